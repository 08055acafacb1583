//! Formats of results.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Write {
    /// Comma-separated values.
    Csv,
    /// JSON.
    Json,
    /// Parquet, with the columns of the CSV.
    Parquet,
    /// Pictures, one file each.
    Svg,
}

impl Write {
    /// CSV and JSON.
    pub(crate) fn data() -> Vec<Self> {
        vec![Self::Csv, Self::Json]
    }

    /// CSV, JSON and pictures.
    pub(crate) fn all() -> Vec<Self> {
        vec![Self::Csv, Self::Json, Self::Svg]
    }
}

/// A table of losses for another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Export {
    /// Loss torque over input speed and torque as VECTO reads it, for engineering mode.
    Vecto,
    /// Efficiency and loss torque over torque, speed and, where several were computed, oil temperature, as a script with the
    /// vectors of Simulink's gearbox blocks.
    Matlab,
    /// Efficiency and bearing friction over speed for `LossyGear` of the Modelica Standard Library: straight lines from the no-load
    /// loss, a fit by relative deviation.
    LossyGear,
}
