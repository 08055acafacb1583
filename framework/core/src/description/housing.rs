//! Housing, oil and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{NetworkChoice, Ordered};
use crate::mechanism::heat_dissipation::HeatDissipation;
use crate::registry::NamedSlots;

/// The housing.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct HousingEntry {
    /// Oil of everything that does not name its own.
    pub oil: Option<OilEntry>,
    /// Gear case in a section across the shafts.
    pub section: Option<CaseSection>,
    /// Gap between the gears and the wall.
    pub clearance: Option<WallClearance>,
    /// The outside, for models of the heat that leaves.
    pub outside: Option<OutsideEntry>,
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

/// The outside of the housing, where it gives heat to the air.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
pub struct OutsideEntry {
    /// Length, width and height of a box about the housing; they stand for what is not stated. [mm]
    #[serde(rename = "box")]
    #[schemars(inner(range(min = 1.0, max = 1e5)))]
    pub sides: Option<[f64; 3]>,
    /// Area of the face by which the housing is mounted, which gives no heat to the air. [cm2]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub mounting_area: f64,
    /// Area that gives heat to the air, without fins; absent, that of the box without its mounting face. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub area: Option<f64>,
    /// Area inside that the oil wets; absent, the area outside. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub oil_area: Option<f64>,
    /// Height; absent, that of the box. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub height: Option<f64>,
    /// Length along the flow of the air; absent, that of the box. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub length: Option<f64>,
    /// Thickness of the wall. [mm]
    #[serde(default = "five_millimetres")]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub wall_thickness: f64,
    /// Thermal conductivity of the wall; 150 for aluminium, 50 for grey cast iron. [W/(m K)]
    #[serde(default = "aluminium")]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub wall_conductivity: f64,
    /// Emissivity: 0.9 to 0.95 painted, 0.15 to 0.3 bare aluminium. [-]
    #[serde(default = "painted")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Speed of the air along the housing; zero for still air. [m/s]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub air_speed: f64,
}

fn five_millimetres() -> f64 {
    5e-3
}

fn aluminium() -> f64 {
    150.0
}

fn painted() -> f64 {
    0.9
}

/// Operating temperature.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct Thermal {
    /// How the temperature is found.
    #[serde(default)]
    pub mode: ThermalMode,
    /// Temperature of the oil, where it is given. [degC]
    #[serde(default = "eighty")]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil: f64,
    /// Temperature of the surroundings. [degC]
    #[serde(default = "twenty")]
    #[schemars(range(min = -60.0, max = 120.0))]
    pub ambient: f64,
    /// Temperature of the oil up to which a balance is looked for. [degC]
    #[serde(default = "hottest")]
    #[schemars(range(min = 0.0, max = 250.0))]
    pub maximum: f64,
    /// Resistance between the oil and the surface of the housing; zero where both are one temperature. [K/W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub oil_to_surface: f64,
    /// Heat that comes from elsewhere, by name, such as a flange-mounted motor.
    #[serde(default, skip_serializing_if = "Ordered::is_empty")]
    pub sources: Ordered<HeatSource>,
    /// Ways on which heat leaves, by name; they add up, and take the place of those in `models`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat_dissipation: Option<NamedSlots<HeatDissipation>>,
    /// Nodes with temperatures of their own, for `mode: network`: `auto`, or nodes, links and flows as written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkChoice>,
}

/// Heat that does not come from the losses.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct HeatSource {
    /// Heat flow. [W]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub heat: f64,
    /// Where it comes in.
    #[serde(default)]
    pub into: HeatInto,
}

/// Where heat comes in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HeatInto {
    /// The oil.
    Oil,
    /// The surface of the housing, as from a flange.
    #[default]
    Surface,
}

impl Default for Thermal {
    fn default() -> Self {
        Self {
            mode: ThermalMode::Fixed,
            oil: eighty(),
            ambient: twenty(),
            maximum: hottest(),
            oil_to_surface: 0.0,
            sources: Ordered::default(),
            heat_dissipation: None,
            network: None,
        }
    }
}

fn eighty() -> f64 {
    80.0
}

fn twenty() -> f64 {
    20.0
}

fn hottest() -> f64 {
    150.0
}

/// How the temperature is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ThermalMode {
    /// It is given.
    #[default]
    Fixed,
    /// Losses and the heat that leaves are in balance.
    Balance,
    /// Every node of the thermal network is in balance.
    Network,
}
