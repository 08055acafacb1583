//! Sensitivity of the losses over a grid: slopes, screening, shares of the variance.

mod outcome;
mod outputs;

use std::sync::{Arc, Mutex, PoisonError};

use gearloss_numerics::inference::{Parameter, Scale};
use gearloss_numerics::sensitivity::{
    Evaluate, Local, PointOf, Screening, VarianceShares, local, screening, variance_shares,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use outcome::{
    EffectOfParameter, OutputSensitivity, RunsOfMethods, SensitivityOfSet, SensitivityOutcome, SharesOfVariance,
    SlopeOfOutput, VariedParameter,
};
pub use outputs::OutputKind;

use self::outputs::Outputs;
use super::common::axes::grid_axes;
use super::common::ranges::{Range, built_again, once};
use super::common::trial::{Left, Trial, left};
use super::{Analysis, Built, BuiltAgain, Engine, Plan, Planner, Run, Stopped, Work};
use crate::engine::JobsWithin;
use crate::points::{Points, notes};
use crate::register_analysis;
use crate::study::{Grid, NameOr, ParameterKey, RangeEntry, Uses, Write};

/// Relative noise of a mean loss. A point is solved until the error of its losses is below 1e-9 of its power.
const NOISE: f64 = 1e-9;
/// Memory of a run without its outputs, roughly.
const BYTES: usize = 192;
/// Number of resamples for the intervals of shares.
const RESAMPLES: usize = 200;

/// Sensitivity of the losses: slopes, screening, shares of the variance.
///
/// Over a grid: mean loss in total and by mechanism and term, mean efficiency, and relative change of the loss at
/// the points (`relative_loss`: root mean square over the points, not for `local`).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SensitivityEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Grid with one gear.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: String,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// The varied quantities. `local` starts from the value of the gearbox (the first if a path matches several different values). A name
    /// refers to a parameter of the study.
    #[schemars(length(min = 1, max = 32), with = "Vec<NameOr<RangeEntry>>")]
    pub parameters: Vec<RangeEntry>,
    /// Methods; default: all.
    #[serde(default = "Method::all")]
    #[schemars(length(min = 1))]
    pub methods: Vec<Method>,
    /// Number of trajectories of `morris`; each needs one run more than there are parameters. [-]
    #[serde(default = "trajectories")]
    #[schemars(range(min = 2, max = 10000))]
    pub trajectories: u32,
    /// Number of samples of `sobol`, a power of two; each needs two runs more than there are parameters. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 16_777_216))]
    pub samples: u32,
}

fn trajectories() -> u32 {
    20
}

fn samples() -> u32 {
    1024
}

/// Method of sensitivity analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Slopes at the values of the gearbox.
    Local,
    /// Screening along trajectories through the ranges, with few runs.
    Morris,
    /// Shares of the variance over the ranges, first-order and total.
    Sobol,
}

impl Method {
    fn all() -> Vec<Self> {
        vec![Self::Local, Self::Morris, Self::Sobol]
    }
}

register_analysis!(SensitivityEntry);

/// The points with each set, and the ranges of the parameters.
pub struct SensitivityPlan<'a>(Vec<SensitivityOfOne<'a>>);

/// One set.
struct SensitivityOfOne<'a> {
    run: Run<'a>,
    ranges: Vec<Range>,
    /// Start values of the slopes.
    starts: Vec<Parameter>,
    runs: RunsOfMethods,
}

impl Plan for SensitivityPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |set: &SensitivityOfOne<'_>| {
            let count = (set.runs.count() + 1) * set.run.points.field.len();
            Work::new(set.run.label(), "point", count)
        };
        self.0.iter().map(work).collect()
    }

    fn samples(&self, cx: &Planner<'_>) -> Vec<BuiltAgain> {
        let of_set = |set: &SensitivityOfOne<'_>| built_again(cx, &set.run.built, &set.ranges);
        self.0.iter().flat_map(of_set).collect()
    }
}

impl Analysis for SensitivityEntry {
    const TYPE: &'static str = "sensitivity";
    const PARAMETERS: Option<ParameterKey> = Some(ParameterKey::Range("parameters"));
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = SensitivityPlan<'a>;
    type Outcome = SensitivityOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: Some(&self.grid),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
        }
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<SensitivityPlan<'a>, Stopped> {
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let grid = self.checked_grid(cx)?;
        let set = |b: &Arc<Built<'a>>| {
            let gear = cx.one_gear(&cx.path(), grid, &b.transmission)?;
            let (torques, speeds) = grid_axes(cx, &self.grid, grid, &b.transmission)?;
            let ranges = self.ranges(cx, b)?;
            let starts = if self.does(Method::Local) {
                starts(cx, &ranges)?
            } else {
                Vec::new()
            };
            let runs = self.runs(ranges.len());
            let kept = BYTES + Outputs::most(&b.transmission) * std::mem::size_of::<f64>();
            cx.fit_in_memory(&cx.path(), runs.count(), kept)?;
            let points = Points {
                terms: true,
                ..cx.points(&b.transmission, &gear, torques, speeds)
            };
            Ok(SensitivityOfOne {
                run: Run::new(cx, b, points)?,
                ranges,
                starts,
                runs,
            })
        };
        let built = cx.built(gearbox, &self.model_sets)?;
        let sets = built.iter().map(set).collect::<Result<_, Stopped>>()?;
        Ok(SensitivityPlan(sets))
    }

    fn reduce<'a>(&'a self, plan: SensitivityPlan<'a>, engine: &Engine<'a>) -> Result<SensitivityOutcome, Stopped> {
        let sensitivities = engine.parts(&plan.0, |set| self.under_set(engine, set))?;
        let built: Vec<_> = plan.0.into_iter().map(|set| set.run.built).collect();
        Ok(SensitivityOutcome {
            head: engine.head(&built),
            sensitivities,
        })
    }
}

/// Results of the methods.
struct Found {
    /// By output, then by parameter.
    local: Option<Vec<Vec<Local>>>,
    morris: Option<Screening>,
    /// By output.
    sobol: Option<Vec<VarianceShares>>,
}

/// Data of the evaluations, shared by threads.
struct Evaluations<'a> {
    jobs: JobsWithin<'a>,
    /// What progress is reported as.
    label: &'a str,
    trial: Trial<'a>,
    points: &'a Points,
    ranges: &'a [Range],
    outputs: &'a Outputs,
    left: Mutex<Left>,
}

/// Where a method evaluates: at values of the parameters, or shares of their ranges.
#[derive(Clone, Copy)]
struct At<'a> {
    evaluations: &'a Evaluations<'a>,
    shares: bool,
}

impl Evaluate for At<'_> {
    fn outputs(&self, count: usize, point: &PointOf<'_>) -> Vec<Result<Vec<f64>, String>> {
        let Self { evaluations, shares } = self;
        let evaluate = |i: usize| {
            let point = point(i);
            if *shares {
                let places = evaluations.ranges.iter().zip(&point);
                let values: Vec<f64> = places.map(|(range, share)| range.value_at(*share)).collect();
                evaluations.solved(&values)
            } else {
                evaluations.solved(&point)
            }
        };
        let Some(all) = evaluations.jobs.compute(evaluations.label, count, evaluate) else {
            return vec![Err("interrupted".to_owned())];
        };
        let mut seen = evaluations.left.lock().unwrap_or_else(PoisonError::into_inner);
        let outputs = all.into_iter().map(|(outputs, left)| {
            seen.extend(left);
            outputs
        });
        outputs.collect()
    }
}

impl Evaluations<'_> {
    /// The outputs at values of the parameters, and the stated ranges outside which they lie.
    fn solved(&self, values: &[f64]) -> (Result<Vec<f64>, String>, Left) {
        let mut seen = Left::new();
        let mut outputs = || {
            let changes = self.ranges.iter().zip(values);
            let changes = changes.flat_map(|(range, value)| range.varied.overrides(*value));
            let transmission = self.trial.build(changes)?;
            let solved = self.trial.solve(self.jobs.engine, &transmission, self.points)?;
            seen.extend(left(&transmission, &solved.seen));
            self.outputs.values(&transmission, &solved.points)
        };
        let outputs = outputs().map_err(|reason: String| format!("{}: {reason}", words(self.ranges, values)));
        (outputs, seen)
    }
}

impl SensitivityEntry {
    fn does(&self, method: Method) -> bool {
        self.methods.contains(&method)
    }

    /// The grid without bound values and envelope; rejects a number of samples that is not a power of two.
    fn checked_grid<'s>(&self, cx: &Planner<'s>) -> Result<&'s Grid, Stopped> {
        let path = cx.path();
        let grid = cx.study.grid(&path, &self.grid)?;
        if !grid.bind.is_empty() || grid.envelope.is_some() {
            let message = "a sensitivity analysis needs a grid without bound values and envelope";
            return Err(cx.wrong(&path, message, "give it its own grid"));
        }
        if !self.samples.is_power_of_two() {
            let message = format!("the number of samples must be a power of two, not {}", self.samples);
            let help = format!("write `samples: {}`", self.samples.next_power_of_two());
            return Err(cx.wrong(&format!("{path}.samples"), message, &help));
        }
        Ok(grid)
    }

    /// The parameters without repetition.
    fn ranges(&self, cx: &Planner<'_>, built: &Built<'_>) -> Result<Vec<Range>, Stopped> {
        let mut ranges = Vec::new();
        for (i, parameter) in self.parameters.iter().enumerate() {
            let range = Range::new(cx, &place(cx, i), parameter, built)?;
            range.inside(cx, &place(cx, i))?;
            ranges.push(range);
        }
        let varied: Vec<_> = ranges.iter().map(|range| &range.varied).collect();
        once(cx, &format!("{}.parameters", cx.path()), &varied)?;
        Ok(ranges)
    }

    /// Number of evaluations of each requested method.
    fn runs(&self, parameters: usize) -> RunsOfMethods {
        let (trajectories, samples) = (self.trajectories as usize, self.samples as usize);
        let runs = |method: Method, count: usize| self.does(method).then_some(count);
        RunsOfMethods {
            local: runs(Method::Local, 1 + 2 * parameters),
            morris: runs(Method::Morris, trajectories * (parameters + 1)),
            sobol: runs(Method::Sobol, samples * (parameters + 2)),
        }
    }

    /// The sensitivities with one set.
    fn under_set(&self, engine: &Engine<'_>, set: &SensitivityOfOne<'_>) -> Result<SensitivityOfSet, Stopped> {
        let SensitivityOfOne {
            run,
            ranges,
            starts,
            runs,
        } = set;
        let (built, points) = (&run.built, &run.points);
        let no_value = |reason: String| {
            let message = format!("models {}: {}", built.name, without_coordinates(&reason));
            let help = "narrow the ranges, or delete points without a value from the grid";
            engine.wrong(&engine.path(), message, help)
        };
        let t = &built.transmission;
        let nominal = engine.solve_here(run)?;
        let relative = self.does(Method::Morris) || self.does(Method::Sobol);
        let outputs = Outputs::new(t, &nominal.points, relative);
        let means = outputs.values(t, &nominal.points).map_err(no_value)?;
        let evaluations = Evaluations {
            jobs: JobsWithin::new(engine),
            label: &built.name,
            trial: Trial::new(engine, built),
            points,
            ranges,
            outputs: &outputs,
            left: Mutex::default(),
        };
        let found = evaluations.jobs.result(self.found(starts, &evaluations))?;
        let found = found.map_err(no_value)?;
        let left_at_samples = evaluations.left.into_inner().unwrap_or_default();
        Ok(SensitivityOfSet {
            model_set: built.name.clone(),
            gear: points.gear.clone(),
            points: points.field.len(),
            runs: RunsOfMethods {
                morris: found.morris.as_ref().map(|morris| morris.runs),
                ..*runs
            },
            outputs: outcome::outputs(&outputs.list, &means, ranges, &found),
            parameters: ranges.iter().map(VariedParameter::new).collect(),
            samples: self.samples as usize,
            left_at_start: notes(t, &nominal.seen).iter().filter(|note| note.outside > 0).count(),
            left_at_samples,
        })
    }

    /// Results of the requested methods.
    fn found(&self, starts: &[Parameter], evaluations: &Evaluations<'_>) -> Result<Found, String> {
        let parameters = evaluations.ranges.len();
        let (trajectories, samples) = (self.trajectories as usize, self.samples as usize);
        let [values, shares] = [false, true].map(|shares| At { evaluations, shares });
        let slopes = self.does(Method::Local).then(|| local(starts, NOISE, values));
        let slopes = slopes.transpose()?;
        let morris = self
            .does(Method::Morris)
            .then(|| screening(parameters, trajectories, shares));
        let morris = morris.transpose()?;
        let sobol = self
            .does(Method::Sobol)
            .then(|| variance_shares(parameters, samples, RESAMPLES, shares));
        Ok(Found {
            local: slopes,
            morris,
            sobol: sobol.transpose()?,
        })
    }
}

/// Place of a parameter in the study.
fn place(cx: &Planner<'_>, number: usize) -> String {
    format!("{}.parameters.{number}", cx.path())
}

/// The parameters at the values of the gearbox, which must be within their ranges.
fn starts(cx: &Planner<'_>, ranges: &[Range]) -> Result<Vec<Parameter>, Stopped> {
    let start = |(i, range): (usize, &Range)| {
        let wrong = |message: String, help: &str| {
            let message = format!("{}: {message}", range.varied.pattern);
            cx.wrong(&place(cx, i), message, help)
        };
        let without = "`local` needs a value of the gearbox";
        let Some(present) = range.varied.start() else {
            let help = "state one, or omit `local`: `methods: [morris, sobol]`";
            return Err(wrong(without.to_owned(), help));
        };
        Parameter::new(&range.varied.pattern, Scale::Linear, present, range.ends).map_err(|_| {
            let [low, high] = range.ends.map(|end| range.varied.words(end));
            let message = format!(
                "the value {} for `local` is not in {low} to {high}",
                range.varied.words(present)
            );
            wrong(message, "widen the range, or omit `local`: `methods: [morris, sobol]`")
        })
    };
    ranges.iter().enumerate().map(start).collect()
}

/// Values of the parameters as text.
fn words(ranges: &[Range], values: &[f64]) -> String {
    let word = |(range, value): (&Range, &f64)| format!("{} = {}", range.varied.pattern, range.varied.words(*value));
    ranges.iter().zip(values).map(word).collect::<Vec<_>>().join(", ")
}

/// Removes the coordinates of the method from an error of an evaluation, which also contains the values of the user.
fn without_coordinates(reason: &str) -> &str {
    match reason.split_once("): ") {
        Some((at, rest)) if at.starts_with("at (") => rest,
        _ => reason,
    }
}
