//! The path of contact of one mesh.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Write;

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
