//! Losses and efficiency over the values of one path.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::{By, SpeedAxis, TorqueAxis, Write};

/// Losses and efficiency over the values of one path, or of two.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SweepEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Resolved path whose value changes, such as `lubricants.sump.viscosity.kv100`, or `thermal.oil` for the temperature.
    pub path: String,
    /// Values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
    /// A second path whose values change too: every combination is solved.
    pub second: Option<SecondEntry>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

/// The second path of a sweep.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SecondEntry {
    /// Resolved path whose value changes.
    pub path: String,
    /// Values, each as in a gearbox.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
}
