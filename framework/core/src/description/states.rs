//! Gear states, torque shares, assumptions and imported loads.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is engaged in one gear.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GearStateEntry {
    /// The engaged couplings and clutches; nothing else is fixed.
    #[schemars(extend("x-refers-to" = "clearances"))]
    Engaged(Vec<String>),
    /// Engaged couplings and clutches, with rules for members that nothing else drives.
    Full(GearStateRecord),
}

/// Engaged couplings and clutches, with rules for members that nothing else drives.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct GearStateRecord {
    /// Engaged couplings and clutches.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "clearances"))]
    pub engaged: Vec<String>,
    /// Shafts or idler gears that no port drives in this gear and that are stationary.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub standstill: Vec<String>,
    /// Ratio of two speeds that a control keeps, in a gear in which two speeds are free: two machines on one planetary set. It transmits no torque.
    pub speed_ratio: Option<SpeedRatioEntry>,
}

/// Speed of a port in a fixed ratio to that of another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SpeedRatioEntry {
    /// Port whose speed follows.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Port whose speed it follows.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub to: String,
    /// Speed of `port` over that of `to`. Several make one gear each, with its ratio behind the name, among which `gear: best` chooses. [-]
    pub ratio: RatiosEntry,
}

/// One ratio, or several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum RatiosEntry {
    /// One. [-]
    One(#[schemars(range(min = -1e3, max = 1e3))] f64),
    /// Several. [-]
    Several(#[schemars(inner(range(min = -1e3, max = 1e3)), length(min = 1))] Vec<f64>),
}

impl GearStateEntry {
    /// Ids of the engaged couplings and clutches.
    pub fn engaged(&self) -> &[String] {
        match self {
            Self::Engaged(ids) => ids,
            Self::Full(record) => &record.engaged,
        }
    }
    /// Ids of the members that are stationary by rule.
    pub fn standstill(&self) -> &[String] {
        match self {
            Self::Engaged(_) => &[],
            Self::Full(record) => &record.standstill,
        }
    }
    /// Ratio of two speeds.
    pub fn speed_ratio(&self) -> Option<&SpeedRatioEntry> {
        match self {
            Self::Engaged(_) => None,
            Self::Full(record) => record.speed_ratio.as_ref(),
        }
    }
}

/// Torque split of parallel paths at a member.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct TorqueShare {
    /// Shaft or idler gear whose torque is split.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub member: String,
    /// Meshes that share it.
    #[schemars(length(min = 2))]
    #[schemars(extend("x-refers-to" = ["meshes", "bevel_meshes", "worm_meshes", "crossed_helical_meshes"]))]
    pub meshes: Vec<String>,
    /// Shares, one for each mesh; their sum is one. [-]
    #[schemars(inner(range(min = 0.0, max = 1.0)), length(min = 2))]
    pub parts: Vec<f64>,
}

/// Paths with a reason or a source.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct AssumedEntry {
    /// Path patterns; `*` matches one id.
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// The reason, or the source.
    pub because: String,
}

/// Bearing loads from a file.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ImportedLoads {
    /// CSV file with the columns `gear`, `torque [Nm]`, `component`, `radial [N]`, `axial [N]` and optionally `tilting [Nm]`.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Port of the torque in the file.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
}

/// Design torque and speed, at the ports where a study gives torque and speed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct RatingEntry {
    /// Maximum torque. [Nm]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub torque: f64,
    /// Maximum speed. [rpm]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub speed: f64,
}
