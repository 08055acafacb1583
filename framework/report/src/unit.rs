//! The drive unit in tables of points, and in one line.

use gearloss_studies::points::UnitPoint;

use crate::text::{figures, number};

/// Heads of its columns; none without machines.
pub fn head(has_unit: bool) -> &'static [&'static str] {
    let all = &["DC power W", "unit loss W", "system efficiency %"];
    if has_unit { all } else { &[] }
}

/// Its cells; none without machines.
pub fn cells(has_unit: bool, unit: Option<&UnitPoint>) -> Vec<String> {
    if !has_unit {
        return Vec::new();
    }
    let efficiency = unit.and_then(|unit| unit.system_efficiency);
    vec![
        number(unit.map(|unit| unit.dc_power_w), 1),
        number(unit.map(|unit| unit.unit_loss_w), 2),
        number(efficiency.map(|share| 100.0 * share), 2),
    ]
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
