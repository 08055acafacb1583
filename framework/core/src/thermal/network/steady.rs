//! Steady-state temperatures of a network, with the losses at these temperatures.
//!
//! Fixed-point iteration, accelerated by the last changes (Anderson, J. ACM 12 (1965) 547-560), because losses that decrease with
//! temperature make the plain iteration oscillate.

use nalgebra::{DMatrix, DVector};

use super::circuit::Leaving;
use super::march::{Moment, Search, Warm};
use super::stepping::farthest;
use crate::evaluate::Scratch;
use crate::thermal::{Outcome, Unbalanced};
use crate::transmission::Transmission;

/// Convergence tolerance of the temperatures. \[K\]
const SETTLED: f64 = 1e-8;
/// Tolerance of the power flow over the last change of the temperatures: smaller changes need more exact losses. \[1/K\]
const EXACTNESS: f64 = 1e-7;
/// Maximum number of iterations.
const MOST: usize = 200;
/// Number of stored changes.
const REMEMBERED: usize = 4;
/// Number of iterations outside the range after which the search ends.
const TOO_HOT: usize = 5;
/// Temperature range of loss evaluations. \[degC\]
const ASKED: [f64; 2] = [-60.0, 250.0];
/// Initial guess above the ambient temperature. \[K\]
const WARMER: f64 = 30.0;

/// A network in steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct Steady {
    /// Outcome of the search.
    pub outcome: Outcome,
    /// Node temperatures; the last iterate if they do not converge. \[degC\]
    pub temperatures: Vec<f64>,
    /// Outgoing heat. \[W\]
    pub leaving: Leaving,
    /// Heat into each node. \[W\]
    pub heat: Vec<f64>,
    /// Loss of each motor in rotor and stator. \[W\]
    pub motors: Vec<[f64; 2]>,
    /// Incoming heat minus outgoing heat. \[W\]
    pub residual: f64,
    /// Number of loss evaluations.
    pub evaluations: usize,
    /// Why there is no steady state.
    pub undefined: Option<Unbalanced>,
}

impl Transmission {
    /// Steady-state node temperatures of a point; `None` without a network.
    pub fn steady(&self, moment: &Moment<'_>, scratch: &mut Scratch) -> Option<Steady> {
        let network = self.network()?;
        let mut guess = network.start(None, moment.around);
        for (node, t) in guess.iter_mut().enumerate() {
            if !network.is_held(node) {
                *t += WARMER;
            }
        }
        let mut warm = Warm::default();
        let mut steady = Steady {
            outcome: Outcome::NoConvergence,
            temperatures: guess.clone(),
            leaving: Leaving::default(),
            heat: Vec::new(),
            motors: Vec::new(),
            residual: 0.0,
            evaluations: 0,
            undefined: None,
        };
        let mut memory = Memory::default();
        let mut hot = 0;
        let mut search = Search::FIRST;
        while steady.evaluations < MOST {
            steady.evaluations += 1;
            let warmed = self.warm(network, moment, &guess, search, scratch, &mut warm);
            let after = warmed.and_then(|()| warm.circuit.solve(&warm.heat, None).ok_or(Unbalanced::Network));
            let after = match after {
                Ok(after) => after,
                Err(reason) => {
                    steady.outcome = Outcome::Undefined;
                    steady.undefined = Some(reason);
                    steady.temperatures = guess;
                    return Some(steady);
                }
            };
            let change = farthest(&after, &guess);
            if change <= SETTLED && search.least <= moment.point.tolerance.power {
                steady.outcome = if after[network.oil()] > self.housing().maximum {
                    Outcome::NoneBelowMaximum
                } else {
                    Outcome::Converged
                };
                steady.leaving = warm.circuit.leaving(&after, &warm.heat);
                steady.residual = warm.heat.iter().sum::<f64>() - steady.leaving.total();
                steady.heat = warm.heat;
                steady.motors = warm.motors;
                steady.temperatures = after;
                // The caller evaluates the losses here, so only what the links note is counted. They had values at these temperatures.
                let speeds = scratch.speeds().to_vec();
                let circuit = &mut warm.circuit;
                let _ = scratch.note_heat(|cells| network.circuit(&guess, (&speeds, cells), moment.around, circuit));
                return Some(steady);
            }
            // Evaluated at the maximum temperature, a node would be warmer still: there is no steady state in the range.
            let beyond = |(guess, after): (&f64, &f64)| *guess >= ASKED[1] && *after > ASKED[1];
            hot = if guess.iter().zip(&after).any(beyond) {
                hot + 1
            } else {
                0
            };
            if hot == TOO_HOT {
                steady.outcome = Outcome::NoneBelowMaximum;
                steady.temperatures = after;
                return Some(steady);
            }
            search = Search {
                least: (EXACTNESS * change).min(Search::FIRST.least),
                ..Search::NEXT
            };
            guess = memory.next(&guess, &after);
            for t in &mut guess {
                *t = t.clamp(ASKED[0], ASKED[1]);
            }
        }
        steady.temperatures = guess;
        Some(steady)
    }
}

/// The last steps of a fixed-point iteration.
#[derive(Default)]
struct Memory {
    /// Guess and its result.
    steps: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Memory {
    /// The next guess: the combination of the last results whose combined changes are minimal.
    fn next(&mut self, guess: &[f64], after: &[f64]) -> Vec<f64> {
        if self.steps.len() > REMEMBERED {
            self.steps.remove(0);
        }
        self.steps.push((guess.to_vec(), after.to_vec()));
        let columns = self.steps.len() - 1;
        let change = |(guess, after): &(Vec<f64>, Vec<f64>), i: usize| after[i] - guess[i];
        let (last, rows) = (&self.steps[columns], guess.len());
        if columns == 0 {
            return after.to_vec();
        }
        let differences = DMatrix::from_fn(rows, columns, |i, j| {
            change(&self.steps[j + 1], i) - change(&self.steps[j], i)
        });
        let changes = DVector::from_fn(rows, |i, _| change(last, i));
        let Ok(mix) = differences.svd(true, true).solve(&changes, 1e-9) else {
            return after.to_vec();
        };
        (0..rows)
            .map(|i| {
                let back: f64 = (0..columns)
                    .map(|j| mix[j] * (self.steps[j + 1].1[i] - self.steps[j].1[i]))
                    .sum();
                after[i] - back
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_swings_settles() {
        // Plain iteration would diverge: each result decreases by 1.4 times the increase of the guess.
        let law = |x: &[f64]| vec![100.0 - 1.4 * x[0] + 0.2 * x[1], 50.0 + 0.3 * x[0] - 0.01 * x[1] * x[1]];
        let mut memory = Memory::default();
        let mut guess = vec![20.0, 20.0];
        let mut passes = 0;
        loop {
            let after = law(&guess);
            if farthest(&after, &guess) < 1e-9 {
                break;
            }
            passes += 1;
            assert!(passes < 40, "{guess:?}");
            guess = memory.next(&guess, &after);
        }
        assert!(passes < 20, "{passes}");
    }
}
