//! Input of an identification: parameters, means over cycles, held-out rows, groups of rows.

mod hold_out;
mod means;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::varied::Tie;

pub use hold_out::{FoldsBy, FoldsEntry, HoldOutEntry, HoldOutRows};
pub use means::{MeanEntry, RelativeTo};

/// One parameter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct IdentifiedEntry {
    /// Resolved path; with `*` all matches change together. Of the rig: `rig.torque_offset_in`, `rig.torque_offset_out`,
    /// `rig.support_in.torque`, `rig.support_out.torque`.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: Option<String>,
    /// Several paths instead of one, which move together along `values`; the parameter is the value of the first.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// Rows with a value for each of `paths`. The first value of the rows increases or decreases; between two rows all values are linear in it.
    #[serde(default)]
    pub values: Vec<Vec<Value>>,
    /// How several quantities change together.
    #[serde(default)]
    pub tie: Tie,
    /// Start value; default: the value of the gearbox or the rig.
    pub start: Option<Value>,
    /// Lower bound, as a quantity of the path; default: from the schema.
    pub from: Option<Value>,
    /// Upper bound; default: from the schema.
    pub to: Option<Value>,
    /// Scale: `log` for positive factors that may vary by more than three to one.
    #[serde(default)]
    pub scale: ScaleEntry,
    /// Prior.
    pub prior: Option<PriorEntry>,
    /// For load factors: one factor at each of these torques, linear in between, instead of a single one.
    pub over: Option<OverEntry>,
}

impl IdentifiedEntry {
    /// A linear parameter between two values; the start is the value of the gearbox or the rig.
    pub fn between(path: impl Into<String>, from: impl Into<Value>, to: impl Into<Value>) -> Self {
        Self {
            path: Some(path.into()),
            paths: Vec::new(),
            values: Vec::new(),
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

impl IdentifiedEntry {
    /// The path as written, or several.
    pub fn words(&self) -> String {
        self.path.clone().unwrap_or_else(|| self.paths.join(", "))
    }
}

/// Scale of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScaleEntry {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic.
    Log,
}

/// Prior of a parameter: equivalent to one more measurement.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct PriorEntry {
    /// Mean; default: the start.
    pub mean: Option<Value>,
    /// Standard deviation, as a quantity of the path; for a logarithmic parameter a number relative to the mean.
    pub deviation: Value,
}

/// Torques at which a load factor is identified.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OverEntry {
    /// Port of the torque.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Torques, ascending. [Nm]
    #[schemars(inner(range(min = 0.0, max = 1e9)), length(min = 2, max = 20))]
    pub torques: Vec<f64>,
}
