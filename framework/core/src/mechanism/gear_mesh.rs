//! Loss of gear meshes.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::contact::sharing::modification::FlankModification;
use crate::description::MaterialEntry;
use crate::description::shift_sign::ShiftSign;
use crate::geometry::{Pair, PairFault, PairSpec};
use crate::loss::{Loss, Term, Undefined};
use crate::lubricant::Lubricant;
use crate::material::{Elastic, Material, reduced_modulus};
use crate::mechanism::mesh_law::mesh_laws;
use crate::mechanism::{Mechanism, described_as};
use crate::real::{Mask as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum GearMesh {}

mesh_laws! {
    GearMesh, GearMeshAt,
    /// Loss of one pair of gears in mesh. A model returns powers in the frame of the carrier.
    ///
    /// The inputs are [`GearMeshAt`], which documents each quantity with unit, source and tested range, and the part in it.
    GearMeshModel,
    /// A model of gear meshes that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses
    /// wide instructions.
    GearMeshLaw
}

/// A pair of gears as written for a single model; in a gearbox the framework fills it from `gears` and `meshes`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct PairEntry {
    /// Numbers of teeth. [-]
    #[schemars(inner(range(min = 5, max = 2000)))]
    pub z: [u32; 2],
    /// The second gear is a ring gear with internal teeth.
    #[serde(default)]
    pub internal: bool,
    /// Normal module. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub normal_module: f64,
    /// Normal pressure angle. [deg]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Helix angle at the reference circle. [deg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub helix_angle: f64,
    /// Working centre distance; default: that of the profile shifts. [mm]
    #[schemars(range(min = 0.5, max = 1e5))]
    pub centre_distance: Option<f64>,
    /// Profile shift coefficients of the first and of the second gear; for a ring gear see `profile_shift_sign`. [-]
    #[schemars(inner(range(min = -3.0, max = 3.0)))]
    pub profile_shift: Option<[f64; 2]>,
    /// Sign of the profile shift of a ring gear; required if it has one.
    pub profile_shift_sign: Option<ShiftSign>,
    /// Tip diameters; required for an internal pair. [mm]
    #[schemars(inner(range(min = 1.0, max = 1e4)))]
    pub tip_diameter: Option<[f64; 2]>,
    /// Effective face width. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: f64,
    /// Roughness and elasticity.
    #[serde(flatten)]
    pub surfaces: SurfacesEntry,
    /// Materials of both gears instead of one modulus, with all values that are needed.
    pub materials: Option<[MaterialEntry; 2]>,
    /// Modifications of the flanks of both gears, for load sharing in thin slices.
    pub modification: Option<[FlankModification; 2]>,
    /// Diameters of the bores of both gears, for `stiffness: sainsot` of thin slices. [mm]
    #[schemars(inner(range(min = 0.1, max = 1e4)))]
    pub bore: Option<[f64; 2]>,
    /// Misalignment of the flanks over the face width, positive if the end of the face opens. [um]
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub misalignment: f64,
}

/// Roughness and elasticity of the flanks of a pair that is written for a single model.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct SurfacesEntry {
    /// Arithmetic mean roughness of the flanks. [um]
    #[schemars(inner(range(min = 0.001, max = 50.0)))]
    pub ra: [f64; 2],
    /// Root mean square roughness of the flanks. [um]
    #[schemars(inner(range(min = 0.001, max = 50.0)))]
    pub rq: [f64; 2],
    /// Young's modulus of both gears. [GPa]
    #[serde(default = "steel")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub elastic_modulus: f64,
    /// Poisson's ratio of both gears. [-]
    #[serde(default = "steel_poisson")]
    #[schemars(range(min = 0.0, max = 0.49))]
    pub poisson: f64,
}

impl SurfacesEntry {
    /// The surfaces, both gears of this metal.
    pub fn surfaces(&self) -> FlankSurfaces {
        FlankSurfaces {
            ra: self.ra,
            rq: self.rq,
            materials: [Material::metal(self.elastic_modulus, self.poisson); 2],
        }
    }
}

/// Roughness and material of the flanks of both gears. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankSurfaces {
    /// Arithmetic mean roughness. \[m\]
    pub ra: [f64; 2],
    /// Root mean square roughness. \[m\]
    pub rq: [f64; 2],
    /// Materials.
    pub materials: [Material; 2],
}

/// The materials of a pair that is written for a single model.
///
/// # Errors
/// Values that are missing, as a sentence.
fn materials_of_pair([first, second]: &[MaterialEntry; 2]) -> Result<[Material; 2], String> {
    let read = |entry: &MaterialEntry| entry.material().map_err(|(key, fault)| format!("`{key}`: {fault}"));
    Ok([read(first)?, read(second)?])
}

/// Young's modulus of steel. \[Pa\]
pub fn steel() -> f64 {
    206e9
}

/// Poisson's ratio of steel.
pub fn steel_poisson() -> f64 {
    0.3
}

/// A pair of gears, complete.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "PairEntry")]
pub struct MeshPart {
    /// Involute geometry.
    pub pair: Pair,
    /// Arithmetic mean roughness, mean of both flanks. \[m\]
    pub ra: f64,
    /// Composite root mean square roughness of both flanks. \[m\]
    pub rq: f64,
    /// Reduced modulus, 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. \[Pa\]
    pub modulus: f64,
    /// Materials of both gears.
    pub materials: [Material; 2],
    /// Modifications of the flanks of both gears.
    pub flanks: [FlankModification; 2],
    /// Diameters of the bores of both gears, if they are stated. \[m\]
    pub bores: [Option<f64>; 2],
    /// Misalignment of the flanks over the face width, positive if the end of the face opens. \[m\]
    pub misalignment: f64,
    /// Misalignment by the deflection of the shafts per tangential force at the base circle over the face width. \[m2/N\]
    pub yielding: f64,
    /// The oil of the mesh, for models that need it at other temperatures and pressures; `None` for a single model.
    pub oil: Option<MeshOil>,
}

/// The oil of a mesh with its name.
#[derive(Debug, Clone)]
pub struct MeshOil {
    /// Id under `lubricants`.
    pub id: String,
    /// The oil.
    pub lubricant: Arc<Lubricant>,
}

/// Equal if it is the same oil, not another one with equal properties.
impl PartialEq for MeshOil {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id && Arc::ptr_eq(&self.lubricant, &other.lubricant)
    }
}

impl MeshPart {
    /// A pair with its computed geometry, from roughness of both flanks (m), Young's modulus (Pa) and Poisson's ratio.
    pub fn new(pair: Pair, ra: [f64; 2], rq: [f64; 2], elastic_modulus: f64, poisson: f64) -> Self {
        let materials = [Material::metal(elastic_modulus, poisson); 2];
        Self::of_surfaces(pair, FlankSurfaces { ra, rq, materials })
    }

    /// A pair with its computed geometry and its surfaces.
    pub fn of_surfaces(pair: Pair, FlankSurfaces { ra, rq, materials }: FlankSurfaces) -> Self {
        Self {
            pair,
            ra: 0.5 * (ra[0] + ra[1]),
            rq: rq[0].hypot(rq[1]),
            modulus: reduced_modulus(materials.map(|material| material.elastic)),
            materials,
            flanks: [FlankModification::default(); 2],
            bores: [None; 2],
            misalignment: 0.0,
            yielding: 0.0,
            oil: None,
        }
    }

    /// Elastic constants of both gears.
    pub fn elastic(&self) -> [Elastic; 2] {
        self.materials.map(|material| material.elastic)
    }

    /// The first plastic of both gears.
    pub fn plastic(&self) -> Option<&Material> {
        self.materials.iter().find(|material| material.kind.is_plastic())
    }

    /// The pair with modified flanks and a misalignment over the face width. \[m\]
    pub fn with_flanks(self, flanks: [FlankModification; 2], misalignment: f64) -> Self {
        Self {
            flanks,
            misalignment,
            ..self
        }
    }

    /// The pair misaligned by its shafts in addition: without torque, and per tangential force at the base circle over the face width.
    /// \[m, m2/N\]
    pub fn leaning(self, constant: f64, per_line_load: f64) -> Self {
        Self {
            misalignment: self.misalignment + constant,
            yielding: per_line_load,
            ..self
        }
    }

    /// Misalignment of the flanks over the face width under a tangential force at the base circle over the face width. \[m and N/m\]
    pub fn misalignment_under(&self, line_load: f64) -> f64 {
        self.misalignment + self.yielding * line_load
    }

    /// The pair with the diameters of the bores of both gears. \[m\]
    pub fn with_bores(self, bores: [Option<f64>; 2]) -> Self {
        Self { bores, ..self }
    }

    /// The pair with its oil.
    pub fn with_oil(self, oil: Option<MeshOil>) -> Self {
        Self { oil, ..self }
    }
}

impl MeshPart {
    /// FZG C gears, for a single model.
    ///
    /// # Errors
    /// None occur: the geometry is valid.
    pub fn fzg_c() -> Result<Self, String> {
        let pair = Pair::new(&PairSpec {
            z: [16, 24],
            internal: false,
            normal_module: 4.5e-3,
            pressure_angle: 20.0_f64.to_radians(),
            helix_angle: 0.0,
            centre_distance: Some(91.5e-3),
            profile_shift: [None, None],
            tip_diameter: [Some(82.636e-3), Some(118.544e-3)],
            root_diameter: [None, None],
            facewidth: 14e-3,
            tip_shortening: true,
        })
        .map_err(|faults| faults.iter().map(PairFault::to_string).collect::<Vec<_>>().join("; "))?;
        Ok(Self::new(pair, [0.4e-6; 2], [0.5e-6; 2], steel(), steel_poisson()))
    }
}

described_as!(MeshPart, PairEntry);

impl TryFrom<PairEntry> for MeshPart {
    type Error = String;

    fn try_from(entry: PairEntry) -> Result<Self, String> {
        let mut profile_shift = entry.profile_shift.map_or([None, None], |x| x.map(Some));
        if let (true, Some([_, x2])) = (entry.internal, entry.profile_shift) {
            if entry.profile_shift_sign.is_none() && x2 != 0.0 {
                return Err(
                    "the profile shift of a ring gear requires its sign: write `profile_shift_sign: iso21771`, \
                            or `outward` where positive is away from the axis"
                        .to_owned(),
                );
            }
            profile_shift[1] = Some(ShiftSign::standard(entry.profile_shift_sign, x2));
        }
        let pair = Pair::new(&PairSpec {
            z: entry.z,
            internal: entry.internal,
            normal_module: entry.normal_module,
            pressure_angle: entry.pressure_angle,
            helix_angle: entry.helix_angle,
            centre_distance: entry.centre_distance,
            profile_shift,
            tip_diameter: entry.tip_diameter.map_or([None, None], |d| d.map(Some)),
            root_diameter: [None, None],
            facewidth: entry.facewidth,
            tip_shortening: true,
        })
        .map_err(|faults| faults.iter().map(PairFault::to_string).collect::<Vec<_>>().join("; "))?;
        let flanks = entry.modification.unwrap_or_default();
        let mut surfaces = entry.surfaces.surfaces();
        if let Some(materials) = &entry.materials {
            surfaces.materials = materials_of_pair(materials)?;
        }
        let part = Self::of_surfaces(pair, surfaces);
        let bores = entry.bore.map_or([None; 2], |bores| bores.map(Some));
        Ok(part.with_flanks(flanks, entry.misalignment).with_bores(bores))
    }
}

context! {
    /// All inputs of a mesh model: one mesh, in the frame of its carrier.
    pub struct GearMeshAt of GearMesh {
        /// Magnitude of the torque of one mesh on the first gear. [Nm]
        torque: 50.0 in 0.0..=5000.0 from "the power flow, reduced by upstream losses unless it is ideal; of the most loaded planet, by `load_sharing`",
        /// Speed of the first gear relative to the carrier, signed. [rpm]
        speed: 3000.0 in -30000.0..=30000.0 from "kinematics",
        /// One if the first gear drives, zero if the second does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        ..oil of contacts from "the oil of the mesh",
        /// One if a thermal network provides the gear temperatures, zero if the model computes them. [-]
        bodies_known: 0.0 in 0.0..=1.0 from "the thermal network",
        /// Body temperature of the first gear, if known. [degC]
        temperature_1: 80.0 in -40.0..=200.0 from "the node of the first gear",
        /// Body temperature of the second gear, if known. [degC]
        temperature_2: 80.0 in -40.0..=200.0 from "the node of the second gear",
    }
}

impl<R: Real> GearMeshAt<'_, R> {
    /// Body temperatures of both gears, if known. \[degC\]
    ///
    /// # Errors
    /// If they are known at some points only.
    pub fn bodies(&self) -> Result<Option<[R; 2]>, Undefined> {
        let known = self.bodies_known.is_above(R::HALF).agreed()?;
        Ok(known.then_some([self.temperature_1, self.temperature_2]))
    }
}

impl Mechanism for GearMesh {
    const KEY: &'static str = "gear_mesh";
    const MEANING: &'static str = "Loss of a pair of gears in mesh.";
    const ANSWER: &'static str = "Power lost in the mesh. [W]";
    const EXAMPLE: &'static str = "{ z: [16, 24], normal_module: 4.5 mm, pressure_angle: 20 deg, centre_distance: 91.5 mm, \
facewidth: 14 mm, tip_diameter: [82.636 mm, 118.544 mm], ra: [0.4 um, 0.4 um], rq: [0.5 um, 0.5 um] }";
    const TOTAL: Term = Term::load("total");
    type Part = MeshPart;
    type At<'a, R: Real> = GearMeshAt<'a, R>;
    type Answer = Loss;
    type Model = dyn GearMeshModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

crate::register_mechanism!(GearMesh);
