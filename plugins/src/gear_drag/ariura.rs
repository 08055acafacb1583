//! Torque of an oil jet on a gear, from its momentum.
//!
//! Source: Ariura, Ueno, Sunamoto 1973; the momentum balance: T = C rho Q r_w (v_t + v_s) for a jet against the motion of the rim,
//! v_t - v_s for a jet along it; C from 0.85 to 1. Computed once for each gear hit by a jet. A jet along the motion and faster than
//! the rim would drive the gear; the loss is then zero.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use gearloss_framework::mechanism::gear_drag::Scope;

use super::injected::Injected;
use crate::checks::SIX_DIGITS;

terms! { IMPULSE = no_load("impulse"); }

/// Torque of an oil jet on a gear, from its momentum.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Flow that hits the gear; not with `nozzle`. [l/min]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub flow: Option<f64>,
    /// Nozzle of the oil network whose flow it is; not with `flow`.
    #[schemars(extend("x-refers-to" = "oil_network.nozzles"))]
    pub nozzle: Option<String>,
    /// Speed of the jet: positive against the motion of the rim, negative along it. [m/s]
    #[serde(default)]
    #[schemars(range(min = -200.0, max = 200.0))]
    pub jet_speed: f64,
    /// Share of the momentum that acts on the gear: 0.85 to 1. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub c: f64,
}

fn default_one() -> f64 {
    1.0
}

struct Ariura {
    flow: Injected,
    jet_speed: f64,
    c: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ariura, Diagnostic> {
    Ok(Ariura {
        flow: Injected::new(params.flow, params.nozzle.as_deref(), cx)?,
        jet_speed: params.jet_speed,
        c: params.c,
    })
}

impl Ariura {
    fn torque(&self, flow: f64, rho: f64, r_w: f64, v_t: f64) -> f64 {
        (self.c * rho * flow * r_w * (v_t + self.jet_speed)).max(0.0)
    }
}

impl GearDragModel for Ariura {
    fn covers(&self) -> Option<Covers> {
        Some(Covers::default())
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let r_w = 0.5 * at.part.gear.working_diameter;
        if at.speed == 0.0 {
            at.branch("at standstill: no loss");
            return Ok(Loss::MOMENTS);
        }
        let torque = self.torque(
            self.flow.at(at),
            at.rho,
            r_w,
            at.show("v_t", "m/s", at.speed.abs() * r_w),
        );
        Ok(Loss::MOMENTS.with(&IMPULSE, at.show("T_I", "Nm", torque)))
    }
}

register!(GearDrag, "ariura", Params,
    source: "Ariura, Ueno, Sunamoto 1973; momentum balance",
    example: "{ type: ariura, flow: 2.5 l/min, jet_speed: 0.4 m/s }",
    evidence: [
        formula(Evidence::Derived, "the momentum balance; one open source agrees"),
        default_of("jet_speed", Evidence::Assumed, "slow compared with the rim"),
        default_of("c", Evidence::Derived, "the full momentum"),
    ],
    checks: [
        Check {
            input: "{ model: { type: ariura, flow: 2.5 l/min, jet_speed: 0.4 m/s }, part: { gear: { z: 40, normal_module: 4 mm, \
                    pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 160 mm, working_diameter: 160 mm, \
                    tip_diameter: 168 mm, root_diameter: 150 mm, contact_height: 1 mm } }, at: { speed: 187.5 rad/s, rho: 820 kg/m3 } }",
            values: &[("moment", "0.0420933 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: ariura, flow: 2.5 l/min, jet_speed: -0.4 m/s }, part: { gear: { z: 40, normal_module: 4 mm, \
                    pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 160 mm, working_diameter: 160 mm, \
                    tip_diameter: 168 mm, root_diameter: 150 mm, contact_height: 1 mm } }, at: { speed: 187.5 rad/s, rho: 820 kg/m3 } }",
            values: &[("moment", "0.0399067 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [IMPULSE], scope: Scope::Gear, prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jet_faster_than_the_rim_drives_nothing() {
        let driving = Ariura {
            flow: Injected::Stated(1e-4),
            jet_speed: -20.0,
            c: 1.0,
        };
        assert_eq!(driving.torque(1e-4, 820.0, 0.080, 15.0), 0.0);
    }
}
