//! Mean loss, energy and largest share of each cycle, in one sentence.

use gearloss_studies::analyses::cycle::{CycleOutcome, DutyOfSet};

use crate::machines::cautions_of_cycle;
use crate::names::{SetNames, cycle, share};
use crate::page::Page;
use crate::text::{figures, in_brackets, short};

/// Share of the consumption above which missing energy is a warning; the details state any.
const NOTICED: f64 = 1e-3;

pub fn add(outcome: &CycleOutcome, page: &mut Page) {
    let mut words = Vec::new();
    let names = SetNames::new(outcome.cycles.iter().map(|duty| duty.model_set.as_str()));
    let several = outcome
        .cycles
        .iter()
        .any(|duty| duty.model_set != outcome.cycles[0].model_set);
    for duty in &outcome.cycles {
        let of = if several {
            format!("{} with {}", cycle(&duty.cycle), names.quoted(&duty.model_set))
        } else {
            cycle(&duty.cycle)
        };
        let mut words_of_set = format!("{} W over {of}", short(duty.mean_loss_w));
        let mut details = Vec::new();
        if let Some(per) = &duty.per_distance {
            words_of_set = format!(
                "{} W ({} Wh/km) over {of}",
                short(duty.mean_loss_w),
                short(per.loss_wh_per_km)
            );
            details.push(format!("{} Wh/km", short(per.loss_wh_per_km)));
        }
        if let Some((name, percent)) = largest(duty) {
            let name = share(name);
            words_of_set.push_str(&format!(", {} % of it in the {name}", short(percent)));
            details.push(format!("{} % {name}", short(percent)));
        }
        words_of_set.push_str(&against_reference(duty));
        if let (Some(band), None) = (&duty.bands, &duty.reference) {
            let [low, _, high] = band.mean_loss_w.map(short);
            words_of_set.push_str(&format!(" (95 %: {low} to {high} W)"));
        }
        if let Some(reference) = &duty.reference {
            let source = reference.source.as_deref().unwrap_or("reference");
            details.push(format!("{} W: {source}", short(reference.mean_loss_w)));
        }
        if let Some(band) = &duty.bands {
            let [low, _, high] = band.mean_loss_w.map(short);
            details.push(format!("95 %: {low} to {high} W"));
            if band.reference_inside == Some(false) {
                page.careful.push(format!(
                    "{of}: the reference is outside the 95 % band of {low} to {high} W"
                ));
            }
        }
        if let Some(consumption) = &duty.consumption {
            let value = figures(consumption.consumption_kwh_per_100_km, 4);
            let band = duty.bands.as_ref().and_then(|band| band.consumption_kwh_per_100_km);
            let band = band.map(|[low, _, high]| format!("95 %: {} to {}", figures(low, 4), figures(high, 4)));
            let in_band = in_brackets(band.as_deref().unwrap_or_default());
            words_of_set.push_str(&format!("; consumption {value} kWh/100 km{in_band}"));
            let range = consumption.range_km.map(|km| format!("range {} km", short(km)));
            let lost = consumption.range_lost_in_transmission_km;
            let lost = lost.map(|km| format!("{} km lost in the transmission", short(km)));
            let details: Vec<String> = [band, range, lost].into_iter().flatten().collect();
            page.key_figure(&format!("consumption, {of}"), value, "kWh/100 km", details.join("; "));
        }
        if let (Some(gears), Some(shares)) = (&duty.gears_used, super::gears::words(duty)) {
            let shifts = gears.shifts.map_or_else(|| "-".to_owned(), |shifts| shifts.to_string());
            page.key_figure(&format!("shifts, {of}"), shifts, "", shares);
        }
        words.push(words_of_set);
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
        if let Some(consumption) = &duty.consumption {
            let lacking = consumption.lacking_kwh_per_100_km + consumption.shortfall_kwh_per_100_km;
            if lacking > NOTICED * consumption.consumption_kwh_per_100_km.abs() {
                page.careful.push(format!(
                    "{of}: the vehicle cannot follow the cycle: it lacks {} kWh/100 km, which its consumption of {} kWh/100 km does not contain",
                    short(lacking),
                    figures(consumption.consumption_kwh_per_100_km, 4)
                ));
            }
        }
        let cautions = duty
            .machines
            .iter()
            .flat_map(|machine| cautions_of_cycle(machine, duty.duration_s));
        let cautions: Vec<String> = cautions.map(|text| format!("{of}: {text}")).collect();
        page.careful.extend(cautions);
    }
    page.headline = (!words.is_empty()).then(|| format!("Mean loss {}", words.join("; ")));
}

/// The deviation from a published value, and whether that is inside the band.
fn against_reference(duty: &DutyOfSet) -> String {
    let Some(reference) = &duty.reference else {
        return String::new();
    };
    let percent = 100.0 * (duty.mean_loss_w / reference.mean_loss_w - 1.0);
    let side = if percent < 0.0 { "below" } else { "above" };
    let band = duty.bands.as_ref().and_then(|band| {
        let [low, _, high] = band.mean_loss_w.map(short);
        let inside = if band.reference_inside? { "inside" } else { "outside" };
        Some(format!(", which is {inside} the 95 % band of {low} to {high} W"))
    });
    format!(
        ", {} % {side} the {} W of {}{}",
        short(percent.abs()),
        short(reference.mean_loss_w),
        reference.source.as_deref().unwrap_or("the reference"),
        band.unwrap_or_default()
    )
}

/// The largest share of the loss, in percent.
fn largest(duty: &DutyOfSet) -> Option<(&str, f64)> {
    let shares = duty.shares.iter().zip(&duty.energies_j);
    let (name, joule) = shares.max_by(|a, b| a.1.total_cmp(b.1))?;
    (duty.energy.loss_j > 0.0).then(|| (name.as_str(), 100.0 * joule / duty.energy.loss_j))
}
