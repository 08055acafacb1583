//! The laws of a tournament whose error measured sets tell, and the losses by them.

use gearloss_framework::transmission::Transmission;

use super::super::common::model_error::{ModelError, ModelErrorEntry, StateOfModelError, laws};
use super::super::{Built, Planner, Stopped};
use super::entrants::Entrants;
use super::law_loss::LossOfLaw;
use super::slot::Slot;
use crate::corpus::ErrorOfLaw;
use crate::points::PointResult;

/// The laws of the base and of the entrants of each mechanism with their errors.
#[derive(Clone)]
pub struct Errors {
    base: Vec<(ModelError, ErrorOfLaw)>,
    /// By mechanism and entrant, of those that can be built.
    entrants: Vec<Vec<Vec<(ModelError, ErrorOfLaw)>>>,
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
