//! The oil with the least loss in one sentence.

use gearloss_studies::analyses::fluid_sweep::{FluidSweepOutcome, FluidsOfDuty, FluidsOfSet, LossOfFluid};

use crate::names::{cycle, listed, quantity};
use crate::page::Page;
use crate::text::short;

pub fn add(outcome: &FluidSweepOutcome, page: &mut Page) {
    let mut words = Vec::new();
    let several = outcome.fluid_sweep.len() > 1;
    for set in &outcome.fluid_sweep {
        for duty in &set.cycles {
            let least = &duty.least;
            let of = if several {
                format!("{}, {}", cycle(&duty.cycle), set.model_set)
            } else {
                cycle(&duty.cycle)
            };
            let end = if least.at_end_of_range {
                "at the end of the range; "
            } else {
                ""
            };
            let flat = least.flat_range.map(short);
            let present = duty.present.value.map_or_else(String::new, |value| {
                format!(
                    "; {} W with the present {}",
                    short(duty.present.mean_loss_w),
                    short(value)
                )
            });
            words.push(format!(
                "{} {} over {of} ({end}{} W{present}; within 1 % of it from {} to {})",
                short(least.value),
                set.unit,
                short(least.mean_loss_w),
                flat[0],
                flat[1]
            ));
            let detail = format!(
                "{} W{present}; within 1 % from {} to {}",
                short(least.mean_loss_w),
                flat[0],
                flat[1]
            );
            page.key_figure(
                &format!("best {}, {of}", property(set)),
                short(least.value),
                set.unit,
                detail,
            );
            if let (Some(used), Some(now)) = (duty.least_consumption, duty.present.consumption) {
                page.key_figure(
                    &format!("least consumption, {of}"),
                    short(used.consumption_kwh_per_100_km),
                    "kWh/100 km",
                    format!(
                        "{} {}; {} kWh/100 km with the present oil",
                        short(used.value),
                        set.unit,
                        short(now.consumption_kwh_per_100_km)
                    ),
                );
            }
            if least.at_end_of_range {
                page.careful
                    .push(format!("{of}: the lowest loss is at the end of the range of oils"));
            }
            limits(set, duty, &of, page);
        }
        if set
            .cycles
            .iter()
            .flat_map(|duty| &duty.fluids)
            .any(|fluid| fluid.beyond_definition)
        {
            page.careful.push(
                "below 2 mm2/s the viscosity index is not defined; its law for thicker oils is extrapolated".to_owned(),
            );
        }
    }
    let property = outcome.fluid_sweep.first().map(property).unwrap_or_default();
    page.headline = (!words.is_empty()).then(|| {
        let start = outcome.start_degc;
        let start = start.map_or_else(
            || "The".to_owned(),
            |start| format!("With a start at {} °C, the", short(start)),
        );
        format!(
            "{start} {property} with the lowest loss is {}{}",
            listed(&words),
            in_common(outcome)
        )
    });
}

/// The best oil that keeps all limits, where the best of all does not.
fn limits(set: &FluidsOfSet, duty: &FluidsOfDuty, of: &str, page: &mut Page) {
    if set.limits.is_empty() {
        return;
    }
    let near = |fluid: &&LossOfFluid| (fluid.value / duty.least.value - 1.0).abs() < 0.01;
    let best = duty.fluids.iter().find(near);
    if best.is_some_and(|fluid| fluid.keeps_limits) {
        return;
    }
    let broken: Vec<String> = set
        .limits
        .iter()
        .enumerate()
        .filter(|(i, limit)| {
            let value = best.and_then(|fluid| fluid.limited[*i]);
            value.is_none_or(|value| limit.least.is_some_and(|x| value < x) || limit.most.is_some_and(|x| value > x))
        })
        .map(|(_, limit)| format!("`{}`", limit.limit))
        .collect();
    match duty.least_within_limits {
        Some(fluid) => {
            page.careful.push(format!(
                "{of}: the oil with the lowest loss breaks {}; {} {} is the best that keeps all limits ({} W)",
                listed(&broken),
                short(fluid.value),
                set.unit,
                short(fluid.mean_loss_w)
            ));
            let label = format!("best {} within limits, {of}", property(set));
            page.key_figure(
                &label,
                short(fluid.value),
                set.unit,
                format!("{} W", short(fluid.mean_loss_w)),
            );
        }
        None => page.careful.push(format!("{of}: no oil keeps {}", listed(&broken))),
    }
}

/// Values whose loss is within one percent of the lowest over every cycle.
fn in_common(outcome: &FluidSweepOutcome) -> String {
    let [set] = &outcome.fluid_sweep[..] else {
        return String::new();
    };
    if set.cycles.len() < 2 {
        return String::new();
    }
    let ends = set.cycles.iter().map(|duty| duty.least.flat_range);
    let [low, high] = ends.fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], [from, to]| {
        [low.max(from), high.min(to)]
    });
    if low <= high {
        format!(
            "; {} to {} {} is within 1 % of the lowest loss over every cycle",
            short(low),
            short(high),
            set.unit
        )
    } else {
        "; no single value is within 1 % of the lowest loss over every cycle".to_owned()
    }
}

/// The swept property in words, without its unit.
fn property(set: &FluidsOfSet) -> String {
    let name = set.property.split([' ', ',']).next().unwrap_or_default();
    quantity(name)
}
