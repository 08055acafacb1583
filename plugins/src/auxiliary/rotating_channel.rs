//! Torque that oil takes from a shaft while it flows outwards in channels of it.
//!
//! Source: the momentum theorem, T = rho Q w (r_2^2 - k r_1^2), with the share k of the shaft's swirl that the oil has at the inlet. Flow,
//! radii and swirl are those of `oil_network`, which has the pressure that the rotation adds. The oil leaves with the speed of the outlet;
//! half of the power is its kinetic energy, the other half lifts its pressure. All of it heats the oil in the end.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { MOMENTUM = no_load("momentum"); }
observed! { FLOW = ("Q", "l/min", "flow through the channels"); }

/// Oil that rotating channels fling outwards.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Rotating channels of the oil network.
    #[schemars(extend("x-refers-to" = "oil_network.rotating_channels"))]
    pub channel: String,
}

struct RotatingChannel;

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<RotatingChannel, Diagnostic> {
    cx.oil_element("rotating_channels", &params.channel)?;
    Ok(RotatingChannel)
}

impl AuxiliaryModel for RotatingChannel {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        at.observe(&FLOW, at.flow * 6e4);
        Ok(Loss::MOMENTS.with(&MOMENTUM, at.show("T", "Nm", at.oil_torque)))
    }
}

register!(Auxiliary, "rotating_channel", Params,
    source: "momentum theorem",
    example: "{ type: rotating_channel, channel: bore }",
    evidence: [formula(Evidence::Derived, "the change of the angular momentum of the oil")],
    checks: [
        Check {
            input: "{ model: { type: rotating_channel, channel: bore }, at: { speed: 6000 rpm, flow: 1 l/min, oil_torque: 3.47670e-3 Nm } }",
            values: &[("total", "2.18447 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [MOMENTUM], observed: [FLOW], prepare: prepare);
