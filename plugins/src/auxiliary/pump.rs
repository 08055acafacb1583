//! Shaft torque of an oil pump from pressure, flow and efficiency.
//!
//! Source: P = dp Q/eta (textbook; ISO/TR 14179-1 uses it with about 0.85). Either with a flow that is independent of speed, as
//! behind a flow regulator, or with a displacement per turn: T = dp V_g/(2 pi eta_hm), with the flow n V_g eta_vol for information.
//! All of the power heats the oil if the pressure is throttled inside the gearbox. A pump of the oil network, named by `pump`, has its
//! displacement and pressure rise from there.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { PUMP = no_load("pump"); }
observed! { FLOW = ("Q", "l/min", "flow that the pump delivers"); }

/// Oil pump from pressure, flow or displacement, and efficiency.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Pump of the oil network that gives pressure and displacement, instead of `pressure`, `flow` and `displacement`.
    #[schemars(extend("x-refers-to" = "oil_network.pumps"))]
    pub pump: Option<String>,
    /// Pressure rise. [bar]
    #[schemars(range(min = 0.0, max = 500.0))]
    pub pressure: Option<f64>,
    /// Flow at any speed, instead of a displacement. [l/min]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub flow: Option<f64>,
    /// Displacement per turn. [cm3]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub displacement: Option<f64>,
    /// Overall efficiency with a flow, hydraulic-mechanical efficiency with a displacement. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: f64,
    /// Volumetric efficiency with a displacement. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub volumetric_efficiency: f64,
    /// Speed below which the torque is constant, with a flow. [rpm]
    #[serde(default = "default_least_speed")]
    #[schemars(range(min = 0.01, max = 1e5))]
    pub least_speed: f64,
}

fn default_one() -> f64 {
    1.0
}

/// 100 rpm. \[rad/s\]
fn default_least_speed() -> f64 {
    100.0 * std::f64::consts::PI / 30.0
}

enum Pump {
    Flow { power: f64, flow: f64, least_speed: f64 },
    Displacement { moment: f64, per_radian: f64 },
    Network { efficiency: f64 },
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Pump, Diagnostic> {
    let turn = 2.0 * std::f64::consts::PI;
    if let Some(pump) = &params.pump {
        if params.pressure.is_some() || params.flow.is_some() || params.displacement.is_some() {
            return Err(cx
                .error(format!("the oil network states pressure and flow of `{pump}`"))
                .help("remove `pressure`, `flow` and `displacement`, or `pump`"));
        }
        cx.oil_element("pumps", pump)?;
        cx.leave_unused(["volumetric_efficiency", "least_speed"]);
        return Ok(Pump::Network {
            efficiency: params.efficiency,
        });
    }
    let Some(pressure) = params.pressure else {
        return Err(cx
            .error("pump requires a pressure")
            .help("write `pressure: 5 bar`, or name a pump of the oil network: `pump: main`"));
    };
    match (params.flow, params.displacement) {
        (Some(flow), None) => Ok(Pump::Flow {
            power: pressure * flow / params.efficiency,
            flow,
            least_speed: params.least_speed,
        }),
        (None, Some(volume)) => Ok(Pump::Displacement {
            moment: pressure * volume / (turn * params.efficiency),
            per_radian: volume * params.volumetric_efficiency / turn,
        }),
        _ => Err(cx
            .error("pump requires either `flow` or `displacement`")
            .help("write `flow: 8 l/min` or `displacement: 12 cm3`")),
    }
}

impl AuxiliaryModel for Pump {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        let speed = at.speed.abs();
        let (moment, flow) = match self {
            Self::Flow {
                power,
                flow,
                least_speed,
            } => (power / speed.max(*least_speed), *flow),
            Self::Displacement { moment, per_radian } => (*moment, per_radian * speed),
            Self::Network { efficiency } => (at.oil_torque / efficiency, at.flow),
        };
        at.observe(&FLOW, flow * 6e4);
        Ok(Loss::MOMENTS.with(&PUMP, at.show("T", "Nm", moment)))
    }
}

register!(Auxiliary, "pump", Params,
    source: "P = dp Q/eta; ISO/TR 14179-1:2001",
    example: "{ type: pump, pressure: 5 bar, flow: 8 l/min, efficiency: 0.5 }",
    evidence: [
        formula(Evidence::SeveralSources, "textbook"),
        default_of("volumetric_efficiency", Evidence::Assumed, "no leakage; affects the flow only"),
        default_of("least_speed", Evidence::Assumed, "keeps the torque finite"),
    ],
    checks: [
        Check {
            input: "{ model: { type: pump, pressure: 5 bar, flow: 8 l/min, efficiency: 0.5 }, at: { speed: 2000 rpm } }",
            values: &[("total", "133.333 W")],
            ..SIX_DIGITS
        },
        // dp V_g/(2 pi) = 0.636620 Nm.
        Check {
            input: "{ model: { type: pump, pump: main, efficiency: 0.5 }, at: { speed: 2000 rpm, pressure: 5 bar, displacement: 8 cm3, \
                    oil_torque: 0.636620 Nm } }",
            values: &[("moment", "1.27324 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [PUMP], observed: [FLOW], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    #[test]
    fn a_flow_and_its_displacement_take_the_same_power() {
        let pump = Pump::Flow {
            power: 5e5 * 8e-3 / 60.0 / 0.5,
            flow: 8e-3 / 60.0,
            least_speed: 1.0,
        };
        let at = AuxiliaryAt::usual(&NoPart {}, Notes::MUTED);
        let watts = pump.loss(&at).unwrap().total_watts(at.speed);
        // The same pump, described by its displacement at that speed.
        let turn = at.speed / (2.0 * std::f64::consts::PI);
        let volume = 8e-3 / 60.0 / turn;
        let by_volume = Pump::Displacement {
            moment: 5e5 * volume / (2.0 * std::f64::consts::PI * 0.5),
            per_radian: 0.0,
        };
        assert!((by_volume.loss(&at).unwrap().total_watts(at.speed) / watts - 1.0).abs() < 1e-12);
    }
}
