//! One component: several models of it, or its path of contact.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::{Data, SpeedAxis, TorqueAxis, Write};
use gearloss_framework::description::Ordered;

/// Several models of one component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ComponentCompareEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Path of the component, such as `bearings.B1`, `meshes.M1` or `gears.G4.drag.churning`.
    pub component: String,
    /// Models by name, each as in a gearbox: `{ type: skf }`. The other components keep theirs.
    pub models: Ordered<Value>,
    /// Set of models for everything else; absent, the models of the gearbox.
    pub model_set: Option<String>,
    /// Overrides for this analysis: resolved path to value, such as `meshes.M2.drag.churning: none`.
    #[serde(default)]
    pub set: Ordered<Value>,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Measured points: torque and speed at the study's ports, and the loss of the component. Each is compared with every model
    /// at that torque and speed.
    pub measured: Option<Data>,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// Speeds, load, pressure, friction, film and loss along the path of contact of one mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ContactPathEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Mesh, one of `meshes`.
    pub mesh: String,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Number of places. [-]
    #[serde(default = "places")]
    #[schemars(range(min = 3, max = 2001))]
    pub places: u32,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

fn places() -> u32 {
    101
}
