//! The fit of each model set in one sentence.

use gearloss_framework::resolve::OWN_MODELS;
use gearloss_studies::analyses::identify::{IdentificationOfSet, IdentifyOutcome};
use gearloss_studies::study::Quantity;

use super::{means, measured, words};
use crate::names::listed;
use crate::page::Page;
use crate::text::{again, short, words_of_set};

/// Probability below which a misfit is significant.
const SIGNIFICANT: f64 = 0.05;

pub fn add(outcome: &IdentifyOutcome, page: &mut Page) {
    let mut sentences = Vec::new();
    let mut after_misfit = false;
    for o in &outcome.identifications {
        sentences.push(sentence(o, after_misfit, page));
        after_misfit = misfits(o);
    }
    page.headline = (!sentences.is_empty()).then(|| sentences.join("; "));
}

/// Whether the points contradict a set.
fn misfits(o: &IdentificationOfSet) -> bool {
    o.misfit.probability.is_some_and(|p| p < SIGNIFICANT)
}

/// `after_misfit`: whether the set before does not fit.
fn sentence(o: &IdentificationOfSet, after_misfit: bool, page: &mut Page) -> String {
    let set = &o.model_set;
    let is_misfit = misfits(o);
    let fits = match o.misfit.probability {
        Some(_) if is_misfit => "does not agree with the data",
        Some(_) => "agrees with the data within its accuracy",
        None => "is fitted",
    };
    let probability = o.misfit.probability.map_or_else(String::new, |p| {
        let p = if p < 0.001 {
            "p < 0.001".to_owned()
        } else {
            format!("p = {p:.2}")
        };
        format!(" ({p})")
    });
    if is_misfit {
        page.careful.push(format!("{set} {fits}{probability}"));
    }
    let named = if set == OWN_MODELS {
        "`own` (the models of the gearbox)".to_owned()
    } else {
        format!("`{set}`")
    };
    let mut sentence = match (is_misfit, after_misfit) {
        (true, true) => format!("nor does {named}{probability}"),
        _ => format!("{named} {fits}{probability}"),
    };
    for (i, quantity) in o.found.quantities().into_iter().enumerate() {
        let (what, unit) = words(quantity);
        let [before, after] = o.found.rms(quantity).map(short);
        sentence.push_str(&format!(
            "{} rms deviation of the {what} {after}{} ({before} before the fit)",
            if i == 0 { ":" } else { "," },
            if after_misfit { again(unit) } else { format!(" {unit}") }
        ));
        page.key_figure(
            &format!("{what} deviation, {}", words_of_set(set)),
            after,
            unit,
            format!("rms; {before} before the fit"),
        );
    }
    if let Some(words) = means::summary(o) {
        sentence.push_str(if o.points.is_empty() { ": " } else { ", " });
        sentence.push_str(&words);
        let [agree, count] = means::agreeing(o);
        page.key_figure(
            &format!("means that agree, {}", words_of_set(set)),
            agree.to_string(),
            "",
            format!(
                "of {count}, within twice {} accuracy",
                if count == 1 { "its" } else { "their" }
            ),
        );
    }
    if let Some(prediction) = held_out(o, page) {
        sentence.push_str(&format!(", {prediction}"));
    }
    let free = o.found.fitted.inference.sized_singular_values().len();
    if !is_misfit {
        sentence.push_str(&format!(
            "; {} of {free} combinations of inputs identified",
            o.resolved_combinations
        ));
    }
    let bounded = o.parameters.iter().filter(|parameter| parameter.bound.is_some());
    let bounded: Vec<String> = bounded.map(|parameter| parameter.name.clone()).collect();
    if !bounded.is_empty() {
        if !is_misfit {
            sentence.push_str(&format!(", but {}", at_bound(&bounded)));
        }
        page.careful.push(format!("{set}: {}", at_bound(&bounded)));
    }
    if o.resolved_combinations < free {
        page.careful.push(format!(
            "{set}: the {} identify {} of {free} combinations of the parameters",
            measured(o),
            o.resolved_combinations
        ));
    }
    sentence
}

/// Says that parameters are at bounds of their ranges.
fn at_bound(names: &[String]) -> String {
    let end = if names.len() == 1 {
        "is at a bound of its range"
    } else {
        "are at bounds of their ranges"
    };
    format!("{} {end}", listed(names))
}

/// The errors of the predictions of held-out rows.
fn held_out(o: &IdentificationOfSet, page: &mut Page) -> Option<String> {
    let held = o.hold_out.as_ref()?;
    let errors = held.quantities.iter().filter_map(|predicted| {
        let (what, unit) = words(predicted.errors.quantity);
        let errors = predicted.held_out.as_ref()?;
        let percent = errors
            .in_percent
            .as_ref()
            .filter(|_| predicted.errors.quantity != Quantity::Efficiency)
            .map_or_else(String::new, |percent| format!(" or {} %", short(percent.rms)));
        page.key_figure(
            &format!("{what}, held out, {}", words_of_set(&o.model_set)),
            short(errors.rms),
            unit,
            format!("rms{percent} at {} points ({})", errors.points, held.chosen_by),
        );
        Some(format!(
            "{}{}{percent} at the held-out points ({})",
            short(errors.rms),
            again(unit),
            held.chosen_by
        ))
    });
    let errors: Vec<String> = errors.collect();
    (!errors.is_empty()).then(|| errors.join(", "))
}
