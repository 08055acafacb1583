//! Friction between flanks according to Benedict and Kelley.
//!
//! Source: Benedict, Kelley: Instantaneous coefficients of gear tooth friction, ASLE Trans. 4 (1961) 59-70:
//! mu = 0.0127 lg(0.02966 w/(eta v_g v_S^2)) with w in N/m, eta in Pa s, v_g and the sum velocity v_S in m/s; the constant of the
//! inch form converts to this one. Roughness, quoted from memory, multiplies by 1.13/(1.13 - S), S in um rms of both flanks, below 1.13 um.
//! Diverges at the pitch point, where the loss still vanishes; limited to `greatest`. Zero where the logarithm is negative.

use std::f64::consts::LOG10_E;

use gearloss_framework::loss::{Notes, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, FrictionLimits, PathAt, ToothFriction, ToothFrictionLaw,
};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::observe_along;
use super::product::Product;
use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! { SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.4, 100.0, "assumed, not stated by a source: gears with lubricant films"); }
observed! { MU = ("mu", "-", "coefficient of friction"); }

coefficients! {
    /// Constants of the formula of Benedict and Kelley.
    struct Constants {
        /// Factor of the logarithm.
        factor = 0.0127, in 0.00635..=0.0254;
        /// Factor inside the logarithm, of the line load in N/m over viscosity in Pa s, sliding velocity and squared sum velocity
        /// in m/s.
        argument_factor = 0.02966, in 0.01483..=0.05932;
        /// Roughness in um at which the roughness factor diverges, where `roughness` is true.
        roughness_limit = 1.13, in 1.0..=2.26;
    }
}

/// Friction between flanks according to Benedict and Kelley.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct BenedictKelley {
    /// Apply the roughness factor.
    #[serde(default)]
    pub roughness: bool,
    /// Maximum coefficient of friction, which applies near the pitch point. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

/// What changes along a path.
const PRODUCT: Product = Product {
    sliding: -1.0,
    sum_speed: -2.0,
    radius: 0.0,
    line_load: 1.0,
};

impl BenedictKelley {
    /// The rest of the logarithm, and what multiplies it, from roughness and viscosity.
    #[inline(always)]
    fn rest<R: Real>(&self, notes: Notes<'_, R>, rq: R, eta: R) -> Result<[R; 2], Undefined> {
        let c = &self.coefficients;
        let rest = (R::constant(c.argument_factor) / eta).ln();
        let smooth = R::constant(c.factor * LOG10_E);
        if !self.roughness {
            return Ok([rest, smooth]);
        }
        let s = notes.show("S", "um", rq.um());
        let limit = R::constant(c.roughness_limit);
        if !s.is_below(limit).all() {
            return Err(Undefined {
                what: "roughness S of both flanks [um], which reaches the value at which the formula diverges",
                value: s.extremes(1).0,
            });
        }
        Ok([rest, smooth * limit / (limit - s)])
    }
}

impl ToothFrictionLaw for BenedictKelley {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let unloaded = at.line_load.is_zero();
        if unloaded.all() {
            at.branch("no load: no friction");
            return Ok(at.observe(&MU, R::ZERO));
        }
        let [rest, factor] = self.rest(at.notes, at.rq, at.eta)?;
        at.notes.among(!unloaded).check(&SUM_SPEED, at.sum_speed);
        let mu = (rest + PRODUCT.logarithm(at)) * factor;
        let mu = R::select(unloaded, R::ZERO, mu);
        at.observe(&MU, self.cut_off(mu));
        Ok(mu)
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let [rest, factor] = self.rest(path.notes, path.rq, path.eta)?;
        for sum_speed in path.extent.sum_speed {
            path.notes.check(&SUM_SPEED, path.speed * sum_speed);
        }
        PRODUCT.logarithms(path, mu);
        for (node, mu) in path.nodes.iter().zip(&mut *mu) {
            *mu = if node.share > 0.0 {
                (*mu + rest) * factor
            } else {
                R::ZERO
            };
        }
        observe_along(path, &MU, mu.iter().map(|mu| self.cut_off(*mu)));
        Ok(Along::default())
    }

    /// The logarithm grows without bound at the pitch point and where load vanishes.
    fn order(&self) -> usize {
        8
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        Some(FrictionLimits::up_to(self.greatest).diverging())
    }
}

register!(ToothFriction, "benedict_kelley", BenedictKelley,
    source: "Benedict, Kelley, ASLE Trans. 4 (1961) 59-70",
    example: "{ type: benedict_kelley }",
    evidence: [
        formula(Evidence::OneSource, "one public source; the inch form, quoted from memory, converts to it"),
        default_of("roughness", Evidence::Recalled, "roughness factor quoted from memory, not checked"),
        default_of("greatest", Evidence::Assumed, "the formula diverges at the pitch point"),
    ],
    checks: [
        Check {
            input: "{ model: { type: benedict_kelley, roughness: false }, at: { sliding: 2 m/s, sum_speed: 10 m/s, line_load: 300 N/mm, \
                    eta: 20 mPa s, rq: 0.4 um } }",
            values: &[("total", "0.0425102")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: benedict_kelley, roughness: true }, at: { sliding: 2 m/s, sum_speed: 10 m/s, line_load: 300 N/mm, \
                    eta: 20 mPa s, rq: 0.4 um } }",
            values: &[("total", "0.0658035")],
            ..SIX_DIGITS
        },
    ],
    limits: [SUM_SPEED], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::mechanism::NoPart;

    fn mu(roughness: bool, sliding: f64, line_load: f64) -> f64 {
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.line_load = line_load;
            to.eta = 20e-3;
            to.sliding = sliding;
            to.sum_speed = 10.0;
            to.rq = 0.4e-6;
        });
        let law = BenedictKelley {
            coefficients: Constants::PUBLISHED,
            roughness,
            greatest: 0.2,
        };
        law.cut_off(law.mu(&at).unwrap())
    }

    #[test]
    fn held_at_the_pitch_point_and_never_negative() {
        assert_eq!(
            (mu(false, 0.0, 3e5), mu(false, 2.0, 100.0), mu(false, 2.0, 0.0)),
            (0.2, 0.0, 0.0)
        );
    }
}
