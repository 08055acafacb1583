//! Transient temperatures of the network of a transmission.

use std::cmp::Ordering;

use super::circuit::Circuit;
use super::parts::{Network, Surroundings};
use super::stepping::{Heated, Scheme, StepSize, Stepping, Trial};
use crate::evaluate::{Asked, BatchScratch, Noting, Point, Snapshot};
use crate::flow::{Start, Status, Tolerance};
use crate::loss::Extent;
use crate::machine::{MachineEnergy, MachineState};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Energies of a time interval. \[J\]
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Heats {
    /// Length. \[s\]
    pub duration: f64,
    /// Loss of each part.
    pub parts: Vec<f64>,
    /// Loss of each motor in rotor and stator.
    pub motors: Vec<[f64; 2]>,
    /// Loss of each inverter that heats a node.
    pub inverters: Vec<f64>,
    /// Heat from other sources.
    pub sources: f64,
    /// Heat stored in the nodes.
    pub stored: f64,
    /// Heat into each node of prescribed temperature.
    pub held: Vec<f64>,
    /// Heat through each heat exchanger.
    pub exchangers: Vec<f64>,
    /// Heat carried away by flows.
    pub flows: f64,
    /// Input energy over the ports.
    pub input: f64,
    /// Output energy over the ports.
    pub output: f64,
    /// True if a motor was outside its map.
    pub beyond_map: bool,
    /// Energies of the active machines.
    pub machines: Vec<MachineEnergy>,
}

impl Heats {
    /// Total heat input of the nodes.
    pub fn heat_input(&self) -> f64 {
        let machines = self.motors.iter().flatten().sum::<f64>() + self.inverters.iter().sum::<f64>();
        self.parts.iter().sum::<f64>() + machines + self.sources
    }

    /// Energy balance error: heat input minus stored heat and outgoing heat; zero to rounding.
    pub fn residual(&self) -> f64 {
        let left = self.held.iter().sum::<f64>() + self.exchangers.iter().sum::<f64>() + self.flows;
        self.heat_input() - self.stored - left
    }

    /// Adds another interval.
    pub fn add(&mut self, more: &Self) {
        self.combine(1.0, more, 1.0);
    }

    /// Linear combination with another.
    pub(super) fn combine(&mut self, factor: f64, more: &Self, share: f64) {
        let one = |sum: &mut f64, x: f64| *sum = factor * *sum + share * x;
        let each = |sums: &mut Vec<f64>, more: &[f64]| {
            sums.resize(sums.len().max(more.len()), 0.0);
            sums.iter_mut().zip(more).for_each(|(sum, x)| one(sum, *x));
        };
        one(&mut self.duration, more.duration);
        each(&mut self.parts, &more.parts);
        each(&mut self.held, &more.held);
        each(&mut self.exchangers, &more.exchangers);
        each(&mut self.inverters, &more.inverters);
        self.motors.resize(self.motors.len().max(more.motors.len()), [0.0; 2]);
        for (sum, x) in self.motors.iter_mut().zip(&more.motors) {
            one(&mut sum[0], x[0]);
            one(&mut sum[1], x[1]);
        }
        one(&mut self.sources, more.sources);
        one(&mut self.stored, more.stored);
        one(&mut self.flows, more.flows);
        one(&mut self.input, more.input);
        one(&mut self.output, more.output);
        self.beyond_map |= more.beyond_map;
        let count = self.machines.len().max(more.machines.len());
        self.machines.resize(count, MachineEnergy::default());
        for (sum, x) in self.machines.iter_mut().zip(&more.machines) {
            sum.combine(factor, x, share);
        }
    }
}

/// Constant conditions of an interval.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Gear state and ports.
    pub case: &'a Case,
    /// Torques and speeds.
    pub point: &'a Point<'a>,
    /// Surroundings of the gearbox.
    pub around: &'a Surroundings,
}

/// An interval with constant conditions.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    /// Its conditions.
    pub moment: Moment<'a>,
    /// Its length. \[s\]
    pub duration: f64,
    /// Number of the workspace of its case.
    pub scratch: usize,
}

/// A simulated interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Passed {
    /// Energies.
    pub heats: Heats,
    /// Node temperatures at its end. \[degC\]
    pub temperatures: Vec<f64>,
    /// Speeds of the members. \[rad/s\]
    pub speeds: Vec<f64>,
    /// Torques that ports apply at its end, by member. \[Nm\]
    pub port_torques: Vec<f64>,
    /// Operating state at its end.
    pub status: Status,
}

/// Losses and heat flows at one set of temperatures.
#[derive(Debug, Clone, Default)]
pub(super) struct Warm {
    pub circuit: Circuit,
    /// The evaluated point, with the loss of each part.
    pub point: Snapshot,
    /// Heat into each node. \[W\]
    pub heat: Vec<f64>,
    /// Loss of each motor in rotor and stator. \[W\]
    pub motors: Vec<[f64; 2]>,
    /// Loss of each inverter that heats a node. \[W\]
    pub inverters: Vec<f64>,
    /// Heat from other sources. \[W\]
    pub sources: f64,
    /// True if a motor was outside its map.
    pub beyond_map: bool,
    /// The active machines.
    pub machines: Vec<MachineState>,
}

/// How the losses at temperatures are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Search {
    pub start: Start,
    /// Minimum tolerance of the power flow; see [`Tolerance::power`].
    pub least: f64,
}

impl Search {
    /// The first of several for one point, roughly, because its temperatures are a guess: usually at the torques without losses.
    pub const FIRST: Self = Self {
        start: Start::Lossless,
        least: Tolerance::ESTIMATE,
    };
    /// The second for steps that are solved together, more roughly than the temperatures change until the third.
    pub const SECOND: Self = Self {
        start: Start::Last,
        least: 1e-3,
    };
    /// Without another one before.
    pub(crate) const ONLY: Self = Self {
        start: Start::Lossless,
        least: 0.0,
    };
    /// After another one for the same point.
    pub(crate) const NEXT: Self = Self {
        start: Start::Last,
        least: 0.0,
    };
}

impl Transmission {
    /// Heat and conductances at the node temperatures at which a point was evaluated.
    pub(super) fn warm(
        &self,
        network: &Network,
        around: &Surroundings,
        temperatures: &[f64],
        warm: &mut Warm,
    ) -> Result<(), Unbalanced> {
        let point = &mut warm.point;
        warm.heat.clear();
        warm.heat.resize(network.names().len(), 0.0);
        network.add_parts(self, point, &mut warm.heat);
        warm.beyond_map = network.add_motors(temperatures, point, &mut warm.heat, &mut warm.motors);
        network.add_inverters(self, temperatures, point, &mut warm.heat, &mut warm.inverters);
        warm.machines = self.machines_at(&point.speeds, &point.port_torques, temperatures);
        warm.sources = 0.0;
        for (node, watts) in network.sources() {
            warm.heat[*node] += watts;
            warm.sources += watts;
        }
        network
            .circuit(temperatures, point, around, &mut warm.circuit)
            .map_err(|(link, reason)| Unbalanced::Link(link, reason))
    }
}

/// Transient simulation of the node temperatures.
pub struct March<'a> {
    stepping: Stepping,
    /// Present node temperatures. \[degC\]
    pub temperatures: Vec<f64>,
    counts: Counts<'a>,
}

/// What is counted in a simulation.
struct Counts<'a> {
    transmission: &'a Transmission,
    network: &'a Network,
    evaluations: usize,
    steps: [usize; 2],
    lost_outside: Vec<f64>,
    seen: Vec<Extent>,
}

/// A transmission in some intervals, for the steps of its network.
struct Loaded<'a, 'b> {
    stages: &'b [Stage<'b>],
    scratches: &'b mut [BatchScratch],
    counts: &'b mut Counts<'a>,
}

/// Steps of stages with equal keys are evaluated together: those of one case, with equal signs of torque and speed and hence equal driving
/// gears.
fn key(stage: &Stage<'_>) -> (usize, [Option<Ordering>; 2]) {
    let sign = |values: &[f64]| values.first().and_then(|value| value.partial_cmp(&0.0));
    let point = stage.moment.point;
    (stage.scratch, [sign(point.torques), sign(point.speeds)])
}

impl Heated for Loaded<'_, '_> {
    fn warm(&mut self, trials: &mut [Trial], search: Search) -> Result<(), Unbalanced> {
        self.counts.evaluations += trials.len();
        let (transmission, network) = (self.counts.transmission, self.counts.network);
        let stages = self.stages;
        let mut sorted: Vec<&mut Trial> = trials.iter_mut().collect();
        sorted.sort_by_key(|trial| key(&stages[trial.stage]));
        // The rough losses at the first guesses are never those of the result.
        let noting = if search.least > 0.0 {
            Noting::Muted
        } else {
            Noting::Seen
        };
        for some in sorted.chunk_by_mut(|a, b| key(&stages[a.stage]) == key(&stages[b.stage])) {
            let Stage { moment, scratch, .. } = stages[some[0].stage];
            let mut asked: Vec<Asked<'_>> = some
                .iter_mut()
                .map(|trial| Asked {
                    point: stages[trial.stage].moment.point.with_tolerance_at_least(search.least),
                    temperatures: &trial.guess,
                    snapshot: &mut trial.warm.point,
                })
                .collect();
            let scratch = &mut self.scratches[scratch];
            let found = transmission.evaluate_each(moment.case, &mut asked, search.start, noting, scratch);
            found.into_iter().collect::<Result<(), _>>()?;
        }
        for trial in trials {
            let around = stages[trial.stage].moment.around;
            transmission.warm(network, around, &trial.guess, &mut trial.warm)?;
        }
        Ok(())
    }

    fn stepped(&mut self, taken: Option<(f64, &Warm)>) {
        let counts = &mut *self.counts;
        counts.steps[usize::from(taken.is_none())] += 1;
        if let Some((length, warm)) = taken {
            warm.point.count(counts.transmission, &mut counts.seen);
            for (cell, watts) in warm.point.lost_outside(counts.transmission) {
                counts.lost_outside[cell] += watts * length;
            }
        }
    }
}

impl<'a> March<'a> {
    /// Starts a simulation from node temperatures. \[degC\]
    pub fn new(
        transmission: &'a Transmission,
        network: &'a Network,
        start: Vec<f64>,
        scheme: Scheme,
        step: StepSize,
    ) -> Self {
        Self {
            stepping: Stepping::new(scheme, step),
            temperatures: start,
            counts: Counts {
                transmission,
                network,
                evaluations: 0,
                steps: [0; 2],
                lost_outside: vec![0.0; transmission.cells],
                seen: vec![Extent::EMPTY; transmission.cells],
            },
        }
    }

    /// Number of loss evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.counts.evaluations
    }

    /// Number of steps so far, and of rejected steps.
    pub fn steps(&self) -> [usize; 2] {
        self.counts.steps
    }

    /// Energy that the components lose while a limit is exceeded, by cell of notes. \[J\]
    pub fn lost_outside(&self) -> &[f64] {
        &self.counts.lost_outside
    }

    /// Observed limits and quantities, one count for each step.
    pub fn seen(&self) -> &[Extent] {
        &self.counts.seen
    }

    /// Number of the next intervals that can be simulated together, from their lengths. \[s\]
    pub fn reach(&self, durations: impl Iterator<Item = f64>) -> usize {
        self.stepping.reach(durations)
    }

    /// Simulates an interval (s) with constant speeds and torques, and returns its energies.
    ///
    /// # Errors
    /// If a loss or a conductance is undefined, or no step is short enough. The temperatures are then those before the
    /// failed step.
    pub fn advance(
        &mut self,
        moment: &Moment<'_>,
        duration: f64,
        scratch: &mut BatchScratch,
    ) -> Result<Heats, Unbalanced> {
        let stage = Stage {
            moment: *moment,
            duration,
            scratch: 0,
        };
        let mut heats = Heats::default();
        for passed in self.advance_together(&[stage], std::slice::from_mut(scratch))? {
            heats.add(&passed.heats);
        }
        Ok(heats)
    }

    /// Simulates the first of some intervals, and as many of the others as can be simulated together with it, each case with its own
    /// workspace. Returns at least one.
    ///
    /// # Errors
    /// As [`March::advance`], for the first.
    pub fn advance_together(
        &mut self,
        stages: &[Stage<'_>],
        scratches: &mut [BatchScratch],
    ) -> Result<Vec<Passed>, Unbalanced> {
        let durations: Vec<f64> = stages.iter().map(|stage| stage.duration).collect();
        let mut loaded = Loaded {
            stages,
            scratches,
            counts: &mut self.counts,
        };
        self.stepping
            .advance_together(&mut loaded, &mut self.temperatures, &durations)
    }
}
