//! An auxiliary with the same power at any speed, such as a controlled alternator.
//!
//! User-defined. At standstill it consumes no power. At vanishing speed its torque would grow without bound, so below `least_speed`
//! the torque stays at its value at that speed.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Evidence, USER_DEFINED, default_of, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { POWER = no_load("power"); }

/// The same power at any speed.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct ConstantPower {
    /// Power taken from the shaft. [W]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power: f64,
    /// Speed below which the torque is constant. [rpm]
    #[serde(default = "default_least_speed")]
    #[schemars(range(min = 0.01, max = 1e5))]
    pub least_speed: f64,
}

/// 100 rpm. \[rad/s\]
fn default_least_speed() -> f64 {
    100.0 * std::f64::consts::PI / 30.0
}

impl AuxiliaryModel for ConstantPower {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        Ok(Loss::MOMENTS.with(&POWER, self.power / at.speed.abs().max(self.least_speed)))
    }
}

register!(Auxiliary, "constant_power", ConstantPower,
    source: USER_DEFINED,
    example: "{ type: constant_power, power: 150 W }",
    evidence: [
        formula(Evidence::User, "the user states it"),
        default_of("least_speed", Evidence::Assumed, "keeps the torque finite"),
    ],
    terms: [POWER]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    #[test]
    fn power_stays_and_vanishes_with_speed() {
        let law = ConstantPower {
            power: 150.0,
            least_speed: 10.0,
        };
        let watts = |speed: f64| {
            let at = AuxiliaryAt::usual(&NoPart {}, Notes::MUTED).with(|to| to.speed = speed);
            law.loss(&at).unwrap().total_watts(speed)
        };
        assert!((watts(200.0) - 150.0).abs() < 1e-9 && (watts(-20.0) - 150.0).abs() < 1e-9);
        assert_eq!((watts(5.0), watts(0.0)), (75.0, 0.0));
    }
}
