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
use super::march::{Heats, Passed, Search, Warm};
use crate::machine::MachineEnergy;
use crate::thermal::Unbalanced;

/// Tolerance between the temperatures at the end of a step and those of its losses. \[K\]
const AGREED: f64 = 0.01;
/// The same for consecutive steps that are solved together, because the error of each is part of the start of the next. \[K\]
const AGREED_TOGETHER: f64 = 1e-3;
/// Number of iterations above which a step is too long.
const MOST_PASSES: usize = 30;
/// Number of iterations above which fewer steps are solved together.
const MOST_PASSES_TOGETHER: usize = 5;
/// The least numbers of iterations, of a single step and of several: more steps are solved together next.
const QUICK_PASSES: [usize; 2] = [2, 3];
/// Minimum number of steps that are solved together: fewer do not fill the lanes.
const LEAST_TOGETHER: usize = 8;
/// Maximum number of steps that are solved together.
const MOST_TOGETHER: usize = 32;
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

/// A step that is being solved.
#[derive(Debug, Clone, Default)]
pub(super) struct Trial {
    /// Number of its interval.
    pub stage: usize,
    /// Node temperatures at which losses, heat and conductances are evaluated. \[degC\]
    pub guess: Vec<f64>,
    /// Losses, heat and conductances there.
    pub warm: Warm,
    length: f64,
    /// Node temperatures at its end. \[degC\]
    after: Vec<f64>,
    leaving: Leaving,
}

/// Heat and conductances of a network at any temperatures.
pub(super) trait Heated {
    /// Losses, heat and conductances of steps at their guesses.
    fn warm(&mut self, trials: &mut [Trial], search: Search) -> Result<(), Unbalanced>;
    /// Called for every step: its length (s) and losses if it is accepted.
    fn stepped(&mut self, taken: Option<(f64, &Warm)>);
}

/// Stepping method, and its state between steps.
pub(super) struct Stepping {
    scheme: Scheme,
    step: StepSize,
    /// Initial length of the next adaptive step. \[s\]
    next: f64,
    /// Maximum number of steps that are solved together next.
    together: usize,
    /// Number of intervals that are solved one by one before that, and how many they are after the next vain attempt.
    wait: usize,
    patience: usize,
    /// Iterations of the last step, or of the last steps that were solved together.
    passes: usize,
    /// The steps that were solved last.
    trials: Vec<Trial>,
}

impl Stepping {
    pub fn new(scheme: Scheme, step: StepSize) -> Self {
        Self {
            scheme,
            step,
            next: f64::INFINITY,
            together: 1,
            wait: 0,
            patience: LEAST_TOGETHER,
            passes: 0,
            trials: vec![Trial::default()],
        }
    }

    /// Number of the next intervals, at least one, whose steps are solved together.
    pub fn reach(&self, durations: impl Iterator<Item = f64>) -> usize {
        let (StepSize::Fixed(step), Scheme::Implicit) = (self.step, self.scheme) else {
            return 1;
        };
        let (mut count, mut steps) = (0, 0);
        for duration in durations {
            let more = even_steps(duration, step);
            if more > self.together - steps {
                break;
            }
            (count, steps) = (count + 1, steps + more);
        }
        if steps < LEAST_TOGETHER { 1 } else { count }
    }

    /// Simulates the first of some intervals (s), and those of the others whose steps are solved together with its own.
    pub fn advance_together(
        &mut self,
        heated: &mut dyn Heated,
        now: &mut Vec<f64>,
        durations: &[f64],
    ) -> Result<Vec<Passed>, Unbalanced> {
        let mut count = self.reach(durations.iter().copied());
        while count > 1 {
            if let Ok(passed) = self.window(heated, now, &durations[..count]) {
                if self.passes <= QUICK_PASSES[1] {
                    self.together = (2 * self.together).min(MOST_TOGETHER);
                    self.patience = LEAST_TOGETHER;
                }
                return Ok(passed);
            }
            self.together = (self.trials.len() / 2).max(1);
            if self.together < LEAST_TOGETHER {
                self.patience *= 2;
                self.wait = self.patience;
            }
            count = self.reach(durations.iter().copied());
        }
        let heats = self.advance(heated, now, durations[0])?;
        let quick = self.passes <= QUICK_PASSES[0] && self.wait == 0;
        self.together = if quick { MOST_TOGETHER / 2 } else { 1 };
        self.wait = self.wait.saturating_sub(1);
        Ok(vec![self.trials[0].passed(heats, now)])
    }

    /// Simulates intervals whose steps are solved together.
    fn window(
        &mut self,
        heated: &mut dyn Heated,
        now: &mut Vec<f64>,
        durations: &[f64],
    ) -> Result<Vec<Passed>, Unbalanced> {
        let StepSize::Fixed(step) = self.step else {
            return Err(Unbalanced::Network);
        };
        let mut count = 0;
        for (stage, duration) in durations.iter().enumerate() {
            let steps = even_steps(*duration, step);
            self.trials.resize_with(count + steps, Trial::default);
            for trial in &mut self.trials[count..count + steps] {
                (trial.stage, trial.length) = (stage, duration / steps as f64);
            }
            count += steps;
        }
        let trials = &mut self.trials;
        self.passes = implicit(heated, now, trials)?;
        let mut passed: Vec<Passed> = Vec::with_capacity(durations.len());
        for stage in trials.chunk_by(|a, b| a.stage == b.stage) {
            let mut heats = Heats::default();
            for trial in stage {
                heated.stepped(Some((trial.length, &trial.warm)));
                heats.add(&trial.heats(now));
                now.clone_from(&trial.after);
            }
            passed.extend(stage.last().map(|last| last.passed(heats, now)));
        }
        Ok(passed)
    }

    /// Simulates an interval (s), step by step.
    pub fn advance(&mut self, heated: &mut dyn Heated, now: &mut Vec<f64>, duration: f64) -> Result<Heats, Unbalanced> {
        let mut heats = Heats::default();
        let mut left = duration;
        let (most, mut length) = match self.step {
            StepSize::Fixed(step) => {
                let even = duration / even_steps(duration, step) as f64;
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
                    heated.stepped(taken.then_some((length, &self.trials[0].warm)));
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
        let trials = &mut self.trials[..1];
        (trials[0].stage, trials[0].length) = (0, length);
        match self.scheme {
            Scheme::Lagged => lagged(heated, before, trials)?,
            Scheme::Implicit => self.passes = implicit(heated, before, trials)?,
        }
        Ok((trials[0].after.clone(), trials[0].heats(before)))
    }
}

impl Trial {
    /// Its energies.
    fn heats(&self, before: &[f64]) -> Heats {
        let (warm, leaving, length) = (&self.warm, &self.leaving, self.length);
        let each = |list: &[f64]| list.iter().map(|x| x * length).collect();
        let [input, output] = warm.point.power;
        Heats {
            duration: length,
            parts: each(&warm.point.watts),
            motors: warm.motors.iter().map(|m| m.map(|x| x * length)).collect(),
            inverters: each(&warm.inverters),
            sources: warm.sources * length,
            stored: warm.circuit.stored(before, &self.after),
            held: each(&leaving.held),
            exchangers: each(&leaving.exchangers),
            flows: leaving.flows * length,
            input: input * length,
            output: output * length,
            beyond_map: warm.beyond_map,
            machines: (warm.machines.iter())
                .map(|state| MachineEnergy::lasting(state, length))
                .collect(),
        }
    }

    /// The interval that ends with this step.
    fn passed(&self, heats: Heats, now: &[f64]) -> Passed {
        let point = &self.warm.point;
        Passed {
            heats,
            temperatures: now.to_vec(),
            speeds: point.speeds.clone(),
            port_torques: point.port_torques.clone(),
            status: point.status,
        }
    }

    /// Solves the network at the end of the step. Returns the difference to the guess. \[K\]
    fn solve(&mut self, before: &[f64]) -> Result<f64, Unbalanced> {
        let step = Some((self.length, before));
        let after = self.warm.circuit.solve(&self.warm.heat, step);
        self.after = after.ok_or(Unbalanced::Network)?;
        Ok(farthest(&self.after, &self.guess))
    }
}

/// Number of equal steps of an interval that are not longer than `step`.
fn even_steps(duration: f64, step: f64) -> usize {
    (duration / step).ceil().max(1.0) as usize
}

fn lagged(heated: &mut dyn Heated, before: &[f64], trials: &mut [Trial]) -> Result<(), Unbalanced> {
    trials[0].guess.clear();
    trials[0].guess.extend_from_slice(before);
    heated.warm(trials, Search::ONLY)?;
    let trial = &mut trials[0];
    let circuit = &mut trial.warm.circuit;
    let exchangers = std::mem::take(&mut circuit.exchangers);
    for e in &exchangers {
        circuit.held[e.to] = Some(e.outlet(before[e.from]));
    }
    trial.solve(before)?;
    let after = &trial.after;
    let mut leaving = trial.warm.circuit.leaving(after, &trial.warm.heat);
    for e in &exchangers {
        // The heat that the oil has lost in the exchanger is among the gains of the other flows. The coolant takes the heat
        // that links transfer to the outlet, whose temperature is prescribed over the step.
        let lost = e.oil * (after[e.from] - after[e.to]);
        leaving.flows -= lost;
        leaving.exchangers.push(lost + std::mem::take(&mut leaving.held[e.to]));
    }
    trial.leaving = leaving;
    Ok(())
}

/// Solves consecutive steps together: the losses of all are evaluated at guesses, then the network is solved step by step with them,
/// until guesses and results agree (waveform relaxation). A single step is the plain fixed-point iteration. Returns the number of
/// iterations.
fn implicit(heated: &mut dyn Heated, before: &[f64], trials: &mut [Trial]) -> Result<usize, Unbalanced> {
    let (agreed, most, second) = if trials.len() == 1 {
        (AGREED, MOST_PASSES, Search::NEXT)
    } else {
        (AGREED_TOGETHER, MOST_PASSES_TOGETHER, Search::SECOND)
    };
    for trial in &mut *trials {
        trial.guess.clear();
        trial.guess.extend_from_slice(before);
    }
    let mut change_before = f64::INFINITY;
    for pass in 1..=most {
        let search = match pass {
            1 => Search::FIRST,
            2 => second,
            _ => Search::NEXT,
        };
        heated.warm(trials, search)?;
        let mut start = before;
        let mut change: f64 = 0.0;
        for trial in &mut *trials {
            change = change.max(trial.solve(start)?);
            start = &trial.after;
        }
        if search == Search::NEXT && change <= agreed {
            for trial in trials {
                trial.leaving = trial.warm.circuit.leaving(&trial.after, &trial.warm.heat);
            }
            return Ok(pass);
        }
        if trials.len() > 1 && change > agreed.max(0.5 * change_before) {
            // Too many of them.
            return Err(Unbalanced::Network);
        }
        change_before = change;
        let share = if pass < CAREFUL { 1.0 } else { 0.5 };
        for trial in &mut *trials {
            for (guess, after) in trial.guess.iter_mut().zip(&trial.after) {
                *guess += share * (after - *guess);
            }
        }
    }
    Err(Unbalanced::Network)
}

/// Maximum difference of two lists of temperatures. \[K\]
pub(super) fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

#[cfg(test)]
mod tests;
