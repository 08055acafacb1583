//! Largest torque of a machine over its speed: |T| <= min(T_max, P_max/w), for a limited time and without limit.
//!
//! The base speed is proportional to the voltage of the DC link if the resistance is neglected, so that T_max(n, U) =
//! T_max(n U_ref/U, U_ref).

use serde::{Deserialize, Serialize};

use super::entry::{BeyondEntry, EnvelopeEntry, ReachEntry};

/// The envelope of a machine; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    peak: Option<ReachEntry>,
    continuous: Option<ReachEntry>,
    /// Longest time above the continuous torque. \[s\]
    pub peak_time: Option<f64>,
    /// Voltage at which it applies over that of the DC link. \[-\]
    slower: f64,
    /// What cycles do beyond it.
    pub beyond: BeyondEntry,
}

/// What a torque reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Reached {
    /// At most the continuous torque.
    #[default]
    Continuous,
    /// More, for a limited time.
    Peak,
    /// More than the machine can.
    Beyond,
}

impl Reached {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::Peak => "peak",
            Self::Beyond => "beyond",
        }
    }
}

/// Relative excess of a torque or a speed that is rounding.
const ROUNDING: f64 = 1e-9;

impl ReachEntry {
    /// Largest torque at a speed \[rad/s\]; zero beyond the largest speed. \[Nm\]
    fn torque(&self, speed: f64, slower: f64) -> f64 {
        let speed = speed.abs();
        if self.speed.is_some_and(|most| speed > most * (1.0 + ROUNDING)) {
            return 0.0;
        }
        let scaled = speed * slower;
        if self.torque * scaled > self.power {
            self.power / scaled
        } else {
            self.torque
        }
    }
}

impl Envelope {
    /// With the voltage of the DC link.
    pub(super) fn new(entry: &EnvelopeEntry, voltage: Option<f64>) -> Self {
        let of = entry.voltage.or(voltage);
        Self {
            peak: entry.peak,
            continuous: entry.continuous,
            peak_time: entry.peak_time,
            slower: of.zip(voltage).map_or(1.0, |(of, voltage)| of / voltage),
            beyond: entry.beyond,
        }
    }

    /// Largest torque at a speed \[rad/s\]. \[Nm\]
    pub fn most(&self, speed: f64) -> f64 {
        let reach = self.peak.or(self.continuous);
        reach.map_or(f64::INFINITY, |reach| reach.torque(speed, self.slower))
    }

    /// Largest torque without limit of time at a speed \[rad/s\]. \[Nm\]
    pub fn continuous(&self, speed: f64) -> f64 {
        let reach = self.continuous;
        reach.map_or_else(|| self.most(speed), |reach| reach.torque(speed, self.slower))
    }

    /// What a torque of either sign reaches.
    pub fn reached(&self, speed: f64, torque: f64) -> Reached {
        let exceeds = |most: f64| torque.abs() > most * (1.0 + ROUNDING);
        if exceeds(self.most(speed)) {
            Reached::Beyond
        } else if exceeds(self.continuous(speed)) {
            Reached::Peak
        } else {
            Reached::Continuous
        }
    }
}
