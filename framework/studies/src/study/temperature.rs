//! Limits and balances of temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{SpeedAxis, TorqueAxis, Write};

/// The torque, or the speed, at which the balance reaches a given temperature.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ThermalLimitEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Temperatures of the oil that may be reached. [degC]
    #[schemars(inner(range(min = 0.0, max = 250.0)), length(min = 1))]
    pub temperature: Vec<f64>,
    /// What is looked for: the torque at each speed, or the speed at each torque.
    #[serde(default)]
    pub find: Find,
    /// Torques: the range in which the limit is looked for, from the value nearest to zero to the farthest; or those at which
    /// the speed is.
    pub torque: TorqueAxis,
    /// Speeds: those at which the torque is looked for; or the range in which the limit is.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

/// What a limit is looked for in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Find {
    /// The torque at each speed.
    #[default]
    Torque,
    /// The speed at each torque.
    Speed,
}
