//! Electric machines at ports: losses of the machine and of its inverter, what its map contains, and how far it reaches.
//!
//! Losses are interpolated, not efficiencies, which have no value at zero power. An efficiency becomes a loss by P (1/eta - 1) while the
//! machine drives and |P| (1 - eta) while it generates. Copper losses follow R/R20 = 1 + 0.00393 (theta - 20), the coefficient of annealed
//! copper.

mod build;
pub mod entry;
mod envelope;
mod inverter;
mod state;

use std::sync::Arc;

pub use entry::{BeyondEntry, Contained, MachineEntry};
pub use envelope::{Envelope, Reached};
pub use state::{MachineEnergy, MachineState};

pub(crate) use build::{Around, machines, motors};
use inverter::Inverter;

use crate::motor::{MotorAt, MotorMap, RotorShare};
use crate::table::clamped;

/// Temperature coefficient of the resistance of copper at 20 degC. \[1/K\]
const COPPER: f64 = 0.003_93;

/// An electric machine at a port.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Path in the description.
    pub path: String,
    /// Number of its port.
    pub port: usize,
    /// Member of the port.
    pub member: usize,
    /// How its files were interpreted, in sentences.
    pub notes: Vec<String>,
    /// True for a motor of a thermal network: where the temperatures are given, it is replaced with the network.
    pub only_in_network: bool,
    /// Nodes of rotor and stator in the thermal network.
    pub nodes: Option<[usize; 2]>,
    /// Node in the thermal network that an inverter that is described apart heats.
    pub inverter_node: Option<usize>,
    /// What its map contains besides the machine.
    pub contains: Vec<Contained>,
    pub(crate) rotor_share: RotorShare,
    law: Law,
    winding: Option<entry::WindingEntry>,
    /// Losses without torque with the inverter off, over speed; `None` of a machine that is always energised. \[rad/s, W\]
    freewheel: Option<[Vec<f64>; 2]>,
    voltage: Option<f64>,
    inverter: Option<Inverter>,
    envelope: Option<Envelope>,
}

/// The losses of a machine.
#[derive(Debug, Clone)]
enum Law {
    Map(Arc<MotorMap>),
    Efficiency(f64),
}

/// Losses of a machine at a state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MachineLoss {
    /// Of the machine, with what its map contains. \[W\]
    pub machine: f64,
    /// Of an inverter that is described apart. \[W\]
    pub inverter: f64,
    /// True if the state is outside a map, whose end value is then used.
    pub outside: bool,
}

impl MachineLoss {
    /// All of it. \[W\]
    pub fn sum(&self) -> f64 {
        self.machine + self.inverter
    }
}

/// Loss of a constant efficiency at a power, whose sign is its direction. \[W\]
fn loss_of_efficiency(efficiency: f64, power: f64) -> f64 {
    if power < 0.0 {
        -power * (1.0 - efficiency)
    } else {
        power * (1.0 / efficiency - 1.0)
    }
}

impl Machine {
    /// A machine with a loss map and nothing else, at a port of a member.
    pub fn of_map(path: &str, (port, member): (usize, usize), map: MotorMap) -> Self {
        Self {
            path: path.to_owned(),
            port,
            member,
            notes: map.notes.clone(),
            only_in_network: false,
            nodes: None,
            inverter_node: None,
            contains: Vec::new(),
            rotor_share: RotorShare::default(),
            law: Law::Map(Arc::new(map)),
            winding: None,
            freewheel: None,
            voltage: None,
            inverter: None,
            envelope: None,
        }
    }

    /// Losses at a speed \[rad/s\], a torque \[Nm\] that it applies to the transmission, and a temperature of its winding \[degC\].
    pub fn loss(&self, speed: f64, torque: f64, temperature: f64) -> MachineLoss {
        if speed == 0.0 && torque == 0.0 {
            // At rest it is off.
            return MachineLoss::default();
        }
        if let Some([speeds, losses]) = self.freewheel.as_ref().filter(|_| torque == 0.0) {
            return MachineLoss {
                machine: if speeds.is_empty() {
                    0.0
                } else {
                    clamped(speeds, losses, speed.abs())
                },
                inverter: 0.0,
                outside: false,
            };
        }
        let at = MotorAt {
            speed,
            torque,
            temperature,
            voltage: self.voltage.unwrap_or_default(),
        };
        let power = speed * torque;
        let (mut machine, mut outside) = match &self.law {
            Law::Map(map) => {
                let read = map.loss_at(&at);
                (read.loss, read.outside)
            }
            Law::Efficiency(efficiency) => (loss_of_efficiency(*efficiency, power), false),
        };
        if let Some(winding) = &self.winding {
            let resistance = |theta: f64| 1.0 + COPPER * (theta - 20.0);
            let ratio = resistance(temperature) / resistance(winding.temperature);
            // Below -234 degC the line is no resistance.
            machine *= 1.0 - winding.copper_share + winding.copper_share * ratio.max(0.0);
        }
        let inverter = match &self.inverter {
            None => 0.0,
            Some(inverter) => {
                let (loss, beyond) = inverter.loss(&at, power + machine, self.map());
                outside |= beyond;
                loss
            }
        };
        MachineLoss {
            machine,
            inverter,
            outside,
        }
    }

    /// Parts of a loss of the machine in rotor and stator at a speed. \[W\]
    pub fn in_rotor_and_stator(&self, speed: f64, loss: f64) -> [f64; 2] {
        let share = self.rotor_share.share_at(speed.abs()).unwrap_or(0.0);
        [share * loss, (1.0 - share) * loss]
    }

    /// Its loss map.
    pub fn map(&self) -> Option<&MotorMap> {
        match &self.law {
            Law::Map(map) => Some(map),
            Law::Efficiency(_) => None,
        }
    }

    /// Its envelope.
    pub fn envelope(&self) -> Option<&Envelope> {
        self.envelope.as_ref()
    }

    /// True if its inverter is off without torque, so that its losses there are those of `freewheel`.
    pub fn freewheels(&self) -> bool {
        self.freewheel.is_some()
    }

    /// How far a speed and a torque are beyond the map: the excess over its largest torque at the speed, and over its largest speed; zero
    /// inside. \[Nm, rad/s\]
    pub fn excess(&self, speed: f64, torque: f64) -> [f64; 2] {
        let Some(map) = self.map() else { return [0.0; 2] };
        let [most_speed, most_torque] = map.reach(speed, torque);
        [torque.abs() - most_torque, speed.abs() - most_speed].map(|excess| excess.max(0.0))
    }
}

#[cfg(test)]
mod tests;
