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

/// An oil. Friction properties belong to it; models read them and may override them.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct LubricantEntry {
    /// Kind; sets the usual friction properties.
    #[serde(default)]
    pub kind: LubricantKind,
    /// Viscosity over temperature.
    pub viscosity: ViscosityEntry,
    /// Density at a reference temperature.
    #[serde(default)]
    pub density: DensityEntry,
    /// Coefficient of boundary friction in rolling bearings; absent, the models' own. [-]
    #[schemars(range(min = 0.01, max = 0.3))]
    pub mu_bl: Option<f64>,
    /// Coefficient of full-film friction in rolling bearings; absent, by kind: 0.05 mineral, 0.04 synthetic, 0.1
    /// transmission fluid. [-]
    #[schemars(range(min = 0.001, max = 0.2))]
    pub mu_ehl: Option<f64>,
    /// Lubricant factor of mean mesh friction; absent, by kind: 1 mineral and transmission fluid, 0.8
    /// polyalphaolefin and ester. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
}

/// Kind of an oil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LubricantKind {
    /// Mineral oil.
    #[default]
    Mineral,
    /// Polyalphaolefin.
    Polyalphaolefin,
    /// Ester.
    Ester,
    /// Polyglycol.
    Polyglycol,
    /// Transmission fluid.
    TransmissionFluid,
}

/// Viscosity over temperature by ASTM D341: two of the three values.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct ViscosityEntry {
    /// Kinematic viscosity at 40 degC. [mm2/s]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub kv40: Option<f64>,
    /// Kinematic viscosity at 100 degC. [mm2/s]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub kv100: Option<f64>,
    /// Viscosity index. [-]
    #[schemars(range(min = 0.0, max = 400.0))]
    pub vi: Option<f64>,
}

/// Density at one temperature.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct DensityEntry {
    /// Temperature. [degC]
    #[serde(default = "fifteen")]
    #[schemars(range(min = -50.0, max = 150.0))]
    pub at: f64,
    /// Density. [kg/m3]
    #[serde(default = "usual_density")]
    #[schemars(range(min = 500.0, max = 1300.0))]
    pub value: f64,
    /// Share of the density that is lost per degree; absent, by kind. [1/K]
    #[schemars(range(min = 0.0, max = 0.002))]
    pub expansion: Option<f64>,
}

fn fifteen() -> f64 {
    15.0
}

fn usual_density() -> f64 {
    870.0
}

impl Default for DensityEntry {
    fn default() -> Self {
        Self {
            at: fifteen(),
            value: usual_density(),
            expansion: None,
        }
    }
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
