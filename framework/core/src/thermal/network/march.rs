//! Temperatures of the network of a transmission in time.

use super::circuit::Circuit;
use super::parts::{Network, Surroundings};
use super::stepping::{Heated, Scheme, StepSize, Stepping};
use crate::evaluate::{Noting, Point, Scratch};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

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
        self.combine(1.0, more, 1.0);
    }

    /// A multiple of itself and a multiple of another.
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
    stepping: Stepping,
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
            .circuit(
                temperatures,
                scratch.speeds_and_cells(),
                moment.around,
                &mut warm.circuit,
            )
            .map_err(|(link, reason)| Unbalanced::Link(link, reason))
    }
}

/// A transmission under one load, for the steps of its network.
struct Loaded<'a, 'b> {
    transmission: &'a Transmission,
    network: &'a Network,
    moment: &'b Moment<'b>,
    scratch: &'b mut Scratch,
    evaluations: &'b mut usize,
    steps: &'b mut [usize; 2],
}

impl Heated for Loaded<'_, '_> {
    fn warm(&mut self, temperatures: &[f64], warm: &mut Warm) -> Result<(), Unbalanced> {
        *self.evaluations += 1;
        self.transmission
            .warm(self.network, self.moment, temperatures, self.scratch, warm)
    }

    fn stepped(&mut self, taken: bool) {
        self.steps[usize::from(!taken)] += 1;
        if taken {
            self.scratch.count_seen();
        }
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
            stepping: Stepping::new(scheme, step),
            temperatures: start,
            evaluations: 0,
            steps: [0; 2],
        }
    }

    /// Goes on over an interval (s) with constant speeds and torques, and tells its energies.
    ///
    /// # Errors
    /// Where a loss or a conductance has no value, or no step is short enough. The temperatures then are those before the step
    /// that failed.
    pub fn advance(&mut self, moment: &Moment<'_>, duration: f64, scratch: &mut Scratch) -> Result<Heats, Unbalanced> {
        let mut loaded = Loaded {
            transmission: self.transmission,
            network: self.network,
            moment,
            scratch,
            evaluations: &mut self.evaluations,
            steps: &mut self.steps,
        };
        self.stepping.advance(&mut loaded, &mut self.temperatures, duration)
    }
}
