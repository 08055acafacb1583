//! Derivatives of a converged flow: its blocks, solved once more over numbers with derivatives.
//!
//! In a loop, losses u = g(u, p) follow from themselves and the given quantities p. Their derivatives therefore follow from
//! u' = g_u u' + g_p. Each evaluation of the laws, with the steps of the loop, decreases the error of u' by the error of the secants, so
//! that a few reach rounding. Values and driving gears stay those of the point.

use super::Flow;
use super::equilibrium::bound;
use super::order::Block;
use super::work::{FlowState, Start, Work};
use crate::real::{DIRECTIONS, Dual, Real as _};

/// Maximum number of evaluations of the laws of a loop.
const MOST: usize = 200;
/// Change of the derivatives over their size below which they no longer change.
const ROUNDING: f64 = 1e-15;
/// The same for derivatives that are accepted, with the change as their error: slow loops stop above rounding.
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
        self.prepare(work, true);
        work.drives.clone_from(&solved.drives);
        work.mesh_loss.fill(Dual::ZERO);
        work.done = false;
        let order = self.adopt_order(work)?;
        let mut error = 0.0_f64;
        for block in &order.blocks {
            if block.is_loop() {
                error = error.max(self.derive_loop(block, solved, work, &mut losses)?);
            } else if block.laws.is_empty() {
                self.balance(block, work);
            } else {
                work.evaluate(self, &block.laws, &mut losses);
                if !self.take_answers(&block.laws, work) {
                    return None;
                }
            }
        }
        self.sum_up(work);
        Some(error)
    }

    /// The same of a loop, whose laws are evaluated where they were accepted.
    fn derive_loop(
        &self,
        block: &Block,
        solved: &Work,
        work: &mut Work<Dual>,
        losses: &mut impl FnMut(&mut FlowState<'_, Dual>),
    ) -> Option<f64> {
        self.begin(block, Start::Lossless, work);
        self.hold(block, solved, work);
        for feedback in &block.feedback {
            work.slopes[feedback.law] = Dual::constant(solved.slopes[feedback.law]);
            work.answers_before[feedback.law] = Dual::ZERO;
        }
        let mut change_before = f64::INFINITY;
        for pass in 1..=MOST {
            work.evaluate(self, &block.laws, losses);
            if !self.take_answers(&block.laws, work) {
                return None;
            }
            let (change, size) = changes(block, work);
            if !(change + size).is_finite() {
                return None;
            }
            // Rounding is reached where the derivatives no longer approach their limit.
            let least = change <= ROUNDING * size || change >= change_before && change <= ENOUGH * size;
            if least || pass == MOST {
                self.accept(block, work);
                return (change <= ENOUGH * size).then(|| change / size.max(f64::MIN_POSITIVE));
            }
            change_before = change;
            bound(block, work);
            let never = (Dual::constant(1.0), Dual::constant(-1.0));
            if !self.approach(block, (false, 1.0), never, work).0 {
                return None;
            }
            self.hold(block, solved, work);
        }
        None
    }

    /// Holds the values of a loop where its laws were accepted.
    fn hold(&self, block: &Block, solved: &Work, work: &mut Work<Dual>) {
        for &unknown in &block.unknowns {
            work.unknown[unknown].value = solved.unknown[unknown];
        }
        self.write(block, work);
    }
}

/// Sums of the changes of the derivatives of the laws of a loop since the evaluation before, and of their sizes, as powers.
fn changes(block: &Block, work: &Work<Dual>) -> (f64, f64) {
    let (mut change, mut size) = (0.0_f64, 0.0_f64);
    for law in block.feedback.iter().map(|feedback| feedback.law) {
        for direction in 0..DIRECTIONS {
            let before = work.answers_before[law].slopes[direction];
            let now = work.answers[law].slopes[direction];
            // Sums keep what is not a number, maxima lose it.
            change += (now - before).abs() * work.weights[law].value;
            size += now.abs() * work.weights[law].value;
        }
    }
    (change, size)
}
