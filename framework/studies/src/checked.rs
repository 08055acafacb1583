//! A gearbox that was checked: what it is built from, and what deserves attention.

use gearloss_framework::coefficients::{Changed, changed_from_source};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::Transmission;

use crate::points::{Note, STATIC_SAFETY, WeakPoint, evidence, merge, notes};

/// A gearbox that was read, resolved and built.
pub struct CheckedGearbox {
    /// The gearbox.
    pub gearbox: Gearbox,
    /// Its resolved description.
    pub resolved: Resolved,
    /// Its transmission.
    pub transmission: Transmission,
    /// Evidence, lowest grade first.
    pub evidence: Vec<WeakPoint>,
    /// Coefficients that differ from their source.
    pub changed: Vec<Changed>,
}

impl CheckedGearbox {
    /// Builds a resolved gearbox.
    ///
    /// # Errors
    /// Everything that building finds.
    pub fn new(language: &Language, gearbox: Gearbox, resolved: Resolved) -> Result<Self, Findings> {
        let transmission = gearbox.build(language, &resolved)?;
        Ok(Self {
            evidence: evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path)),
            changed: changed_from_source(&transmission, &resolved),
            gearbox,
            resolved,
            transmission,
        })
    }

    /// The lowest grade of evidence.
    pub fn lowest_evidence(&self) -> Option<Evidence> {
        self.evidence.first().map(|weak| weak.grade)
    }
}

/// Bearings with insufficient static safety at the rated torque and speed, in any gear, in drive and coast.
pub fn overloaded(t: &Transmission) -> Vec<Note> {
    let Some(rating) = t.rating else { return Vec::new() };
    let mut seen = Vec::new();
    for i in 0..t.states().len() {
        let Some(case) = t.case_at_reference(i) else { continue };
        let mut scratch = t.scratch(&case);
        let mut torques = vec![0.0; case.torque_ports.len()];
        for sign in [1.0, -1.0] {
            let Some(first) = torques.first_mut() else { continue };
            *first = sign * rating.torque;
            let point = Point {
                speeds: &[rating.speed],
                torques: &torques,
                flow: PowerFlow::Ideal,
                ..Point::default()
            };
            t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
        }
        merge(&mut seen, &scratch.totals);
    }
    if seen.is_empty() {
        return Vec::new();
    }
    let safety = |note: &Note| note.name == STATIC_SAFETY;
    notes(t, &seen).into_iter().filter(safety).collect()
}
