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
use super::{Analysis, Built, Context, Stopped, gear_of};
use crate::points::{GridResult, TotalLoss, notes_with_shares};
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
    type Outcome = SweepOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).in_gears(&self.gear)
    }

    fn run(&self, cx: &Context<'_>) -> Result<SweepOutcome, Stopped> {
        self.oil_is_free(cx)?;
        let all = self.solve(cx)?;
        cx.begin()?;
        cx.complete()?;
        let shares = together(all.iter().map(|value| &value.built.transmission), self.by);
        let quantity = |built: &Built<'_>, path: &String| Varied::new(cx.language, &built.resolved, path, Tie::Value);
        let varied: Vec<Varied> = match all.first() {
            Some(first) => self
                .paths()
                .filter_map(|path| quantity(&first.built, path).ok())
                .collect(),
            None => Vec::new(),
        };
        let limits = LimitColumn::all(cx.language, cx.study);
        let sweep: Vec<SweepOfValue> = all.iter().map(|value| self.record(value, &shares, &limits)).collect();
        Ok(SweepOutcome {
            head: cx.head(&all.iter().map(|value| &value.built).collect::<Vec<_>>()),
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

/// All points with one set at one value.
struct Solved<'a> {
    /// Index of the value, and of the second one.
    places: [usize; 2],
    built: Built<'a>,
    gear: String,
    result: GridResult,
}

impl SweepEntry {
    /// The varied paths.
    fn paths(&self) -> impl Iterator<Item = &String> {
        std::iter::once(&self.path).chain(self.second.as_ref().map(|second| &second.path))
    }

    /// Rejects a temperature that the conditions fix.
    fn oil_is_free(&self, cx: &Context<'_>) -> Result<(), Stopped> {
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

    /// Every set at every value; absent if the analysis is only checked.
    fn solve<'s>(&'s self, cx: &'s Context<'_>) -> Result<Vec<Solved<'s>>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let seconds: Vec<Option<(&String, &Value)>> = match &self.second {
            Some(second) => second.values.iter().map(|value| Some((&second.path, value))).collect(),
            None => vec![None],
        };
        let (mut all, mut held, mut number) = (Vec::new(), 0, 0);
        for (k, second) in seconds.iter().enumerate() {
            for (i, value) in self.values.iter().enumerate() {
                // If every value fails, the path is wrong, which is reported first.
                let mut changes = vec![(self.path.clone(), value.clone(), format!("{path}.values.{i}"))];
                let second =
                    second.map(|(own, value)| (own.clone(), value.clone(), format!("{path}.second.values.{k}")));
                changes.extend(second);
                for built in cx.built_with(gearbox, &self.model_sets, &changes)? {
                    number += 1;
                    let t = &built.transmission;
                    let gear = gear_of(self.gear.as_deref(), t).to_owned();
                    let torques = torques(cx, &format!("{path}.torque"), &self.torque, t)?;
                    let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, t)?;
                    let mut points = cx.points(t, &gear, torques, speeds);
                    points.terms = self.by == By::Term;
                    cx.holds(&path, held + points.field.len(), 1)?;
                    if cx.checked(&built, &points)? {
                        continue;
                    }
                    held += points.field.len();
                    let Some(result) = cx.part(number, || cx.solve(&built, &points))? else {
                        continue;
                    };
                    all.push(Solved {
                        places: [i, k],
                        built,
                        gear,
                        result,
                    });
                }
            }
        }
        Ok(all)
    }

    /// The record of a solved value.
    fn record(&self, solved: &Solved<'_>, shares: &[String], limits: &[LimitColumn]) -> SweepOfValue {
        let t = &solved.built.transmission;
        let [first, second] = solved.places;
        let own = Shares::new(t, self.by).under(shares);
        SweepOfValue {
            model_set: solved.built.name.clone(),
            gear: solved.gear.clone(),
            path: self.path.clone(),
            value: self.values[first].clone(),
            second: self.second.as_ref().map(|entry| SecondValue {
                path: entry.path.clone(),
                value: entry.values[second].clone(),
            }),
            shares: shares.to_vec(),
            points: solved
                .result
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
                    losses_w: own.stack(p),
                    limit_values: LimitColumn::by_name(limits, &p.limits),
                    beyond: p.beyond,
                    solved_speed_rpm: p.speed * RPM,
                })
                .collect(),
            notes: notes_with_shares(t, &solved.result.seen, TotalLoss::of(&solved.result.points)),
            places: solved.places,
        }
    }
}
