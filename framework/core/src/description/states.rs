//! Gear states, torque shares, assumptions and imported loads.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is engaged in one gear.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GearStateEntry {
    /// The engaged couplings and clutches; nothing else is held.
    Engaged(Vec<String>),
    /// Engaged couplings and clutches with rules for what nothing else moves.
    Full(GearStateRecord),
}

/// What is engaged in one gear, with rules for what nothing else moves.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct GearStateRecord {
    /// Engaged couplings and clutches.
    #[serde(default)]
    pub engaged: Vec<String>,
    /// Shafts or loose gears that no port moves in this gear and that stand still.
    #[serde(default)]
    pub standstill: Vec<String>,
}

impl GearStateEntry {
    /// Ids of the engaged couplings and clutches.
    pub fn engaged(&self) -> &[String] {
        match self {
            Self::Engaged(ids) => ids,
            Self::Full(record) => &record.engaged,
        }
    }
    /// Ids of the members that stand still by rule.
    pub fn standstill(&self) -> &[String] {
        match self {
            Self::Engaged(_) => &[],
            Self::Full(record) => &record.standstill,
        }
    }
}

/// How parallel paths share the torque of a member.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct TorqueShare {
    /// Shaft or loose gear whose torque is shared.
    pub member: String,
    /// Meshes that share it.
    #[schemars(length(min = 2))]
    pub meshes: Vec<String>,
    /// Parts, one for each mesh; they add up to one. [-]
    #[schemars(inner(range(min = 0.0, max = 1.0)), length(min = 2))]
    pub parts: Vec<f64>,
}

/// Paths and a reason or a source.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct AssumedEntry {
    /// Path patterns; `*` stands for one id.
    pub paths: Vec<String>,
    /// The reason, or the source.
    pub because: String,
}

/// Loads of components from a file.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ImportedLoads {
    /// CSV file with the columns `gear`, `torque [Nm]`, `component`, `radial [N]`, `axial [N]` and, if wanted,
    /// `tilting [Nm]`.
    pub file: String,
    /// Port whose torque the file's torque is.
    pub port: String,
}

/// What a gearbox is made for, at the ports where a study gives torque and speed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct RatingEntry {
    /// Largest torque. [Nm]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub torque: f64,
    /// Largest speed. [rpm]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub speed: f64,
}
