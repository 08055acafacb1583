//! Friction of bearings: rolling bearings, plain bearings, thrust washers.

mod clearance_class;
mod film;
mod grease;
mod internal;

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attach::{Stiffness, Support, SupportSite};
use crate::loads::{AngularRow, Carries, Induced, StaticFactors, StaticRating, Thrust};
use crate::loss::{Loss, Notes, Term, Undefined};
use crate::maker::bare;
use crate::mechanism::{Component, Mechanism, Scalar, described_as};
use crate::real::{Dual, Lane, Points, Real};
use crate::resolve::basic_designation;
use crate::{answered_by, context};

pub use film::BearingFilm;
pub use grease::BearingGrease;
pub use internal::{ElementMaterial, ElementRow, Elements, InternalGeometry};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Bearing {}

/// Friction of one bearing. A model returns moments about the bearing's axis.
///
/// The inputs are [`BearingAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait BearingModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate. Values that depend only on speed and oil may be computed in
    /// [`BearingAt::once`], which skips them in all iterations of a point but the first.
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined>;

    /// The losses at several points together; written by a [law](BearingLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn losses(&self, _at: &BearingAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The loss with its derivatives; written by a [law](BearingLaw). `None` has them found by differences.
    fn loss_with_derivatives(&self, _at: &BearingAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        None
    }
}

/// A model of bearings that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses wide
/// instructions.
pub trait BearingLaw: Send + Sync {
    /// Loss at one operating point, or at several. Pure; must not allocate.
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined>;
}

impl<L: BearingLaw> BearingModel for L {
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined> {
        BearingLaw::loss(self, at)
    }

    fn losses(&self, at: &BearingAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || BearingLaw::loss(self, at),
        )
    }

    fn loss_with_derivatives(&self, at: &BearingAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        Some(BearingLaw::loss(self, at))
    }
}

/// Kind of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BearingKind {
    /// Deep groove ball bearing, single row.
    DeepGrooveBall,
    /// Deep groove ball bearing, double row.
    DeepGrooveBallDoubleRow,
    /// Self-aligning ball bearing.
    SelfAligningBall,
    /// Angular contact ball bearing, single row.
    AngularContactBall,
    /// Angular contact ball bearing, double row or a matched pair.
    AngularContactBallDoubleRow,
    /// Four-point contact ball bearing.
    FourPointContactBall,
    /// Thrust ball bearing.
    ThrustBall,
    /// Cylindrical roller bearing with a cage.
    CylindricalRoller,
    /// Cylindrical roller bearing, full complement.
    CylindricalRollerFullComplement,
    /// Needle roller and cage assembly or needle roller bearing.
    NeedleCage,
    /// Tapered roller bearing.
    TaperedRoller,
    /// Spherical roller bearing.
    SphericalRoller,
    /// Toroidal roller bearing (CARB) with a cage.
    ToroidalRoller,
    /// Toroidal roller bearing (CARB), full complement.
    ToroidalRollerFullComplement,
    /// Cylindrical roller thrust bearing.
    CylindricalRollerThrust,
    /// Needle roller thrust bearing.
    NeedleRollerThrust,
    /// Spherical roller thrust bearing.
    SphericalRollerThrust,
    /// Plain journal bearing: a shaft in a bush, with oil between them.
    Plain,
    /// Thrust washer or thrust pads: plane faces with oil between them.
    ThrustWasher,
}

/// Lubrication of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Lubrication {
    /// Oil bath: the level comes from the housing's oil or from `oil_height`.
    #[default]
    Bath,
    /// Oil jet.
    Jet,
    /// Oil and air, oil spot or oil mist.
    OilAir,
    /// Grease; its base oil is the `lubricant` of the bearing.
    Grease,
}

/// Seals or shields of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BearingSeals {
    /// Their design.
    pub design: SealDesign,
    /// One or two. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 2))]
    pub number: u32,
}

fn two() -> u32 {
    2
}

/// Design of the seals of a bearing, by the suffixes of SKF; those of other makers are similar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SealDesign {
    /// Contact seal with a steel insert: RS1; RSR, DU, LU of others.
    Rs1,
    /// Contact seal in a recess of the inner ring: RSH.
    Rsh,
    /// Contact seal of low friction: RSL.
    Rsl,
    /// Contact seal of a cylindrical roller bearing: LS.
    Ls,
    /// Contact seal of a spherical or toroidal roller bearing: CS.
    Cs,
    /// Non-contact seal: RZ; VV, LB of others.
    NonContact,
    /// Shield: Z.
    Shield,
}

impl SealDesign {
    /// Whether the seals touch.
    pub fn is_contact(self) -> bool {
        !matches!(self, Self::NonContact | Self::Shield)
    }
}

/// Class of the radial internal clearance (DIN 620-4, ISO 5753).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ClearanceClass {
    /// Less than C2.
    C1,
    /// Less than normal.
    C2,
    /// Normal.
    Cn,
    /// Greater than normal.
    C3,
    /// Greater than C3.
    C4,
    /// Greater than C4.
    C5,
}

/// A bearing as written; omitted keys come from the catalogue by `designation`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct BearingEntry {
    /// Designation in a bearing catalogue; fills the omitted keys.
    #[schemars(extend("x-refers-to" = "catalogue", "x-also-called" = ["type", "name"]))]
    pub designation: Option<String>,
    /// Kind of the bearing.
    #[schemars(extend("x-also-called" = ["type"]))]
    pub kind: Option<BearingKind>,
    /// Dimension series, as in the tables of the loss models.
    pub series: Option<String>,
    /// Bore diameter; inside diameter of the raceway for a needle roller and cage assembly, of the running surface for a plain bearing or a
    /// thrust washer. [mm]
    #[schemars(range(min = 0.5, max = 3000.0))]
    pub bore: Option<f64>,
    /// Outside diameter; outside diameter of the raceway for a needle roller and cage assembly, of the running surface for a thrust washer. Not
    /// needed for a plain bearing. [mm]
    #[schemars(range(min = 1.0, max = 5000.0))]
    pub outside: Option<f64>,
    /// Width; total width of a tapered roller bearing, of the running surface for a plain bearing. [mm]
    #[schemars(range(min = 0.5, max = 2000.0))]
    pub width: Option<f64>,
    /// Basic static load rating. [N]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub c0: Option<f64>,
    /// Basic dynamic load rating. [N]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub c: Option<f64>,
    /// Limit of the ratio of axial to radial load. [-]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub e: Option<f64>,
    /// Axial factor of the dynamic equivalent load. [-]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub y: Option<f64>,
    /// Axial factor of the static equivalent load. [-]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub y0: Option<f64>,
    /// Contact angle; default of an angular contact ball bearing: that of its designation. From it or from `y` follows the thrust that the
    /// radial load of an angular contact ball or tapered roller bearing induces; no model uses that of other kinds. [deg]
    #[schemars(range(min = 1.0, max = 89.0))]
    pub contact_angle: Option<f64>,
    /// Fatigue load limit; for ratings. [N]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub pu: Option<f64>,
    /// Calculation factor f0 of the catalogue, from which the axial factor of a deep groove ball bearing follows; for ratings. Unlike f0
    /// of friction models. [-]
    #[schemars(range(min = 1.0, max = 30.0))]
    pub calculation_factor: Option<f64>,
    /// Minimum load factor k_r of the catalogue; for ratings. [-]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub minimum_load_factor: Option<f64>,
    /// Thermal reference speed of the catalogue; for ratings. [rpm]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub reference_speed: Option<f64>,
    /// Limiting speed of the catalogue; for ratings. [rpm]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub limiting_speed: Option<f64>,
    /// Seals or shields of the bearing; default: from the designation, none. Only the model `skf` has their friction.
    pub seals: Option<BearingSeals>,
    /// Class of the radial internal clearance; default: from the designation. Estimates `internal.clearance`.
    pub clearance: Option<ClearanceClass>,
    /// Internal geometry, for the model `contact` and for ratings from the load distribution; default: estimated from the boundary dimensions.
    pub internal: Option<InternalGeometry>,
    /// Radius of the lowest point of the outer raceway. [mm]
    #[schemars(range(min = 0.5, max = 2500.0))]
    pub raceway: Option<f64>,
    /// Oil height above the lowest point of the outer raceway, if the bearing has a separate oil pocket. [mm]
    #[schemars(range(min = 0.0, max = 2000.0))]
    pub oil_height: Option<f64>,
    /// Lubrication.
    #[serde(default)]
    pub lubrication: Lubrication,
    /// Grease in the bearing, for `lubrication: grease`.
    pub grease: Option<BearingGrease>,
    /// Oil film of a plain bearing or a thrust washer.
    pub film: Option<BearingFilm>,
}

/// A bearing, complete. Lengths in m, loads in N.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "BearingEntry")]
pub struct BearingPart {
    /// Designation, if any.
    pub designation: Option<String>,
    /// Kind.
    pub kind: BearingKind,
    /// Dimension series, if known.
    pub series: Option<String>,
    /// Bore diameter d. \[m\]
    pub bore: f64,
    /// Outside diameter D; that of the bore if a plain bearing states none. \[m\]
    pub outside: f64,
    /// Width B. \[m\]
    pub width: Option<f64>,
    /// Static load rating. \[N\]
    pub c0: Option<f64>,
    /// Dynamic load rating. \[N\]
    pub c: Option<f64>,
    /// Limit of Fa/Fr.
    pub e: Option<f64>,
    /// Axial factor Y.
    pub y: Option<f64>,
    /// Axial factor Y0.
    pub y0: Option<f64>,
    /// Contact angle. \[rad\]
    pub contact_angle: Option<f64>,
    /// Fatigue load limit. \[N\]
    pub pu: Option<f64>,
    /// Calculation factor f0 of the catalogue.
    pub calculation_factor: Option<f64>,
    /// Minimum load factor k_r of the catalogue.
    pub minimum_load_factor: Option<f64>,
    /// Thermal reference speed. \[rad/s\]
    pub reference_speed: Option<f64>,
    /// Limiting speed. \[rad/s\]
    pub limiting_speed: Option<f64>,
    /// Seals or shields.
    pub seals: Option<BearingSeals>,
    /// Class of the radial internal clearance, if known.
    pub clearance: Option<ClearanceClass>,
    /// Internal geometry as stated.
    pub internal: Option<InternalGeometry>,
    /// Radius of the lowest point of the outer raceway. \[m\]
    pub raceway: f64,
    /// Separate oil height above the raceway's lowest point. \[m\]
    pub oil_height: Option<f64>,
    /// Lubrication.
    pub lubrication: Lubrication,
    /// Grease in the bearing, as stated.
    pub grease: Option<BearingGrease>,
    /// Oil film; of plain bearings, with a relative clearance and the film thickness at which the surfaces touch, and of thrust washers, with
    /// a gap.
    pub film: Option<BearingFilm>,
}

impl BearingPart {
    /// Factor of the churning of grease on viscous friction; one without grease.
    pub fn churning(&self) -> f64 {
        self.grease.and_then(|grease| grease.churning).unwrap_or(1.0)
    }

    /// Mean diameter d_m = (d + D)/2. \[m\]
    pub fn mean_diameter(&self) -> f64 {
        0.5 * (self.bore + self.outside)
    }

    /// Factors of the equivalent static load P0 according to ISO 76:2006. `None` for kinds whose factors depend on an internal
    /// geometry that is not stated.
    pub fn static_factors(&self) -> Option<StaticFactors> {
        let (x0, y0) = match self.kind {
            BearingKind::DeepGrooveBall | BearingKind::DeepGrooveBallDoubleRow => (0.6, 0.5),
            BearingKind::CylindricalRoller
            | BearingKind::CylindricalRollerFullComplement
            | BearingKind::NeedleCage
            | BearingKind::ToroidalRoller
            | BearingKind::ToroidalRollerFullComplement => (1.0, 0.0),
            // For ball bearings Y0 is 0.26 at a contact angle of 40 degrees, 0.38 at 25.
            BearingKind::TaperedRoller | BearingKind::AngularContactBall => (0.5, self.y0?),
            BearingKind::SphericalRoller | BearingKind::SelfAligningBall => (1.0, self.y0?),
            // A contact angle of 90 degrees: thrust only.
            BearingKind::ThrustBall | BearingKind::CylindricalRollerThrust | BearingKind::NeedleRollerThrust => {
                return Some(StaticFactors {
                    radial: 0.0,
                    axial: 1.0,
                    least: 0.0,
                });
            }
            _ => return None,
        };
        Some(StaticFactors::radial(x0, y0))
    }

    /// The loads that the bearing can carry, by its kind, and by the beginning of its designation where that states the flanges (ISO 5753,
    /// DIN 5412) or the number of directions.
    pub fn carries(&self) -> Carries {
        let designation = bare(self.designation.as_deref().unwrap_or_default());
        let begins = |with: &[&str]| with.iter().any(|start| designation.starts_with(start));
        let single_direction = || {
            if begins(&[
                "511", "512", "513", "514", "532", "533", "534", "811", "812", "893", "894", "292", "293", "294",
            ]) {
                Thrust::OneDirection
            } else {
                Thrust::Both
            }
        };
        let thrust = match self.kind {
            BearingKind::NeedleCage
            | BearingKind::ToroidalRoller
            | BearingKind::ToroidalRollerFullComplement
            | BearingKind::Plain => Thrust::None,
            BearingKind::CylindricalRoller | BearingKind::CylindricalRollerFullComplement => match () {
                () if begins(&["NNCF", "NCF", "NJ", "NF"]) => Thrust::OneDirection,
                () if begins(&[
                    "NNCL", "NU1", "NU2", "NU3", "NU4", "RN", "N1", "N2", "N3", "N4", "NN3", "NN4", "NNU",
                ]) =>
                {
                    Thrust::None
                }
                () => Thrust::Both,
            },
            BearingKind::AngularContactBall | BearingKind::TaperedRoller | BearingKind::ThrustWasher => {
                Thrust::OneDirection
            }
            BearingKind::ThrustBall
            | BearingKind::CylindricalRollerThrust
            | BearingKind::NeedleRollerThrust
            | BearingKind::SphericalRollerThrust => single_direction(),
            BearingKind::DeepGrooveBall
            | BearingKind::DeepGrooveBallDoubleRow
            | BearingKind::SelfAligningBall
            | BearingKind::AngularContactBallDoubleRow
            | BearingKind::FourPointContactBall
            | BearingKind::SphericalRoller => Thrust::Both,
        };
        Carries {
            // A contact angle of 90 degrees; spherical roller thrust bearings have about 50 degrees.
            radial: !self.kind.is_thrust() || self.kind == BearingKind::SphericalRollerThrust,
            thrust,
        }
    }

    /// The thrust that a radial load induces. The rows of double-row bearings balance each other; spherical roller thrust bearings are not
    /// known here.
    pub fn induced(&self) -> Induced {
        match self.kind {
            BearingKind::TaperedRoller => Induced::of_tapered_roller(self.y, self.contact_angle),
            BearingKind::AngularContactBall => Induced::of_angular_contact_ball(self.contact_angle),
            _ => Induced::None,
        }
    }

    /// Static load rating with the factors of P0; `None` if one of them is not known.
    pub fn static_rating(&self) -> Option<StaticRating> {
        Some(StaticRating {
            c0: self.c0?,
            factors: self.static_factors()?,
        })
    }
}

impl BearingKind {
    /// True if its rolling elements are balls, with contact in points; other rolling bearings have rollers, with contact in lines.
    pub fn has_balls(self) -> bool {
        match self {
            Self::DeepGrooveBall
            | Self::DeepGrooveBallDoubleRow
            | Self::SelfAligningBall
            | Self::AngularContactBall
            | Self::AngularContactBallDoubleRow
            | Self::FourPointContactBall
            | Self::ThrustBall => true,
            Self::CylindricalRoller
            | Self::CylindricalRollerFullComplement
            | Self::NeedleCage
            | Self::TaperedRoller
            | Self::SphericalRoller
            | Self::ToroidalRoller
            | Self::ToroidalRollerFullComplement
            | Self::CylindricalRollerThrust
            | Self::NeedleRollerThrust
            | Self::SphericalRollerThrust
            | Self::Plain
            | Self::ThrustWasher => false,
        }
    }

    /// Its name in documents.
    pub fn name(self) -> String {
        let value = serde_json::to_value(self).ok();
        value
            .as_ref()
            .and_then(|name| name.as_str())
            .unwrap_or_default()
            .to_owned()
    }

    /// True for a thrust bearing.
    pub fn is_thrust(self) -> bool {
        matches!(
            self,
            Self::ThrustBall
                | Self::CylindricalRollerThrust
                | Self::NeedleRollerThrust
                | Self::SphericalRollerThrust
                | Self::ThrustWasher
        )
    }

    /// True if it has rolling elements.
    pub fn rolls(self) -> bool {
        !matches!(self, Self::Plain | Self::ThrustWasher)
    }
}

described_as!(BearingPart, BearingEntry);

impl TryFrom<BearingEntry> for BearingPart {
    type Error = String;

    fn try_from(entry: BearingEntry) -> Result<Self, String> {
        let missing = |what: &str| {
            format!("`{what}` is missing: state a catalogue `designation`, or `kind`, `bore` and `outside`")
        };
        let kind = entry.kind.ok_or_else(|| missing("kind"))?;
        let bore = entry.bore.ok_or_else(|| missing("bore"))?;
        let outside = match entry.outside {
            None if kind == BearingKind::Plain => bore,
            outside => outside.ok_or_else(|| missing("outside"))?,
        };
        if outside <= bore && entry.outside.is_some() {
            return Err(format!(
                "outside {} mm does not exceed bore {} mm: swap them or correct one",
                outside * 1e3,
                bore * 1e3
            ));
        }
        // Without the catalogue's shoulder diameters: the ball diameter is about 0.3 (D - d), so the raceway's lowest point is at
        // (d_m + D_w)/2; for tapered and needle roller bearings it is at half the outside diameter.
        let raceway = entry.raceway.unwrap_or(match kind {
            BearingKind::TaperedRoller | BearingKind::NeedleCage => 0.5 * outside,
            BearingKind::Plain => 0.5 * bore,
            _ => 0.25 * (bore + outside) + 0.15 * (outside - bore),
        });
        if !(0.5 * bore..=0.5 * outside).contains(&raceway) {
            return Err(format!(
                "raceway {} mm is not between the radii of bore and outside, {} and {} mm: correct one of them",
                raceway * 1e3,
                0.5e3 * bore,
                0.5e3 * outside
            ));
        }
        let film = film::checked(&entry, kind, bore)?;
        grease::check(&entry, kind)?;
        let designated = entry.designation.as_deref().and_then(basic_designation);
        let designated =
            designated.filter(|basic| kind == BearingKind::AngularContactBall && basic.kind == kind.name());
        let designated = designated.and_then(|basic| basic.contact_angle);
        let designated = designated.map(|degrees| f64::from(degrees).to_radians());
        if let Some(fault) = entry.internal.as_ref().and_then(|internal| internal.fault(kind)) {
            return Err(fault);
        }
        let part = Self {
            designation: entry.designation,
            kind,
            series: entry.series,
            bore,
            outside,
            width: entry.width,
            c0: entry.c0,
            c: entry.c,
            e: entry.e,
            y: entry.y,
            y0: entry.y0,
            contact_angle: entry.contact_angle.or(designated),
            pu: entry.pu,
            calculation_factor: entry.calculation_factor,
            minimum_load_factor: entry.minimum_load_factor,
            reference_speed: entry.reference_speed,
            limiting_speed: entry.limiting_speed,
            seals: entry.seals,
            clearance: entry.clearance,
            internal: entry.internal,
            raceway,
            oil_height: entry.oil_height,
            lubrication: entry.lubrication,
            grease: entry.grease,
            film,
        };
        if part.internal.is_some() {
            part.rolling_elements().map_err(std::borrow::Cow::into_owned)?;
        }
        Ok(part)
    }
}

context! {
    /// All inputs of a bearing model.
    pub struct BearingAt of Bearing {
        /// Speed of the inner ring relative to the outer ring, signed. [rpm]
        speed: 3000.0 in -30000.0..=30000.0 from "kinematics of `shaft` and `outer`",
        /// Speed of the outer ring, signed; zero in the housing. [rpm]
        outer_speed: 0.0 in -30000.0..=30000.0 from "kinematics of `outer`",
        /// Radial load. [N]
        radial: 1000.0 in 0.0..=100000.0 from "statics of the shaft with tooth forces, weights, external forces and preload, times `radial_factor`",
        /// Axial load. [N]
        axial: 300.0 in 0.0..=50000.0 from "the bearings of the shaft that take its thrust, with preload and the induced thrust of pairs, times `axial_factor`",
        /// Tilting moment. [Nm]
        tilting: 0.0 in 0.0..=1000.0 from "statics of a shaft supported by this bearing alone, or on bearings with a tilting stiffness",
        /// Temperature of the oil at the bearing. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the component: given, balanced or a node of the network, and `temperature_offset`",
        /// Kinematic viscosity of the oil at the bearing. [mm2/s]
        nu: 10.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Density of the oil at the bearing. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
        /// Relative decrease of the oil's viscosity with temperature. [1/K]
        beta: 0.03 in 0.001..=0.3 from "the slope of its viscosity at this temperature",
        /// Oil height above the lowest point of the outer raceway; zero when dry. [mm]
        oil_height: 5.0 in 0.0..=500.0 from "`oil_height`, else the oil level at its position; zero under grease",
        /// Coefficient of boundary friction stated for the oil; zero if none is stated. [-]
        mu_bl: 0.0 in 0.0..=0.3 from "`mu_bl` of the oil",
        /// Coefficient of full-film friction of ball bearings stated for the oil. [-]
        mu_ehl: 0.05 in 0.001..=0.2 from "`mu_ehl` of the oil, or its kind",
        /// Pressure-viscosity coefficient of the oil. [1/GPa]
        alpha: 15.0 in 1.0..=60.0 from "`pressure_viscosity` of the oil, or its kind",
        /// Thermal conductivity of the oil. [W/(m K)]
        conductivity: 0.135 in 0.05..=0.5 from "`conductivity` of the oil, else its density according to Cragoe",
        /// Eyring stress stated for the oil; zero if none is stated. [MPa]
        tau0: 5.0 in 0.0..=50.0 from "`tau0` in `rheology` of the oil",
        /// Slope of the limiting shear stress over pressure stated for the oil; zero if none is stated. [-]
        limiting_slope: 0.06 in 0.0..=0.2 from "`limiting_slope` in `rheology` of the oil",
    }
}

impl Mechanism for Bearing {
    const KEY: &'static str = "bearing";
    const MEANING: &'static str = "Friction of a rolling bearing, a plain bearing or a thrust washer.";
    const ANSWER: &'static str = "Friction moment. [Nm]";
    const EXAMPLE: &'static str = "{ kind: deep_groove_ball, series: \"63\", bore: 40 mm, outside: 90 mm, width: 23 mm, c0: 24000 N, c: 42300 N }";
    const TOTAL: Term = Term::load("total");
    type Part = BearingPart;
    type At<'a, R: Real> = BearingAt<'a, R>;
    type Answer = Loss;
    type Model = dyn BearingModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

impl Component for Bearing {
    const SECTION: &'static str = "bearings";
    type Attachment = Support;

    #[inline(always)]
    fn context<'a, R: Points>(
        part: &'a BearingPart,
        site: SupportSite<'a, R>,
        notes: Notes<'a, R>,
    ) -> BearingAt<'a, R> {
        let oil = site.oil;
        let greased = part.lubrication == Lubrication::Grease;
        if greased {
            notes.branch("grease: the oil is its base oil, without a level");
        }
        let pocket = if greased { Some(0.0) } else { part.oil_height };
        BearingAt {
            part,
            speed: site.speed,
            outer_speed: site.outer_speed,
            radial: site.radial,
            axial: site.axial,
            tilting: site.tilting,
            temperature: oil.temperature,
            nu: oil.nu,
            rho: oil.rho,
            beta: oil.beta,
            oil_height: pocket.map_or_else(|| site.level.over_bottom(part.raceway).max(site.pocket), R::constant),
            mu_bl: oil.mu_bl,
            mu_ehl: oil.mu_ehl,
            alpha: oil.alpha,
            conductivity: oil.conductivity,
            tau0: oil.tau0,
            limiting_slope: oil.limiting_slope,
            notes,
        }
    }

    fn static_rating(part: &BearingPart) -> Option<StaticRating> {
        part.static_rating()
    }

    fn carries(part: &BearingPart) -> Carries {
        part.carries()
    }

    fn induced(part: &BearingPart) -> Induced {
        part.induced()
    }

    fn angular_row(part: &BearingPart) -> Result<AngularRow, Cow<'static, str>> {
        part.angular_row()
    }

    fn stiffness(part: &BearingPart, stiffness: Stiffness, load: f64) -> Result<f64, Cow<'static, str>> {
        part.rolling_elements()?.stiffness(stiffness, load)
    }

    fn lowest(part: &BearingPart) -> Option<f64> {
        let reads = part.oil_height.is_none() && part.lubrication != Lubrication::Grease;
        reads.then_some(part.raceway)
    }

    fn name(part: &BearingPart) -> String {
        match &part.designation {
            Some(designation) => designation.clone(),
            None => part.kind.name(),
        }
    }
}

impl BearingModel for Scalar<Bearing> {
    fn loss(&self, at: &BearingAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }

    fn losses(&self, at: &BearingAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Ok(Loss::MOMENTS.with(&Bearing::TOTAL, self.values(at)?))
    }

    fn loss_with_derivatives(&self, _at: &BearingAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        let value = self.constant()?;
        Some(Ok(Loss::MOMENTS.with(&Bearing::TOTAL, Dual::constant(value))))
    }
}

crate::register_component!(Bearing);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_raceway_of_a_6205_lies_near_23_2_mm() {
        let entry = BearingEntry {
            kind: Some(BearingKind::DeepGrooveBall),
            bore: Some(0.025),
            outside: Some(0.052),
            ..BearingEntry::default()
        };
        let part = BearingPart::try_from(entry).unwrap();
        assert!((part.raceway - 23.3e-3).abs() < 0.05e-3, "{}", part.raceway);
    }

    #[test]
    fn the_loads_of_a_designation_are_those_with_maker_suffixes_and_spaces() {
        use BearingKind as K;
        for (kind, designation, radial, thrust) in [
            (K::CylindricalRoller, "NU205EC", true, Thrust::None),
            (K::CylindricalRoller, "SKF NU 205 ECP", true, Thrust::None),
            (K::CylindricalRoller, "n 205-E-TVP2", true, Thrust::None),
            (K::CylindricalRoller, "NJ 2205", true, Thrust::OneDirection),
            (K::CylindricalRoller, "FAG NUP205-E", true, Thrust::Both),
            (K::NeedleCage, "", true, Thrust::None),
            (K::ThrustBall, "NSK 511 08", false, Thrust::OneDirection),
            (K::ThrustBall, "52208", false, Thrust::Both),
            (K::SphericalRollerThrust, "29412 E", true, Thrust::OneDirection),
        ] {
            let entry = BearingEntry {
                designation: Some(designation.to_owned()),
                kind: Some(kind),
                bore: Some(0.025),
                outside: Some(0.052),
                ..BearingEntry::default()
            };
            let carries = BearingPart::try_from(entry).unwrap().carries();
            assert_eq!((carries.radial, carries.thrust), (radial, thrust), "{designation}");
        }
    }

    #[test]
    fn a_bearing_inside_out_is_refused() {
        let entry = BearingEntry {
            kind: Some(BearingKind::DeepGrooveBall),
            bore: Some(0.052),
            outside: Some(0.025),
            ..BearingEntry::default()
        };
        assert!(BearingPart::try_from(entry).unwrap_err().contains("swap"));
    }
}
