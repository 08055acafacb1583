//! Models against measured points: every model of a mechanism, untuned, with bands from uncertain inputs.

mod candidate;
mod cell;
mod film;

use std::sync::Arc;

use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::kind_of;
use gearloss_numerics::sampling::Sobol;
use gearloss_numerics::statistics::{bands, quantile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use self::cell::{Cell, Ratio};

use self::candidate::{Candidate, PointOfCandidate};
use self::film::Film;
use super::common::inputs::Input;
use super::tournament::CandidatesEntry;
use super::tournament::entrants::Entrants;
use super::tournament::slot::Slot;
use super::{Analysis, Built, Engine, Head, Outcome, Plan, Planner, Stopped, Work, gear_of};
use crate::codes;
use crate::distinct::distinct;
use crate::measured::{Measured, Row, Seen};
use crate::numbers::{RPM, tidy};
use crate::points::Note;
use crate::register_analysis;
use crate::study::{Data, NameOr, ParameterKey, ToleranceEntry, Uses, Write};
use crate::table::Table;

/// Every model of a mechanism compared with a measurement of its losses, without any fit, with bands from uncertain inputs.
///
/// The ratio of the calculated to the measured loss is stated for each model: over all points and by regime, inside its band and inside
/// its stated range.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ValidationEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear of the data without a column `gear`; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Model set of all other components; default: the models of the gearbox.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_set: Option<String>,
    /// Measured points with `loss`, `loss_torque` or `efficiency`.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Data,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// The mechanism that is judged, and its models.
    #[serde(flatten)]
    pub judged: CandidatesEntry,
    /// Paths of the judged components, such as `bearings.B1`; default: all of the mechanism.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "component"))]
    pub components: Vec<String>,
    /// What the measured loss contains.
    #[serde(default)]
    pub loss_of: LossOf,
    /// What the measurement does not state: inputs of the gearbox with their ranges, for the bands. A name refers to a parameter of the
    /// study, uniformly distributed.
    #[serde(default)]
    #[schemars(with = "Vec<NameOr<ToleranceEntry>>")]
    pub inputs: Vec<ToleranceEntry>,
    /// A condition whose values are left out in turn: `speed`, `torque`, `oil_temperature`, or a column under `bind`. One factor on the loss of
    /// each model is fitted to the points at the other values, and predicts these: what remains is the shape of the law, not its level.
    pub leave_out: Option<String>,
    /// Number of samples of the inputs; powers of two fill the ranges most evenly. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: u32,
}

fn samples() -> u32 {
    128
}

/// What the measured loss contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LossOf {
    /// The loss of the judged components alone.
    #[default]
    Judged,
    /// The loss of the whole gearbox; the other components keep the models of the set.
    Gearbox,
}

register_analysis!(ValidationEntry);

/// Every model of a mechanism against a measurement.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ValidationOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The comparison.
    pub validation: Validation,
}

/// Models of a mechanism against measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Validation {
    /// The judged mechanism, with the slot of a drag.
    pub mechanism: String,
    /// Kinds of the judged components, such as `tapered_roller`, joined by `+`; empty for components without kinds.
    pub part: String,
    /// What the measured loss contains.
    pub loss_of: LossOf,
    /// Name of the file, or of several.
    pub file: String,
    /// Number of measured points. [-]
    pub points: usize,
    /// Number of samples of each band; zero if neither inputs nor accuracies are stated. [-]
    pub samples: usize,
    /// The models, those closest to the measurement first.
    pub models: Vec<ValidatedModel>,
    /// Models without the inputs or without a loss here, each with the reason.
    pub left_out: Vec<String>,
    /// How the file was read.
    pub notes_on_file: Vec<String>,
    /// The first coordinate that varies, with its unit, at each point; absent if none does.
    #[serde(skip)]
    pub over: Option<(String, Vec<f64>)>,
}

/// One model against the measured points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ValidatedModel {
    /// Its name, with its nested models.
    pub name: String,
    /// As in a gearbox.
    pub model: Value,
    /// All points together.
    pub all: Cell,
    /// The points by regime.
    pub regimes: Vec<CellOfRegime>,
    /// The points, in the order of the file.
    pub at: Vec<ValidatedPoint>,
    /// Number of samples without a loss. [-]
    pub failed_samples: usize,
    /// The model with one fitted factor; absent unless a condition is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fitted: Option<FittedFactor>,
}

/// A model with one factor on its loss, fitted to a measurement.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FittedFactor {
    /// The condition whose values were left out in turn.
    pub left_out: String,
    /// The factor from all points, which makes the geometric mean of the ratios one. [-]
    pub factor: f64,
    /// The points, each predicted with the factor from the points at the other values.
    pub predicted: Cell,
}

/// The points of a regime.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CellOfRegime {
    /// What the regime is of: `speed`, `torque`, `oil_temperature`, `viscosity`, `lambda` or `kappa`, or a bound column.
    pub over: String,
    /// Unit of its ends.
    pub unit: String,
    /// Lower end. [unit]
    pub from: f64,
    /// Upper end. [unit]
    pub to: f64,
    /// Its points.
    pub cell: Cell,
}

/// One measured point and the model.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ValidatedPoint {
    /// File, if there are several, and line. [-]
    pub line: String,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Measured loss. [W]
    pub measured_w: f64,
    /// Loss with the model. [W]
    pub loss_w: f64,
    /// Calculated over measured loss. [-]
    pub ratio: f64,
    /// Lower and upper end of the 95 % band of the ratio, from the inputs and the accuracy of the measurement; absent without both. [-]
    pub band: Option<[f64; 2]>,
    /// Whether all models are inside their stated ranges.
    pub in_range: bool,
}

/// A coordinate of regimes: its name, its unit, and its value at each row.
type Regime = (String, String, Vec<f64>);

/// The models, the points, and the uncertain inputs.
pub struct ValidationPlan<'a> {
    base: Arc<Built<'a>>,
    measured: Measured,
    candidates: Vec<Candidate<'a>>,
    /// Whether the entry lists its models: then each must have a loss.
    named: bool,
    mechanism: String,
    /// Kinds of the judged components.
    part: String,
    /// Their paths.
    judged: Vec<String>,
    left_out: Vec<String>,
    inputs: Vec<Input>,
    samples: usize,
}

impl Plan for ValidationPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let rows = self.measured.rows.len() * (1 + self.samples);
        let work = |candidate: &Candidate<'_>| Work::new(&candidate.name, "row", rows);
        self.candidates.iter().map(work).collect()
    }
}

impl Analysis for ValidationEntry {
    const TYPE: &'static str = "validation";
    const PARAMETERS: Option<ParameterKey> = Some(ParameterKey::Range("inputs"));
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = ValidationPlan<'a>;
    type Outcome = ValidationOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_set)
            .in_gears(&self.gear)
            .bind(&self.bind)
            .with("data", Some(&self.data))
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<ValidationPlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let base = cx.built(gearbox, self.model_set.as_slice())?.remove(0);
        let bind: Vec<&str> = self.bind.ids().collect();
        let measured = cx.read_at_ports(&format!("{path}.data"), &self.data, &bind)?;
        self.has_losses(cx, &measured)?;
        let entrants = Entrants::new(
            cx,
            path.clone(),
            &self.judged,
            Slot::new(cx, &path, &self.judged)?,
            &base,
        )?;
        self.check_components(cx, &base, &entrants)?;
        self.check_left_out(cx)?;
        let inputs = Input::all(cx, &path, &self.inputs, &base)?;
        let gear = gear_of(self.gear.as_deref(), &base.transmission);
        let rows = cx.study.rows(&measured, &self.bind, Some(gear), false);
        let mut candidates: Vec<Candidate<'a>> = Vec::new();
        let mut left_out = entrants.left_out;
        for entrant in &entrants.list {
            match &entrant.built {
                Ok(_) => candidates.push(Candidate::new(cx, &base, self, &entrants.slot, entrant)),
                Err(reason) => left_out.push(format!("{}: {reason}", entrant.name)),
            }
        }
        // Errors of bound values are those of every model.
        if let Some(first) = candidates.first() {
            cx.rows_fit(&rows, base.gearbox, &first.variants)?;
        }
        // Whether an accuracy is stated does not depend on the loss.
        let accurate = measured.rows.iter().any(|row| spread(&measured, row, 1.0).is_some());
        let part = self.kinds(&base, &entrants.slot);
        let judged = self.paths(&base, &entrants.slot);
        Ok(ValidationPlan {
            base,
            candidates,
            named: entrants.named,
            judged,
            part,
            mechanism: entrants.slot.name,
            left_out,
            samples: if self.inputs.is_empty() && !accurate {
                0
            } else {
                self.samples as usize
            },
            inputs,
            measured,
        })
    }

    fn reduce<'a>(&'a self, plan: ValidationPlan<'a>, engine: &Engine<'a>) -> Result<ValidationOutcome, Stopped> {
        let mut left_out = plan.left_out.clone();
        let film = Film::new(engine, self, &plan);
        let found = engine.parts(&plan.candidates, |candidate| {
            self.judge(engine, &plan, candidate, &film)
        })?;
        let mut models = Vec::new();
        for (candidate, found) in plan.candidates.iter().zip(found) {
            match found {
                Ok(model) => models.push(model),
                Err(reason) if plan.named => {
                    let help = "`gearloss models --needs GEARBOX` lists the inputs of a model";
                    return Err(engine.wrong(&format!("{}.models.{}", engine.path(), candidate.name), reason, help));
                }
                Err(reason) => left_out.push(format!("{}: {reason}", candidate.name)),
            }
        }
        if models.is_empty() {
            let message = format!(
                "no model of `{}` has a loss at these points: {}",
                plan.mechanism,
                left_out.join("; ")
            );
            return Err(engine.wrong(&engine.path(), message, "add the inputs that the models need"));
        }
        models.sort_by(|a, b| a.all.ratio.ln().abs().total_cmp(&b.all.ratio.ln().abs()));
        Ok(ValidationOutcome {
            head: engine.head(&[Arc::clone(&plan.base)]),
            validation: Validation {
                mechanism: plan.mechanism,
                part: plan.part,
                loss_of: self.loss_of,
                file: engine.data(&engine.path(), &self.data)?.file.to_string(),
                points: plan.measured.rows.len(),
                samples: plan.samples,
                over: coordinates(&plan.measured, &models[0].at, &film)
                    .into_iter()
                    .next()
                    .map(|(over, unit, values)| (format!("{} in {unit}", over.replace('_', " ")), values)),
                models,
                left_out,
                notes_on_file: plan.measured.notes,
            },
        })
    }
}

/// Standard deviation of the measured loss of a row over that loss; absent if nothing states it. \[-\]
fn spread(measured: &Measured, row: &Row, loss: f64) -> Option<f64> {
    let of = |quantity: &str, reading: Option<f64>, whole: Option<f64>| {
        Some(measured.stated_accuracy(row, quantity, reading)? / measured.divisor / whole?)
    };
    let [torque, efficiency] = ["loss_torque", "efficiency"].map(|quantity| measured.value(row, quantity));
    of("loss", Some(loss), Some(loss))
        .or_else(|| of("loss_torque", torque, torque))
        .or_else(|| of("efficiency", efficiency, efficiency.map(|efficiency| 1.0 - efficiency)))
}

impl ValidationEntry {
    /// Rejects points without a positive loss, to which no ratio exists.
    fn has_losses(&self, cx: &Planner<'_>, measured: &Measured) -> Result<(), Stopped> {
        let path = format!("{}.data", cx.path());
        let file = &cx.data(&path, &self.data)?.file;
        let wrong = |message: String, help: &str| Err(cx.wrong_as(codes::DATA, &path, message, help));
        let held: Vec<&str> = ["loss", "loss_torque", "efficiency"]
            .into_iter()
            .filter(|quantity| measured.holds(quantity))
            .collect();
        if held.is_empty() {
            return wrong(
                format!("{file}: there is no measured loss"),
                "state the column of `loss`, `loss_torque` or `efficiency` under `columns`",
            );
        }
        for row in &measured.rows {
            for quantity in &held {
                let value = measured.value(row, quantity);
                let is_loss = value.is_some_and(|value| match *quantity {
                    "efficiency" => value > 0.0 && value < 1.0,
                    _ => value > 0.0,
                });
                if !is_loss {
                    return wrong(
                        format!(
                            "{file}: {}: the {} has no positive loss",
                            measured.origin(row),
                            quantity.replace('_', " ")
                        ),
                        "check the sign and the unit of the column; leave points without a loss out with `rows`",
                    );
                }
            }
        }
        Ok(())
    }

    /// Rejects a condition that a measurement does not have.
    fn check_left_out(&self, cx: &Planner<'_>) -> Result<(), Stopped> {
        let conditions: Vec<&str> = ["speed", "torque", "oil_temperature"]
            .into_iter()
            .chain(self.bind.ids())
            .collect();
        match &self.leave_out {
            Some(name) if !conditions.contains(&name.as_str()) => {
                let help = format!("write one of {}", conditions.join(", "));
                let message = format!("`{name}` is no condition of the points");
                Err(cx.wrong(&format!("{}.leave_out", cx.path()), message, &help))
            }
            _ => Ok(()),
        }
    }

    /// The model with one factor, each value of the condition predicted by the others; absent unless that is asked for.
    fn fitted(
        &self,
        engine: &Engine<'_>,
        measured: &Measured,
        at: &[ValidatedPoint],
        film: &Film,
    ) -> Result<Option<FittedFactor>, Stopped> {
        let Some(name) = &self.leave_out else { return Ok(None) };
        let of = coordinates(measured, at, film)
            .into_iter()
            .find(|(over, ..)| over == name);
        let Some((_, _, values)) = of else {
            let message =
                format!("`{name}` does not vary between the points, so that none of its values can be left out");
            return Err(engine.wrong(
                &format!("{}.leave_out", engine.path()),
                message,
                "choose a condition that varies",
            ));
        };
        let mean = |places: &mut dyn Iterator<Item = usize>| {
            let logs: Vec<f64> = places.map(|i| at[i].ratio.ln()).collect();
            logs.iter().sum::<f64>() / logs.len() as f64
        };
        let mut predicted = at.to_vec();
        for (_, places) in bands(&values) {
            let factor = (-mean(&mut (0..at.len()).filter(|i| !places.contains(i)))).exp();
            for point in places {
                predicted[point].ratio *= factor;
                predicted[point].band = None;
            }
        }
        let factor = (-mean(&mut (0..at.len()))).exp();
        let cell = Cell::of(&predicted, &[]);
        Ok(cell.map(|predicted| FittedFactor {
            left_out: name.clone(),
            factor,
            predicted,
        }))
    }

    /// Rejects components that the mechanism does not have.
    fn check_components(&self, cx: &Planner<'_>, base: &Built<'_>, entrants: &Entrants) -> Result<(), Stopped> {
        let parts = base.transmission.parts();
        let judged = parts.iter().filter(|part| entrants.slot.covers(part));
        let paths: Vec<&str> = judged.map(|part| part.path.as_str()).collect();
        let wrong = |(i, path): (usize, &String)| -> Option<Diagnostic> {
            let place = format!("{}.components.{i}", cx.path());
            let dangling = || gearloss_framework::attach::dangling(&place, "component", path, &paths);
            (!paths.contains(&path.as_str())).then(dangling)
        };
        let list: Vec<Diagnostic> = self.components.iter().enumerate().filter_map(wrong).collect();
        if list.is_empty() { Ok(()) } else { Err(cx.found(list)) }
    }

    /// Paths of the judged components.
    fn paths(&self, base: &Built<'_>, slot: &Slot) -> Vec<String> {
        let judged = base.transmission.parts().iter().filter(|part| slot.covers(part));
        let judged = judged.filter(|part| self.components.is_empty() || self.components.contains(&part.path));
        judged.map(|part| part.path.clone()).collect()
    }

    /// Kinds of the judged components, each once.
    fn kinds(&self, base: &Built<'_>, slot: &Slot) -> String {
        let paths = self.paths(base, slot);
        let kinds = paths.iter().filter_map(|path| kind_of(&base.resolved.value, path));
        distinct(kinds).join("+")
    }

    /// One model at all points, nominal and with every sample; or why it has no loss.
    fn judge(
        &self,
        engine: &Engine<'_>,
        plan: &ValidationPlan<'_>,
        candidate: &Candidate<'_>,
        film: &Film,
    ) -> Result<Result<ValidatedModel, String>, Stopped> {
        let measured = &plan.measured;
        let rows = engine.study.rows(measured, &self.bind, self.gear.as_deref(), false);
        let going = |_: usize| engine.should_continue();
        let nominal = candidate.points(&rows, &[], &going)?;
        let seen = |points: &[PointOfCandidate]| -> Vec<(f64, f64)> {
            let seen = measured.rows.iter().zip(points).map(|(row, point)| {
                let loss = Seen::without_rig(measured, row, &point.point).loss.unwrap_or(f64::NAN);
                (loss, spread(measured, row, loss).unwrap_or(0.0))
            });
            seen.collect()
        };
        // Samples are computed even if the nominal point fails, so that every run has the same stages.
        let sobol = Sobol::new(plan.inputs.len() + 1);
        let sobol = sobol.map_err(|reason| engine.wrong(&engine.path(), reason, "use fewer inputs"))?;
        let measured_losses = nominal.as_ref().map_or_else(|_| Vec::new(), |points| seen(points));
        let sample = |i: usize| -> Result<Option<Vec<f64>>, Stopped> {
            let place = sobol.point(i as u32);
            let value = |(input, share): (&Input, &f64)| input.value(*share).ok();
            let Some(values) = plan.inputs.iter().zip(&place).map(value).collect::<Option<Vec<f64>>>() else {
                return Ok(None);
            };
            let changes = plan.inputs.iter().zip(&values);
            let changes = changes.flat_map(|(input, value)| input.range.varied.overrides(*value));
            let changes: Vec<(String, Value)> = changes.collect();
            let Ok(points) = candidate.points(&rows, &changes, &going)? else {
                return Ok(None);
            };
            // The error of a measurement is common to its points: a scale of the torque, a reading of a figure.
            let normal = place
                .last()
                .and_then(|share| gearloss_numerics::sampling::inverse_normal(*share));
            let ratio = |(point, (loss, spread)): (&PointOfCandidate, &(f64, f64))| {
                point.loss / (loss * (spread * normal.unwrap_or(0.0)).exp())
            };
            Ok(Some(points.iter().zip(&measured_losses).map(ratio).collect()))
        };
        let sampled = engine.jobs(&candidate.name, plan.samples, sample)?;
        let nominal = match nominal {
            Ok(nominal) => nominal,
            Err(reason) => return Ok(Err(reason)),
        };
        let solved: Vec<&Vec<f64>> = sampled.iter().flatten().collect();
        let band = |i: usize| {
            let mut ratios: Vec<f64> = solved.iter().filter_map(|ratios| ratios.get(i).copied()).collect();
            ratios.retain(|ratio| ratio.is_finite());
            ratios.sort_unstable_by(f64::total_cmp);
            (2 * ratios.len() > plan.samples).then(|| [0.025, 0.975].map(|share| quantile(&ratios, share)))
        };
        let point =
            |(i, ((row, point), (loss, _))): (usize, ((&Row, &PointOfCandidate), &(f64, f64)))| ValidatedPoint {
                line: measured.line(row),
                torque_nm: point.point.torque,
                speed_rpm: tidy(point.point.speed * RPM),
                oil_temperature_degc: point.point.oil,
                measured_w: *loss,
                loss_w: point.loss,
                ratio: point.loss / loss,
                band: band(i),
                in_range: !point.point.outside,
            };
        let at = measured.rows.iter().zip(&nominal).zip(&measured_losses);
        let at: Vec<ValidatedPoint> = at.enumerate().map(point).collect();
        if let Some(none) = at.iter().find(|point| !(point.ratio.is_finite() && point.ratio > 0.0)) {
            return Ok(Err(format!(
                "no ratio in line {}: a loss of {} W against {} W",
                none.line, none.loss_w, none.measured_w
            )));
        }
        // Means of the logarithms of the ratios at some points, by sample: what a set does not state moves all of them.
        let sampled = |places: &[usize]| -> Vec<f64> {
            let mean = |ratios: &&Vec<f64>| places.iter().map(|i| ratios[*i].ln()).sum::<f64>() / places.len() as f64;
            solved.iter().map(mean).filter(|mean| mean.is_finite()).collect()
        };
        let Some(all) = Cell::of(&at, &sampled(&(0..at.len()).collect::<Vec<_>>())) else {
            return Ok(Err("no points".to_owned()));
        };
        Ok(Ok(ValidatedModel {
            name: candidate.name.clone(),
            model: candidate.model.clone(),
            all,
            regimes: regimes(measured, &at, film, &sampled),
            failed_samples: plan.samples - solved.len(),
            fitted: self.fitted(engine, measured, &at, film)?,
            at,
        }))
    }
}

/// What varies between the points: speed, torque, oil temperature, viscosity, film, and the bound columns.
fn coordinates(measured: &Measured, at: &[ValidatedPoint], film: &Film) -> Vec<Regime> {
    let mut all: Vec<Regime> = vec![
        (
            "speed".to_owned(),
            "rpm".to_owned(),
            at.iter().map(|p| p.speed_rpm).collect(),
        ),
        (
            "torque".to_owned(),
            "Nm".to_owned(),
            at.iter().map(|p| p.torque_nm).collect(),
        ),
    ];
    if let Some(oil) = at.iter().map(|p| p.oil_temperature_degc).collect() {
        all.push(("oil_temperature".to_owned(), "degC".to_owned(), oil));
    }
    if let Some(viscosities) = &film.viscosities {
        all.push(("viscosity".to_owned(), "mm2/s".to_owned(), viscosities.clone()));
    }
    if let Some((symbol, ratios)) = &film.ratios {
        all.push(((*symbol).to_owned(), String::new(), ratios.clone()));
    }
    for column in measured.columns.iter().filter(|column| column.bound.is_some()) {
        let (Some(name), Some(place)) = (&column.bound, measured.column(&column.header)) else {
            continue;
        };
        let number = |row: &Row| row.cells.get(place).and_then(|cell| cell.parse().ok());
        if let Some(values) = measured.rows.iter().map(number).collect() {
            all.push((name.clone(), column.unit.clone().unwrap_or_default(), values));
        }
    }
    all.retain(|(.., values)| bands(values).len() > 1);
    all
}

/// The points by every coordinate that varies.
fn regimes(
    measured: &Measured,
    at: &[ValidatedPoint],
    film: &Film,
    sampled: &dyn Fn(&[usize]) -> Vec<f64>,
) -> Vec<CellOfRegime> {
    let cells = |(over, unit, values): Regime| -> Vec<CellOfRegime> {
        let cell = |([from, to], places): ([f64; 2], Vec<usize>)| {
            let points: Vec<ValidatedPoint> = places.iter().map(|i| at[*i].clone()).collect();
            Some(CellOfRegime {
                over: over.clone(),
                unit: unit.clone(),
                from,
                to,
                cell: Cell::of(&points, &sampled(&places))?,
            })
        };
        bands(&values).into_iter().filter_map(cell).collect()
    };
    coordinates(measured, at, film).into_iter().flat_map(cells).collect()
}

impl Outcome for ValidationOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let (name, models) = (&self.head.analysis, &self.validation.models);
        let points = Table::of_each(name, models, |model| &model.at)
            .text("model", "Model", |(model, _)| &model.name)
            .text("line", "File, if there are several, and line", |(_, point)| &point.line)
            .fields("torque_nm speed_rpm oil_temperature_degc", |(_, point)| point)
            .number("measured_w", "W", "Measured loss", |(_, point)| point.measured_w)
            .number("loss_w", "W", "Loss with the model", |(_, point)| point.loss_w)
            .number("ratio", "-", "Calculated over measured loss", |(_, point)| point.ratio)
            .number("ratio_low", "-", "Lower end of its 95 % band", |(_, point)| {
                point.band.map(|band| band[0])
            })
            .number("ratio_high", "-", "Upper end of its 95 % band", |(_, point)| {
                point.band.map(|band| band[1])
            })
            .text(
                "in_range",
                "Whether all models are inside their stated ranges",
                |(_, point)| {
                    if point.in_range { "yes" } else { "no" }
                },
            )
            .finish();
        let cells = models.iter().flat_map(|model| {
            let all = std::iter::once((model, None, &model.all));
            all.chain(
                model
                    .regimes
                    .iter()
                    .map(move |regime| (model, Some(regime), &regime.cell)),
            )
        });
        let cells = Table::of(format!("{name}-cells"), cells)
            .text("model", "Model", |(model, ..)| &model.name)
            .text(
                "over",
                "Coordinate of the regime; empty for all points",
                |(_, regime, _)| regime.map_or("", |regime| &regime.over),
            )
            .text("unit", "Unit of its ends", |(_, regime, _)| {
                regime.map_or("", |regime| &regime.unit)
            })
            .number("from", "-", "Lower end of the regime", |(_, regime, _)| {
                regime.map(|regime| regime.from)
            })
            .number("to", "-", "Upper end of the regime", |(_, regime, _)| {
                regime.map(|regime| regime.to)
            })
            .number("points", "-", "Number of points", |(.., cell)| cell.points as f64)
            .number(
                "ratio",
                "-",
                "Geometric mean of calculated over measured loss",
                |(.., cell)| cell.ratio,
            )
            .number("least", "-", "Least ratio", |(.., cell)| cell.least)
            .number("greatest", "-", "Greatest ratio", |(.., cell)| cell.greatest)
            .number(
                "bias_percent",
                "%",
                "Mean of calculated less measured loss",
                |(.., cell)| cell.bias_percent,
            )
            .number(
                "rms_percent",
                "%",
                "Root mean square of calculated less measured loss",
                |(.., cell)| cell.rms_percent,
            )
            .number(
                "max_percent",
                "%",
                "Greatest difference of either sign",
                |(.., cell)| cell.max_percent,
            )
            .number(
                "in_band",
                "-",
                "Share of points whose band contains the measurement",
                |(.., cell)| cell.in_band,
            )
            .number(
                "in_range",
                "-",
                "Share of points inside the stated ranges",
                |(.., cell)| cell.in_range,
            )
            .number(
                "error",
                "-",
                "Standard deviation of the logarithm of the ratio from inputs and accuracy",
                |(.., cell)| cell.error,
            )
            .number(
                "scatter",
                "-",
                "Standard deviation of the logarithms of the ratios of the points",
                |(.., cell)| cell.scatter,
            )
            .finish();
        vec![points, cells]
    }

    /// None: the share of the points inside the stated ranges is part of the result.
    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }
}
