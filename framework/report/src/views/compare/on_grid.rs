//! Differences over a grid: a table, a verdict and a map for each set; one histogram and parity plot for all.

use gearloss_studies::analyses::compare::{CompareOutcome, DifferenceAt, GridComparison};
use gearloss_studies::analyses::numbers::{RPM, tidy};

use crate::deviations::{histograms, parity};
use crate::page::Page;
use crate::text::{TextTable, fixed, number, spread};
use crate::{Figure, Map};

pub fn show(outcome: &CompareOutcome, all: &[GridComparison], page: &mut Page) {
    let name = &outcome.head.analysis;
    let (words, label) = outcome.quantity.words(outcome.difference);
    for c in all {
        page.line(format!(
            "{name}: {words} of {} minus {} in {label}, gear {}",
            c.model_set, c.base, c.gear
        ));
        page.lines(differences(c));
        page.verdict(format!(
            "{} minus {}, {words} in {label}: {}",
            c.model_set,
            c.base,
            figures(c)
        ));
        page.line("");
        page.outside(&c.notes);
        page.line("");
    }
    for c in all {
        let title = format!("{name}: {words} of {} minus {} in {label}", c.model_set, c.base);
        page.figure(format!("{name}-{}", c.model_set), map(title, c, outcome.accuracy));
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

/// A selection of differences as a table of torque and speed.
fn differences(c: &GridComparison) -> String {
    let shown = spread(c.speeds.len());
    let mut titles = vec!["torque Nm".to_owned()];
    titles.extend(shown.iter().map(|i| format!("{} rpm", fixed(c.speeds[*i] * RPM, 0))));
    let mut table = TextTable::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
    for t in spread(c.torques.len()) {
        let mut row = vec![format!("{}", c.torques[t])];
        let difference = |i: &usize| c.points[t * c.speeds.len() + i].difference;
        row.extend(shown.iter().map(|i| number(difference(i), 2)));
        table.row(row);
    }
    table.render()
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

fn map(title: String, c: &GridComparison, accuracy: Option<f64>) -> Figure {
    let mark = |x: f64| format!("{}", tidy(x));
    Figure::Map(Map {
        title,
        x: ("speed rpm".to_owned(), c.speeds.iter().map(|w| mark(w * RPM)).collect()),
        y: ("torque Nm".to_owned(), c.torques.iter().map(|t| mark(*t)).collect()),
        values: c.points.iter().map(|p| p.difference).collect(),
        diverging: true,
        hatched: c.outside.clone(),
        unseen: accuracy,
        ..Map::default()
    })
}
