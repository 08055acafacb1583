//! Windage and churning of one gear according to Maurer.
//!
//! Source: Maurer 1994, as quoted by a public gearbox program: T = 1.37e-9 v_t^1.9 d^1.6 b^0.52 m_n^0.69 in N m; v_t in m/s, d, b, m_n in mm.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;
use crate::checks::SIX_DIGITS;

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
    checks: [
        Check {
            input: "{ part: { gear: { z: 50, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 30 mm, reference_diameter: 200 mm, \
                    working_diameter: 200 mm, tip_diameter: 208 mm, root_diameter: 190 mm, contact_height: 1 mm } }, \
                    at: { speed: 500 rad/s } }",
            values: &[("moment", "0.169799 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 60, normal_module: 2 mm, pressure_angle: 20 deg, facewidth: 25 mm, reference_diameter: 120 mm, \
                    working_diameter: 120 mm, tip_diameter: 124 mm, root_diameter: 115 mm, contact_height: 1 mm } }, \
                    at: { speed: 1333.333333 rad/s } }",
            values: &[("moment", "0.103257 Nm")],
            ..SIX_DIGITS
        },
    ],
    terms: [TERM]);
