//! The design with the least mean loss of cycles under limits.

mod band;
mod changes;
mod drives;
mod objectives;
mod outcome;
mod search;
mod variables;

use gearloss_framework::description::Ordered;
use gearloss_framework::resolve::matches;
use schemars::JsonSchema;
use serde::Deserialize;

pub use objectives::{Minimised, ObjectiveEntry, QuantityEntry};
pub use outcome::{
    BandOfGain, ChangeOfDesign, ConsumptionOfSearch, DesignOfDisagreement, DesignOfSearch, Disagreement,
    FailureOfSearch, GainOfCycle, LimitOfSearch, ObjectiveOfSearch, OptimiseOutcome, VariableOfSearch,
};
pub use variables::{Scale, VariableEntry};

use self::drives::Drives;
use self::objectives::Objective;
use self::search::Search;
use self::variables::Variable;
use super::common::duties::{DrivePlan, Duties};
use super::common::inputs::Input;
use super::common::model_error::ModelErrorEntry;
use super::common::trial::Trial;
use super::{Analysis, Built, Engine, Plan, Planner, Stopped, Work};
use crate::analyses::common::limits_over_cycles::limits_of;
use crate::limits::Limit;
use crate::register_analysis;
use crate::study::{DriveEntry, LimitEntry, Then, ToleranceEntry, Uses, Write};

/// The design with the least mean loss of cycles under limits: which change saves most?
///
/// Numbers and choices are searched together by an evolutionary algorithm (NSGA-II), then the numbers are refined. Several cycles are
/// several objectives, whose best compromises form a front.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OptimiseEntry {
    /// Cycles and settings of the simulation; one model set.
    #[serde(flatten)]
    pub drive: DriveEntry,
    /// Variables by name.
    #[schemars(length(min = 1, max = 64))]
    pub variables: Ordered<VariableEntry>,
    /// What is minimised: the mean loss over a cycle by its name, or a quantity of it, such as `{ quantity: consumption, of: wltc }`.
    /// Default: the consumption over every cycle if the study describes a machine and a battery, otherwise the mean loss. Other cycles
    /// are for limits.
    #[serde(default)]
    pub minimise: Vec<ObjectiveEntry>,
    /// Limits by name, which a design must keep.
    #[serde(default)]
    pub limits: Ordered<LimitEntry>,
    /// Maximum number of designs. [-]
    #[serde(default = "designs")]
    #[schemars(range(min = 16, max = 1_000_000))]
    pub designs: u32,
    /// Designs of a generation; default: 8 and 4 for each variable, at most 64. [-]
    #[schemars(range(min = 8, max = 1000))]
    pub population: Option<u32>,
    /// Seed of the random numbers. [-]
    #[serde(default = "seed")]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub seed: u32,
    /// Uncertain inputs for the band of the gain: the present and the best design are driven with the same values drawn from their
    /// distributions.
    #[serde(default)]
    pub inputs: Vec<ToleranceEntry>,
    /// Error of the models for the band of the gain: a factor on the loss of each model that measured sets judge, the same in the present and
    /// the best design.
    pub model_error: Option<ModelErrorEntry>,
    /// Number of samples of uncertain inputs; powers of two fill the ranges most evenly. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: u32,
    /// Name of a model set with the best design, for later analyses.
    #[schemars(extend("x-defines" = "model_sets"))]
    pub then: Option<String>,
}

fn designs() -> u32 {
    400
}

fn seed() -> u32 {
    1
}

fn samples() -> u32 {
    64
}

register_analysis!(OptimiseEntry);

/// The gearbox, its cycles, and what is searched.
pub struct OptimisePlan<'a> {
    drive: DrivePlan<'a>,
    variables: Vec<Variable>,
    objectives: Vec<Objective>,
    limits: Vec<Limit>,
    inputs: Vec<Input>,
    designs: usize,
}

impl Plan for OptimisePlan<'_> {
    fn work(&self) -> Vec<Work> {
        vec![Work::new(&self.drive.built[0].name, "design", self.designs).at_most()]
    }
}

impl Analysis for OptimiseEntry {
    const TYPE: &'static str = "optimise";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = OptimisePlan<'a>;
    type Outcome = OptimiseOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::driving(&self.drive)
    }

    fn then(&self) -> Option<Then<'_>> {
        let set = self.then.as_deref()?;
        Some(Then {
            set,
            model_sets: &self.drive.model_sets,
        })
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<OptimisePlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.drive.gearbox.as_ref())?;
        if self.drive.model_sets.len() > 1 {
            let help = "give one, and write an analysis for each other one";
            return Err(cx.wrong(&format!("{path}.model_sets"), "a search has one model set", help));
        }
        let duties = Duties::new(cx, &path, &self.drive.ride, self.drive.gear.as_ref().map(Into::into))?;
        let drive = DrivePlan::new(cx, &path, duties, cx.built(gearbox, &self.drive.model_sets)?)?;
        let b = &drive.built[0];
        let variables = Variable::all(cx, &path, &self.variables, b)?;
        let has_machine = drive.duties.has_machine(&b.transmission);
        let objectives = Objective::all(cx, &self.minimise, &drive.duties, has_machine)?;
        let limits = limits_of(cx, &path, &self.limits, &drive.duties, b)?;
        let mut inputs = Input::all(cx, &path, &self.inputs, b)?;
        let own = inputs.len();
        ModelErrorEntry::add(self.model_error.as_ref(), cx, b, &mut inputs)?;
        same_laws(cx, b, &variables, &inputs[own..])?;
        drives::check(cx, &Trial::new(cx, b), &variables)?;
        Ok(OptimisePlan {
            objectives,
            limits,
            inputs,
            designs: self.designs as usize,
            variables,
            drive,
        })
    }

    fn reduce<'a>(&'a self, plan: OptimisePlan<'a>, engine: &Engine<'a>) -> Result<OptimiseOutcome, Stopped> {
        let b = &plan.drive.built[0];
        let (objectives, inputs) = (&plan.objectives, &plan.inputs);
        let drives = Drives {
            engine,
            duties: &plan.drive.duties,
            trial: Trial::new(engine, b),
            variables: &plan.variables,
            limits: &plan.limits,
        };
        let present = drives.present()?;
        let mut search = Search::new(&drives, self, &present, objectives);
        search.run()?;
        let chosen = search.chosen();
        let changes = match &chosen {
            Some(chosen) => changes::of_design(&drives, &chosen.genes, &present, objectives)?,
            None => Vec::new(),
        };
        let band = match &chosen {
            Some(chosen) if !inputs.is_empty() => {
                let changed: Vec<usize> = changes.iter().map(|change| change.variable).collect();
                band::of_gain(&drives, self.samples, inputs, &chosen.genes, &changed, objectives)?
            }
            _ => Vec::new(),
        };
        Ok(outcome::put_together(
            self, b, &drives, &search, &present, objectives, changes, band,
        ))
    }
}

/// Rejects choices in components whose model has a known error: the best design may have another law there, or another kind of component.
fn same_laws(cx: &Planner<'_>, b: &Built<'_>, variables: &[Variable], errors: &[Input]) -> Result<(), Stopped> {
    let factors = || errors.iter().flat_map(|input| &input.range.varied.paths);
    for variable in variables.iter().filter(|variable| variable.is_choice()) {
        let chosen = matches(&b.resolved.value, &variable.path);
        let of_component = |factor: &String| {
            let component = factor.strip_suffix("loss_factor").unwrap_or(factor);
            chosen.iter().any(|path| path.starts_with(component))
        };
        if let Some(factor) = factors().find(|factor| of_component(factor)) {
            let message = format!("the choice may change the law of `{factor}`, whose error `model_error` draws");
            let help = "delete `model_error`, or vary numbers alone";
            return Err(cx.wrong(&format!("{}.variables.{}", cx.path(), variable.name), message, help));
        }
    }
    Ok(())
}
