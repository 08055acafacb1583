//! Gears and meshes with their geometry and members, as the other modules of a transmission refer to them.

use std::sync::Arc;

use super::crossed::CrossedTeeth;
use super::members::Members;
use crate::description::MeshMetal;
use crate::geometry::Pair;
use crate::material::Material;

/// A gear with its geometry; SI.
#[derive(Debug, Clone)]
pub struct GearSeat {
    /// Id.
    pub id: String,
    /// Member that it rotates with.
    pub member: usize,
    /// Middle of the face width along the shaft; of gears on axes that cross the position of their mean point. \[m\]
    pub at: f64,
    /// Position of the largest tip circle along the shaft: that of a bevel gear is at its outer end. \[m\]
    pub tip_at: f64,
    /// Number of teeth.
    pub z: u32,
    /// Face width. \[m\]
    pub facewidth: f64,
    /// Internal teeth.
    pub ring: bool,
    /// Reference, tip and root diameter; zero without a mesh. \[m\]
    pub diameters: [f64; 3],
    /// Material, if it names one.
    pub material: Option<Material>,
}

/// The materials of two gears; of one that names none a metal of the mesh's modulus (Pa) and Poisson's ratio.
pub(crate) fn materials_of(gears: &[GearSeat], pair: [usize; 2], metal: MeshMetal) -> [Material; 2] {
    let of_mesh = || Material::metal(metal.elastic_modulus, metal.poisson);
    pair.map(|gear| gears[gear].material.unwrap_or_else(of_mesh))
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
    pub teeth: Teeth,
    /// Roughness Ra of both flanks. \[m\]
    pub ra: [f64; 2],
    /// Roughness Rq of both flanks. \[m\]
    pub rq: [f64; 2],
}

/// Teeth in mesh.
#[derive(Debug, Clone)]
pub(crate) enum Teeth {
    /// Cylindrical gears on parallel axes.
    Cylindrical(Box<CylindricalTeeth>),
    /// Gears on axes that cross.
    Crossed(Arc<CrossedTeeth>),
}

/// Teeth of cylindrical gears on parallel axes.
#[derive(Debug, Clone)]
pub(crate) struct CylindricalTeeth {
    /// Geometry.
    pub pair: Pair,
    /// Hand of the first gear: one right, minus one left, zero without net thrust.
    pub hand: f64,
    /// Unit vector across the axes, in the frame of their direction (y and z of axes along x), from the axis of the first gear to the contact.
    pub direction: [f64; 2],
}

impl MeshSeat {
    /// Teeth of cylindrical gears.
    pub fn cylindrical(&self) -> Option<&CylindricalTeeth> {
        match &self.teeth {
            Teeth::Cylindrical(teeth) => Some(teeth),
            Teeth::Crossed(_) => None,
        }
    }

    /// Teeth of gears on axes that cross.
    pub fn crossed(&self) -> Option<&Arc<CrossedTeeth>> {
        match &self.teeth {
            Teeth::Cylindrical(_) => None,
            Teeth::Crossed(teeth) => Some(teeth),
        }
    }

    /// True if the second gear is a ring gear.
    pub fn internal(&self) -> bool {
        self.cylindrical().is_some_and(|teeth| teeth.pair.internal)
    }

    /// Numbers of teeth.
    pub fn z(&self) -> [u32; 2] {
        match &self.teeth {
            Teeth::Cylindrical(teeth) => teeth.pair.z,
            Teeth::Crossed(teeth) => teeth.cones.z,
        }
    }

    /// Sign of the second number of teeth in the constraint of speeds.
    pub fn sign(&self) -> f64 {
        match &self.teeth {
            Teeth::Cylindrical(teeth) => teeth.pair.sign(),
            Teeth::Crossed(teeth) => teeth.sign(),
        }
    }

    /// Radius at which the tangential force of the first gear acts. \[m\]
    pub fn radius(&self) -> f64 {
        match &self.teeth {
            Teeth::Cylindrical(teeth) => teeth.pair.working_radius[0],
            Teeth::Crossed(teeth) => teeth.cones.radius[0],
        }
    }
}

/// Orbit radius of a planet body; `None` if it meshes with no gear on the central axis. \[m\]
pub fn orbit(body: usize, members: &Members, meshes: &[MeshSeat]) -> Option<f64> {
    meshes
        .iter()
        .filter(|m| m.members.contains(&body) && !m.members.iter().all(|b| members.planets[*b].is_some()))
        .find_map(|m| Some(m.cylindrical()?.pair.centre_distance))
}
