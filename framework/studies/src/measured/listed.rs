//! Operating points that a study lists itself, as rows without measured values.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Measured, Row};

/// One operating point of a list.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ListedPoint {
    /// Name; default: its number.
    pub name: Option<String>,
    /// Gear; default: that of the analysis.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Torque at the port of the conditions. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed at the port of the conditions. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Oil temperature; default: from the conditions or the gearbox. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil_temperature: Option<f64>,
}

impl Measured {
    /// Rows of points that were not measured.
    pub fn listed(points: &[ListedPoint]) -> Self {
        let rows = (1..).zip(points).map(|(line, point)| Row {
            line,
            name: point.name.clone(),
            gear: point.gear.clone(),
            values: vec![Some(point.torque), Some(point.speed), point.oil_temperature],
            ..Row::default()
        });
        Self {
            quantities: vec!["torque", "speed", "oil_temperature"],
            rows: rows.collect(),
            divisor: 1.0,
            ..Self::default()
        }
    }
}
