//! Differences over a grid: a table, a verdict and a map for each set; one histogram and parity plot for all.

use gearloss_studies::analyses::compare::{CompareOutcome, DifferenceAt, GridComparison};
use gearloss_studies::numbers::{RPM, tidy};

use crate::deviations::{histograms, parity};
use crate::figure::jumps;
use crate::names::SetNames;
use crate::page::Page;
use crate::picture::{PanelQuantity, Panels, Screen};
use crate::text::{TextTable, number, signed};
use crate::{Figure, Map};

pub fn show(outcome: &CompareOutcome, all: &[GridComparison], page: &mut Page) {
    let name = &outcome.head.analysis;
    let (words, label) = outcome.quantity.words(outcome.difference);
    for c in all {
        page.line(format!(
            "{name}: {words} of {} minus {} in {label}, gear {}",
            c.model_set, c.base, c.gear
        ));
        page.table(differences(c));
        page.verdict(format!(
            "{} minus {}, {words} in {label}: {}",
            c.model_set,
            c.base,
            figures(c)
        ));
        if let Some(band) = c.loss_difference_band_w {
            page.verdict(with_error((&c.model_set, &c.base), band));
        }
        page.line("");
        page.line("");
    }
    let panels = panels(all, (words, label));
    for c in all {
        let title = format!("{name}: {words} of {} minus {} in {label}", c.model_set, c.base);
        let (file, figure) = (
            format!("{name}-{}", c.model_set),
            map(title, (words, label), c, outcome.accuracy),
        );
        match &panels {
            Some(_) => page.file_figure(file, figure),
            None => page.figure(file, figure),
        }
    }
    if let Some(panels) = panels {
        page.screen(Screen::Panels(Box::new(panels)));
    }
    let known = |c: &GridComparison| c.points.iter().filter_map(|p| p.difference).collect();
    let lists = all.iter().map(|c| (c.model_set.clone(), known(c))).collect();
    page.figure(format!("{name}-histogram"), histograms(name, (words, label), lists));
    let pairs = |c: &GridComparison| c.points.iter().map(|p| Some((p.base_model?, p.model?))).collect();
    let lists = all.iter().map(|c| (c.model_set.clone(), pairs(c))).collect();
    let base = all.first().map_or("", |c| c.base.as_str());
    let figure = parity(name, words, (&format!("{base}: {words}"), words), lists);
    page.figure(format!("{name}-parity"), figure);
}

/// The band of a difference of the mean loss with the known errors of the models.
pub fn with_error((set, base): (&str, &str), [low, middle, high]: [f64; 3]) -> String {
    let sides = if low <= 0.0 && high >= 0.0 {
        "; it contains zero"
    } else {
        ""
    };
    format!(
        "{set} minus {base}, mean loss with the known errors of the models: {} to {} W (95 %), median {} W{sides}",
        signed(low),
        signed(high),
        signed(middle)
    )
}

/// A selection of differences as a table of torque and speed.
fn differences(c: &GridComparison) -> TextTable {
    let speeds: Vec<f64> = c.speeds.iter().map(|speed| speed * RPM).collect();
    let difference = |t: usize, s: usize| c.points[t * speeds.len() + s].difference;
    TextTable::over_grid(&c.torques, &speeds, |t, s| number(difference(t, s), 2))
}

/// Extremes, mean and root mean square as text.
fn figures(c: &GridComparison) -> String {
    let place = |found: &Option<DifferenceAt>| {
        found.map_or_else(
            || "-".to_owned(),
            |at| {
                let speed = at.speed * RPM;
                format!("{:.3} at {} Nm, {speed:.0} rpm", at.difference, at.torque_nm)
            },
        )
    };
    let of_loss = c.loss_difference_percent_of_loss;
    format!(
        "min {}; max {}; mean {}, rms {}; loss difference: mean {} %, rms {} %",
        place(&c.least),
        place(&c.greatest),
        number(c.mean, 3),
        number(c.difference.map(|s| s.rms), 3),
        number(of_loss.map(|s| s.mean), 2),
        number(of_loss.map(|s| s.rms), 2)
    )
}

/// All differences side by side with one scale, if their axes are the same.
fn panels(all: &[GridComparison], (words, label): (&str, &str)) -> Option<Panels> {
    let first = all.first()?;
    let same = |c: &GridComparison| c.torques == first.torques && c.speeds == first.speeds && c.gear == first.gear;
    if !all.iter().all(same) || first.torques.len() < 2 || first.speeds.len() < 2 {
        return None;
    }
    let names = SetNames::new(all.iter().flat_map(|c| [c.model_set.as_str(), c.base.as_str()]));
    let minus = |c: &GridComparison| format!("{} minus {}", names.word(&c.model_set), names.word(&c.base));
    // A single map has no name of its own.
    let title = match all {
        [only] => format!("Difference of the {words}, {}, gear {}", minus(only), first.gear),
        _ => format!("Difference of the {words}, gear {}", first.gear),
    };
    Some(Panels {
        title,
        rows: vec![String::new()],
        columns: all.iter().map(minus).collect(),
        x: (
            "speed in rpm".to_owned(),
            first.speeds.iter().map(|w| tidy(w * RPM)).collect(),
        ),
        y: (
            "torque in Nm".to_owned(),
            first.torques.iter().map(|t| tidy(*t)).collect(),
        ),
        quantities: vec![PanelQuantity {
            name: format!("difference of the {words}"),
            unit: label.to_owned(),
            diverging: true,
            best: None,
            jumps: jumps(words),
            panels: all
                .iter()
                .map(|c| Some(c.points.iter().map(|p| p.difference).collect()))
                .collect(),
        }],
        outside: all
            .iter()
            .map(|c| {
                if c.outside.contains(&true) {
                    c.outside.clone()
                } else {
                    Vec::new()
                }
            })
            .collect(),
        ..Panels::default()
    })
}

fn map(title: String, (words, unit): (&str, &str), c: &GridComparison, accuracy: Option<f64>) -> Figure {
    let mark = |x: f64| format!("{}", tidy(x));
    Figure::Map(Map {
        title,
        x: ("speed rpm".to_owned(), c.speeds.iter().map(|w| mark(w * RPM)).collect()),
        y: ("torque Nm".to_owned(), c.torques.iter().map(|t| mark(*t)).collect()),
        values: c.points.iter().map(|p| p.difference).collect(),
        unit: unit.to_owned(),
        jumps: jumps(words),
        diverging: true,
        hatched: c.outside.clone(),
        unseen: accuracy,
        ..Map::default()
    })
}
