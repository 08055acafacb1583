//! Figures of sensitivity: bars of effects, sigma over mu*, stacked shares.

use gearloss_studies::analyses::sensitivity::{OutputKind, OutputSensitivity, SensitivityOfSet};

use super::{Influences, descending, influences};
use crate::Figure;
use crate::page::Page;
use crate::picture::{Screen, Tornado, TornadoBar};
use crate::plot::{Bar, Line, Stroke};

/// Maximum number of letters of a name in a legend, and of a line below a bar.
const NAME: usize = 21;
const LINE: usize = 14;

pub fn draw(name: &str, set: &SensitivityOfSet, page: &mut Page) {
    if let Some(tornado) = tornado(set) {
        page.screen(Screen::Tornado(tornado));
    }
    let list = [
        ("effects", effects(name, set)),
        ("morris", morris(name, set)),
        ("shares", shares(name, set)),
    ];
    for (what, figure) in list {
        if let Some(figure) = figure {
            page.figure(format!("{name}-{}-{what}", set.model_set), figure);
        }
    }
}

/// The mean loss at both ends of each parameter by its slope; absent without slopes.
fn tornado(set: &SensitivityOfSet) -> Option<Tornado> {
    let loss = set.outputs.first()?;
    let slopes = loss.local.as_ref()?;
    let bars = set.parameters.iter().zip(slopes).filter_map(|(parameter, slope)| {
        let start = parameter.start?;
        let ends = [parameter.from, parameter.to];
        Some(TornadoBar {
            name: short(&parameter.path),
            results: ends.map(|end| loss.mean + slope.slope * (end - start)),
            ends: ends.map(|end| parameter.varied.words(end)),
        })
    });
    let mut bars: Vec<TornadoBar> = bars.collect();
    let size = |bar: &TornadoBar| (bar.results[1] - bar.results[0]).abs();
    bars.sort_by(|a, b| size(b).total_cmp(&size(a)));
    Some(Tornado {
        title: format!("Mean loss at the ends of each range, by the slopes, {}", set.model_set),
        x: "mean loss in W".to_owned(),
        base: loss.mean,
        bars,
    })
}

/// A bar for each parameter, the largest first.
fn effects(name: &str, set: &SensitivityOfSet) -> Option<Figure> {
    let Influences { values, unit, of, .. } = influences(set.outputs.first()?)?;
    let bar = |k: &usize| Bar {
        label: folded(&set.parameters[*k].path),
        shares: vec![values[*k]],
        above: format!("{:.3}", values[*k]),
        ..Bar::default()
    };
    Some(Figure::Bars {
        title: format!("{name}: sensitivity of the mean loss, models {}", set.model_set),
        over: String::new(),
        height: format!("{of} in {unit}"),
        names: vec!["mean loss".to_owned()],
        bars: descending(&values).iter().map(bar).collect(),
    })
}

/// Mean and standard deviation of the effect of each parameter; above the line sigma exceeds mu*.
fn morris(name: &str, set: &SensitivityOfSet) -> Option<Figure> {
    let effects = set.outputs.first()?.morris.as_ref()?;
    let effect = set.parameters.iter().zip(effects).map(|(parameter, effect)| Line {
        name: short(&parameter.path),
        points: vec![Some((effect.mu_star, effect.sigma))],
        stroke: Stroke::Dots,
    });
    let mut lines: Vec<Line> = effect.collect();
    let most = effects
        .iter()
        .fold(0.0, |most: f64, effect| most.max(effect.mu_star.min(effect.sigma)));
    lines.push(Line {
        name: "sigma = mu*".to_owned(),
        points: vec![Some((0.0, 0.0)), Some((most, most))],
        stroke: Stroke::Line,
    });
    Some(Figure::Lines {
        title: format!(
            "{name}: effects on the mean loss, mean and standard deviation, models {}",
            set.model_set
        ),
        x: "mu* in W".to_owned(),
        y: "sigma in W".to_owned(),
        lines,
    })
}

/// First-order shares of the variance of the loss, of each mechanism and of the efficiency; the remainder is due to interactions.
fn shares(name: &str, set: &SensitivityOfSet) -> Option<Figure> {
    let bar = |output: &OutputSensitivity| {
        let shares = output.sobol.as_ref().filter(|shares| shares.variance > 0.0)?;
        let mut stack: Vec<f64> = shares.first.iter().map(|share| share.value.max(0.0)).collect();
        stack.push((1.0 - stack.iter().sum::<f64>()).max(0.0));
        Some(Bar {
            label: folded(&output.output.replace('_', "_.").replace("_.", "_\n")),
            shares: stack,
            ..Bar::default()
        })
    };
    let shown = set.outputs.iter().filter(|output| output.kind != OutputKind::Term);
    let bars: Vec<Bar> = shown.filter_map(bar).collect();
    let mut names: Vec<String> = set.parameters.iter().map(|parameter| short(&parameter.path)).collect();
    names.push("interactions".to_owned());
    (!bars.is_empty()).then(|| Figure::Bars {
        title: format!("{name}: shares of the variance, models {}", set.model_set),
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
