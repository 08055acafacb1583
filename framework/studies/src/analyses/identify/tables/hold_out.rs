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
    .fields(
        "line name gear torque_nm speed_rpm oil_temperature_degc quantity",
        |(_, point)| point,
    )
    .fields_in(UNIT, "measured predicted", |(_, point)| point)
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
