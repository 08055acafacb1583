//! One point with its case, and its solution.

use gearloss_framework::evaluate::{Point, PowerFlow, Scratch, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::loss::Extent;
use gearloss_framework::machine::{Machine, MachineState};
use gearloss_framework::transmission::{Case, Transmission};

use super::{Found, Note, OilTemperature, SelfLocking, UnitPoint, notes, self_locking};

/// A point with its case.
pub struct PreparedPoint {
    /// Gear state and given quantities.
    pub case: Case,
    /// Name of the gear state.
    pub gear: String,
    /// Given speeds. \[rad/s\]
    pub speeds: Vec<f64>,
    /// Given torques. \[Nm\]
    pub torques: Vec<f64>,
    /// Temperature of the oil.
    pub oil: OilTemperature,
    /// Real or ideal power flow.
    pub flow: PowerFlow,
}

impl PreparedPoint {
    /// The point with the default tolerance.
    pub fn point(&self) -> Point<'_> {
        Point {
            speeds: &self.speeds,
            torques: &self.torques,
            flow: self.flow,
            tolerance: Tolerance::default(),
            inclination: 0.0,
        }
    }

    /// Finds the temperatures and solves the point.
    pub fn solve<'a>(&'a self, transmission: &'a Transmission, scratch: &'a mut Scratch) -> SolvedPoint<'a> {
        let point = self.point();
        let found = self.oil.find(transmission, &self.case, &point, scratch);
        // Notes of heat paths count over all points; here there is one.
        let of_heat = scratch.totals.clone();
        let solution = transmission.evaluate(&self.case, &point, found.temperatures(), scratch);
        let extents: Vec<Extent> = of_heat
            .iter()
            .zip(solution.extents())
            .map(|(heat, seen)| heat.merge(seen))
            .collect();
        SolvedPoint {
            machines: if found.is_sound() {
                machines(transmission, &solution, found.temperatures())
            } else {
                Vec::new()
            },
            locking: self_locking(transmission, self, &solution, found.temperatures()),
            notes: notes(transmission, &extents),
            solution,
            found,
        }
    }
}

/// A solved point.
pub struct SolvedPoint<'a> {
    /// Temperatures.
    pub found: Found,
    /// Speeds, torques, loads and losses.
    pub solution: Solution<'a>,
    /// The active machines; empty without any.
    pub machines: Vec<(String, MachineState)>,
    /// The direction in which the transmission locks; absent if it does not.
    pub locking: Option<SelfLocking>,
    /// Quantities that models noted.
    pub notes: Vec<Note>,
}

impl SolvedPoint<'_> {
    /// The drive unit; absent without machines, and without a loss.
    pub fn unit(&self) -> Option<UnitPoint> {
        unit(&self.machines, &self.solution)
    }
}

fn unit(machines: &[(String, MachineState)], solution: &Solution<'_>) -> Option<UnitPoint> {
    let machines: Vec<MachineState> = machines.iter().map(|(_, state)| *state).collect();
    UnitPoint::new(&machines, solution.loss()?)
}

/// The drive unit of a solution at temperatures \[degC\]; absent without machines, and without a loss.
pub fn unit_of(t: &Transmission, solution: &Solution<'_>, temperatures: &[f64]) -> Option<UnitPoint> {
    unit(&machines(t, solution, temperatures), solution)
}

/// The active machines of a solved point with their paths.
fn machines(t: &Transmission, solution: &Solution<'_>, temperatures: &[f64]) -> Vec<(String, MachineState)> {
    if !solution.has_flow() {
        return Vec::new();
    }
    let at = |machine: &Machine| {
        let (speed, torque) = (solution.speed(machine.member), solution.port_torque(machine.member));
        (machine.path.clone(), t.machine_at(machine, speed, torque, temperatures))
    };
    t.active_machines(temperatures.len() > 1).map(at).collect()
}
