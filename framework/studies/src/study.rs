//! Studies: gearboxes, conditions, grids and analyses as data.

mod axes;
mod by;
mod cautions;
mod compare;
mod data;
mod drive;
mod files;
mod gear;
mod identify;
pub(crate) mod limits;
mod names;
mod parameters;
mod range;
mod then;
mod together;
mod tolerance;
mod write;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use axes::{AxisError, Envelope, OfRating, PowerAxis, Shares, Span, SpeedAxis, TemperatureAxis, TorqueAxis};
pub use by::By;
pub use cautions::Cautions;
pub use compare::{Difference, Quantity};
pub use data::Data;
pub use drive::{DriveEntry, RideEntry};
pub use files::Study;
pub use gear::{BEST, Choose, ChosenGear, CycleGear};
pub use identify::{
    FoldsBy, FoldsEntry, HoldOutEntry, HoldOutRows, IdentifiedEntry, MeanEntry, OverEntry, PriorEntry, RelativeTo,
    ScaleEntry,
};
pub use limits::{LimitEntry, LimitedQuantity, Severity};
pub use names::is_device;
pub use parameters::{NameOr, NamesOrParameters, ParameterKey};
pub use range::RangeEntry;

pub use then::Then;
pub use together::{Together, joined};
pub use tolerance::{Shape, ToleranceEntry};
pub use write::Write;

use crate::analyses::AnalysisEntry;
use crate::duty::{CycleEntry, VehicleEntry};
use crate::measured::MeasuredEntry;
use gearloss_framework::description::Ordered;
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::language::STUDY;
use gearloss_framework::registry::DocumentKind;
use gearloss_framework::transmission::Transmission;

/// A study.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "study")]
pub struct StudyEntry {
    /// Kind and format version of the document.
    #[schemars(extend("x-also-called" = ["schema", "format", "kind"]))]
    pub gearloss: StudyFormat,
    /// Title for reports.
    pub title: Option<String>,
    /// The question of the study, shown at the top of the report.
    pub question: Option<String>,
    /// Analyses whose results answer the question, the most important first; default: the first three with a result in one sentence.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "analyses"))]
    pub answered_by: Vec<String>,
    /// Operating point for forces, power balance and evidence of losses in the report; default: maximum torque and speed of the first grid.
    pub report_at: Option<ReportAt>,
    /// Gearbox files by name, relative to the study.
    #[schemars(extend("x-refers-to" = "file"))]
    pub gearboxes: Ordered<String>,
    /// Conditions of all analyses.
    #[serde(default)]
    pub conditions: Conditions,
    /// Measured points by name.
    #[serde(default)]
    pub measurements: Ordered<MeasuredEntry>,
    /// Parameters by name, for analyses that refer to them: `parameters: [viscosity, roughness]`.
    #[serde(default)]
    pub parameters: Ordered<IdentifiedEntry>,
    /// Cycles by name: shipped driving cycles, recorded series, load spectra.
    #[serde(default)]
    pub cycles: Ordered<CycleEntry>,
    /// Vehicles by name, for cycles with a vehicle speed only.
    #[serde(default)]
    pub vehicles: Ordered<VehicleEntry>,
    /// Limits of quantities by name: every analysis reports where they are not kept, `optimise` and `fluid_sweep` keep them.
    #[serde(default)]
    pub limits: Ordered<LimitEntry>,
    /// Grids of operating points by name.
    #[serde(default)]
    pub grids: Ordered<Grid>,
    /// Analyses by name; the names are used for folders and files.
    pub analyses: Ordered<AnalysisEntry>,
}

crate::analyses::submit! { DocumentKind { name: STUDY, schema: StudyEntry::json_schema } }

/// Kind and format version of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum StudyFormat {
    /// The first format.
    #[serde(rename = "study/1")]
    One,
}

/// The operating point of a report.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ReportAt {
    /// Gear; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
}

/// Conditions of all analyses.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Conditions {
    /// Port of the given torque, which is applied to the transmission.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub torque_at: String,
    /// Port with given speed.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub speed_at: String,
    /// Ports of the gearbox that turn at one speed and are combined into one port, `wheels`: both wheels of a driven axle on a straight
    /// road. Default: from the gearbox.
    #[schemars(length(min = 2))]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub wheels: Option<Vec<String>>,
    /// Speeds of the ports of `wheels` over their common speed, in the same order, as in a corner: `[1.06, 0.94]`. Default: from the
    /// gearbox, else all one. [-]
    #[schemars(inner(range(min = 0.0, max = 2.0)), length(min = 2))]
    pub wheel_speeds: Option<Vec<f64>>,
    /// Oil temperature; default: from the gearbox, given or by heat balance at each point. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil_temperature: Option<f64>,
    /// Whether torque downstream is reduced by upstream losses.
    #[serde(default)]
    pub power_flow: PowerFlow,
    /// Overrides: resolved path to value.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub set: Ordered<Value>,
    /// Values that follow others in all analyses: resolved path to a formula of numbers and paths, such as `gears.W2.z: "107 - gears.P2.z"`.
    /// Numbers are in the documented unit of their path. Formulas are evaluated after all changes, in their order.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub follows: Ordered<Value>,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            torque_at: input(),
            speed_at: input(),
            wheels: None,
            wheel_speeds: None,
            oil_temperature: None,
            power_flow: PowerFlow::Real,
            set: Ordered::default(),
            follows: Ordered::default(),
        }
    }
}

fn input() -> String {
    "input".to_owned()
}

/// A grid of operating points: every torque at every speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Grid {
    /// Gear, or several; default: the first.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Gears,
    /// Torques: one, a list, or from, to and step; or fractions of the rating of the gearbox.
    pub torque: TorqueAxis,
    /// Speeds: one, a list, or from, to and step; or fractions of the rating of the gearbox.
    pub speed: SpeedAxis,
    /// Maximum torque over speed; points outside are omitted.
    pub envelope: Option<Envelope>,
    /// Further varied values in addition to torque and speed: resolved path to values, such as `housing.oil.volume: [60 ml, 90 ml]`. Every
    /// combination is solved.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub bind: Ordered<Value>,
}

/// One or several gears; in a map `best` is the one that draws least at each point.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Gears {
    /// One.
    One(String),
    /// Several.
    List(#[schemars(length(min = 1))] Vec<String>),
}

impl Default for Gears {
    fn default() -> Self {
        Self::List(Vec::new())
    }
}

impl Gears {
    /// The names as written; empty for the first of the gearbox.
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::List(names) => names,
        }
    }

    /// The names for a gearbox: its first gear if none is written.
    pub fn selected(&self, transmission: &Transmission) -> Vec<String> {
        match (self.names(), transmission.states()) {
            ([], [first, ..]) => vec![first.name.clone()],
            (names, _) => names.to_vec(),
        }
    }
}

impl Grid {
    /// Every combination of the bound values, as overrides; a single empty one if nothing is bound.
    ///
    /// # Errors
    /// The path without a list of values.
    pub(crate) fn combinations(&self) -> Result<Vec<Vec<(String, Value)>>, String> {
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

/// Names used by an analysis.
#[derive(Debug, Clone)]
pub struct Uses<'a> {
    /// Gearbox; default: the first.
    pub gearbox: Option<&'a String>,
    /// Grid.
    pub grid: Option<&'a String>,
    /// Its key.
    pub grid_key: &'static str,
    /// Sets of models.
    pub sets: Vec<&'a String>,
    /// Gears, in addition to those of the grid.
    pub gears: Vec<&'a String>,
    /// Data, each with its key.
    pub data: Vec<(&'static str, &'a Data)>,
    /// Columns of the data that change the gearbox.
    pub bind: Option<&'a Ordered<String>>,
    /// Duties.
    pub cycles: &'a [String],
    /// Vehicle.
    pub vehicle: Option<&'a String>,
    /// Whether a grid may have `gear: best`.
    pub best_gear: bool,
}

impl<'a> Uses<'a> {
    /// For a gearbox with model sets.
    pub fn new(gearbox: Option<&'a String>, sets: impl IntoIterator<Item = &'a String>) -> Self {
        Self {
            gearbox,
            grid: None,
            grid_key: "grid",
            sets: sets.into_iter().collect(),
            gears: Vec::new(),
            data: Vec::new(),
            bind: None,
            cycles: &[],
            vehicle: None,
            best_gear: false,
        }
    }

    pub(crate) fn driving(drive: &'a DriveEntry) -> Self {
        Self::new(drive.gearbox.as_ref(), &drive.model_sets)
            .in_gears(drive.gear.iter().flat_map(CycleGear::names))
            .riding(Some(&drive.ride))
    }

    /// With cycles and a vehicle.
    pub(crate) fn riding(self, ride: Option<&'a RideEntry>) -> Self {
        let Some(ride) = ride else { return self };
        Self {
            cycles: &ride.cycles,
            vehicle: ride.vehicle.as_ref(),
            ..self
        }
    }

    /// With data at a key.
    pub fn with(self, key: &'static str, data: Option<&'a Data>) -> Self {
        let mut uses = self;
        uses.data.extend(data.map(|data| (key, data)));
        uses
    }

    /// With columns of the data that change the gearbox.
    pub fn bind(self, bind: &'a Ordered<String>) -> Self {
        Self {
            bind: Some(bind),
            ..self
        }
    }

    /// Columns of the data at a key that change the gearbox; measured points of a map bind none.
    pub fn bound_of(&self, key: &str) -> Vec<&'a str> {
        let bind = self.bind.filter(|_| key != "measured");
        bind.map_or_else(Vec::new, |bind| bind.ids().collect())
    }

    /// With gears.
    pub fn in_gears(self, gears: impl IntoIterator<Item = &'a String>) -> Self {
        let gears = gears.into_iter().collect();
        Self { gears, ..self }
    }
}
