//! Losses and efficiency over the values of one path, or of two.

mod outcome;

use gearloss_framework::document::Diagnostic;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::axes::{speeds, torques};
use super::limits::at_points::LimitColumn;
use super::numbers::{RPM, tidy};
use super::ranges::published;
use super::shares::{Shares, together};
use super::{Analysis, Engine, Planner, Run, Runs, Stopped, gear_of};
use crate::points::{GridResult, Points, TotalLoss, notes_with_shares};
use crate::register_analysis;
use crate::study::{By, SpeedAxis, TorqueAxis, Uses, Write};
use crate::varied::{Tie, Varied};

pub use self::outcome::{NotesOfSet, PointOfSweep, SecondValue, SweepOfValue, SweepOutcome};

/// Losses and efficiency over the values of one path, or of two.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SweepEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Resolved path that is varied, such as `lubricants.sump.viscosity.kv100`, or `thermal.oil` for the temperature.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: String,
    /// Values, each as in a gearbox: `[4 mm2/s, 6 mm2/s]`.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
    /// A second varied path: every combination is solved.
    pub second: Option<SecondEntry>,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; default: CSV, JSON and SVG.
    #[serde(default = "Write::every_format")]
    pub write: Vec<Write>,
}

/// The second path of a sweep.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SecondEntry {
    /// Resolved path that is varied.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: String,
    /// Values, each as in a gearbox.
    #[schemars(length(min = 1))]
    pub values: Vec<Value>,
}

register_analysis!(SweepEntry);

impl Analysis for SweepEntry {
    const TYPE: &'static str = "sweep";
    type Plan<'a> = SweepPlan<'a>;
    type Outcome = SweepOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).in_gears(&self.gear)
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<SweepPlan<'a>, Stopped> {
        self.oil_is_free(cx)?;
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let seconds: Vec<Option<(&String, &Value)>> = match &self.second {
            Some(second) => second.values.iter().map(|value| Some((&second.path, value))).collect(),
            None => vec![None],
        };
        let (mut runs, mut places, mut held) = (Vec::new(), Vec::new(), 0);
        for (k, second) in seconds.iter().enumerate() {
            for (i, value) in self.values.iter().enumerate() {
                // If every value fails, the path is wrong, which is reported first.
                let mut changes = vec![(self.path.clone(), value.clone(), format!("{path}.values.{i}"))];
                let second = second.map(|(second_path, value)| {
                    (second_path.clone(), value.clone(), format!("{path}.second.values.{k}"))
                });
                changes.extend(second);
                for built in cx.built_with(gearbox, &self.model_sets, &changes)? {
                    let t = &built.transmission;
                    let torques = torques(cx, &format!("{path}.torque"), &self.torque, t)?;
                    let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, t)?;
                    let points = Points {
                        terms: self.by == By::Term,
                        ..cx.points(t, gear_of(self.gear.as_deref(), t), torques, speeds)
                    };
                    held += points.field.len();
                    cx.holds(&path, held, 1)?;
                    runs.push(Run::new(cx, &built, points)?);
                    places.push([i, k]);
                }
            }
        }
        Ok((Runs(runs), places))
    }

    fn reduce<'a>(&'a self, (runs, places): SweepPlan<'a>, engine: &Engine<'a>) -> Result<SweepOutcome, Stopped> {
        let solved = engine.solve_all(&runs)?;
        let built = runs.built();
        let shares = together(built.iter().map(|b| &b.transmission), self.by);
        let quantity = |path: &String| Varied::new(engine.language, &built.first()?.resolved, path, Tie::Value).ok();
        let varied: Vec<Varied> = self.paths().filter_map(quantity).collect();
        let limits = LimitColumn::all(engine.language, engine.study);
        let values = runs.0.iter().zip(&places).zip(&solved);
        let sweep: Vec<SweepOfValue> = values
            .map(|((run, places), solved)| self.record(run, *places, solved, &shares, &limits))
            .collect();
        Ok(SweepOutcome {
            head: engine.head(&built),
            notes: NotesOfSet::all(&sweep),
            sweep,
            limits,
            published: published(varied.iter()),
        })
    }

    fn formats(&self) -> &[Write] {
        &self.write
    }
}

/// Every set at every value, with the indices of the value and of the second one.
type SweepPlan<'a> = (Runs<'a>, Vec<[usize; 2]>);

impl SweepEntry {
    /// The varied paths.
    fn paths(&self) -> impl Iterator<Item = &String> {
        std::iter::once(&self.path).chain(self.second.as_ref().map(|second| &second.path))
    }

    /// Rejects a temperature that the conditions fix.
    fn oil_is_free(&self, cx: &Planner<'_>) -> Result<(), Stopped> {
        if cx.study.entry.conditions.oil_temperature.is_none() || self.paths().all(|path| path != "thermal.oil") {
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
        places: [usize; 2],
        solved: &GridResult,
        shares: &[String],
        limits: &[LimitColumn],
    ) -> SweepOfValue {
        let t = &run.built.transmission;
        let [first, second] = places;
        let summed = Shares::new(t, self.by).under(shares);
        SweepOfValue {
            model_set: run.built.name.clone(),
            gear: run.points.gear.clone(),
            path: self.path.clone(),
            value: self.values[first].clone(),
            second: self.second.as_ref().map(|entry| SecondValue {
                path: entry.path.clone(),
                value: entry.values[second].clone(),
            }),
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
