//! The misfit and the parameters, as text.

use gearloss_studies::analyses::identify::IdentificationOfSet;
use gearloss_studies::analyses::identify::outcome::AccuracyOfPoints;
use gearloss_studies::analyses::identify::parameter::{ProfileOfParameter, ReachOfProfile, verdict_words};

use super::{short, span, words};
use crate::page::Page;
use crate::text::TextTable;

/// Deviation of the models from the points before and after the fit.
pub(super) fn misfit(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    for quantity in o.found.quantities() {
        let (what, unit) = words(quantity);
        let [before, after] = o.found.rms(quantity);
        let weighted = match o.accuracy {
            AccuracyOfPoints::Given => {
                let [before, after] = o.found.weighted_rms(quantity).map(short);
                format!("; divided by the accuracy of the points {before} and {after}")
            }
            AccuracyOfPoints::Estimated => String::new(),
        };
        page.verdict(format!(
            "{name}: {}: {what} deviation {} {unit} rms before the fit, {} after{weighted}",
            o.model_set,
            short(before),
            short(after)
        ));
    }
    match (o.accuracy, &o.found.checks.lack) {
        (AccuracyOfPoints::Given, Some(lack)) => page.line(format!(
            "chi-square with the stated accuracies {:.1} at {:.0} degrees of freedom, {}",
            lack.objective,
            lack.freedom,
            if lack.probability < 0.001 {
                "p < 0.001".to_owned()
            } else {
                format!("p = {:.3}", lack.probability)
            }
        )),
        (AccuracyOfPoints::Given, None) => {}
        (AccuracyOfPoints::Estimated, _) => {
            let first = o.found.quantities().first().copied();
            page.line(format!(
                "no accuracy is stated: intervals are based on the scatter of the points, {}{}",
                short(o.misfit.standard_deviation_of_residuals),
                first.map_or_else(String::new, |quantity| format!(" {}", words(quantity).1))
            ));
        }
    }
}

/// A table of the parameters with notes.
pub(super) fn show(o: &IdentificationOfSet, page: &mut Page) {
    page.table(table(o));
    for (parameter, theta) in o.found.parameters.iter().zip(o.found.fitted.theta()) {
        if let Some(words) = parameter.changed_from_source(*theta) {
            page.line(format!("`{}`: coefficient {words}", parameter.name));
        }
    }
    for parameter in &o.parameters {
        if let Some(reason) = parameter.profile.as_ref().and_then(|profile| profile.failed.as_ref()) {
            page.line(format!("no profile of `{}`: {reason}", parameter.name));
        }
    }
    let kinked = o.parameters.iter().filter(|parameter| parameter.kink);
    let kinked: Vec<&str> = kinked.map(|parameter| parameter.name.as_str()).collect();
    if !kinked.is_empty() {
        page.line(format!(
            "kink: derivatives differ on both sides of the minimum, so the linearised intervals of {} are only approximate; use the profile intervals",
            kinked.join(", ")
        ));
    }
    if o.found.fitted.inference.is_robust() {
        page.line("a robust loss has no profile intervals");
    }
}

fn table(o: &IdentificationOfSet) -> TextTable {
    let inference = &o.found.fitted.inference;
    let widening = o.misfit.widening;
    let mut head = vec!["parameter", "unit", "stated", "fitted", "95 % linearised"];
    if widening.is_some() {
        head.push("widened");
    }
    head.extend(["95 % profile", "verdict"]);
    let mut table = TextTable::new(&head);
    for (k, parameter) in o.parameters.iter().enumerate() {
        let interval = |widening: f64| {
            inference.interval(k, 0.95, widening).map_or_else(
                || "-".to_owned(),
                |i| {
                    let cut = if i.ends == i.uncut { "" } else { " (cut)" };
                    format!("{}{cut}", span(i.ends))
                },
            )
        };
        let kink = if parameter.kink { " (kink)" } else { "" };
        let mut row = vec![
            parameter.name.clone(),
            parameter.unit.to_owned(),
            parameter.stated.map_or_else(|| "-".to_owned(), short),
            short(parameter.value),
            format!("{}{kink}", interval(1.0)),
        ];
        row.extend(widening.map(interval));
        row.push(parameter.profile.as_ref().map_or_else(|| "-".to_owned(), profile));
        row.push(verdict_words(parameter.judgement));
        table.row(row);
    }
    table
}

/// A profile interval with its notes.
fn profile(profile: &ProfileOfParameter) -> String {
    let (Some(ends), Some(reach)) = (profile.ends, profile.reach) else {
        return "failed".to_owned();
    };
    let remark = if reach.contains(&ReachOfProfile::Unresolved) {
        " (open)"
    } else if reach.contains(&ReachOfProfile::Bound) {
        " (bound)"
    } else if profile.nonlinear == Some(true) {
        " (nonlinear)"
    } else {
        ""
    };
    format!("{}{remark}", span(ends))
}
