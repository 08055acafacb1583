//! Transient temperatures of the network of a transmission.

use super::circuit::Circuit;
use super::parts::{Network, Surroundings};
use super::stepping::{Heated, Scheme, StepSize, Stepping};
use crate::evaluate::{Noting, Point, Scratch};
use crate::flow::{Start, Tolerance};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Energies of a time interval. \[J\]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heats {
    /// Length. \[s\]
    pub duration: f64,
    /// Loss of each part.
    pub parts: Vec<f64>,
    /// Loss of each motor in rotor and stator.
    pub motors: Vec<[f64; 2]>,
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
}

impl Heats {
    /// Total heat input of the nodes.
    pub fn heat_input(&self) -> f64 {
        self.parts.iter().sum::<f64>() + self.motors.iter().flatten().sum::<f64>() + self.sources
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
    pub(super) fn combine(&mut self, own: f64, more: &Self, share: f64) {
        let one = |sum: &mut f64, x: f64| *sum = own * *sum + share * x;
        let each = |sums: &mut Vec<f64>, more: &[f64]| {
            sums.resize(sums.len().max(more.len()), 0.0);
            sums.iter_mut().zip(more).for_each(|(sum, x)| one(sum, *x));
        };
        one(&mut self.duration, more.duration);
        each(&mut self.parts, &more.parts);
        each(&mut self.held, &more.held);
        each(&mut self.exchangers, &more.exchangers);
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
    /// Heat from other sources. \[W\]
    pub sources: f64,
    /// Power in and out. \[W\]
    pub power: [f64; 2],
    /// True if a motor is outside its map.
    pub beyond_map: bool,
}

/// How the losses at temperatures are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Search {
    pub start: Start,
    /// Minimum tolerance of the power flow; see [`Tolerance::power`].
    pub least: f64,
}

impl Search {
    /// The first of several for one point, roughly: its temperatures are a guess.
    pub const FIRST: Self = Self {
        start: Start::Lossless,
        least: 1e-5,
    };
    /// Without another one before.
    pub const ONLY: Self = Self {
        start: Start::Lossless,
        least: 0.0,
    };
    /// After another one for the same point.
    pub const NEXT: Self = Self {
        start: Start::Last,
        least: 0.0,
    };
}

/// Transient simulation of the node temperatures.
pub struct March<'a> {
    transmission: &'a Transmission,
    network: &'a Network,
    stepping: Stepping,
    /// Present node temperatures. \[degC\]
    pub temperatures: Vec<f64>,
    /// Number of loss evaluations so far.
    pub evaluations: usize,
    /// Number of steps so far, and of rejected steps.
    pub steps: [usize; 2],
    /// Energy that the components lose while a limit is exceeded, by cell of notes. \[J\]
    pub lost_outside: Vec<f64>,
}

impl Transmission {
    /// Losses, heat and conductances at node temperatures.
    pub(super) fn warm(
        &self,
        network: &Network,
        moment: &Moment<'_>,
        temperatures: &[f64],
        search: Search,
        scratch: &mut Scratch,
        warm: &mut Warm,
    ) -> Result<(), Unbalanced> {
        let own = moment.point.tolerance;
        let power = own.power.max(search.least);
        let point = Point {
            tolerance: Tolerance { power, ..own },
            ..*moment.point
        };
        // The losses at the first guess are never those of the result.
        let noting = if search == Search::FIRST {
            Noting::Muted
        } else {
            Noting::Seen
        };
        self.try_point_from(search.start, moment.case, &point, temperatures, scratch, noting)?;
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
            .circuit(
                temperatures,
                scratch.speeds_and_cells(),
                moment.around,
                &mut warm.circuit,
            )
            .map_err(|(link, reason)| Unbalanced::Link(link, reason))
    }
}

/// A transmission at one operating point, for the steps of its network.
struct Loaded<'a, 'b> {
    transmission: &'a Transmission,
    network: &'a Network,
    moment: &'b Moment<'b>,
    scratch: &'b mut Scratch,
    evaluations: &'b mut usize,
    steps: &'b mut [usize; 2],
    lost_outside: &'b mut [f64],
}

impl Heated for Loaded<'_, '_> {
    fn warm(&mut self, temperatures: &[f64], search: Search, warm: &mut Warm) -> Result<(), Unbalanced> {
        *self.evaluations += 1;
        self.transmission
            .warm(self.network, self.moment, temperatures, search, self.scratch, warm)
    }

    fn stepped(&mut self, taken: Option<f64>) {
        self.steps[usize::from(taken.is_none())] += 1;
        if let Some(length) = taken {
            self.scratch.count_seen();
            for (cell, watts) in self.scratch.lost_outside() {
                self.lost_outside[cell] += watts * length;
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
            transmission,
            network,
            stepping: Stepping::new(scheme, step),
            temperatures: start,
            evaluations: 0,
            steps: [0; 2],
            lost_outside: vec![0.0; transmission.cells],
        }
    }

    /// Simulates an interval (s) with constant speeds and torques, and returns its energies.
    ///
    /// # Errors
    /// If a loss or a conductance is undefined, or no step is short enough. The temperatures are then those before the
    /// failed step.
    pub fn advance(&mut self, moment: &Moment<'_>, duration: f64, scratch: &mut Scratch) -> Result<Heats, Unbalanced> {
        let mut loaded = Loaded {
            transmission: self.transmission,
            network: self.network,
            moment,
            scratch,
            evaluations: &mut self.evaluations,
            steps: &mut self.steps,
            lost_outside: &mut self.lost_outside,
        };
        self.stepping.advance(&mut loaded, &mut self.temperatures, duration)
    }
}
