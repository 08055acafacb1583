//! How well models meet a measurement over two quantities of the gearbox.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::{Data, Difference, Quantity, Write};
use crate::varied::Tie;
use gearloss_framework::description::Ordered;

/// Root of the mean square of the difference from measured points, for every pair of values of two quantities of the gearbox.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct RmsSurfaceEntry {
    /// Gearbox of every set that names none; absent, the first.
    pub gearbox: Option<String>,
    /// Measured points. One without a value at some pair counts at none, so that all pairs stand on the same points.
    pub data: Data,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// Gear state of the data where no column says it; absent, the first.
    pub gear: Option<String>,
    /// Sets to compare with the data; `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[schemars(length(min = 1))]
    pub against: Vec<String>,
    /// What is compared.
    #[serde(default)]
    pub quantity: Quantity,
    /// How the difference counts: the model minus the measurement.
    #[serde(default)]
    pub difference: Difference,
    /// Accuracy of the measurement, in the unit of the difference, where no column tells it. [-]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub accuracy: Option<f64>,
    /// The first quantity.
    pub x: SurfaceAxisEntry,
    /// The second quantity.
    pub y: SurfaceAxisEntry,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

/// A quantity of the gearbox and its values.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SurfaceAxisEntry {
    /// Resolved path; with `*` all that it meets move together.
    pub path: String,
    /// How several quantities move together.
    #[serde(default)]
    pub tie: Tie,
    /// Rising values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`.
    #[schemars(length(min = 2))]
    pub values: Vec<Value>,
}
