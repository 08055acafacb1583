//! Steady-state temperatures of a network, with the losses at these temperatures.
//!
//! Fixed-point iteration, accelerated by the last changes (Anderson, J. ACM 12 (1965) 547-560), because losses that decrease with
//! temperature make the plain iteration oscillate. Where this finds nothing, the search begins anew from the surroundings in small steps,
//! as the bodies warm up: where heat grows faster with temperature than it leaves, such as that of bearings whose preload grows as they
//! warm, they pass all temperatures, and there is no steady state. (A steady state below, if there is one, would be reached first.)

use nalgebra::{DMatrix, DVector};

use super::circuit::Leaving;
use super::march::{Moment, Search, Warm};
use super::parts::Network;
use super::stepping::farthest;
use crate::evaluate::{Asked, BatchScratch, Noting, Scratch};
use crate::flow::Start;
use crate::loss::Extent;
use crate::thermal::{Outcome, Unbalanced};
use crate::transmission::Transmission;

/// Convergence tolerance of the temperatures. \[K\]
const SETTLED: f64 = 1e-8;
/// Tolerance of the power flow over the last change of the temperatures: smaller changes need more exact losses. What one iteration from
/// the last losses leaves is usually less. \[1/K\]
const EXACTNESS: f64 = 1e-3;
/// Maximum tolerance of the power flow after the first evaluation.
const ROUGHEST: f64 = 1e-3;
/// Maximum number of accelerated iterations.
const MOST: usize = 200;
/// Further iterations, in which the bodies warm up slowly.
const WARMING: usize = 400;
/// Share of the way to the temperatures that its heat would bring about in each of them.
const SLOWLY: f64 = 0.25;
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
    /// Loss of each inverter that heats a node. \[W\]
    pub inverters: Vec<f64>,
    /// Incoming heat minus outgoing heat. \[W\]
    pub residual: f64,
    /// Number of loss evaluations.
    pub evaluations: usize,
    /// Every iteration, in order.
    pub history: Vec<NetworkStep>,
    /// Why there is no steady state.
    pub undefined: Option<Unbalanced>,
}

/// One iteration of the search for a steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkStep {
    /// Oil temperature of the housing at which the losses were evaluated. \[degC\]
    pub oil: f64,
    /// Largest difference of a node from the temperature that its heat there would bring about. \[K\]
    pub change: f64,
}

impl Transmission {
    /// Steady-state node temperatures of a point; `None` without a network.
    pub fn steady(&self, moment: &Moment<'_>, scratch: &mut Scratch) -> Option<Steady> {
        let evaluate = |asked: &mut [Asked<'_>], start: Start| {
            let each = asked.iter_mut();
            each.map(|asked| self.evaluate_one(moment.case, asked, start, Noting::Muted, scratch))
                .collect()
        };
        let found = self.search_steady(std::slice::from_ref(moment), evaluate)?;
        self.count_links(&found, &mut scratch.totals);
        found.into_iter().map(|seeking| seeking.steady).next()
    }

    /// Steady-state node temperatures of several points of one case side by side: with the numbers of each as a single one.
    pub fn steady_states(&self, moments: &[Moment<'_>], scratch: &mut BatchScratch) -> Option<Vec<Steady>> {
        let evaluate = |asked: &mut [Asked<'_>], start: Start| {
            self.evaluate_each(moments[0].case, asked, start, Noting::Muted, scratch)
        };
        let found = self.search_steady(moments, evaluate)?;
        self.count_links(&found, &mut scratch.alone().totals);
        Some(found.into_iter().map(|seeking| seeking.steady).collect())
    }

    /// Iterates the temperatures of points until each has its steady state. The losses of all that have none yet are evaluated together.
    fn search_steady<'m>(
        &self,
        moments: &'m [Moment<'m>],
        mut evaluate: impl FnMut(&mut [Asked<'_>], Start) -> Vec<Result<(), Unbalanced>>,
    ) -> Option<Vec<Seeking<'m>>> {
        let network = self.network()?;
        let mut all: Vec<Seeking<'_>> = moments.iter().map(|moment| Seeking::new(network, moment)).collect();
        let mut start = Search::FIRST.start;
        loop {
            let mut open: Vec<&mut Seeking<'_>> = all.iter_mut().filter(|seeking| seeking.open).collect();
            if open.is_empty() {
                return Some(all);
            }
            let mut asked: Vec<Asked<'_>> = open.iter_mut().map(|seeking| seeking.ask()).collect();
            let found = evaluate(&mut asked, start);
            for (seeking, found) in open.into_iter().zip(found) {
                seeking.follow(self, network, found);
            }
            start = Search::NEXT.start;
        }
    }

    /// Counts what the links note at the steady states. The caller evaluates the losses there, which counts those of the models.
    fn count_links(&self, found: &[Seeking<'_>], totals: &mut [Extent]) {
        for seeking in found {
            if !seeking.steady.heat.is_empty() {
                seeking.warm.point.count(self, totals);
            }
        }
    }
}

/// The search for the steady state of one point.
struct Seeking<'m> {
    moment: &'m Moment<'m>,
    search: Search,
    warm: Warm,
    memory: Memory,
    /// Number of successive iterations outside the range.
    hot: usize,
    open: bool,
    /// With the present guess as temperatures.
    steady: Steady,
}

impl<'m> Seeking<'m> {
    fn new(network: &Network, moment: &'m Moment<'m>) -> Self {
        let mut guess = network.start(None, moment.around);
        for (node, t) in guess.iter_mut().enumerate() {
            if !network.is_held(node) {
                *t += WARMER;
            }
        }
        Self {
            moment,
            search: Search::FIRST,
            warm: Warm::default(),
            memory: Memory::default(),
            hot: 0,
            open: true,
            steady: Steady {
                outcome: Outcome::NoConvergence,
                temperatures: guess,
                leaving: Leaving::default(),
                heat: Vec::new(),
                motors: Vec::new(),
                inverters: Vec::new(),
                residual: 0.0,
                evaluations: 0,
                history: Vec::new(),
                undefined: None,
            },
        }
    }

    /// The evaluation at the present guess.
    fn ask(&mut self) -> Asked<'_> {
        self.steady.evaluations += 1;
        Asked {
            point: self.moment.point.with_tolerance_at_least(self.search.least),
            temperatures: &self.steady.temperatures,
            snapshot: &mut self.warm.point,
        }
    }

    /// Follows an evaluation with the next guess, or ends the search.
    fn follow(&mut self, transmission: &Transmission, network: &Network, found: Result<(), Unbalanced>) {
        let (steady, warm) = (&mut self.steady, &mut self.warm);
        let warmed = found.and_then(|()| transmission.warm(network, self.moment.around, &steady.temperatures, warm));
        let after = warmed.and_then(|()| warm.circuit.solve(&warm.heat, None).ok_or(Unbalanced::Network));
        let after = match after {
            Ok(after) => after,
            Err(reason) => {
                steady.outcome = Outcome::Undefined;
                steady.undefined = Some(reason);
                self.open = false;
                return;
            }
        };
        let guess = &steady.temperatures;
        let change = farthest(&after, guess);
        steady.history.push(NetworkStep {
            oil: guess[network.oil()],
            change,
        });
        let settled = change <= SETTLED && self.search.least <= self.moment.point.tolerance.power;
        // Evaluated at the maximum temperature, a node would be warmer still: there is no steady state in the range.
        let beyond = |(guess, after): (&f64, &f64)| *guess >= ASKED[1] && *after > ASKED[1];
        let oil = network.oil();
        let is_warming = steady.evaluations > MOST;
        let maximum = transmission.housing().maximum;
        let passes = is_warming && guess[oil] >= maximum && after[oil] > guess[oil];
        self.hot = if guess.iter().zip(&after).any(beyond) {
            self.hot + 1
        } else {
            0
        };
        if settled || passes || self.hot == TOO_HOT {
            steady.outcome = if settled && after[oil] <= maximum {
                Outcome::Converged
            } else {
                Outcome::NoneBelowMaximum
            };
            if settled {
                steady.leaving = warm.circuit.leaving(&after, &warm.heat);
                steady.residual = warm.heat.iter().sum::<f64>() - steady.leaving.total();
                steady.heat.clone_from(&warm.heat);
                steady.motors.clone_from(&warm.motors);
                steady.inverters.clone_from(&warm.inverters);
            }
            if !passes {
                steady.temperatures = after;
            }
            self.open = false;
            return;
        }
        self.search = Search {
            least: (EXACTNESS * change).min(ROUGHEST),
            ..Search::NEXT
        };
        if steady.evaluations == MOST {
            steady.temperatures = network.start(None, self.moment.around);
        } else if is_warming {
            for (t, after) in steady.temperatures.iter_mut().zip(&after) {
                *t += SLOWLY * (after - *t);
            }
        } else {
            steady.temperatures = self.memory.next(guess, &after);
        }
        for t in &mut steady.temperatures {
            *t = t.clamp(ASKED[0], ASKED[1]);
        }
        self.open = steady.evaluations < MOST + WARMING;
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
