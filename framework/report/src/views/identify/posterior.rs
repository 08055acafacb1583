//! Intervals of the posterior, the fit and the profiles as text.

use gearloss_studies::analyses::identify::IdentificationOfSet;

use super::{short, span};
use crate::page::Page;
use crate::text::{TextTable, fixed};

pub(super) fn show(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    if let Some(reason) = &o.no_posterior {
        page.line(format!("{name}: no posterior: {reason}"));
    }
    let Some(posterior) = &o.posterior else { return };
    let or_dash = |ends: Option<[f64; 2]>| ends.map_or_else(|| "-".to_owned(), span);
    let table = TextTable::of(&posterior.parameters)
        .column("parameter", |parameter| &parameter.name)
        .column("unit", |parameter| parameter.unit)
        .column("median", |parameter| short(parameter.median))
        .column("95 % posterior", |parameter| span(parameter.interval))
        .column("95 % linearised", |parameter| or_dash(parameter.linearised))
        .column("95 % profile", |parameter| or_dash(parameter.profile))
        .column("independent draws", |parameter| fixed(parameter.independent_draws, 0));
    page.line(format!(
        "{name}: posterior of {} walkers, {} steps each, {:.0} % of the moves accepted",
        posterior.walkers,
        posterior.steps,
        100.0 * posterior.acceptance
    ));
    page.table(table.finish());
    if !posterior.is_settled {
        let all = posterior.parameters.iter();
        let least = all.clone().map(|p| p.independent_draws).fold(f64::INFINITY, f64::min);
        let slowest = all.map(|p| p.autocorrelation_steps).fold(1.0, f64::max);
        page.verdict(format!(
            "{name}: the posterior has not converged: {least:.0} independent draws, autocorrelation time {slowest:.0} of {} steps; \
             at least 400 draws and 20 autocorrelation times are required: increase `steps`",
            posterior.steps
        ));
    }
}
