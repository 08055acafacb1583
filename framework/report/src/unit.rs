//! The drive unit in tables of points, and in one line.

use gearloss_studies::points::UnitPoint;

use crate::text::{figures, number};

/// Head and cell of a column.
type Column = (&'static str, fn(Option<&UnitPoint>) -> String);

/// Its columns; none without machines.
pub fn columns(has_unit: bool) -> &'static [Column] {
    const ALL: [Column; 3] = [
        ("DC power W", |unit| number(unit.map(|unit| unit.dc_power_w), 1)),
        ("unit loss W", |unit| number(unit.map(|unit| unit.unit_loss_w), 2)),
        ("system efficiency %", |unit| {
            number(unit.and_then(|unit| Some(100.0 * unit.system_efficiency?)), 2)
        }),
    ];
    if has_unit { &ALL } else { &[] }
}

/// It in one line; nothing without machines.
pub fn line(unit: Option<&UnitPoint>) -> String {
    let Some(unit) = unit else {
        return String::new();
    };
    let efficiency = unit.system_efficiency.map_or_else(
        || "no power passes".to_owned(),
        |efficiency| format!("efficiency {} %", figures(100.0 * efficiency, 4)),
    );
    format!(
        "drive unit: DC power {} W, loss {} W, {efficiency}\n",
        figures(unit.dc_power_w, 5),
        figures(unit.unit_loss_w, 4)
    )
}
