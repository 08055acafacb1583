//! An identification: what the points say of each parameter, in sentences, tables and pictures.

mod compare;
mod hold_out;
mod next;
mod parameters;
mod pictures;
mod posterior;
mod search;
mod stacks;

use gearloss_numerics::inference::Verdict;
use gearloss_studies::analyses::identify::{IdentificationOfSet, IdentifyOutcome};
use gearloss_studies::study::{Difference, Quantity};

use crate::page::Page;
use crate::register_view;
use crate::text::figures;

register_view!(IdentifyOutcome, show);

/// Condition of unit columns from which on it is reported, and from which on it is a warning.
const CONDITION: [f64; 2] = [30.0, 1000.0];
/// Residual below which nothing but rounding is left.
const ROUNDING: f64 = 1e-6;

fn show(outcome: &IdentifyOutcome, page: &mut Page) {
    let name = &outcome.head.analysis;
    for note in &outcome.data.notes {
        page.line(format!("{name}: {}: {note}", outcome.data.file));
    }
    if let Some(held) = &outcome.held_out {
        page.line(format!(
            "{name}: {} of {} rows are held out ({})",
            held.rows, outcome.data.points, held.words
        ));
        if held.undecided > 0 {
            page.line(format!(
                "{name}: {} rows lack what the condition asks for, and are fitted",
                held.undecided
            ));
        }
    }
    let mut moved: Vec<String> = Vec::new();
    for o in &outcome.identifications {
        moves(name, o, &mut moved, page);
        show_set(outcome, o, page);
    }
    if let Some(reason) = outcome.not_compared {
        page.line(format!("{name}: {reason}\n"));
    }
    if let Some(compared) = &outcome.comparison_of_sets {
        compare::show(name, compared, page);
    }
    for o in &outcome.identifications {
        pictures::draw(outcome, o, page);
    }
}

/// Parameters that move several quantities, where no set before has said the same, and notes on the points.
fn moves(name: &str, o: &IdentificationOfSet, moved: &mut Vec<String>, page: &mut Page) {
    for parameter in &o.found.parameters {
        let line = format!(
            "{name}: `{}` moves {}",
            parameter.base_name(),
            parameter.paths().join(", ")
        );
        if parameter.paths().len() > 1 && !moved.contains(&line) {
            page.line(&line);
            moved.push(line);
        }
    }
    for note in &o.notes {
        page.line(format!("{name}: {note}"));
    }
}

/// What was found for one set.
fn show_set(outcome: &IdentifyOutcome, o: &IdentificationOfSet, page: &mut Page) {
    let name = &outcome.head.analysis;
    search::show(name, o, page);
    parameters::misfit(name, o, page);
    parameters::show(o, page);
    posterior::show(name, o, page);
    for parameter in &o.parameters {
        if parameter.judgement != Verdict::WellDetermined {
            page.line(format!("`{}` {}", parameter.name, parameter.sentence));
        }
    }
    resolved(name, o, page);
    for words in &o.checks.sentences {
        page.verdict(format!("{name}: {words}"));
    }
    folds(name, &outcome.requested.groups, o, page);
    hold_out::show(name, o, page);
    if let Err(reason) = &o.found.shares {
        page.line(format!("no bands on the losses: {reason}"));
    }
    next::show(name, o, page);
    page.outside(&o.outside);
    page.line("");
}

/// How many combinations of parameters the points tell.
fn resolved(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    let count = o.found.fitted.inference.sized_singular_values().len();
    if count == 0 {
        return page.verdict(format!(
            "{name}: no parameter is free: each is held or stands on a bound"
        ));
    }
    let condition = match o.condition {
        None => "columns are parallel".to_owned(),
        Some(c) if c > CONDITION[1] => format!("condition {c:.0}: columns are nearly parallel"),
        Some(c) if c > CONDITION[0] => format!("condition {c:.0}: watch combinations"),
        Some(c) => format!("condition {c:.0}"),
    };
    page.verdict(format!(
        "{name}: the points resolve {} of {count} combinations of free parameters ({condition})",
        o.resolved_combinations
    ));
}

/// How well groups of rows are predicted from the others.
fn folds(name: &str, groups: &str, o: &IdentificationOfSet, page: &mut Page) {
    let inference = &o.found.fitted.inference;
    if let Some(Err(reason)) = &o.found.folds {
        page.line(format!("no cross-validation: {reason}"));
    }
    let (Some(Ok((folds, validation))), Some(record)) = (&o.found.folds, &o.folds) else {
        return;
    };
    let inside = (inference.chi_square() / inference.residuals().len() as f64).sqrt();
    let kind = if folds.iter().all(|fold| fold.band.is_some()) {
        "bands"
    } else {
        "groups"
    };
    page.line(format!(
        "predicted without its own {groups} a residual is {:.3} rms over {} {kind}, fitted {inside:.3}",
        record.rms,
        folds.len()
    ));
    let strange = validation.strange(inside).into_iter();
    for place in strange.filter(|_| record.rms > ROUNDING) {
        let fold = &record.bands[place];
        page.line(format!(
            "{name}: the model does not extrapolate to {}: {:.3} rms there",
            fold.name, fold.rms
        ));
    }
}

/// A number in four digits.
fn short(x: f64) -> String {
    figures(x, 4)
}

/// An interval in four digits.
fn span(ends: [f64; 2]) -> String {
    format!("{} to {}", short(ends[0]), short(ends[1]))
}

/// A quantity in names of files.
fn slug(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Efficiency => "efficiency",
        Quantity::Loss => "loss",
        Quantity::LossTorque => "loss-torque",
        Quantity::Temperature => "temperature",
    }
}

/// A quantity and the unit of its differences.
fn words(quantity: Quantity) -> (&'static str, &'static str) {
    quantity.words(Difference::Points)
}
