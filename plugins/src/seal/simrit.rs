//! Radial lip seals by a seal manufacturer's rule of thumb: an upper bound.
//!
//! Source: Freudenberg/Simrit, quoted from memory: P = 0.5 d v in W, d in mm, v circumferential speed in m/s. Three to four times the law of Linke.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { LIP = no_load("lip"); }

coefficients! {
    /// The constant of the rule.
    struct Constants {
        /// Power in W per mm of diameter and m/s of circumferential speed; other laws give a third to a quarter.
        factor = 0.5, in 0.1..=1.0;
    }
}

/// Radial lip seals by a manufacturer's rule of thumb: an upper bound.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Simrit {
    #[serde(default)]
    coefficients: Constants,
}

/// Friction torque from the diameter in m. \[Nm\]
fn moment(factor: f64, d: f64) -> f64 {
    factor * d.mm() * 0.5 * d
}

impl SealModel for Simrit {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        Ok(Loss::MOMENTS.with(
            &LIP,
            at.show("T", "Nm", moment(self.coefficients.factor, at.part.diameter)),
        ))
    }
}

register!(Seal, "simrit", Simrit,
    source: "Freudenberg/Simrit",
    example: "{ type: simrit }",
    evidence: [formula(Evidence::Disputed, "quoted from memory, not checked; three to four times other laws")],
    terms: [LIP]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_to_four_times_linke_at_40_mm() {
        let linke = 36.9120 / (3000.0 * std::f64::consts::PI / 30.0);
        assert!(
            (3.0..4.0).contains(&(moment(Constants::PUBLISHED.factor, 0.040) / linke)),
            "{}",
            moment(Constants::PUBLISHED.factor, 0.040) / linke
        );
    }
}
