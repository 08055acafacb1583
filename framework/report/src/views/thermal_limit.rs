//! Thermal limits: a table for each model set; figures of the limit and the output power over speed or torque.

mod summary;

use gearloss_framework::thermal::Limit;
use gearloss_studies::analyses::thermal_limit::{Find, ThermalLimit, ThermalLimitOutcome, ThermalLimitsOfSet};
use gearloss_studies::distinct::distinct;

use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number};
use crate::unit;

register_view!(ThermalLimitOutcome, show);

fn show(outcome: &ThermalLimitOutcome, page: &mut Page) {
    summary::add(outcome, page);
    for of_set in &outcome.thermal_limits {
        page.line(format!("{}: models {}", outcome.head.analysis, of_set.model_set));
        table(of_set, page);
        page.line("");
    }
    figures(outcome, page);
}

/// The limits of one set with notes.
fn table(of_set: &ThermalLimitsOfSet, page: &mut Page) {
    let has_unit = of_set.limits.iter().any(|limit| limit.unit.is_some());
    let table = TextTable::of(&of_set.limits)
        .column("oil degC", |limit| number(Some(limit.limit_degc), 1))
        .column("speed rpm", |limit| number(limit.solved_speed_rpm, 1))
        .column("torque Nm", |limit| number(limit.torque_nm, 3))
        .column("outcome", |limit| limit.outcome.replace('_', " "))
        .column("loss W", |limit| number(limit.loss_w, 2))
        .column("output W", |limit| number(limit.output_w, 1))
        .each(unit::columns(has_unit), |table, (head, cell)| {
            table.column(head, |limit| cell(limit.unit.as_ref()))
        });
    page.table(table.finish());
    // If losses increase with temperature, a lower steady temperature may exist.
    let is_lower = |limit: &&ThermalLimit| limit.lowest_balance_degc.is_some_and(|t| t < limit.limit_degc - 0.01);
    let lower = of_set.limits.iter().filter(is_lower).count();
    if lower > 0 {
        page.line(format!(
            "{lower} of these points also have a steady state at a lower temperature"
        ));
    }
    let is_exceeded = |limit: &ThermalLimit| limit.outcome == Limit::ExceededFromTheStart.name();
    if of_set.find == Find::Torque && of_set.limits.iter().any(is_exceeded) {
        page.line(
            "if the limit is exceeded from the start, the losses at the first torque of the range are already too high",
        );
    }
    page.line("");
}

/// The limit and the output power over the given quantity: a line for each set and temperature.
fn figures(outcome: &ThermalLimitOutcome, page: &mut Page) {
    let (mut limits, mut powers) = (Vec::new(), Vec::new());
    for of_set in &outcome.thermal_limits {
        for temperature in temperatures(of_set) {
            let name = if outcome.thermal_limits.len() > 1 {
                format!("{} {temperature} degC", of_set.model_set)
            } else {
                format!("{temperature} degC")
            };
            let limited = of_set.limits.iter().filter(|limit| limit.limit_degc == temperature);
            let line = |y: &dyn Fn(&ThermalLimit) -> Option<f64>| Line {
                name: name.clone(),
                points: limited
                    .clone()
                    .map(|limit| {
                        let x = match of_set.find {
                            Find::Torque => limit.solved_speed_rpm,
                            Find::Speed => limit.torque_nm,
                        };
                        Some((x?, y(limit)?))
                    })
                    .collect(),
                stroke: Stroke::Marked,
            };
            limits.push(line(&|limit| match of_set.find {
                Find::Torque => limit.torque_nm,
                Find::Speed => limit.solved_speed_rpm,
            }));
            powers.push(line(&|limit| limit.output_w.or(limit.input_w)));
        }
    }
    let name = &outcome.head.analysis;
    let conditions = &outcome.head.conditions;
    let torque = format!("torque at {} in Nm", conditions.torque_at);
    let speed = format!("speed at {} in rpm", conditions.speed_at);
    let find = outcome.thermal_limits.first().map(|of_set| of_set.find);
    let (x, y, title) = match find.unwrap_or_default() {
        Find::Torque => (speed, torque, "torque at which the oil reaches a temperature"),
        Find::Speed => (torque, speed, "speed at which the oil reaches a temperature"),
    };
    let figure = |title: &str, y: String, lines: Vec<Line>| Figure::Lines {
        title: format!("{name}: {title}"),
        x: x.clone(),
        y,
        lines,
    };
    page.figure(name, figure(title, y, limits));
    let title = "output power at which the oil reaches a temperature";
    page.figure(format!("{name}-power"), figure(title, "power in W".to_owned(), powers));
}

/// The distinct temperatures of the limits.
fn temperatures(of_set: &ThermalLimitsOfSet) -> Vec<f64> {
    distinct(of_set.limits.iter().map(|limit| limit.limit_degc))
}
