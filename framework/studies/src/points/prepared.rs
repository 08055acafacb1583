//! One point with its case, and its solution.

use gearloss_framework::evaluate::{Point, PowerFlow, Scratch, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::loss::Extent;
use gearloss_framework::transmission::{Case, Transmission};

use super::{Found, Note, OilTemperature, SelfLocking, notes, self_locking};

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
    /// The direction in which the transmission locks; absent if it does not.
    pub locking: Option<SelfLocking>,
    /// Quantities that models noted.
    pub notes: Vec<Note>,
}
