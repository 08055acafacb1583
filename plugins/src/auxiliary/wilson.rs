//! Shaft torque of a displacement pump with pressure-dependent, viscous and constant friction, according to Wilson.
//!
//! Source: Wilson 1946, quoted from memory: T = V_g/(2 pi) (dp (1 + C_f) + C_v eta w) + T_c. The user states the coefficients of the pump.
//! A pump of the oil network, named by `pump`, has its displacement and pressure rise from there.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
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
pub struct Params {
    /// Pump of the oil network that gives pressure and displacement, instead of `pressure` and `displacement`.
    #[schemars(extend("x-refers-to" = "oil_network.pumps"))]
    pub pump: Option<String>,
    /// Pressure rise. [bar]
    #[schemars(range(min = 0.0, max = 500.0))]
    pub pressure: Option<f64>,
    /// Displacement per turn. [cm3]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub displacement: Option<f64>,
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

/// The law of a pump.
struct Wilson {
    /// Pressure rise and displacement; those of the oil network without. \[Pa and m3\]
    stated: Option<[f64; 2]>,
    c_f: f64,
    c_v: f64,
    t_c: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Wilson, Diagnostic> {
    let stated = match (&params.pump, params.pressure, params.displacement) {
        (Some(pump), None, None) => {
            cx.oil_element("pumps", pump)?;
            None
        }
        (None, Some(pressure), Some(displacement)) => Some([pressure, displacement]),
        (Some(pump), ..) => {
            return Err(cx
                .error(format!("the oil network states pressure and displacement of `{pump}`"))
                .help("remove `pressure` and `displacement`, or `pump`"));
        }
        (None, ..) => {
            return Err(cx.error("wilson requires a pressure and a displacement").help(
                "write `pressure: 5 bar` and `displacement: 8 cm3`, or name a pump of the oil network: `pump: main`",
            ));
        }
    };
    Ok(Wilson {
        stated,
        c_f: params.c_f,
        c_v: params.c_v,
        t_c: params.t_c,
    })
}

impl AuxiliaryModel for Wilson {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        let [pressure, displacement] = self.stated.unwrap_or([at.pressure, at.displacement]);
        let volume = displacement / (2.0 * std::f64::consts::PI);
        let pressure = at.show("T_p", "Nm", volume * pressure * (1.0 + self.c_f));
        let viscous = at.show("T_v", "Nm", volume * self.c_v * at.eta * at.speed.abs());
        Ok(Loss::MOMENTS
            .with(&PRESSURE, pressure)
            .with(&VISCOUS, viscous)
            .with(&CONSTANT, self.t_c))
    }
}

register!(Auxiliary, "wilson", Params,
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
        // The same pump in an oil network.
        Check {
            input: "{ model: { type: wilson, pump: main, c_f: 0.05, c_v: 1e5, t_c: 0.05 Nm }, \
                    at: { speed: 2000 rpm, eta: 10 mPa s, pressure: 5 bar, displacement: 8 cm3 } }",
            values: &[("moment", "0.985117 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [PRESSURE, VISCOUS, CONSTANT], prepare: prepare);
