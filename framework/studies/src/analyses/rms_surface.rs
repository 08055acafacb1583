//! Misfit between models and a measurement over two quantities of the gearbox.

mod least;
mod outcome;
mod solve;

use std::sync::Arc;

use gearloss_framework::description::Ordered;
use gearloss_framework::resolve::matches;
use gearloss_framework::variants::Variants;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use self::solve::{Counted, Pair, counted_points, pairs};
use super::common::measurable::{countable, measured};
use super::common::ranges::varied;
use super::common::trial::Left;
use super::{Analysis, Built, Engine, Plan, Planner, Stopped, Work};
use crate::measured::Measured;
use crate::register_analysis;
use crate::study::{Data, Difference, Quantity, Uses, Write};
use crate::varied::{Tie, Varied};

pub use self::least::{Flat, Least};
pub use self::outcome::{
    AxisOfSurface, LeastOfSurface, PairOfSurface, PointLeftOut, RangeOfSurface, RmsSurfaceOutcome, SurfaceOfSet,
};

/// Misfit between models and a measurement over two quantities of the gearbox.
///
/// The root mean square difference from measured points for every pair of values.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct RmsSurfaceEntry {
    /// Gearbox of sets without a product; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Measured points. Points without a value at any pair are omitted at all pairs, so that all pairs use the same points.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Data,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// Gear of the data without a column `gear`; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Model sets to compare with the data; `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[schemars(length(min = 1))]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub against: Vec<String>,
    /// Compared quantity.
    #[serde(default)]
    pub quantity: Quantity,
    /// Unit of the difference: model minus measurement.
    #[serde(default)]
    pub difference: Difference,
    /// Accuracy of the measurement, in the unit of the difference, if no column states it. [-]
    #[schemars(range(min = 0.0, max = 1e9), extend("x-bare" = true))]
    pub accuracy: Option<f64>,
    /// The first quantity.
    pub x: SurfaceAxisEntry,
    /// The second quantity.
    pub y: SurfaceAxisEntry,
}

/// A quantity of the gearbox and its values.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SurfaceAxisEntry {
    /// Resolved path; with `*` all matches change together.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: String,
    /// How several quantities change together.
    #[serde(default)]
    pub tie: Tie,
    /// Ascending values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`.
    #[schemars(length(min = 2))]
    pub values: Vec<Value>,
}

register_analysis!(RmsSurfaceEntry);

/// The gearbox with each set, both axes of each, and the measured rows.
pub struct RmsSurfacePlan<'a> {
    built: Vec<Arc<Built<'a>>>,
    axes: Vec<[Axis; 2]>,
    measured: Measured,
}

impl Plan for RmsSurfacePlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |(b, [x, y]): (&Arc<Built<'_>>, &[Axis; 2])| {
            let count = x.values.len() * y.values.len() * self.measured.rows.len();
            Work::new(&b.name, "row", count)
        };
        self.built.iter().zip(&self.axes).map(work).collect()
    }
}

impl Analysis for RmsSurfaceEntry {
    const TYPE: &'static str = "rms_surface";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = RmsSurfacePlan<'a>;
    type Outcome = RmsSurfaceOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.against)
            .in_gears(&self.gear)
            .bind(&self.bind)
            .with("data", Some(&self.data))
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<RmsSurfacePlan<'a>, Stopped> {
        let path = cx.path();
        countable(cx, &path, self.quantity, self.difference)?;
        measured(cx, &path, self.quantity)?;
        let bind: Vec<&str> = self.bind.ids().collect();
        let measured = cx.read(&format!("{path}.data"), &self.data, &bind)?;
        let rows = cx.study.rows(&measured, &self.bind, self.gear.as_deref(), false);
        let (mut built, mut axes) = (Vec::new(), Vec::new());
        for b in cx.built(cx.gearbox(self.gearbox.as_ref())?, &self.against)? {
            axes.push(self.axes(cx, &measured, &b)?);
            let variants = Variants::new(cx.language, b.gearbox, cx.study.choice(b.set()));
            cx.rows_fit(&rows, b.gearbox, &variants)?;
            built.push(b);
        }
        Ok(RmsSurfacePlan { built, axes, measured })
    }

    fn reduce<'a>(&'a self, plan: RmsSurfacePlan<'a>, engine: &Engine<'a>) -> Result<RmsSurfaceOutcome, Stopped> {
        let RmsSurfacePlan { built, axes, measured } = plan;
        let rows = engine.study.rows(&measured, &self.bind, self.gear.as_deref(), false);
        let mut left_at_pairs = Left::new();
        let sets = || built.iter().map(|b| &**b).zip(&axes);
        let solved = engine.parts(sets(), |(b, axes)| {
            pairs(engine, self, b, axes, &rows, &mut left_at_pairs)
        })?;
        let counted = counted_points(engine, self, &measured, sets().zip(&solved))?;
        let surfaces = sets().zip(solved);
        let surfaces = surfaces.map(|((b, axes), pairs)| self.surface(engine, &measured, &counted, b, axes, pairs));
        Ok(RmsSurfaceOutcome {
            surfaces: surfaces.collect::<Result<_, _>>()?,
            head: engine.head(&built),
            difference: self.difference,
            measured_points: measured.rows.len(),
            measured_notes: measured.notes,
            left_at_pairs,
        })
    }
}

/// A quantity and its values, ascending, in its unit.
struct Axis {
    varied: Varied,
    values: Vec<f64>,
}

impl Axis {
    fn new(cx: &Planner<'_>, path: &str, entry: &SurfaceAxisEntry, built: &Built<'_>) -> Result<Self, Stopped> {
        let varied = varied(cx, &format!("{path}.path"), (&entry.path, entry.tie), built)?;
        let mut values: Vec<f64> = Vec::new();
        for (i, written) in entry.values.iter().enumerate() {
            let wrong = |message: String, help: &str| {
                let message = format!("{}: {message}", entry.path);
                cx.wrong(&format!("{path}.values.{i}"), message, help)
            };
            let value = varied
                .quantity(written, false)
                .map_err(|reason| wrong(reason, "write a quantity of the path, such as `5 mm`"))?;
            let [least, greatest] = varied.range;
            if value < least || value > greatest {
                let message = format!("{} is outside {least} to {greatest}", varied.words(value));
                return Err(wrong(message, "delete it"));
            }
            if values.last().is_some_and(|last| *last >= value) {
                return Err(wrong(
                    "the values are not ascending".to_owned(),
                    "sort them and remove duplicates",
                ));
            }
            values.push(value);
        }
        Ok(Self { varied, values })
    }

    fn record(&self) -> AxisOfSurface {
        AxisOfSurface {
            path: self.varied.pattern.clone(),
            paths: self.varied.paths.clone(),
            unit: self.varied.unit.symbol,
            values: self.values.clone(),
            words: self.values.iter().map(|value| self.varied.words(*value)).collect(),
        }
    }
}

impl RmsSurfaceEntry {
    /// Both axes under one set.
    fn axes(&self, cx: &Planner<'_>, measured: &Measured, built: &Built<'_>) -> Result<[Axis; 2], Stopped> {
        let path = cx.path();
        let x = Axis::new(cx, &format!("{path}.x"), &self.x, built)?;
        let y = Axis::new(cx, &format!("{path}.y"), &self.y, built)?;
        let shared = |a: &[String], b: &[String]| a.iter().any(|path| b.contains(path));
        if shared(&x.varied.paths, &y.varied.paths) {
            let message = format!(
                "`{}` and `{}` change the same value",
                x.varied.pattern, y.varied.pattern
            );
            return Err(cx.wrong(
                &format!("{path}.y.path"),
                message,
                "choose another quantity for one of them",
            ));
        }
        for (key, axis) in [("x", &x), ("y", &y)] {
            let wrong = |message: String, help: &str| cx.wrong(&format!("{path}.{key}.path"), message, help);
            for (column, pattern) in self.bind.iter() {
                if shared(&axis.varied.paths, &matches(&built.resolved.value, pattern)) {
                    let message = format!("column `{column}` of the data changes `{}` too", axis.varied.pattern);
                    return Err(wrong(
                        message,
                        "delete the column from `bind`, or choose another quantity",
                    ));
                }
            }
            let oil = axis.varied.paths.iter().any(|path| path == "thermal.oil");
            if oil && measured.holds("oil_temperature") {
                let message = "the data give the temperature of every point, so it cannot be varied".to_owned();
                return Err(wrong(message, "choose another quantity"));
            }
        }
        Ok([x, y])
    }

    /// The surface of one set.
    fn surface(
        &self,
        cx: &Planner<'_>,
        measured: &Measured,
        counted: &Counted,
        built: &Built<'_>,
        [x, y]: &[Axis; 2],
        pairs: Vec<Pair>,
    ) -> Result<SurfaceOfSet, Stopped> {
        let path = cx.path();
        let rms: Vec<Option<f64>> = pairs.iter().map(|pair| pair.rms(measured, &counted.places)).collect();
        let Some(least) = Least::new(&rms, x.values.len(), counted.accuracy) else {
            let why = pairs.iter().find_map(|pair| pair.differences.as_ref().err());
            let message = format!(
                "models {}: no pair has a value: {}",
                built.name,
                why.map_or("no point has one", String::as_str)
            );
            return Err(cx.wrong(&path, message, "move the values of `x` and `y`"));
        };
        let left_out = |(i, reason): &(usize, String)| {
            let row = &measured.rows[*i];
            PointLeftOut {
                line: row.line,
                name: row.name.clone(),
                reason: reason.clone(),
                file: measured.file(row).map(str::to_owned),
            }
        };
        let pairs = pairs.into_iter().zip(rms).map(|(pair, rms)| PairOfSurface {
            x: pair.at[0],
            y: pair.at[1],
            rms,
            reason: pair.differences.err(),
        });
        Ok(SurfaceOfSet {
            model_set: built.name.clone(),
            file: cx.data(&format!("{path}.data"), &self.data)?.file.to_string(),
            quantity: self.quantity,
            unit: self.quantity.unit(self.difference),
            points: counted.places.len(),
            left_out: counted.left_out.iter().map(left_out).collect(),
            accuracy: counted.accuracy,
            x: x.record(),
            y: y.record(),
            pairs: pairs.collect(),
            least: LeastOfSurface::new(&least, &x.values, &y.values),
            least_place: least,
        })
    }
}
