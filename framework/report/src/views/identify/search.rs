//! The course of a search as text.

use gearloss_numerics::least_squares::{Minimum, Status};
use gearloss_studies::analyses::identify::IdentificationOfSet;
use gearloss_studies::identify::Identified;

use super::{short, words};
use crate::page::Page;

/// Maximum number of printed other minima, and the distance in standard errors above which a parameter counts as different.
const MINIMA: usize = 5;
const DIFFERS: f64 = 0.5;
/// Relative difference above which a parameter without a standard error counts as different.
const APART: f64 = 0.01;

pub(super) fn show(name: &str, o: &IdentificationOfSet, page: &mut Page) {
    let (fit, minima) = (o.found.fitted.fit(), &o.found.fitted.minima.minima);
    page.line(format!(
        "{name}: models {}, {} measured numbers, {} parameters",
        o.model_set,
        fit.rows,
        o.parameters.len()
    ));
    page.line(format!(
        "search {} after {} steps and {} evaluations of all points{}",
        ended(o),
        o.search.steps,
        o.search.evaluations,
        starts(minima)
    ));
    for kink in &o.search.kinks {
        page.line(format!("{name}: {}", kink.sentence));
    }
    if !fit.kinks.is_empty() && o.search.kinks.is_empty() {
        page.line(format!(
            "{name}: minimum at a kink of the residuals at which no component's loss is discontinuous"
        ));
    }
    for other in minima.iter().skip(1).take(MINIMA) {
        page.line(format!("{name}: {}", another(o, other)));
    }
    if minima.len() > MINIMA + 1 {
        page.line(format!(
            "{name}: {} more minima are listed in the JSON file",
            minima.len() - MINIMA - 1
        ));
    }
    for note in &o.search.notes {
        page.line(format!("note: {note}"));
    }
    if let Some(kinship) = o.search.kinship {
        page.line(format!("minima with the same misfit: {kinship}"));
    }
    for (quantity, factor) in &o.found.fitted.factors {
        page.line(format!(
            "the stated accuracy of the {} should be multiplied by {factor:.2}",
            words(*quantity).0
        ));
    }
}

/// The status of the search.
fn ended(o: &IdentificationOfSet) -> String {
    let search = &o.search;
    match search.worth {
        Status::Converged if !o.found.fitted.fit().kinks.is_empty() => {
            format!("converged at a kink ({})", search.reason)
        }
        Status::Converged => format!("converged ({})", search.reason),
        Status::Singular => "converged, but a combination of parameters has no effect (singular)".to_owned(),
        Status::Failed | Status::Interrupted => format!("{} ({}): no minimum", search.status, search.reason),
    }
}

/// The minima that the starts lead to.
fn starts(minima: &[Minimum]) -> String {
    let starts: usize = minima.iter().map(|m| m.starts.len()).sum();
    match (starts, minima.len()) {
        (1, _) => String::new(),
        (starts, 1) => format!("; all {starts} starts converge to it"),
        (starts, several) => format!(
            "; {} of {starts} starts converge to it, the others to {}",
            minima[0].starts.len(),
            if several == 2 {
                "another minimum".to_owned()
            } else {
                format!("{} other minima", several - 1)
            }
        ),
    }
}

/// Another minimum: its misfit, and the parameters that differ.
fn another(o: &IdentificationOfSet, other: &Minimum) -> String {
    let fit = o.found.fitted.fit();
    let differs = |(k, parameter): (usize, &Identified)| {
        let (here, there) = (fit.theta[k], other.fit.theta[k]);
        match o.found.fitted.distance(other, k) {
            Some(distance) if distance.abs() >= DIFFERS => Some(format!(
                "{} {} ({distance:+.1} standard errors)",
                parameter.name,
                short(there)
            )),
            None if (there - here).abs() > APART * here.abs().max(there.abs()) => {
                Some(format!("{} {}", parameter.name, short(there)))
            }
            _ => None,
        }
    };
    let list: Vec<String> = o.found.parameters.iter().enumerate().filter_map(differs).collect();
    let list = if list.is_empty() {
        "no parameter differs by half a standard error".to_owned()
    } else {
        list.join(", ")
    };
    let more = if fit.cost > 0.0 {
        format!("{:.2} % more", 100.0 * (other.fit.cost / fit.cost - 1.0))
    } else {
        "more".to_owned()
    };
    format!(
        "another minimum, found from {} of the starts, has the sum of squares {} ({more}): {list}",
        other.starts.len(),
        short(other.fit.chi2())
    )
}
