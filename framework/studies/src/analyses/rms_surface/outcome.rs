//! The outcome of a surface.

use gearloss_numerics::inference::Side;
use schemars::JsonSchema;
use serde::Serialize;

use super::least::{Flat, Least};
use crate::analyses::trial::Left;
use crate::analyses::{Head, Outcome};
use crate::analysis::Note;
use crate::cells;
use crate::study::{Difference, Quantity};
use crate::table::{Column, Table};

/// Surfaces of the difference from measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RmsSurfaceOutcome {
    /// Where it comes from.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub surfaces: Vec<SurfaceOfSet>,
    /// How the difference counts.
    #[serde(skip)]
    pub difference: Difference,
    /// What reading the measured points brought up.
    #[serde(skip)]
    pub measured_notes: Vec<String>,
    /// Number of measured points, those that count nowhere included.
    #[serde(skip)]
    pub measured_points: usize,
    /// Stated ranges that were left at some pair.
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
    /// What is compared.
    pub quantity: Quantity,
    /// Unit of the differences: `percent`, `points`, `w`, `nm` or `k`.
    pub unit: &'static str,
    /// Number of points that count, the same at all pairs.
    pub points: usize,
    /// Points that count nowhere, because they lack a value at some pair.
    pub left_out: Vec<PointLeftOut>,
    /// Accuracy of the measurement, in the unit of the differences; absent where none is known.
    pub accuracy: Option<f64>,
    /// The first quantity.
    pub x: AxisOfSurface,
    /// The second quantity.
    pub y: AxisOfSurface,
    /// Every pair of values, those of x innermost.
    pub pairs: Vec<PairOfSurface>,
    /// The least value.
    pub least: LeastOfSurface,
    /// The least value by the numbers of the values along the axes.
    #[serde(skip)]
    pub least_place: Least,
}

/// A measured point that counts nowhere.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointLeftOut {
    /// Line in its file.
    pub line: u64,
    /// Name, where the file has names.
    pub name: Option<String>,
    /// Why.
    pub reason: String,
    /// Its file, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// A quantity of the gearbox and its values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct AxisOfSurface {
    /// Path as it is written in the study.
    pub path: String,
    /// Paths that it meets.
    pub paths: Vec<String>,
    /// Unit of the values; empty for a factor.
    pub unit: &'static str,
    /// Rising values, in that unit.
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
    /// Root of the weighted mean square of the differences, in their unit; absent where the pair has no value.
    pub rms: Option<f64>,
    /// Why it has none.
    pub reason: Option<String>,
}

/// The least value of a surface.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LeastOfSurface {
    /// Value of x, in its unit.
    pub x: f64,
    /// Value of y, in its unit.
    pub y: f64,
    /// Root of the mean square there, in the unit of the differences.
    pub rms: f64,
    /// End of x at which it is, `lower` or `upper`: the values would perhaps fall beyond.
    pub x_end: Option<&'static str>,
    /// End of y at which it is.
    pub y_end: Option<&'static str>,
    /// Whether anything changes along x.
    pub x_depends: bool,
    /// Whether anything changes along y.
    pub y_depends: bool,
    /// Where some value is within 5 % of it.
    pub close: RangeOfSurface,
    /// Where some value is above it by less than the accuracy of one measurement; absent where none is known.
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
        let axis = |axis: &AxisOfSurface| {
            let unit = if axis.unit.is_empty() { "-" } else { axis.unit };
            Column::number(&axis.path, unit, "Value of the path")
        };
        let mut table = Table::new(
            &self.head.analysis,
            [
                Column::text("model_set", "Model set"),
                axis(&first.x),
                axis(&first.y),
                Column::number("points", "-", "Number of points that count"),
                Column::number(
                    format!("rms_{}", first.unit),
                    symbol,
                    "Root of the mean square of the differences",
                ),
            ],
        );
        for surface in &self.surfaces {
            for pair in &surface.pairs {
                let points = if pair.rms.is_some() { surface.points } else { 0 };
                table.push(cells![&surface.model_set, pair.x, pair.y, points, pair.rms]);
            }
        }
        vec![table]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<(&str, &str)> {
        let left = self.left_at_pairs.iter();
        left.map(|(path, name)| (path.as_str(), name.as_str())).collect()
    }
}
