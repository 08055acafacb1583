//! The width of the bands, and the input with the strongest correlation.

use gearloss_studies::analyses::uncertainty::{PointOfBand, UncertaintyOutcome};
use gearloss_studies::numbers::tidy;

use crate::names::quantity;
use crate::page::Page;
use crate::text::{extremes, label_of_set, of_set, place, range, short};

/// The largest correlation that chance gives among unrelated inputs in this number of samples, with a probability of at least 95 %: Fisher's
/// transformation, with the tail of the normal distribution bounded by exp(-x^2/2).
fn largest_by_chance(samples: f64, inputs: f64) -> f64 {
    let x = (2.0 * (inputs / 0.05).ln()).sqrt();
    (x / (samples - 3.0).max(1.0).sqrt()).tanh()
}

pub fn add(outcome: &UncertaintyOutcome, page: &mut Page) {
    let (mut words, mut correlations) = (Vec::new(), Vec::new());
    for set in &outcome.bands {
        let label = |name: &str| label_of_set(name, &set.model_set, outcome.bands.len());
        let half = |value: fn(&PointOfBand) -> Option<f64>| {
            extremes(set.points.iter().filter_map(move |point| Some((value(point)?, point))))
        };
        let mut found = Vec::new();
        let at = |point: &PointOfBand| place(tidy(point.torque_nm), tidy(point.speed_rpm));
        if let Some([low, high]) = half(|point| point.efficiency_percent.half_width()) {
            found.push(format!(
                "the efficiency is known to ±{} points, widest at {}",
                range(low.0, high.0, 2),
                at(high.1)
            ));
            page.key_figure(
                &label("widest band of the efficiency"),
                format!("±{}", short(high.0)),
                "points",
                at(high.1),
            );
        }
        if let Some([low, high]) = half(|point| point.loss_w.half_width()) {
            found.push(format!("the loss is known to ±{} W", range(low.0, high.0, 1)));
            page.key_figure(
                &label("widest band of the loss"),
                format!("±{}", short(high.0)),
                "W",
                at(high.1),
            );
        }
        let strongest = set.inputs.first();
        if let Some((input, strength)) = strongest.and_then(|i| Some((i, i.correlation_with_mean_loss?))) {
            let of = of_set(&set.model_set, outcome.bands.len());
            let chance = largest_by_chance(set.samples as f64, set.inputs.len() as f64);
            if strength.abs() > chance {
                let (name, strength) = (quantity(&input.path), short(strength));
                correlations.push(format!("{strength} ({name}) {of}").trim_end().to_owned());
                let detail = format!("of the mean loss with the {name}");
                page.key_figure(&label("strongest correlation"), strength, "", detail);
            } else {
                let samples = set.samples;
                correlations.push(
                    format!(
                        "no larger than chance gives with {samples} samples ({}) {of}",
                        short(chance)
                    )
                    .trim_end()
                    .to_owned(),
                );
            }
        }
        if set.failed > 0 {
            page.careful
                .push(format!("{}: {} samples have no value", set.model_set, set.failed));
        }
        if !found.is_empty() {
            words.push(of_set(&set.model_set, outcome.bands.len()) + &found.join(", "));
        }
    }
    let bands = (!words.is_empty()).then(|| format!("With 95 % confidence: {}", words.join("; ")));
    let correlations = (!correlations.is_empty()).then(|| {
        format!(
            "The strongest correlation of an input with the mean loss is {}",
            correlations.join(", ")
        )
    });
    let sentences: Vec<String> = [bands, correlations].into_iter().flatten().collect();
    page.headline = (!sentences.is_empty()).then(|| sentences.join(". "));
}
