//! An identification: verdicts, tables and figures of the parameters.

mod compare;
mod hold_out;
mod means;
mod next;
mod parameters;
mod pictures;
mod posterior;
mod search;
mod stacks;
mod summary;

use gearloss_numerics::inference::Verdict;
use gearloss_studies::analyses::identify::{IdentificationOfSet, IdentifyOutcome};
use gearloss_studies::study::{Difference, Quantity};

use crate::page::Page;
use crate::register_view;
use crate::text::figures;

register_view!(IdentifyOutcome, show);

/// Condition number of the unit columns above which it is reported, and above which it is a warning.
const CONDITION: [f64; 2] = [30.0, 1000.0];
/// Residual that consists of rounding errors only.
const ROUNDING: f64 = 1e-6;

fn show(outcome: &IdentifyOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    if let Some(data) = &outcome.data {
        for note in &data.notes {
            page.line(format!("{name}: {}: {note}", data.file));
        }
    }
    if let Some((held, data)) = outcome.held_out.as_ref().zip(outcome.data.as_ref()) {
        page.line(format!(
            "{name}: {} of {} rows are held out ({})",
            held.rows, data.points, held.words
        ));
        if held.undecided > 0 {
            page.line(format!(
                "{name}: {} rows lack a value that the condition of `hold_out` uses; they are fitted",
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

/// Parameters that change several quantities, unless an earlier set reported the same, and notes on the points.
fn moves(name: &str, o: &IdentificationOfSet, moved: &mut Vec<String>, page: &mut Page) {
    for parameter in &o.found.parameters {
        let line = format!(
            "{name}: `{}` changes {}",
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

/// The results of one set.
fn show_set(outcome: &IdentifyOutcome, o: &IdentificationOfSet, page: &mut Page) {
    let name = &outcome.head.analysis;
    search::show(name, o, page);
    parameters::misfit(name, o, page);
    means::show(o, page);
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
    correction(name, o, page);
    if let Err(reason) = &o.found.shares {
        page.line(format!("no uncertainty bands of the losses: {reason}"));
    }
    next::show(name, o, page);
    page.line("");
}

/// The number of identifiable combinations of parameters.
fn resolved(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    let count = o.found.fitted.inference.sized_singular_values().len();
    if count == 0 {
        return page.verdict(format!("{name}: no parameter is free: each is fixed or at a bound"));
    }
    let condition = match o.condition {
        None => "columns are parallel".to_owned(),
        Some(c) if c > CONDITION[1] => format!("condition number {c:.0}: columns are nearly parallel"),
        Some(c) if c > CONDITION[0] => format!("condition number {c:.0}: check combinations of parameters"),
        Some(c) => format!("condition number {c:.0}"),
    };
    page.verdict(format!(
        "{name}: the {} identify {} of {count} combinations of free parameters ({condition})",
        measured(o),
        o.resolved_combinations
    ));
}

/// What is measured, in a word.
fn measured(o: &IdentificationOfSet) -> &'static str {
    match (o.points.is_empty(), o.means.is_empty()) {
        (_, true) => "points",
        (true, false) => "means",
        (false, false) => "points and means",
    }
}

/// The prediction errors of groups of rows from fits to the others.
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
        "cross-validation over {} {kind} ({groups}): predicted residual {:.3} rms, fitted {inside:.3}",
        folds.len(),
        record.rms
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

/// How well a correction predicts the loss torque that the fit does not explain.
fn correction(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    for of_gear in &o.correction {
        let over: Vec<&str> = of_gear.over.iter().map(|over| over.words().0).collect();
        page.verdict(format!(
            "{name}: gear {}: {} Nm rms of the loss torque remain after the fit; a smooth correction over {}, which is no physics, leaves {} Nm where each of {} points is left out \
             ({:.0} % of them inside the 95 % band)",
            of_gear.gear,
            short(of_gear.rms_before_nm),
            over.join(", "),
            short(of_gear.rms_left_out_nm),
            of_gear.points.len(),
            100.0 * of_gear.in_band
        ));
    }
}

/// A number with four digits.
fn short(x: f64) -> String {
    figures(x, 4)
}

/// An interval with four digits.
fn span(ends: [f64; 2]) -> String {
    format!("{} to {}", short(ends[0]), short(ends[1]))
}

/// A quantity in file names.
fn slug(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Efficiency => "efficiency",
        Quantity::Loss => "loss",
        Quantity::LossTorque => "loss-torque",
        Quantity::Temperature => "temperature",
        // Not measured, so never identified from.
        Quantity::DcPower | Quantity::UnitLoss | Quantity::SystemEfficiency => "unit",
    }
}

/// A quantity and the unit of its differences.
fn words(quantity: Quantity) -> (&'static str, &'static str) {
    quantity.words(Difference::Points)
}
