//! Gears and meshes with their geometry and members, as the other modules of a transmission refer to them.

use super::members::Members;
use crate::geometry::Pair;

/// A gear with its geometry; SI.
#[derive(Debug, Clone)]
pub struct GearSeat {
    /// Id.
    pub id: String,
    /// Member that it rotates with.
    pub member: usize,
    /// Middle of the face width along the shafts. \[m\]
    pub at: f64,
    /// Number of teeth.
    pub z: u32,
    /// Face width. \[m\]
    pub facewidth: f64,
    /// Internal teeth.
    pub ring: bool,
    /// Reference, tip and root diameter; zero without a mesh. \[m\]
    pub diameters: [f64; 3],
}

/// A mesh with its members; SI.
#[derive(Debug, Clone)]
pub(crate) struct MeshSeat {
    /// Path, such as `meshes.M1`.
    pub path: String,
    /// Numbers of both gears.
    pub gears: [usize; 2],
    /// Members of both gears.
    pub members: [usize; 2],
    /// Member that is the carrier; `None` for axes fixed in the housing.
    pub carrier: Option<usize>,
    /// Number of equal copies.
    pub count: f64,
    /// Geometry.
    pub pair: Pair,
    /// Hand of the first gear: one right, minus one left, zero without net thrust.
    pub hand: f64,
    /// Unit vector in y and z from the axis of the first gear to the contact.
    pub direction: [f64; 2],
    /// Roughness Ra of both flanks. \[m\]
    pub ra: [f64; 2],
    /// Roughness Rq of both flanks. \[m\]
    pub rq: [f64; 2],
}

/// Orbit radius of a planet body; `None` if it meshes with no gear on the central axis. \[m\]
pub fn orbit(body: usize, members: &Members, meshes: &[MeshSeat]) -> Option<f64> {
    meshes
        .iter()
        .find(|m| m.members.contains(&body) && !m.members.iter().all(|b| members.planets[*b].is_some()))
        .map(|m| m.pair.centre_distance)
}
