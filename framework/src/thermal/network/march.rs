//! Temperatures of a network in time.
//!
//! Each step goes backwards in time (backward Euler), so that it is stable for any length: losses, conductances and flows are those
//! at its end, found by repeated substitution, or, as some publications have it, those at its beginning with the oil behind a
//! heat exchanger held at what its inlet was. Energy is kept to rounding either way, because the heat that is counted is
//! the heat that was solved with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::build::{Network, Surroundings};
use super::circuit::{Circuit, Leaving};
use crate::evaluate::{Noting, Point, Scratch};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Temperature within which the losses of a step belong to its end. \[K\]
const AGREED: f64 = 0.01;
/// Passes after which a step counts as too long.
const MOST_PASSES: usize = 30;
/// Passes from which on only half of each change is taken.
const CAREFUL: usize = 8;
/// The shortest step over an interval.
const SHORTEST: f64 = 1.0 / 4096.0;

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

/// Energy of a stretch of time. \[J\]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heats {
    /// Length. \[s\]
    pub duration: f64,
    /// Loss of each part.
    pub parts: Vec<f64>,
    /// Loss of each motor in rotor and stator.
    pub motors: Vec<[f64; 2]>,
    /// Heat from elsewhere.
    pub sources: f64,
    /// Heat stored in the nodes.
    pub stored: f64,
    /// Into each held node.
    pub held: Vec<f64>,
    /// Through each heat exchanger.
    pub exchangers: Vec<f64>,
    /// Carried away by flows.
    pub flows: f64,
    /// Power that ports put in.
    pub input: f64,
    /// Power that comes out.
    pub output: f64,
    /// True where a motor was beyond its map.
    pub beyond_map: bool,
}

impl Heats {
    /// All heat that came into the nodes.
    pub fn came(&self) -> f64 {
        self.parts.iter().sum::<f64>() + self.motors.iter().flatten().sum::<f64>() + self.sources
    }

    /// What is left of the heat that came, less what was stored and what left; zero to rounding.
    pub fn residual(&self) -> f64 {
        let left = self.held.iter().sum::<f64>() + self.exchangers.iter().sum::<f64>() + self.flows;
        self.came() - self.stored - left
    }

    /// Adds another stretch.
    pub fn add(&mut self, more: &Self) {
        let each = |sums: &mut Vec<f64>, more: &[f64]| {
            sums.resize(more.len(), 0.0);
            sums.iter_mut().zip(more).for_each(|(sum, x)| *sum += x);
        };
        self.duration += more.duration;
        each(&mut self.parts, &more.parts);
        each(&mut self.held, &more.held);
        each(&mut self.exchangers, &more.exchangers);
        self.motors.resize(more.motors.len(), [0.0; 2]);
        for (sum, x) in self.motors.iter_mut().zip(&more.motors) {
            sum[0] += x[0];
            sum[1] += x[1];
        }
        self.sources += more.sources;
        self.stored += more.stored;
        self.flows += more.flows;
        self.input += more.input;
        self.output += more.output;
        self.beyond_map |= more.beyond_map;
    }
}

/// What holds over an interval.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Gear state and ports.
    pub case: &'a Case,
    /// Torques and speeds.
    pub point: &'a Point<'a>,
    /// What surrounds the gearbox.
    pub around: &'a Surroundings,
}

/// Losses and heat flows at one set of temperatures.
#[derive(Debug, Clone, Default)]
pub(super) struct Warm {
    pub circuit: Circuit,
    /// Heat into each node. \[W\]
    pub heat: Vec<f64>,
    /// Loss of each part. \[W\]
    pub parts: Vec<f64>,
    /// Loss of each motor in rotor and stator. \[W\]
    pub motors: Vec<[f64; 2]>,
    /// Heat from elsewhere. \[W\]
    pub sources: f64,
    /// Power in and out. \[W\]
    pub power: [f64; 2],
    /// True where a motor is beyond its map.
    pub beyond_map: bool,
}

/// Temperatures that go on in time.
pub struct March<'a> {
    transmission: &'a Transmission,
    network: &'a Network,
    scheme: Scheme,
    step: StepSize,
    /// Length with which the next adaptive step begins. \[s\]
    next: f64,
    warm: Warm,
    /// Temperatures of the nodes now. \[degC\]
    pub temperatures: Vec<f64>,
    /// Evaluations of the losses so far.
    pub evaluations: usize,
    /// Steps so far, those among them that were tried in vain.
    pub steps: [usize; 2],
}

impl Transmission {
    /// Losses, heat and conductances at temperatures of the nodes.
    pub(super) fn warm(
        &self,
        network: &Network,
        moment: &Moment<'_>,
        temperatures: &[f64],
        scratch: &mut Scratch,
        warm: &mut Warm,
    ) -> Result<(), Unbalanced> {
        self.try_point(moment.case, moment.point, temperatures, scratch, Noting::Seen)?;
        warm.heat.clear();
        warm.heat.resize(network.names().len(), 0.0);
        network.add_parts(self, scratch, &mut warm.heat);
        warm.parts.clear();
        warm.parts.extend_from_slice(scratch.watts());
        warm.power = scratch.power();
        warm.beyond_map = network.add_motors(temperatures, scratch, &mut warm.heat, &mut warm.motors);
        warm.sources = 0.0;
        for (node, watts) in network.sources() {
            warm.heat[*node] += watts;
            warm.sources += watts;
        }
        network
            .circuit(temperatures, scratch.speeds(), moment.around, None, &mut warm.circuit)
            .map_err(|(link, reason)| Unbalanced::Link(link, reason))
    }
}

impl<'a> March<'a> {
    /// A march from temperatures of the nodes. \[degC\]
    pub fn new(
        transmission: &'a Transmission,
        network: &'a Network,
        start: Vec<f64>,
        scheme: Scheme,
        step: StepSize,
    ) -> Self {
        Self {
            transmission,
            network,
            scheme,
            step,
            next: f64::INFINITY,
            warm: Warm::default(),
            temperatures: start,
            evaluations: 0,
            steps: [0; 2],
        }
    }

    /// Goes on over an interval (s) with constant speeds and torques, and tells its energies.
    ///
    /// # Errors
    /// Where a loss or a conductance has no value, or no step is short enough.
    pub fn advance(&mut self, moment: &Moment<'_>, duration: f64, scratch: &mut Scratch) -> Result<Heats, Unbalanced> {
        let mut heats = Heats::default();
        let mut left = duration;
        let least = duration * SHORTEST;
        let mut length = match self.step {
            StepSize::Fixed(most) => duration / (duration / most).ceil().max(1.0),
            StepSize::Adaptive(_) => self.next.min(duration),
        };
        while left > 1e-9 * duration {
            length = length.min(left);
            let before = self.temperatures.clone();
            match self.tried(moment, length, scratch) {
                Ok((more, error)) => {
                    let (accepted, factor) = match self.step {
                        StepSize::Fixed(_) => (true, 1.0),
                        StepSize::Adaptive(tolerance) => {
                            // The error of a step goes with the square of its length.
                            let factor = (0.8 * (tolerance / error.max(1e-12)).sqrt()).clamp(0.2, 4.0);
                            (error <= tolerance || length <= least, factor)
                        }
                    };
                    self.steps[usize::from(!accepted)] += 1;
                    if accepted {
                        scratch.count_seen();
                        heats.add(&more);
                        left -= length;
                        self.next = (length * factor).max(self.next.min(length * factor));
                    } else {
                        self.temperatures = before;
                    }
                    length = (length * factor).max(least);
                }
                Err(Unbalanced::Flow) if length > least => {
                    self.steps[1] += 1;
                    self.temperatures = before;
                    length *= 0.5;
                }
                Err(other) => {
                    self.temperatures = before;
                    return Err(other);
                }
            }
        }
        Ok(heats)
    }

    /// One step, or where steps adapt two of half its length and how far one is from them. \[K\]
    fn tried(&mut self, moment: &Moment<'_>, length: f64, scratch: &mut Scratch) -> Result<(Heats, f64), Unbalanced> {
        let StepSize::Adaptive(_) = self.step else {
            return Ok((self.single(moment, length, scratch)?, 0.0));
        };
        let before = self.temperatures.clone();
        self.single(moment, length, scratch)?;
        let whole = std::mem::replace(&mut self.temperatures, before);
        let mut heats = self.single(moment, 0.5 * length, scratch)?;
        heats.add(&self.single(moment, 0.5 * length, scratch)?);
        Ok((heats, farthest(&whole, &self.temperatures)))
    }

    /// One step.
    fn single(&mut self, moment: &Moment<'_>, length: f64, scratch: &mut Scratch) -> Result<Heats, Unbalanced> {
        let before = self.temperatures.clone();
        let (after, leaving) = match self.scheme {
            Scheme::Lagged => self.lagged(moment, length, scratch)?,
            Scheme::Implicit => self.implicit(moment, length, scratch)?,
        };
        self.temperatures = after;
        let warm = &self.warm;
        let each = |list: &[f64]| list.iter().map(|x| x * length).collect();
        Ok(Heats {
            duration: length,
            parts: each(&warm.parts),
            motors: warm.motors.iter().map(|m| m.map(|x| x * length)).collect(),
            sources: warm.sources * length,
            stored: warm.circuit.stored(&before, &self.temperatures),
            held: each(&leaving.held),
            exchangers: each(&leaving.exchangers),
            flows: leaving.flows * length,
            input: warm.power[0] * length,
            output: warm.power[1] * length,
            beyond_map: warm.beyond_map,
        })
    }

    fn evaluate(&mut self, moment: &Moment<'_>, at: &[f64], scratch: &mut Scratch) -> Result<(), Unbalanced> {
        self.evaluations += 1;
        self.transmission
            .warm(self.network, moment, at, scratch, &mut self.warm)
    }

    fn lagged(
        &mut self,
        moment: &Moment<'_>,
        length: f64,
        scratch: &mut Scratch,
    ) -> Result<(Vec<f64>, Leaving), Unbalanced> {
        let before = self.temperatures.clone();
        self.evaluate(moment, &before, scratch)?;
        let circuit = &mut self.warm.circuit;
        let exchangers = std::mem::take(&mut circuit.exchangers);
        for e in &exchangers {
            circuit.held[e.to] = Some(e.outlet(before[e.from]));
        }
        let after = circuit
            .solve(&self.warm.heat, Some((length, &before)))
            .ok_or(Unbalanced::Flow)?;
        let mut leaving = circuit.leaving(&after);
        for e in &exchangers {
            // What the oil has lost on its way through the exchanger stands among the gains of the other flows.
            let heat = e.oil * (after[e.from] - after[e.to]);
            leaving.exchangers.push(heat);
            leaving.flows -= heat;
        }
        Ok((after, leaving))
    }

    fn implicit(
        &mut self,
        moment: &Moment<'_>,
        length: f64,
        scratch: &mut Scratch,
    ) -> Result<(Vec<f64>, Leaving), Unbalanced> {
        let before = self.temperatures.clone();
        let mut guess = before.clone();
        for pass in 1..=MOST_PASSES {
            self.evaluate(moment, &guess, scratch)?;
            let after = self
                .warm
                .circuit
                .solve(&self.warm.heat, Some((length, &before)))
                .ok_or(Unbalanced::Flow)?;
            if farthest(&after, &guess) <= AGREED {
                let leaving = self.warm.circuit.leaving(&after);
                return Ok((after, leaving));
            }
            let share = if pass < CAREFUL { 1.0 } else { 0.5 };
            for (guess, after) in guess.iter_mut().zip(&after) {
                *guess += share * (after - *guess);
            }
        }
        Err(Unbalanced::Flow)
    }
}

/// The greatest difference of two lists of temperatures. \[K\]
pub(super) fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}
