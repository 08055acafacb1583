//! Losses and temperatures of all points in one sentence.

use gearloss_studies::analyses::common::measurable::is_measurable;
use gearloss_studies::analyses::operating_points::{OperatingPoint, OperatingPointsOutcome};
use gearloss_studies::numbers::tidy;

use crate::names::share;
use crate::page::Page;
use crate::text::{extremes, label_of_set, of_set, place, range, short, signed};

pub fn add(outcome: &OperatingPointsOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for points_of_set in &outcome.operating_points {
        let (set, points) = (&points_of_set.model_set, &points_of_set.points);
        let ends = |value: fn(&OperatingPoint) -> Option<f64>| {
            extremes(points.iter().filter_map(move |point| Some((value(point)?, point))))
        };
        let label = |name: &str| label_of_set(name, set, outcome.operating_points.len());
        let is_one = points.len() == 1;
        let at = |which: &str, point: &OperatingPoint| {
            let at = place(tidy(point.torque_nm), point.speed_rpm);
            if is_one {
                format!("at {at}")
            } else {
                format!("{which} at point {}: {at}", point.name)
            }
        };
        let mut found = Vec::new();
        if let Some([low, high]) = ends(|point| point.loss_w) {
            let parts = high
                .1
                .losses_w
                .as_deref()
                .map(|losses| leading(&points_of_set.shares, losses));
            let parts = parts.filter(|parts| !parts.is_empty());
            let which = if is_one { "" } else { "at the highest loss: " };
            let parts = parts.map_or_else(String::new, |parts| format!(" ({which}{parts})"));
            found.push(format!("loss {} W{parts}", range(low.0, high.0, 1)));
            page.key_figure(&label("loss"), range(low.0, high.0, 1), "W", at("largest", high.1));
        }
        if let Some([low, high]) = ends(|point| point.oil_temperature_degc) {
            found.push(format!("oil {} °C", range(low.0, high.0, 1)));
            let value = range(low.0, high.0, 1);
            page.key_figure(&label("oil temperature"), value, "°C", at("highest", high.1));
        }
        let deviation = |point: &OperatingPoint| {
            let (loss, seen) = (point.loss_w?, point.measured.loss_w?);
            is_measurable(seen, loss).then(|| 100.0 * (loss / seen - 1.0))
        };
        let deviations: Vec<f64> = points.iter().filter_map(deviation).collect();
        if !deviations.is_empty() {
            let count = deviations.len() as f64;
            let mean = deviations.iter().sum::<f64>() / count;
            let rms = (deviations.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
            found.push(format!(
                "{} % relative to the measured loss on average ({} % rms)",
                signed(mean),
                short(rms)
            ));
            page.key_figure(
                &label("deviation from the measured loss"),
                short(rms),
                "%",
                format!("rms; mean {} %", signed(mean)),
            );
        }
        if !found.is_empty() {
            let start = if words.is_empty() {
                match points.len() {
                    1 => "At the operating point ".to_owned(),
                    count => format!("At {count} operating points "),
                }
            } else {
                String::new()
            };
            let start = format!("{start}{}", of_set(set, outcome.operating_points.len()));
            words.push(format!("{}: {}", start.trim_end(), found.join(", ")));
        }
        let missing = points.iter().filter(|point| point.loss_w.is_none()).count();
        if missing > 0 {
            page.careful
                .push(format!("{set}: {missing} points have no defined loss"));
        }
    }
    page.headline = (!words.is_empty()).then(|| words.join("; "));
}

/// The two largest shares of a loss.
fn leading(names: &[String], losses: &[f64]) -> String {
    let total: f64 = losses.iter().sum();
    let mut order: Vec<(&String, f64)> = names.iter().zip(losses.iter().copied()).collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let words = order.into_iter().take(2).filter(|(_, watts)| *watts > 0.0);
    let words: Vec<String> = words
        .map(|(name, watts)| format!("{} {} %", share(name), short(100.0 * watts / total)))
        .collect();
    words.join(", ")
}
