//! Every combination of models, ranked by a measurement, or the spread that they leave.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::{Data, Quantity, Write};
use crate::description::Ordered;

/// Every combination of the models of some mechanisms. The loss of each is evaluated once and added; against measured points
/// combinations are ranked by their cross-validated error, without them their spread is the uncertainty of the models.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct TournamentEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state of the data; absent, the first. A grid has its own.
    pub gear: Option<String>,
    /// Set of models for everything else; absent, the models of the gearbox.
    pub model_set: Option<String>,
    /// The mechanisms whose models change.
    #[schemars(length(min = 1))]
    pub mechanisms: Vec<CandidatesEntry>,
    /// Grid, of one gear state; not with `data`.
    pub grid: Option<String>,
    /// Measured points that the combinations are ranked by.
    pub data: Option<Data>,
    /// What errors are counted in: efficiency points, watts, or newton metres.
    #[serde(default)]
    pub quantity: Quantity,
    /// Each mechanism's loss may be scaled by a factor, fitted within these bounds for each combination.
    pub factors: Option<FactorsEntry>,
    /// Groups of neighbouring torques of which each is predicted from the others. [-]
    #[serde(default = "folds")]
    #[schemars(range(min = 2, max = 20))]
    pub folds: u32,
    /// How many combinations are printed. [-]
    #[serde(default = "shown")]
    #[schemars(range(min = 1, max = 1000))]
    pub shown: u32,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

fn folds() -> u32 {
    5
}

fn shown() -> u32 {
    10
}

/// The models of one mechanism that take part.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CandidatesEntry {
    /// Mechanism, such as `bearing`.
    pub mechanism: String,
    /// Slot of a mechanism of which a gear has several models: `churning` of `gear_drag`.
    pub slot: Option<String>,
    /// Models by name, each as in a gearbox: `{ type: skf }`; absent, all that this gearbox has the inputs
    /// for, with their defaults. Those of drags are named always, because laws for churning, injection and windage are one mechanism.
    #[serde(default)]
    pub models: Ordered<Value>,
}

/// Bounds of the factors.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct FactorsEntry {
    /// Least factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least: f64,
    /// Greatest factor. [-]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub greatest: f64,
}
