//! Temperatures at which a network rests: losses at the temperatures that they lead to.
//!
//! Repeated substitution, accelerated by the last changes (Anderson, J. ACM 12 (1965) 547-560), because losses that fall with
//! temperature make plain substitution swing.

use nalgebra::{DMatrix, DVector};

use super::circuit::Leaving;
use super::march::{Moment, Warm};
use super::stepping::farthest;
use crate::evaluate::Scratch;
use crate::thermal::{Outcome, Unbalanced};
use crate::transmission::Transmission;

/// Temperature within which nothing changes any more. \[K\]
const SETTLED: f64 = 1e-8;
/// Passes after which there is no rest.
const MOST: usize = 200;
/// How many changes are remembered.
const REMEMBERED: usize = 4;
/// Passes beyond the range after which nothing is expected to come back.
const TOO_HOT: usize = 5;
/// Range in which losses are asked. \[degC\]
const ASKED: [f64; 2] = [-60.0, 250.0];
/// How much warmer than the surroundings the search begins. \[K\]
const WARMER: f64 = 30.0;

/// A network at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Steady {
    /// What became of the search.
    pub outcome: Outcome,
    /// Temperatures of the nodes; the last that were tried where they do not rest. \[degC\]
    pub temperatures: Vec<f64>,
    /// Where heat leaves. \[W\]
    pub leaving: Leaving,
    /// Heat into each node. \[W\]
    pub heat: Vec<f64>,
    /// Loss of each motor in rotor and stator. \[W\]
    pub motors: Vec<[f64; 2]>,
    /// Heat that comes, less what leaves. \[W\]
    pub residual: f64,
    /// Evaluations of the losses.
    pub evaluations: usize,
    /// Why there is no value.
    pub undefined: Option<Unbalanced>,
}

impl Transmission {
    /// Temperatures of the nodes at which a point rests; absent without a network.
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
        while steady.evaluations < MOST {
            steady.evaluations += 1;
            let asked = self.warm(network, moment, &guess, scratch, &mut warm);
            let after = asked.and_then(|()| warm.circuit.solve(&warm.heat, None).ok_or(Unbalanced::Network));
            let after = match after {
                Ok(after) => after,
                Err(reason) => {
                    steady.outcome = Outcome::Undefined;
                    steady.undefined = Some(reason);
                    steady.temperatures = guess;
                    return Some(steady);
                }
            };
            if farthest(&after, &guess) <= SETTLED {
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
                // What the models saw there counts once.
                scratch.count_seen();
                return Some(steady);
            }
            // Asked no warmer, a node would be warmer still: there is no rest in the range.
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
            guess = memory.next(&guess, &after);
            for t in &mut guess {
                *t = t.clamp(ASKED[0], ASKED[1]);
            }
        }
        steady.temperatures = guess;
        Some(steady)
    }
}

/// The last steps of a repeated substitution.
#[derive(Default)]
struct Memory {
    /// Guess and what it led to.
    steps: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Memory {
    /// The next guess: the mix of the last answers whose mixed changes are least.
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
        // Plain substitution would run away: each answer falls by 1.4 times what the guess rose.
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
