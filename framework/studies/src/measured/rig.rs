//! The rig of a measurement: offsets of its meters, drag of its bearings, and accuracy of its instruments.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The rig of a measurement. `in` is the reference port of the gearbox, `out` its other port; torques at `out` are positive if they leave a
/// driven transmission.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct RigEntry {
    /// Offset of the torque meter at `in`. [Nm]
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub torque_offset_in: f64,
    /// Offset of the torque meter at `out`. [Nm]
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub torque_offset_out: f64,
    /// All bearings of the rig between the torque meter and the transmission at `in`.
    #[serde(default)]
    pub support_in: SupportLossEntry,
    /// All bearings of the rig between the transmission and the torque meter at `out`.
    #[serde(default)]
    pub support_out: SupportLossEntry,
    /// Accuracy of the torque meter at `in`.
    pub torque_in: Option<TorqueMeterEntry>,
    /// Accuracy of the torque meter at `out`.
    pub torque_out: Option<TorqueMeterEntry>,
    /// Accuracy of the speed at `in`. [rpm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed_in: f64,
    /// Accuracy of the speed at `out`. [rpm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub speed_out: f64,
    /// Accuracy of the oil temperature. [K]
    #[schemars(range(min = 1e-6, max = 1000.0))]
    pub oil_temperature: Option<f64>,
}

/// Drag of bearings of a rig: the torque at one speed, proportional to a power of the speed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct SupportLossEntry {
    /// Drag torque at `speed`. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub torque: f64,
    /// Reference speed of the drag torque. [rpm]
    #[serde(default = "stated_speed")]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub speed: f64,
    /// Exponent of the speed: 0 for a constant torque, 2/3 for lubricated bearings, 1 for a viscous torque. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub exponent: f64,
}

impl Default for SupportLossEntry {
    fn default() -> Self {
        Self {
            torque: 0.0,
            speed: stated_speed(),
            exponent: 0.0,
        }
    }
}

/// 1000 rpm. \[rad/s\]
fn stated_speed() -> f64 {
    1000.0 * std::f64::consts::PI / 30.0
}

impl SupportLossEntry {
    /// Drag torque at a speed in rad/s, against the rotation. \[Nm\]
    fn drag(self, speed: f64) -> f64 {
        let share = (speed / self.speed).abs();
        if share == 0.0 {
            0.0
        } else {
            self.torque * share.powf(self.exponent) * speed.signum()
        }
    }
}

/// Accuracy of a torque meter: independent contributions, added as squares.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct TorqueMeterEntry {
    /// Full scale torque. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub full_scale: f64,
    /// Accuracy in percent of the full scale, as for an accuracy class. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_full_scale: f64,
    /// Accuracy in percent of the torque. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_torque: f64,
    /// Accuracy independent of the torque. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub absolute: f64,
}

impl TorqueMeterEntry {
    /// Stated accuracy at a torque. \[Nm\]
    fn accuracy_at(self, torque: f64) -> f64 {
        let scale = 0.01 * self.percent_of_full_scale * self.full_scale;
        self.absolute.hypot(0.01 * self.percent_of_torque * torque).hypot(scale)
    }
}

/// Meaning of a stated accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StatedAs {
    /// Maximum error, as for an accuracy class, with uniform distribution: the standard deviation is 1/sqrt(3) of it.
    #[default]
    Limit,
    /// The standard deviation.
    Standard,
    /// The standard deviation times the coverage factor.
    Expanded,
}

impl StatedAs {
    /// Divisor from a stated accuracy to a standard deviation. \[-\]
    pub fn divisor(self, coverage_factor: f64) -> f64 {
        match self {
            Self::Limit => 3.0_f64.sqrt(),
            Self::Standard => 1.0,
            Self::Expanded => coverage_factor,
        }
    }
}

/// Contribution of the rig to the measured torques.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rig {
    /// Offsets of the meters at `in` and `out`. \[Nm\]
    pub offset: [f64; 2],
    /// Bearings of the rig at `in` and `out`.
    pub support: [SupportLossEntry; 2],
}

/// Speeds of `in` and `out`. \[rad/s\]
pub type PortSpeeds = [f64; 2];

impl Rig {
    /// From an entry.
    pub fn from_entry(entry: &RigEntry) -> Self {
        Self {
            offset: [entry.torque_offset_in, entry.torque_offset_out],
            support: [entry.support_in, entry.support_out],
        }
    }

    /// Whether it has no contribution.
    pub fn is_silent(&self) -> bool {
        !self.at_in() && !self.at_out()
    }

    fn at_in(&self) -> bool {
        self.offset[0] != 0.0 || self.support[0].torque != 0.0
    }

    /// Whether it has a contribution at `out`.
    pub fn at_out(&self) -> bool {
        self.offset[1] != 0.0 || self.support[1].torque != 0.0
    }

    /// Contribution to the torques applied to the transmission at `in` and `out`. \[Nm\]
    ///
    /// The meter at `out` is positive if power leaves a driven transmission: the torque applied to the transmission has the opposite sign,
    /// or the same sign if the transmission reverses the direction of rotation.
    pub fn added(&self, [input, output]: PortSpeeds) -> [f64; 2] {
        let sense = if input == 0.0 { 1.0 } else { input.signum() } * if output == 0.0 { 1.0 } else { output.signum() };
        [
            self.offset[0] + self.support[0].drag(input),
            self.support[1].drag(output) - sense * self.offset[1],
        ]
    }

    /// Contribution to the measured loss. \[W\]
    pub fn power(&self, speeds: PortSpeeds) -> f64 {
        let [input, output] = self.added(speeds);
        input * speeds[0] + output * speeds[1]
    }
}

/// Standard deviations of instruments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruments {
    /// Torque meters at `in` and `out`, as stated.
    torque: [TorqueMeterEntry; 2],
    /// Speeds at `in` and `out`, as stated. \[rad/s\]
    speed: [f64; 2],
    /// Divisor of both.
    divisor: f64,
}

/// A point as measured by the instruments: torques and speeds of `in` and `out` as magnitudes, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Powers {
    /// Torques. \[Nm\]
    pub torque: [f64; 2],
    /// Speeds. \[rad/s\]
    pub speed: [f64; 2],
    /// Index of the input port: 0 is `in`.
    pub driven: usize,
}

impl Instruments {
    /// From a rig with both torque meters.
    pub fn from_entry(entry: &RigEntry, divisor: f64) -> Option<Self> {
        let torque = [entry.torque_in?, entry.torque_out?];
        let speed = [entry.speed_in, entry.speed_out];
        Some(Self { torque, speed, divisor })
    }

    /// Standard deviation of the torque at a port. \[Nm\]
    pub fn torque(&self, port: usize, torque: f64) -> f64 {
        self.torque[port].accuracy_at(torque) / self.divisor
    }

    fn of_ports(&self, at: &Powers) -> [(f64, f64); 2] {
        [0, 1].map(|k| (self.torque(k, at.torque[k]), self.speed[k] / self.divisor))
    }

    /// Standard deviation of the loss from both torques and speeds. \[W\]
    pub fn loss(&self, at: &Powers) -> f64 {
        let ports = self.of_ports(at);
        let of = |k: usize| (at.speed[k] * ports[k].0).hypot(at.torque[k] * ports[k].1);
        of(0).hypot(of(1))
    }

    /// Standard deviation of the loss torque at `in`. \[Nm\]
    pub fn loss_torque(&self, at: &Powers, loss_torque: f64) -> f64 {
        let ports = self.of_ports(at);
        let ratio = at.speed[1] / at.speed[0];
        // The loss torque is T1 + i T2 with the speed ratio i, T2 as magnitude with the opposite sign: an error of w1 changes only the
        // ratio.
        let other = (at.torque[0] - loss_torque).abs();
        let torques = ports[0].0.hypot(ratio * ports[1].0);
        torques
            .hypot(other * ports[0].1 / at.speed[0])
            .hypot(ratio * at.torque[1] * ports[1].1 / at.speed[1])
    }

    /// Standard deviation of an efficiency. \[-\]
    pub fn efficiency(&self, at: &Powers, efficiency: f64) -> f64 {
        let ports = self.of_ports(at);
        let of = |k: usize| (ports[k].0 / at.torque[k]).hypot(ports[k].1 / at.speed[k]);
        efficiency * of(0).hypot(of(1))
    }

    /// Whether the torque at the input port is below three of its standard deviations: its efficiency is then meaningless.
    pub fn drowns(&self, at: &Powers) -> bool {
        let port = at.driven;
        at.torque[port] < 3.0 * self.torque(port, at.torque[port])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meters_and_bearings_add_torque_and_power() {
        let rig = Rig {
            offset: [0.03, 0.2],
            support: [
                SupportLossEntry {
                    torque: 0.01,
                    speed: 100.0,
                    exponent: 1.0,
                },
                SupportLossEntry {
                    torque: 0.05,
                    ..SupportLossEntry::default()
                },
            ],
        };
        // A reduction by ten that keeps the sense: both ports turn forward, the torque at the output is negative.
        let [input, output] = rig.added([1000.0, 100.0]);
        assert!((input - (0.03 + 0.1)).abs() < 1e-15 && (output - (0.05 - 0.2)).abs() < 1e-15);
        assert!((rig.power([1000.0, 100.0]) - (130.0 - 15.0)).abs() < 1e-12);
        // With the sense turned the meter at the output still counts what leaves as positive.
        let [_, output] = rig.added([1000.0, -100.0]);
        assert!((output - (-0.05 + 0.2)).abs() < 1e-15);
        assert!((rig.power([1000.0, -100.0]) - (130.0 - 15.0)).abs() < 1e-12);
        // Bearings of the rig brake at either sense, an offset keeps its sign.
        assert!((rig.power([-1000.0, -100.0]) - (-30.0 + 100.0 + 20.0 + 5.0)).abs() < 1e-12);
        assert!(Rig::default().is_silent() && !rig.is_silent() && rig.at_out());
        assert!(rig.added([0.0, 0.0]).iter().all(|t| t.is_finite()));
    }

    #[test]
    fn accuracies_follow_from_those_of_the_instruments() {
        let meter = |full_scale: f64| TorqueMeterEntry {
            full_scale,
            percent_of_full_scale: 0.05,
            percent_of_torque: 0.0,
            absolute: 0.0,
        };
        let entry = RigEntry {
            torque_in: Some(meter(50.0)),
            torque_out: Some(meter(500.0)),
            ..RigEntry::default()
        };
        let instruments = Instruments::from_entry(&entry, StatedAs::Limit.divisor(2.0)).expect("both are stated");
        let at = Powers {
            torque: [10.0, 98.0],
            speed: [1000.0, 100.0],
            driven: 0,
        };
        let (s1, s2) = (0.025 / 3.0_f64.sqrt(), 0.25 / 3.0_f64.sqrt());
        assert!((instruments.loss(&at) - (1000.0 * s1).hypot(100.0 * s2)).abs() < 1e-12);
        // 200 W of 10 kW at 1000 rad/s: 0.2 Nm.
        assert!((instruments.loss_torque(&at, 0.2) - instruments.loss(&at) / 1000.0).abs() < 1e-15);
        let eta = instruments.efficiency(&at, 0.98);
        assert!((eta - 0.98 * (s1 / 10.0).hypot(s2 / 98.0)).abs() < 1e-15);
        // An error of one speed moves the loss torque by the whole torque, the loss by torque times it.
        let turning = RigEntry {
            speed_out: 0.1,
            ..entry
        };
        let turning = Instruments::from_entry(&turning, 1.0).expect("both are stated");
        assert!((turning.loss_torque(&at, 0.2) - turning.loss(&at) / 1000.0).abs() < 1e-12);
        assert!(!turning.drowns(&at));
        let small = Powers {
            torque: [0.05, 0.0],
            ..at
        };
        assert!(turning.drowns(&small));
        assert!(
            (StatedAs::Expanded.divisor(2.0) - 2.0).abs() < 1e-15
                && (StatedAs::Standard.divisor(2.0) - 1.0).abs() < 1e-15
        );
    }
}
