//! What is observed of a contact, and its range over a path: a path is noted once, not at each of its points.

use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::real::Points;

use super::place::{Place, Settled};
use super::{LAMBDA, MU, MU_F, PECLET, PRESSURE, T_BODY, T_FILM, THICKNESS, WARMTH};

/// Observed quantities.
const QUANTITIES: usize = 9;

/// What is observed of a contact, in the units of the notes.
pub type Observation<R> = [R; QUANTITIES];

/// What is observed of a settled contact.
#[inline(always)]
pub fn observed<R: Points>(place: &Place<'_, R>, settled: &Settled<R>) -> Observation<R> {
    [
        place.mean_pressure().gpa(),
        place.peclet(),
        settled.bodies[0],
        settled.bodies[1],
        settled.film.um(),
        settled.lambda,
        settled.temperature,
        settled.mu_film,
        settled.mu,
    ]
}

/// Notes it, with further steps of the formula before the friction.
#[inline(always)]
pub fn note<R: Points>(notes: Notes<'_, R>, observed: &Observation<R>, steps: impl FnOnce()) {
    let [pressure, peclet, first, second, film, lambda, temperature, mu_film, mu] = *observed;
    notes.check(&PRESSURE, pressure);
    notes.check(&PECLET, peclet);
    notes.observe(&T_BODY[0], first);
    notes.observe(&T_BODY[1], second);
    notes.observe(&THICKNESS, film);
    notes.observe(&LAMBDA, lambda);
    notes.check(&WARMTH, temperature);
    notes.observe(&T_FILM, temperature);
    steps();
    notes.observe(&MU_F, mu_film);
    notes.observe(&MU, mu);
}

/// The ranges over the points of a path.
#[derive(Debug, Clone, Copy)]
pub struct Seen<R> {
    /// Minima.
    pub least: Observation<R>,
    /// Maxima.
    pub greatest: Observation<R>,
}

impl<R: Points> Default for Seen<R> {
    /// Nothing.
    fn default() -> Self {
        Self {
            least: [R::constant(f64::INFINITY); QUANTITIES],
            greatest: [R::constant(f64::NEG_INFINITY); QUANTITIES],
        }
    }
}

impl<R: Points> Seen<R> {
    /// Forgets what was seen where a condition holds.
    #[inline(always)]
    pub fn forget(&mut self, which: R::Mask) {
        let nothing = Self::default();
        for (end, nothing) in self.least.iter_mut().zip(nothing.least) {
            *end = R::select(which, nothing, *end);
        }
        for (end, nothing) in self.greatest.iter_mut().zip(nothing.greatest) {
            *end = R::select(which, nothing, *end);
        }
    }

    /// Adds a point of the path where a condition holds.
    #[inline(always)]
    pub fn add(&mut self, which: R::Mask, observed: &Observation<R>) {
        for ((least, greatest), x) in self.least.iter_mut().zip(&mut self.greatest).zip(observed) {
            *least = R::select(which, least.min(*x), *least);
            *greatest = R::select(which, greatest.max(*x), *greatest);
        }
    }

    /// Notes both ends of each range.
    #[inline(always)]
    pub fn note(&self, notes: Notes<'_, R>) {
        note(notes, &self.least, || ());
        note(notes, &self.greatest, || ());
    }
}
