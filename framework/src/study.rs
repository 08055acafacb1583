//! Studies: gearboxes, conditions, grids and analyses as data.

mod axes;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use axes::{Span, SpeedAxis, SpeedSpan, TorqueAxis, TorqueSpan};

use crate::description::Ordered;
use crate::evaluate::PowerFlow;

/// A study.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "study")]
pub struct StudyEntry {
    /// Kind and format version of the document.
    pub gearloss: StudyFormat,
    /// Title for reports.
    pub title: Option<String>,
    /// Gearbox files by name, relative to the study.
    pub gearboxes: Ordered<String>,
    /// What every analysis starts from.
    #[serde(default)]
    pub conditions: Conditions,
    /// Grids of operating points by name.
    #[serde(default)]
    pub grids: Ordered<Grid>,
    /// Analyses by name; the names become folders and file names.
    pub analyses: Ordered<Analysis>,
}

/// Kind and format version of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum StudyFormat {
    /// The first format.
    #[serde(rename = "study/1")]
    One,
}

/// What every analysis starts from.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Conditions {
    /// Port at which the torque is given, as applied to the transmission.
    #[serde(default = "input")]
    pub torque_at: String,
    /// Port at which the speed is given.
    #[serde(default = "input")]
    pub speed_at: String,
    /// Temperature of the oil; absent, that of the gearbox. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil_temperature: Option<f64>,
    /// Whether losses change the torques of what comes after them.
    #[serde(default)]
    pub power_flow: PowerFlow,
    /// Overrides: resolved path to value.
    #[serde(default)]
    pub set: Ordered<Value>,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            torque_at: input(),
            speed_at: input(),
            oil_temperature: None,
            power_flow: PowerFlow::Real,
            set: Ordered::default(),
        }
    }
}

fn input() -> String {
    "input".to_owned()
}

/// A grid of operating points: every torque at every speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Grid {
    /// Gear state.
    pub gear: String,
    /// Torques: one, a list, or from, to and step.
    pub torque: TorqueAxis,
    /// Speeds: one, a list, or from, to and step.
    pub speed: SpeedAxis,
}

/// An analysis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Analysis {
    /// Losses and efficiency over a grid.
    Map(MapEntry),
    /// Difference between sets of models over a grid.
    Compare(CompareEntry),
    /// Losses by mechanism or component over speed.
    Breakdown(BreakdownEntry),
    /// Several models of one component over speed.
    ComponentCompare(ComponentCompareEntry),
    /// Speeds, load, pressure, friction, film and loss along the path of contact of one mesh.
    ContactPath(ContactPathEntry),
}

/// Losses and efficiency over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MapEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid.
    pub grid: String,
    /// Sets of models; absent, the models of the gearbox.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Formats to write; absent, both.
    #[serde(default = "both")]
    pub write: Vec<Write>,
}

/// Difference between sets of models over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CompareEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid.
    pub grid: String,
    /// Set that the others are compared with.
    pub base: String,
    /// Sets to compare.
    #[schemars(length(min = 1))]
    pub against: Vec<String>,
    /// What is compared.
    #[serde(default)]
    pub quantity: Quantity,
    /// How the difference counts: the other set minus the base.
    #[serde(default)]
    pub difference: Difference,
    /// Formats to write; absent, both.
    #[serde(default = "both")]
    pub write: Vec<Write>,
}

/// Losses by mechanism or component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BreakdownEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the whole loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; absent, both.
    #[serde(default = "both")]
    pub write: Vec<Write>,
}

/// Several models of one component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ComponentCompareEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Path of the component, such as `bearings.B1`, `meshes.M1` or `gears.G4.drag.churning`.
    pub component: String,
    /// Models by name, each as in a gearbox: `{ type: skf }`. The other components keep theirs.
    pub models: Ordered<Value>,
    /// Set of models for everything else; absent, the models of the gearbox.
    pub model_set: Option<String>,
    /// Overrides for this analysis: resolved path to value, such as `meshes.M2.drag.churning: none`.
    #[serde(default)]
    pub set: Ordered<Value>,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// CSV file with measured points: columns `torque [Nm]` and `speed [rpm]` of the study's ports, and `loss [W]`. Each is
    /// compared with every model at that torque and speed.
    pub measured: Option<String>,
    /// Formats to write; absent, both.
    #[serde(default = "both")]
    pub write: Vec<Write>,
}

/// Speeds, load, pressure, friction, film and loss along the path of contact of one mesh.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ContactPathEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Mesh, one of `meshes`.
    pub mesh: String,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Number of places. [-]
    #[serde(default = "places")]
    #[schemars(range(min = 3, max = 2001))]
    pub places: u32,
    /// Formats to write; absent, both.
    #[serde(default = "both")]
    pub write: Vec<Write>,
}

fn places() -> u32 {
    101
}

fn both() -> Vec<Write> {
    vec![Write::Csv, Write::Json]
}

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Write {
    /// Comma-separated values.
    Csv,
    /// JSON.
    Json,
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Efficiency.
    #[default]
    Efficiency,
    /// Sum of all losses.
    Loss,
}

/// How a difference counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    /// Efficiency points (0.01), or watts for a loss.
    #[default]
    Points,
    /// Percent of the base.
    Percent,
}

/// What losses are summed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// By mechanism.
    #[default]
    Mechanism,
    /// By component.
    Component,
    /// By the usual sums: gears, bearings, seals, others; load-dependent and not.
    Sum,
}

/// Unit of a breakdown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum As {
    /// Watts.
    #[default]
    Watts,
    /// Percent of the whole loss.
    Percent,
}
