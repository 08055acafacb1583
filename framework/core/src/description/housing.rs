//! Housing, oil and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{NetworkChoice, Ordered};
use crate::mechanism::NamedSlots;
use crate::mechanism::heat_dissipation::HeatDissipation;

/// The housing.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct HousingEntry {
    /// Oil of all components without their own.
    pub oil: Option<OilEntry>,
    /// Cross-section of the gear case, perpendicular to the shafts.
    pub section: Option<CaseSection>,
    /// Gap between the gears and the wall.
    pub clearance: Option<WallClearance>,
    /// The oil space inside the housing, from which level and volume of the oil follow from each other.
    pub inside: Option<InsideEntry>,
    /// The outside of the housing, for heat dissipation models.
    pub outside: Option<OutsideEntry>,
    /// Road grade: rotation of the housing about y, nose up positive. [deg]
    #[serde(default)]
    #[schemars(range(min = -89.0, max = 89.0))]
    pub grade: f64,
    /// Bank: rotation of the housing about x. [deg]
    #[serde(default)]
    #[schemars(range(min = -89.0, max = 89.0))]
    pub bank: f64,
    /// Direction of travel of the vehicle in the housing. With it, road grade and acceleration of a cycle incline the oil in addition to
    /// `grade` and `bank`, and the level follows from the volume at each moment. An output on the axis of the wheels, with x across the vehicle
    /// and z upwards, that turns positively about +x drives towards -y. Default: a cycle does not incline the oil, because nothing else says
    /// how the gearbox is mounted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub travel: Option<TravelDirection>,
}

/// A horizontal direction in the housing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum TravelDirection {
    /// Along the shafts, towards +x.
    #[serde(rename = "+x")]
    AlongX,
    /// Along the shafts, towards -x.
    #[serde(rename = "-x")]
    AgainstX,
    /// Across the shafts, towards +y.
    #[serde(rename = "+y")]
    AlongY,
    /// Across the shafts, towards -y.
    #[serde(rename = "-y")]
    AgainstY,
}

impl TravelDirection {
    /// The unit vector.
    pub fn direction(self) -> [f64; 3] {
        match self {
            Self::AlongX => [1.0, 0.0, 0.0],
            Self::AgainstX => [-1.0, 0.0, 0.0],
            Self::AlongY => [0.0, 1.0, 0.0],
            Self::AgainstY => [0.0, -1.0, 0.0],
        }
    }
}

/// The sump.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct OilEntry {
    /// Oil, one of `lubricants`.
    #[schemars(extend("x-refers-to" = "lubricants"))]
    pub lubricant: String,
    /// Volume as filled; default: that of the level in the oil space. [l]
    #[schemars(range(min = 0.001, max = 1e4))]
    pub volume: Option<f64>,
    /// Temperature at which the volume was filled. [degC]
    #[serde(default = "twenty")]
    #[schemars(range(min = -60.0, max = 150.0))]
    pub fill_temperature: f64,
    /// Part of the volume that is in pipes, cooler and jackets while the pump runs. [l]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub circuit_volume: f64,
    /// Oil height above the datum at standstill; default: that of the volume in the oil space. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub level: Option<f64>,
    /// True if all oil is collected in a tank: no part is immersed.
    #[serde(default)]
    pub dry_sump: bool,
    /// Datum: the axis of this shaft at x = 0; default: the origin of the housing.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub measured_from: Option<String>,
    /// Oil height while rotating, if it was measured: a height, or heights over the speed of a shaft; `at_rest` if gears do not lower it.
    /// Default: estimated from the oil that the gears lift. Churning laws use the level at rest.
    pub running_level: Option<Running>,
    /// Place in the band of an estimated running level: -1 the lowest, 0 the usual, 1 the highest estimate. [-]
    #[serde(default)]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub running_band: f64,
    /// Offset added to the levels at rest and while rotating. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e3, max = 1e3))]
    pub level_offset: f64,
}

/// Oil height while rotating.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Running {
    /// As at rest.
    Word(RunningWord),
    /// One height above the datum. [mm]
    Height(#[schemars(range(min = -1e4, max = 1e4))] f64),
    /// Heights over the speed of a shaft.
    Over(LevelOver),
}

/// Word for the oil height while rotating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RunningWord {
    /// That at rest.
    AtRest,
}

/// Oil heights over the speed of a shaft, linear in between, constant beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct LevelOver {
    /// Shaft of the speed.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub shaft: String,
    /// Speeds, increasing from zero or above. [rpm]
    #[schemars(inner(range(min = 0.0, max = 1e6)), length(min = 2))]
    pub speeds: Vec<f64>,
    /// Heights above the datum, one for each speed. [mm]
    #[schemars(inner(range(min = -1e4, max = 1e4)), length(min = 2))]
    pub levels: Vec<f64>,
}

/// Cross-section of the gear case, perpendicular to the shafts.
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

/// The oil space inside the housing. Without sections it is the convex hull of the tip circles with the radial gap of `clearance` around
/// them, a housing without ribs and without a sump below the gears.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct InsideEntry {
    /// Inside width of the hull, about the middle of the gears; default: their extent plus the axial gap of `clearance` on both sides. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub width: Option<f64>,
    /// Sections of the space by name, from the drawing, joined below the level; they replace the hull.
    #[serde(default, skip_serializing_if = "Ordered::is_empty")]
    pub sections: Ordered<InsideSection>,
    /// Inside wall above the level on which thrown oil runs down; default: that of the space. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub wall_area: Option<f64>,
    /// Horizontal length of that wall; default: the circumference of the space. [mm]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub wall_length: Option<f64>,
}

/// A section of the oil space: a polygon perpendicular to the shafts, and its range along them.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct InsideSection {
    /// Beginning along the shafts. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub from: f64,
    /// End along the shafts. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub to: f64,
    /// Corners of the inside wall in order: y of each, in the housing. [mm]
    #[schemars(inner(range(min = -1e5, max = 1e5)), length(min = 3))]
    pub y: Vec<f64>,
    /// z of each corner, upwards. [mm]
    #[schemars(inner(range(min = -1e5, max = 1e5)), length(min = 3))]
    pub z: Vec<f64>,
}

/// The outside of the housing, where it dissipates heat to the air.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
pub struct OutsideEntry {
    /// Length, width and height of a box around the housing; used for omitted values. [mm]
    #[serde(rename = "box")]
    #[schemars(inner(range(min = 1.0, max = 1e5)))]
    pub sides: Option<[f64; 3]>,
    /// Area of the mounting face, which dissipates no heat to the air. [cm2]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub mounting_area: f64,
    /// Area that dissipates heat to the air, without fins; default: that of the box without its mounting face. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub area: Option<f64>,
    /// Oil-wetted inside area; default: the outside area. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub oil_area: Option<f64>,
    /// Height; default: that of the box. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub height: Option<f64>,
    /// Length along the air flow; default: that of the box. [mm]
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
    /// Air speed along the housing; zero for still air. [m/s]
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
    /// How the temperature is determined.
    #[serde(default)]
    pub mode: ThermalMode,
    /// Oil temperature if it is given. [degC]
    #[serde(default = "eighty")]
    #[schemars(range(min = -60.0, max = 250.0), extend("x-also-called" = ["temperature", "oil_temperature"]))]
    pub oil: f64,
    /// Ambient temperature. [degC]
    #[serde(default = "twenty")]
    #[schemars(range(min = -60.0, max = 120.0))]
    pub ambient: f64,
    /// Maximum oil temperature of the search for a balance. [degC]
    #[serde(default = "hottest")]
    #[schemars(range(min = 0.0, max = 250.0))]
    pub maximum: f64,
    /// Thermal resistance between the oil and the surface of the housing; zero if both have one temperature. [K/W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub oil_to_surface: f64,
    /// Heat from other sources, by name, such as a flange-mounted motor.
    #[serde(default, skip_serializing_if = "Ordered::is_empty")]
    pub sources: Ordered<HeatSource>,
    /// Heat dissipation paths by name; their heat flows add up. They replace those in `models`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat_dissipation: Option<NamedSlots<HeatDissipation>>,
    /// Nodes with their own temperatures, for `mode: network`: `auto`, or nodes, links and flows as written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkChoice>,
}

/// Heat that does not come from the losses.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct HeatSource {
    /// Heat flow. [W]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub heat: f64,
    /// Where it enters.
    #[serde(default)]
    pub into: HeatInto,
}

/// Where heat enters.
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

/// How the temperature is determined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ThermalMode {
    /// Given.
    #[default]
    Fixed,
    /// From the balance of losses and heat dissipation.
    Balance,
    /// From the heat balance of every node of the thermal network.
    Network,
}
