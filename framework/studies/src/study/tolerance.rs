//! Uncertain inputs: quantities with their distributions.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::RangeEntry;

/// One uncertain input: `plus_minus`, `percent`, or `from` and `to`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ToleranceEntry {
    /// The quantity and its range.
    #[serde(flatten)]
    pub range: RangeEntry,
    /// Distribution in the range.
    #[serde(default)]
    pub distribution: Shape,
}

/// Distribution in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Uniform.
    #[default]
    Uniform,
    /// Normal: the range contains 95 % of the values; values outside the range of the schema are moved to its ends.
    Normal,
    /// Triangular: mode at the value of the gearbox, zero density at the ends.
    Triangular,
}
