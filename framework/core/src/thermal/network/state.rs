//! Numerical form of a network at one state: heat of parts and motors, and its circuit.

use super::circuit::{Circuit, Exchange};
use super::parts::{Law, Lawful, Network, Rate, Surroundings};
use crate::evaluate::Snapshot;
use crate::loss::{Notes, Undefined};
use crate::mechanism::heat_link::HeatLinkAt;
use crate::transmission::{HeatPath, PartKind, Transmission};

impl Network {
    /// Adds the heat of all parts at the last evaluated point to that of the nodes. \[W\]
    pub(super) fn add_parts(&self, transmission: &Transmission, point: &Snapshot, heat: &mut [f64]) {
        for ((part, way), watts) in transmission.parts().iter().zip(&self.heat).zip(&point.watts) {
            match (way, part.kind) {
                (HeatPath::Gears([first, second]), PartKind::Mesh(mesh)) => {
                    let share = point.first_heat[mesh];
                    heat[*first] += share * watts;
                    heat[*second] += (1.0 - share) * watts;
                }
                (HeatPath::Gears(nodes), _) => spread(*watts, nodes, heat),
                (HeatPath::Nodes(nodes), _) => spread(*watts, nodes, heat),
            }
        }
    }
    /// Adds the losses of all motors at the last evaluated point to the heat of the nodes, and returns them for rotor and stator;
    /// true if one is outside its map. \[W\]
    pub(super) fn add_motors(
        &self,
        temperatures: &[f64],
        point: &Snapshot,
        heat: &mut [f64],
        losses: &mut Vec<[f64; 2]>,
    ) -> bool {
        let mut outside = false;
        losses.clear();
        for motor in &self.motors {
            let machine = &motor.machine;
            let (speed, torque) = (point.speeds[machine.member], point.port_torques[machine.member]);
            // The windings are in the stator.
            let found = machine.loss(speed, torque, temperatures[motor.stator]);
            outside |= found.outside;
            let losses_of_motor = machine.in_rotor_and_stator(speed, found.machine);
            heat[motor.rotor] += losses_of_motor[0];
            heat[motor.stator] += losses_of_motor[1];
            losses.push(losses_of_motor);
        }
        outside
    }
    /// Adds the losses of all inverters with a node to the heat of the nodes, and returns them: those of
    /// [`Transmission::machines_at`], which are part of what the DC link supplies. \[W\]
    pub(super) fn add_inverters(
        &self,
        transmission: &Transmission,
        temperatures: &[f64],
        point: &Snapshot,
        heat: &mut [f64],
        losses: &mut Vec<f64>,
    ) {
        losses.clear();
        for seat in &self.inverters {
            let member = seat.machine.member;
            let (speed, torque) = (point.speeds[member], point.port_torques[member]);
            let state = transmission.machine_at(&seat.machine, speed, torque, temperatures);
            heat[seat.node] += state.inverter;
            losses.push(state.inverter);
        }
    }
    /// Initial temperatures: prescribed ones, else stated ones, else `start`, else the ambient temperature. \[degC\]
    pub fn start(&self, start: Option<f64>, around: &Surroundings) -> Vec<f64> {
        let ambient = around.ambient.unwrap_or(self.ambient);
        (0..self.names.len())
            .map(|i| {
                self.prescribed(i, around)
                    .or(self.starts[i])
                    .or(start)
                    .unwrap_or(ambient)
            })
            .collect()
    }

    /// Prescribed temperature of a node. \[degC\]
    fn prescribed(&self, node: usize, around: &Surroundings) -> Option<f64> {
        match (node, around.ambient) {
            (0, Some(ambient)) => Some(ambient),
            _ => self.held[node],
        }
    }

    /// Writes the numerical form of the network at node temperatures (degC) and the speeds of an evaluated point.
    ///
    /// # Errors
    /// Number of the link whose model is undefined, and the reason.
    pub(crate) fn circuit(
        &self,
        temperatures: &[f64],
        point: &mut Snapshot,
        around: &Surroundings,
        circuit: &mut Circuit,
    ) -> Result<(), (usize, Undefined)> {
        circuit.capacities.clone_from(&self.capacities);
        circuit.held.clear();
        circuit
            .held
            .extend((0..self.names.len()).map(|i| self.prescribed(i, around)));
        // A single mass flow in the circuit, so that it is balanced: that of the oil of the housing.
        let oil = temperatures[self.oil];
        let pumped = || self.pumped.unwrap_or(0.0) * self.lubricant.density(oil);
        let mass = around.oil_flow.unwrap_or_else(pumped);
        let capacity = mass * self.lubricant.heat_capacity(oil);
        let density = self.lubricant.density(oil);
        let (speeds, oil_flows, cells) = point.flows_and_cells();
        let through = |element: usize| density * oil_flows[element].max(0.0);
        let rate = |rate: Rate| match rate {
            Rate::Given(given) => given,
            Rate::Share(share) => share * capacity,
            Rate::Element(element, share) => share * through(element) * self.lubricant.heat_capacity(oil),
        };
        circuit.links.clear();
        for (i, link) in self.links.iter().enumerate() {
            let conductance = match &link.law {
                Law::Given(given) => *given,
                Law::Model(law) => {
                    let ends = link.between.map(|node| temperatures[node]);
                    let notes = Notes::new(cells, law.model.notes);
                    let mass = law.supply.map_or(mass, |element| through(element.into()));
                    law.conductance(ends, speeds, around.vehicle_speed, mass, notes)
                        .map_err(|e| (i, e))?
                }
            };
            circuit.links.push((link.between, conductance));
        }
        circuit.flows.clear();
        circuit
            .flows
            .extend(self.flows.iter().map(|(ends, flow)| (*ends, rate(*flow))));
        circuit.exchangers.clear();
        circuit.exchangers.extend(self.exchangers.iter().map(|e| {
            let oil = rate(e.oil);
            let coolant = around.coolant_flow.unwrap_or(e.coolant_flow) * e.coolant_heat_capacity;
            Exchange {
                from: e.from,
                to: e.to,
                oil,
                transfer: e.arrangement.transfer(e.ua, [oil, coolant]),
                coolant: around.coolant_temperature.unwrap_or(e.coolant_temperature),
            }
        }));
        Ok(())
    }
}

impl Lawful {
    pub(super) fn conductance(
        &self,
        [first, second]: [f64; 2],
        speeds: &[f64],
        vehicle_speed: f64,
        oil_flow: f64,
        notes: Notes<'_>,
    ) -> Result<f64, Undefined> {
        let oil = self.lubricant.oil_at(0.5 * (first + second));
        let at = HeatLinkAt {
            part: &self.part,
            temperature_1: first,
            temperature_2: second,
            speed: self.member.map_or(0.0, |member| speeds[member].abs()),
            vehicle_speed: vehicle_speed.abs(),
            nu: oil.nu,
            eta: oil.eta,
            rho: oil.rho,
            heat_capacity: self.lubricant.heat_capacity(oil.temperature),
            conductivity: oil.conductivity,
            oil_flow,
            notes,
        };
        let conductance = self.model.conductance(&at)?;
        if conductance.is_finite() && conductance >= 0.0 {
            Ok(conductance)
        } else {
            Err(Undefined {
                what: "conductance of a link, which is negative or not finite [W/K]",
                value: conductance,
            })
        }
    }
}

/// Adds heat to nodes in equal shares.
fn spread(watts: f64, nodes: &[usize], heat: &mut [f64]) {
    for node in nodes {
        heat[*node] += watts / nodes.len() as f64;
    }
}
