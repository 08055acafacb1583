//! Derivatives of a converged flow: the iteration between torque and loss, continued over numbers with derivatives.
//!
//! At a converged point, losses u = g(u, p) follow from themselves and the given quantities p. Their derivatives therefore follow from
//! u' = g_u u' + g_p, where g_u is about the share of losses in the power. Each pass over the models multiplies the error of u' by this
//! share, so that a few passes reach rounding. Values and driving gears stay those of the point.

use super::Flow;
use super::solve::evaluate_losses;
use super::work::{FlowState, Work};
use crate::real::{DIRECTIONS, Dual, Real as _};

/// Maximum number of passes: losses of 0.9 of the power, which need the most, reach 1e-9.
const MOST: usize = 200;
/// Change of the derivatives over their size below which they no longer change.
const ROUNDING: f64 = 1e-15;
/// The same for derivatives that are accepted, with the change as their error: slow passes stop above rounding.
const ENOUGH: f64 = 1e-10;

impl Flow {
    /// Computes the derivatives of a flow that was solved, at the speeds, given torques and drags of the work. Returns their last
    /// change over their size, which is their error; `None` if they do not converge.
    pub fn derive(
        &self,
        solved: &Work,
        work: &mut Work<Dual>,
        mut losses: impl FnMut(&mut FlowState<'_, Dual>),
    ) -> Option<f64> {
        self.prepare(work);
        work.drives.clone_from(&solved.drives);
        for (own, solved) in work.used.values.iter_mut().zip(&solved.used.values) {
            *own = Dual::constant(*solved);
        }
        work.done = false;
        let mut change_before = f64::INFINITY;
        for pass in 1..=MOST {
            if !self.solve(work, true) || !evaluate_losses(work, &mut losses) {
                return None;
            }
            self.weigh(work);
            let (change, size) = follow(work);
            // Rounding is reached where the derivatives no longer approach their limit.
            if !(change + size).is_finite() {
                return None;
            }
            let least = change <= ROUNDING * size || change >= change_before && change <= ENOUGH * size;
            if least || pass == MOST {
                work.drags.clone_from_slice(work.used.drags());
                return (change <= ENOUGH * size).then(|| change / size.max(f64::MIN_POSITIVE));
            }
            change_before = change;
        }
        None
    }
}

/// Takes over the derivatives of the results of the models. Returns the sums of their changes and of their sizes, as powers.
fn follow(work: &mut Work<Dual>) -> (f64, f64) {
    let (mut change, mut size) = (0.0_f64, 0.0_f64);
    let pairs = work.used.values.iter_mut().zip(&work.answer.values);
    for ((used, answer), weight) in pairs.zip(&work.weights) {
        for direction in 0..DIRECTIONS {
            let (before, now) = (used.slopes[direction], answer.slopes[direction]);
            // Sums keep what is not a number, maxima lose it.
            change += (now - before).abs() * weight.value;
            size += now.abs() * weight.value;
        }
        used.slopes = answer.slopes;
    }
    (change, size)
}
