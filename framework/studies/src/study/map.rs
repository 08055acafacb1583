//! Losses and efficiency over a grid.

use schemars::JsonSchema;
use serde::Deserialize;

use gearloss_framework::description::Ordered;

use super::{Data, Export, Write};

/// Losses and efficiency over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MapEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid; not with `points`.
    pub grid: Option<String>,
    /// File of points in place of a grid, as of measured data: torque, speed, and where it has them gear state and temperature
    /// of the oil, which then holds for its point.
    pub points: Option<Data>,
    /// Columns of the points that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// Gear state of the points where no column says it; absent, the first.
    pub gear: Option<String>,
    /// Measured points that are drawn into the pictures.
    pub measured: Option<Data>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Formats to write; absent, CSV and JSON. Pictures show efficiency, loss and, with a balance, temperature.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
    /// Tables of losses for other programs, one file for each gear state; a grid is needed.
    #[serde(default)]
    pub export: Vec<Export>,
    /// Largest share of the loss torque by which the straight lines of a `lossy_gear` table may miss it at a point of the grid;
    /// above it the table is refused. [-]
    #[serde(default = "quarter")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub lossy_gear_limit: f64,
}

/// About what sets of models differ by among themselves.
fn quarter() -> f64 {
    0.25
}
