//! Machines outside their loss maps at solved points.

use gearloss_framework::machine::Machine;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use crate::numbers::{RPM, tidy};
use crate::points::PointResult;

/// A machine that is outside a map at some points, where the end value of the map is used.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MachineOutside {
    /// Path of the machine.
    pub machine: String,
    /// Number of points. [-]
    pub points: usize,
    /// Torque at the point that is farthest outside its own map. [Nm]
    pub torque_nm: f64,
    /// Speed there. [rpm]
    pub speed_rpm: f64,
    /// Torque beyond the largest of the map at this speed; zero inside. [Nm]
    pub torque_beyond_nm: f64,
    /// Speed beyond the largest of the map; zero inside. [rpm]
    pub speed_beyond_rpm: f64,
}

impl MachineOutside {
    /// The machines that are outside at some points.
    pub fn of<'p>(t: &Transmission, points: impl Iterator<Item = &'p PointResult>) -> Vec<Self> {
        let mut all = Vec::new();
        if t.machines().is_empty() {
            return all;
        }
        for point in points {
            let machines = t.active_machines(point.nodes.len() > 1).zip(&point.machines);
            let outside = machines.filter(|(_, state)| state.outside);
            let one = outside.map(|(machine, state)| Self::at(machine, [state.torque, state.speed]));
            Self::merge(&mut all, one);
        }
        all
    }

    /// At one point with a torque \[Nm\] and a speed \[rad/s\].
    fn at(machine: &Machine, [torque, speed]: [f64; 2]) -> Self {
        Self::beyond(machine, [torque, speed], machine.excess(speed, torque))
    }

    /// At one point with a torque and a speed, and by how much they are beyond. \[Nm, rad/s\]
    pub(crate) fn beyond(
        machine: &Machine,
        [torque, speed]: [f64; 2],
        [torque_beyond_nm, speed_beyond]: [f64; 2],
    ) -> Self {
        Self {
            machine: machine.path.clone(),
            points: 1,
            torque_nm: torque,
            speed_rpm: tidy(speed * RPM),
            torque_beyond_nm,
            speed_beyond_rpm: tidy(speed_beyond * RPM),
        }
    }

    /// Adds other points.
    pub fn merge(all: &mut Vec<Self>, more: impl IntoIterator<Item = Self>) {
        for more in more {
            match all.iter_mut().find(|known| known.machine == more.machine) {
                Some(known) => {
                    let points = known.points + more.points;
                    // Of equal ones the least torque and speed, whatever the order of the points.
                    let order = |at: &Self| [-at.size(), at.torque_nm, at.speed_rpm];
                    if order(&more) < order(known) {
                        *known = more;
                    }
                    known.points = points;
                }
                None => all.push(more),
            }
        }
    }

    /// How far it is outside, by the power that the excess has.
    pub fn size(&self) -> f64 {
        self.torque_beyond_nm * self.speed_rpm.abs() + self.speed_beyond_rpm * self.torque_nm.abs()
    }

    /// Where it is beyond something, and how far, for a finding.
    pub(crate) fn words(&self, beyond: &str) -> String {
        let place = if self.size() > 0.0 {
            let excess = beyond_words(self.torque_beyond_nm, self.speed_beyond_rpm);
            format!(
                ", farthest with {:.1} Nm at {:.0} rpm{excess}",
                self.torque_nm, self.speed_rpm
            )
        } else {
            String::new()
        };
        let points = if self.points == 1 { "point" } else { "points" };
        format!("`{}` is {beyond} at {} {points}{place}", self.machine, self.points)
    }
}

/// Torque (Nm) and speed (rpm) beyond a map, as the end of a sentence.
fn beyond_words(torque: f64, speed: f64) -> String {
    let mut words = String::new();
    if torque > 0.0 {
        words.push_str(&format!(", {torque:.1} Nm above its largest torque there"));
    }
    if speed > 0.0 {
        words.push_str(&format!(", {speed:.0} rpm above its largest speed"));
    }
    words
}
