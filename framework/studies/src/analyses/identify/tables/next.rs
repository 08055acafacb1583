//! Table of the points to measure next.

use super::super::outcome::IdentificationOfSet;
use super::UNIT;
use crate::numbers::{RPM, tidy};
use crate::table::Table;

/// All candidates of all sets, with their positions in the plan.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    let mut rows = Vec::new();
    for o in all {
        let Some(Ok(next)) = &o.found.next else { continue };
        rows.extend(next.candidates.iter().enumerate().map(|(i, at)| (o, next, i, at)));
    }
    Table::of(format!("{name}-next"), rows)
        .text("model_set", "Model set", |(o, ..)| &o.model_set)
        .text("gear", "Gear", |(_, next, ..)| &next.gear)
        .number("torque_nm", "Nm", "Torque", |(.., at)| at.torque)
        .number("speed_rpm", "rpm", "Speed", |(.., at)| tidy(at.speed * RPM))
        .number("oil_temperature_degc", "degC", "Oil temperature", |(.., at)| at.oil)
        .number(
            "accuracy",
            UNIT,
            "Standard deviation of a measurement there; of an efficiency as a fraction",
            |(_, next, i, _)| next.plan.deviations[*i],
        )
        .number(
            "gain_alone",
            "-",
            "Gain of this point as the only measurement",
            |(_, next, i, _)| next.plan.gains[*i],
        )
        .text("places_in_plan", "Positions in the plan", |(_, next, i, _)| {
            let choices = next.plan.plan.choices.iter().enumerate();
            let places = choices.filter(|(_, choice)| choice.candidate == *i);
            places
                .map(|(place, _)| (place + 1).to_string())
                .collect::<Vec<_>>()
                .join(" ")
        })
        .finish()
}
