//! Two bearings that press against each other: axial preload, and what temperature makes of it.
//!
//! Derived: the shaft between two bearings A and B that take thrust in opposite directions moves by x towards A; at assembly both are closed by
//! d0 together, negative for end play. Fa_A(x) - Fa_B(d0 - x) = Ka has one root, because both thrusts grow with their displacements.

use super::equilibrium::{Axes, Given, Row, balance};
use super::root::root_of_growing;

/// Thrusts of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedThrust {
    /// Displacement of the shaft towards the first bearing from where that one begins to carry thrust. \[m\]
    pub displacement: f64,
    /// Thrusts of both bearings. \[N\]
    pub thrust: [f64; 2],
}

/// Shares an external thrust (N), positive onto the first bearing, between two bearings that are closed by `closing` together (m). Each one
/// gives its thrust at its own axial displacement, or `None` where it is not known. The `scale` is a displacement of usual size, from which the
/// search starts. Beyond the thrust at which one bearing lifts off, the other carries all.
pub fn share_thrust(
    bearings: [&dyn Fn(f64) -> Option<f64>; 2],
    closing: f64,
    external: f64,
    scale: f64,
) -> Option<SharedThrust> {
    let thrusts = |x: f64| Some([bearings[0](x)?, bearings[1](closing - x)?]);
    let off = |x: f64| thrusts(x).map_or(f64::NAN, |[first, second]| first - second - external);
    let displacement = root_of_growing(off, 0.5 * closing, scale, 60)?;
    Some(SharedThrust {
        displacement,
        thrust: thrusts(displacement)?,
    })
}

/// Thrust of a row at an axial displacement under a radial load, without tilt; `None` if nothing balances the radial load. \[N\]
pub fn thrust_at(row: &impl Row, radial_load: f64, axial: f64) -> Option<f64> {
    let given = Axes {
        axial: Given::Displacement(axial),
        ..Axes::loaded(0.0, radial_load)
    };
    balance(row, &given).ok().map(|found| found.load.axial)
}

/// Arrangement of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// Face to face: the lines of contact meet between the bearings.
    X,
    /// Back to back.
    O,
}

/// A pair of bearings with the temperatures of its surroundings, for the change of its closing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermal {
    /// Arrangement.
    pub arrangement: Arrangement,
    /// Mean diameters of the contacts with the outer rings. \[m\]
    pub diameter: [f64; 2],
    /// Contact angles. \[rad\]
    pub contact_angle: [f64; 2],
    /// Distance of these contacts along the axis. \[m\]
    pub distance: f64,
    /// Expansion of the shaft with inner rings and elements, and of the housing with outer rings. \[1/K\]
    pub expansion: [f64; 2],
    /// Their temperatures above that of assembly. \[K\]
    pub rise: [f64; 2],
}

impl Thermal {
    /// Change of the closing of the pair: (a_s dT_s - a_h dT_h)(D1/(2 tan a1) + D2/(2 tan a2) + s L) with s = 1 face to face, -1 back to back. \[m\]
    pub fn closing(&self) -> f64 {
        let side = match self.arrangement {
            Arrangement::X => 1.0,
            Arrangement::O => -1.0,
        };
        let growth = self.expansion[0] * self.rise[0] - self.expansion[1] * self.rise[1];
        growth * (self.neutral_distance() + side * self.distance)
    }

    /// Distance at which temperature does not change the closing of a pair back to back. \[m\]
    pub fn neutral_distance(&self) -> f64 {
        let cones = self.diameter.iter().zip(&self.contact_angle);
        cones.map(|(diameter, angle)| 0.5 * diameter / angle.tan()).sum()
    }
}
