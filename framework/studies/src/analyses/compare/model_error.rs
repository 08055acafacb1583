//! Bands of differences with the error of the models. A law that several cases use has the same factor in a sample, so that its error cancels
//! as far as the cases lose the same by it.

use std::sync::Arc;

use gearloss_framework::transmission::Transmission;
use gearloss_numerics::sampling::Sobol;
use serde_json::Value;

use super::CompareEntry;
use crate::analyses::common::inputs::Input;
use crate::analyses::common::model_error::ModelErrorEntry;
use crate::analyses::common::trial::Trial;
use crate::analyses::{Built, Engine, Planner, Stopped};
use crate::distinct::distinct;
use crate::points::quantile;

/// Number of samples unless the study states one.
const SAMPLES: u32 = 64;

/// Probabilities of the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Losses of a case whose differences are averaged, by cycle; not a number where there is no loss. \[W\]
pub type Losses = Vec<Vec<f64>>;

/// The errors of the models of each case, the base first; none unless they are asked for.
pub fn inputs(cx: &Planner<'_>, entry: &CompareEntry, built: &[Arc<Built<'_>>]) -> Result<Vec<Vec<Input>>, Stopped> {
    if entry.samples.is_some() && entry.model_error.is_none() {
        let path = format!("{}.samples", cx.path());
        return Err(cx.wrong(
            &path,
            "`samples` belongs to `model_error`",
            "delete it, or write `model_error: corpus`",
        ));
    }
    if entry.model_error.is_none() {
        return Ok(Vec::new());
    }
    let of_case = |b: &Arc<Built<'_>>| {
        let mut inputs = Vec::new();
        ModelErrorEntry::add(entry.model_error.as_ref(), cx, b, &mut inputs)?;
        Ok(inputs)
    };
    built.iter().map(of_case).collect()
}

/// Lower end, median and upper end of the difference of each case from the base, by case and cycle; absent where no law has a known error,
/// and if fewer than half of the samples have a difference. \[W\]
pub fn bands(
    engine: &Engine<'_>,
    entry: &CompareEntry,
    (built, inputs): (&[Arc<Built<'_>>], &[Vec<Input>]),
    losses: &(dyn Fn(usize, &Trial<'_>, &Transmission) -> Result<Losses, String> + Sync),
) -> Result<Vec<Vec<Option<[f64; 3]>>>, Stopped> {
    let laws = distinct(inputs.iter().flatten().map(|input| input.range.varied.pattern.as_str()));
    if laws.is_empty() {
        return Ok(Vec::new());
    }
    let path = engine.path();
    let sobol = Sobol::new(laws.len()).map_err(|reason| engine.wrong(&path, reason, "compare fewer sets"))?;
    let first_variant = built.len() - entry.variants.len();
    let trials = built
        .iter()
        .enumerate()
        .map(|(case, b)| Trial::new(engine, if case < first_variant { b } else { &built[0] }));
    let trials: Vec<Trial<'_>> = trials.collect();
    let of_variant = |case: usize| -> Vec<(String, Value)> {
        let changes = case
            .checked_sub(first_variant)
            .and_then(|i| entry.variants.iter().nth(i));
        let changes = changes.into_iter().flat_map(|(_, values)| values.iter());
        changes.map(|(path, value)| (path.to_owned(), value.clone())).collect()
    };
    let sample = |i: usize| -> Result<Vec<Losses>, String> {
        let shares = sobol.point(i as u32);
        let share = |input: &Input| {
            laws.iter()
                .position(|law| *law == input.range.varied.pattern)
                .map_or(0.5, |k| shares[k])
        };
        let of_case = |(case, (trial, inputs)): (usize, (&Trial<'_>, &Vec<Input>))| {
            let mut changes = of_variant(case);
            for input in inputs {
                changes.extend(input.range.varied.overrides(input.value(share(input))?));
            }
            losses(case, trial, &trial.build(changes)?)
        };
        trials.iter().zip(inputs).enumerate().map(of_case).collect()
    };
    let count = entry.samples.unwrap_or(SAMPLES) as usize;
    let all = engine.jobs("samples of the error of the models", count, |i| Ok(sample(i).ok()))?;
    let solved: Vec<&Vec<Losses>> = all.iter().flatten().collect();
    let band = |case: usize, cycle: usize| {
        let difference =
            |sample: &&Vec<Losses>| mean_difference(sample.first()?.get(cycle)?, sample.get(case)?.get(cycle)?);
        let mut differences: Vec<f64> = solved.iter().filter_map(difference).collect();
        differences.sort_unstable_by(f64::total_cmp);
        (2 * differences.len() > count).then(|| SHARES.map(|share| quantile(&differences, share)))
    };
    let cycles = solved.first().and_then(|sample| sample.first()).map_or(0, Vec::len);
    Ok((1..built.len())
        .map(|case| (0..cycles).map(|cycle| band(case, cycle)).collect())
        .collect())
}

/// Mean of the differences where both have a loss.
fn mean_difference(base: &[f64], other: &[f64]) -> Option<f64> {
    let differences = base
        .iter()
        .zip(other)
        .map(|(base, other)| other - base)
        .filter(|x| x.is_finite());
    let differences: Vec<f64> = differences.collect();
    (!differences.is_empty()).then(|| differences.iter().sum::<f64>() / differences.len() as f64)
}
