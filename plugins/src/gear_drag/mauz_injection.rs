//! Squeezing torque of oil that is injected into a mesh, according to Mauz.
//!
//! Source: Mauz 1987, quoted from memory: T = 4.12 rho Q^0.75 r_w v_t^1.25 b^0.25 m_n^0.25 (nu/nu_0)^0.25 (h_Z/h_Z0)^0.5, SI; dimensionally exact.
//! nu_0 and h_Z0 are not public, so the user states both ratios. Computed once for each mesh, at the first gear. Oil injected at
//! the outgoing side is not squeezed.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SQUEEZING;
use super::injected::Injected;
use crate::checks::SIX_DIGITS;
use crate::powers::power;
use gearloss_framework::mechanism::gear_drag::Scope;

terms! { TERM = no_load("squeezing"); }

coefficients! {
    /// Constants of the formula of Mauz.
    struct Constants {
        /// Factor of the formula, SI.
        factor = 4.12, in 2.06..=8.24;
        /// Exponent of the flow.
        flow_exponent = 0.75, in 0.375..=1.5;
        /// Exponent of the pitch line speed.
        speed_exponent = 1.25, in 0.625..=2.5;
        /// Exponent of face width times module.
        size_exponent = 0.25, in 0.125..=0.5;
        /// Exponent of the viscosity over its reference.
        viscosity_exponent = 0.25, in 0.125..=0.5;
        /// Exponent of the tooth height over its reference.
        height_exponent = 0.5, in 0.25..=1.0;
    }
}

/// Injection side of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Ingoing side.
    #[default]
    Ingoing,
    /// Outgoing side; no oil is squeezed.
    Outgoing,
}

/// Squeezing torque of oil that is injected into a mesh, according to Mauz.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Flow into the mesh; not with `nozzle`. [l/min]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub flow: Option<f64>,
    /// Nozzle of the oil network whose flow it is; not with `flow`.
    #[schemars(extend("x-refers-to" = "oil_network.nozzles"))]
    pub nozzle: Option<String>,
    /// Injection side.
    #[serde(default)]
    pub side: Side,
    /// Viscosity over its reference. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub viscosity_ratio: f64,
    /// Tooth height over its reference. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub tooth_height_ratio: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn default_one() -> f64 {
    1.0
}

struct MauzInjection {
    params: Params,
    flow: Injected,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<MauzInjection, Diagnostic> {
    let flow = Injected::new(params.flow, params.nozzle.as_deref(), cx)?;
    Ok(MauzInjection { params, flow })
}

impl MauzInjection {
    /// Torque, SI. \[Nm\]
    fn torque(&self, flow: f64, rho: f64, r_w: f64, v_t: f64, b: f64, module: f64) -> f64 {
        let c = &self.params.coefficients;
        let ratios = self.params.viscosity_ratio.powf(c.viscosity_exponent)
            * power(self.params.tooth_height_ratio, c.height_exponent);
        let (flow, speed) = (flow.powf(c.flow_exponent), v_t.powf(c.speed_exponent));
        c.factor * rho * flow * r_w * speed * (b * module).powf(c.size_exponent) * ratios
    }
}

impl GearDragModel for MauzInjection {
    fn covers(&self) -> Option<Covers> {
        Some(SQUEEZING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        if self.params.side == Side::Outgoing || at.speed == 0.0 {
            at.branch("injected at the outgoing side, or at standstill: no squeezing loss");
            return Ok(Loss::MOMENTS);
        }
        let gear = &at.part.gear;
        let b = at
            .part
            .mate
            .map_or(gear.facewidth, |mate| mate.facewidth.min(gear.facewidth));
        let r_w = 0.5 * gear.working_diameter;
        let torque = self.torque(
            self.flow.at(at),
            at.rho,
            r_w,
            at.speed.abs() * r_w,
            b,
            gear.normal_module,
        );

        Ok(Loss::MOMENTS.with(&TERM, at.show("T_Q", "Nm", torque)))
    }
}

register!(GearDrag, "mauz_injection", Params,
    source: "Mauz 1987",
    example: "{ type: mauz_injection, flow: 2 l/min }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; dimensionally exact"),
        default_of("side", Evidence::Assumed, "the side with a loss"),
        default_of("viscosity_ratio", Evidence::Assumed, "the reference is not public"),
        default_of("tooth_height_ratio", Evidence::Assumed, "the reference is not public"),
    ],
    checks: [
        Check {
            input: "{ model: { type: mauz_injection, flow: 2 l/min }, part: { gear: { z: 16, normal_module: 4.5 mm, \
                    pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 72 mm, working_diameter: 73.2 mm, \
                    tip_diameter: 82.6 mm, root_diameter: 61 mm, contact_height: 1 mm } }, at: { speed: 273.2240437 rad/s, \
                    rho: 850 kg/m3 } }",
            values: &[("moment", "0.0973906 Nm")],
            ..SIX_DIGITS
        },
        // The first one with a nozzle.
        Check {
            input: "{ model: { type: mauz_injection, nozzle: J1 }, part: { gear: { z: 16, normal_module: 4.5 mm, \
                    pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 72 mm, working_diameter: 73.2 mm, \
                    tip_diameter: 82.6 mm, root_diameter: 61 mm, contact_height: 1 mm } }, at: { speed: 273.2240437 rad/s, \
                    rho: 850 kg/m3, injected: 2 l/min } }",
            values: &[("moment", "0.0973906 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: mauz_injection, flow: 5 l/min, viscosity_ratio: 4, tooth_height_ratio: 0.6 }, \
                    part: { gear: { z: 64, normal_module: 2.5 mm, pressure_angle: 20 deg, facewidth: 30 mm, reference_diameter: 160 mm, \
                    working_diameter: 160 mm, tip_diameter: 165 mm, root_diameter: 154 mm, contact_height: 1 mm } }, \
                    at: { speed: 312.5 rad/s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.35975 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [TERM], scope: Scope::Mesh, prepare: prepare);
