//! Friction between flanks according to Misharin.
//!
//! Source: Misharin 1958, quoted from memory: mu = 0.325 (v_g v_S nu)^-0.25, nu in mm2/s, v_g and the sum velocity v_S in m/s. Stated for
//! 0.02 to 0.08, to which it is limited, and for Hertz pressures of 245 MPa and more; the range of slide-to-roll ratios is not
//! known.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, FrictionLimits, PathAt, ToothFriction, ToothFrictionLaw,
};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::observe_along;
use super::product::Product;
use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! {
    PRESSURE = ("p_H", "Hertzian pressure", "GPa", 0.245, 4.0, "Misharin, quoted from memory");
    SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.4, 100.0, "assumed, not stated by a source: gears with lubricant films");
}
observed! { MU = ("mu", "-", "coefficient of friction"); }

coefficients! {
    /// Constants of the formula of Misharin.
    struct Constants {
        /// Factor of the formula.
        factor = 0.325, in 0.1625..=0.65;
        /// Exponent of sliding velocity and sum velocity in m/s times viscosity in mm2/s.
        exponent = -0.25, in -0.5..=-0.125;
        /// Minimum coefficient of friction if `held` is true.
        least_friction = 0.02, in 0.005..=0.04;
        /// Maximum coefficient of friction if `held` is true.
        greatest_friction = 0.08, in 0.04..=0.16;
    }
}

/// Friction between flanks according to Misharin.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Misharin {
    /// Limit the coefficient to the stated 0.02 to 0.08.
    #[serde(default = "yes")]
    pub held: bool,
    /// Maximum coefficient of friction if `held` is false; boundary friction limits the growth of the formula near the pitch point
    /// and at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn yes() -> bool {
    true
}

impl Misharin {
    /// What changes along a path.
    #[inline(always)]
    fn product(&self) -> Product {
        let exponent = self.coefficients.exponent;
        Product {
            sliding: exponent,
            sum_speed: exponent,
            radius: 0.0,
            line_load: 0.0,
        }
    }

    /// The rest of the formula.
    #[inline(always)]
    fn factor<R: Real>(&self, nu: R) -> R {
        nu.mm2_s().power(self.coefficients.exponent) * self.coefficients.factor
    }
}

impl ToothFrictionLaw for Misharin {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        at.check(&PRESSURE, at.pressure.gpa());
        at.check(&SUM_SPEED, at.sum_speed);
        let mu = self.factor(at.nu) * self.product().logarithm(at).exp();
        at.observe(&MU, self.cut_off(mu));
        Ok(mu)
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let unit_pressure = path.unit_pressure().gpa();
        for end in 0..2 {
            path.notes.check(&PRESSURE, unit_pressure * path.extent.root_load[end]);
            path.notes.check(&SUM_SPEED, path.speed * path.extent.sum_speed[end]);
        }
        self.product().along(path, self.factor(path.nu), mu);
        observe_along(path, &MU, mu.iter().map(|mu| self.cut_off(*mu)));
        Ok(Along::default())
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        let limits = FrictionLimits::up_to(self.greatest).diverging();
        Some(if self.held {
            FrictionLimits {
                least: self.coefficients.least_friction,
                greatest: self.coefficients.greatest_friction,
                ..limits
            }
        } else {
            limits
        })
    }
}

register!(ToothFriction, "misharin", Misharin,
    source: "Misharin 1958",
    example: "{ type: misharin }",
    evidence: [
        formula(Evidence::Recalled, "formula quoted from memory of reviews, not checked"),
        default_of("held", Evidence::Recalled, "the range stated with the formula"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ at: { sliding: 2 m/s, sum_speed: 10 m/s, nu: 20 mm2/s } }",
            values: &[("total", "0.0726722")],
            ..SIX_DIGITS
        },
    ],
    limits: [PRESSURE, SUM_SPEED], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    fn law(held: bool) -> Misharin {
        Misharin {
            coefficients: Constants::PUBLISHED,
            held,
            greatest: 0.2,
        }
    }

    #[test]
    fn the_coefficient_is_cut_off_at_the_pitch_point() {
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.sliding = 2.0;
            to.sum_speed = 10.0;
            to.nu = 20e-6;
        });
        let still = at.with(|to| to.sliding = 0.0);
        for (held, greatest) in [(true, 0.08), (false, 0.2)] {
            assert_eq!(law(held).cut_off(law(held).mu(&still).unwrap()), greatest);
        }
    }
}
