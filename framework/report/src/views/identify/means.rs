//! Means over cycles as text: stated, and calculated before and after the fit.

use gearloss_studies::analyses::identify::IdentificationOfSet;
use gearloss_studies::analyses::identify::means::MeanOfFit;

use super::{short, span};
use crate::Figure;
use crate::names::listed;
use crate::page::Page;
use crate::plot::Interval;
use crate::text::TextTable;

/// Residual up to which a mean agrees.
const AGREES: f64 = 2.0;

pub(super) fn show(o: &IdentificationOfSet, page: &mut Page) {
    if o.means.is_empty() {
        return;
    }
    let table = TextTable::of(&o.means)
        .column("mean", |mean| &mean.name)
        .column("unit", |mean| mean.unit)
        .column("stated", |mean| stated(mean))
        .column("accuracy", |mean| short(mean.accuracy))
        .column("before the fit", |mean| short(mean.model_before))
        .column("after", |mean| short(mean.model))
        .column("deviation over accuracy", |mean| short(mean.residual));
    page.table(table.finish());
}

/// The value or the range that agrees with a mean.
fn stated(mean: &MeanOfFit) -> String {
    match (mean.from, mean.to) {
        (Some(from), Some(to)) if from == to => short(from),
        (Some(from), Some(to)) => span([from, to]),
        (Some(from), None) => format!("at least {}", short(from)),
        (None, Some(to)) => format!("at most {}", short(to)),
        (None, None) => "-".to_owned(),
    }
}

/// How many means agree with the fit, and which do not; absent without means.
pub(super) fn summary(o: &IdentificationOfSet) -> Option<String> {
    let beyond = o.means.iter().filter(|mean| mean.residual.abs() > AGREES);
    let beyond: Vec<String> = beyond.map(|mean| mean.name.clone()).collect();
    let count = o.means.len();
    match (count, beyond.len()) {
        (0, _) => None,
        (1, 0) => Some("the mean within twice its accuracy".to_owned()),
        (1, _) => Some(format!("the mean {} not within twice its accuracy", listed(&beyond))),
        (_, 0) => Some(format!("all {count} means within twice their accuracy")),
        (_, out) => Some(format!(
            "{} of {count} means within twice their accuracy, not {}",
            count - out,
            listed(&beyond)
        )),
    }
}

/// The same as two numbers: how many agree, of how many.
pub(super) fn agreeing(o: &IdentificationOfSet) -> [usize; 2] {
    let agree = o.means.iter().filter(|mean| mean.residual.abs() <= AGREES);
    [agree.count(), o.means.len()]
}

/// Deviations of the means over their accuracies, before and after the fit.
pub(super) fn picture(name: &str, o: &IdentificationOfSet) -> Figure {
    let interval = |mean: &MeanOfFit| Interval {
        name: mean.name.clone(),
        at: mean.residual,
        ends: None,
        before: Some(mean.residual_before),
    };
    Figure::Intervals {
        title: format!("{name}: deviation of {} from the means", o.model_set),
        x: "deviation over accuracy, 0: in the range".to_owned(),
        marks: vec![-AGREES, AGREES],
        key: ["fitted", "before the fit", "twice the accuracy"].map(str::to_owned),
        list: o.means.iter().map(interval).collect(),
    }
}
