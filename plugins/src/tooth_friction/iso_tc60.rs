//! Friction between flanks according to a working draft of ISO TC 60.
//!
//! Source: ISO/TC 60 draft as quoted in reviews: mu = 0.12 (w S/(R v_e eta))^0.25; w in N/mm, S rms roughness of both flanks in um,
//! R in mm, v_e mean rolling speed in m/s, eta in mPa s. A public SI form with 0.0254 and the sum velocity is the same.

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
use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! { ROLLING = ("v_e", "entraining velocity", "m/s", 0.2, 50.0, "assumed, not stated by a source: gears with lubricant films"); }
observed! { MU = ("mu", "-", "coefficient of friction"); }

coefficients! {
    /// Constants of the formula of the draft.
    struct Constants {
        /// Factor of the formula.
        factor = 0.12, in 0.06..=0.24;
        /// Exponent of load times roughness over radius, rolling speed and viscosity.
        exponent = 0.25, in 0.1..=0.5;
    }
}

/// Friction between flanks according to a working draft of ISO TC 60.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct IsoTc60 {
    /// Maximum coefficient of friction; boundary friction limits the growth of the formula at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

impl IsoTc60 {
    /// What changes along a path.
    #[inline(always)]
    fn product(&self) -> Product {
        let exponent = self.coefficients.exponent;
        Product {
            sliding: 0.0,
            sum_speed: -exponent,
            radius: -exponent,
            line_load: exponent,
        }
    }

    /// The rest of the formula, from roughness and viscosity.
    #[inline(always)]
    fn factor<R: Real>(&self, rq: R, eta: R) -> R {
        let c = &self.coefficients;
        // In units of the formula: N/mm over mm times the mean rolling speed, half of the sum of the speeds.
        let ratio = R::constant(2.0).n_mm() / R::constant(1.0).mm() * rq.um() / eta.mpa_s();
        ratio.power(c.exponent) * c.factor
    }
}

impl ToothFrictionLaw for IsoTc60 {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        entraining(at.sum_speed)?;
        at.check(&ROLLING, at.sum_speed * 0.5);
        let mu = self.factor(at.rq, at.eta) * self.product().logarithm(at).exp();
        at.observe(&MU, self.cut_off(mu));
        Ok(mu)
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        for sum_speed in path.extent.sum_speed {
            let rolling = entraining(path.speed * sum_speed)? * 0.5;
            path.notes.check(&ROLLING, rolling);
        }
        self.product().along(path, self.factor(path.rq, path.eta), mu);
        observe_along(path, &MU, mu.iter().map(|mu| self.cut_off(*mu)));
        Ok(Along::default())
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        Some(FrictionLimits::up_to(self.greatest))
    }
}

register!(ToothFriction, "iso_tc60", IsoTc60,
    source: "ISO/TC 60 working draft, as quoted in reviews",
    example: "{ type: iso_tc60 }",
    evidence: [
        formula(Evidence::OneSource, "one public source and memory agree"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ at: { line_load: 300 N/mm, rq: 0.4 um, radius: 10 mm, sum_speed: 10 m/s, eta: 20 mPa s } }",
            values: &[("total", "0.0706279")],
            ..SIX_DIGITS
        },
    ],
    limits: [ROLLING], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    const LAW: IsoTc60 = IsoTc60 {
        coefficients: Constants::PUBLISHED,
        greatest: 0.2,
    };

    #[test]
    fn creeping_contacts_are_cut_off_and_rest_is_undefined() {
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.line_load = 3e5;
            to.rq = 0.4e-6;
            to.radius = 10e-3;
            to.sum_speed = 10.0;
            to.eta = 20e-3;
        });
        assert_eq!(LAW.cut_off(LAW.mu(&at.with(|to| to.sum_speed = 1e-6)).unwrap()), 0.2);
        let fault = LAW.mu(&at.with(|to| to.sum_speed = 0.0)).unwrap_err();
        assert!(fault.what.starts_with("sum of the surface speeds"), "{fault}");
    }
}
