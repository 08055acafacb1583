//! The band of a gain under uncertain inputs.

use gearloss_numerics::sampling::Sobol;

use super::drives::Drives;
use super::objectives::Objective;
use crate::analyses::Stopped;
use crate::analyses::common::inputs::Input;
use crate::points::quantile;

/// Probabilities of the ends and the middle of a band.
pub const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Quantiles of the gains of an objective over the samples, in its unit.
#[derive(Debug, Clone)]
pub struct Band {
    /// Of all changes together.
    pub all: [f64; 3],
    /// Of each change alone.
    pub alone: Vec<[f64; 3]>,
    /// Number of samples that could be driven.
    pub samples: usize,
}

/// The bands of the objectives. Present and best design have the same inputs in each sample, so that what is uncertain in both cancels.
pub fn of_gain(
    drives: &Drives<'_>,
    samples: u32,
    inputs: &[Input],
    genes: &[f64],
    changed: &[usize],
    objectives: &[Objective],
) -> Result<Vec<Band>, Stopped> {
    let engine = drives.engine;
    let path = engine.path();
    let sobol = Sobol::new(inputs.len()).map_err(|reason| engine.wrong(&path, reason, "use fewer inputs"))?;
    // Gains by set of changes and objective.
    let sample = |i: usize| -> Result<Vec<Vec<f64>>, String> {
        let shares = sobol.point(i as u32);
        let mut values = Vec::new();
        for (input, share) in inputs.iter().zip(shares) {
            values.extend(input.range.varied.overrides(input.value(share)?));
        }
        let losses = |is_changed: &dyn Fn(usize) -> bool| -> Result<Vec<f64>, String> {
            let changes = drives.overrides(genes, is_changed);
            let drive = drives.drive(values.iter().cloned().chain(changes).collect())?;
            Ok(objectives.iter().map(|objective| objective.value(&drive)).collect())
        };
        let present = losses(&|_| false)?;
        let gain = |losses: Vec<f64>| {
            present
                .iter()
                .zip(losses)
                .map(|(present, changed_loss)| present - changed_loss)
                .collect()
        };
        let mut gains = vec![gain(losses(&|_| true)?)];
        for variable in changed {
            gains.push(gain(losses(&|place| place == *variable)?));
        }
        Ok(gains)
    };
    let all = engine.jobs("samples of the gain", samples as usize, |i| Ok(sample(i)))?;
    let driven: Vec<Vec<Vec<f64>>> = all.into_iter().flatten().collect();
    if driven.len() < 2 {
        let message = "hardly any sample of the uncertain inputs could be driven";
        return Err(engine.wrong(&format!("{path}.inputs"), message, "narrow the ranges of the inputs"));
    }
    let band = |set: usize, objective: usize| {
        let mut gains: Vec<f64> = driven.iter().map(|sample| sample[set][objective]).collect();
        gains.sort_by(f64::total_cmp);
        SHARES.map(|share| quantile(&gains, share))
    };
    let bands = (0..objectives.len()).map(|objective| Band {
        all: band(0, objective),
        alone: (1..=changed.len()).map(|set| band(set, objective)).collect(),
        samples: driven.len(),
    });
    Ok(bands.collect())
}
