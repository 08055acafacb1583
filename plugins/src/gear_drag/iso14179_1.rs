//! Churning of one gear according to ISO/TR 14179-1, of AGMA origin.
//!
//! The report calls it windage and churning, but a gear that is not immersed loses nothing.
//!
//! Source: ISO/TR 14179-1:2001, quoted from memory: sides 1.474 f_g nu n^3 D^5.7/(A_g 1e26) and tooth surface 7.37 f_g nu n^3 D^4.7
//! b (R_f/sqrt(tan beta))/(A_g 1e26) in kW, nu in mm2/s, n in 1/min, lengths in mm; R_f = 7.93 - 4.648/m_t, beta at least 10 deg,
//! A_g = 0.2. The immersion factor f_g rises from 0 without oil to 1 for a fully immersed gear, linear in the immersion depth of
//! the tip circle at rest (assumed: the report has no other). The shaft losses of the report are not included. The loss grows with
//! viscosity and the cube of speed: far below other laws for a thin oil, far above for a thick one at high speed. For industrial
//! units; R_f is limited to zero for transverse modules below 0.586 mm.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::CHURNING;
use super::rise::{Rise, SWELL, churning};
use crate::checks::SIX_DIGITS;
use crate::powers::power;

terms! {
    SIDES = no_load("sides");
    TEETH = no_load("teeth");
}

coefficients! {
    /// Constants of the formulas of ISO/TR 14179-1.
    struct Constants {
        /// Factor of the sides, times 1e-26, for kW, mm2/s, 1/min and mm.
        sides_factor = 1.474, in 0.737..=2.948;
        /// Factor of the tooth surface, times 1e-26.
        teeth_factor = 7.37, in 3.685..=14.74;
        /// Exponent of the speed.
        speed_exponent = 3.0, in 2.0..=3.5;
        /// Exponent of the outer diameter at the sides.
        sides_diameter_exponent = 5.7, in 4.5..=6.5;
        /// Exponent of the outer diameter at the tooth surface.
        teeth_diameter_exponent = 4.7, in 3.5..=5.5;
        /// Constant of the roughness factor R_f.
        roughness_constant = 7.93, in 3.965..=15.86;
        /// Factor of the inverse transverse module in mm in R_f.
        roughness_module = 4.648, in 2.324..=9.296;
    }
}

churning! {
    /// Windage and churning of one gear according to ISO/TR 14179-1, of AGMA origin.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Params {
        /// Arrangement constant. [-]
        #[serde(default = "a_g")]
        #[schemars(range(min = 0.01, max = 10.0))]
        pub a_g: f64,
        #[serde(default)]
        coefficients: Constants,
    }
}

struct Iso14179 {
    coefficients: Constants,
    a_g: f64,
    rise: Rise,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Iso14179, Diagnostic> {
    Ok(Iso14179 {
        rise: params.rise(cx)?,
        coefficients: params.coefficients,
        a_g: params.a_g,
    })
}

fn a_g() -> f64 {
    0.2
}

impl Iso14179 {
    /// Power of both sides from mm2/s, min-1 and mm. \[W\]
    fn sides(&self, f_g: f64, nu: f64, n: f64, d: f64) -> f64 {
        let c = &self.coefficients;
        let speed = power(n, c.speed_exponent);
        c.sides_factor * f_g * nu * speed * d.powf(c.sides_diameter_exponent) / (self.a_g * 1e26) * 1e3
    }

    /// Power of the tooth surface from mm2/s, min-1, mm and helix angle in rad. \[W\]
    #[allow(clippy::too_many_arguments)]
    fn teeth(&self, f_g: f64, nu: f64, n: f64, d: f64, b: f64, m_t: f64, beta: f64) -> f64 {
        let c = &self.coefficients;
        let r_f = (c.roughness_constant - c.roughness_module / m_t).max(0.0);
        let tan = beta.max(10.0_f64.to_radians()).tan();
        let speed = power(n, c.speed_exponent);
        c.teeth_factor * f_g * nu * speed * d.powf(c.teeth_diameter_exponent) * b * (r_f / tan.sqrt())
            / (self.a_g * 1e26)
            * 1e3
    }
}

impl GearDragModel for Iso14179 {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| Ok(self.alone(at)))
    }
}

impl Iso14179 {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Loss {
        let gear = &at.part.gear;
        let f_g = at.show("f_g", "-", (at.tip_dip / gear.tip_diameter).clamp(0.0, 1.0));
        let (nu, n, d) = (at.nu.mm2_s(), at.speed.abs().rpm(), gear.tip_diameter.mm());
        let m_t = gear.normal_module.mm() / gear.helix_angle.cos();
        let sides = self.sides(f_g, nu, n, d);
        let teeth = self.teeth(f_g, nu, n, d, gear.facewidth.mm(), m_t, gear.helix_angle);
        Loss::POWERS
            .with(&SIDES, at.show("P_sides", "W", sides))
            .with(&TEETH, at.show("P_teeth", "W", teeth))
    }
}

register!(GearDrag, "iso14179_1", Params,
    source: "ISO/TR 14179-1:2001",
    example: "{ type: iso14179_1 }",
    evidence: [
        formula(Evidence::Recalled, "constants quoted from memory"),
        default_of("a_g", Evidence::Recalled, "quoted from memory, not checked"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: "{ model: { type: iso14179_1, a_g: 0.2 }, part: { gear: { z: 48, normal_module: 4 mm, pressure_angle: 20 deg, \
                    facewidth: 50 mm, reference_diameter: 192 mm, working_diameter: 192 mm, tip_diameter: 200 mm, \
                    root_diameter: 182 mm, contact_height: 1 mm } }, at: { speed: 1500 rpm, tip_dip: 100 mm, nu: 100 mm2/s } }",
            values: &[("sides", "162.399 W"), ("teeth", "3271.85 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL], terms: [SIDES, TEETH], prepare: prepare);
