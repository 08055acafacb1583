//! Internal geometry of a rolling bearing: as stated, else estimated from its boundary dimensions and load ratings.
//!
//! Sources of the estimates: the diameter of a ball is 0.3 (D - d), or that of C0 = f0 Z D_w^2 (ISO 76) if C0 and f0 are known and it is near; a deep
//! groove bearing is filled with balls over 186 degrees, Z = 1 + 186 deg/(2 asin(D_w/d_m)), which gives the numbers of balls of 6010, 6205, 6206, 6208,
//! 6305, 6308 and 6309; angular contact bearings have Z D_w = 2.9 d_m (recalled). The diameter of a roller is 0.275 (D - d) and rollers fill 83 % of the
//! circumference, full complements 98 %, from the few bearings whose interior is known; their length follows from C0 = 44 (1 - gamma) Z L D_w cos(a)
//! (ISO 76), else from the width. Grooves of 0.52 and 0.53 are those that ISO/TS 16281 assumes. Contact angles follow from the designation (DIN 628-1) or
//! from e and Y, by their relations in ISO 281.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BearingKind, BearingPart};
use crate::attach::Stiffness;
use crate::loads::AngularRow;
use crate::rolling::{
    Axes, BallGeometry, Balls, Contact, ManyElements, Material, Profile, RollerGeometry, Rollers, Row, balance,
    balance_from,
};

/// Internal geometry of a bearing with one row of balls or rollers; what is omitted is estimated from the boundary dimensions. For the
/// model `contact` and for ratings from the load distribution.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InternalGeometry {
    /// Number of rolling elements. [-]
    #[schemars(range(min = 3, max = 500))]
    pub elements: Option<u32>,
    /// Diameter of a rolling element; mean diameter of a tapered roller. [mm]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub diameter: Option<f64>,
    /// Effective length of a roller. [mm]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub length: Option<f64>,
    /// Diameter of the circle of the centres of the rolling elements; default: half the sum of bore and outside diameter. [mm]
    #[schemars(range(min = 0.5, max = 5000.0))]
    pub pitch_diameter: Option<f64>,
    /// Radii of the grooves of the inner and the outer ring over the diameter of a ball. [-]
    #[schemars(inner(range(min = 0.502, max = 0.65)))]
    pub conformity: Option<[f64; 2]>,
    /// Radial clearance in operation of deep groove ball, cylindrical and needle roller bearings, negative with preload; default: zero, or what the
    /// class `clearance` has more than the normal one. [um]
    #[schemars(range(min = -500.0, max = 2000.0))]
    pub clearance: Option<f64>,
    /// Material of the rolling elements.
    #[serde(default)]
    pub material: ElementMaterial,
}

/// Material of rolling elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ElementMaterial {
    /// Bearing steel.
    #[default]
    Steel,
    /// Silicon nitride: a hybrid bearing.
    SiliconNitride,
}

impl ElementMaterial {
    fn properties(self) -> Material {
        match self {
            Self::Steel => Material::STEEL,
            Self::SiliconNitride => Material::SILICON_NITRIDE,
        }
    }
}

/// The rolling elements of a bearing.
#[derive(Debug, Clone)]
pub enum ElementRow {
    /// Balls.
    Balls(Balls),
    /// Rollers.
    Rollers(Rollers),
}

/// The rolling elements of a bearing, and whether their geometry is known.
#[derive(Debug, Clone)]
pub struct Elements {
    /// The row.
    pub row: ElementRow,
    /// True if number, diameter, length or contact angle are estimated.
    pub is_estimated: bool,
    /// True if the clearance in operation is not stated.
    pub is_clearance_assumed: bool,
}

/// Fa over Fr tan(a) at which half of very many elements carry, of balls and of rollers (integrals of Sjoevall).
const HALF_LOADED: [f64; 2] = [1.216, 1.258];

/// A stiffness of a row under a thrust and a radial load on a ring that does not tilt.
///
/// # Errors
/// What the elements do that gives none.
fn stiffness_of(row: &impl Row, stiffness: Stiffness, [axial, radial]: [f64; 2]) -> Result<f64, &'static str> {
    const UNBALANCED: &str = "have no equilibrium";
    let given = Axes::loaded(axial, radial);
    let level = balance(row, &given).map_err(|_| UNBALANCED)?;
    match stiffness {
        Stiffness::Radial => {
            let found = radial / level.displacement.radial[0];
            if found > 0.0 { Ok(found) } else { Err(UNBALANCED) }
        }
        Stiffness::Tilting => {
            // Free, under the moment that holds it.
            let given = given.with_moment(level.load.tilt[0]).mirrored();
            let free = balance_from(row, &given, &level.displacement).map_err(|_| UNBALANCED)?;
            free.tilting_stiffness()
                .ok_or("do not resist to a tilt, too few of them being loaded,")
        }
    }
}

impl Elements {
    /// A stiffness under a radial load (N) on a ring that does not tilt; with a contact angle under the axial load that loads half of the elements.
    /// The radial one is the load over the displacement, that against a tilt in the plane of the load the slope of the moment, at constant loads.
    ///
    /// # Errors
    /// If the elements do not carry the load.
    pub fn stiffness(&self, stiffness: Stiffness, load: f64) -> Result<f64, Cow<'static, str>> {
        let loads = |angle: f64, share: f64| [share * load * angle.tan(), load];
        let [balls, rollers] = HALF_LOADED;
        let found = match &self.row {
            ElementRow::Balls(row) => stiffness_of(row, stiffness, loads(row.geometry().contact_angle, balls)),
            ElementRow::Rollers(row) => stiffness_of(row, stiffness, loads(row.geometry().contact_angle, rollers)),
        };
        found.map_err(|what| Cow::Owned(format!("its rolling elements {what} under a radial load of {load} N")))
    }
}

/// Slices of a roller.
const SLICES: usize = 30;

impl InternalGeometry {
    /// What is wrong with the stated values for a kind of bearing.
    pub(super) fn fault(&self, kind: BearingKind) -> Option<String> {
        let has = |is_stated: bool, key: &str, whose: &str| {
            is_stated.then(|| {
                format!(
                    "`internal.{key}` is for {whose} only: remove it from this `{}`",
                    kind.name()
                )
            })
        };
        if !kind.has_known_distribution() {
            return Some(format!(
                "`internal` is not used for `{}`: only single-row deep groove and angular contact ball, cylindrical, needle and tapered \
                 roller bearings have a load distribution; remove it",
                kind.name()
            ));
        }
        let has_angle = kind.has_contact_angle();
        has(self.length.is_some() && kind.has_balls(), "length", "rollers")
            .or_else(|| has(self.conformity.is_some() && !kind.has_balls(), "conformity", "balls"))
            .or_else(|| {
                let whose = "bearings without a contact angle";
                has(self.clearance.is_some() && has_angle, "clearance", whose)
            })
    }
}

impl BearingKind {
    /// True for single rows that a thrust loads at an angle.
    fn has_contact_angle(self) -> bool {
        matches!(self, Self::AngularContactBall | Self::TaperedRoller)
    }

    /// True if the loads of its rolling elements can be calculated: one row of balls or rollers.
    pub fn has_known_distribution(self) -> bool {
        matches!(
            self,
            Self::DeepGrooveBall
                | Self::AngularContactBall
                | Self::CylindricalRoller
                | Self::CylindricalRollerFullComplement
                | Self::NeedleCage
                | Self::TaperedRoller
        )
    }
}

/// A value as stated, or estimated.
fn or_estimate(stated: Option<f64>, is_estimated: &mut bool, estimate: impl FnOnce() -> f64) -> f64 {
    stated.unwrap_or_else(|| {
        *is_estimated = true;
        estimate()
    })
}

/// Contact angles of angular contact ball bearings with e of ISO 281. \[deg\]
const ANGLES_BY_E: [[f64; 2]; 6] = [
    [0.57, 20.0],
    [0.68, 25.0],
    [0.80, 30.0],
    [0.95, 35.0],
    [1.14, 40.0],
    [1.34, 45.0],
];

impl BearingPart {
    /// The rolling elements with their geometry; an error says what is missing.
    ///
    /// # Errors
    /// If the kind has no single row of elements, or what is omitted cannot be estimated.
    pub fn rolling_elements(&self) -> Result<Elements, Cow<'static, str>> {
        let kind = self.kind;
        if !kind.has_known_distribution() {
            return Err("the loads of the rolling elements of this kind of bearing are not calculated".into());
        }
        let internal = self.internal.clone().unwrap_or_default();
        let mut is_estimated = false;
        let pitch_diameter = internal.pitch_diameter.unwrap_or_else(|| self.mean_diameter());
        let contact_angle = match self.contact_angle.filter(|_| kind.has_contact_angle()) {
            Some(angle) => angle,
            None => self.estimated_angle(&mut is_estimated)?,
        };
        let is_clearance_assumed = internal.clearance.is_none() && contact_angle == 0.0;
        let clearance = match (internal.clearance, self.clearance) {
            (Some(clearance), _) => clearance,
            (None, Some(class)) => class.above_normal(kind, self.bore).unwrap_or(0.0),
            (None, None) => 0.0,
        };
        if kind == BearingKind::NeedleCage
            && (internal.elements.is_none() || internal.diameter.is_none() || internal.length.is_none())
        {
            return Err(
                "needle roller bearings: state `internal.elements`, `internal.diameter` and `internal.length`".into(),
            );
        }
        let [elements, diameter] = self.number_and_diameter(&internal, pitch_diameter, &mut is_estimated);
        let half_pitch = (diameter / pitch_diameter).min(1.0).asin();
        let is_between =
            pitch_diameter - diameter >= 0.9999 * self.bore && pitch_diameter + diameter <= 1.0001 * self.outside;
        if elements < 3.0 || elements * half_pitch > 1.0001 * std::f64::consts::PI || !is_between {
            return Err(Cow::Owned(format!(
                "{elements} rolling elements of {:.4} mm do not fit on a circle of {:.4} mm between bore and outside diameter: correct `internal`",
                1e3 * diameter,
                1e3 * pitch_diameter
            )));
        }
        let material = internal.material.properties();
        let row = if kind.has_balls() {
            let geometry = BallGeometry {
                number: elements as usize,
                diameter,
                pitch_diameter,
                conformity: internal.conformity.unwrap_or([0.52, 0.53]),
                contact_angle,
                clearance,
                balls: material,
                rings: Material::STEEL,
            };
            // Half of it turns the grooves by a contact angle of 60 degrees.
            if clearance > geometry.groove_distance() {
                return Err(Cow::Owned(format!(
                    "a clearance of {:.1} um is too large for grooves whose centres are {:.1} um apart: correct `internal`",
                    1e6 * clearance,
                    1e6 * geometry.groove_distance()
                )));
            }
            ElementRow::Balls(Balls::new(geometry))
        } else {
            is_estimated |= internal.length.is_none();
            let length = internal.length.map_or_else(
                || self.estimated_length(elements, diameter, pitch_diameter, contact_angle),
                Ok,
            )?;
            ElementRow::Rollers(Rollers::new(RollerGeometry {
                number: elements as usize,
                diameter,
                length,
                pitch_diameter,
                contact_angle,
                clearance,
                slices: SLICES,
                profile: Profile::Logarithmic,
                rollers: material,
                rings: Material::STEEL,
            }))
        };
        Ok(Elements {
            row,
            is_estimated,
            is_clearance_assumed,
        })
    }

    /// The row of an angular contact ball or tapered roller bearing as very many elements with the nominal contact angle, rollers straight.
    ///
    /// # Errors
    /// If it is another kind, or as [`Self::rolling_elements`].
    pub fn angular_row(&self) -> Result<AngularRow, Cow<'static, str>> {
        if !self.kind.has_contact_angle() {
            return Err("only single-row angular contact ball and tapered roller bearings have a preload".into());
        }
        let elements = self.rolling_elements()?;
        let (number, stiffness, contact_angle, pitch_diameter, diameter, contact) = match &elements.row {
            ElementRow::Balls(balls) => {
                let own = balls.geometry();
                let (angle, pitch) = (own.contact_angle, own.pitch_diameter);
                (
                    own.number,
                    balls.stiffness(),
                    angle,
                    pitch,
                    own.diameter,
                    Contact::Point,
                )
            }
            ElementRow::Rollers(rollers) => {
                let own = rollers.geometry();
                let (angle, pitch) = (own.contact_angle, own.pitch_diameter);
                (
                    own.number,
                    rollers.stiffness(),
                    angle,
                    pitch,
                    own.diameter,
                    Contact::Line,
                )
            }
        };
        Ok(AngularRow {
            row: ManyElements {
                number: number as f64,
                stiffness,
                contact_angle,
                contact,
            },
            outer_diameter: pitch_diameter + diameter * contact_angle.cos(),
            is_estimated: elements.is_estimated,
        })
    }

    /// Number of elements and their diameter, stated or estimated. \[-, m\]
    fn number_and_diameter(
        &self,
        internal: &InternalGeometry,
        pitch_diameter: f64,
        is_estimated: &mut bool,
    ) -> [f64; 2] {
        let share = if self.kind.has_balls() { 0.3 } else { 0.275 };
        let rule = or_estimate(internal.diameter, is_estimated, || share * (self.outside - self.bore));
        let elements = or_estimate(internal.elements.map(f64::from), is_estimated, || {
            let half_pitch = (rule / pitch_diameter).min(1.0).asin();
            match self.kind {
                BearingKind::DeepGrooveBall => (1.0 + 186.0_f64.to_radians() / (2.0 * half_pitch)).round(),
                BearingKind::AngularContactBall => (2.9 * pitch_diameter / rule).floor(),
                BearingKind::CylindricalRollerFullComplement => (0.98 * std::f64::consts::PI / half_pitch).floor(),
                _ => (0.83 * std::f64::consts::PI / half_pitch).floor(),
            }
        });
        let diameter = match (internal.diameter, self.c0.zip(self.calculation_factor)) {
            (None, Some((c0, f0))) if self.kind == BearingKind::DeepGrooveBall => {
                // C0 = f0 Z D^2, in N and mm.
                let found = 1e-3 * (c0 / (f0 * elements)).sqrt();
                if (0.85..1.15).contains(&(found / rule)) {
                    found
                } else {
                    rule
                }
            }
            _ => rule,
        };
        [elements, diameter]
    }

    /// Contact angle from the designation or the factors of the equivalent load. \[rad\]
    fn estimated_angle(&self, is_estimated: &mut bool) -> Result<f64, Cow<'static, str>> {
        let angle = match self.kind {
            BearingKind::AngularContactBall => self.e.and_then(by_e).map(f64::to_radians),
            // e = 1.5 tan a, Y = 0.4 cot a.
            BearingKind::TaperedRoller => self.e.map(|e| e / 1.5).or(self.y.map(|y| 0.4 / y)).map(f64::atan),
            _ => return Ok(0.0),
        };
        *is_estimated = true;
        angle.ok_or_else(|| "the contact angle is not known: state `contact_angle`, or `e`".into())
    }

    /// Length of a roller from the static load rating, else from the width. \[m\]
    fn estimated_length(
        &self,
        number: f64,
        diameter: f64,
        pitch_diameter: f64,
        angle: f64,
    ) -> Result<f64, Cow<'static, str>> {
        let cos = angle.cos();
        let gamma = diameter * cos / pitch_diameter;
        // C0 = 44 (1 - gamma) Z L D cos(a), in N and mm.
        let of_rating = self
            .c0
            .map(|c0| 1e-6 * c0 / (44.0 * (1.0 - gamma) * number * diameter * cos));
        let of_width = self.width.map(|width| 0.6 * width);
        let is_possible = |length: &f64| self.width.is_none_or(|width| (0.2..0.95).contains(&(length / width)));
        of_rating
            .filter(is_possible)
            .or(of_width)
            .ok_or_else(|| "the length of the rollers is not known: state `internal.length`, `c0` or `width`".into())
    }
}

/// Contact angle of a ball bearing from e, between the ends of the table. \[deg\]
fn by_e(e: f64) -> Option<f64> {
    let pair = ANGLES_BY_E
        .windows(2)
        .find(|pair| (pair[0][0]..=pair[1][0]).contains(&e))?;
    let share = (e - pair[0][0]) / (pair[1][0] - pair[0][0]);
    Some(pair[0][1] + share * (pair[1][1] - pair[0][1]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mechanism::bearing::BearingEntry;
    use crate::testing::assert_close;

    fn part(kind: BearingKind, bore: f64, outside: f64) -> BearingPart {
        let entry = BearingEntry {
            kind: Some(kind),
            bore: Some(1e-3 * bore),
            outside: Some(1e-3 * outside),
            ..BearingEntry::default()
        };
        BearingPart::try_from(entry).unwrap()
    }

    fn balls(part: &BearingPart) -> BallGeometry {
        match part.rolling_elements().unwrap().row {
            ElementRow::Balls(balls) => *balls.geometry(),
            ElementRow::Rollers(_) => panic!("rollers"),
        }
    }

    fn rollers(part: &BearingPart) -> RollerGeometry {
        match part.rolling_elements().unwrap().row {
            ElementRow::Rollers(rollers) => *rollers.geometry(),
            ElementRow::Balls(_) => panic!("balls"),
        }
    }

    /// Bore, outside diameter, C0, f0, and the balls as publications have them.
    #[test]
    fn balls_of_deep_groove_bearings() {
        for (bore, outside, c0, f0, number, diameter) in [
            (25.0, 52.0, 7800.0, 14.0, 9, 7.938),
            (25.0, 62.0, 11_600.0, 12.0, 7, 11.5),
            (30.0, 62.0, 11_200.0, 14.0, 9, 9.525),
            (40.0, 80.0, 17_900.0, 14.0, 9, 11.906),
            (40.0, 90.0, 24_000.0, 13.0, 8, 15.081),
            (45.0, 100.0, 31_500.0, 13.0, 8, 17.462),
            (50.0, 80.0, 16_000.0, 16.0, 13, 8.731),
        ] {
            let mut bearing = part(BearingKind::DeepGrooveBall, bore, outside);
            assert_eq!(balls(&bearing).number, number, "{bore}");
            assert_close(balls(&bearing).diameter, 1e-3 * diameter, 0.06);
            (bearing.c0, bearing.calculation_factor) = (Some(c0), Some(f0));
            assert_close(balls(&bearing).diameter, 1e-3 * diameter, 0.025);
        }
    }

    /// A 7218 B has 16 balls of 22.225 mm at 40 degrees, Harris' 218.
    #[test]
    fn an_angular_contact_bearing() {
        let mut bearing = part(BearingKind::AngularContactBall, 90.0, 160.0);
        assert!(bearing.rolling_elements().unwrap_err().contains("`contact_angle`"));
        bearing.e = Some(1.14);
        let found = balls(&bearing);
        assert_close(found.contact_angle.to_degrees(), 40.0, 1e-12);
        assert_close(found.number as f64, 16.0, 0.07);
        assert_close(found.diameter, 22.225e-3, 0.06);
        bearing.contact_angle = Some(25.0_f64.to_radians());
        assert_close(balls(&bearing).contact_angle.to_degrees(), 25.0, 1e-12);
    }

    /// A published 32216 has 16 rollers of 17 mm; an NU 208 has 14 of 11 mm by 12 mm.
    #[test]
    fn rollers_of_roller_bearings() {
        let mut tapered = part(BearingKind::TaperedRoller, 80.0, 140.0);
        (tapered.e, tapered.c0, tapered.width) = (Some(0.43), Some(245_000.0), Some(0.035_25));
        let found = rollers(&tapered);
        assert_close(found.number as f64, 16.0, 0.07);
        assert_close(found.diameter, 17e-3, 0.04);
        assert_close(found.contact_angle.tan(), 0.43 / 1.5, 1e-12);
        assert!((0.55..0.8).contains(&(found.length / 0.035_25)), "{}", found.length);
        let mut cylindrical = part(BearingKind::CylindricalRoller, 40.0, 80.0);
        assert!(cylindrical.rolling_elements().unwrap_err().contains("internal.length"));
        cylindrical.width = Some(0.018);
        let found = rollers(&cylindrical);
        assert_eq!(found.number, 14);
        assert_close(found.diameter, 11e-3, 1e-12);
        assert_close(found.length, 12e-3, 0.15);
        cylindrical.c0 = Some(53_000.0);
        assert_close(rollers(&cylindrical).length, 12e-3, 0.25);
    }

    #[test]
    fn stated_geometry_is_used_and_nothing_is_estimated() {
        let mut bearing = part(BearingKind::DeepGrooveBall, 25.0, 62.0);
        bearing.internal = Some(InternalGeometry {
            elements: Some(8),
            diameter: Some(10e-3),
            pitch_diameter: Some(43e-3),
            conformity: Some([0.515, 0.525]),
            clearance: Some(12e-6),
            ..InternalGeometry::default()
        });
        let found = bearing.rolling_elements().unwrap();
        assert!(!found.is_estimated && !found.is_clearance_assumed);
        let geometry = balls(&bearing);
        assert_eq!(
            (geometry.number, geometry.diameter, geometry.clearance),
            (8, 10e-3, 12e-6)
        );
        assert_eq!((geometry.pitch_diameter, geometry.conformity), (43e-3, [0.515, 0.525]));
        for change in [
            |internal: &mut InternalGeometry| internal.elements = Some(14),
            |internal: &mut InternalGeometry| internal.pitch_diameter = Some(60e-3),
        ] {
            let mut wrong = bearing.clone();
            change(wrong.internal.as_mut().unwrap());
            assert!(wrong.rolling_elements().unwrap_err().contains("do not fit"));
        }
        bearing.internal.as_mut().unwrap().clearance = Some(500e-6);
        assert!(
            bearing
                .rolling_elements()
                .unwrap_err()
                .contains("500.0 um is too large")
        );
    }

    #[test]
    fn keys_of_other_kinds_are_refused() {
        let stated = |internal: InternalGeometry, kind: BearingKind| internal.fault(kind).unwrap_or_default();
        let length = InternalGeometry {
            length: Some(0.01),
            ..InternalGeometry::default()
        };
        assert!(stated(length.clone(), BearingKind::DeepGrooveBall).contains("`internal.length` is for rollers only"));
        assert_eq!(stated(length.clone(), BearingKind::TaperedRoller), "");
        assert!(stated(length, BearingKind::SphericalRoller).contains("remove it"));
        let clearance = InternalGeometry {
            clearance: Some(1e-5),
            ..InternalGeometry::default()
        };
        assert!(stated(clearance, BearingKind::AngularContactBall).contains("internal.clearance"));
    }

    /// The load over the displacement of balls without clearance: F = K sum of cos^2.5 over the loaded half, times delta^1.5.
    #[test]
    fn radial_stiffness_is_that_of_the_closed_form() {
        let elements = part(BearingKind::DeepGrooveBall, 40.0, 80.0)
            .rolling_elements()
            .unwrap();
        let ElementRow::Balls(row) = &elements.row else {
            panic!("rollers")
        };
        let number = row.geometry().number;
        let cosines = (0..number).map(|i| (std::f64::consts::TAU * i as f64 / number as f64).cos());
        let sum: f64 = cosines.filter(|cos| *cos > 0.0).map(|cos| cos.powf(2.5)).sum();
        for load in [100.0, 3000.0, 20_000.0] {
            let displacement = (load / (row.stiffness() * sum)).powf(2.0 / 3.0);
            assert_close(
                elements.stiffness(Stiffness::Radial, load).unwrap(),
                load / displacement,
                1e-9,
            );
        }
        // Twice the load has 2^(1/3) times the stiffness; of rollers less, down to 2^(1/10) if they were straight.
        let ratio = |elements: &Elements| {
            elements.stiffness(Stiffness::Radial, 6000.0).unwrap()
                / elements.stiffness(Stiffness::Radial, 3000.0).unwrap()
        };
        assert_close(ratio(&elements), 2.0_f64.cbrt(), 1e-9);
        let rollers = BearingPart {
            width: Some(18e-3),
            ..part(BearingKind::CylindricalRoller, 40.0, 80.0)
        };
        let rollers = rollers.rolling_elements().unwrap();
        assert!((1.0..1.3).contains(&ratio(&rollers)), "{}", ratio(&rollers));
        assert!(
            rollers.stiffness(Stiffness::Radial, 3000.0).unwrap()
                > elements.stiffness(Stiffness::Radial, 3000.0).unwrap()
        );
        let spherical = part(BearingKind::SphericalRoller, 40.0, 80.0);
        assert!(spherical.rolling_elements().is_err());
    }

    /// The slope of the moment over the tilt, with and without contact angle.
    #[test]
    fn tilting_stiffness_is_the_slope_of_the_moment() {
        let of = |row: &dyn Fn(f64) -> f64| (row(1e-6) - row(-1e-6)) / 2e-6;
        let mut found = Vec::new();
        for (kind, angle) in [
            (BearingKind::DeepGrooveBall, None),
            (BearingKind::AngularContactBall, Some(40.0_f64.to_radians())),
            (BearingKind::CylindricalRoller, None),
            (BearingKind::TaperedRoller, Some(14.0_f64.to_radians())),
        ] {
            let bearing = BearingPart {
                width: Some(18e-3),
                contact_angle: angle,
                ..part(kind, 40.0, 80.0)
            };
            let elements = bearing.rolling_elements().unwrap();
            let stiffness = elements.stiffness(Stiffness::Tilting, 3000.0).unwrap();
            let share = HALF_LOADED[usize::from(!kind.has_balls())];
            let given = Axes::loaded(share * 3000.0 * angle.unwrap_or(0.0).tan(), 3000.0);
            let slope = match &elements.row {
                ElementRow::Balls(row) => of(&|tilt| balance(row, &given.with_tilt(tilt)).unwrap().load.tilt[0]),
                ElementRow::Rollers(row) => of(&|tilt| balance(row, &given.with_tilt(tilt)).unwrap().load.tilt[0]),
            };
            assert!((stiffness / slope - 1.0).abs() < 1e-4, "{kind:?}: {stiffness} {slope}");
            found.push(stiffness);
        }
        // Rollers resist to tilts, balls hardly.
        assert!(found[2] > 10.0 * found[0], "{found:?}");
    }
}
