//! What an identification is given: parameters, rows that are held out, groups of rows.

mod hold_out;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::varied::Tie;

pub use hold_out::{FoldsBy, FoldsEntry, HoldOutEntry, HoldOutRows};

/// One parameter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct IdentifiedEntry {
    /// Resolved path; with `*` all matches change together. Of the rig: `rig.torque_offset_in`, `rig.torque_offset_out`,
    /// `rig.support_in.torque`, `rig.support_out.torque`.
    pub path: String,
    /// How several quantities change together.
    #[serde(default)]
    pub tie: Tie,
    /// Where the search begins; absent, the value of the gearbox or the rig.
    pub start: Option<Value>,
    /// Least value, as a quantity of the path; absent, that of the schema.
    pub from: Option<Value>,
    /// Greatest value; absent, that of the schema.
    pub to: Option<Value>,
    /// How it is counted: `log` for factors above zero that may vary by more than three to one.
    #[serde(default)]
    pub scale: ScaleEntry,
    /// Prior.
    pub prior: Option<PriorEntry>,
    /// For load factors: one factor at each of these torques, linear in between, in place of a single one.
    pub over: Option<OverEntry>,
}

impl IdentifiedEntry {
    /// A parameter between two values as one writes them, counted as it is; the search begins at the value of the gearbox or the
    /// rig.
    pub fn between(path: impl Into<String>, from: impl Into<Value>, to: impl Into<Value>) -> Self {
        Self {
            path: path.into(),
            tie: Tie::default(),
            start: None,
            from: Some(from.into()),
            to: Some(to.into()),
            scale: ScaleEntry::default(),
            prior: None,
            over: None,
        }
    }
}

/// How a parameter is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScaleEntry {
    /// As it is.
    #[default]
    Linear,
    /// By its logarithm.
    Log,
}

/// What is known of a parameter beside the points: it counts like one more measurement.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct PriorEntry {
    /// Mean; absent, the start.
    pub mean: Option<Value>,
    /// Standard deviation, as a quantity of the path; of a logarithmic parameter a number, relative to the mean.
    pub deviation: Value,
}

/// Torques at which a load factor is found.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OverEntry {
    /// Port of the torque.
    pub port: String,
    /// Torques, rising. [Nm]
    #[schemars(inner(range(min = 0.0, max = 1e9)), length(min = 2, max = 20))]
    pub torques: Vec<f64>,
}
