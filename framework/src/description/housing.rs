//! Housing, oil and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The housing.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct HousingEntry {
    /// Oil of everything that does not name its own.
    pub oil: Option<OilEntry>,
    /// Gear case in a section across the shafts.
    pub section: Option<CaseSection>,
    /// Gap between the gears and the wall.
    pub clearance: Option<WallClearance>,
    /// Road grade: rotation of the housing about y, nose up positive. [deg]
    #[serde(default)]
    #[schemars(range(min = -89.0, max = 89.0))]
    pub grade: f64,
    /// Bank: rotation of the housing about x. [deg]
    #[serde(default)]
    #[schemars(range(min = -89.0, max = 89.0))]
    pub bank: f64,
}

/// The sump.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct OilEntry {
    /// Oil, one of `lubricants`.
    pub lubricant: String,
    /// Volume. [l]
    #[schemars(range(min = 0.001, max = 1e4))]
    pub volume: Option<f64>,
    /// Height of the oil at rest above the datum; absent, nothing dips. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub level: Option<f64>,
    /// Datum: the axis of this shaft at x = 0; absent, the origin of the housing.
    pub measured_from: Option<String>,
    /// Height of the oil while turning: a height, or heights over the speed of a shaft.
    pub running_level: Option<Running>,
    /// Added to whichever level counts. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e3, max = 1e3))]
    pub level_offset: f64,
}

/// Height of the oil while turning.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Running {
    /// One height above the datum. [mm]
    Height(#[schemars(range(min = -1e4, max = 1e4))] f64),
    /// Heights over the speed of a shaft.
    Over(LevelOver),
}

/// Heights of the oil over the speed of a shaft, linear in between, constant beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct LevelOver {
    /// Shaft whose speed counts.
    pub shaft: String,
    /// Speeds, rising from zero or above. [rpm]
    #[schemars(inner(range(min = 0.0, max = 1e6)), length(min = 2))]
    pub speeds: Vec<f64>,
    /// Heights above the datum, one for each speed. [mm]
    #[schemars(inner(range(min = -1e4, max = 1e4)), length(min = 2))]
    pub levels: Vec<f64>,
}

/// Gear case in a section across the shafts.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct CaseSection {
    /// Area. [cm2]
    #[schemars(range(min = 0.1, max = 1e7))]
    pub area: f64,
    /// Perimeter. [cm]
    #[schemars(range(min = 0.1, max = 1e5))]
    pub perimeter: f64,
}

/// Gap between the gears and the wall.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct WallClearance {
    /// Radial gap. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub radial: f64,
    /// Axial gap. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub axial: f64,
}

/// Operating temperature.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct Thermal {
    /// How the temperature is found.
    #[serde(default)]
    pub mode: ThermalMode,
    /// Temperature of the oil. [degC]
    #[serde(default = "eighty")]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil: f64,
}

impl Default for Thermal {
    fn default() -> Self {
        Self {
            mode: ThermalMode::Fixed,
            oil: eighty(),
        }
    }
}

fn eighty() -> f64 {
    80.0
}

/// How the temperature is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ThermalMode {
    /// It is given.
    #[default]
    Fixed,
}
