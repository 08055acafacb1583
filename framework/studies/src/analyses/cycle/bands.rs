//! Bands of mean losses from uncertain inputs.

use gearloss_numerics::sampling::Sobol;

use super::CycleAnalysisEntry;
use super::outcome::{BandOfDuty, DutyOfSet, InputOfBand};
use crate::analyses::common::duties::{Duties, MeanLoss};
use crate::analyses::common::inputs::Input;
use crate::analyses::common::trial::{Left, Trial};
use crate::analyses::{Built, Engine, Stopped};
use crate::points::{correlation, quantile};

/// Probabilities of the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Results of samples of a gearbox.
struct Samples {
    /// Values of the inputs, and the mean losses of each cycle.
    driven: Vec<(Vec<f64>, Vec<MeanLoss>)>,
    /// Why each of the other samples has no value.
    failed: Vec<String>,
    left: Left,
}

/// Simulates all duties with samples of a gearbox.
pub fn bands<'i>(
    engine: &Engine<'_>,
    entry: &CycleAnalysisEntry,
    (built, inputs): (&Built<'_>, &'i [Input]),
    (duties, names): (&Duties<'_>, &[String]),
) -> Result<Bands<'i>, Stopped> {
    let samples = sample(engine, entry, (built, inputs), (duties, names))?;
    Ok(Bands {
        inputs,
        samples,
        shares: names.len(),
    })
}

/// Samples of the duties of one model set.
pub struct Bands<'i> {
    inputs: &'i [Input],
    samples: Samples,
    shares: usize,
}

impl Bands<'_> {
    /// Adds the bands to the results of the duties.
    pub fn add_to(&self, results: &mut [DutyOfSet]) {
        for (k, result) in results.iter_mut().enumerate() {
            let mut band = self.samples.band(k, self.inputs, self.shares);
            let [low, _, high] = band.mean_loss_w;
            let reference = result.reference.as_ref();
            band.reference_inside = reference.map(|reference| (low..=high).contains(&reference.mean_loss_w));
            result.bands = Some(band);
        }
    }

    /// The stated ranges outside which samples lie.
    pub fn left(self) -> Left {
        self.samples.left
    }
}

fn sample(
    engine: &Engine<'_>,
    entry: &CycleAnalysisEntry,
    (built, inputs): (&Built<'_>, &[Input]),
    (duties, names): (&Duties<'_>, &[String]),
) -> Result<Samples, Stopped> {
    let path = engine.path();
    let sobol = Sobol::new(inputs.len()).map_err(|reason| engine.wrong(&path, reason, "use fewer inputs"))?;
    let trial = Trial::new(engine, built);
    let sample = |i: usize| -> Result<(Vec<f64>, Vec<MeanLoss>, Left), String> {
        let shares = sobol.point(i as u32);
        let values: Vec<f64> = inputs
            .iter()
            .zip(shares)
            .map(|(input, share)| input.value(share))
            .collect::<Result<_, _>>()?;
        let changes = inputs.iter().zip(&values);
        let t = trial.build(changes.flat_map(|(input, value)| input.range.varied.overrides(*value)))?;
        let driven = duties.mean_losses(engine, &t, entry.by, names);
        let (losses, left) = driven.map_err(|unfinished| unfinished.message)?;
        Ok((values, losses, left))
    };
    let all = engine.jobs(&format!("{} samples", built.name), entry.samples as usize, |i| {
        Ok(sample(i))
    })?;
    let mut samples = Samples {
        driven: Vec::new(),
        failed: Vec::new(),
        left: Left::new(),
    };
    for result in all {
        match result {
            Ok((values, losses, more)) => {
                samples.left.extend(more);
                samples.driven.push((values, losses));
            }
            Err(reason) => samples.failed.push(reason),
        }
    }
    if samples.driven.len() < 2 {
        let first = samples.failed.first().map_or("", String::as_str);
        let message = format!("hardly any sample could be simulated: {first}");
        return Err(engine.wrong(&path, message, "narrow the ranges of the inputs"));
    }
    Ok(samples)
}

impl Samples {
    /// The band of one cycle.
    fn band(&self, duty: usize, inputs: &[Input], shares: usize) -> BandOfDuty {
        let band_of = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            SHARES.map(|share| quantile(&values, share))
        };
        let band = |watts: &dyn Fn(&MeanLoss) -> f64| {
            band_of(self.driven.iter().map(|(_, losses)| watts(&losses[duty])).collect())
        };
        let consumed =
            |(_, losses): &(Vec<f64>, Vec<MeanLoss>)| Some(losses[duty].consumption?.consumption_kwh_per_100_km);
        let consumption: Option<Vec<f64>> = self.driven.iter().map(consumed).collect();
        BandOfDuty {
            samples: self.driven.len(),
            failed: self.failed.len(),
            quantiles: SHARES,
            mean_loss_w: band(&|mean| mean.loss),
            mean_losses_w: (0..shares).map(|k| band(&|mean| mean.shares[k])).collect(),
            consumption_kwh_per_100_km: consumption.map(band_of),
            inputs: self.ranked(duty, inputs),
            reference_inside: None,
            first_failure: self.failed.first().cloned(),
        }
    }

    /// Inputs with their correlation with the mean loss of a cycle, the strongest first.
    fn ranked(&self, duty: usize, inputs: &[Input]) -> Vec<InputOfBand> {
        let losses: Vec<f64> = self.driven.iter().map(|(_, losses)| losses[duty].loss).collect();
        let input = |(k, input): (usize, &Input)| {
            let values: Vec<f64> = self.driven.iter().map(|(values, _)| values[k]).collect();
            let [from, to] = input.range.ends.map(|end| input.range.varied.words(end));
            InputOfBand {
                input: format!("{} {from} to {to}", input.range.varied.pattern),
                correlation_with_mean_loss: correlation(&values, &losses),
            }
        };
        let mut ranked: Vec<InputOfBand> = inputs.iter().enumerate().map(input).collect();
        let strength = |input: &InputOfBand| input.correlation_with_mean_loss.unwrap_or(0.0).abs();
        ranked.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
        ranked
    }
}
