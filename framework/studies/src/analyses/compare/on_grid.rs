//! Differences of model sets from a base over a grid: the other set minus the base.

use std::sync::Arc;

use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use super::cases::{cases, names};
use super::over_cycles::DifferenceOfShare;
use super::{CompareEntry, model_error, unit};
use crate::analyses::common::axes::grid_axes;
use crate::analyses::common::inputs::Input;
use crate::analyses::common::model_error::losses_of_parts;
use crate::analyses::common::shares::{Shares, together};
use crate::analyses::common::trial::Trial;
use crate::analyses::{Built, Engine, Plan, Planner, Run, Runs, Stopped, Work};
use crate::codes;
use crate::numbers::{RPM, tidy};
use crate::points::{GridResult, Note, PointResult, Statistics, TotalLoss, notes, notes_with_shares};
use crate::study::{By, Difference, Grid, Quantity};
use crate::table::Table;

/// Differences of one model set from the base over a grid.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct GridComparison {
    /// Name of the set.
    pub model_set: String,
    /// Name of the base.
    pub base: String,
    /// Gear state.
    pub gear: String,
    /// Compared quantity.
    pub quantity: Quantity,
    /// Unit of the differences.
    pub unit: &'static str,
    /// Where the difference is minimal.
    pub least: Option<DifferenceAt>,
    /// Where the difference is maximal.
    pub greatest: Option<DifferenceAt>,
    /// Mean difference. [unit of the differences]
    pub mean: Option<f64>,
    /// Statistics of the differences. [unit of the differences]
    pub difference: Option<Statistics>,
    /// Statistics of the differences of the loss, of the base's loss. [%]
    pub loss_difference_percent_of_loss: Option<Statistics>,
    /// Lower end, median and upper end of the 95 % band of the mean difference of the loss, from the known errors of the models; absent unless they
    /// are asked for, and known for some model. [W]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loss_difference_band_w: Option<[f64; 3]>,
    /// What models of the set noted.
    pub notes: Vec<Note>,
    /// Every torque at every speed, torque by torque.
    pub points: Vec<GridDifference>,
    /// Torques of the grid for the base. [Nm]
    #[serde(skip)]
    pub torques: Vec<f64>,
    /// Speeds of the grid for the base. [rad/s]
    #[serde(skip)]
    pub speeds: Vec<f64>,
    /// Points outside a stated range of a model of either set.
    #[serde(skip)]
    pub outside: Vec<bool>,
    /// Mean losses by component over the points where both sets have a loss.
    #[serde(skip)]
    pub components: Vec<DifferenceOfShare>,
    /// Number of quantities outside their stated ranges with the base.
    #[serde(skip)]
    pub ranges_left_by_base: usize,
}

/// A difference with its operating point.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct DifferenceAt {
    /// The difference. [unit of the differences]
    pub difference: f64,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Speed as it was solved. [rad/s]
    #[serde(skip)]
    pub speed: f64,
}

/// Both sets at one operating point.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct GridDifference {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Quantity with the base. [its unit; efficiency as a fraction]
    pub base_model: Option<f64>,
    /// Quantity with the set. [its unit; efficiency as a fraction]
    pub model: Option<f64>,
    /// The set minus the base. [unit of the differences]
    pub difference: Option<f64>,
}

/// The base of the comparison and its grid.
struct Base<'a> {
    name: &'a str,
    built: &'a Built<'a>,
    gear: &'a str,
    torques: &'a [f64],
    speeds: &'a [f64],
    points: &'a [PointResult],
    ranges_left: usize,
}

/// The base and the compared sets over a grid.
pub struct GridPlan<'a> {
    /// The base first.
    runs: Runs<'a>,
    /// Axes in fractions of a rating have different values for each product; tables and figures show those of the base.
    axes: [Vec<f64>; 2],
}

impl Plan for GridPlan<'_> {
    fn work(&self) -> Vec<Work> {
        self.runs.work()
    }
}

impl<'a> GridPlan<'a> {
    pub(super) fn new(cx: &Planner<'a>, entry: &CompareEntry, grid_name: &str, base: &str) -> Result<Self, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(entry.gearbox.as_ref())?;
        let grid = cx.study.grid(&path, grid_name)?;
        check_grid(cx, grid_name, grid)?;
        let built = cases(cx, entry, gearbox, &names(entry, base))?;
        let without = built.iter().find(|b| !cx.has_machines(&b.transmission));
        if let Some(b) = without.filter(|_| entry.quantity.is_of_unit()) {
            let message = format!("`{}` has no machine", b.name);
            let help = "describe it under `machines` of the gearbox, or compare a quantity of the gearbox";
            return Err(cx.wrong_as(codes::NO_MACHINE, &format!("{path}.quantity"), message, help));
        }
        let gear = cx.one_gear(&path, grid, &built[0].transmission)?;
        let run = |b: &Arc<Built<'a>>| {
            let (torques, speeds) = grid_axes(cx, grid_name, grid, &b.transmission)?;
            Run::new(cx, b, cx.points(&b.transmission, &gear, torques, speeds))
        };
        let (torques, speeds) = grid_axes(cx, grid_name, grid, &built[0].transmission)?;
        Ok(Self {
            runs: Runs::of_sets(&built, run)?,
            axes: [torques, speeds],
        })
    }

    pub(super) fn compare(
        &self,
        engine: &Engine<'_>,
        entry: &CompareEntry,
        base: &str,
        inputs: &[Vec<Input>],
    ) -> Result<Vec<GridComparison>, Stopped> {
        let solved = engine.solve_all(&self.runs)?;
        let first = &self.runs.0[0];
        let seen = notes(&first.built.transmission, &solved[0].seen);
        let base = Base {
            name: base,
            built: &first.built,
            gear: &first.points.gear,
            torques: &self.axes[0],
            speeds: &self.axes[1],
            points: &solved[0].points,
            ranges_left: seen.iter().filter(|note| note.outside > 0).count(),
        };
        let losses = |case: usize, trial: &Trial<'_>, t: &Transmission| {
            let solved = trial.solve(engine, t, &self.runs.0[case].points)?;
            Ok(vec![
                solved
                    .points
                    .iter()
                    .map(|point| point.loss.unwrap_or(f64::NAN))
                    .collect(),
            ])
        };
        let bands = model_error::bands(engine, entry, (&self.built(), inputs), &losses)?;
        for (run, solved) in self.runs.0.iter().zip(&solved).filter(|_| !inputs.is_empty()) {
            engine.weigh_model_error(&run.built.name, &losses_of_parts(&solved.points));
        }
        let others = self.runs.0.iter().zip(&solved).skip(1).enumerate();
        let comparison = |(i, (run, other)): (usize, (&Run<'_>, &GridResult))| GridComparison {
            loss_difference_band_w: bands.get(i).and_then(|cycles| *cycles.first()?),
            ..comparison(entry, &base, &run.built, other)
        };
        Ok(others.map(comparison).collect())
    }

    /// The base and the sets.
    pub(super) fn built(&self) -> Vec<Arc<Built<'a>>> {
        self.runs.built()
    }
}

/// Rejects a grid with bound values or an envelope.
fn check_grid(cx: &Planner<'_>, name: &str, grid: &Grid) -> Result<(), Stopped> {
    if !grid.bind.is_empty() {
        return Err(cx.wrong(
            &format!("grids.{name}.bind"),
            "a comparison needs a grid without bound values",
            "give it its own grid, and the value under `conditions: { set: ... }`",
        ));
    }
    if grid.envelope.is_some() {
        return Err(cx.wrong(
            &format!("grids.{name}.envelope"),
            "a comparison needs a grid without envelope",
            "give it its own grid",
        ));
    }
    Ok(())
}

/// Comparison of one set with the base.
fn comparison(entry: &CompareEntry, base: &Base<'_>, built: &Built<'_>, other: &GridResult) -> GridComparison {
    let point = |(base, other): (&PointResult, &PointResult)| {
        let (base_model, model) = (entry.quantity.value(base), entry.quantity.value(other));
        GridDifference {
            torque_nm: other.torque,
            speed_rpm: tidy(other.speed * RPM),
            base_model,
            model,
            difference: base_model
                .zip(model)
                .and_then(|(base, other)| entry.quantity.difference(entry.difference, base, other)),
        }
    };
    let pairs = || base.points.iter().zip(&other.points);
    let points: Vec<GridDifference> = pairs().map(point).collect();
    let at = |found: Option<(usize, f64)>| {
        found.map(|(i, difference)| DifferenceAt {
            difference,
            torque_nm: points[i].torque_nm,
            speed_rpm: points[i].speed_rpm,
            speed: other.points[i].speed,
        })
    };
    let known: Vec<f64> = points.iter().filter_map(|p| p.difference).collect();
    let of_loss = |(base, other): (&PointResult, &PointResult)| {
        let base = base.loss.filter(|loss| *loss != 0.0)?;
        Some(100.0 * (other.loss? - base) / base)
    };
    GridComparison {
        model_set: built.name.clone(),
        base: base.name.to_owned(),
        gear: base.gear.to_owned(),
        quantity: entry.quantity,
        unit: entry.quantity.unit(entry.difference),
        least: at(extreme(&points, |a, b| a < b)),
        greatest: at(extreme(&points, |a, b| a > b)),
        mean: (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64),
        difference: Statistics::from_values(known),
        loss_difference_percent_of_loss: Statistics::from_values(pairs().filter_map(of_loss)),
        loss_difference_band_w: None,
        notes: notes_with_shares(&built.transmission, &other.seen, TotalLoss::of(&other.points)),
        outside: pairs().map(|(a, b)| a.outside || b.outside).collect(),
        points,
        torques: base.torques.to_vec(),
        speeds: base.speeds.to_vec(),
        components: components([base.built, built], [base.points, &other.points]),
        ranges_left_by_base: base.ranges_left,
    }
}

/// Mean losses of the components of both, in the order of the document.
fn components(built: [&Built<'_>; 2], points: [&[PointResult]; 2]) -> Vec<DifferenceOfShare> {
    let transmissions = built.map(|b| &b.transmission);
    let names = together(transmissions.into_iter(), By::Component);
    let [of_base, of_other] = transmissions.map(|t| Shares::new(t, By::Component).under(&names));
    let mut sums = [vec![0.0; names.len()], vec![0.0; names.len()]];
    let mut count = 0.0;
    for (base, other) in points[0].iter().zip(points[1]) {
        let (Some(base), Some(other)) = (of_base.stack(base), of_other.stack(other)) else {
            continue;
        };
        count += 1.0;
        for (sums, losses) in sums.iter_mut().zip([base, other]) {
            sums.iter_mut().zip(losses).for_each(|(sum, watts)| *sum += watts);
        }
    }
    let [of_base, of_other] = sums.map(|sums| {
        sums.into_iter()
            .map(|sum| if count > 0.0 { sum / count } else { 0.0 })
            .collect::<Vec<_>>()
    });
    let shares = names.into_iter().zip(of_base).zip(of_other);
    let share = |((share, base), other): ((String, f64), f64)| DifferenceOfShare {
        share,
        base_mean_loss_w: base,
        mean_loss_w: other,
        difference_w: other - base,
    };
    shares.map(share).collect()
}

/// Place and value of the first difference that comes before all others.
fn extreme(points: &[GridDifference], before: fn(f64, f64) -> bool) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (i, point) in points.iter().enumerate() {
        if let Some(difference) = point.difference
            && best.is_none_or(|(_, so_far)| before(difference, so_far))
        {
            best = Some((i, difference));
        }
    }
    best
}

pub(super) fn table(name: &str, (quantity, difference): (Quantity, Difference), all: &[GridComparison]) -> Table {
    let what = quantity.name();
    let difference_name = format!("difference_{}", quantity.unit(difference));
    Table::of_each(name, all, |comparison| &comparison.points)
        .text("model_set", "Model set", |(of_set, _)| &of_set.model_set)
        .text("base", "Base of the comparison", |(of_set, _)| &of_set.base)
        .text("gear", "Gear", |(of_set, _)| &of_set.gear)
        .fields("torque_nm speed_rpm", |(_, point)| point)
        .number(what, unit(quantity), "Quantity with the set", |(_, point)| point.model)
        .number(
            format!("base_{what}"),
            unit(quantity),
            "Quantity with the base",
            |(_, point)| point.base_model,
        )
        .number(
            difference_name,
            quantity.words(difference).1,
            "The set minus the base",
            |(_, point)| point.difference,
        )
        .finish()
}
