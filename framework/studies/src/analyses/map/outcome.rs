//! Results of maps: records, tables as columns, and additional data for figures and texts.

use gearloss_fmu::Library;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::super::{Head, Outcome};
use super::best::BestGears;
use super::export::{ExportData, ExportName};
use super::map_of::MapOf;
use super::points::MapPoints;
use super::shown::ShownMap;
use crate::analyses::common::outside_maps::MachineOutside;
use crate::distinct::distinct;
use crate::limits::at_points::LimitColumn;
use crate::numbers::word;
use crate::points::{Note, OilTemperature, WeakPoint};
use crate::study::Envelope;
use crate::table::Table;

/// The maps of an analysis.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MapOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// Whose efficiency and loss the figures and exported tables show; absent of the gearbox.
    #[serde(skip_serializing_if = "MapOf::is_gearbox")]
    pub of: MapOf,
    /// One for each gear, each model set and each combination of bound values.
    pub maps: Vec<MapOfSet>,
    /// The points of all maps; without rows if these were passed to [`Engine::sink`].
    #[serde(skip)]
    pub table: Table,
    /// Notes on the file of points.
    #[serde(skip)]
    pub about_points: Vec<String>,
    /// Notes on the file of measured points.
    #[serde(skip)]
    pub about_measured: Vec<String>,
    /// Measured points for figures.
    #[serde(skip)]
    pub marks: Vec<Mark>,
    /// Maximum torque over speed, beyond which there are no points.
    #[serde(skip)]
    pub envelope: Option<Envelope>,
    /// Combined notes of all maps of a set, if they form one table over a bound value.
    #[serde(skip)]
    pub notes_of_sets: Option<Vec<NotesOfSet>>,
    /// Requested tables for other programs.
    #[serde(skip)]
    pub exports: Vec<ExportName>,
    /// Maximum relative deviation of the straight lines of a `lossy_gear` table.
    #[serde(skip)]
    pub lossy_gear_limit: f64,
    /// Libraries for the FMUs; empty unless one is exported.
    #[serde(skip)]
    pub libraries: Vec<Library>,
}

/// A map with one model set, one gear and one combination of bound values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MapOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state; `best` if each point has its own.
    pub gear: String,
    /// The gears of a map in the best gear of each point; absent otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_gears: Option<BestGears>,
    /// Bound values: resolved path to value.
    pub bound: serde_json::Map<String, Value>,
    /// Oil temperature; absent if each point has its own. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// The sums of losses of each point.
    pub sums: Vec<SumMeaning>,
    /// The components whose losses are listed for each point, in order.
    pub parts: Vec<PartModel>,
    /// Number of iterations over the loss models.
    pub passes: usize,
    /// Machines that are outside their loss maps at some points; absent if none is.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub outside_maps: Vec<MachineOutside>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Formulas, defaults and data with low evidence grades.
    pub evidence: Vec<WeakPoint>,
    /// The points.
    #[schemars(with = "Vec<super::points::MapPoint<'static>>")]
    pub points: MapPoints,
    /// Whose efficiency and loss is shown.
    #[serde(skip)]
    pub of: MapOf,
    /// Origin of the oil temperature.
    #[serde(skip)]
    pub oil: OilTemperature,
    /// Limits of the study at points, in the order of the values of the shown points.
    #[serde(skip)]
    pub limits: Vec<LimitColumn>,
    /// Data for figures and text.
    #[serde(skip)]
    pub shown: ShownMap,
    /// Further data for tables of other programs.
    #[serde(skip)]
    pub export: ExportData,
}

/// A sum of losses.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct SumMeaning {
    /// Name.
    pub sum: &'static str,
    /// Description.
    pub meaning: &'static str,
}

/// A component with losses.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PartModel {
    /// Path.
    pub part: String,
    /// Loss mechanism.
    pub mechanism: &'static str,
    /// Model.
    pub model: &'static str,
}

/// A measured point for figures.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Gear; absent: any.
    pub gear: Option<String>,
    /// Torque. [Nm]
    pub torque: f64,
    /// Speed. [rad/s]
    pub speed: f64,
}

/// Notes of all maps of a set.
#[derive(Debug, Clone)]
pub struct NotesOfSet {
    /// Name of the set.
    pub model_set: String,
    /// The notes.
    pub notes: Vec<Note>,
}

impl MapOfSet {
    /// The bound values, for a heading.
    pub fn bound_words(&self) -> String {
        let words = self
            .bound
            .iter()
            .map(|(path, value)| format!(", {path} {}", word(value)));
        words.collect()
    }
}

impl MapOutcome {
    /// Names of the sets in the order of the maps.
    pub fn set_names(&self) -> Vec<&str> {
        distinct(self.maps.iter().map(|map| map.model_set.as_str()))
    }
}

impl Outcome for MapOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.table.clone()]
    }

    fn notes(&self) -> Vec<&Note> {
        match &self.notes_of_sets {
            Some(sets) => sets.iter().flat_map(|set| &set.notes).collect(),
            None => self.maps.iter().flat_map(|map| &map.notes).collect(),
        }
    }
}
