//! Rolling bearings according to Palmgren, as in ISO/TR 14179-2.
//!
//! Source: ISO/TR 14179-2:2001; SKF General Catalogue 1994; Palmgren 1957: M = M0 + M1 (+ M2 for cylindrical rollers under axial
//! load), N mm: M0 = 1e-7 f0 (nu n)^(2/3) dm^3 from nu n = 2000, 160e-7 f0 dm^3 below; M1 = f1 P1^a dm^b with a = b = 1 except for
//! spherical rollers; M2 = f2 Fa dm.
//! The step of 0.8 % at nu n = 2000 is in the published formula and is retained. Steady speed, normal clearance. f0 and f1 are
//! tables by kind, series and lubrication; a range covers light to heavy series. If the table has no value, or a row requires a
//! series or a load factor that is not given, building fails and names the missing value.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::bearing::{Bearing, BearingPart};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::palmgren::{self, AXIAL_RATIO, Constants, F0, LOAD, NO_LOAD, P1, Palmgren, RADIAL_RATIO, flanged};
use super::rows::{self, Lack};
use crate::checks::{BY_HAND, SIX_DIGITS};

/// Load-dependent and load-independent moment according to Palmgren, as in ISO/TR 14179-2.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    /// Factor f0 of the load-independent moment; default: by kind, series and lubrication. [-]
    #[schemars(range(min = 0.0, max = 50.0))]
    pub f0: Option<f64>,
    /// Factor z of f1 = z (P0/C0)^y for ball bearings, or f1 itself for roller bearings; default: by kind and series. [-]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub f1: Option<f64>,
    /// Exponent y of deep groove ball bearings: 0.55 according to SKF and Harris, 0.5 according to Schaeffler. [-]
    #[serde(default = "exponent")]
    #[schemars(range(min = 0.1, max = 1.0))]
    pub exponent: f64,
    /// Factor k of P1 = k Fa - 0.1 Fr of deep groove ball bearings: 3 according to SKF and Harris, 3.3 according to Schaeffler. [-]
    #[serde(default = "axial_factor")]
    #[schemars(range(min = 0.5, max = 5.0))]
    pub axial_factor: f64,
    /// Factor f2 of the moment of axially loaded cylindrical roller bearings; default: by kind and lubrication. [-]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub f2: Option<f64>,
    #[serde(default)]
    coefficients: Constants,
}

fn exponent() -> f64 {
    0.55
}

fn axial_factor() -> f64 {
    3.0
}

impl Iso14179 {
    fn model(&self, part: &BearingPart) -> Result<Palmgren, Lack> {
        let mut law = rows::load_law(part, self.exponent, self.axial_factor, self.f1.is_some())?;
        law.z = self.f1.unwrap_or(law.z);
        if self.f2.is_some() && !flanged(part) {
            let help = "omit `f2`; for other bearings f1 includes the axial load";
            return Err((
                "`f2` applies to cylindrical roller bearings only".to_owned(),
                help.to_owned(),
            ));
        }
        let f0 = self.f0.map_or_else(|| rows::f0(part), Ok)?;
        Palmgren::new(
            part,
            F0::Fixed(f0),
            law,
            self.f2.unwrap_or(rows::f2(part)),
            self.coefficients,
        )
    }
}

fn prepare(params: Iso14179, cx: &mut Build<'_>) -> Result<Palmgren, Diagnostic> {
    palmgren::of_part(cx, |part| params.model(part))
}

register!(Bearing, "iso14179_2", Iso14179,
    source: "ISO/TR 14179-2:2001; SKF General Catalogue 1994",
    example: "{ type: iso14179_2 }",
    evidence: [
        formula(Evidence::SeveralSources, "catalogues and standard give the same formula"),
        default_of("f0", Evidence::Recalled, "table quoted from memory, not checked; the series selects within a range"),
        default_of("f1", Evidence::Disputed, "three published variants for deep groove balls; factors for needle roller bearings differ by four"),
        default_of("exponent", Evidence::Disputed, "0.55 according to SKF and Harris, 0.5 according to Schaeffler"),
        default_of("axial_factor", Evidence::Disputed, "3 according to SKF and Harris, 3.3 according to Schaeffler"),
        default_of("f2", Evidence::Recalled, "table quoted from memory, not checked; flanges of the EC design"),
    ],
    checks: [
        Check {
            input: "{ part: { kind: deep_groove_ball, series: '63', bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { speed: 3000 rpm, \
                    nu: 15 mm2/s, radial: 3000 N, axial: 1000 N, oil_height: 0 mm } }",
            values: &[
                ("P0", "3000 N"),
                ("P1", "3000 N"),
                ("f1", "2.86776e-4"),
                ("M0", "69.4883 N mm"),
                ("M1", "55.9213 N mm"),
                ("moment", "125.410 N mm"),
            ],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { kind: deep_groove_ball, series: '63', bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { speed: 100 rpm, \
                    nu: 15 mm2/s, radial: 0 N, axial: 0 N, oil_height: 0 mm } }",
            values: &[("M0", "8.78800 N mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: iso14179_2, f0: 2.2 }, part: { kind: cylindrical_roller, series: '2', bore: 40 mm, \
                    outside: 80 mm }, at: { speed: 1500 rpm, nu: 40 mm2/s, radial: 5000 N, axial: 500 N, oil_height: 0 mm } }",
            values: &[("M0", "72.8300 N mm"), ("M1", "90 N mm"), ("M2", "60 N mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { kind: spherical_roller, series: 222E, bore: 50 mm, outside: 90 mm, y: 2.8 }, at: { speed: 1000 rpm, \
                    nu: 40 mm2/s, radial: 10000 N, axial: 0 N, oil_height: 0 mm } }",
            values: &[("M1", "134.778516 N mm")],
            source: "by hand: 0.00015 10000^1.35 70^0.3",
            ..BY_HAND
        },
    ],
    limits: [AXIAL_RATIO, RADIAL_RATIO], terms: [LOAD, NO_LOAD], observed: [P1], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::bearing::testing::{moments, part};
    use gearloss_framework::mechanism::bearing::BearingKind;

    fn params() -> Iso14179 {
        Iso14179 {
            coefficients: Constants::PUBLISHED,
            f0: None,
            f1: None,
            exponent: 0.55,
            axial_factor: 3.0,
            f2: None,
        }
    }

    #[test]
    fn the_viscous_branch_begins_with_the_published_step() {
        let part = part(BearingKind::DeepGrooveBall, "63", 40.0, 90.0, Some(24000.0));
        let model = params().model(&part).unwrap();
        // The upper branch starts 0.8 % lower.
        let below = moments(&model, &part, [1999.9 / 15.0, 15.0, 0.0, 0.0], 0.0)[1];
        let above = moments(&model, &part, [2000.1 / 15.0, 15.0, 0.0, 0.0], 0.0)[1];
        assert!((above / below - 158.74 / 160.0).abs() < 1e-4);
    }

    #[test]
    fn needle_cages_have_a_row_and_ball_bearings_need_a_rating() {
        let cage = part(BearingKind::NeedleCage, "", 28.0, 33.0, None);
        let model = params().model(&cage).unwrap();
        assert_eq!((model.f0, model.law.z), (F0::Fixed(12.0), 0.002));
        let ball = part(BearingKind::DeepGrooveBall, "63", 40.0, 90.0, None);
        assert!(params().model(&ball).unwrap_err().0.contains("c0"));
    }

    #[test]
    fn a_missing_series_or_an_empty_cell_says_what_to_give() {
        let nameless = part(BearingKind::DeepGrooveBall, "", 40.0, 90.0, Some(24000.0));
        assert!(params().model(&nameless).unwrap_err().1.contains("63"));
        // With a written f1 and a single f0 for the bath, no series is required.
        assert!(
            Iso14179 {
                f1: Some(0.0009),
                ..params()
            }
            .model(&nameless)
            .is_ok()
        );
        let mut thrust = part(BearingKind::NeedleRollerThrust, "", 30.0, 52.0, None);
        assert_eq!(params().model(&thrust).unwrap().f0, F0::Fixed(5.0));
        thrust.lubrication = gearloss_framework::mechanism::bearing::Lubrication::OilAir;
        assert!(params().model(&thrust).unwrap_err().1.contains("f0"));
        assert_eq!(
            Iso14179 {
                f0: Some(4.0),
                ..params()
            }
            .model(&thrust)
            .unwrap()
            .f0,
            F0::Fixed(4.0)
        );
    }

    #[test]
    fn spherical_rollers_need_y() {
        let part = part(BearingKind::SphericalRoller, "222E", 50.0, 90.0, None);
        assert!(params().model(&part).unwrap_err().0.contains("`y`"));
    }

    #[test]
    fn without_load_only_the_oil_resists_and_rest_is_finite() {
        let part = part(BearingKind::DeepGrooveBall, "63", 40.0, 90.0, Some(24000.0));
        let model = params().model(&part).unwrap();
        let [load, no_load] = moments(&model, &part, [0.0, 15.0, 0.0, 0.0], 0.0);
        assert!(load == 0.0 && no_load > 0.0);
    }
}
