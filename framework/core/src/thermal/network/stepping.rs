//! Steps in time.
//!
//! Each step goes backwards in time (backward Euler), so that it is stable for any length: losses, conductances and flows are those
//! at its end, found by repeated substitution, or, as some publications have it, those at its beginning with the oil behind a
//! heat exchanger held at what its inlet was. Energy is kept to rounding either way, because the heat that is counted is
//! the heat that was solved with.
//!
//! The error falls with the length of the steps. A march that adapts them takes each step whole and in two halves; the difference, which
//! the tolerance bounds, is the error of the halves, so that it is taken off (Richardson). The sum stays stable for any length, and
//! keeps the energy, because all that is summed is linear in both.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::circuit::Leaving;
use super::march::{Heats, Warm};
use crate::thermal::Unbalanced;

/// Temperature within which the losses of a step belong to its end. \[K\]
const AGREED: f64 = 0.01;
/// Passes after which a step counts as too long.
const MOST_PASSES: usize = 30;
/// Passes from which on only half of each change is taken.
const CAREFUL: usize = 8;
/// The shortest step over the longest; no more than the next is needed.
const SHORTEST: f64 = 1.0 / 4096.0;
/// A step that is short for every node of a transmission. \[s\]
const SHORT: f64 = 1e-3;

/// Where in a step its losses, conductances and flows are those of the temperatures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// At its end.
    #[default]
    Implicit,
    /// At its beginning.
    Lagged,
}

/// How long steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// No longer than this, and no longer than the intervals of the duty. \[s\]
    Fixed(f64),
    /// As long as one step and two of half its length agree within this. \[K\]
    Adaptive(f64),
}

/// What heats the nodes of a network, and what links them, at any temperatures.
pub(super) trait Heated {
    /// Losses, heat and conductances at temperatures of the nodes.
    fn warm(&mut self, temperatures: &[f64], warm: &mut Warm) -> Result<(), Unbalanced>;
    /// Hears of every step whether it was taken, or tried in vain.
    fn stepped(&mut self, taken: bool);
}

/// How a march steps, and what it remembers from step to step.
pub(super) struct Stepping {
    scheme: Scheme,
    step: StepSize,
    /// Length with which the next adaptive step begins. \[s\]
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

    /// Goes on over an interval (s).
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
                            // The error of a step goes with the square of its length.
                            let factor = (0.8 * (tolerance / error.max(1e-12)).sqrt()).clamp(0.2, 4.0);
                            (error <= tolerance || length <= least, factor)
                        }
                    };
                    heated.stepped(taken);
                    if taken {
                        heats.add(&more);
                        left -= length;
                        *now = after;
                        // What is left of an interval says nothing of the next one's steps.
                        self.next = if cut {
                            self.next.max(length * factor)
                        } else {
                            length * factor
                        };
                    }
                    length = (length * factor).clamp(least, most);
                }
                Err(Unbalanced::Flow | Unbalanced::Network) if length > least => {
                    heated.stepped(false);
                    length *= 0.5;
                }
                Err(other) => return Err(other),
            }
        }
        Ok(heats)
    }

    /// One step, or where steps adapt two of half its length without their error: temperatures, energies, and that error in K.
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
        heated.warm(before, &mut self.warm)?;
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
            // What the oil has lost on its way through the exchanger stands among the gains of the other flows. What links bring
            // to its outlet, which is held over the step, the coolant takes.
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
            heated.warm(&guess, &mut self.warm)?;
            let after = self
                .warm
                .circuit
                .solve(&self.warm.heat, Some((length, before)))
                .ok_or(Unbalanced::Network)?;
            if farthest(&after, &guess) <= AGREED {
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

/// The greatest difference of two lists of temperatures. \[K\]
pub(super) fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

#[cfg(test)]
mod tests;
