//! Friction of worm drives according to AGMA.
//!
//! Source: ANSI/AGMA 6034-B92, as two independent public programs and textbooks print it: with the sliding velocity v in ft/min, mu = 0.150 at
//! rest, 0.124 exp(-0.074 v^0.645) up to 10 ft/min and 0.103 exp(-0.110 v^0.450) + 0.012 above; the two curves differ by 2 % where they meet.
//! Worms of hardened steel and wheels of bronze, with the oils that AGMA recommends; oil, temperature and roughness are not in the formula.
//! Efficiency from forces as vectors, tan rho = mu/cos alpha_n.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::worm_mesh::{AtRest, WormMesh, WormMeshAt, WormMeshLaw, WormPart};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{BACK, EFFICIENCY, MU, SLIDING, of_friction};
use crate::checks::SIX_DIGITS;

/// One foot per minute. \[m/s\]
const FOOT_PER_MINUTE: f64 = 0.3048 / 60.0;
/// Sliding velocity at which the curves meet. \[ft/min\]
const SLOW: f64 = 10.0;

coefficients! {
    /// Constants of the curves of AGMA.
    struct Constants {
        /// Coefficient of friction at rest.
        rest = 0.150, in 0.05..=0.3;
        /// Factor of the curve of slow sliding.
        slow_factor = 0.124, in 0.062..=0.248;
        /// Factor in its exponential.
        slow_rate = 0.074, in 0.037..=0.148;
        /// Exponent of the velocity in ft/min in its exponential.
        slow_exponent = 0.645, in 0.3225..=1.0;
        /// Factor of the curve of fast sliding.
        fast_factor = 0.103, in 0.0515..=0.206;
        /// Factor in its exponential.
        fast_rate = 0.110, in 0.055..=0.22;
        /// Exponent of the velocity in ft/min in its exponential.
        fast_exponent = 0.450, in 0.225..=0.9;
        /// Coefficient of friction of very fast sliding.
        constant = 0.012, in 0.0..=0.024;
    }
}

/// Friction of worm drives according to AGMA, from the sliding velocity.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Agma {
    #[serde(default)]
    coefficients: Constants,
}

impl Agma {
    /// Coefficient of friction at a sliding velocity above zero. \[m/s\]
    #[inline(always)]
    fn mu<R: Real>(&self, sliding: R) -> R {
        let c = &self.coefficients;
        let v = sliding / FOOT_PER_MINUTE;
        let slow = (v.power(c.slow_exponent) * -c.slow_rate).exp() * c.slow_factor;
        let fast = (v.power(c.fast_exponent) * -c.fast_rate).exp() * c.fast_factor + c.constant;
        R::select(v.is_above(R::constant(SLOW)), fast, slow)
    }
}

impl WormMeshLaw for Agma {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &WormMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        Ok(of_friction(
            at,
            |at| self.mu(at.show("v_g", "m/s", at.sliding())),
            |mu| at.part.pair.tan_rho(mu),
        ))
    }

    fn at_rest(&self, part: &WormPart) -> Option<AtRest> {
        let friction = self.coefficients.rest;
        Some(AtRest::new(&part.pair, friction, part.pair.tan_rho(friction)))
    }
}

register!(WormMesh, "agma", Agma,
    source: "ANSI/AGMA 6034-B92, as printed in textbooks and public programs",
    example: "{ type: agma }",
    evidence: [
        formula(Evidence::SeveralSources, "two independent transcriptions agree; for hardened steel on bronze with the recommended oil, which the formula does not contain"),
    ],
    checks: [
        // Shigley's example: 2 threads, 30 teeth, diameter 2 in, axial pitch 0.5236 in, 1200 1/min; 637 ft/min.
        Check {
            input: "{ model: { type: agma }, part: { z: [2, 30], module: 4.233333 mm, worm_diameter: 50.8 mm, pressure_angle: 14.5 deg, \
                    facewidth: 25 mm }, at: { speed: 1200 rpm, torque: 10 Nm } }",
            values: &[("v_g", "3.23589 m/s"), ("mu_zm", "0.0257973")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: agma }, at: { speed: 1500 rpm, torque: 8.72383 Nm } }",
            values: &[("mu_zm", "0.0272149"), ("eta_z", "0.879006"), ("total", "165.802 W")],
            ..SIX_DIGITS
        },
        // 7.6 ft/min.
        Check {
            input: "{ model: { type: agma }, at: { speed: 20 rpm, torque: 8.72383 Nm, first_drives: 0 } }",
            values: &[("mu_zm", "0.0943000"), ("eta_z", "0.536453"), ("eta_back", "0.536453")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, EFFICIENCY, BACK]);
