//! A model in the judged components, solved at the measured rows.

use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use super::super::common::trial::why;
use super::super::tournament::entrants::Entrant;
use super::super::tournament::slot::Slot;
use super::super::{Built, Planner, Stopped};
use super::{LossOf, ValidationEntry};
use crate::points::{PointResult, Rows};

/// A model, and the gearbox with it.
pub struct Candidate<'a> {
    pub name: String,
    /// As in a gearbox.
    pub model: Value,
    pub variants: Variants<'a>,
    slot: Slot,
    entry: &'a ValidationEntry,
}

/// A solved row, and the loss that is compared with the measured one.
pub struct PointOfCandidate {
    pub point: PointResult,
    /// \[W\]
    pub loss: f64,
}

impl<'a> Candidate<'a> {
    /// The gearbox with a model in every slot of the mechanism that is not written for one component.
    pub fn new(cx: &Planner<'a>, base: &Built<'a>, entry: &'a ValidationEntry, slot: &Slot, entrant: &Entrant) -> Self {
        let mut choice = cx.study.choice(base.set());
        let replaced = slot.replaced(cx.language, &base.resolved).into_iter();
        let fits = |path: &String| {
            let section = path.split('.').next().unwrap_or_default();
            !slot.is_drag() || cx.language.fits_scope(section, &entrant.model)
        };
        choice
            .overrides
            .extend(replaced.filter(fits).map(|path| (path, entrant.model.clone())));
        Self {
            name: entrant.name.clone(),
            model: entrant.model.clone(),
            variants: Variants::new(cx.language, base.gearbox, choice),
            slot: slot.clone(),
            entry,
        }
    }

    /// The rows with further overrides, or why one of them has no loss.
    ///
    /// # Errors
    /// An interruption.
    pub fn points(
        &self,
        rows: &Rows<'_>,
        changes: &[(String, Value)],
        going: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<Result<Vec<PointOfCandidate>, String>, Stopped> {
        let built = match rows.build(&self.variants, changes) {
            Ok(built) => built,
            Err(findings) => return Ok(Err(findings.first())),
        };
        let solved = match rows.solve(built, None, going) {
            Ok(Some(solved)) => solved,
            Ok(None) => return Err(Stopped::Interrupted),
            Err(list) => {
                return Ok(Err(list
                    .first()
                    .map_or_else(String::new, |error| error.message.clone())));
            }
        };
        let judged: Vec<Vec<usize>> = solved.transmissions.iter().map(|t| self.judged(t)).collect();
        let point = |(place, _, point): (usize, String, PointResult)| {
            if point.loss.is_none() {
                return Err(why(&solved.transmissions[place], &point));
            }
            let loss = judged[place].iter().map(|part| point.parts[*part]).sum();
            Ok(PointOfCandidate { point, loss })
        };
        Ok(solved.rows.into_iter().map(point).collect())
    }

    /// Indices of the components whose losses are compared.
    fn judged(&self, transmission: &Transmission) -> Vec<usize> {
        let parts = transmission.parts();
        match self.entry.loss_of {
            LossOf::Gearbox => (0..parts.len()).collect(),
            LossOf::Judged => {
                let listed = |path: &String| self.entry.components.is_empty() || self.entry.components.contains(path);
                let covered = self.slot.covered(parts).into_iter();
                covered.filter(|part| listed(&parts[*part].path)).collect()
            }
        }
    }
}
