//! The change of the loss over the values, in one sentence.

use gearloss_studies::analyses::numbers::word;
use gearloss_studies::analyses::sweep::{SweepOfValue, SweepOutcome};

use crate::names::{listed, quantity};
use crate::page::Page;
use crate::text::{extremes, of_set, short, signed};

pub fn add(outcome: &SweepOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for own in &outcome.notes {
        let set = &own.model_set;
        let mean = |value: &SweepOfValue| {
            let losses: Option<Vec<f64>> = value.points.iter().map(|point| point.loss_w).collect();
            losses.map(|losses| losses.iter().sum::<f64>() / losses.len() as f64)
        };
        let values = outcome
            .values_of_set(set)
            .filter_map(|value| Some((mean(value)?, value)));
        let Some([low, high]) = extremes(values) else { continue };
        let at = |value: &SweepOfValue| {
            let second = value
                .second
                .as_ref()
                .map_or_else(String::new, |second| format!(" and {}", word(&second.value)));
            format!("{}{second}", word(&value.value))
        };
        let change = if high.0 > 0.0 {
            100.0 * (low.0 / high.0 - 1.0)
        } else {
            0.0
        };
        words.push(format!(
            "{}the mean loss is {} W at {} and {} W at {} ({} %)",
            of_set(set, outcome.notes.len()),
            short(low.0),
            at(low.1),
            short(high.0),
            at(high.1),
            signed(change)
        ));
        page.key_figure(&format!("least mean loss, {set}"), short(low.0), "W", at(low.1));
        page.key_figure(&format!("largest mean loss, {set}"), short(high.0), "W", at(high.1));
    }
    let first = outcome.sweep.first();
    let second = first.and_then(|value| Some(quantity(&value.second.as_ref()?.path)));
    let paths = first.map(|value| quantity(&value.path)).into_iter().chain(second);
    let paths = listed(&paths.collect::<Vec<_>>());
    page.headline = (!words.is_empty()).then(|| format!("Over the {paths}: {}", words.join("; ")));
}
