//! Windage of one gear in air-oil mist according to Anderson and Loewenthal.
//!
//! Source: Anderson, Loewenthal, NASA TP-1622 (1980), quoted from memory: P = 2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 eta + 0.019)^0.2 in kW; n in
//! 1/min, R and b in m, eta in mPa s. The constants assume a mist; for air alone only the viscous term is omitted.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;
use crate::checks::SIX_DIGITS;

terms! { TERM = no_load("windage"); }

coefficients! {
    /// Constants of the formula of Anderson and Loewenthal.
    struct Constants {
        /// Factor of the formula, for kW, 1/min and m.
        factor = 2.82e-7, in 1.41e-7..=5.64e-7;
        /// Factor of the face width over the radius.
        width_factor = 2.3, in 1.15..=4.6;
        /// Exponent of the speed.
        speed_exponent = 2.8, in 2.0..=3.5;
        /// Exponent of the radius.
        radius_exponent = 4.6, in 3.5..=5.5;
        /// Factor of the viscosity in mPa s.
        viscosity_factor = 0.028, in 0.014..=0.056;
        /// Constant for the air, added to the viscous term.
        air_constant = 0.019, in 0.0095..=0.038;
        /// Exponent of the sum of both.
        viscosity_exponent = 0.2, in 0.1..=0.4;
    }
}

/// Windage of one gear in air-oil mist according to Anderson and Loewenthal.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct AndersonLoewenthal {
    /// Oil mist with its viscosity; otherwise air alone.
    #[serde(default = "yes")]
    pub mist: bool,
    #[serde(default)]
    coefficients: Constants,
}

fn yes() -> bool {
    true
}

/// Power from 1/min, m and mPa s. \[W\]
fn power(c: &Constants, n: f64, r: f64, b: f64, eta: f64) -> f64 {
    c.factor
        * (1.0 + c.width_factor * b / r)
        * n.powf(c.speed_exponent)
        * r.powf(c.radius_exponent)
        * (c.viscosity_factor * eta + c.air_constant).powf(c.viscosity_exponent)
        * 1e3
}

impl GearDragModel for AndersonLoewenthal {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let eta = if self.mist { at.eta.mpa_s() } else { 0.0 };
        let (n, r) = (at.speed.abs().rpm(), 0.5 * gear.working_diameter);
        let power = power(&self.coefficients, n, r, gear.facewidth, eta);
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

register!(GearDrag, "anderson_loewenthal", AndersonLoewenthal,
    source: "Anderson, Loewenthal, NASA TP-1622 (1980)",
    example: "{ type: anderson_loewenthal }",
    evidence: [
        formula(Evidence::Recalled, "four independent windage laws agree within a factor of two"),
        default_of("mist", Evidence::Recalled, "as the original assumes"),
    ],
    checks: [
        Check {
            input: "{ part: { gear: { z: 50, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 30 mm, reference_diameter: 200 mm, \
                    working_diameter: 200 mm, tip_diameter: 208 mm, root_diameter: 190 mm, contact_height: 1 mm } }, \
                    at: { speed: 10000 rpm, eta: 20 mPa s } }",
            values: &[("total", "1700.87 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 40, normal_module: 3 mm, pressure_angle: 20 deg, facewidth: 25 mm, reference_diameter: 120 mm, \
                    working_diameter: 120 mm, tip_diameter: 126 mm, root_diameter: 112 mm, contact_height: 1 mm } }, \
                    at: { speed: 15000 rpm, eta: 5 mPa s } }",
            values: &[("total", "451.821 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [TERM]);
