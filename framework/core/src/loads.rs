//! Bearing loads from tooth forces, weights, external forces and preload.
//!
//! Radial reactions are linear in the tangential force of each mesh and in its magnitude, so unit cases are solved once; a point
//! costs a few multiplications. The bearings that take thrust depend on its direction, so thrust is distributed at every point.

mod batched;
mod beam;
mod layout;
mod shaft_loads;
mod static_rating;
mod statics;
mod thrust;

pub use batched::LoadLanes;
pub use beam::{Beam, BeamFault, BeamLoad, BeamSupport};
pub use layout::{Layout, LoadFault, MemberLayout, MeshLayout, PlanetBody, Section, SupportLayout};
pub use shaft_loads::ShaftLoads;
pub use static_rating::{LEAST_STATIC_SAFETY, StaticFactors, StaticRating};
pub use thrust::Taking;

/// Load of one support at one point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SupportLoad {
    /// Radial load. \[N\]
    pub radial: f64,
    /// Axial load. \[N\]
    pub axial: f64,
    /// Tilting moment. \[Nm\]
    pub tilting: f64,
    /// Thrust that nothing on the member takes, signed towards +x; zero if there is none. \[N\]
    pub untaken: f64,
}

#[cfg(test)]
mod tests;
