//! Rolling bearings according to Harris, in Palmgren's form.
//!
//! Source: Harris, Kotzalas: Rolling Bearing Analysis, quoted from memory: M0 as SKF 1994; M1 = z (Fs/Cs)^y F_b dm with deep groove z 0.0004 (light)
//! to 0.0006, y 0.55; angular contact 0.001, 0.33; self-aligning 0.0003, 0.40; thrust ball 0.0008, 0.33; rollers as SKF 1994. F_b =
//! max(Fr, 0.9 Fa cot(alpha) - 0.1 Fr) for bearings with a contact angle, 3 Fa - 0.1 Fr for others, max(Fr, 0.8 Fa cot(alpha)) for rollers, Fa for
//! thrust bearings. Flanges of cylindrical rollers as SKF 1994.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::bearing::{Bearing, BearingKind, BearingPart};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::palmgren::{self, AXIAL_RATIO, Constants, F0, LOAD, NO_LOAD, P1, Palmgren, RADIAL_RATIO};
use super::rows::{self, Lack, LoadLaw, Rule};
use crate::checks::BY_HAND;

/// Rolling bearings according to Harris, in Palmgren's form.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Factor f0 of the load-independent moment; default: by kind, series and lubrication. [-]
    #[schemars(range(min = 0.0, max = 50.0))]
    pub f0: Option<f64>,
    /// Factor z; default: by kind and series. [-]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub z: Option<f64>,
    /// Contact angle of angular contact, self-aligning, tapered and spherical bearings; default: 40, 10, 14 and 10 deg. Not used for
    /// other kinds. [deg]
    #[schemars(range(min = 1.0, max = 80.0))]
    pub contact_angle: Option<f64>,
    #[serde(default)]
    coefficients: Constants,
}

impl Params {
    fn model(&self, part: &BearingPart) -> Result<Palmgren, Lack> {
        use BearingKind as K;
        let cot = |usual: f64| 1.0 / self.contact_angle.unwrap_or(usual.to_radians()).tan();
        // Static factor of angular contact bearings: 0.26 at 40 deg, proportional to the cotangent; twice that for two rows.
        let ball = |z, y, usual: f64| {
            let y0 = part.y0.unwrap_or(0.22 * cot(usual));
            LoadLaw::new(
                z,
                y,
                Rule::Ball {
                    k_cot: 0.9 * cot(usual),
                    y0,
                },
            )
        };
        let two_rows = |z, y, usual: f64| {
            let y0 = part.y0.unwrap_or(0.44 * cot(usual));
            LoadLaw::new(
                z,
                y,
                Rule::BallTwoRows {
                    k_cot: 0.9 * cot(usual),
                    y0,
                },
            )
        };
        let mut law = match part.kind {
            K::DeepGrooveBall | K::DeepGrooveBallDoubleRow => {
                let skf = rows::load_law(part, 0.55, 3.0, self.z.is_some())?;
                // The light series of SKF 1994 have less than 0.0009 there.
                let z = if skf.z < 0.0009 { 0.0004 } else { 0.0006 };
                LoadLaw { z, ..skf }
            }
            K::AngularContactBall | K::FourPointContactBall => ball(0.001, 0.33, 40.0),
            K::AngularContactBallDoubleRow => two_rows(0.001, 0.33, 40.0),
            K::SelfAligningBall => two_rows(0.0003, 0.40, 10.0),
            K::TaperedRoller => LoadLaw::new(0.0004, 0.0, Rule::Roller { k_cot: 0.8 * cot(14.0) }),
            K::SphericalRoller => rows::spherical(part, Rule::Roller { k_cot: 0.8 * cot(10.0) })?,
            _ => rows::load_law(part, 0.55, 3.0, self.z.is_some())?,
        };
        law.z = self.z.unwrap_or(law.z);
        let f0 = self.f0.map_or_else(|| rows::f0(part), Ok)?;
        Palmgren::new(part, F0::Fixed(f0), law, rows::f2(part), self.coefficients)
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Palmgren, Diagnostic> {
    palmgren::of_part(cx, |part| params.model(part))
}

register!(Bearing, "harris", Params,
    source: "Harris, Kotzalas, Rolling Bearing Analysis",
    example: "{ type: harris }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked against the book"),
        default_of("f0", Evidence::Recalled, "table quoted from memory"),
        default_of("z", Evidence::Disputed, "three published variants for deep groove balls"),
        default_of("contact_angle", Evidence::Assumed, "typical designs"),
    ],
    checks: [
        Check {
            input: "{ model: { type: harris, contact_angle: 12 deg }, part: { kind: angular_contact_ball, series: 72 BE, bore: 40 mm, \
                    outside: 80 mm, c0: 26000 N }, at: { speed: 3000 rpm, nu: 15 mm2/s, radial: 3000 N, axial: 1000 N, \
                    oil_height: 0 mm } }",
            values: &[("f1", "4.9035297e-4"), ("P1", "3934.1671 N"), ("M1", "115.747831 N mm")],
            source: "by hand: f1 = 0.001 (3000/26000)^0.33, P1 = 0.9 1000 cot 12 deg - 0.1 3000, d_m = 60 mm",
            ..BY_HAND
        },
        Check {
            input: "{ model: { type: harris, contact_angle: 40 deg }, part: { kind: angular_contact_ball, series: 72 BE, bore: 40 mm, \
                    outside: 80 mm, c0: 26000 N }, at: { speed: 3000 rpm, nu: 15 mm2/s, radial: 3000 N, axial: 1000 N, \
                    oil_height: 0 mm } }",
            values: &[("P1", "3000 N"), ("M1", "88.2635344 N mm")],
            source: "by hand: the radial load exceeds 0.9 1000 cot 40 deg - 0.1 3000 = 772.6 N",
            ..BY_HAND
        },
    ],
    limits: [AXIAL_RATIO, RADIAL_RATIO], terms: [LOAD, NO_LOAD], observed: [P1], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::bearing::testing::{RIG, moments, part};

    const PLAIN: Params = Params {
        coefficients: Constants::PUBLISHED,
        f0: None,
        z: None,
        contact_angle: None,
    };

    #[test]
    fn deep_groove_balls_take_two_thirds_of_the_load_moment_of_skf_1994() {
        let part = part(BearingKind::DeepGrooveBall, "63", 40.0, 90.0, Some(24000.0));
        let [load, no_load] = moments(&PLAIN.model(&part).unwrap(), &part, RIG, 0.0);
        assert!((load / (55.9213 / 1.5) - 1.0).abs() < 1e-5, "{load}");
        assert!((no_load / 69.4883 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn every_factor_is_that_of_the_book() {
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/harris.csv"));
        for line in table.rows() {
            let (kind, light, heavy) = match line.text("type") {
                "deep_groove" => (BearingKind::DeepGrooveBall, "60", "63"),
                "angular_contact" => (BearingKind::AngularContactBall, "72 BE", "73 BE"),
                "thrust_ball" => (BearingKind::ThrustBall, "60", "63"),
                "self_aligning" => (BearingKind::SelfAligningBall, "10", "13"),
                other => panic!("{other}"),
            };
            for (column, series) in [("z_light", light), ("z_heavy", heavy)] {
                let palmgren = PLAIN.model(&part(kind, series, 40.0, 80.0, Some(26000.0))).unwrap();
                line.is(column, palmgren.law.z);
                line.is("y", palmgren.law.exponent);
            }
        }
    }
}
