//! Table of the predictions of held-out rows.

use super::super::outcome::IdentificationOfSet;
use super::UNIT;
use crate::table::Table;

/// One row for each held-out value.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    Table::of_each(format!("{name}-hold-out"), all, |o| {
        o.hold_out.iter().flat_map(|held| &held.points)
    })
    .text("model_set", "Model set", |(o, _)| &o.model_set)
    .number("line", "-", "Line in the file", |(_, point)| point.line as f64)
    .text("name", "Name of the row", |(_, point)| {
        point.name.as_deref().unwrap_or_default()
    })
    .text("gear", "Gear", |(_, point)| &point.gear)
    .number("torque_nm", "Nm", "Torque", |(_, point)| point.torque_nm)
    .number("speed_rpm", "rpm", "Speed", |(_, point)| point.speed_rpm)
    .number("oil_temperature_degc", "degC", "Oil temperature", |(_, point)| {
        point.oil_temperature_degc
    })
    .text(
        "quantity",
        "Quantity of this row with its unit; efficiencies as fractions",
        |(_, point)| point.quantity,
    )
    .number(
        "measured",
        UNIT,
        "Measured, without the contribution of the identified rig",
        |(_, point)| point.measured,
    )
    .number("predicted", UNIT, "Predicted", |(_, point)| point.predicted)
    .ends(
        ["band_low", "band_high"],
        UNIT,
        "the 95 % band of the measurement",
        |(_, point)| point.band,
    )
    .text("inside", "Whether the measurement is inside its band", |(_, point)| {
        point.inside.map(|inside| inside.to_string()).unwrap_or_default()
    })
    .finish()
}
