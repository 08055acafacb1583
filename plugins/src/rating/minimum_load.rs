//! Minimum load of rolling bearings, below which rolling elements slide.
//!
//! Sources: pages of the SKF catalogue: 0.02 C for needle roller, 0.007 C0 for toroidal roller bearings with a cage and 0.01 C0 without,
//! 0.01 C0 for spherical roller bearings; with the k_r of the catalogue (nu n/1000)^(2/3) (d_m/100)^2 k_r in kN for deep groove ball and
//! (6 + 4 n/n_r)(d_m/100)^2 k_r for cylindrical roller bearings; nu in mm2/s, n in 1/min, d_m in mm. The formulas with k_r, and 0.01 C for
//! the other ball and 0.02 C for the other roller bearings, are quoted from memory.
//! The larger one of radial and axial load is compared. An oil that is cold at the start needs more. Thrust bearings are not rated.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const MINIMUM: Figure = Figure::greatest("F_m", "N", "minimum load").detail();
const RATIO: Figure = Figure::least("F/F_m", "-", "load over minimum load");

/// Minimum load of a rolling bearing.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct MinimumLoad {
    /// Load over minimum load below which the bearing is reported. [-]
    #[serde(default = "least_ratio")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_ratio: f64,
}

fn least_ratio() -> f64 {
    1.0
}

/// Minimum load at a point; `None` if the data of the bearing do not suffice. \[N\]
fn minimum(at: &BearingAt<'_>) -> Option<f64> {
    let part = at.part;
    let n = at.speed.rpm().abs();
    let size = (part.mean_diameter().mm() / 100.0).powi(2);
    let of_factor = part.minimum_load_factor.map(|k| 1e3 * k * size);
    match part.kind {
        BearingKind::DeepGrooveBall
        | BearingKind::DeepGrooveBallDoubleRow
        | BearingKind::AngularContactBallDoubleRow => {
            let viscous = (at.nu.mm2_s() * n / 1000.0).powf(2.0 / 3.0);
            of_factor.map(|k| k * viscous).or_else(|| Some(0.01 * part.c?))
        }
        BearingKind::CylindricalRoller | BearingKind::CylindricalRollerFullComplement => of_factor
            .zip(part.reference_speed)
            .map(|(k, reference)| k * (6.0 + 4.0 * n / reference.rpm()))
            .or_else(|| Some(0.02 * part.c?)),
        BearingKind::NeedleCage | BearingKind::TaperedRoller => Some(0.02 * part.c?),
        BearingKind::SphericalRoller | BearingKind::ToroidalRollerFullComplement => Some(0.01 * part.c0?),
        BearingKind::ToroidalRoller => Some(0.007 * part.c0?),
        BearingKind::SelfAligningBall | BearingKind::AngularContactBall | BearingKind::FourPointContactBall => {
            Some(0.01 * part.c?)
        }
        BearingKind::ThrustBall
        | BearingKind::CylindricalRollerThrust
        | BearingKind::NeedleRollerThrust
        | BearingKind::SphericalRollerThrust
        | BearingKind::Plain
        | BearingKind::ThrustWasher => None,
    }
}

impl Rating<Bearing> for MinimumLoad {
    fn rate(&self, at: &BearingAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        if at.speed == 0.0 {
            at.branch("no relative speed: no minimum load");
            return Ok(());
        }
        let Some(minimum) = minimum(at) else {
            at.branch("no minimum load is known for this bearing");
            return Ok(());
        };
        to.add(&MINIMUM, at.show("F_m", "N", minimum));
        if minimum > 0.0 {
            let ratio = at.radial.max(at.axial.abs()) / minimum;
            to.add_bounded(&RATIO, at.show("F/F_m", "-", ratio), Bound::at_least(self.least_ratio));
        }
        Ok(())
    }
}

register_rating!(Bearing, "minimum_load", MinimumLoad,
    source: "SKF rolling bearings catalogue",
    evidence: [
        formula(Evidence::Recalled, "shares of C and C0 of four kinds are on pages of the maker; the others and the formulas with k_r from memory"),
        default_of("least_ratio", Evidence::OneSource, "the maker's requirement"),
    ],
    checks: [
        Check {
            input: "{ part: { kind: deep_groove_ball, bore: 40 mm, outside: 90 mm, minimum_load_factor: 0.03 }, at: { speed: 3000 rpm, \
                    nu: 15 mm2/s } }",
            values: &[("F_m", "160.36 N")],
            tolerance: 1e-3,
            because: "the powers were calculated by hand",
            source: "by hand: 0.03 (15 3000/1000)^(2/3) (65/100)^2 kN",
        },
        Check {
            input: "{ part: { kind: needle_cage, bore: 40 mm, outside: 90 mm, c: 50000 N, c0: 60000 N } }",
            values: &[("F_m", "1000 N")],
            tolerance: 1e-12,
            because: "the product is exact",
            source: "SKF catalogue, page of the kind of bearing: 0.02 C",
        },
        Check {
            input: "{ part: { kind: toroidal_roller, bore: 40 mm, outside: 90 mm, c: 50000 N, c0: 60000 N } }",
            values: &[("F_m", "420 N")],
            tolerance: 1e-12,
            because: "the product is exact",
            source: "SKF catalogue, page of the kind of bearing: 0.007 C0",
        },
        Check {
            input: "{ part: { kind: spherical_roller, bore: 40 mm, outside: 90 mm, c: 50000 N, c0: 60000 N } }",
            values: &[("F_m", "600 N")],
            tolerance: 1e-12,
            because: "the product is exact",
            source: "SKF catalogue, page of the kind of bearing: 0.01 C0",
        },
    ],
    figures: [MINIMUM, RATIO]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::testing::{assert_close, rate};

    #[test]
    fn a_load_below_the_minimum_is_reported() {
        let part = "{ kind: tapered_roller, bore: 30 mm, outside: 62 mm, c: 40000 N }";
        let rated = rate(
            "minimum_load",
            &format!("{{ part: {part}, at: {{ radial: 100 N, axial: 400 N }} }}"),
        );
        let found = rated.rated.figures().iter().find(|f| f.is_outside()).unwrap();
        assert_close(found.value, 0.5, 1e-12);
    }
}
