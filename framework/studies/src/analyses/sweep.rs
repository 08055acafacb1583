//! Losses and efficiency over the values of one path, or of two, or of paths that move together: at points or over cycles.

mod cycles;
mod outcome;

use std::sync::Arc;

use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::common::axes::{speeds, torques};
use super::common::duties::{DrivePlan, Duties, sums_energies};
use super::common::gears::stated_gear;
use super::common::ranges::published;
use super::common::shares::{Shares, together};
use super::{Analysis, Built, Engine, Plan, Planner, Run, Runs, Stopped, Work, gear_of};
use crate::analyses::common::limits_over_cycles::limits_of;
use crate::limits::Limit;
use crate::limits::at_points::LimitColumn;
use crate::numbers::{RPM, tidy};
use crate::points::{GridResult, Points, TotalLoss, notes_with_shares};
use crate::register_analysis;
use crate::study::{By, CycleGear, RideEntry, SpeedAxis, Together, TorqueAxis, Uses, Write};
use crate::varied::{Tie, Varied};

pub use self::outcome::{
    CombinationLeftOut, CycleOfSweep, NotesOfSet, PointOfSweep, SecondValue, SweepOfValue, SweepOutcome,
};

/// Losses and efficiency over the values of one path, or of two, or of paths that move together.
///
/// They are solved at points of torque and speed, or over cycles, which also have the consumption of a vehicle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SweepEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear; default: the first. Over cycles `best` chooses the gear that draws least, an entry states how gears are chosen.
    pub gear: Option<CycleGear>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Resolved path that is varied, such as `lubricants.sump.viscosity.kv100`, or `thermal.oil` for the temperature.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: Option<String>,
    /// Several paths instead of one, whose `values` move together. Combinations with which the gearbox cannot be built are left out.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// Values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`; with `paths` each a list with a value for each path: `[[24, 83], [30, 77]]`.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
    /// A second varied path: every combination is solved.
    pub second: Option<SecondEntry>,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Torques; not with `drive`.
    pub torque: Option<TorqueAxis>,
    /// Speeds; not with `drive`.
    pub speed: Option<SpeedAxis>,
    /// Cycles instead of torques and speeds.
    pub drive: Option<RideEntry>,
}

/// The second path of a sweep.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SecondEntry {
    /// Resolved path that is varied.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: Option<String>,
    /// Several paths instead of one, whose `values` move together.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// Values, each as in a gearbox; with `paths` each a list with a value for each path.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
}

register_analysis!(SweepEntry);

/// What a sweep solves.
pub enum SweepPlan<'a> {
    /// Points with every set at every value.
    Points {
        /// The points.
        runs: Runs<'a>,
        /// The varied paths.
        varied: VariedPaths,
        /// Which of the values.
        solved: Solved,
    },
    /// Cycles with every set at every value.
    Cycles {
        /// The cycles.
        drive: Box<DrivePlan<'a>>,
        /// Limits at each of them.
        limits: Vec<Vec<Limit>>,
        /// The varied paths.
        varied: VariedPaths,
        /// Which of the values.
        solved: Solved,
    },
}

/// The varied paths: the first, and the second if there are two.
pub type VariedPaths = (Together, Option<Together>);

/// Which values are solved.
#[derive(Debug, Default)]
pub struct Solved {
    /// For every set at every value the indices of the value and of the second one, without those that are left out.
    places: Vec<[usize; 2]>,
    left_out: Vec<CombinationLeftOut>,
}

impl Plan for SweepPlan<'_> {
    fn work(&self) -> Vec<Work> {
        match self {
            Self::Points { runs, .. } => runs.work(),
            Self::Cycles { drive, .. } => drive.work(),
        }
    }
}

impl Analysis for SweepEntry {
    const TYPE: &'static str = "sweep";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = SweepPlan<'a>;
    type Outcome = SweepOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets)
            .in_gears(self.gear.iter().flat_map(CycleGear::names))
            .riding(self.drive.as_ref())
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<SweepPlan<'a>, Stopped> {
        self.oil_is_free(cx)?;
        let path = cx.path();
        let varied = self.varied(cx)?;
        let (built, solved) = self.built(cx, &varied)?;
        let Some(ride) = &self.drive else {
            let (Some(torque), Some(speed)) = (&self.torque, &self.speed) else {
                let help = "write `torque: 10 Nm` and `speed: 3000 rpm`, or `drive: { cycles: [NAME] }`";
                return Err(cx.wrong(&path, "neither points nor cycles are stated", help));
            };
            let gear = stated_gear(cx, self.gear.as_ref())?;
            let (mut runs, mut held) = (Vec::new(), 0);
            for built in built {
                let t = &built.transmission;
                let torques = torques(cx, &format!("{path}.torque"), torque, t)?;
                let speeds = speeds(cx, &format!("{path}.speed"), speed, t)?;
                let points = Points {
                    terms: self.by == By::Term,
                    ..cx.points(t, gear_of(gear, t), torques, speeds)
                };
                held += points.field.len();
                cx.holds(&path, held, 1)?;
                runs.push(Run::new(cx, &built, points)?);
            }
            return Ok(SweepPlan::Points {
                runs: Runs(runs),
                varied,
                solved,
            });
        };
        if self.torque.is_some() || self.speed.is_some() {
            let message = "points and cycles are stated";
            return Err(cx.wrong(&path, message, "delete `drive`, or `torque` and `speed`"));
        }
        sums_energies(cx, &path, self.by)?;
        let duties = Duties::new(cx, &format!("{path}.drive"), ride, self.gear.as_ref().map(Into::into))?;
        let drive = DrivePlan::new(cx, &path, duties, built)?;
        let limits = drive.built.iter();
        let limits = limits.map(|b| limits_of(cx, &path, &Ordered::default(), &drive.duties, b));
        Ok(SweepPlan::Cycles {
            limits: limits.collect::<Result<_, _>>()?,
            drive: Box::new(drive),
            varied,
            solved,
        })
    }

    fn reduce<'a>(&'a self, plan: SweepPlan<'a>, engine: &Engine<'a>) -> Result<SweepOutcome, Stopped> {
        let (runs, varied, places) = match plan {
            SweepPlan::Points { runs, varied, solved } => (runs, varied, solved),
            SweepPlan::Cycles {
                drive,
                limits,
                varied,
                solved,
            } => return self.over_cycles(engine, &drive, &limits, &varied, solved),
        };
        let solved = engine.solve_all(&runs)?;
        let built = runs.built();
        let shares = together(built.iter().map(|b| &b.transmission), self.by);
        let quantity = |path: &String| Varied::new(engine.language, &built.first()?.resolved, path, Tie::Value).ok();
        let (first, second) = &varied;
        let paths = first.paths.iter().chain(second.iter().flat_map(|second| &second.paths));
        let coefficients: Vec<Varied> = paths.filter_map(quantity).collect();
        let limits = LimitColumn::all(engine.language, engine.study);
        let values = runs.0.iter().zip(&places.places).zip(&solved);
        let mut sweep: Vec<SweepOfValue> = values
            .map(|((run, places), solved)| self.record(run, (&varied, *places), solved, &shares, &limits))
            .collect();
        compact(sweep.iter_mut().map(|value| &mut value.places).collect());
        Ok(SweepOutcome {
            head: engine.head(&built),
            notes: NotesOfSet::all(sweep.iter().map(|value| (&value.model_set, &value.notes))),
            sweep,
            cycles: Vec::new(),
            left_out: places.left_out,
            cycle_limits: Vec::new(),
            limits,
            published: published(coefficients.iter()),
        })
    }
}

impl SweepEntry {
    /// The varied paths with their values.
    fn varied(&self, cx: &Planner<'_>) -> Result<VariedPaths, Stopped> {
        let path = cx.path();
        let at = |key: &str, (below, message, help): (String, String, String)| {
            cx.wrong(&format!("{path}{key}{below}"), message, &help)
        };
        let first = Together::new(self.path.as_deref(), &self.paths, &self.values).map_err(|wrong| at("", wrong))?;
        let second = self.second.as_ref().map(|second| {
            Together::new(second.path.as_deref(), &second.paths, &second.values).map_err(|wrong| at(".second", wrong))
        });
        Ok((first, second.transpose()?))
    }

    /// The gearbox with every set at every value. Of values that belong together, or that others follow, those are left out with which it
    /// cannot be built; if none can, the first reason is an error.
    fn built<'a>(
        &self,
        cx: &Planner<'a>,
        (first, second): &VariedPaths,
    ) -> Result<(Vec<Arc<Built<'a>>>, Solved), Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let is_joint = |together: &Together| together.paths.len() > 1;
        let may_fail =
            is_joint(first) || second.as_ref().is_some_and(is_joint) || !cx.study.entry.conditions.follows.is_empty();
        let (mut all, mut solved, mut fault) = (Vec::new(), Solved::default(), None);
        for k in 0..second.as_ref().map_or(1, |second| second.rows.len()) {
            for i in 0..first.rows.len() {
                // If every value fails, the path is wrong, which is reported first.
                let placed = |together: &Together, choice: usize, key: &str| -> Vec<(String, Value, String)> {
                    let place = format!("{path}{key}.values.{choice}");
                    let overrides = together.overrides(choice).into_iter();
                    overrides.map(|(path, value)| (path, value, place.clone())).collect()
                };
                let mut changes = placed(first, i, "");
                changes.extend(second.iter().flat_map(|second| placed(second, k, ".second")));
                match cx.built_with(gearbox, &self.model_sets, &changes) {
                    Ok(built) => {
                        solved.places.extend(built.iter().map(|_| [i, k]));
                        all.extend(built);
                    }
                    Err(Stopped::Found(findings)) if may_fail => {
                        solved.left_out.push(CombinationLeftOut {
                            values: words_of((first, i), second.as_ref().map(|second| (second, k))),
                            reason: findings.first(),
                        });
                        fault.get_or_insert(Stopped::Found(findings));
                    }
                    Err(stopped) => return Err(stopped),
                }
            }
        }
        match fault {
            Some(fault) if all.is_empty() => Err(fault),
            _ => Ok((all, solved)),
        }
    }

    /// Rejects a temperature that the conditions fix.
    fn oil_is_free(&self, cx: &Planner<'_>) -> Result<(), Stopped> {
        let second = self
            .second
            .iter()
            .flat_map(|second| second.path.iter().chain(&second.paths));
        let mut paths = self.path.iter().chain(&self.paths).chain(second);
        if cx.study.entry.conditions.oil_temperature.is_none() || paths.all(|path| path != "thermal.oil") {
            return Ok(());
        }
        let error = Diagnostic::error(
            format!("{}.path", cx.path()),
            "the conditions fix the temperature, so it cannot be varied",
        )
        .help("delete `conditions.oil_temperature`");
        Err(cx.found(vec![error]))
    }

    /// The record of a solved value.
    fn record(
        &self,
        run: &Run<'_>,
        (varied, places): (&VariedPaths, [usize; 2]),
        solved: &GridResult,
        shares: &[String],
        limits: &[LimitColumn],
    ) -> SweepOfValue {
        let t = &run.built.transmission;
        let summed = Shares::new(t, self.by).under(shares);
        SweepOfValue {
            model_set: run.built.name.clone(),
            gear: run.points.gear.clone(),
            path: varied.0.words(),
            value: value_of(&varied.0, places[0]),
            second: second_of(varied, places),
            shares: shares.to_vec(),
            points: solved
                .points
                .iter()
                .map(|p| PointOfSweep {
                    torque_nm: p.torque,
                    speed_rpm: tidy(p.speed * RPM),
                    oil_temperature_degc: p.oil,
                    balance: p.balance,
                    status: p.status,
                    efficiency: p.efficiency,
                    loss_w: p.loss,
                    losses_w: summed.stack(p),
                    unit: p.unit(),
                    limit_values: LimitColumn::by_name(limits, &p.limits),
                    beyond: p.beyond,
                    solved_speed_rpm: p.speed * RPM,
                })
                .collect(),
            notes: notes_with_shares(t, &solved.seen, TotalLoss::of(&solved.points)),
            places,
        }
    }
}

/// The value of a choice as in the study.
fn value_of(together: &Together, choice: usize) -> Value {
    match &together.rows[choice][..] {
        [value] => value.clone(),
        row => Value::from(row.to_vec()),
    }
}

fn second_of((_, second): &VariedPaths, [_, choice]: [usize; 2]) -> Option<SecondValue> {
    second.as_ref().map(|second| SecondValue {
        path: second.words(),
        value: value_of(second, choice),
    })
}

/// Numbers the values that are not left out.
fn compact(mut places: Vec<&mut [usize; 2]>) {
    for side in 0..2 {
        let mut known: Vec<usize> = places.iter().map(|place| place[side]).collect();
        known.sort_unstable();
        known.dedup();
        for place in &mut places {
            place[side] = known.partition_point(|known| *known < place[side]);
        }
    }
}

/// A combination in words.
fn words_of((first, i): (&Together, usize), second: Option<(&Together, usize)>) -> String {
    let words = |(together, choice): (&Together, usize)| {
        format!(
            "{} {}",
            together.words(),
            crate::numbers::word(&value_of(together, choice))
        )
    };
    std::iter::once((first, i))
        .chain(second)
        .map(words)
        .collect::<Vec<_>>()
        .join(", ")
}
