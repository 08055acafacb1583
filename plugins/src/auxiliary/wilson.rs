//! Shaft torque of a displacement pump with pressure-dependent, viscous and constant friction, according to Wilson.
//!
//! Source: Wilson 1946, quoted from memory: T = V_g/(2 pi) (dp (1 + C_f) + C_v eta w) + T_c. The user states the coefficients of the pump.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! {
    PRESSURE = no_load("pressure");
    VISCOUS = no_load("viscous");
    CONSTANT = no_load("constant");
}

/// Displacement pump with pressure-dependent, viscous and constant friction, according to Wilson.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Wilson {
    /// Pressure rise. [bar]
    #[schemars(range(min = 0.0, max = 500.0))]
    pub pressure: f64,
    /// Displacement per turn. [cm3]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub displacement: f64,
    /// Coefficient C_f of pressure-dependent friction. [-]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub c_f: f64,
    /// Coefficient C_v of viscous friction. [-]
    #[schemars(range(min = 0.0, max = 1e8))]
    pub c_v: f64,
    /// Constant torque. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub t_c: f64,
}

impl AuxiliaryModel for Wilson {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        let volume = self.displacement / (2.0 * std::f64::consts::PI);
        let pressure = at.show("T_p", "Nm", volume * self.pressure * (1.0 + self.c_f));
        let viscous = at.show("T_v", "Nm", volume * self.c_v * at.eta * at.speed.abs());
        Ok(Loss::MOMENTS
            .with(&PRESSURE, pressure)
            .with(&VISCOUS, viscous)
            .with(&CONSTANT, self.t_c))
    }
}

register!(Auxiliary, "wilson", Wilson,
    source: "Wilson 1946",
    example: "{ type: wilson, pressure: 5 bar, displacement: 8 cm3, c_f: 0.05, c_v: 1e5, t_c: 0.05 Nm }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; the user states the coefficients"),
        default_of("t_c", Evidence::Assumed, "no constant part"),
    ],
    checks: [
        Check {
            input: "{ model: { type: wilson, pressure: 5 bar, displacement: 8 cm3, c_f: 0.05, c_v: 1e5, t_c: 0.05 Nm }, \
                    at: { speed: 2000 rpm, eta: 10 mPa s } }",
            values: &[("moment", "0.985117 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [PRESSURE, VISCOUS, CONSTANT]);
