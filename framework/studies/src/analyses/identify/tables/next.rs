//! Table of the points to measure next.

use super::super::outcome::IdentificationOfSet;
use crate::analyses::numbers::{RPM, tidy};
use crate::cells;
use crate::table::{Column, Table};

/// All candidates of all sets, with their positions in the plan.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    let mut table = Table::new(
        format!("{name}-next"),
        [
            Column::text("model_set", "Model set"),
            Column::text("gear", "Gear"),
            Column::number("torque_nm", "Nm", "Torque"),
            Column::number("speed_rpm", "rpm", "Speed"),
            Column::number("oil_temperature_degc", "degC", "Oil temperature"),
            Column::number(
                "accuracy",
                "mixed",
                "Standard deviation of a measurement there; of an efficiency as a fraction",
            ),
            Column::number("gain_alone", "-", "Gain of this point as the only measurement"),
            Column::text("places_in_plan", "Positions in the plan"),
        ],
    );
    for o in all {
        let Some(Ok(next)) = &o.found.next else { continue };
        for (i, at) in next.candidates.iter().enumerate() {
            let choices = next.plan.plan.choices.iter().enumerate();
            let places: Vec<String> = choices
                .filter(|(_, choice)| choice.candidate == i)
                .map(|(place, _)| (place + 1).to_string())
                .collect();
            table.push(cells![
                &o.model_set,
                &next.gear,
                at.torque,
                tidy(at.speed * RPM),
                at.oil,
                next.plan.deviations[i],
                next.plan.gains[i],
                places.join(" "),
            ]);
        }
    }
    table
}
