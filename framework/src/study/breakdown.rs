//! Where losses arise.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{SpeedAxis, TorqueAxis, Write};

/// Losses by mechanism or component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BreakdownEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the whole loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// What losses are summed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// By mechanism.
    #[default]
    Mechanism,
    /// By component.
    Component,
    /// By the usual sums: gears, bearings, seals, others; load-dependent and not.
    Sum,
}

/// Unit of a breakdown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum As {
    /// Watts.
    #[default]
    Watts,
    /// Percent of the whole loss.
    Percent,
}
