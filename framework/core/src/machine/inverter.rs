//! Losses of a two-level inverter with three phases: a constant efficiency, a map, or values of the data sheet.
//!
//! Conduction with sine modulation, I the peak of the phase current, pf the power factor, m the modulation, six of each:
//!
//! - transistor V0 I (1/(2 pi) + m pf/8) + r I2 (1/8 + m pf/(3 pi)),
//! - diode Vd I (1/(2 pi) - m pf/8) + rd I2 (1/8 - m pf/(3 pi)),
//! - MOSFET with synchronous rectification 3 R I_rms2 for all six.
//!
//! Switching: f (E_on + E_off)/pi (I/I_n) (U/U_n)^kv, and f E_rr/pi (I/I_n)^ki (U/U_n)^kd, six of each.
//! Sources: Casanellas 1994 and the integrals themselves, which tests repeat; the exponents are recalled.

use std::f64::consts::{PI, SQRT_2, TAU};
use std::sync::Arc;

use super::entry::{BridgeEntry, CurrentEntry};
use super::loss_of_efficiency;
use crate::motor::{MotorAt, MotorMap, PhaseCurrent};
use crate::table::clamped;

/// The losses of an inverter.
#[derive(Debug, Clone)]
pub(super) enum Inverter {
    Efficiency(f64),
    Map(Arc<MotorMap>),
    Bridge(Box<Bridge>),
}

/// An inverter by the data sheet of its semiconductors.
#[derive(Debug, Clone)]
pub(super) struct Bridge {
    pub entry: BridgeEntry,
    pub conduction: Conduction,
    /// Of the DC link. \[V\]
    pub voltage: f64,
}

/// Lines through the curves of the semiconductors. \[V, ohm\]
#[derive(Debug, Clone, Copy)]
pub(super) enum Conduction {
    Bipolar { transistor: [f64; 2], diode: [f64; 2] },
    Channel(f64),
}

impl Inverter {
    /// Loss at a state of the machine and a power at its terminals \[W\]; true if it is outside of what is known. \[W\]
    pub fn loss(&self, at: &MotorAt, power: f64, machine: Option<&MotorMap>) -> (f64, bool) {
        match self {
            Self::Efficiency(efficiency) => (loss_of_efficiency(*efficiency, power), false),
            Self::Map(map) => {
                let read = map.loss_at(at);
                (read.loss, read.outside)
            }
            Self::Bridge(bridge) => {
                let (phase, outside) = match (&bridge.entry.current, machine.and_then(|map| map.phase(at))) {
                    (_, Some(phase)) => (phase, false),
                    (Some(current), None) => current.phase(at),
                    // Refused when the machine is built.
                    (None, None) => (
                        PhaseCurrent {
                            current: 0.0,
                            power_factor: 0.0,
                            modulation: 0.0,
                        },
                        true,
                    ),
                };
                (bridge.loss(&phase), outside)
            }
        }
    }
}

impl CurrentEntry {
    /// The phase current at a state, and whether the field must be weakened by a current that is not known.
    fn phase(&self, at: &MotorAt) -> (PhaseCurrent, bool) {
        let speed = at.speed.abs();
        let with_torque = at.torque.abs() * self.current / self.torque;
        let weakens = speed > self.base_speed;
        let weakening = if weakens && !self.field_weakening.is_empty() {
            let speeds: Vec<f64> = self.field_weakening.iter().map(|at| at.speed).collect();
            let currents: Vec<f64> = self.field_weakening.iter().map(|at| at.current).collect();
            clamped(&speeds, &currents, speed)
        } else {
            0.0
        };
        let phase = PhaseCurrent {
            current: with_torque.hypot(weakening),
            power_factor: if at.speed * at.torque < 0.0 {
                -self.power_factor
            } else {
                self.power_factor
            },
            modulation: self.modulation * (speed / self.base_speed).min(1.0),
        };
        (phase, weakens && self.field_weakening.is_empty())
    }
}

impl Bridge {
    /// Loss of all six switches. \[W\]
    pub fn loss(&self, phase: &PhaseCurrent) -> f64 {
        let peak = SQRT_2 * phase.current;
        let swing = phase.modulation * phase.power_factor;
        let conduction = match self.conduction {
            Conduction::Channel(resistance) => 3.0 * resistance * phase.current * phase.current,
            Conduction::Bipolar { transistor, diode } => {
                let branch = |[voltage, resistance]: [f64; 2], swing: f64| {
                    voltage * peak * (1.0 / TAU + swing / 8.0) + resistance * peak * peak * (0.125 + swing / (3.0 * PI))
                };
                6.0 * (branch(transistor, swing) + branch(diode, -swing))
            }
        };
        let e = &self.entry;
        // The document's hertz are turns; switchings are not.
        let frequency = e.frequency / TAU;
        let (current, voltage) = (peak / e.at_current, self.voltage / e.at_voltage);
        let switching = (e.energy_on + e.energy_off) * current * voltage.powf(e.voltage_exponent)
            + e.energy_recovery * current.powf(e.recovery_current_exponent) * voltage.powf(e.recovery_voltage_exponent);
        (conduction + 6.0 * frequency / PI * switching).max(0.0) + e.auxiliary
    }
}
