//! Windage of one gear according to Dawson.
//!
//! Source: Dawson: Windage loss in larger high-speed gears, Proc. IMechE 198A (1984) 51-59, quoted from memory:
//! P = 1e-20 n^2.9 (0.16 D^3.9 + D^2.9 b^0.75 m^1.15) Phi lambda in kW; n in 1/min, D root diameter, b and m in mm.
//! Phi is 1 in air and more in oil mist; lambda is 1 for a free gear, 0.7 in a loose and 0.5 to 0.6 in a tight enclosure.
//! A bevel gear has the root diameter of its outer end and its face width: an extension of our own.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;
use crate::checks::SIX_DIGITS;

terms! { TERM = no_load("windage"); }
limits! {
    CONE = ("delta", "pitch angle of a bevel gear", "deg", 0.0, 0.0,
        "tests with cylindrical gears; with the outer root diameter and the face width of a bevel gear uncertain by a factor of about two");
}

coefficients! {
    /// Constants of the formula of Dawson.
    struct Constants {
        /// Factor of the formula, for kW, 1/min and mm.
        factor = 1e-20, in 0.5e-20..=2e-20;
        /// Exponent of the speed.
        speed_exponent = 2.9, in 2.0..=3.5;
        /// Factor of the face term relative to the tooth term.
        faces_factor = 0.16, in 0.08..=0.32;
        /// Exponent of the root diameter in the face term.
        faces_diameter_exponent = 3.9, in 3.0..=4.5;
        /// Exponent of the root diameter in the tooth term.
        teeth_diameter_exponent = 2.9, in 2.0..=3.5;
        /// Exponent of the face width.
        width_exponent = 0.75, in 0.375..=1.5;
        /// Exponent of the module.
        module_exponent = 1.15, in 0.575..=2.3;
    }
}

/// Windage of one gear according to Dawson.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Dawson {
    /// Factor of the medium: 1 in air, more in oil mist. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub phi: f64,
    /// Factor of the enclosure: 1 free, 0.7 loose, 0.5 to 0.6 tight. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.1, max = 1.0))]
    pub lambda: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn default_one() -> f64 {
    1.0
}

impl Dawson {
    /// Power from min-1 and mm. \[W\]
    fn power(&self, n: f64, d: f64, b: f64, m: f64) -> f64 {
        let c = &self.coefficients;
        let teeth = d.powf(c.teeth_diameter_exponent) * b.powf(c.width_exponent) * m.powf(c.module_exponent);
        c.factor
            * n.powf(c.speed_exponent)
            * (c.faces_factor * d.powf(c.faces_diameter_exponent) + teeth)
            * self.phi
            * self.lambda
            * 1e3
    }
}

impl GearDragModel for Dawson {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn describes_bevel(&self) -> bool {
        true
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        if gear.pitch_angle != 0.0 {
            at.branch("bevel gear: root diameter of its outer end");
            at.check(&CONE, gear.pitch_angle.to_degrees());
        }
        let d = at.show("D", "mm", gear.root_diameter.mm());
        let power = self.power(at.speed.abs().rpm(), d, gear.facewidth.mm(), gear.normal_module.mm());
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

register!(GearDrag, "dawson", Dawson,
    source: "Dawson, Proc. IMechE 198A (1984) 51-59",
    example: "{ type: dawson, lambda: 0.6 }",
    evidence: [
        formula(Evidence::Recalled, "four independent windage laws agree within a factor of two"),
        default_of("phi", Evidence::Recalled, "air"),
        default_of("lambda", Evidence::Recalled, "a free gear"),
    ],
    checks: [
        Check {
            input: "{ model: { type: dawson, lambda: 1 }, part: { gear: { z: 102, normal_module: 10 mm, pressure_angle: 20 deg, \
                    facewidth: 200 mm, reference_diameter: 1020 mm, working_diameter: 1020 mm, tip_diameter: 1040 mm, \
                    root_diameter: 1000 mm, contact_height: 1 mm } }, at: { speed: 3000 rpm } }",
            values: &[("total", "55370.6 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: dawson, lambda: 0.6 }, part: { gear: { z: 62, normal_module: 3 mm, pressure_angle: 20 deg, \
                    facewidth: 30 mm, reference_diameter: 186 mm, working_diameter: 186 mm, tip_diameter: 192 mm, \
                    root_diameter: 180 mm, contact_height: 1 mm } }, at: { speed: 12000 rpm } }",
            values: &[("total", "1042.68 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [CONE], terms: [TERM]);
