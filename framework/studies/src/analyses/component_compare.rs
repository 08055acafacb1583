//! Several models of one component over speed by term, compared with measured points.

use std::sync::Arc;

use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::evaluate::{PartLoss, Point};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::loss::Term;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::{Case, Transmission};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::common::axes::{speeds, torques};
use super::common::measurable::is_measurable;
use super::{Analysis, Built, Engine, Head, Outcome, Plan, Planner, Run, Stopped, Work, gear_of};
use crate::numbers::{RPM, tidy};
use crate::points::{Note, Points, notes};
use crate::register_analysis;
use crate::study::{Data, SpeedAxis, TorqueAxis, Uses};
use crate::table::Table;

/// Several models of one component over speed.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ComponentCompareEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Path of the component, such as `bearings.B1`, `meshes.M1` or `gears.G4.drag.churning`.
    #[schemars(extend("x-refers-to" = "component"))]
    pub component: String,
    /// Models by name, each as in a gearbox: `{ type: skf }`. The other components keep their models.
    pub models: Ordered<Value>,
    /// Model set of all other components; default: the models of the gearbox.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_set: Option<String>,
    /// Overrides for this analysis: resolved path to value, such as `meshes.M2.drag.churning: none`.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub set: Ordered<Value>,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Measured points: torque and speed at the study's ports, and the loss of the component. Each is compared with every model
    /// at that torque and speed.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub measured: Option<Data>,
}

register_analysis!(ComponentCompareEntry);

/// Several models of one component over speed.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ComponentCompareOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The comparison.
    pub component_comparison: ComponentComparison,
    /// Why models have no losses, one entry for each omitted model.
    #[serde(skip)]
    pub failures: Vec<Findings>,
}

/// Losses of one component under several models.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ComponentComparison {
    /// Path of the component.
    pub component: String,
    /// Model set of all other components; absent: the models of the gearbox.
    pub model_set: Option<String>,
    /// Gear state.
    pub gear: String,
    /// Oil temperature, if given. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// One for each model.
    pub models: Vec<ModelOfComponent>,
    /// The measured points.
    pub measured: Vec<MeasuredLoss>,
    /// Differences between models and measurement; none for a model without a value at any measured point.
    pub deviations: Vec<DeviationOfModel>,
    /// Torques of the grid. [Nm]
    #[serde(skip)]
    pub torques: Vec<f64>,
    /// Speeds of the grid. [rad/s]
    #[serde(skip)]
    pub speeds: Vec<f64>,
    /// Number of measured points whose loss is too small for a difference in percent.
    #[serde(skip)]
    pub omitted: usize,
}

/// One model with the losses of the component under it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ModelOfComponent {
    /// Name of the model in the study.
    pub model: String,
    /// Every torque at every speed of the grid, torque by torque.
    pub points: Vec<LossOfComponent>,
    /// The same at the measured points.
    pub at_measured: Vec<LossOfComponent>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Terms of the model.
    #[serde(skip)]
    pub terms: Vec<&'static str>,
}

/// Loss of the component at one point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LossOfComponent {
    /// Given torque. [Nm]
    pub torque_nm: f64,
    /// Given speed. [rpm]
    pub speed_rpm: f64,
    /// Loss of all copies; absent if the model has no value. [W]
    pub loss_w: Option<f64>,
    /// Moment of one copy about its relative speed. [Nm]
    pub moment_of_one_nm: Option<f64>,
    /// Loss of all copies by term. [W]
    pub terms_w: Ordered<Option<f64>>,
    /// Why the model has no value.
    pub undefined: Option<String>,
}

/// One measured point.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct MeasuredLoss {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Measured loss of the component. [W]
    pub loss_w: f64,
    /// Speed as it was read. [rad/s]
    #[serde(skip)]
    pub speed: f64,
}

/// Differences between one model and the measurement.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DeviationOfModel {
    /// Name of the model.
    pub model: String,
    /// Number of points.
    pub count: usize,
    /// Mean of model minus measurement. [%]
    pub mean_percent: f64,
    /// Root mean square of model minus measurement. [%]
    pub rms_percent: f64,
}

/// The gearbox with each model, and the points.
pub struct ComponentPlan<'a> {
    models: Vec<Run<'a>>,
    failures: Vec<Findings>,
    torques: Vec<f64>,
    speeds: Vec<f64>,
    measured: Vec<MeasuredLoss>,
}

impl ComponentPlan<'_> {
    /// Every torque at every speed. \[Nm, rad/s\]
    fn grid(&self) -> Vec<(f64, f64)> {
        let grid = self
            .torques
            .iter()
            .flat_map(|t| self.speeds.iter().map(move |w| (*t, *w)));
        grid.collect()
    }
}

impl Plan for ComponentPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let count = self.torques.len() * self.speeds.len() + self.measured.len();
        self.models
            .iter()
            .map(|run| Work::new(run.label(), "point", count))
            .collect()
    }

    fn into_failures(self) -> Vec<Findings> {
        self.failures
    }
}

impl Analysis for ComponentCompareEntry {
    const TYPE: &'static str = "component_compare";
    type Plan<'a> = ComponentPlan<'a>;
    type Outcome = ComponentCompareOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_set)
            .in_gears(&self.gear)
            .with("measured", self.measured.as_ref())
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<ComponentPlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let variants = cx.built(gearbox, self.model_set.as_slice())?;
        // The models may define a drag slot.
        let known = |b: &Arc<Built<'_>>| b.transmission.parts().iter().any(|part| part.path == self.component);
        if !self.component.contains(".drag.") && !variants.iter().any(known) {
            return Err(no_part(cx, &self.component, &variants[0].transmission));
        }
        let torques = torques(cx, &format!("{path}.torque"), &self.torque, &variants[0].transmission)?;
        let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, &variants[0].transmission)?;
        cx.holds(&path, torques.len().saturating_mul(speeds.len()), self.models.len())?;
        let measured = match &self.measured {
            Some(data) => measured(cx, &format!("{path}.measured"), data)?,
            None => Vec::new(),
        };
        self.check_names(cx)?;
        // A model that fails does not stop the others.
        let (mut models, mut failures) = (Vec::new(), Vec::new());
        for (model, value) in self.models.iter() {
            match self.with_model(cx, gearbox, (model, value)) {
                Ok(model) => models.push(model),
                Err(Stopped::Found(findings)) => failures.push(findings),
                Err(stopped) => return Err(stopped),
            }
        }
        Ok(ComponentPlan {
            models,
            failures,
            torques,
            speeds,
            measured,
        })
    }

    fn reduce<'a>(&'a self, plan: ComponentPlan<'a>, engine: &Engine<'a>) -> Result<ComponentCompareOutcome, Stopped> {
        let grid = plan.grid();
        let compared = |run: &Run<'_>| {
            if engine.should_continue() {
                self.compared(run, &grid, &plan.measured)
            } else {
                Err(Stopped::Interrupted)
            }
        };
        let models: Vec<ModelOfComponent> = engine.undivided(|| plan.models.iter().map(compared).collect())?;
        let Some(first) = plan.models.first() else {
            return Err(Stopped::Several(plan.failures));
        };
        let built: Vec<_> = plan.models.iter().map(|run| Arc::clone(&run.built)).collect();
        Ok(ComponentCompareOutcome {
            head: engine.head(&built),
            component_comparison: ComponentComparison {
                component: self.component.clone(),
                model_set: self.model_set.clone(),
                gear: first.points.gear.clone(),
                oil_temperature_degc: first.points.oil.given(),
                deviations: deviations(&models, &plan.measured),
                omitted: omitted(&models, &plan.measured),
                models,
                measured: plan.measured,
                torques: plan.torques,
                speeds: plan.speeds,
            },
            failures: plan.failures,
        })
    }
}

impl ComponentCompareEntry {
    /// The slot of the component: drags are slots themselves.
    fn slot(&self) -> String {
        if self.component.contains(".drag.") {
            self.component.clone()
        } else {
            format!("{}.model", self.component)
        }
    }

    /// Rejects a comparison without models, and a model with the name of the measured points.
    fn check_names(&self, cx: &Planner<'_>) -> Result<(), Stopped> {
        let path = format!("{}.models", cx.path());
        if self.models.is_empty() {
            let help = "write for example `models: { ours: { type: skf } }`";
            return Err(cx.wrong(&path, "no model is given", help));
        }
        if self.models.iter().any(|(name, _)| name == "measured") {
            let message = "`measured` is the name of the measured points";
            return Err(cx.wrong(&path, message, "rename the model"));
        }
        Ok(())
    }

    /// The gearbox with one model.
    fn with_model<'a>(
        &'a self,
        cx: &Planner<'a>,
        gearbox: &'a Gearbox,
        (model, value): (&str, &Value),
    ) -> Result<Run<'a>, Stopped> {
        let mut choice: Choice = cx.study.choice(self.model_set.as_deref());
        let set = self.set.iter().map(|(path, value)| (path.to_owned(), value.clone()));
        choice.overrides.extend(set);
        choice.overrides.push((self.slot(), value.clone()));
        let choice_of_model = (self.slot(), format!("{}.models.{model}", cx.path()));
        let (resolved, transmission) = cx.study.built(cx.language, gearbox, &choice, &[choice_of_model])?;
        if !transmission.parts().iter().any(|part| part.path == self.component) {
            return Err(no_part(cx, &self.component, &transmission));
        }
        let gear = gear_of(self.gear.as_deref(), &transmission);
        let points = cx.points(&transmission, gear, Vec::new(), Vec::new());
        let built = Arc::new(Built {
            name: model.to_owned(),
            gearbox,
            resolved,
            transmission,
        });
        Run::without_limits(cx, &built, points)
    }

    /// One model at the points of the grid and at the measured ones.
    fn compared(
        &self,
        run: &Run<'_>,
        grid: &[(f64, f64)],
        measured: &[MeasuredLoss],
    ) -> Result<ModelOfComponent, Stopped> {
        let t = &run.built.transmission;
        let part = t
            .parts()
            .iter()
            .position(|part| part.path == self.component)
            .unwrap_or(0);
        let case = run.points.case(t).map_err(|list| run.findings(list))?;
        let measured = measured.iter().map(|m| (m.torque_nm, m.speed));
        let all: Vec<(f64, f64)> = grid.iter().copied().chain(measured).collect();
        let terms = t.instances()[t.parts()[part].notes.instance()].entry.terms;
        let (mut points, notes) = losses(t, (&run.points, &case), (part, terms), &all);
        let at_measured = points.split_off(grid.len());
        Ok(ModelOfComponent {
            model: run.built.name.clone(),
            points,
            at_measured,
            notes,
            terms: terms.iter().map(|term| term.name).collect(),
        })
    }
}

fn no_part(cx: &Planner<'_>, component: &str, transmission: &Transmission) -> Stopped {
    let paths: Vec<&str> = transmission.parts().iter().map(|p| p.path.as_str()).collect();
    let path = format!("{}.component", cx.path());
    cx.found(vec![dangling(&path, "component", component, &paths)])
}

/// Losses of a component at points of torque and speed, and notes of models.
fn losses(
    transmission: &Transmission,
    (given, case): (&Points, &Case),
    (part, terms): (usize, &[Term]),
    points: &[(f64, f64)],
) -> (Vec<LossOfComponent>, Vec<Note>) {
    let mut scratch = transmission.scratch(case);
    let mut losses = Vec::with_capacity(points.len());
    for (torque, speed) in points {
        let torques = [*torque];
        let point = Point {
            speeds: &[*speed],
            torques: &torques[..case.torque_ports.len()],
            flow: given.flow,
            tolerance: Tolerance::default(),
            inclination: 0.0,
        };
        let warm = given.oil.find(transmission, case, &point, &mut scratch);
        let solution = transmission.evaluate(case, &point, warm.temperatures(), &mut scratch);
        losses.push(loss_of_component((*torque, *speed), &solution.explain(part).0, terms));
    }
    (losses, notes(transmission, &scratch.totals))
}

fn loss_of_component((torque, speed): (f64, f64), loss: &PartLoss, terms: &[Term]) -> LossOfComponent {
    let has_value = loss.result.is_ok();
    let term = |term: &Term| {
        let watts = has_value.then(|| loss.term_watts(term.index));
        (term.name.to_owned(), watts)
    };
    LossOfComponent {
        torque_nm: torque,
        speed_rpm: tidy(speed * RPM),
        loss_w: has_value.then(|| loss.watts()),
        moment_of_one_nm: loss.moment(),
        terms_w: Ordered(terms.iter().map(term).collect()),
        undefined: loss.result.err().map(|reason| reason.to_string()),
    }
}

/// Computed and measured losses at the measured points at which the model has a value.
fn pairs<'a>(model: &'a ModelOfComponent, measured: &'a [MeasuredLoss]) -> impl Iterator<Item = (f64, f64)> + 'a {
    let pairs = model.at_measured.iter().zip(measured);
    pairs.filter_map(|(point, m)| Some((point.loss_w?, m.loss_w)))
}

/// Mean and root mean square of the differences from the measured points, by model.
fn deviations(models: &[ModelOfComponent], measured: &[MeasuredLoss]) -> Vec<DeviationOfModel> {
    let deviation = |model: &ModelOfComponent| {
        let gaps: Vec<f64> = pairs(model, measured)
            .filter(|(computed, seen)| is_measurable(*seen, *computed))
            .map(|(computed, seen)| 100.0 * (computed - seen) / seen)
            .collect();
        let count = gaps.len() as f64;
        (!gaps.is_empty()).then(|| DeviationOfModel {
            model: model.model.clone(),
            count: gaps.len(),
            mean_percent: gaps.iter().sum::<f64>() / count,
            rms_percent: (gaps.iter().map(|g| g * g).sum::<f64>() / count).sqrt(),
        })
    };
    models.iter().filter_map(deviation).collect()
}

/// Number of measured points whose loss is too small for a difference in percent: the maximum over the models.
fn omitted(models: &[ModelOfComponent], measured: &[MeasuredLoss]) -> usize {
    let omitted = |model| {
        let omitted = pairs(model, measured).filter(|(computed, seen)| !is_measurable(*seen, *computed));
        omitted.count()
    };
    models.iter().map(omitted).max().unwrap_or(0)
}

/// Reads measured points.
fn measured(cx: &Planner<'_>, path: &str, data: &Data) -> Result<Vec<MeasuredLoss>, Stopped> {
    let read = cx.read_at_ports(path, data, &[])?;
    let mut points = Vec::new();
    for row in &read.rows {
        let value = |quantity: &str| read.value(row, quantity);
        let loss = value("loss").filter(|watts| *watts > 0.0);
        let (Some(torque), Some(speed), Some(watts)) = (value("torque"), value("speed"), loss) else {
            let file = &cx.data(path, data)?.file;
            let message = format!("{file}: {}: no positive loss", read.origin(row));
            return Err(cx.wrong(path, message, "give the loss of the component in a column `loss [W]`"));
        };
        points.push(MeasuredLoss {
            torque_nm: torque,
            speed_rpm: tidy(speed * RPM),
            loss_w: watts,
            speed,
        });
    }
    Ok(points)
}

/// A row of the table: a loss of one model, or the measured one, at one point.
struct Row<'o> {
    model: &'o str,
    torque: f64,
    speed: f64,
    term: &'o str,
    loss: Option<f64>,
    moment: Option<f64>,
    undefined: &'o str,
}

impl Outcome for ComponentCompareOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let comparison = &self.component_comparison;
        let mut rows = Vec::new();
        for model in &comparison.models {
            for point in model.points.iter().chain(&model.at_measured) {
                let row = |term, loss, moment| Row {
                    model: &model.model,
                    torque: point.torque_nm,
                    speed: point.speed_rpm,
                    term,
                    loss,
                    moment,
                    undefined: point.undefined.as_deref().unwrap_or_default(),
                };
                rows.push(row("total", point.loss_w, point.moment_of_one_nm));
                rows.extend(point.terms_w.iter().map(|(term, watts)| row(term, *watts, None)));
            }
        }
        rows.extend(comparison.measured.iter().map(|m| Row {
            model: "measured",
            torque: m.torque_nm,
            speed: m.speed_rpm,
            term: "total",
            loss: Some(m.loss_w),
            moment: None,
            undefined: "",
        }));
        let table = Table::of(&self.head.analysis, rows)
            .text("model", "Model, or `measured`", |row| row.model)
            .number("torque_nm", "Nm", "Given torque", |row| row.torque)
            .number("speed_rpm", "rpm", "Given speed", |row| row.speed)
            .text("term", "Term of the model, or `total`", |row| row.term)
            .number("loss_w", "W", "Loss of all copies", |row| row.loss)
            .number(
                "moment_of_one_nm",
                "Nm",
                "Moment of one copy about its relative speed",
                |row| row.moment,
            )
            .text("undefined", "Why the model has no value", |row| row.undefined);
        vec![table.finish()]
    }

    /// None: notes are listed with the losses of each model. The compared models are not those of the study.
    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn unlisted(&self) -> usize {
        let models = &self.component_comparison.models;
        let notes = models.iter().flat_map(|model| &model.notes);
        notes.filter(|note| note.outside > 0).count()
    }

    fn failures(&self) -> &[Findings] {
        &self.failures
    }
}
