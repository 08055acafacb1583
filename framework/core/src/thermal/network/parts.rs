//! A built thermal network: indices instead of names, models instead of choices.

use std::sync::Arc;

use super::faults;
use crate::document::Diagnostic;
use crate::lubricant::Lubricant;
use crate::machine::Machine;
use crate::mechanism::Slot;
use crate::mechanism::heat_link::{HeatLink, HeatLinkPart};
use crate::thermal::Arrangement;
use crate::transmission::HeatPath;

/// Surroundings of a gearbox at one time. `None`: as in the description.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surroundings {
    /// Ambient temperature. \[degC\]
    pub ambient: Option<f64>,
    /// Speed of the vehicle. \[m/s\]
    pub vehicle_speed: f64,
    /// Mass flow of the circulated oil. \[kg/s\]
    pub oil_flow: Option<f64>,
    /// Mass flow of the coolant of every heat exchanger. \[kg/s\]
    pub coolant_flow: Option<f64>,
    /// Inlet temperature of the coolant. \[degC\]
    pub coolant_temperature: Option<f64>,
}

/// Conductance of a link.
pub(super) enum Law {
    Given(f64),
    Model(Box<Lawful>),
}

/// A model with its inputs.
pub(super) struct Lawful {
    pub(super) model: Slot<HeatLink>,
    pub(super) part: Arc<HeatLinkPart>,
    pub(super) member: Option<usize>,
    /// Element of the oil network that the model names.
    pub(super) supply: Option<u16>,
    pub(super) lubricant: Arc<Lubricant>,
}

/// One link.
pub struct Link {
    /// Path, such as `thermal.network.links.casing_air`.
    pub path: String,
    pub(super) between: [usize; 2],
    pub(super) law: Law,
}

/// Quantity of a flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rate {
    /// Mass flow times specific heat. \[W/K\]
    Given(f64),
    /// A share of the circulated oil flow.
    Share(f64),
    /// A share of the flow through an element of the oil network, by number.
    Element(usize, f64),
}

pub(super) struct Exchanger {
    pub(super) path: String,
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) oil: Rate,
    pub(super) ua: f64,
    pub(super) arrangement: Arrangement,
    /// \[kg/s\]
    pub(super) coolant_flow: f64,
    pub(super) coolant_heat_capacity: f64,
    pub(super) coolant_temperature: f64,
}

/// An electric machine that heats two nodes.
pub(super) struct Motor {
    pub(super) machine: Arc<Machine>,
    pub(super) rotor: usize,
    pub(super) stator: usize,
}

/// An inverter that heats a node.
pub(super) struct InverterSeat {
    pub(super) machine: Arc<Machine>,
    pub(super) node: usize,
}

/// A thermal network.
pub struct Network {
    pub(super) names: Vec<String>,
    pub(super) capacities: Vec<f64>,
    /// Prescribed node temperatures; the first node is the ambient. \[degC\]
    pub(super) held: Vec<Option<f64>>,
    /// Initial temperatures, if stated. \[degC\]
    pub(super) starts: Vec<Option<f64>>,
    pub(super) links: Vec<Link>,
    pub(super) flows: Vec<([usize; 2], Rate)>,
    pub(super) exchangers: Vec<Exchanger>,
    pub(super) sources: Vec<(usize, f64)>,
    pub(super) motors: Vec<Motor>,
    pub(super) inverters: Vec<InverterSeat>,
    pub(super) heat: Vec<HeatPath>,
    /// The oil of the housing.
    pub(super) oil: usize,
    pub(super) pumped: Option<f64>,
    pub(super) lubricant: Arc<Lubricant>,
    pub(super) ambient: f64,
}

impl Network {
    /// Assigns the heat of each part to nodes, in the order of the parts.
    pub(crate) fn set_heat(&mut self, heat: Vec<HeatPath>) {
        self.heat = heat;
    }
    /// Names, capacities and connections, for checks.
    pub(super) fn shape(&self) -> faults::Shape<'_> {
        faults::Shape {
            names: &self.names,
            capacities: &self.capacities,
            held: self.held.iter().map(Option::is_some).collect(),
            links: self.links.iter().map(|link| link.between).collect(),
            flows: self
                .flows
                .iter()
                .map(|(ends, _)| *ends)
                .chain(self.exchangers.iter().map(|e| [e.from, e.to]))
                .collect(),
            cooled: self.exchangers.iter().map(|e| e.to).collect(),
        }
    }
    /// Names of the nodes, `ambient` first.
    pub fn names(&self) -> &[String] {
        &self.names
    }
    /// Heat capacities of the nodes. \[J/K\]
    pub fn capacities(&self) -> &[f64] {
        &self.capacities
    }
    /// True for nodes with prescribed temperature.
    pub fn is_held(&self, node: usize) -> bool {
        self.held[node].is_some()
    }
    /// Number of the node that is the oil of the housing.
    pub fn oil(&self) -> usize {
        self.oil
    }
    /// Links with their paths and ends.
    pub fn links(&self) -> impl ExactSizeIterator<Item = (&str, [usize; 2])> {
        self.links.iter().map(|link| (link.path.as_str(), link.between))
    }
    /// True if oil is circulated, so that a recorded flow is used.
    pub fn is_pumped(&self) -> bool {
        self.pumped.is_some()
    }
    /// Paths of the heat exchangers.
    pub fn exchangers(&self) -> impl ExactSizeIterator<Item = &str> {
        self.exchangers.iter().map(|e| e.path.as_str())
    }
    /// Warnings: notes on the maps of motors, and nodes whose outgoing oil flow is less than the incoming one.
    pub(crate) fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        for motor in &self.motors {
            let path = format!("{}.map", motor.machine.path);
            let notes = motor.machine.notes.iter();
            warnings.extend(notes.map(|note| Diagnostic::warning(path.clone(), note.clone())));
        }
        let flows = self.flows.iter().copied();
        let exchangers = self.exchangers.iter().map(|e| ([e.from, e.to], e.oil));
        let ways: Vec<([usize; 2], Rate)> = flows.chain(exchangers).collect();
        for (node, name) in self.names.iter().enumerate().filter(|(i, _)| !self.is_held(*i)) {
            // Given flows and shares of the circulated flow are balanced separately.
            let mut net = [0.0_f64; 2];
            for ([from, to], rate) in &ways {
                let (kind, amount) = match rate {
                    Rate::Given(given) => (0, *given),
                    Rate::Share(share) => (1, *share),
                    // Flows of the oil network balance at its junctions.
                    Rate::Element(..) => continue,
                };
                if *to == node {
                    net[kind] += amount;
                }
                if *from == node {
                    net[kind] -= amount;
                }
            }
            if net.iter().any(|net| net.abs() > 1e-9) {
                warnings.push(
                    Diagnostic::warning(
                        format!("thermal.network.nodes.{name}"),
                        format!(
                            "outgoing and incoming oil flow of `{name}` differ: the difference adds or removes heat"
                        ),
                    )
                    .help("close the circuit with flows, each with its share"),
                );
            }
        }
        warnings
    }
    /// Paths of the motors.
    pub fn motors(&self) -> impl ExactSizeIterator<Item = &str> {
        self.motors.iter().map(|m| m.machine.path.as_str())
    }
    /// Paths of the machines whose inverters heat a node.
    pub fn inverters(&self) -> impl ExactSizeIterator<Item = &str> {
        self.inverters.iter().map(|seat| seat.machine.path.as_str())
    }
    /// Heat from other sources by node. \[W\]
    pub fn sources(&self) -> &[(usize, f64)] {
        &self.sources
    }
    /// Destination of the heat of a part, by its number.
    pub fn heat(&self, part: usize) -> &HeatPath {
        &self.heat[part]
    }
}
