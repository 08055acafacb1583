//! Table of the predictions of held-out rows.

use super::super::outcome::IdentificationOfSet;
use crate::cells;
use crate::table::{Column, Table};

/// One row for each held-out value.
pub(in crate::analyses::identify) fn table(name: &str, all: &[IdentificationOfSet]) -> Table {
    const UNIT: &str = "mixed";
    let mut table = Table::new(
        format!("{name}-hold-out"),
        [
            Column::text("model_set", "Model set"),
            Column::number("line", "-", "Line in the file"),
            Column::text("name", "Name of the row"),
            Column::text("gear", "Gear"),
            Column::number("torque_nm", "Nm", "Torque"),
            Column::number("speed_rpm", "rpm", "Speed"),
            Column::number("oil_temperature_degc", "degC", "Oil temperature"),
            Column::text(
                "quantity",
                "Quantity of this row with its unit; efficiencies as fractions",
            ),
            Column::number(
                "measured",
                UNIT,
                "Measured, without the contribution of the identified rig",
            ),
            Column::number("predicted", UNIT, "Predicted"),
            Column::number("band_low", UNIT, "Lower end of the 95 % band of the measurement"),
            Column::number("band_high", UNIT, "Upper end of the 95 % band of the measurement"),
            Column::text("inside", "Whether the measurement is inside its band"),
        ],
    );
    for o in all {
        for point in o.hold_out.iter().flat_map(|held| &held.points) {
            table.push(cells![
                &o.model_set,
                point.line as usize,
                point.name.as_deref().unwrap_or_default(),
                &point.gear,
                point.torque_nm,
                point.speed_rpm,
                point.oil_temperature_degc,
                point.quantity,
                point.measured,
                point.predicted,
                point.band.map(|band| band[0]),
                point.band.map(|band| band[1]),
                point.inside.map_or("", |inside| if inside { "true" } else { "false" }),
            ]);
        }
    }
    table
}
