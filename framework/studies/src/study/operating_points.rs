//! Losses of a list of operating points from a file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{By, Data, Write};
use gearloss_framework::description::Ordered;

/// Losses of a list of operating points from a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OperatingPointsEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// The points, one row each: torque, speed and a name, the columns of `bind`, and what was measured: loss, temperatures of
    /// oil and surface, each with its accuracy. With `faulty_rows: keep` cells of measured columns may be empty.
    pub data: Data,
    /// Columns that change a value of the gearbox: column to resolved path, such as `volume: housing.oil.volume`. The unit stands
    /// in the header: `volume [ml]`.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}
