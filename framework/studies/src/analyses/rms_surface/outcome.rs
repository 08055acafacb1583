//! The outcome of a surface.

use gearloss_numerics::inference::Side;
use schemars::JsonSchema;
use serde::Serialize;

use super::least::{Flat, Least};
use crate::analyses::common::trial::Left;
use crate::analyses::{Head, Outcome};
use crate::points::Note;
use crate::study::{Difference, Quantity};
use crate::table::Table;

/// Surfaces of the difference from measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RmsSurfaceOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub surfaces: Vec<SurfaceOfSet>,
    /// Kind of difference.
    #[serde(skip)]
    pub difference: Difference,
    /// Notes on the file of measured points.
    #[serde(skip)]
    pub measured_notes: Vec<String>,
    /// Number of measured points, including omitted ones.
    #[serde(skip)]
    pub measured_points: usize,
    /// Quantities outside their stated ranges at any pair.
    #[serde(skip)]
    pub left_at_pairs: Left,
}

/// The surface of one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SurfaceOfSet {
    /// Name of the set.
    pub model_set: String,
    /// File of the measured points.
    pub file: String,
    /// Compared quantity.
    pub quantity: Quantity,
    /// Unit of the differences: `percent`, `points`, `w`, `nm` or `k`.
    pub unit: &'static str,
    /// Number of points used, the same at all pairs.
    pub points: usize,
    /// Points that are omitted because they have no value at some pair.
    pub left_out: Vec<PointLeftOut>,
    /// Accuracy of the measurement, in the unit of the differences; absent if unknown.
    pub accuracy: Option<f64>,
    /// The first quantity.
    pub x: AxisOfSurface,
    /// The second quantity.
    pub y: AxisOfSurface,
    /// Every pair of values, those of x innermost.
    pub pairs: Vec<PairOfSurface>,
    /// The minimum.
    pub least: LeastOfSurface,
    /// The minimum by indices along the axes.
    #[serde(skip)]
    pub least_place: Least,
}

/// An omitted measured point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointLeftOut {
    /// Line in its file.
    pub line: u64,
    /// Name, if the file has names.
    pub name: Option<String>,
    /// Why.
    pub reason: String,
    /// Its file, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// A quantity of the gearbox and its values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct AxisOfSurface {
    /// Path as in the study.
    pub path: String,
    /// Paths that it matches.
    pub paths: Vec<String>,
    /// Unit of the values; empty for a factor.
    pub unit: &'static str,
    /// Ascending values, in that unit.
    pub values: Vec<f64>,
    /// The values with their unit.
    #[serde(skip)]
    pub words: Vec<String>,
}

/// The difference at a pair of values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PairOfSurface {
    /// Value of x, in its unit.
    pub x: f64,
    /// Value of y, in its unit.
    pub y: f64,
    /// Weighted root mean square of the differences, in their unit; absent if the pair has no value.
    pub rms: Option<f64>,
    /// Why it has none.
    pub reason: Option<String>,
}

/// The minimum of a surface.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LeastOfSurface {
    /// Value of x, in its unit.
    pub x: f64,
    /// Value of y, in its unit.
    pub y: f64,
    /// Root mean square there, in the unit of the differences.
    pub rms: f64,
    /// End of x at which it is, `lower` or `upper`: the values may decrease beyond.
    pub x_end: Option<&'static str>,
    /// End of y at which it is.
    pub y_end: Option<&'static str>,
    /// Whether the values change along x.
    pub x_depends: bool,
    /// Whether the values change along y.
    pub y_depends: bool,
    /// Range with a value within 5 % of it.
    pub close: RangeOfSurface,
    /// Range with a value above it by less than the accuracy of one measurement; absent if unknown.
    pub within_accuracy: Option<RangeOfSurface>,
}

/// Ranges of both quantities.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct RangeOfSurface {
    /// Lower and upper end along x, in its unit.
    pub x: [f64; 2],
    /// Lower and upper end along y, in its unit.
    pub y: [f64; 2],
}

impl LeastOfSurface {
    pub(super) fn new(least: &Least, x: &[f64], y: &[f64]) -> Self {
        let range = |flat: &Flat| RangeOfSurface {
            x: flat[0].map(|place| x[place]),
            y: flat[1].map(|place| y[place]),
        };
        Self {
            x: x[least.place[0]],
            y: y[least.place[1]],
            rms: least.value,
            x_end: least.ends[0].map(Side::name),
            y_end: least.ends[1].map(Side::name),
            x_depends: least.depends[0],
            y_depends: least.depends[1],
            close: range(&least.close),
            within_accuracy: least.unseen.as_ref().map(range),
        }
    }
}

impl Outcome for RmsSurfaceOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let Some(first) = self.surfaces.first() else {
            return Vec::new();
        };
        let (_, symbol) = first.quantity.words(self.difference);
        let unit = |axis: &AxisOfSurface| if axis.unit.is_empty() { "-" } else { axis.unit };
        let table = Table::of_each(&self.head.analysis, &self.surfaces, |surface| &surface.pairs)
            .text("model_set", "Model set", |(surface, _)| &surface.model_set)
            .number(&first.x.path, unit(&first.x), "Value of the path", |(_, pair)| pair.x)
            .number(&first.y.path, unit(&first.y), "Value of the path", |(_, pair)| pair.y)
            .number("points", "-", "Number of points used", |(surface, pair)| {
                if pair.rms.is_some() { surface.points as f64 } else { 0.0 }
            })
            .number(
                format!("rms_{}", first.unit),
                symbol,
                "Root mean square of the differences",
                |(_, pair)| pair.rms,
            );
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.left_at_pairs.iter().collect()
    }
}
