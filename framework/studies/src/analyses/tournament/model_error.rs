//! The band of the loss over all combinations, with the error of each model that measured sets judge.
//!
//! Every combination has the same weight. In a sample a combination is drawn, and a factor for each of its laws with a known error and for
//! those of the other components. Losses are added at the temperatures of the base, as everywhere in a tournament.

use gearloss_framework::transmission::Transmission;
use gearloss_numerics::inference::Further;
use gearloss_numerics::sampling::Sobol;

use super::super::model_error::{ModelError, ModelErrorEntry, StateOfModelError, laws};
use super::super::{Built, Engine, Planner, Stopped};
use super::entrants::Entrants;
use super::field::Field;
use super::slot::Slot;
use crate::corpus::ErrorOfLaw;
use crate::points::{PointResult, quantile};

/// Number of samples of combinations and factors.
const SAMPLES: u32 = 512;

/// Probabilities of the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// The laws of the base and of the entrants of each mechanism with their errors.
#[derive(Clone)]
pub struct Errors {
    base: Vec<(ModelError, ErrorOfLaw)>,
    /// By mechanism and entrant, of those that can be built.
    entrants: Vec<Vec<Vec<(ModelError, ErrorOfLaw)>>>,
}

/// Losses by a law with a known error.
#[derive(Clone)]
pub struct LossOfLaw {
    factor: Further,
    /// By point. \[W\]
    loss: Vec<f64>,
}

impl Errors {
    /// Reads the cells and notes for the head what they say of every law that takes part.
    pub fn new(
        cx: &Planner<'_>,
        entry: Option<&ModelErrorEntry>,
        base: &Built<'_>,
        entrants: &[Entrants],
    ) -> Result<Option<Self>, Stopped> {
        let Some(entry) = entry else { return Ok(None) };
        let tables = entry.tables(cx)?;
        let cells = tables.cells();
        let of = |t: &Transmission| laws(cx, &base.resolved, t, &cells);
        let of_slot = |slot: &Entrants| {
            slot.list
                .iter()
                .map(|e| e.built.as_ref().map_or_else(|_| Vec::new(), &of))
                .collect()
        };
        let errors = Self {
            base: of(&base.transmission),
            entrants: entrants.iter().map(of_slot).collect(),
        };
        let parts = base.transmission.parts();
        let is_varied = |law: &&ModelError| {
            entrants
                .iter()
                .any(|e| law.parts.iter().any(|i| e.slot.covers(&parts[*i])))
        };
        let mut all: Vec<ModelError> = errors.base.iter().map(|(law, _)| law.clone()).collect();
        for (slot, of_slot) in entrants.iter().zip(&errors.entrants) {
            for (law, _) in of_slot.iter().flatten() {
                let known = all.iter().any(|other| {
                    (other.mechanism, &other.model, &other.kind) == (law.mechanism, &law.model, &law.kind)
                });
                if !known && slot.slot.is_of(law.mechanism) && is_varied(&law) {
                    // The components have the losses of the base.
                    all.push(ModelError {
                        parts: Vec::new(),
                        ..law.clone()
                    });
                }
            }
        }
        cx.keep_model_error(&base.name, all);
        Ok(Some(errors))
    }

    /// The known laws of the base in components of a mechanism, or in those of none.
    pub fn of_base(&self, t: &Transmission, points: &[PointResult], is_own: impl Fn(usize) -> bool) -> Vec<LossOfLaw> {
        known(&self.base, t, points, is_own)
    }

    /// The known laws of an entrant in the components of its mechanism.
    pub fn of_entrant(
        &self,
        [slot, entrant]: [usize; 2],
        t: &Transmission,
        points: &[PointResult],
        of: &Slot,
    ) -> Vec<LossOfLaw> {
        known(&self.entrants[slot][entrant], t, points, |part| {
            of.covers(&t.parts()[part])
        })
    }
}

fn known(
    laws: &[(ModelError, ErrorOfLaw)],
    t: &Transmission,
    points: &[PointResult],
    is_own: impl Fn(usize) -> bool,
) -> Vec<LossOfLaw> {
    let of_law = |(law, error): &(ModelError, ErrorOfLaw)| {
        let factor = error.factor.clone().filter(|_| law.state == StateOfModelError::Known)?;
        let parts: Vec<usize> = law
            .parts
            .iter()
            .copied()
            .filter(|part| *part < t.parts().len() && is_own(*part))
            .collect();
        let loss = points
            .iter()
            .map(|p| parts.iter().map(|part| p.parts[*part]).sum())
            .collect();
        (!parts.is_empty()).then_some(LossOfLaw { factor, loss })
    };
    laws.iter().filter_map(of_law).collect()
}

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
