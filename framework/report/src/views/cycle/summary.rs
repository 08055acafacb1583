//! Mean loss, energy and largest share of each cycle, in one sentence.

use gearloss_studies::analyses::cycle::{CycleOutcome, DutyOfSet};

use crate::page::Page;
use crate::text::{short, signed};

pub fn add(outcome: &CycleOutcome, page: &mut Page) {
    let mut words = Vec::new();
    let several = outcome
        .cycles
        .iter()
        .any(|duty| duty.model_set != outcome.cycles[0].model_set);
    for duty in &outcome.cycles {
        let of = if several {
            format!("{}, {}", duty.cycle, duty.model_set)
        } else {
            duty.cycle.clone()
        };
        let mut own = format!("{of}: {} W", short(duty.mean_loss_w));
        let mut details = Vec::new();
        if let Some(per) = &duty.per_distance {
            own.push_str(&format!(" or {} Wh/km", short(per.loss_wh_per_km)));
            details.push(format!("{} kWh/100 km", short(per.loss_kwh_per_100_km)));
        }
        if let Some((name, share)) = largest(duty) {
            own.push_str(&format!(", {} % of it {name}", short(share)));
            details.push(format!("{} % {name}", short(share)));
        }
        if let Some(reference) = &duty.reference {
            let ratio = 100.0 * (duty.mean_loss_w / reference.mean_loss_w - 1.0);
            own.push_str(&format!(" ({} W in the reference)", short(reference.mean_loss_w)));
            details.push(format!("{} % to the reference", signed(ratio)));
        }
        if let Some(band) = &duty.bands {
            let [low, _, high] = band.mean_loss_w.map(short);
            details.push(format!("95 %: {low} to {high} W"));
            if band.reference_inside == Some(false) {
                page.careful.push(format!(
                    "{of}: the reference lies outside the band of {low} to {high} W"
                ));
            }
        }
        words.push(own);
        page.key_figure(
            &format!("mean loss, {of}"),
            short(duty.mean_loss_w),
            "W",
            details.join("; "),
        );
        if let Some(broken) = &duty.broken {
            page.careful
                .push(format!("{of} ends at {} s: {}", short(broken.time_s), broken.reason));
        }
        if duty.motors_beyond_map {
            page.careful.push(format!("{of}: a motor was outside its map"));
        }
    }
    page.headline = (!words.is_empty()).then(|| format!("mean loss over {}", words.join("; ")));
}

/// The largest share of the loss, in percent.
fn largest(duty: &DutyOfSet) -> Option<(&str, f64)> {
    let shares = duty.shares.iter().zip(&duty.energies_j);
    let (name, joule) = shares.max_by(|a, b| a.1.total_cmp(b.1))?;
    (duty.energy.loss_j > 0.0).then(|| (name.as_str(), 100.0 * joule / duty.energy.loss_j))
}
