//! Time stepping.
//!
//! Each step uses backward Euler, which is stable for any length. Losses, conductances and flows are those at its end, found by
//! fixed-point iteration. Alternatively, as in some publications, they are those at its start, with the outlet of a heat exchanger
//! prescribed from its previous inlet. Both conserve energy to rounding, because the energies use the heat of the solved equations.
//!
//! The error decreases with the step length. Adaptive stepping computes each step once as a whole and once in two halves; the
//! difference, which the tolerance bounds, is the error of the halves and is subtracted (Richardson). The result remains stable for
//! any length and conserves energy, because all sums are linear in both.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::circuit::Leaving;
use super::march::{Heats, Search, Warm};
use crate::thermal::Unbalanced;

/// Tolerance between the temperatures at the end of a step and those of its losses. \[K\]
const AGREED: f64 = 0.01;
/// Number of iterations above which a step is too long.
const MOST_PASSES: usize = 30;
/// Number of iterations above which only half of each change is applied.
const CAREFUL: usize = 8;
/// Ratio of the shortest to the longest step; not below the precision of time.
const SHORTEST: f64 = 1.0 / 4096.0;
/// A step that is short for every node of a transmission. \[s\]
const SHORT: f64 = 1e-3;

/// Time within a step at which losses, conductances and flows are evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Its end.
    #[default]
    Implicit,
    /// Its start.
    Lagged,
}

/// Length of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// Fixed maximum, also bounded by the intervals of the cycle. \[s\]
    Fixed(f64),
    /// Adaptive: one step and two half steps agree within this. \[K\]
    Adaptive(f64),
}

/// Heat and conductances of a network at any temperatures.
pub(super) trait Heated {
    /// Losses, heat and conductances at node temperatures.
    fn warm(&mut self, temperatures: &[f64], search: Search, warm: &mut Warm) -> Result<(), Unbalanced>;
    /// Called for every step: its length if it is accepted. \[s\]
    fn stepped(&mut self, taken: Option<f64>);
}

/// Stepping method, and its state between steps.
pub(super) struct Stepping {
    scheme: Scheme,
    step: StepSize,
    /// Initial length of the next adaptive step. \[s\]
    next: f64,
    warm: Warm,
}

impl Stepping {
    pub fn new(scheme: Scheme, step: StepSize) -> Self {
        Self {
            scheme,
            step,
            next: f64::INFINITY,
            warm: Warm::default(),
        }
    }

    /// Simulates an interval (s).
    pub fn advance(&mut self, heated: &mut dyn Heated, now: &mut Vec<f64>, duration: f64) -> Result<Heats, Unbalanced> {
        let mut heats = Heats::default();
        let mut left = duration;
        let (most, mut length) = match self.step {
            StepSize::Fixed(step) => {
                let even = duration / (duration / step).ceil().max(1.0);
                (even, even)
            }
            StepSize::Adaptive(_) => (duration, self.next.min(duration)),
        };
        let least = (most * SHORTEST).min(SHORT);
        while left > 1e-9 * duration {
            let cut = left < length;
            length = length.min(left);
            match self.tried(heated, now, length) {
                Ok((after, more, error)) => {
                    let (taken, factor) = match self.step {
                        // Back to full length after steps that were too long.
                        StepSize::Fixed(_) => (true, 2.0),
                        StepSize::Adaptive(tolerance) => {
                            // The error of a step is proportional to the square of its length.
                            let factor = (0.8 * (tolerance / error.max(1e-12)).sqrt()).clamp(0.2, 4.0);
                            (error <= tolerance || length <= least, factor)
                        }
                    };
                    heated.stepped(taken.then_some(length));
                    if taken {
                        heats.add(&more);
                        left -= length;
                        *now = after;
                        // The remainder of an interval gives no information on the steps of the next one.
                        self.next = if cut {
                            self.next.max(length * factor)
                        } else {
                            length * factor
                        };
                    }
                    length = (length * factor).clamp(least, most);
                }
                Err(Unbalanced::Flow | Unbalanced::Network) if length > least => {
                    heated.stepped(None);
                    length *= 0.5;
                }
                Err(other) => return Err(other),
            }
        }
        Ok(heats)
    }

    /// One step, or for adaptive stepping two half steps with the error subtracted: temperatures, energies, and that error in K.
    fn tried(
        &mut self,
        heated: &mut dyn Heated,
        before: &[f64],
        length: f64,
    ) -> Result<(Vec<f64>, Heats, f64), Unbalanced> {
        let (whole, of_whole) = self.single(heated, before, length)?;
        let StepSize::Adaptive(_) = self.step else {
            return Ok((whole, of_whole, 0.0));
        };
        let (middle, mut heats) = self.single(heated, before, 0.5 * length)?;
        let (mut after, second) = self.single(heated, &middle, 0.5 * length)?;
        heats.add(&second);
        let error = farthest(&whole, &after);
        heats.combine(2.0, &of_whole, -1.0);
        for (after, whole) in after.iter_mut().zip(&whole) {
            *after = 2.0 * *after - whole;
        }
        Ok((after, heats, error))
    }

    /// One step.
    fn single(
        &mut self,
        heated: &mut dyn Heated,
        before: &[f64],
        length: f64,
    ) -> Result<(Vec<f64>, Heats), Unbalanced> {
        let (after, leaving) = match self.scheme {
            Scheme::Lagged => self.lagged(heated, before, length)?,
            Scheme::Implicit => self.implicit(heated, before, length)?,
        };
        let warm = &self.warm;
        let each = |list: &[f64]| list.iter().map(|x| x * length).collect();
        let heats = Heats {
            duration: length,
            parts: each(&warm.parts),
            motors: warm.motors.iter().map(|m| m.map(|x| x * length)).collect(),
            sources: warm.sources * length,
            stored: warm.circuit.stored(before, &after),
            held: each(&leaving.held),
            exchangers: each(&leaving.exchangers),
            flows: leaving.flows * length,
            input: warm.power[0] * length,
            output: warm.power[1] * length,
            beyond_map: warm.beyond_map,
        };
        Ok((after, heats))
    }

    fn lagged(
        &mut self,
        heated: &mut dyn Heated,
        before: &[f64],
        length: f64,
    ) -> Result<(Vec<f64>, Leaving), Unbalanced> {
        heated.warm(before, Search::ONLY, &mut self.warm)?;
        let circuit = &mut self.warm.circuit;
        let exchangers = std::mem::take(&mut circuit.exchangers);
        for e in &exchangers {
            circuit.held[e.to] = Some(e.outlet(before[e.from]));
        }
        let after = circuit
            .solve(&self.warm.heat, Some((length, before)))
            .ok_or(Unbalanced::Network)?;
        let mut leaving = circuit.leaving(&after, &self.warm.heat);
        for e in &exchangers {
            // The heat that the oil has lost in the exchanger is among the gains of the other flows. The coolant takes the heat
            // that links transfer to the outlet, whose temperature is prescribed over the step.
            let lost = e.oil * (after[e.from] - after[e.to]);
            leaving.flows -= lost;
            leaving.exchangers.push(lost + std::mem::take(&mut leaving.held[e.to]));
        }
        Ok((after, leaving))
    }

    fn implicit(
        &mut self,
        heated: &mut dyn Heated,
        before: &[f64],
        length: f64,
    ) -> Result<(Vec<f64>, Leaving), Unbalanced> {
        let mut guess = before.to_vec();
        for pass in 1..=MOST_PASSES {
            let search = if pass == 1 { Search::FIRST } else { Search::NEXT };
            heated.warm(&guess, search, &mut self.warm)?;
            let after = self
                .warm
                .circuit
                .solve(&self.warm.heat, Some((length, before)))
                .ok_or(Unbalanced::Network)?;
            if pass > 1 && farthest(&after, &guess) <= AGREED {
                let leaving = self.warm.circuit.leaving(&after, &self.warm.heat);
                return Ok((after, leaving));
            }
            let share = if pass < CAREFUL { 1.0 } else { 0.5 };
            for (guess, after) in guess.iter_mut().zip(&after) {
                *guess += share * (after - *guess);
            }
        }
        Err(Unbalanced::Network)
    }
}

/// Maximum difference of two lists of temperatures. \[K\]
pub(super) fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

#[cfg(test)]
mod tests;
