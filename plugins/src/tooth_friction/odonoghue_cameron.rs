//! Friction between flanks according to O'Donoghue and Cameron.
//!
//! Source: O'Donoghue, Cameron: Friction and temperature in rolling sliding contacts, ASLE Trans. 9 (1966) 186-194, quoted from memory:
//! mu = 0.6 (S + 22)/35/(eta^(1/8) v_g^(1/3) v_S^(1/6) R^(1/2)), in inches: S centre line average in uin, eta in cP, speeds in in/s,
//! R in inches. With metres the result is absurd. S was that of the discs before running; here it is the mean Ra of the flanks. At
//! the pitch point, where the formula diverges and the loss vanishes, the coefficient is limited to `greatest`.

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

use super::product::Product;
use super::{entraining, observe_along};
use crate::checks::SIX_DIGITS;

limits! { SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.4, 100.0, "assumed, not stated by a source: gears with lubricant films"); }
observed! { MU = ("mu", "-", "coefficient of friction"); }

/// One inch. \[m\]
const INCH: f64 = 25.4e-3;

#[inline(always)]
fn microinches<R: Real>(roughness: R) -> R {
    roughness / INCH * 1e6
}

coefficients! {
    /// Constants of the formula of O'Donoghue and Cameron, in inches.
    struct Constants {
        /// Factor of the formula.
        factor = 0.6, in 0.3..=1.2;
        /// Roughness in uin added to that of the flanks.
        roughness_offset = 22.0, in 11.0..=44.0;
        /// Roughness in uin that divides the sum.
        roughness_divisor = 35.0, in 17.5..=70.0;
        /// Exponent of the viscosity in cP.
        viscosity_exponent = 0.125, in 0.0625..=0.25;
        /// Exponent of the sliding velocity in in/s.
        sliding_exponent = 1.0 / 3.0, in 1.0 / 6.0..=2.0 / 3.0;
        /// Exponent of the sum velocity in in/s.
        sum_speed_exponent = 1.0 / 6.0, in 1.0 / 12.0..=1.0 / 3.0;
        /// Exponent of the radius of curvature in inches.
        radius_exponent = 0.5, in 0.25..=1.0;
    }
}

/// Friction between flanks according to O'Donoghue and Cameron.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct ODonoghueCameron {
    /// Maximum coefficient of friction; boundary friction limits the growth of the formula near the pitch point and at creeping
    /// speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

/// Higher than boundary friction, which the formula already exceeds at normal speeds.
fn greatest() -> f64 {
    1.0
}

impl ODonoghueCameron {
    /// What changes along a path.
    #[inline(always)]
    fn product(&self) -> Product {
        let c = &self.coefficients;
        Product {
            sliding: -c.sliding_exponent,
            sum_speed: -c.sum_speed_exponent,
            radius: -c.radius_exponent,
            line_load: 0.0,
        }
    }

    /// The rest of the formula, from roughness in uin and viscosity.
    #[inline(always)]
    fn factor<R: Real>(&self, s: R, eta: R) -> R {
        let c = &self.coefficients;
        // Speeds and radius are in inches.
        let inches = INCH.power(c.sliding_exponent + c.sum_speed_exponent + c.radius_exponent);
        let viscosity = eta.mpa_s().power(c.viscosity_exponent);
        (s + c.roughness_offset) * (c.factor / c.roughness_divisor * inches) / viscosity
    }
}

impl ToothFrictionLaw for ODonoghueCameron {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let s = at.show("S", "uin", microinches(at.ra));
        at.check(&SUM_SPEED, entraining(at.sum_speed)?);
        let mu = self.factor(s, at.eta) * self.product().logarithm(at).exp();
        at.observe(&MU, self.cut_off(mu));
        Ok(mu)
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        for sum_speed in path.extent.sum_speed {
            path.notes.check(&SUM_SPEED, entraining(path.speed * sum_speed)?);
        }
        let s = path.notes.show("S", "uin", microinches(path.ra));
        self.product().along(path, self.factor(s, path.eta), mu);
        observe_along(path, &MU, mu.iter().map(|mu| self.cut_off(*mu)));
        Ok(Along::default())
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        Some(FrictionLimits::up_to(self.greatest).diverging())
    }
}

register!(ToothFriction, "odonoghue_cameron", ODonoghueCameron,
    source: "O'Donoghue, Cameron, ASLE Trans. 9 (1966) 186-194",
    example: "{ type: odonoghue_cameron }",
    evidence: [
        formula(Evidence::Recalled, "formula quoted from memory, not checked; the magnitude is plausible"),
        default_of("greatest", Evidence::Assumed, "above the value of the formula at normal speeds, unlike boundary friction"),
    ],
    checks: [
        Check {
            input: "{ at: { sliding: 1.999996 m/s, sum_speed: 9.99998 m/s, eta: 20 mPa s, ra: 0.3302 um, radius: 10.16 mm } }",
            values: &[("total", "0.0562212")],
            source: "independent implementation of the formula, in inches: 78.74 in/s, 393.7 in/s, 13e-6 in, 0.4 in",
            ..SIX_DIGITS
        },
    ],
    limits: [SUM_SPEED], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    const LAW: ODonoghueCameron = ODonoghueCameron {
        coefficients: Constants::PUBLISHED,
        greatest: 0.2,
    };

    #[test]
    fn the_pitch_point_is_cut_off_and_rest_is_undefined() {
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.sliding = 78.74 * INCH;
            to.sum_speed = 393.7 * INCH;
            to.eta = 20e-3;
            to.ra = 13e-6 * INCH;
            to.radius = 0.4 * INCH;
        });
        assert_eq!(LAW.cut_off(LAW.mu(&at.with(|to| to.sliding = 0.0)).unwrap()), 0.2);
        let fault = LAW.mu(&at.with(|to| to.sum_speed = 0.0)).unwrap_err();
        assert!(fault.what.starts_with("sum of the surface speeds"), "{fault}");
    }
}
