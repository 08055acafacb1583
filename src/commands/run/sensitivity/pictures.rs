//! Bars of effects, effects over their scatter, stacks of shares.

use gearloss_report::Figure;
use gearloss_report::plot::{Bar, Line, Stroke};
use gearloss_studies::study::Write;

use super::super::Runner;
use super::super::write::picture;
use super::Found;
use super::outputs::Kind;
use super::show::descending;
use crate::output::Failure;

/// Letters of a name in a legend, and of a line below a bar.
const NAME: usize = 21;
const LINE: usize = 14;

pub fn draw(runner: &Runner<'_>, name: &str, f: &Found<'_>, formats: &[Write]) -> Result<(), Failure> {
    let file = |what: &str| format!("{name}-{}-{what}", f.built.name);
    let list = [
        (file("effects"), effects(name, f)),
        (file("morris"), morris(name, f)),
        (file("shares"), shares(name, f)),
    ];
    for (file, figure) in list {
        if let Some(figure) = figure {
            picture(runner, &file, figure, formats)?;
        }
    }
    Ok(())
}

/// A bar for each parameter, the greatest first: change of the mean loss, else its share of the variance, else the slope.
fn effects(name: &str, f: &Found<'_>) -> Option<Figure> {
    let (values, height): (Vec<f64>, &str) = match (&f.morris, &f.sobol, &f.local) {
        (Some(morris), ..) => (
            morris.effects[0].iter().map(|e| e.magnitude).collect(),
            "mu* of the mean loss in W",
        ),
        (None, Some(sobol), _) => (
            sobol[0].total.iter().map(|e| e.value.max(0.0)).collect(),
            "share of the variance, with others",
        ),
        (None, None, Some(local)) => (
            local[0]
                .iter()
                .map(|l| l.scaled.map_or(0.0, |s| 100.0 * s.abs()))
                .collect(),
            "slope times range in % of the loss",
        ),
        (None, None, None) => return None,
    };
    let bar = |k: &usize| Bar {
        label: folded(&f.ranges[*k].varied.pattern),
        shares: vec![values[*k]],
        above: format!("{:.3}", values[*k]),
        ..Bar::default()
    };
    Some(Figure::Bars {
        title: format!("{name}: what the mean loss depends on, models {}", f.built.name),
        over: String::new(),
        height: height.to_owned(),
        names: vec!["mean loss".to_owned()],
        bars: descending(&values).iter().map(bar).collect(),
    })
}

/// The size of the effect of each parameter and how it varies; above the line it varies by more than its size.
fn morris(name: &str, f: &Found<'_>) -> Option<Figure> {
    let effects = &f.morris.as_ref()?.effects[0];
    let mut lines: Vec<Line> = f
        .ranges
        .iter()
        .zip(effects)
        .map(|(range, e)| Line {
            name: short(&range.varied.pattern),
            points: vec![Some((e.magnitude, e.deviation))],
            stroke: Stroke::Dots,
        })
        .collect();
    let most = effects
        .iter()
        .fold(0.0, |most: f64, e| most.max(e.magnitude.min(e.deviation)));
    lines.push(Line {
        name: "sigma = mu*".to_owned(),
        points: vec![Some((0.0, 0.0)), Some((most, most))],
        stroke: Stroke::Line,
    });
    Some(Figure::Lines {
        title: format!(
            "{name}: effects on the mean loss and how they vary, models {}",
            f.built.name
        ),
        x: "mu* in W".to_owned(),
        y: "sigma in W".to_owned(),
        lines,
    })
}

/// What the parameters explain alone of the variance of the loss, of each mechanism and of the efficiency; the rest is due to
/// their interactions.
fn shares(name: &str, f: &Found<'_>) -> Option<Figure> {
    let sobol = f.sobol.as_ref()?;
    let shown = f.outputs.list.iter().zip(sobol);
    let shown = shown.filter(|(output, shares)| output.kind != Kind::Term && shares.variance > 0.0);
    let bars: Vec<Bar> = shown
        .map(|(output, shares)| {
            let mut stack: Vec<f64> = shares.first.iter().map(|e| e.value.max(0.0)).collect();
            stack.push((1.0 - stack.iter().sum::<f64>()).max(0.0));
            Bar {
                label: folded(&output.name.replace('_', "_.").replace("_.", "_\n")),
                shares: stack,
                ..Bar::default()
            }
        })
        .collect();
    let mut names: Vec<String> = f.ranges.iter().map(|range| short(&range.varied.pattern)).collect();
    names.push("interactions".to_owned());
    (!bars.is_empty()).then(|| Figure::Bars {
        title: format!("{name}: shares of the variance, models {}", f.built.name),
        over: String::new(),
        height: "share of the variance".to_owned(),
        names,
        bars,
    })
}

/// The end of a path that fits a legend.
fn short(path: &str) -> String {
    if path.chars().count() <= NAME {
        return path.to_owned();
    }
    let mut start = path.len();
    for (i, _) in path.match_indices('.').rev() {
        if path[i..].chars().count() >= NAME {
            break;
        }
        start = i;
    }
    if start == path.len() {
        return path.to_owned();
    }
    format!("…{}", &path[start + 1..])
}

/// A path in lines that fit below a bar.
fn folded(path: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for piece in path.split_inclusive('.') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + piece.chars().count() <= LINE => line.push_str(piece),
            _ => lines.push(piece.to_owned()),
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_fit_their_places() {
        assert_eq!(short("gears.*.surface.rq"), "gears.*.surface.rq");
        assert_eq!(short("lubricants.sump.viscosity.kv100"), "…viscosity.kv100");
        assert_eq!(
            folded("lubricants.sump.viscosity.kv100"),
            "lubricants.\nsump.\nviscosity.\nkv100"
        );
        assert_eq!(folded("gears.*.surface.rq"), "gears.*.\nsurface.rq");
    }
}
