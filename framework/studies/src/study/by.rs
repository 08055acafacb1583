//! Grouping of losses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grouping of losses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// By mechanism.
    #[default]
    Mechanism,
    /// By component.
    Component,
    /// By stage: a mesh with the drags of its gears, a planetary set, and for everything else its shaft.
    Stage,
    /// By mechanism and term, such as the rolling and sliding terms of a bearing.
    Term,
    /// Gearbox, machines and inverters of the drive unit, at points.
    Unit,
    /// By the usual sums: gears, bearings, seals, others; load-dependent and load-independent.
    Sum,
}
