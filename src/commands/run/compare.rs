//! Differences: between sets of models and products over a grid, or between them and what was measured.

mod on_grid;
mod with_data;

use gearloss_framework::document::Diagnostic;
use gearloss_studies::study::CompareEntry;

use gearloss_report::deviations::{histograms, parity};
use gearloss_studies::analyses::measurable::countable;

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
