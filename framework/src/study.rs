//! Studies: gearboxes, conditions, grids and analyses as data.

mod axes;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use axes::{Span, SpeedAxis, SpeedSpan, TorqueAxis, TorqueSpan};

use crate::description::Ordered;
use crate::evaluate::PowerFlow;
use crate::measured::MeasuredEntry;

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
    /// Temperature of the oil; absent, that of the gearbox: the one stated there, or that of the balance at each point. [degC]
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
    /// Values that change from point to point beside torque and speed: resolved path to values, such as
    /// `housing.oil.volume: [60 ml, 90 ml]`. Every combination is solved.
    #[serde(default)]
    pub bind: Ordered<Value>,
}

impl Grid {
    /// Every combination of the bound values, as overrides; one without any where nothing is bound.
    ///
    /// # Errors
    /// The path of which no values are listed.
    pub fn combinations(&self) -> Result<Vec<Vec<(String, Value)>>, String> {
        let mut all: Vec<Vec<(String, Value)>> = vec![Vec::new()];
        for (path, values) in self.bind.iter() {
            let values = values
                .as_array()
                .filter(|list| !list.is_empty())
                .ok_or_else(|| path.to_owned())?;
            all = all
                .iter()
                .flat_map(|before| {
                    values.iter().map(|value| {
                        let mut more = before.clone();
                        more.push((path.to_owned(), value.clone()));
                        more
                    })
                })
                .collect();
        }
        Ok(all)
    }
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
    /// Losses of a list of operating points from a file, as stacked bars, with room for what was measured.
    OperatingPoints(OperatingPointsEntry),
    /// The torque, or the speed, at which the balance reaches a given temperature.
    ThermalLimit(ThermalLimitEntry),
    /// How the temperature of one point is found: losses and heat over temperature, and every step.
    Balance(BalanceEntry),
    /// Losses and efficiency over the values of one path.
    Sweep(SweepEntry),
}

/// Losses and efficiency over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MapEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid.
    pub grid: String,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Formats to write; absent, CSV and JSON. Pictures show efficiency, loss and, with a balance, temperature.
    #[serde(default = "data")]
    pub write: Vec<WriteAlso>,
}

/// Losses of a list of operating points from a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OperatingPointsEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// CSV file beside the study, one row for each point: `name`, `torque [Nm]`, `speed [rpm]`, the columns of `bind`, and what
    /// was measured: `measured_loss [W]`, `measured_oil_temperature [degC]`, `measured_surface_temperature [degC]`, each with an
    /// error such as `measured_loss_error [W]` or `measured_surface_temperature_error [K]`. Cells of measured columns may be empty.
    pub file: String,
    /// Columns that change a value of the gearbox: column to resolved path, such as `volume: housing.oil.volume`. The unit stands
    /// in the header: `volume [ml]`.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "all")]
    pub write: Vec<WriteAlso>,
}

/// The torque, or the speed, at which the balance reaches a given temperature.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ThermalLimitEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Temperatures of the oil that may be reached. [degC]
    #[schemars(inner(range(min = 0.0, max = 250.0)), length(min = 1))]
    pub temperature: Vec<f64>,
    /// What is looked for: the torque at each speed, or the speed at each torque.
    #[serde(default)]
    pub find: Find,
    /// Torques: the range in which the limit is looked for, from the value nearest to zero to the farthest; or those at which
    /// the speed is.
    pub torque: TorqueAxis,
    /// Speeds: those at which the torque is looked for; or the range in which the limit is.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "all")]
    pub write: Vec<WriteAlso>,
}

/// What a limit is looked for in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Find {
    /// The torque at each speed.
    #[default]
    Torque,
    /// The speed at each torque.
    Speed,
}

/// Losses and efficiency over the values of one path.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SweepEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Resolved path whose value changes, such as `lubricants.sump.viscosity.kv100`, or `thermal.oil` for the temperature.
    pub path: String,
    /// Values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "all")]
    pub write: Vec<WriteAlso>,
}

/// How the temperature of one point is found.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BalanceEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Overrides for this analysis: resolved path to value.
    #[serde(default)]
    pub set: Ordered<Value>,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "all")]
    pub write: Vec<WriteAlso>,
}

/// Difference between sets of models, and products, over a grid; or between them and what was measured.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CompareEntry {
    /// Gearbox of every set that names none; absent, the first.
    pub gearbox: Option<String>,
    /// Grid; not with `data`.
    pub grid: Option<String>,
    /// Set that the others are compared with; not with `data`. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    pub base: Option<String>,
    /// Measured points that the sets are compared with.
    pub data: Option<MeasuredEntry>,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// Gear state of the data where no column says it; absent, the first.
    pub gear: Option<String>,
    /// Sets to compare; `PRODUCT/SET` takes another gearbox.
    #[schemars(length(min = 1))]
    pub against: Vec<String>,
    /// What is compared.
    #[serde(default)]
    pub quantity: Quantity,
    /// How the difference counts: the other set minus the base, or the model minus the measurement.
    #[serde(default)]
    pub difference: Difference,
    /// Formats to write; absent, CSV and JSON. Pictures show the differences and, with data, parity.
    #[serde(default = "data")]
    pub write: Vec<WriteAlso>,
}

/// Losses by mechanism or component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BreakdownEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
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
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
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

fn data() -> Vec<WriteAlso> {
    vec![WriteAlso::Csv, WriteAlso::Json]
}

fn all() -> Vec<WriteAlso> {
    vec![WriteAlso::Csv, WriteAlso::Json, WriteAlso::Svg]
}

/// A format to write, pictures among them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WriteAlso {
    /// Comma-separated values.
    Csv,
    /// JSON.
    Json,
    /// Pictures, one file each.
    Svg,
}

impl WriteAlso {
    /// The formats of data among those asked for.
    pub fn data(list: &[Self]) -> Vec<Write> {
        let data = |format: &Self| match format {
            Self::Csv => Some(Write::Csv),
            Self::Json => Some(Write::Json),
            Self::Svg => None,
        };
        list.iter().filter_map(data).collect()
    }
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
    /// Loss over the speed of the reference port.
    LossTorque,
    /// Temperature of the oil, where it is found by balance.
    Temperature,
}

impl Quantity {
    /// Name in results, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss_w",
            Self::LossTorque => "loss_torque_nm",
            Self::Temperature => "oil_temperature_degc",
        }
    }

    /// Unit of a difference.
    pub fn unit(self, difference: Difference) -> &'static str {
        match (difference, self) {
            (Difference::Percent, _) => "percent",
            (Difference::Points, Self::Efficiency) => "points",
            (Difference::Points, Self::Loss) => "w",
            (Difference::Points, Self::LossTorque) => "nm",
            (Difference::Points, Self::Temperature) => "k",
        }
    }

    /// The quantity and the unit of a difference in words.
    pub fn words(self, difference: Difference) -> (&'static str, &'static str) {
        let what = match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss",
            Self::LossTorque => "loss torque",
            Self::Temperature => "oil temperature",
        };
        let unit = match (difference, self) {
            (Difference::Percent, _) => "%",
            (Difference::Points, Self::Efficiency) => "efficiency points",
            (Difference::Points, Self::Loss) => "W",
            (Difference::Points, Self::LossTorque) => "Nm",
            (Difference::Points, Self::Temperature) => "K",
        };
        (what, unit)
    }

    /// The other value minus the base, in that unit; absent where the base is zero and a percentage is asked for.
    pub fn difference(self, difference: Difference, base: f64, other: f64) -> Option<f64> {
        match (difference, self) {
            (Difference::Percent, _) => (base != 0.0).then(|| 100.0 * (other - base) / base),
            (Difference::Points, Self::Efficiency) => Some(100.0 * (other - base)),
            (Difference::Points, _) => Some(other - base),
        }
    }
}

/// How a difference counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    /// Efficiency points (0.01), watts for a loss, kelvins for a temperature.
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
