//! The change of the loss over the values, in one sentence.

use gearloss_studies::analyses::sweep::{PointOfSweep, SweepOfValue, SweepOutcome};
use gearloss_studies::numbers::word;

use crate::names::{listed, of_component, quantity};
use crate::page::Page;
use crate::text::{extremes, label_of_set, of_set, short, with_printed_units};

/// Most values that the sentence names.
const NAMED: usize = 6;

pub fn add(outcome: &SweepOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for notes in &outcome.notes {
        let set = &notes.model_set;
        let mean = |value: &SweepOfValue| {
            let losses: Option<Vec<f64>> = value.points.iter().map(|point| point.loss_w).collect();
            losses.map(|losses| losses.iter().sum::<f64>() / losses.len() as f64)
        };
        let values = outcome
            .values_of_set(set)
            .filter_map(|value| Some((mean(value)?, value)));
        let values: Vec<(f64, &SweepOfValue)> = values.collect();
        let Some([low, high]) = extremes(values.iter().copied()) else {
            continue;
        };
        let at = |value: &SweepOfValue| {
            let second = value
                .second
                .as_ref()
                .map_or_else(String::new, |second| format!(" and {}", word(&second.value)));
            with_printed_units(&format!("{}{second}", word(&value.value)))
        };
        let change = if high.0 > 0.0 {
            100.0 * (1.0 - low.0 / high.0)
        } else {
            0.0
        };
        let of = of_set(set, outcome.notes.len());
        words.push(if values.len() <= NAMED {
            let each = values
                .iter()
                .map(|(loss, value)| format!("{} W at {}", short(*loss), at(value)));
            format!("{of}{}", listed(&each.collect::<Vec<_>>()))
        } else {
            format!(
                "{of}lowest at {} with {} W, {} % below the {} W at {}",
                at(low.1),
                short(low.0),
                short(change),
                short(high.0),
                at(high.1)
            )
        });
        cards(outcome, set, low, high, &at(low.1), &at(high.1), page);
    }
    let first = outcome.sweep.first();
    let second = first.and_then(|value| Some(quantity(&value.second.as_ref()?.path)));
    let paths = first.map(|value| quantity(&value.path)).into_iter().chain(second);
    let paths = listed(&paths.collect::<Vec<_>>());
    page.headline = (!words.is_empty()).then(|| format!("Mean loss by {paths}: {}", words.join("; ")));
}

/// What the value with the lowest loss reaches: its loss, oil temperature and limited quantities.
fn cards(
    outcome: &SweepOutcome,
    set: &str,
    (low, best): (f64, &SweepOfValue),
    (high, _): (f64, &SweepOfValue),
    at: &str,
    at_high: &str,
    page: &mut Page,
) {
    let label = |name: &str| label_of_set(name, set, outcome.notes.len());
    let at = format!("at {at}");
    let detail = if low < high {
        format!("{at}; {} W at {at_high}", short(high))
    } else {
        at.clone()
    };
    page.key_figure(&label("lowest mean loss"), short(low), "W", detail);
    let largest = |read: &dyn Fn(&PointOfSweep) -> Option<f64>, sign: f64| {
        let values = best.points.iter().filter_map(read);
        values.max_by(|a, b| (sign * a).total_cmp(&(sign * b)))
    };
    // A given temperature has no balance, and is no result.
    let is_result = best.points.iter().any(|point| point.balance.is_some());
    if let (true, Some(oil)) = (is_result, largest(&|point| point.oil_temperature_degc, 1.0)) {
        page.key_figure(&label("oil temperature"), short(oil), "°C", at.as_str());
    }
    for column in &outcome.limits {
        let limits = &outcome.head.study_limits;
        let least = limits
            .iter()
            .any(|reached| reached.limit == column.name && reached.least.is_some());
        let sign = if least { -1.0 } else { 1.0 };
        let value = largest(&|point| point.limit_values.get(&column.name).copied().flatten(), sign);
        if let Some(value) = value.filter(|_| !column.is_of_oil) {
            let unit = if column.unit == "-" { "" } else { column.unit };
            page.key_figure(&label(&of_component(&column.words)), short(value), unit, at.as_str());
        }
    }
}
