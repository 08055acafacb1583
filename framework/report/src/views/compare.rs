//! Differences: between model sets over a grid, or between models and a measurement.

mod on_grid;
mod over_cycles;
mod summary;
mod with_data;

use gearloss_studies::analyses::compare::{CompareOutcome, Comparisons};

use crate::page::Page;
use crate::register_view;

register_view!(CompareOutcome, show);

fn show(outcome: &CompareOutcome, page: &mut Page) {
    summary::add(outcome, page);
    match &outcome.comparisons {
        Comparisons::OnGrid(all) => on_grid::show(outcome, all, page),
        Comparisons::OverCycles(all) => over_cycles::show(&outcome.head.analysis, all, page),
        Comparisons::WithData(all) => with_data::show(outcome, all, page),
    }
}
