//! Squeezing torque of oil that is injected into a mesh, according to Mauz.
//!
//! Source: Mauz 1987, quoted from memory: T = 4.12 rho Q^0.75 r_w v_t^1.25 b^0.25 m_n^0.25 (nu/nu_0)^0.25 (h_Z/h_Z0)^0.5, SI; dimensionally exact.
//! nu_0 and h_Z0 are not public, so the user states both ratios. Computed once for each mesh, at the first gear. Oil injected at
//! the outgoing side is not squeezed.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SQUEEZING;
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
pub struct MauzInjection {
    /// Flow into the mesh. [l/min]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub flow: f64,
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

impl MauzInjection {
    /// Torque, SI. \[Nm\]
    fn torque(&self, rho: f64, r_w: f64, v_t: f64, b: f64, module: f64) -> f64 {
        let c = &self.coefficients;
        let ratios =
            self.viscosity_ratio.powf(c.viscosity_exponent) * power(self.tooth_height_ratio, c.height_exponent);
        let (flow, speed) = (self.flow.powf(c.flow_exponent), v_t.powf(c.speed_exponent));
        c.factor * rho * flow * r_w * speed * (b * module).powf(c.size_exponent) * ratios
    }
}

impl GearDragModel for MauzInjection {
    fn covers(&self) -> Option<Covers> {
        Some(SQUEEZING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        if self.side == Side::Outgoing || at.speed == 0.0 {
            at.branch("injected at the outgoing side, or at standstill: no squeezing loss");
            return Ok(Loss::MOMENTS);
        }
        let gear = &at.part.gear;
        let b = at
            .part
            .mate
            .map_or(gear.facewidth, |mate| mate.facewidth.min(gear.facewidth));
        let r_w = 0.5 * gear.working_diameter;
        let torque = self.torque(at.rho, r_w, at.speed.abs() * r_w, b, gear.normal_module);

        Ok(Loss::MOMENTS.with(&TERM, at.show("T_Q", "Nm", torque)))
    }
}

register!(GearDrag, "mauz_injection", MauzInjection,
    source: "Mauz 1987",
    example: "{ type: mauz_injection, flow: 2 l/min }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; dimensionally exact"),
        default_of("side", Evidence::Assumed, "the side with a loss"),
        default_of("viscosity_ratio", Evidence::Assumed, "the reference is not public"),
        default_of("tooth_height_ratio", Evidence::Assumed, "the reference is not public"),
    ],
    terms: [TERM], scope: Scope::Mesh);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c4_published_values() {
        let law = |flow: f64, viscosity_ratio, tooth_height_ratio| MauzInjection {
            coefficients: Constants::PUBLISHED,
            flow: flow * 1e-3 / 60.0,
            side: Side::Ingoing,
            viscosity_ratio,
            tooth_height_ratio,
        };
        for (value, printed) in [
            (
                law(2.0, 1.0, 1.0).torque(850.0, 36.6e-3, 10.0, 20e-3, 4.5e-3),
                0.0973906,
            ),
            (law(5.0, 4.0, 0.6).torque(830.0, 80e-3, 25.0, 30e-3, 2.5e-3), 1.35975),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}
