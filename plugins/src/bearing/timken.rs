//! Tapered roller bearings according to the Timken catalogue.
//!
//! Source: Timken, Bearing engineering manual, quoted from memory: M = 2.56e-6 G1 (n mu)^0.62 F^0.3 in N m; n in 1/min, mu in mPa s, F in N, G1 a
//! geometry factor of the bearing from the catalogue (10 to 100 for bores of 25 to 60 mm), with K = 0.389 cot(half cup angle) =
//! Y/1.028: F = Fa for K Fa/Fr above 2, 0.06 Fr/K below 0.47. Between them the catalogue has a chart; by a convention of this
//! program F = f Fr/K with f linear in K Fa/Fr from 0.06 to 2. Single row. Below a minimum speed of the catalogue the torque is
//! nearly constant.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, BearingLaw};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { LOAD = load("load"); }
observed! { FORCE = ("F_eff", "N", "equivalent load of the torque"); }

coefficients! {
    /// Constants of the formula of Timken.
    struct Constants {
        /// Factor of the formula, for N m, 1/min, mPa s and N.
        factor = 2.56e-6, in 1.28e-6..=5.12e-6;
        /// Exponent of speed times viscosity.
        speed_exponent = 0.62, in 0.31..=1.24;
        /// Exponent of the load.
        load_exponent = 0.3, in 0.15..=0.6;
        /// K Fa/Fr above which only the axial load counts.
        thrust_ratio = 2.0, in 1.0..=4.0;
        /// K Fa/Fr below which only the radial load counts.
        radial_ratio = 0.47, in 0.235..=0.94;
        /// Factor of Fr/K below that value.
        radial_factor = 0.06, in 0.03..=0.12;
    }
}

/// Tapered roller bearings according to the Timken catalogue.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Geometry factor G1 of the bearing. [-]
    #[schemars(range(min = 0.1, max = 100_000.0))]
    pub g1: f64,
    /// Factor K of the bearing; default: its axial factor Y over 1.028. [-]
    #[schemars(range(min = 0.1, max = 5.0))]
    pub k: Option<f64>,
    /// Speed below which the torque is constant. [rpm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub least_speed: f64,
    #[serde(default)]
    coefficients: Constants,
}

struct Timken {
    coefficients: Constants,
    g1: f64,
    k: f64,
    least_speed: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Timken, Diagnostic> {
    let part = cx.own_part::<Bearing>()?;
    if part.kind != BearingKind::TaperedRoller {
        return Err(cx
            .error("timken applies to tapered roller bearings only")
            .help("give this bearing its own model, such as `model: { type: skf }`"));
    }
    if part.churning() != 1.0 {
        return Err(cx
            .error("timken has no law of the churning of grease")
            .help("omit `grease.churning`, or choose `skf` or `iso14179_2` for this bearing"));
    }
    let k = params.k.or(part.y.map(|y| y / 1.028)).ok_or_else(|| {
        cx.error("timken requires `k`, or `y` of the bearing")
            .help("add `k:` to the model or `y:` to the bearing")
    })?;
    if k <= 0.0 {
        return Err(cx
            .error("K of the bearing is zero")
            .help("correct `y:` of the bearing, or add `k:` to the model"));
    }
    Ok(Timken {
        coefficients: params.coefficients,
        g1: params.g1,
        k,
        least_speed: params.least_speed,
    })
}

impl Timken {
    #[inline(always)]
    fn force<R: Real>(&self, fr: R, fa: R) -> R {
        let ratio = fa * self.k / fr;
        let c = &self.coefficients;
        let (most, least, factor) = (c.thrust_ratio, c.radial_ratio, c.radial_factor);
        let line = (ratio - least) * ((most - factor) / (most - least)) + factor;
        let radial = R::select(ratio.is_above(R::constant(least)), line, R::constant(factor)) * fr / self.k;
        // Without radial load there is no ratio, or it is infinite.
        R::select(ratio.is_below(R::constant(most)), radial, fa)
    }

    /// Moment from 1/min, mPa s and N. \[Nm\]
    #[inline(always)]
    fn moment<R: Real>(&self, n: R, mu: R, force: R) -> R {
        let c = &self.coefficients;
        (n * mu).power(c.speed_exponent) * (c.factor * self.g1) * force.power(c.load_exponent)
    }
}

impl BearingLaw for Timken {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let n = at.speed.abs().at_least(self.least_speed).rpm();
        let mu = at.show("mu", "mPa s", (at.nu * at.rho).mpa_s());
        let force = at.observe(&FORCE, self.force(at.radial, at.axial));
        Ok(Loss::MOMENTS.with(&LOAD, at.show("M", "Nm", self.moment(n, mu, force))))
    }
}

register!(Bearing, "timken", Params,
    source: "Timken, Bearing engineering manual",
    example: "{ type: timken, g1: 20, k: 1.6 }",
    part: "{ kind: tapered_roller, series: \"302\", bore: 30 mm, outside: 62 mm, width: 17.25 mm, c0: 44000 N, y: 1.6 }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; a straight line replaces a chart"),
        default_of("k", Evidence::Recalled, "relation to Y quoted from memory, not checked"),
        default_of("least_speed", Evidence::Assumed, "the user takes it from the catalogue"),
    ],
    checks: [
        Check {
            input: "{ model: { type: timken, g1: 20, k: 1.6 }, at: { speed: 2000 rpm, nu: 25 mm2/s, rho: 800 kg/m3, radial: 1000 N, \
                    axial: 2500 N } }",
            values: &[("F_eff", "2500 N"), ("moment", "0.381882 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [LOAD], observed: [FORCE], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: Timken = Timken {
        coefficients: Constants::PUBLISHED,
        g1: 20.0,
        k: 1.6,
        least_speed: 0.0,
    };

    #[test]
    fn the_load_is_steady_over_all_ratios() {
        let mut before = MODEL.force(1000.0, 0.0);
        for fa in 1..200 {
            let now = MODEL.force(1000.0, 10.0 * f64::from(fa));
            assert!(now >= before && now - before < 30.0);
            before = now;
        }
    }
}
