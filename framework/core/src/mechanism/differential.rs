//! Friction of the gears in a differential.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::crossed::{DepthEntry, FlankAngles, SpiralAngleOf};
use crate::description::{BevelAxes, BevelTeeth};
use crate::loss::{Loss, Notes, Term, Undefined};
use crate::material::Material;
use crate::mechanism::bevel_mesh::{BevelMeshAt, BevelPart};
use crate::mechanism::gear_mesh::{FlankSurfaces, steel, steel_poisson};
use crate::mechanism::{Answers, Mechanism, Scalar, with_oil};
use crate::real::{Dual, Lane, Points as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Differential {}

/// Friction of the gears inside a differential whose sides turn at different speeds. A model returns powers; the slower side gains the
/// torque that the faster one loses.
///
/// The inputs are [`DifferentialAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait DifferentialModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &DifferentialAt<'_>) -> Result<Loss, Undefined>;

    /// The losses at several points together; written by a [law](DifferentialLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn losses(&self, _at: &DifferentialAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The loss with its derivatives; written by a [law](DifferentialLaw). `None` has them found by differences.
    fn loss_with_derivatives(&self, _at: &DifferentialAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        None
    }
}

/// A model of differentials that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses
/// wide instructions.
pub trait DifferentialLaw: Send + Sync {
    /// Loss at one operating point, or at several. Pure; must not allocate.
    fn loss<R: Answers>(&self, at: &DifferentialAt<'_, R>) -> Result<Loss<R>, Undefined>;
}

impl<L: DifferentialLaw> DifferentialModel for L {
    fn loss(&self, at: &DifferentialAt<'_>) -> Result<Loss, Undefined> {
        DifferentialLaw::loss(self, at)
    }

    fn losses(&self, at: &DifferentialAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || DifferentialLaw::loss(self, at),
        )
    }

    fn loss_with_derivatives(&self, at: &DifferentialAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        Some(DifferentialLaw::loss(self, at))
    }
}

/// A side gear of a bevel differential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SideGear {
    /// Number of teeth. [-]
    #[schemars(range(min = 5, max = 200))]
    pub z: u32,
    /// Mean pitch radius. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub radius: f64,
    /// Mean radius of the thrust washer between side gear and case. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub washer_radius: f64,
}

/// A pinion of a bevel differential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PinionGear {
    /// Number of teeth. [-]
    #[schemars(range(min = 5, max = 200))]
    pub z: u32,
    /// Mean radius of the seat or washer between the back of the pinion and the case. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub seat_radius: f64,
    /// Radius of the pin, the cross or the spider on which the pinion turns. [mm]
    #[schemars(range(min = 0.5, max = 1000.0))]
    pub pin_radius: f64,
}

/// Teeth of the gears of a differential, for models that evaluate their meshes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DifferentialTeeth {
    /// Number of pinions, which share the torque equally. [-]
    #[schemars(range(min = 1, max = 8))]
    pub pinions: u32,
    /// Face width of the gears. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub facewidth: f64,
    /// Arithmetic mean roughness of the flanks. [um]
    #[schemars(range(min = 0.01, max = 20.0))]
    pub ra: f64,
}

/// The straight bevel gears of a differential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DifferentialGears {
    /// Both side gears.
    pub side: SideGear,
    /// The pinions; the friction does not depend on their number.
    pub pinion: PinionGear,
    /// Pressure angle of the teeth. [deg]
    #[serde(default = "usual_pressure_angle")]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Their teeth, for models that evaluate their meshes.
    pub teeth: Option<DifferentialTeeth>,
}

impl DifferentialGears {
    /// A pinion with a side gear, of steel: straight teeth of the usual depth.
    ///
    /// # Errors
    /// Why there is no such pair.
    pub fn mesh(&self, teeth: &DifferentialTeeth) -> Result<BevelPart, String> {
        let written = BevelTeeth {
            outer_diameter: None,
            outer_module: None,
            mean_diameter: Some(2.0 * self.side.radius),
            spiral_angle: 0.0,
            spiral_angle_of: SpiralAngleOf::Pinion,
            pressure_angle: FlankAngles {
                drive: self.pressure_angle,
                coast: self.pressure_angle,
                limit_factor: 0.0,
            },
            method: None,
            cutter: None,
            calculation_point: None,
            wheel_pitch_angle: None,
            depth: DepthEntry::default(),
        };
        let axes = BevelAxes {
            z: [self.pinion.z, self.side.z],
            shaft_angle: std::f64::consts::FRAC_PI_2,
            offset: 0.0,
            facewidth: teeth.facewidth,
        };
        let pair = written.pair(&axes).map_err(|fault| fault.to_string())?;
        let surfaces = FlankSurfaces {
            ra: [teeth.ra; 2],
            // As of gears that state none.
            rq: [1.25 * teeth.ra; 2],
            materials: [Material::metal(steel(), steel_poisson()); 2],
        };
        Ok(BevelPart::new(pair, surfaces, None))
    }
}

/// That of many differentials with few teeth is 22.5 deg; that of the basic rack is the default. \[rad\]
fn usual_pressure_angle() -> f64 {
    20.0_f64.to_radians()
}

/// A differential.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DifferentialPart {
    /// The gears inside, for models of their friction.
    pub gears: Option<DifferentialGears>,
}

context! {
    /// All inputs of a differential model, in the frame of the case.
    pub struct DifferentialAt of Differential {
        /// Magnitude of the torque of the side gear that drives in the frame of the case, the one with the larger torque. [Nm]
        torque: 500.0 in 0.0..=50000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Speed of the left side relative to the case, signed: half the difference of the speeds of both sides. [rpm]
        speed: 50.0 in -3000.0..=3000.0 from "kinematics and `speed_difference`",
        /// One if the left side drives in the frame of the case, zero if the right one does. [-]
        left_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        /// Speed of the case, signed. [rpm]
        case_speed: 800.0 in -10000.0..=10000.0 from "kinematics",
        ..oil of contacts from "`lubricant` of the differential or the oil of the housing",
    }
}

impl<R: Real> DifferentialAt<'_, R> {
    /// The inputs of a model of the mesh of a pinion with a side gear: torque on the pinion, speed of the pinion in the case, and whether the pinion
    /// drives.
    #[inline(always)]
    pub fn mesh_at<'b>(
        &self,
        part: &'b BevelPart,
        (torque, speed, pinion_drives): (R, R, bool),
        notes: Notes<'b, R>,
    ) -> BevelMeshAt<'b, R> {
        with_oil!(of contacts from self, BevelMeshAt {
            part,
            torque,
            speed,
            first_drives: R::constant(f64::from(u8::from(pinion_drives))),
            // Straight flanks are equal.
            drive_flank: R::constant(1.0),
            bodies_known: R::ZERO,
            temperature_1: self.temperature,
            temperature_2: self.temperature,
            notes,
        })
    }
}

impl Mechanism for Differential {
    const KEY: &'static str = "differential";
    const MEANING: &'static str = "Friction of the gears in a differential whose sides turn at different speeds.";
    const ANSWER: &'static str = "Power lost in the differential. [W]";
    const EXAMPLE: &'static str = "{ gears: { side: { z: 16, radius: 30 mm, washer_radius: 28 mm }, \
pinion: { z: 10, seat_radius: 16 mm, pin_radius: 8 mm }, pressure_angle: 20 deg, teeth: { pinions: 2, facewidth: 14 mm, ra: 0.8 um } } }";
    const TOTAL: Term = Term::load("total");
    type Part = DifferentialPart;
    type At<'a, R: Real> = DifferentialAt<'a, R>;
    type Answer = Loss;
    type Model = dyn DifferentialModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

impl DifferentialModel for Scalar<Differential> {
    fn loss(&self, at: &DifferentialAt<'_>) -> Result<Loss, Undefined> {
        self.power(at)
    }

    fn losses(&self, at: &DifferentialAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Ok(Loss::POWERS.with(&Differential::TOTAL, self.values(at)?))
    }

    fn loss_with_derivatives(&self, _at: &DifferentialAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        let value = self.constant()?;
        Some(Ok(Loss::POWERS.with(&Differential::TOTAL, Dual::constant(value))))
    }
}

crate::register_mechanism!(Differential);
