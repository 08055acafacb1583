//! Bands of mean losses from uncertain inputs.

use gearloss_numerics::sampling::Sobol;
use gearloss_studies::analysis::quantile;
use gearloss_studies::study::{CycleAnalysisEntry, ReferenceLoss};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::super::{Built, Runner};
use super::outcome::Outcome;
use crate::interrupt;
use crate::output::{Failure, Out, Table};
use gearloss_studies::analyses::duties::Duties;
use gearloss_studies::analyses::inputs::Input;
use gearloss_studies::analyses::shares::Shares;
use gearloss_studies::analyses::trial::{Left, Trial, left};

/// Shares of the samples below the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// What samples leave of one duty.
pub struct Band {
    samples: usize,
    failed: Vec<String>,
    /// Mean loss. \[W\]
    loss: [f64; 3],
    /// Mean losses by share. \[W\]
    shares: Vec<[f64; 3]>,
    /// Inputs with their correlation with the mean loss, the strongest first.
    ranked: Vec<(String, Option<f64>)>,
}

/// Values of the inputs; for each duty its mean losses by share and their sum; stated ranges that were left.
type Sample = (Vec<f64>, Vec<(f64, Vec<f64>)>, Left);

/// Drives all duties through samples of a gearbox.
pub fn sample(
    runner: &Runner<'_>,
    path: &str,
    entry: &CycleAnalysisEntry,
    built: &Built<'_>,
    duties: &Duties<'_>,
    outcomes: &mut [Outcome<'_>],
    out: &mut Out,
) -> Result<(), Failure> {
    let inputs = Input::all(runner, path, &entry.inputs, built)?;
    let sobol = Sobol::new(inputs.len()).map_err(|reason| runner.wrong(path, reason, "use fewer inputs"))?;
    let trial = Trial::new(runner, built);
    let names: Vec<String> = outcomes.first().map(|o| o.names.clone()).unwrap_or_default();
    let bar = runner.bar(u64::from(entry.samples), &format!("{} samples", built.name));
    let one = |i: u32| -> Result<Sample, String> {
        let shares = sobol.point(i);
        let values: Vec<f64> = inputs
            .iter()
            .zip(shares)
            .map(|(input, share)| input.value(share))
            .collect::<Result<_, _>>()?;
        let changes = inputs.iter().zip(&values);
        let t = trial.build(changes.flat_map(|(input, value)| input.range.varied.overrides(*value)))?;
        let shares = Shares::of(&t, entry.by).under(&names);
        let mut losses = Vec::new();
        let mut seen = Left::new();
        for read in &duties.list {
            let driven = duties
                .drive(&t, read, &|_| !interrupt::pressed())
                .map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?
                .ok_or("interrupted")?;
            if let Some((time, _)) = driven.broken {
                return Err(format!("`{}` could not be driven beyond {time} s", read.name));
            }
            let time = driven.total.duration;
            let means: Vec<f64> = shares.sums(&driven.total.parts).iter().map(|x| x / time).collect();
            losses.push((driven.total.parts.iter().sum::<f64>() / time, means));
            seen.extend(left(&t, &driven.seen));
        }
        bar.inc(1);
        Ok((values, losses, seen))
    };
    let all: Vec<Result<Sample, String>> = (0..entry.samples).into_par_iter().with_max_len(1).map(one).collect();
    bar.finish_and_clear();
    if interrupt::pressed() {
        return Err(Failure::Interrupted);
    }
    let (mut samples, mut failed, mut seen) = (Vec::new(), Vec::new(), Left::new());
    for sample in all {
        match sample {
            Ok((values, losses, more)) => {
                seen.extend(more);
                samples.push((values, losses));
            }
            Err(reason) => failed.push(reason),
        }
    }
    if samples.len() < 2 {
        let first = failed.first().map_or("", String::as_str);
        let message = format!("hardly a sample could be driven: {first}");
        return Err(runner.wrong(path, message, "narrow the ranges of the inputs"));
    }
    runner.left_at_samples(&seen, out);
    let own = outcomes.iter_mut().filter(|o| std::ptr::eq(o.built, built));
    for (duty, outcome) in own.enumerate() {
        let band = |of: &dyn Fn(&(f64, Vec<f64>)) -> f64| {
            let mut values: Vec<f64> = samples.iter().map(|(_, losses)| of(&losses[duty])).collect();
            values.sort_by(f64::total_cmp);
            SHARES.map(|share| quantile(&values, share))
        };
        let losses: Vec<f64> = samples.iter().map(|(_, losses)| losses[duty].0).collect();
        let correlation = |k: usize| {
            let values: Vec<f64> = samples.iter().map(|(values, _)| values[k]).collect();
            gearloss_studies::analysis::correlation(&values, &losses)
        };
        let mut ranked: Vec<(String, Option<f64>)> = inputs
            .iter()
            .enumerate()
            .map(|(k, input)| {
                let [from, to] = input.range.ends.map(|end| input.range.varied.words(end));
                (format!("{} {from} to {to}", input.range.varied.pattern), correlation(k))
            })
            .collect();
        ranked.sort_by(|a, b| b.1.unwrap_or(0.0).abs().total_cmp(&a.1.unwrap_or(0.0).abs()));
        outcome.bands = Some(Band {
            samples: samples.len(),
            failed: failed.clone(),
            loss: band(&|(loss, _)| *loss),
            shares: (0..names.len()).map(|k| band(&|(_, shares)| shares[k])).collect(),
            ranked,
        });
    }
    Ok(())
}

impl Band {
    /// The band in lines: of the loss, of its shares, and which inputs make it.
    pub fn lines(&self, o: &Outcome<'_>) -> String {
        let [low, middle, high] = self.loss;
        let mut text = format!(
            "  {} samples of {} inputs: mean loss {low:.1} to {high:.1} W (95 %), median {middle:.1} W",
            self.samples,
            self.ranked.len()
        );
        if let Some(reference) = o.reference {
            let inside = (low..=high).contains(&reference.loss);
            text.push_str(&format!(
                "; {} W lies {} it",
                reference.loss,
                if inside { "in" } else { "outside of" }
            ));
        }
        text.push('\n');
        if let Some(reason) = self.failed.first() {
            text.push_str(&format!(
                "  {} further samples have no value: {reason}\n",
                self.failed.len()
            ));
        }
        let mut table = Table::new(&["loss", "2.5 % W", "median W", "97.5 % W"]);
        for (name, band) in o.names.iter().zip(&self.shares) {
            let mut row = vec![name.clone()];
            row.extend(band.iter().map(|x| format!("{x:.2}")));
            table.row(row);
        }
        text.push_str(&table.render());
        let mut table = Table::new(&["input", "correlation with the mean loss"]);
        for (input, correlation) in &self.ranked {
            table.row(vec![input.clone(), crate::output::number(*correlation, 3)]);
        }
        text.push_str(&table.render());
        text
    }

    /// The band as JSON; its shares are in the order of those of the outcome.
    pub fn json(&self, reference: Option<&ReferenceLoss>) -> Value {
        let [low, _, high] = self.loss;
        json!({
            "samples": self.samples, "failed": self.failed.len(), "quantiles": SHARES, "mean_loss_w": self.loss,
            "mean_losses_w": self.shares,
            "inputs": self.ranked.iter().map(|(input, c)| json!({ "input": input, "correlation_with_mean_loss": c })).collect::<Vec<_>>(),
            "reference_inside": reference.map(|r| (low..=high).contains(&r.loss)),
        })
    }
}
