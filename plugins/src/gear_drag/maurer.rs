//! Windage and churning of one gear according to Maurer.
//!
//! Source: Maurer 1994, as quoted by a public gearbox program: T = 1.37e-9 v_t^1.9 d^1.6 b^0.52 m_n^0.69 in N m; v_t in m/s, d, b, m_n in mm.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;

terms! { TERM = no_load("windage"); }

coefficients! {
    /// Constants of the formula of Maurer.
    struct Constants {
        /// Factor of the formula, for N m, m/s and mm.
        factor = 1.37e-9, in 0.685e-9..=2.74e-9;
        /// Exponent of the pitch line speed.
        speed_exponent = 1.9, in 0.95..=3.0;
        /// Exponent of the pitch diameter.
        diameter_exponent = 1.6, in 0.8..=3.2;
        /// Exponent of the face width.
        width_exponent = 0.52, in 0.26..=1.04;
        /// Exponent of the module.
        module_exponent = 0.69, in 0.345..=1.38;
    }
}

/// Windage and churning of one gear according to Maurer.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Maurer {
    #[serde(default)]
    coefficients: Constants,
}

/// Torque from m/s and mm. \[Nm\]
fn torque(c: &Constants, v_t: f64, d: f64, b: f64, m_n: f64) -> f64 {
    c.factor
        * v_t.powf(c.speed_exponent)
        * d.powf(c.diameter_exponent)
        * b.powf(c.width_exponent)
        * m_n.powf(c.module_exponent)
}

impl GearDragModel for Maurer {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let v_t = at.show("v_t", "m/s", at.speed.abs() * 0.5 * gear.working_diameter);
        let torque = torque(
            &self.coefficients,
            v_t,
            gear.working_diameter.mm(),
            gear.facewidth.mm(),
            gear.normal_module.mm(),
        );
        Ok(Loss::MOMENTS.with(&TERM, at.show("T_V", "Nm", torque)))
    }
}

register!(GearDrag, "maurer", Maurer,
    source: "Maurer 1994",
    example: "{ type: maurer }",
    evidence: [formula(Evidence::OneSource, "one public program and memory agree")],
    terms: [TERM]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c17_published_gears() {
        for (value, printed) in [
            (torque(&Constants::PUBLISHED, 50.0, 200.0, 30.0, 4.0), 0.169799),
            (torque(&Constants::PUBLISHED, 80.0, 120.0, 25.0, 2.0), 0.103257),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}
