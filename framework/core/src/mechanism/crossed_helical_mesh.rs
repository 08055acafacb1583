//! Loss of crossed helical meshes.
//!
//! The flanks touch in a point, with a path of contact as that of other gears ([`MeshPart`]), so the laws of tooth friction and of mean friction are
//! those of cylindrical gears. They slide lengthwise as well, so friction has an arm about the axes, and a large one locks the pair.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::Pair;
use crate::geometry::crossed::{PitchCones, TeethFault};
use crate::loss::{Loss, Term};
use crate::material::reduced_modulus;
use crate::mechanism::gear_mesh::{FlankSurfaces, GearMeshAt, MeshPart, SurfacesEntry};
use crate::mechanism::mesh_law::mesh_laws;
use crate::mechanism::{Mechanism, described_as, with_oil};
use crate::real::Real;
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum CrossedHelicalMesh {}

mesh_laws! {
    CrossedHelicalMesh, CrossedHelicalMeshAt,
    /// Loss of a pair of cylindrical gears on crossed axes. A model returns powers.
    ///
    /// The inputs are [`CrossedHelicalMeshAt`], which documents each quantity with unit, source and tested range, and the part in it. If the loss
    /// exceeds the power of the driving gear, the pair locks itself, and the other gear must be driven as well.
    CrossedHelicalMeshModel,
    /// A model of crossed helical meshes that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it
    /// uses wide instructions.
    CrossedHelicalMeshLaw
}

/// A crossed helical pair as written for a single model; in a gearbox the framework fills it from axes, gears and meshes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct CrossedHelicalEntry {
    /// Numbers of teeth. [-]
    #[schemars(inner(range(min = 1, max = 2000)))]
    pub z: [u32; 2],
    /// Normal module. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub normal_module: f64,
    /// Normal pressure angle. [deg]
    #[serde(default = "usual_angle")]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Helix angles, positive for right-hand gears; their sum is the angle between the axes. [deg]
    #[schemars(inner(range(min = -85.0, max = 85.0)))]
    pub helix_angle: [f64; 2],
    /// Tip diameters; default: an addendum of one normal module. [mm]
    #[schemars(inner(range(min = 1.0, max = 1e4)))]
    pub tip_diameter: Option<[f64; 2]>,
    /// Roughness and elasticity.
    #[serde(flatten)]
    pub surfaces: SurfacesEntry,
}

fn usual_angle() -> f64 {
    20.0_f64.to_radians()
}

/// A crossed helical pair, complete.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "CrossedHelicalEntry")]
pub struct CrossedHelicalPart {
    /// The flanks, with their surfaces and the oil.
    pub flanks: MeshPart,
    /// Sliding over the speed of the first gear at the pitch point, and the part of the first flank's velocity in its direction. \[m\]
    pub at_pitch: [f64; 2],
}

impl CrossedHelicalPart {
    /// A pair with its cylinders, normal pressure angle, tip radii and surfaces. SI.
    ///
    /// # Errors
    /// All faults that make the teeth impossible.
    pub fn new(
        cylinders: &PitchCones,
        (pressure_angle, tip_radius): (f64, [f64; 2]),
        surfaces: FlankSurfaces,
    ) -> Result<Self, Vec<TeethFault>> {
        let modulus = reduced_modulus(surfaces.materials.map(|material| material.elastic));
        let pair = Pair::crossed_helical(cylinders, pressure_angle, tip_radius, modulus)?;
        let motion = pair.crossed.as_ref();
        let at_pitch = motion.map_or([0.0; 2], |motion| [motion.sliding_speed(0.0), motion.friction_arm(0.0)]);
        Ok(Self {
            flanks: MeshPart::of_surfaces(pair, surfaces),
            at_pitch,
        })
    }
}

described_as!(CrossedHelicalPart, CrossedHelicalEntry);

impl TryFrom<CrossedHelicalEntry> for CrossedHelicalPart {
    type Error = String;

    fn try_from(entry: CrossedHelicalEntry) -> Result<Self, String> {
        let [first, second] = entry.helix_angle;
        // The frame has a right-hand first gear, or the mirror image of the pair.
        let mirror = if first + second < 0.0 { -1.0 } else { 1.0 };
        let cylinders = PitchCones::cylinders(entry.z, entry.normal_module, [mirror * first, -mirror * second]);
        if cylinders.shaft_angle.abs() < 1e-3 {
            return Err("the axes are parallel: the helix angles add up to the angle between them".to_owned());
        }
        let tips = cylinders.radius.map(|r| r + entry.normal_module);
        let tips = entry.tip_diameter.map_or(tips, |tips| tips.map(|d| 0.5 * d));
        Self::new(&cylinders, (entry.pressure_angle, tips), entry.surfaces.surfaces())
            .map_err(|faults| faults.iter().map(TeethFault::to_string).collect::<Vec<_>>().join("; "))
    }
}

context! {
    /// All inputs of a model of a crossed helical mesh.
    pub struct CrossedHelicalMeshAt of CrossedHelicalMesh {
        /// Magnitude of the torque on the first gear that has the power of the driving gear. [Nm]
        torque: 10.0 in 0.0..=1000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Speed of the first gear, signed. [rpm]
        speed: 1000.0 in -20000.0..=20000.0 from "kinematics",
        /// One if the first gear drives, zero if the second does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        ..oil of contacts from "the oil of the mesh",
    }
}

impl<'a, R: Real> CrossedHelicalMeshAt<'a, R> {
    /// The inputs of a pair from those of its flanks.
    #[inline(always)]
    pub(crate) fn of_flanks(part: &'a CrossedHelicalPart, mesh: &GearMeshAt<'a, R>) -> Self {
        with_oil!(of contacts from mesh, Self {
            part,
            torque: mesh.torque,
            speed: mesh.speed,
            first_drives: mesh.first_drives,
            notes: mesh.notes,
        })
    }

    /// The flanks as a mesh, with the torque that causes their normal force without friction.
    #[inline(always)]
    pub fn flanks(&self) -> GearMeshAt<'a, R> {
        with_oil!(of contacts from self, GearMeshAt {
            part: &self.part.flanks,
            torque: self.torque,
            speed: self.speed,
            first_drives: self.first_drives,
            bodies_known: R::ZERO,
            temperature_1: self.temperature,
            temperature_2: self.temperature,
            notes: self.notes,
        })
    }

    /// Arm of the torque of the driving gear for a unit of normal force, over the speed of the first gear, with sliding power and friction arm of
    /// friction on the flanks. Positive for any friction. \[m\]
    #[inline(always)]
    pub fn arm(&self, sliding: R, friction_arm: R) -> R {
        let arm = self.part.flanks.pair.base_radius[0];
        R::select(
            self.first_drives.is_above(R::HALF),
            friction_arm,
            sliding - friction_arm,
        ) + arm
    }
}

impl Mechanism for CrossedHelicalMesh {
    const KEY: &'static str = "crossed_helical_mesh";
    const MEANING: &'static str = "Loss of a pair of cylindrical gears on crossed axes.";
    const ANSWER: &'static str = "Power lost in the mesh. [W]";
    const EXAMPLE: &'static str = "{ z: [15, 30], normal_module: 3 mm, pressure_angle: 20 deg, helix_angle: [45 deg, 45 deg], ra: [0.4 um, 0.4 um], \
rq: [0.5 um, 0.5 um] }";
    const TOTAL: Term = Term::load("total");
    type Part = CrossedHelicalPart;
    type At<'a, R: Real> = CrossedHelicalMeshAt<'a, R>;
    type Answer = Loss;
    type Model = dyn CrossedHelicalMeshModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

crate::register_mechanism!(CrossedHelicalMesh);
