//! Differences: between sets of models and products over a grid, or between them and what was measured.

mod on_grid;
mod with_data;

use gearloss_framework::document::Diagnostic;
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::analysis::histogram;
use gearloss_studies::study::{CompareEntry, Difference, Quantity};

use super::Runner;
use crate::output::{Failure, Out};

pub fn run(runner: &Runner<'_>, name: &str, entry: &CompareEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let wrong = |path: String, message: &str, mend: &str| -> Result<(), Failure> {
        let error = Diagnostic::error(path, message).mend(mend);
        Err(runner.study.findings(vec![error]).into())
    };
    countable(runner, &path, entry.quantity, entry.difference)?;
    match (&entry.grid, &entry.base, &entry.data) {
        (None, None, Some(data)) => with_data::run(runner, name, entry, data, out),
        (Some(_), Some(_), None) if !entry.bind.is_empty() || entry.gear.is_some() => {
            wrong(path, "`bind` and `gear` belong to `data`", "state them in the grid")
        }
        (Some(grid), Some(base), None) => on_grid::run(runner, name, entry, (grid, base), out),
        _ => wrong(
            path,
            "a comparison needs either `grid` and `base`, or `data`",
            "write `grid: ..., base: ...` to compare sets, or `data: { file: ... }` to compare with a measurement",
        ),
    }
}

/// Refuses a difference that a quantity does not have.
pub(super) fn countable(
    runner: &Runner<'_>,
    path: &str,
    quantity: Quantity,
    difference: Difference,
) -> Result<(), Failure> {
    if (quantity, difference) == (Quantity::Temperature, Difference::Percent) {
        let message = "a temperature has no percentage";
        let mend = "write `difference: points`, which counts kelvins";
        return Err(runner.wrong(&format!("{path}.difference"), message, mend));
    }
    Ok(())
}

/// Numbers of points over their difference, in the same cells for every set.
pub(super) fn histograms(name: &str, (what, unit): (&str, &str), lists: Vec<(String, Vec<f64>)>) -> Figure {
    let all: Vec<f64> = lists.iter().flat_map(|(_, list)| list.iter().copied()).collect();
    let (from, width, cells) = histogram(&all);
    let steps = |(set, list): (String, Vec<f64>)| {
        let mut counts = vec![0.0; cells.len()];
        for x in list {
            let cell = (((x - from) / width) as usize).min(cells.len().saturating_sub(1));
            counts[cell] += 1.0;
        }
        let mut points = vec![Some((from, 0.0))];
        for (i, count) in counts.iter().enumerate() {
            let left = from + width * i as f64;
            points.extend([Some((left, *count)), Some((left + width, *count))]);
        }
        points.push(Some((from + width * cells.len() as f64, 0.0)));
        Line {
            name: set,
            points,
            stroke: Stroke::Line,
        }
    };
    Figure::Lines {
        title: format!("{name}: how often a difference occurs"),
        x: format!("difference of {what} in {unit}"),
        y: "points".to_owned(),
        lines: lists.into_iter().map(steps).collect(),
    }
}

/// One quantity over the same of what it is compared with, and the line of equal values.
fn parity(name: &str, what: &str, (x, y): (&str, &str), lists: Vec<(String, Vec<Option<(f64, f64)>>)>) -> Figure {
    let all = || lists.iter().flat_map(|(_, list)| list.iter().flatten());
    let ends = all().fold(None, |ends: Option<(f64, f64)>, (a, b)| {
        let (low, high) = ends.unwrap_or((*a, *a));
        Some((low.min(*a).min(*b), high.max(*a).max(*b)))
    });
    let mut lines: Vec<Line> = Vec::new();
    for (set, points) in lists {
        lines.push(Line {
            name: set,
            points,
            stroke: Stroke::Dots,
        });
    }
    if let Some((low, high)) = ends {
        lines.push(Line {
            name: "equal".to_owned(),
            points: vec![Some((low, low)), Some((high, high))],
            stroke: Stroke::Line,
        });
    }
    Figure::Lines {
        title: format!("{name}: parity of {what}"),
        x: x.to_owned(),
        y: y.to_owned(),
        lines,
    }
}
