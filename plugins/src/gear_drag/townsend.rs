//! Windage of a smooth rotor of the gear's size, according to Townsend.
//!
//! Source: Townsend (ed.): Dudley's Gear Handbook, 2nd ed., 1991, quoted from memory: P = n^3 D^5 L^0.7/1e17 in hp, n in 1/min, D and L in inches.
//! A rotor without teeth: the loss is below the laws for gears.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;
use crate::checks::SIX_DIGITS;
use crate::powers::power;

terms! { TERM = no_load("windage"); }
/// One horsepower. \[W\]
const HP: f64 = 745.699_871_582;
/// One inch. \[m\]
const INCH: f64 = 25.4e-3;

coefficients! {
    /// Constants of the formula of the handbook.
    struct Constants {
        /// Divisor of the formula, for hp, 1/min and inches.
        divisor = 1e17, in 0.5e17..=2e17;
        /// Exponent of the speed.
        speed_exponent = 3.0, in 2.0..=3.5;
        /// Exponent of the diameter.
        diameter_exponent = 5.0, in 4.0..=5.5;
        /// Exponent of the length.
        length_exponent = 0.7, in 0.35..=1.4;
    }
}

/// Windage of a smooth rotor of the gear's size.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Townsend {
    #[serde(default)]
    coefficients: Constants,
}

/// Power from 1/min and inches. \[W\]
fn windage(c: &Constants, n: f64, d: f64, l: f64) -> f64 {
    power(n, c.speed_exponent) * power(d, c.diameter_exponent) * l.powf(c.length_exponent) / c.divisor * HP
}

impl GearDragModel for Townsend {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let power = windage(
            &self.coefficients,
            at.speed.abs().rpm(),
            gear.tip_diameter / INCH,
            gear.facewidth / INCH,
        );
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

register!(GearDrag, "townsend", Townsend,
    source: "Townsend (ed.), Dudley's Gear Handbook, 1991",
    example: "{ type: townsend }",
    evidence: [formula(Evidence::Recalled, "below the laws for gears, as expected of a smooth rotor")],
    checks: [
        Check {
            input: "{ part: { gear: { z: 61, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 50.8 mm, \
                    reference_diameter: 244 mm, working_diameter: 244 mm, tip_diameter: 254 mm, root_diameter: 234 mm, \
                    contact_height: 1 mm } }, at: { speed: 10000 rpm } }",
            values: &[("total", "1211.39 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 74, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 76.2 mm, \
                    reference_diameter: 296 mm, working_diameter: 296 mm, tip_diameter: 304.8 mm, root_diameter: 286 mm, \
                    contact_height: 1 mm } }, at: { speed: 6000 rpm } }",
            values: &[("total", "864.787 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [TERM]);
