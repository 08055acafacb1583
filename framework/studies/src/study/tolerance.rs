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
    /// How values lie in the range.
    #[serde(default)]
    pub distribution: Shape,
}

/// How values lie in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// All are as likely.
    #[default]
    Uniform,
    /// Normal: the range holds 95 % of the values; those beyond the range of the schema are moved onto it.
    Normal,
    /// The value of the gearbox is the likeliest, the ends are not reached.
    Triangular,
}
