//! The fit of each model set in one sentence.

use gearloss_studies::analyses::identify::{IdentificationOfSet, IdentifyOutcome};

use super::words;
use crate::page::Page;
use crate::text::{brief, of_set, short};

pub fn add(outcome: &IdentifyOutcome, page: &mut Page) {
    let mut sentences = Vec::new();
    for o in &outcome.identifications {
        sentences.push(sentence(o, outcome.identifications.len(), page));
    }
    page.headline = (!sentences.is_empty()).then(|| sentences.join("; "));
}

fn sentence(o: &IdentificationOfSet, sets: usize, page: &mut Page) -> String {
    let set = &o.model_set;
    let mut sentence = of_set(set, sets);
    for (i, quantity) in o.found.quantities().into_iter().enumerate() {
        let (what, unit) = words(quantity);
        let unit = brief(unit);
        let [before, after] = o.found.rms(quantity).map(short);
        let comma = if i > 0 { ", " } else { "" };
        sentence.push_str(&format!("{comma}{what} {before} to {after} {unit} rms"));
        page.key_figure(
            &format!("{what} deviation, {set}"),
            after,
            unit,
            format!("rms; {before} before the fit"),
        );
    }
    let free = o.found.fitted.inference.sized_singular_values().len();
    sentence.push_str(&format!(
        ", {} of {free} combinations of parameters identified",
        o.resolved_combinations
    ));
    let outliers = o.checks.outlier_lines.len();
    if outliers > 0 {
        let plural = if outliers == 1 { "" } else { "s" };
        sentence.push_str(&format!(", {outliers} outlier{plural}"));
    }
    if let Some(p) = o.misfit.probability {
        let p = if p < 0.001 {
            "p < 0.001".to_owned()
        } else {
            format!("p = {p:.2}")
        };
        sentence.push_str(&format!(" ({p})"));
        if o.misfit.probability.is_some_and(|p| p < 0.05) {
            page.careful
                .push(format!("{set} does not fit the points within their accuracy ({p})"));
        }
    }
    let bounded = o.parameters.iter().filter(|parameter| parameter.bound.is_some());
    let bounded: Vec<&str> = bounded.map(|parameter| parameter.name.as_str()).collect();
    if !bounded.is_empty() {
        page.careful
            .push(format!("{set}: at a bound of its range: {}", bounded.join(", ")));
    }
    if o.resolved_combinations < free {
        page.careful.push(format!(
            "{set}: the points identify {} of {free} combinations of the parameters",
            o.resolved_combinations
        ));
    }
    sentence
}
