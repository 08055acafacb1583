//! Loss of worm drives.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::lubricant::LubricantKind;
use crate::geometry::{Holding, WormPair, WormProfile, WormSpec};
use crate::loss::{Loss, Term, Undefined};
use crate::mechanism::{Answers, Mechanism, Scalar, described_as};
use crate::real::{Dual, Lane, Points as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum WormMesh {}

/// Loss of a worm and its wheel. A model returns powers.
///
/// The inputs are [`WormMeshAt`], which documents each quantity with unit, source and tested range, and the part in it. If the wheel drives, the
/// loss may exceed its power: the pair locks itself, and the worm must be driven as well.
pub trait WormMeshModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &WormMeshAt<'_>) -> Result<Loss, Undefined>;

    /// The losses at several points together; written by a [law](WormMeshLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn losses(&self, _at: &WormMeshAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The loss with its derivatives; written by a [law](WormMeshLaw). `None` has them found by differences.
    fn loss_with_derivatives(&self, _at: &WormMeshAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        None
    }

    /// Friction of a pair at rest; `None` if the model does not know it.
    fn at_rest(&self, _part: &WormPart) -> Option<AtRest> {
        None
    }
}

/// A model of worm drives that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses wide
/// instructions.
pub trait WormMeshLaw: Send + Sync {
    /// Loss at one operating point, or at several. Pure; must not allocate.
    fn loss<R: Answers>(&self, at: &WormMeshAt<'_, R>) -> Result<Loss<R>, Undefined>;

    /// As [`WormMeshModel::at_rest`].
    fn at_rest(&self, _part: &WormPart) -> Option<AtRest> {
        None
    }
}

impl<L: WormMeshLaw> WormMeshModel for L {
    fn loss(&self, at: &WormMeshAt<'_>) -> Result<Loss, Undefined> {
        WormMeshLaw::loss(self, at)
    }

    fn losses(&self, at: &WormMeshAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || WormMeshLaw::loss(self, at),
        )
    }

    fn loss_with_derivatives(&self, at: &WormMeshAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        Some(WormMeshLaw::loss(self, at))
    }

    fn at_rest(&self, part: &WormPart) -> Option<AtRest> {
        WormMeshLaw::at_rest(self, part)
    }
}

/// A worm drive at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtRest {
    /// Coefficient of friction at rest.
    pub friction: f64,
    /// Efficiency with which the worm sets the wheel in motion, and the wheel the worm; zero or less if it cannot.
    pub efficiency: [f64; 2],
}

impl AtRest {
    /// From the coefficient of friction and the tangent of its angle of friction.
    pub fn new(pair: &WormPair, friction: f64, tan_rho: f64) -> Self {
        Self {
            friction,
            efficiency: pair.efficiencies(tan_rho),
        }
    }

    /// Whether it holds a load.
    pub fn holding(&self) -> Holding {
        Holding::of(self.efficiency[0])
    }
}

/// Material of the rim of a worm wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WheelMaterial {
    /// Tin bronze CuSn12-C-GZ, centrifugally cast.
    #[default]
    Cusn12,
    /// Tin bronze with nickel CuSn12Ni2-C-GZ or -GC.
    Cusn12ni2,
    /// Aluminium bronze CuAl10Fe5Ni5.
    Cual10fe5ni5,
    /// Cast iron with nodular graphite EN-GJS-400-15.
    EnGjs400,
    /// Grey cast iron EN-GJL-250.
    EnGjl250,
}

/// How oil comes to the mesh of a worm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WormLubrication {
    /// The worm or the wheel dips into the oil.
    #[default]
    Bath,
    /// Oil is sprayed into the mesh.
    Spray,
}

/// A worm drive as written for a single model; in a gearbox the framework fills it from `gears` and `worm_meshes`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct WormEntry {
    /// Threads of the worm and teeth of the wheel. [-]
    #[schemars(inner(range(min = 1, max = 2000)))]
    pub z: [u32; 2],
    /// Axial module of the worm. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub module: f64,
    /// Diameter factor q: reference diameter of the worm over the module; or state `worm_diameter`. [-]
    #[schemars(range(min = 3.0, max = 100.0))]
    pub diameter_factor: Option<f64>,
    /// Reference diameter of the worm instead of `diameter_factor`. [mm]
    #[schemars(range(min = 0.5, max = 2000.0))]
    pub worm_diameter: Option<f64>,
    /// Normal pressure angle. [deg]
    #[serde(default = "usual_angle")]
    #[schemars(range(min = 5.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Profile of the threads.
    #[serde(default)]
    pub profile: WormProfile,
    /// Profile shift coefficient of the wheel. [-]
    #[serde(default)]
    #[schemars(range(min = -2.0, max = 2.0))]
    pub profile_shift: f64,
    /// Face width of the wheel. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: f64,
    /// Material of the rim of the wheel.
    #[serde(default)]
    pub material: WheelMaterial,
    /// Arithmetic mean roughness of the flanks of the worm. [um]
    #[serde(default = "usual_roughness")]
    #[schemars(range(min = 0.001, max = 50.0))]
    pub ra: f64,
    /// How oil comes to the mesh.
    #[serde(default)]
    pub lubrication: WormLubrication,
    /// Kind of the oil.
    #[serde(default)]
    pub oil: LubricantKind,
}

/// Normal pressure angle of most worms. \[rad\]
pub fn usual_angle() -> f64 {
    20.0_f64.to_radians()
}

/// Roughness of a ground worm, to which DIN 3996 refers. \[m\]
pub fn usual_roughness() -> f64 {
    0.5e-6
}

/// What a gearbox describes beside the mesh, so that a model does not count it again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Described {
    /// Bearings of the shafts of worm or wheel.
    pub bearings: bool,
    /// Seals of these shafts.
    pub seals: bool,
}

impl Described {
    /// What is described on either of two shafts.
    pub fn with(self, other: Self) -> Self {
        Self {
            bearings: self.bearings || other.bearings,
            seals: self.seals || other.seals,
        }
    }
}

/// A worm drive, complete.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "WormEntry")]
pub struct WormPart {
    /// Geometry.
    pub pair: WormPair,
    /// Material of the rim of the wheel.
    pub material: WheelMaterial,
    /// Arithmetic mean roughness of the flanks of the worm. \[m\]
    pub ra: f64,
    /// How oil comes to the mesh.
    pub lubrication: WormLubrication,
    /// Kind of the oil.
    pub oil: LubricantKind,
    /// What is described beside the mesh; nothing for a single model.
    pub described: Described,
}

impl WormEntry {
    /// Reference diameter of the worm. \[m\]
    ///
    /// # Errors
    /// If it is stated twice or not at all.
    pub fn reference_diameter(
        module: f64,
        diameter_factor: Option<f64>,
        worm_diameter: Option<f64>,
    ) -> Result<f64, &'static str> {
        match (diameter_factor, worm_diameter) {
            (Some(q), None) => Ok(q * module),
            (None, Some(diameter)) => Ok(diameter),
            (Some(_), Some(_)) => Err("the diameter of the worm is stated twice"),
            (None, None) => Err("the diameter of the worm is missing: `diameter_factor` or `worm_diameter`"),
        }
    }
}

impl TryFrom<WormEntry> for WormPart {
    type Error = &'static str;

    fn try_from(entry: WormEntry) -> Result<Self, Self::Error> {
        Ok(Self {
            pair: WormPair::new(WormSpec {
                z: entry.z,
                module: entry.module,
                worm_diameter: WormEntry::reference_diameter(entry.module, entry.diameter_factor, entry.worm_diameter)?,
                pressure_angle: entry.pressure_angle,
                profile: entry.profile,
                profile_shift: entry.profile_shift,
                facewidth: entry.facewidth,
            }),
            material: entry.material,
            ra: entry.ra,
            lubrication: entry.lubrication,
            oil: entry.oil,
            described: Described::default(),
        })
    }
}

described_as!(WormPart, WormEntry);

context! {
    /// All inputs of a model of worm drives.
    pub struct WormMeshAt of WormMesh {
        /// Magnitude of the torque on the worm that has the power of the driving gear: if the wheel drives, its torque over the ratio. [Nm]
        torque: 10.0 in 0.0..=1000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Speed of the worm, signed. [rpm]
        speed: 1500.0 in -10000.0..=10000.0 from "kinematics",
        /// One if the worm drives, zero if the wheel does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        /// Temperature of the oil. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the mesh: given, balanced or a node of the network, and `temperature_offset`",
        /// Kinematic viscosity of the oil. [mm2/s]
        nu: 50.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 41.0 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of the oil. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
    } laws {
        "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
    }
}

impl<R: Real> WormMeshAt<'_, R> {
    /// Where the worm drives.
    #[inline(always)]
    pub fn worm_drives(&self) -> R::Mask {
        self.first_drives.is_above(R::HALF)
    }

    /// Sliding velocity at the reference cylinder of the worm. \[m/s\]
    #[inline(always)]
    pub fn sliding(&self) -> R {
        self.speed.abs() * self.part.pair.sliding()
    }

    /// Power of the driving gear. \[W\]
    #[inline(always)]
    pub fn input(&self) -> R {
        self.torque * self.speed.abs()
    }
}

impl Mechanism for WormMesh {
    const KEY: &'static str = "worm_mesh";
    const MEANING: &'static str = "Loss of a worm and its wheel.";
    const ANSWER: &'static str = "Power lost in the mesh. [W]";
    const EXAMPLE: &'static str = "{ z: [2, 41], module: 4 mm, diameter_factor: 9, pressure_angle: 20 deg, profile: zi, facewidth: 30 mm, \
material: cusn12, ra: 0.5 um, lubrication: bath, oil: mineral }";
    const TOTAL: Term = Term::load("total");
    type Part = WormPart;
    type At<'a, R: Real> = WormMeshAt<'a, R>;
    type Answer = Loss;
    type Model = dyn WormMeshModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

impl WormMeshModel for Scalar<WormMesh> {
    fn loss(&self, at: &WormMeshAt<'_>) -> Result<Loss, Undefined> {
        self.power(at)
    }

    fn losses(&self, at: &WormMeshAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Ok(Loss::POWERS.with(&WormMesh::TOTAL, self.values(at)?))
    }

    fn loss_with_derivatives(&self, _at: &WormMeshAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        let value = self.constant()?;
        Some(Ok(Loss::POWERS.with(&WormMesh::TOTAL, Dual::constant(value))))
    }
}

crate::register_mechanism!(WormMesh);
