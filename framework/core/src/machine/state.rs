//! The machines of a transmission at a solved point, and their energies over an interval.

use serde::{Deserialize, Serialize};

use super::{Machine, Reached};
use crate::transmission::Transmission;

/// A machine at a solved point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MachineState {
    /// \[rad/s\]
    pub speed: f64,
    /// Torque that it applies to the transmission. \[Nm\]
    pub torque: f64,
    /// Loss of the machine, with what its map contains. \[W\]
    pub machine: f64,
    /// Loss of an inverter that is described apart. \[W\]
    pub inverter: f64,
    /// True if it is outside a map, whose end value is then used.
    pub outside: bool,
    /// What its torque reaches.
    pub reached: Reached,
}

impl MachineState {
    /// Power into the transmission. \[W\]
    pub fn shaft(&self) -> f64 {
        self.speed * self.torque
    }

    /// Power out of the DC link. \[W\]
    pub fn electric(&self) -> f64 {
        self.shaft() + self.machine + self.inverter
    }
}

/// Energies of a machine over an interval.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MachineEnergy {
    /// Into the transmission. \[J\]
    pub shaft: f64,
    /// Loss of the machine, with what its map contains. \[J\]
    pub machine: f64,
    /// Loss of an inverter that is described apart. \[J\]
    pub inverter: f64,
    /// Time outside a map. \[s\]
    pub outside: f64,
    /// Time above the continuous torque. \[s\]
    pub above_continuous: f64,
    /// Time above the envelope. \[s\]
    pub beyond: f64,
}

impl MachineEnergy {
    /// Of a state that lasts for a time. \[s\]
    pub fn lasting(state: &MachineState, time: f64) -> Self {
        let during = |is_so: bool| if is_so { time } else { 0.0 };
        Self {
            shaft: state.shaft() * time,
            machine: state.machine * time,
            inverter: state.inverter * time,
            outside: during(state.outside),
            above_continuous: during(state.reached > Reached::Continuous),
            beyond: during(state.reached == Reached::Beyond),
        }
    }

    /// Linear combination with another.
    pub(crate) fn combine(&mut self, factor: f64, more: &Self, share: f64) {
        let one = |sum: &mut f64, x: f64| *sum = factor * *sum + share * x;
        one(&mut self.shaft, more.shaft);
        one(&mut self.machine, more.machine);
        one(&mut self.inverter, more.inverter);
        let time = |sum: &mut f64, x: f64| *sum = (factor * *sum + share * x).max(0.0);
        time(&mut self.outside, more.outside);
        time(&mut self.above_continuous, more.above_continuous);
        time(&mut self.beyond, more.beyond);
    }

    /// Out of the DC link. \[J\]
    pub fn electric(&self) -> f64 {
        self.shaft + self.machine + self.inverter
    }
}

impl Transmission {
    /// The machines whose losses count: where temperatures are given, motors of the thermal network are replaced with it.
    pub fn active_machines(&self, in_network: bool) -> impl Iterator<Item = &Machine> {
        let machines = self.machines().iter().map(|machine| &**machine);
        machines.filter(move |machine| in_network || !machine.only_in_network)
    }

    /// A machine at a speed \[rad/s\], a torque \[Nm\] and the temperatures of the nodes, or of the oil alone \[degC\].
    pub fn machine_at(&self, machine: &Machine, speed: f64, torque: f64, temperatures: &[f64]) -> MachineState {
        let node = machine.nodes.map(|[_, stator]| stator);
        let oil = self.network().map(crate::thermal::network::Network::oil);
        let winding = node.or(oil).and_then(|node| temperatures.get(node));
        let winding = winding
            .or(temperatures.first())
            .copied()
            .unwrap_or(self.oil_temperature);
        let loss = machine.loss(speed, torque, winding);
        MachineState {
            speed,
            torque,
            machine: loss.machine,
            inverter: loss.inverter,
            outside: loss.outside,
            reached: machine
                .envelope()
                .map_or(Reached::Continuous, |envelope| envelope.reached(speed, torque)),
        }
    }

    /// The active machines at a point with speeds \[rad/s\] and torques of ports \[Nm\] by member, and temperatures of the nodes, or of the oil
    /// alone. \[degC\]
    pub fn machines_at(&self, speeds: &[f64], port_torques: &[f64], temperatures: &[f64]) -> Vec<MachineState> {
        let machines = self.active_machines(temperatures.len() > 1);
        let at = |machine: &Machine| {
            let member = machine.member;
            self.machine_at(machine, speeds[member], port_torques[member], temperatures)
        };
        machines.map(at).collect()
    }
}
