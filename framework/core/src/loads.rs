//! Bearing loads from tooth forces, weights, external forces and preload.
//!
//! Radial reactions are linear in the tangential force of each mesh and in its magnitude, so unit cases are solved once; a point
//! costs a few multiplications. The bearings that take thrust depend on its direction, and those of a pair load each other, so thrust is
//! distributed at every point.

mod beam;
mod carries;
mod induced;
mod layout;
mod pair;
mod planet_loads;
mod shaft_loads;
mod static_rating;
mod statics;
mod stiff_pair;
mod thermal_closing;
mod thrust;
mod tilt;

pub use carries::{Carries, Thrust};
pub use induced::{Induced, InducedBasis, InducedThrust};
pub use layout::{
    CrossedMesh, CylindricalMesh, Layout, LoadFault, MemberLayout, MeshLayout, PlanetBody, Section, SupportLayout,
};
pub use pair::{Pair, PairLoads, PairSpring, PairedSupport};
pub use planet_loads::{ElasticPlanets, PinForces};
pub use shaft_loads::{Group, ShaftLoads, ToothForces};
pub use static_rating::{LEAST_STATIC_SAFETY, StaticFactors, StaticRating};
pub use stiff_pair::{AngularRow, StiffPair};
pub use thermal_closing::{Mounting, ThermalClosing};
pub use tilt::{Tilt, TiltFault};

use crate::real::Points;

/// Load of one support, at one point or at several.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SupportLoad<R = f64> {
    /// Radial load. \[N\]
    pub radial: R,
    /// Axial load. \[N\]
    pub axial: R,
    /// Tilting moment. \[Nm\]
    pub tilting: R,
    /// Thrust that nothing on the member takes, signed towards +x; zero if there is none. \[N\]
    pub untaken: R,
}

impl<R: Points> SupportLoad<R> {
    /// The load at one of the points.
    pub fn at_point(&self, point: usize) -> SupportLoad {
        SupportLoad {
            radial: self.radial.at_point(point),
            axial: self.axial.at_point(point),
            tilting: self.tilting.at_point(point),
            untaken: self.untaken.at_point(point),
        }
    }
}

#[cfg(test)]
mod tests;
