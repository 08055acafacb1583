//! Static safety of rolling bearings according to ISO 76.
//!
//! Source: ISO 76:2006: S0 = C0/P0 with P0 = X0 Fr + Y0 Fa, for radial bearings at least Fr, for thrust bearings Fa. X0 and Y0 are those of
//! the kind: 0.6 and 0.5 for deep groove, 0.5 and the Y0 of the catalogue for tapered and single-row angular contact, 1 and Y0 for
//! self-aligning, spherical roller and double-row angular contact, 1 and 0.58 for four-point contact bearings.
//! Roller bearings and shocks need more than 1: 1.5 and more, drawn cup needle roller bearings 3, according to catalogues.

use gearloss_framework::loads::StaticFactors;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, BearingPart};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const P0: Figure = Figure::greatest("P0", "N", "equivalent static load").detail();
const S0: Figure = Figure::least("S0", "-", "static safety");

/// Static safety of a rolling bearing according to ISO 76.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso76 {
    /// Static safety below which the bearing is reported. [-]
    #[serde(default = "least_safety")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_safety: f64,
}

fn least_safety() -> f64 {
    1.0
}

/// Factors of P0; `None` if the data of the bearing do not suffice.
fn factors(part: &BearingPart) -> Option<StaticFactors> {
    part.static_factors().or_else(|| match part.kind {
        BearingKind::AngularContactBallDoubleRow => Some(StaticFactors::radial(1.0, part.y0?)),
        BearingKind::FourPointContactBall => Some(StaticFactors::radial(1.0, 0.58)),
        _ => None,
    })
}

impl Rating<Bearing> for Iso76 {
    fn rate(&self, at: &BearingAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let (Some(c0), Some(factors)) = (at.part.c0, factors(at.part)) else {
            at.branch("`c0`, or `y0` of this kind of bearing, is not known: no static safety");
            return Ok(());
        };
        at.show("X0", "-", factors.radial);
        at.show("Y0", "-", factors.axial);
        let load = at.show("P0", "N", factors.load(at.radial, at.axial.abs()));
        to.add(&P0, load);
        if load > 0.0 {
            to.add_bounded(&S0, at.show("S0", "-", c0 / load), Bound::at_least(self.least_safety));
        }
        Ok(())
    }
}

register_rating!(Bearing, "iso_76", Iso76,
    source: "ISO 76:2006",
    evidence: [
        formula(Evidence::SeveralSources, "catalogues of several makers; the factors of four-point contact bearings are recalled"),
        default_of("least_safety", Evidence::SeveralSources, "ball bearings in smooth operation; other bearings need more"),
    ],
    checks: [
        Check {
            input: "{ part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { radial: 3000 N, \
                    axial: 1000 N } }",
            values: &[("P0", "3000 N")],
            tolerance: 1e-12,
            because: "the sum is exact",
            source: "by hand: max(Fr, 0.6 Fr + 0.5 Fa)",
        },
        Check {
            input: "{ part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { radial: 1000 N, \
                    axial: 3000 N } }",
            values: &[("P0", "2100 N")],
            tolerance: 1e-12,
            because: "the sum is exact",
            source: "by hand: max(Fr, 0.6 Fr + 0.5 Fa)",
        },
        Check {
            input: "{ part: { kind: angular_contact_ball, bore: 40 mm, outside: 80 mm, c0: 26000 N, y0: 0.26 }, at: { radial: 2000 N, \
                    axial: 10000 N } }",
            values: &[("P0", "3600 N")],
            tolerance: 1e-12,
            because: "the sum is exact",
            source: "by hand: max(Fr, 0.5 Fr + 0.26 Fa)",
        },
        Check {
            input: "{ part: { kind: tapered_roller, bore: 30 mm, outside: 62 mm, c0: 44000 N, y0: 0.9 }, at: { radial: 3000 N, \
                    axial: 5000 N } }",
            values: &[("P0", "6000 N")],
            tolerance: 1e-12,
            because: "the sum is exact",
            source: "by hand: max(Fr, 0.5 Fr + Y0 Fa)",
        },
        Check {
            input: "{ part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, c0: 24000 N }, at: { radial: 3000 N, \
                    axial: 1000 N } }",
            values: &[("S0", "8")],
            tolerance: 1e-12,
            because: "the quotient is exact",
            source: "by hand: 24000 N/3000 N",
        },
    ],
    figures: [P0, S0]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::testing::{assert_close, rate};

    /// The overloaded bearing of a gearbox that passed unnoticed: a 6010 under 44 kN.
    #[test]
    fn an_overloaded_6010_is_reported() {
        let part = "{ kind: deep_groove_ball, bore: 50 mm, outside: 80 mm, c0: 16000 N }";
        let rated = rate(
            "iso_76",
            &format!("{{ part: {part}, at: {{ radial: 44000 N, axial: 0 N }} }}"),
        );
        let found = rated.rated.figures().iter().find(|f| f.is_outside()).unwrap();
        assert_close(found.value, 0.3636, 1e-3);
        assert_eq!(found.fault(), Some(("below", 1.0)));
    }

    #[test]
    fn without_data_there_is_no_rating() {
        let part = "{ kind: tapered_roller, bore: 30 mm, outside: 62 mm, c0: 44000 N }";
        assert!(
            rate("iso_76", &format!("{{ part: {part} }}"))
                .rated
                .figures()
                .is_empty()
        );
    }
}
