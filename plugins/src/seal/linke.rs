//! Radial lip seals according to Linke.
//!
//! Source: Linke, Stirnradverzahnung: P = 7.69e-6 d^2 n in W, d in mm, n in 1/min; one lip. The torque is independent of speed, oil
//! and temperature. Some programs attribute it to ISO/TR 14179-2, incorrectly.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { LIP = no_load("lip"); }

coefficients! {
    /// The constant of the formula of Linke.
    struct Constants {
        /// Factor of the power in W, for mm and 1/min.
        factor = 7.69e-6, in 3.845e-6..=15.38e-6;
    }
}

/// Radial lip seals according to Linke: torque from the square of the diameter.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Linke {
    #[serde(default)]
    coefficients: Constants,
}

/// Friction torque from the diameter in mm. \[Nm\]
fn moment(factor: f64, d: f64) -> f64 {
    factor * d * d / (std::f64::consts::PI / 30.0)
}

impl SealModel for Linke {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        Ok(Loss::MOMENTS.with(
            &LIP,
            at.show("T", "Nm", moment(self.coefficients.factor, at.part.diameter.mm())),
        ))
    }
}

register!(Seal, "linke", Linke,
    source: "Linke, Stirnradverzahnung",
    example: "{ type: linke }",
    evidence: [formula(Evidence::SeveralSources, "a public program, a list of methods and memory agree")],
    checks: [
        Check {
            input: "{ part: { diameter: 40 mm }, at: { speed: 3000 rpm } }",
            values: &[("total", "36.9120 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [LIP]);
