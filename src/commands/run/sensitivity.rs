//! What the losses over a grid depend on: slopes, screening, shares of the variance.

mod outputs;
mod pictures;
mod results;
mod show;

use std::sync::Mutex;

use gearloss_numerics::inference::{Parameter, Scale};
use gearloss_numerics::sensitivity::{Local, Screening, VarianceShares, local, screening, variance_shares};
use gearloss_studies::analysis::Points;
use gearloss_studies::study::{Method, SensitivityEntry};
use indicatif::ProgressBar;
use serde_json::Value;

use self::outputs::{Kind, Outputs};
use super::write::{head, write};
use super::{Built, Runner, grid_axes};
use crate::interrupt;
use crate::output::{Failure, Out};
use gearloss_studies::analyses::ranges::{Range, once};
use gearloss_studies::analyses::trial::{Left, Trial, left};

/// Relative noise of a mean loss. A point is solved until what is left to change is below 1e-9 of its power.
const NOISE: f64 = 1e-9;
/// Resamples for the intervals of shares.
const RESAMPLES: usize = 200;

/// What was found for one set of models.
struct Found<'a> {
    built: Built<'a>,
    gear: String,
    /// Number of points of the grid.
    points: usize,
    ranges: Vec<Range>,
    outputs: Outputs,
    /// Values of the outputs at the values of the gearbox.
    values: Vec<f64>,
    /// By output, then by parameter.
    local: Option<Vec<Vec<Local>>>,
    morris: Option<Screening>,
    /// By output.
    sobol: Option<Vec<VarianceShares>>,
    /// Samples of `sobol`.
    samples: usize,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &SensitivityEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let grid = runner.study.grid(&path, &entry.grid)?;
    if !grid.bind.is_empty() || grid.envelope.is_some() {
        let message = "a sensitivity takes a grid without bound values and envelope";
        return Err(runner.wrong(&path, message, "give it a grid of its own"));
    }
    if !entry.samples.is_power_of_two() {
        let message = format!(
            "{} samples are no power of two, and only those fill the ranges evenly",
            entry.samples
        );
        let mend = format!("write `samples: {}`", entry.samples.next_power_of_two());
        return Err(runner.wrong(&format!("{path}.samples"), message, &mend));
    }
    let mut all = Vec::new();
    for built in runner.built(gearbox, &entry.model_sets)? {
        let gear = runner.one_gear(&path, grid, &built.transmission)?;
        let (torques, speeds) = grid_axes(runner, &entry.grid, grid, &built.transmission)?;
        let mut points = runner.points(&built.transmission, &gear, torques, speeds);
        points.terms = true;
        all.extend(found(runner, &path, entry, built, &points, out)?);
    }
    if runner.only_checks {
        return Ok(());
    }
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for found in &all {
        show::show(runner, name, found, out)?;
        rows.extend(found.rows());
        values.push(found.result());
        pictures::draw(runner, name, found, &entry.write)?;
    }
    let mut value = head(runner, &all.iter().map(|found| &found.built).collect::<Vec<_>>());
    value["sensitivities"] = Value::Array(values);
    write(runner, name, &entry.write, &results::header(), &rows, &value)
}

impl Found<'_> {
    /// Slopes of an output over a parameter, without an elasticity where the parameter is zero: it has no relative change. None of the
    /// relative change over the points, which is least at the values of the gearbox and has a kink there.
    fn slopes(&self, output: usize, parameter: usize) -> Option<Local> {
        if self.outputs.list[output].kind == Kind::RelativeLoss {
            return None;
        }
        let local = self.local.as_ref()?[output][parameter];
        let zero = self.ranges[parameter].varied.start() == Some(0.0);
        Some(Local {
            elasticity: local.elasticity.filter(|_| !zero),
            ..local
        })
    }
}

/// Everything of one set; nothing where it is only checked.
fn found<'a>(
    runner: &Runner<'_>,
    path: &str,
    entry: &SensitivityEntry,
    built: Built<'a>,
    points: &Points,
    out: &mut Out,
) -> Result<Option<Found<'a>>, Failure> {
    let place = |i: usize| format!("{path}.parameters.{i}");
    let mut ranges = Vec::new();
    for (i, parameter) in entry.parameters.iter().enumerate() {
        let range = Range::new(runner, &place(i), parameter, &built)?;
        range.inside(runner, &place(i))?;
        ranges.push(range);
    }
    once(
        runner,
        &format!("{path}.parameters"),
        &ranges.iter().map(|range| &range.varied).collect::<Vec<_>>(),
    )?;
    let wanted = |method: Method| entry.methods.contains(&method);
    let starts = if wanted(Method::Local) {
        starts(runner, &place, &ranges)?
    } else {
        Vec::new()
    };
    let no_value = |reason: String| {
        let message = format!("models {}: {}", built.name, without_coordinates(&reason));
        let mend = "narrow the ranges, or leave points without a value out of the grid";
        runner.wrong(path, message, mend)
    };
    let (parameters, trajectories, samples) = (ranges.len(), entry.trajectories as usize, entry.samples as usize);
    let runs = [
        (Method::Local, 1 + 2 * parameters),
        (Method::Morris, trajectories * (parameters + 1)),
        (Method::Sobol, samples * (parameters + 2)),
    ];
    let count: usize = runs.iter().filter(|(method, _)| wanted(*method)).map(|(_, n)| n).sum();
    runner.holds(path, points.field.len(), count)?;
    if runner.checked(&built, points)? {
        return Ok(None);
    }
    let nominal = runner.solve(&built, points)?.points;
    let outputs = Outputs::of(
        &built.transmission,
        &nominal,
        wanted(Method::Morris) || wanted(Method::Sobol),
    );
    let values = outputs.values(&built.transmission, &nominal).map_err(no_value)?;
    let bar = runner.bar(count as u64, &built.name);
    let trial = Trial::new(runner, &built);
    let seen = Mutex::new(Left::new());
    let evaluate = |values: &[f64]| -> Result<Vec<f64>, String> {
        if interrupt::pressed() {
            return Err("interrupted".to_owned());
        }
        let one = || {
            let changes = ranges.iter().zip(values);
            let transmission = trial.build(changes.flat_map(|(range, value)| range.varied.overrides(*value)))?;
            let solved = trial.solve(&transmission, points)?;
            if let Ok(mut seen) = seen.lock() {
                seen.extend(left(&transmission, &solved.seen));
            }
            outputs.values(&transmission, &solved.points)
        };
        let found = one().map_err(|reason| format!("{}: {reason}", words(&ranges, values)));
        bar.inc(1);
        found
    };
    let shares = |shares: &[f64]| evaluate(&at(&ranges, shares));
    let work = || -> Result<_, String> {
        let local = wanted(Method::Local)
            .then(|| local(&starts, NOISE, evaluate))
            .transpose()?;
        let morris = wanted(Method::Morris).then(|| screening(parameters, trajectories, shares));
        let morris = morris.transpose()?;
        let sobol = wanted(Method::Sobol).then(|| variance_shares(parameters, samples, RESAMPLES, shares));
        Ok((local, morris, sobol.transpose()?))
    };
    let worked = work();
    ProgressBar::finish_and_clear(&bar);
    if interrupt::pressed() {
        return Err(Failure::Interrupted);
    }
    let (local, morris, sobol) = worked.map_err(no_value)?;
    runner.left_at_samples(&seen.into_inner().unwrap_or_default(), out);
    Ok(Some(Found {
        gear: points.gear.clone(),
        points: points.field.len(),
        built,
        ranges,
        outputs,
        values,
        local,
        morris,
        sobol,
        samples,
    }))
}

/// The parameters at the values of the gearbox, which have to lie in their ranges.
fn starts(runner: &Runner<'_>, place: &dyn Fn(usize) -> String, ranges: &[Range]) -> Result<Vec<Parameter>, Failure> {
    let start = |(i, range): (usize, &Range)| {
        let wrong = |message: String, mend: &str| {
            let message = format!("{}: {message}", range.varied.pattern);
            runner.wrong(&place(i), message, mend)
        };
        let without = "the gearbox states no value at which `local` could stand";
        let Some(own) = range.varied.start() else {
            let mend = "state one, or leave `local` out: `methods: [morris, sobol]`";
            return Err(wrong(without.to_owned(), mend));
        };
        Parameter::new(&range.varied.pattern, Scale::Linear, own, range.ends).map_err(|_| {
            let [low, high] = range.ends.map(|end| range.varied.words(end));
            let message = format!(
                "`local` stands at {}, which is not in {low} to {high}",
                range.varied.words(own)
            );
            wrong(
                message,
                "widen the range, or leave `local` out: `methods: [morris, sobol]`",
            )
        })
    };
    ranges.iter().enumerate().map(start).collect()
}

/// Values of the parameters at shares of their ranges.
fn at(ranges: &[Range], shares: &[f64]) -> Vec<f64> {
    ranges
        .iter()
        .zip(shares)
        .map(|(range, share)| range.at(*share))
        .collect()
}

/// Values of the parameters in words.
fn words(ranges: &[Range], values: &[f64]) -> String {
    let word = |(range, value): (&Range, &f64)| format!("{} = {}", range.varied.pattern, range.varied.words(*value));
    ranges.iter().zip(values).map(word).collect::<Vec<_>>().join(", ")
}

/// A fault of an evaluation says where it was, in coordinates of the method, and then in the user's own words: these do.
fn without_coordinates(reason: &str) -> &str {
    match reason.split_once("): ") {
        Some((at, rest)) if at.starts_with("at (") => rest,
        _ => reason,
    }
}
