//! A network in numbers, for programs that simulate it with tables instead of models.

use super::march::Warm;
use super::parts::{Law, Network, Rate};
use crate::evaluate::{Asked, BatchScratch, Noting, Point, PowerFlow};
use crate::flow::{Start, Tolerance};
use crate::loss::{Notes, Undefined};
use crate::thermal::{Arrangement, Unbalanced};
use crate::transmission::{Case, HeatPath, PartKind, Transmission};

/// A heat exchanger in numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExchangerNumbers {
    /// Nodes of the oil before and after it.
    pub between: [usize; 2],
    /// Flow of the oil.
    pub oil: Rate,
    /// Conductance between oil and coolant. \[W/K\]
    pub ua: f64,
    /// Flow arrangement.
    pub arrangement: Arrangement,
    /// Mass flow of the coolant. \[kg/s\]
    pub coolant_flow: f64,
    /// Specific heat of the coolant. \[J/(kg K)\]
    pub coolant_heat_capacity: f64,
    /// Inlet temperature of the coolant. \[degC\]
    pub coolant_temperature: f64,
}

/// State that determines the conductance of a link.
#[derive(Debug, Clone, Copy)]
pub struct LinkState<'a> {
    /// Temperatures of both nodes. \[degC\]
    pub temperatures: [f64; 2],
    /// Speeds of the members. \[rad/s\]
    pub speeds: &'a [f64],
    /// Speed of the vehicle. \[m/s\]
    pub vehicle_speed: f64,
    /// Mass flow of the circulated oil. \[kg/s\]
    pub oil_flow: f64,
}

/// Torque and speed at the ports of a case, at temperatures of the nodes.
#[derive(Debug, Clone)]
pub struct Load {
    /// Torque; unused in a gear that needs none. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Temperatures of the nodes. \[degC\]
    pub temperatures: Vec<f64>,
}

/// Heat of all losses at one load.
#[derive(Debug, Clone, Default)]
pub struct NodeHeats {
    /// For each part the heat into nodes. \[W\]
    pub parts: Vec<Vec<(usize, f64)>>,
    /// Heat of each motor into its rotor and its stator. \[W\]
    pub motors: Vec<[f64; 2]>,
}

impl Network {
    /// Prescribed temperature of a node; that of the first, the ambient, may be changed. \[degC\]
    pub fn held(&self, node: usize) -> Option<f64> {
        self.held[node]
    }

    /// Volume flow of the circulated oil. \[m3/s\]
    pub fn pumped(&self) -> Option<f64> {
        self.pumped
    }

    /// Density (kg/m3) and specific heat (J/(kg K)) of the oil of the housing at a temperature. \[degC\]
    pub fn oil_properties(&self, temperature: f64) -> [f64; 2] {
        [
            self.lubricant.density(temperature),
            self.lubricant.heat_capacity(temperature),
        ]
    }

    /// True if flows of the oil network carry heat, which depend on speeds and on the temperature of the oil.
    pub fn uses_oil_network(&self) -> bool {
        let exchangers = self.exchangers.iter().map(|exchanger| exchanger.oil);
        let mut rates = self.flows.iter().map(|(_, rate)| *rate).chain(exchangers);
        let named = |law: &Law| matches!(law, Law::Model(law) if law.supply.is_some());
        rates.any(|rate| matches!(rate, Rate::Element(..))) || self.links.iter().any(|link| named(&link.law))
    }

    /// Flows of oil from one node to another.
    pub fn flows(&self) -> &[([usize; 2], Rate)] {
        &self.flows
    }

    /// The heat exchangers in numbers, in the order of [`Network::exchangers`].
    pub fn exchanger_numbers(&self) -> impl ExactSizeIterator<Item = ExchangerNumbers> {
        self.exchangers.iter().map(|e| ExchangerNumbers {
            between: [e.from, e.to],
            oil: e.oil,
            ua: e.ua,
            arrangement: e.arrangement,
            coolant_flow: e.coolant_flow,
            coolant_heat_capacity: e.coolant_heat_capacity,
            coolant_temperature: e.coolant_temperature,
        })
    }

    /// Conductance of a link, by its number. \[W/K\]
    ///
    /// # Errors
    /// If its model is undefined.
    pub fn conductance(&self, link: usize, at: &LinkState<'_>) -> Result<f64, Undefined> {
        match &self.links[link].law {
            Law::Given(given) => Ok(*given),
            Law::Model(law) => law.conductance(at.temperatures, at.speeds, at.vehicle_speed, at.oil_flow, Notes::MUTED),
        }
    }

    /// Member, rotor and stator node of a motor, by its number.
    pub fn motor_nodes(&self, motor: usize) -> (usize, [usize; 2]) {
        let seat = &self.motors[motor];
        (seat.machine.member, [seat.rotor, seat.stator])
    }

    /// Losses of a motor in rotor and stator at a speed (rad/s), a torque (Nm) and a temperature of its windings (degC). \[W\]
    pub fn motor_loss(&self, motor: usize, speed: f64, torque: f64, temperature: f64) -> [f64; 2] {
        let machine = &self.motors[motor].machine;
        machine.in_rotor_and_stator(speed, machine.loss(speed, torque, temperature).machine)
    }

    /// Speeds (rad/s) and torques (Nm) of the map of a motor, both ascending and not negative; `None` without a map.
    pub fn motor_axes(&self, motor: usize) -> Option<[Vec<f64>; 2]> {
        let nodes = self.motors[motor].machine.map()?.nodes();
        Some([0, 1].map(|column| {
            let mut axis: Vec<f64> = nodes.iter().map(|(place, _)| place[column]).collect();
            axis.sort_by(f64::total_cmp);
            axis.dedup();
            axis
        }))
    }
}

impl Transmission {
    /// Heat of all losses at some loads of a case with one speed and at most one torque, each for itself.
    ///
    /// # Panics
    /// If a load does not have a temperature for each node, or the network is that of another transmission: bugs of the caller.
    pub fn node_heats(
        &self,
        network: &Network,
        case: &Case,
        flow: PowerFlow,
        loads: &[Load],
        scratch: &mut BatchScratch,
    ) -> Vec<Result<NodeHeats, Unbalanced>> {
        let sign = |load: &Load| [load.torque, load.speed].map(|x| x.partial_cmp(&0.0));
        let mut heats = Vec::with_capacity(loads.len());
        for some in loads.chunk_by(|a, b| sign(a) == sign(b)) {
            let mut warms: Vec<Warm> = vec![Warm::default(); some.len()];
            let mut asked: Vec<Asked<'_>> = some
                .iter()
                .zip(&mut warms)
                .map(|(load, warm)| Asked {
                    point: Point {
                        speeds: std::slice::from_ref(&load.speed),
                        torques: &std::slice::from_ref(&load.torque)[..case.torque_ports.len()],
                        flow,
                        tolerance: Tolerance::default(),
                        inclination: 0.0,
                    },
                    temperatures: &load.temperatures,
                    snapshot: &mut warm.point,
                })
                .collect();
            let found = self.evaluate_each(case, &mut asked, Start::Lossless, Noting::Muted, scratch);
            for ((found, load), warm) in found.into_iter().zip(some).zip(&mut warms) {
                heats.push(found.map(|()| self.read_heats(network, &load.temperatures, warm)));
            }
        }
        heats
    }

    /// The heat of an evaluated load.
    fn read_heats(&self, network: &Network, temperatures: &[f64], warm: &mut Warm) -> NodeHeats {
        let point = &warm.point;
        let parts = self
            .parts()
            .iter()
            .zip(&point.watts)
            .enumerate()
            .map(|(i, (part, watts))| match (network.heat(i), part.kind) {
                (HeatPath::Gears([first, second]), PartKind::Mesh(mesh)) => {
                    let share = point.first_heat[mesh];
                    vec![(*first, share * watts), (*second, (1.0 - share) * watts)]
                }
                (HeatPath::Gears(nodes), _) => spread(nodes, *watts),
                (HeatPath::Nodes(nodes), _) => spread(nodes, *watts),
            });
        let parts = parts.collect();
        warm.heat.clear();
        warm.heat.resize(network.names().len(), 0.0);
        network.add_motors(temperatures, &warm.point, &mut warm.heat, &mut warm.motors);
        NodeHeats {
            parts,
            motors: std::mem::take(&mut warm.motors),
        }
    }
}

/// Equal shares for nodes.
fn spread(nodes: &[usize], watts: f64) -> Vec<(usize, f64)> {
    nodes.iter().map(|node| (*node, watts / nodes.len() as f64)).collect()
}
