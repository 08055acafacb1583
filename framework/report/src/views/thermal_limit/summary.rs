//! The limits of the first gear set in one sentence.

use gearloss_framework::thermal::Limit;
use gearloss_studies::analyses::thermal_limit::{Find, ThermalLimit, ThermalLimitOutcome};

use crate::page::Page;
use crate::text::short;

pub fn add(outcome: &ThermalLimitOutcome, page: &mut Page) {
    let Some(of_set) = outcome.thermal_limits.first() else {
        return;
    };
    let find = |limit: &ThermalLimit| match of_set.find {
        Find::Torque => limit.torque_nm,
        Find::Speed => limit.solved_speed_rpm,
    };
    let given = |limit: &ThermalLimit| match of_set.find {
        Find::Torque => limit.solved_speed_rpm,
        Find::Speed => limit.torque_nm,
    };
    let (unit, along) = match of_set.find {
        Find::Torque => ("Nm", "rpm"),
        Find::Speed => ("rpm", "Nm"),
    };
    // The middle of the axis stands for all.
    let mut places: Vec<f64> = of_set.limits.iter().filter_map(given).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let Some(middle) = places.get(places.len() / 2) else {
        return;
    };
    let there = of_set.limits.iter().filter(|limit| given(limit) == Some(*middle));
    let (mut reached, mut others) = (Vec::new(), Vec::new());
    for limit in there {
        let degrees = format!("{} °C", short(limit.limit_degc));
        match find(limit) {
            Some(value) => {
                reached.push(format!("{degrees} at {} {unit}", short(value)));
                page.key_figure(
                    &format!("{degrees} reached at"),
                    short(value),
                    unit,
                    format!("{} {along}", short(*middle)),
                );
            }
            None => others.push(format!("{degrees} {}", without_value(limit.outcome, of_set.find))),
        }
    }
    let mut clauses = Vec::new();
    if !reached.is_empty() {
        clauses.push(format!("the oil would reach {}", reached.join(", ")));
    }
    clauses.extend(others);
    page.headline = Some(format!("At {} {along} {}", short(*middle), clauses.join("; ")));
}

/// An outcome without a value, as the predicate of a temperature.
fn without_value(outcome: &str, find: Find) -> String {
    let unknown = match find {
        Find::Torque => "torques",
        Find::Speed => "speeds",
    };
    if outcome == Limit::NotReached.name() {
        format!("is not reached in the range of {unknown}")
    } else if outcome == Limit::ExceededFromTheStart.name() {
        format!("is exceeded from the start of the range of {unknown}")
    } else {
        "has no limit, because losses or heat have no value".to_owned()
    }
}
