//! Loss of bevel and hypoid meshes.
//!
//! A mesh has two pairs of flanks. Each is a [`MeshPart`], as that of cylindrical gears: two surfaces that touch along a path of contact, that of
//! the virtual cylindrical gears, with the velocities of the real ones. So the laws of tooth friction and of mean friction, the load sharing and
//! the ratings of flanks are those of cylindrical gears. What differs is that friction has an arm about the axes, because the flanks also slide
//! lengthwise: the normal force that a torque causes depends on friction, and a large one would lock the pair.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::{BevelAxes, BevelPair, BevelTeeth};
use crate::loss::{Loss, Term, Undefined};
use crate::mechanism::gear_mesh::{FlankSurfaces, GearMeshAt, MeshOil, MeshPart, SurfacesEntry};
use crate::mechanism::mesh_law::mesh_laws;
use crate::mechanism::{Mechanism, described_as, with_oil};
use crate::real::{Mask as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum BevelMesh {}

mesh_laws! {
    BevelMesh, BevelMeshAt,
    /// Loss of one pair of bevel or hypoid gears in mesh. A model returns powers.
    ///
    /// The inputs are [`BevelMeshAt`], which documents each quantity with unit, source and tested range, and the part in it.
    BevelMeshModel,
    /// A model of bevel meshes that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses
    /// wide instructions.
    BevelMeshLaw
}

/// A bevel or hypoid pair as written for a single model; in a gearbox the framework fills it from axes, gears and meshes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct BevelEntry {
    /// Numbers of teeth, the pinion first. [-]
    #[schemars(inner(range(min = 5, max = 500)))]
    pub z: [u32; 2],
    /// Angle between the axes. [deg]
    #[serde(default = "right_angle")]
    #[schemars(range(min = 1.0, max = 170.0))]
    pub shaft_angle: f64,
    /// Distance of the axes; zero for bevel gears, whose axes intersect. [mm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub offset: f64,
    /// Face width of the wheel. [mm]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub facewidth: f64,
    /// The teeth.
    #[serde(flatten)]
    pub teeth: BevelTeeth,
    /// Roughness and elasticity.
    #[serde(flatten)]
    pub surfaces: SurfacesEntry,
}

fn right_angle() -> f64 {
    std::f64::consts::FRAC_PI_2
}

/// A bevel or hypoid pair, complete.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "BevelEntry")]
pub struct BevelPart {
    /// Cones, blanks and flanks.
    pub pair: BevelPair,
    /// The drive flanks and the coast flanks, with their surfaces and the oil.
    pub flanks: [MeshPart; 2],
}

impl BevelPart {
    /// A pair with its surfaces, and the oil of the mesh.
    pub fn new(pair: BevelPair, surfaces: FlankSurfaces, oil: Option<&MeshOil>) -> Self {
        let flanks = pair.flanks;
        let flanks = flanks.map(|flanks| MeshPart::of_surfaces(flanks, surfaces).with_oil(oil.cloned()));
        Self { pair, flanks }
    }
}

described_as!(BevelPart, BevelEntry);

impl TryFrom<BevelEntry> for BevelPart {
    type Error = String;

    fn try_from(entry: BevelEntry) -> Result<Self, String> {
        let axes = BevelAxes {
            z: entry.z,
            shaft_angle: entry.shaft_angle,
            offset: entry.offset,
            facewidth: entry.facewidth,
        };
        let pair = entry.teeth.pair(&axes);
        let pair = pair.map_err(|fault| fault.to_string())?;
        Ok(Self::new(pair, entry.surfaces.surfaces(), None))
    }
}

context! {
    /// All inputs of a model of a bevel or hypoid mesh. The first gear is the pinion.
    pub struct BevelMeshAt of BevelMesh {
        /// Magnitude of the torque on the pinion that has the power of the driving gear. [Nm]
        torque: 250.0 in 0.0..=5000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Speed of the pinion, signed. [rpm]
        speed: 1200.0 in -30000.0..=30000.0 from "kinematics",
        /// One if the pinion drives, zero if the wheel does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        /// One if the drive flanks carry, the concave one of the pinion and the convex one of the wheel; zero if the coast flanks do. [-]
        drive_flank: 1.0 in 0.0..=1.0 from "the directions of torque and rotation, and the hand of the pinion",
        ..oil of contacts from "the oil of the mesh",
        /// One if a thermal network provides the gear temperatures, zero if the model computes them. [-]
        bodies_known: 0.0 in 0.0..=1.0 from "the thermal network",
        /// Body temperature of the pinion, if known. [degC]
        temperature_1: 80.0 in -40.0..=200.0 from "the node of the pinion",
        /// Body temperature of the wheel, if known. [degC]
        temperature_2: 80.0 in -40.0..=200.0 from "the node of the wheel",
    }
}

/// Friction on the flanks of a whole mesh, with the load that they share.
#[derive(Debug, Clone, Copy)]
pub struct MeshFriction<R> {
    /// Sliding power per normal force and speed of the pinion. \[m\]
    pub sliding: R,
    /// Arm of the friction force about the axis of the pinion. \[m\]
    pub arm: R,
}

impl<'a, R: Real> BevelMeshAt<'a, R> {
    /// The inputs of a pair from those of its drive flanks alone, and one where the drive flanks carry, zero where the coast flanks do.
    #[inline(always)]
    pub(crate) fn on_flanks(part: &'a BevelPart, mesh: &GearMeshAt<'a, R>, drive_flank: R) -> Self {
        with_oil!(of contacts from mesh, Self {
            part,
            torque: mesh.torque,
            speed: mesh.speed,
            first_drives: mesh.first_drives,
            drive_flank,
            bodies_known: mesh.bodies_known,
            temperature_1: mesh.temperature_1,
            temperature_2: mesh.temperature_2,
            notes: mesh.notes,
        })
    }

    /// The flanks that carry: 0 for the drive flanks, 1 for the coast flanks.
    ///
    /// # Errors
    /// If points differ in them.
    pub fn flank(&self) -> Result<usize, Undefined> {
        Ok(usize::from(!self.drive_flank.is_above(R::HALF).agreed()?))
    }

    /// The flanks that carry as a mesh, with the torque that causes their normal force without friction.
    #[inline(always)]
    pub fn on_flank(&self, flank: usize) -> GearMeshAt<'a, R> {
        with_oil!(of contacts from self, GearMeshAt {
            part: &self.part.flanks[flank],
            torque: self.torque,
            speed: self.speed,
            first_drives: self.first_drives,
            bodies_known: self.bodies_known,
            temperature_1: self.temperature_1,
            temperature_2: self.temperature_2,
            notes: self.notes,
        })
    }

    /// Normal force of the carrying flanks with friction on them. \[N\]
    ///
    /// The driving gear has the stated torque: T = F_n (a + A) if it is the pinion, F_n (a - A + S) if it is the wheel, with the arms a of the
    /// normal force and A of the friction force about the axis of the pinion, and the sliding S over its speed.
    ///
    /// # Errors
    /// If no normal force balances the torque.
    #[inline(always)]
    pub fn normal_force(&self, flank: usize, friction: &MeshFriction<R>) -> Result<R, Undefined> {
        let pair = &self.part.flanks[flank].pair;
        let arm = pair.base_radius[0] * pair.cos_base_helix;
        let by_first = friction.arm;
        let by_second = friction.sliding - friction.arm;
        let arm = R::select(self.first_drives.is_above(R::HALF), by_first, by_second) + arm;
        if !arm.is_above(R::ZERO).all() {
            return Err(Undefined {
                what: "arm of the tooth force about the driving gear's axis, so that friction locks the pair [m]",
                value: arm.extremes(1).0,
            });
        }
        Ok(self.torque / arm)
    }
}

impl Mechanism for BevelMesh {
    const KEY: &'static str = "bevel_mesh";
    const MEANING: &'static str = "Loss of a pair of bevel or hypoid gears in mesh.";
    const ANSWER: &'static str = "Power lost in the mesh. [W]";
    const EXAMPLE: &'static str = "{ z: [13, 42], offset: 15 mm, facewidth: 30 mm, outer_diameter: 170 mm, spiral_angle: 49.99814 deg, \
pressure_angle: { drive: 20 deg, coast: 20 deg, limit_factor: 1 }, cutter: { radius: 63.5 mm }, depth: { wheel_addendum: 0.35, \
addendum_angle: 1 deg, dedendum_angle: 4 deg }, ra: [0.4 um, 0.4 um], rq: [0.5 um, 0.5 um] }";
    const TOTAL: Term = Term::load("total");
    type Part = BevelPart;
    type At<'a, R: Real> = BevelMeshAt<'a, R>;
    type Answer = Loss;
    type Model = dyn BevelMeshModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

crate::register_mechanism!(BevelMesh);
