//! Losses and efficiency over a grid.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Write;

/// Losses and efficiency over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MapEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid.
    pub grid: String,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Formats to write; absent, CSV and JSON. Pictures show efficiency, loss and, with a balance, temperature.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}
