//! Loss tables for other programs: their data of a map. The formats register themselves, in any crate.

use std::borrow::Cow;
use std::fmt;

use gearloss_framework::document::did_you_mean;
use gearloss_framework::registry::inventory;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::axes::Axes;
use super::map_of::MapOf;
use super::outcome::{MapOfSet, MapOutcome};
use super::shown::{LossAt, LossGrid};
use crate::points::Given;

/// A format of loss tables.
pub trait ExportFormat: Sync {
    /// Its name under `export`.
    fn name(&self) -> &'static str;

    /// Description as a sentence.
    fn meaning(&self) -> &'static str;

    /// Whether a table can have these ascending axes.
    ///
    /// # Errors
    /// Errors of the axes.
    fn fits(&self, axes: &Axes) -> Result<(), Refusal>;

    /// Additional points whose loss torque it needs; `rated` is the rated torque in Nm.
    fn further_points(&self, _grid: &LossGrid, _rated: Option<f64>) -> Vec<Given> {
        Vec::new()
    }

    /// Whether its file contains the library of FMUs for each platform.
    fn has_library(&self) -> bool {
        false
    }

    /// Whether a table may be that of a drive unit or of its machines, whose losses are not all between two shafts.
    ///
    /// # Errors
    /// Why not, and what to use instead.
    fn takes(&self, of: MapOf) -> Result<(), Refusal> {
        if of.is_gearbox() {
            return Ok(());
        }
        Err(Refusal::new(
            format!(
                "`{}` describes losses between two shafts, not those{}, which are between the DC link and a shaft",
                self.name(),
                of.words()
            ),
            "export `fmu3`, `mat`, `matlab` or `modelica`, or delete `of` for the losses of the gearbox",
        ))
    }

    /// Whether its table has the oil temperature as an axis, so that maps that differ in it are one table, and those that differ in anything
    /// else none.
    fn joins_temperatures(&self) -> bool {
        false
    }

    /// The maps in the file of a map, for the interpolation error that is reported with it.
    fn covered<'a>(&self, map: &ExportMap<'a>) -> Vec<&'a MapOfSet> {
        vec![map.map]
    }

    /// The file of a map; absent if the file of another map contains it.
    ///
    /// # Errors
    /// Why there is none.
    fn file(&self, map: &ExportMap<'_>) -> Result<Option<ExportFile>, Refusal>;

    /// Files beside it.
    fn further_files(&self, _map: &ExportMap<'_>) -> Vec<ExportFile> {
        Vec::new()
    }
}

/// Why there is no table.
#[derive(Debug, Clone)]
pub struct Refusal {
    /// What is wrong.
    pub message: String,
    /// Help.
    pub help: String,
}

impl Refusal {
    /// An error.
    pub fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: help.into(),
        }
    }
}

/// A file for another program.
#[derive(Debug, Clone)]
pub struct ExportFile {
    /// Its name.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
    /// Notes as one line.
    pub about: String,
}

/// A map for a format.
pub struct ExportMap<'a> {
    /// All maps of the analysis.
    pub outcome: &'a MapOutcome,
    /// The map.
    pub map: &'a MapOfSet,
    /// Efficiency and loss torque over its grid.
    pub grid: &'a LossGrid,
    /// All maps of its set and gear, which differ in bound values, including itself.
    pub siblings: Vec<&'a MapOfSet>,
    /// Its number among them, starting at one.
    pub number: usize,
    /// Loss torques at the additional points; absent if there is none. [Nm]
    pub further: &'a [Option<f64>],
}

impl ExportMap<'_> {
    /// The grid of one of the maps with a row at zero torque, where the loss is the no-load loss.
    pub fn complete(map: &MapOfSet) -> Option<LossGrid> {
        let grid = map.shown.whole.as_ref()?;
        Some(grid.with_no_load(&map.export.no_load))
    }

    /// Name of a file of this map only, without extension.
    pub fn own_name(&self) -> String {
        let name = self.shared_name();
        if self.siblings.len() > 1 {
            format!("{name}-{}", self.number)
        } else {
            name
        }
    }

    /// Name of a common file of its siblings, without extension.
    pub fn shared_name(&self) -> String {
        let analysis = &self.outcome.head.analysis;
        format!("{analysis}-{}-{}", self.map.model_set, self.map.gear).replace('/', "-")
    }
}

/// A format that is linked into the program.
pub struct ExportKind(pub &'static dyn ExportFormat);

inventory::collect!(ExportKind);

/// Registers a format: `register_export!(Vecto);` with a unit struct.
#[macro_export]
macro_rules! register_export {
    ($format:expr) => {
        $crate::analyses::submit! {
            $crate::analyses::map::export::ExportKind(&$format)
        }
    };
}

/// A format as named in a study.
#[derive(Clone, Copy)]
pub struct ExportName(&'static dyn ExportFormat);

impl ExportName {
    /// The format.
    pub fn format(self) -> &'static dyn ExportFormat {
        self.0
    }

    /// All formats, in the order of their names.
    fn all() -> Vec<&'static dyn ExportFormat> {
        let mut all: Vec<_> = inventory::iter::<ExportKind>().map(|kind| kind.0).collect();
        all.sort_by_key(|format| format.name());
        all
    }
}

impl fmt::Debug for ExportName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.name())
    }
}

impl Serialize for ExportName {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.0.name())
    }
}

impl<'de> Deserialize<'de> for ExportName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let all = Self::all();
        let found = all.iter().find(|format| format.name() == name);
        found.map(|format| Self(*format)).ok_or_else(|| {
            let close = did_you_mean(&name, all.iter().map(|format| format.name()));
            let help = close.map_or_else(String::new, |close| format!(", did you mean `{close}`?"));
            D::Error::custom(format!("there is no format `{name}`{help}"))
        })
    }
}

impl JsonSchema for ExportName {
    fn schema_name() -> Cow<'static, str> {
        "Export".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let variant = |format: &&dyn ExportFormat| serde_json::json!({ "description": format.meaning(), "type": "string", "const": format.name() });
        let variants: Vec<serde_json::Value> = Self::all().iter().map(variant).collect();
        json_schema!({ "description": "A loss table for another program.", "oneOf": variants })
    }
}

/// Data of a map for tables of other programs, in addition to its points.
#[derive(Debug, Clone, Default)]
pub struct ExportData {
    /// Deviation of linear interpolation from the loss torque midway between the points, those at zero torque included: maximum and
    /// root mean square. Of a drive unit from its loss in W, which tables interpolate themselves or through the loss torque of the gearbox. [Nm]
    pub between: Option<(f64, f64)>,
    /// The rated torque. [Nm]
    pub rated: Option<f64>,
    /// For each format the loss torques at its additional points; absent if there is none. [Nm]
    pub further: Vec<Vec<Option<f64>>>,
    /// Losses at zero torque for each speed; empty if the grid has this torque.
    pub no_load: Vec<LossAt>,
    /// Speed of the other port over that of the reference port; absent unless there are two ports.
    pub ratio: Option<f64>,
    /// The machines of a map that shows them.
    pub machines: Vec<MachineAtSpeeds>,
    /// As `between`, midway also between this oil temperature and the next one among the maps of the same set and gear. [Nm]
    pub between_oils: Option<(f64, f64)>,
}

/// A machine over the speeds of a grid.
#[derive(Debug, Clone)]
pub struct MachineAtSpeeds {
    /// True at the reference port, whose torque and speed are those of the grid.
    pub at_reference: bool,
    /// True if its inverter is off without torque, so that its loss there is friction and iron alone.
    pub freewheels: bool,
    /// Largest torque at each speed; absent without an envelope. \[Nm\]
    pub most: Option<Vec<f64>>,
}
