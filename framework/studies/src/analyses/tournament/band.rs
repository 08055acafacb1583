//! The band of the loss over all combinations, with the error of each model that measured sets judge.
//!
//! Every combination has the same weight. In a sample a combination is drawn, and a factor for each of its laws with a known error and for
//! those of the other components. Losses are added at the temperatures of the base, as everywhere in a tournament.

use gearloss_numerics::sampling::Sobol;

use super::super::{Engine, Stopped};
use super::field::Field;
use super::law_loss::LossOfLaw;
use crate::points::quantile;

/// Number of samples of combinations and factors.
const SAMPLES: u32 = 512;

/// Probabilities of the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Lower end, median and upper end of the loss over all combinations, by point. \[W\]
pub fn bands(engine: &Engine<'_>, field: &Field<'_>) -> Result<Vec<[f64; 3]>, Stopped> {
    let of_slots = field
        .slots
        .iter()
        .map(|slot| slot.candidates.iter().map(|c| c.laws.len()).max().unwrap_or(0));
    let of_slots: Vec<usize> = of_slots.collect();
    let dimensions = field.rest_laws.len() + of_slots.iter().map(|laws| 1 + laws).sum::<usize>();
    let sobol =
        Sobol::new(dimensions).map_err(|reason| engine.wrong(&engine.path(), reason, "list fewer mechanisms"))?;
    let mut samples = vec![Vec::with_capacity(SAMPLES as usize); field.points.len()];
    for i in 0..SAMPLES {
        let mut shares = sobol.point(i).into_iter();
        let mut losses = field.rest.clone();
        let mut add = |laws: &[LossOfLaw], shares: &[f64]| {
            for (law, share) in laws.iter().zip(shares) {
                let factor = law.factor.quantile(*share).map_or(1.0, f64::exp);
                losses
                    .iter_mut()
                    .zip(&law.loss)
                    .for_each(|(sum, loss)| *sum += (factor - 1.0) * loss);
            }
        };
        add(
            &field.rest_laws,
            &shares.by_ref().take(field.rest_laws.len()).collect::<Vec<_>>(),
        );
        let mut chosen = Vec::new();
        for (slot, laws) in field.slots.iter().zip(&of_slots) {
            let place = shares.next().unwrap_or(0.0) * slot.candidates.len() as f64;
            let candidate = &slot.candidates[(place as usize).min(slot.candidates.len() - 1)];
            add(&candidate.laws, &shares.by_ref().take(*laws).collect::<Vec<_>>());
            chosen.push(candidate);
        }
        for (point, (samples, rest)) in samples.iter_mut().zip(&losses).enumerate() {
            samples.push(rest + chosen.iter().map(|candidate| candidate.loss[point]).sum::<f64>());
        }
    }
    let band = |mut losses: Vec<f64>| {
        losses.sort_unstable_by(f64::total_cmp);
        SHARES.map(|share| quantile(&losses, share))
    };
    Ok(samples.into_iter().map(band).collect())
}
