//! Mesh loss according to ISO/TR 14179-1, of AGMA origin.
//!
//! Source: ISO/TR 14179-1:2001, quoted from memory: P = f_m T1 n1 cos^2 beta_w/(9549 M) in kW, M = 2 cos alpha_w (H_s + H_t)/(H_s^2 + H_t^2),
//! f_m = nu^-0.223 K^-0.40/(3.239 v^0.70), K = 1000 T1 (z1 + z2)/(2 b r_w1^2 z2) in N/mm2; z2 - z1 for internal pairs. Gear 1 is the
//! one with fewer teeth. The geometry factor 1/M is that of an evenly shared load, which a derivation confirms for spur gears. For
//! oils of ISO VG 150 to 460, 2 to 25 m/s and K from 1.4 to 14 N/mm2. Its friction falls with load, contrary to other laws, and is
//! about a third of theirs.

use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { SLIDING = load("sliding"); }
limits! {
    SPEED = ("v", "pitch line velocity", "m/s", 2.0, 25.0, "ISO/TR 14179-1");
    K_FACTOR = ("K", "K factor of the load", "N/mm2", 1.4, 14.0, "ISO/TR 14179-1");
}
observed! {
    F_M = ("f_m", "-", "mesh coefficient of friction");
    M = ("M", "-", "mesh mechanical advantage");
}

coefficients! {
    /// Constants of the mesh coefficient of friction f_m.
    struct Constants {
        /// Divisor of the formula.
        divisor = 3.239, in 1.6195..=6.478;
        /// Exponent of the kinematic viscosity in mm2/s.
        viscosity_exponent = -0.223, in -0.446..=-0.1115;
        /// Exponent of K in N/mm2.
        load_exponent = -0.40, in -0.8..=-0.2;
        /// Exponent of the pitch line speed in m/s, in the divisor.
        speed_exponent = 0.70, in 0.35..=1.4;
    }
}

/// Mesh loss according to ISO/TR 14179-1, of AGMA origin.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    /// Maximum coefficient of friction; bounds the growth of the formula at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 10.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

/// Higher than boundary friction, which the formula already exceeds under light loads at normal speeds.
fn greatest() -> f64 {
    1.0
}

/// Sliding ratios at the start of approach and the end of recess, H_s and H_t.
fn sliding_ratios(pair: &Pair) -> [f64; 2] {
    let (cos, sin) = (pair.working_angle.cos(), pair.working_angle.sin());
    let tip = |gear: usize| (0.5 * pair.tip_diameter[gear] / pair.working_radius[gear]).powi(2);
    let root = |gear: usize| (tip(gear) - cos * cos).max(0.0).sqrt();
    if pair.internal {
        let u = pair.ratio();
        return [(u - 1.0) * (sin - root(1)), (u - 1.0) / u * (root(0) - sin)];
    }
    let (pinion, wheel) = if pair.z[0] <= pair.z[1] { (0, 1) } else { (1, 0) };
    let u = f64::from(pair.z[wheel]) / f64::from(pair.z[pinion]);
    [(u + 1.0) * (root(wheel) - sin), (u + 1.0) / u * (root(pinion) - sin)]
}

fn advantage(pair: &Pair) -> f64 {
    let [h_s, h_t] = sliding_ratios(pair);
    2.0 * pair.working_angle.cos() * (h_s + h_t) / (h_s * h_s + h_t * h_t)
}

/// f_m from viscosity in mm2/s, K in N/mm2, pitch line speed in m/s.
#[inline(always)]
fn friction<R: Real>(c: &Constants, nu: R, k: R, v: R) -> R {
    nu.power(c.viscosity_exponent) * k.power(c.load_exponent) / (v.power(c.speed_exponent) * c.divisor)
}

impl GearMeshLaw for Iso14179 {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let pair = &at.part.pair;
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let pinion = usize::from(pair.z[0] > pair.z[1]);
        let [z_1, z_2] = [pair.z[pinion], pair.z[1 - pinion]].map(f64::from);
        let ratio = pair.working_radius[pinion] / pair.working_radius[0];
        let torque = at.show("T1", "Nm", at.torque * ratio);
        let r_w = pair.working_radius[pinion].mm();
        let teeth = if pair.internal { z_2 - z_1 } else { z_1 + z_2 };
        let k = torque * 1000.0 * teeth / (2.0 * pair.facewidth.mm() * r_w * r_w * z_2);
        let k = at.check(&K_FACTOR, k);
        let v = at.check(&SPEED, at.speed.abs() * pair.working_radius[0]);
        let f_m = at.observe(
            &F_M,
            friction(&self.coefficients, at.nu.mm2_s(), k, v).at_most(self.greatest),
        );
        let m = at.observe(&M, R::constant(advantage(pair)));
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        let watts = f_m * input * pair.working_helix.cos().powi(2) / m;
        Ok(Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts)))
    }
}

register!(GearMesh, "iso14179_1", Iso14179,
    source: "ISO/TR 14179-1:2001",
    example: "{ type: iso14179_1 }",
    evidence: [
        formula(Evidence::Recalled, "coefficients of f_m quoted from memory; the geometry factor is derived"),
        default_of("greatest", Evidence::Assumed, "above the value of the formula under light loads at 0.1 m/s, far outside its range"),
    ],
    checks: [
        Check {
            input: "{ at: { torque: 200 Nm, speed: 1500 rpm, nu: 50 mm2/s } }",
            values: &[("K", "8.88707 N/mm2"), ("M", "4.17869"), ("f_m", "0.0158305")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ at: { torque: 200 Nm, speed: 1500 rpm, nu: 50 mm2/s } }",
            values: &[("total", "119.019 W")],
            tolerance: 4e-5,
            because: "the values have six digits, and 9549 replaces 30000/pi in the calculation of the torque",
            ..SIX_DIGITS
        },
    ],
    limits: [SPEED, K_FACTOR], terms: [SLIDING], observed: [F_M, M]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gear_mesh::path_integral::tests::{Kind, fzg_c14, pair_of};
    use gearloss_framework::loss::Notes;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn b6_sliding_ratios() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let [h_s, h_t] = sliding_ratios(&part.pair);
        close(h_s, 0.440628);
        close(h_t, 0.444122);
        close(1.0 / advantage(&part.pair), part.pair.loss_factor_uniform());
    }

    #[test]
    fn b6_friction_and_internal_ratios() {
        close(friction(&Constants::PUBLISHED, 100.0, 5.0, 10.0), 0.0115878);
        let [h_s, h_t] = sliding_ratios(&pair_of(Kind::Internal).pair);
        close(h_s, 0.14357);
        close(h_t, 0.131362);
    }

    #[test]
    fn either_gear_may_be_written_first() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let swapped = pair_of(Kind::Swapped);
        let watts = |part: &gearloss_framework::mechanism::gear_mesh::MeshPart, torque, speed| {
            let at = GearMeshAt::usual(part, Notes::MUTED).with(|to| {
                to.torque = torque;
                to.speed = speed;
                to.nu = 50e-6;
            });
            Iso14179 {
                coefficients: Constants::PUBLISHED,
                greatest: greatest(),
            }
            .loss(&at)
            .unwrap()
            .sum()
        };
        close(watts(&swapped, 300.0, 100.0), watts(&part, 200.0, 150.0));
    }
}
