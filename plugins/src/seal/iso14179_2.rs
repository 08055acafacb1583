//! Radial lip seals according to ISO/TR 14179-2.
//!
//! Source: ISO/TR 14179-2:2001, clause on seals: P = [145 - 1.6 T + 350 lg lg(nu40 + 0.8)] d^2 n 1e-7, in W with T in degC,
//! nu40 in mm2/s, d in mm, n in 1/min. The power is linear in speed, so the torque is constant. Assumes one lip. The bracket falls
//! with temperature and is limited to zero. Not for non-contact seals, which have no loss here.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, limits, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { LIP = no_load("lip"); }

limits! {
    /// Above, the formula would give a negative loss: above about 128 degC with 30 mm2/s at 40 degC, or 157 degC with 100 mm2/s. The
    /// upper end exceeds any oil temperature.
    BRACKET = ("bracket", "bracket of the formula", "-", 0.0, 1000.0, "below, the power would be negative; it is set to zero");
}

coefficients! {
    /// Constants of the bracket of ISO/TR 14179-2.
    struct Constants {
        /// Constant of the bracket.
        constant = 145.0, in 72.5..=290.0;
        /// Decrease of the bracket per degC.
        temperature_factor = 1.6, in 0.8..=3.2;
        /// Factor of lg lg(nu40 + 0.8).
        viscosity_factor = 350.0, in 175.0..=700.0;
    }
}

/// Radial lip seals according to ISO/TR 14179-2.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    #[serde(default)]
    coefficients: Constants,
}

impl SealModel for Iso14179 {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("non-contact seal");
            return Ok(Loss::MOMENTS);
        }
        let lg = (at.nu40.mm2_s() + 0.8).log10().log10();
        let c = &self.coefficients;
        let bracket =
            c.constant - c.temperature_factor * at.show("T_oil", "degC", at.temperature) + c.viscosity_factor * lg;
        if bracket < 0.0 {
            at.branch("the bracket is negative: set to zero");
        }
        let bracket = at.check(&BRACKET, bracket).max(0.0);
        let d = at.show("d", "mm", at.part.diameter.mm());
        // Power per speed: n in 1/min is 30/pi times the speed in rad/s.
        let moment = bracket * d * d * 1e-7 * 1.0_f64.rpm();
        Ok(Loss::MOMENTS.with(&LIP, at.show("M", "Nm", moment)))
    }
}

register!(Seal, "iso14179_2", Iso14179,
    source: "ISO/TR 14179-2:2001",
    example: "{ type: iso14179_2 }",
    evidence: [formula(Evidence::OneSource, "one published source; magnitude checked against Linke's diagram")],
    checks: [
        Check {
            input: "{ part: { diameter: 40 mm }, at: { speed: 3000 rpm, temperature: 70 degC, nu40: 30 mm2/s } }",
            values: &[("total", "44.8643 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { diameter: 40 mm }, at: { speed: 3000 rpm, temperature: 60 degC, nu40: 100 mm2/s } }",
            values: &[("total", "74.2192 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { diameter: 40 mm }, at: { speed: 3000 rpm, temperature: 150 degC, nu40: 30 mm2/s } }",
            values: &[("total", "0 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [BRACKET], terms: [LIP]);

#[cfg(test)]
mod tests {
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::seal::SealPart;

    #[test]
    fn the_moment_does_not_depend_on_speed_and_a_seal_without_contact_has_none() {
        let moment = |kind, speed| {
            let part = SealPart {
                diameter: 0.040,
                kind,
                material: None,
            };
            let at = SealAt::usual(&part, Notes::MUTED).with(|to| to.speed = speed);
            Iso14179 {
                coefficients: Constants::PUBLISHED,
            }
            .loss(&at)
            .map_or(f64::NAN, |loss| loss.total_moment(speed))
        };
        // The power is linear in speed, so the torque has a finite limit at standstill.
        assert!(moment(SealKind::RadialLip, 0.0) > 0.0);
        assert_eq!(moment(SealKind::RadialLip, 0.0), moment(SealKind::RadialLip, -300.0));
        assert_eq!(moment(SealKind::NonContact, 300.0), 0.0);
    }
}
