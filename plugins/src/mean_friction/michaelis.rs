//! Mean friction of a mesh according to Michaelis, as in DIN 3990-4.
//!
//! Source: DIN 3990-4:1987 according to Michaelis 1987, quoted from memory: mu = 0.045 (w_Bt/(v_SC rho_redC))^0.2 eta^-0.05 X_R X_L with
//! X_R = 2.2 (Ra/rho_redC)^0.25; w_Bt in N/mm and at least 150, v_SC in m/s, rho_redC in mm, eta in mPa s, Ra in um.
//! The load factors of the standard (K_A and others) are not applied: this is the nominal load.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! {
    LINE_LOAD = ("w_Bt", "line load", "N/mm", 150.0, 3000.0, "lower clamp of the method");
    PITCH_SPEED = ("v_t", "pitch line velocity", "m/s", 0.5, 60.0,
        "assumed, not stated by a source: as for Schlenk's formula of the same form");
}
observed! { MU = ("mu_m", "-", "mean coefficient of friction"); }

coefficients! {
    /// Constants of the formula of Michaelis.
    struct Constants {
        /// Factor of the formula.
        factor = 0.045, in 0.0225..=0.09;
        /// Exponent of the line load over sum velocity and radius of curvature.
        load_exponent = 0.2, in 0.1..=0.4;
        /// Exponent of the dynamic viscosity in mPa s.
        viscosity_exponent = -0.05, in -0.2..=-0.01;
        /// Factor of the roughness over the radius of curvature, in X_R.
        roughness_factor = 2.2, in 1.1..=4.4;
        /// Exponent of the roughness in um over the radius of curvature in mm, in X_R.
        roughness_exponent = 0.25, in 0.0..=0.5;
        /// Line load in N/mm below which the friction is constant, if `clamp_line_load` is true.
        least_line_load = 150.0, in 1.0..=1000.0;
    }
}

/// Mean friction of a mesh according to Michaelis, as in DIN 3990-4.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Michaelis {
    /// Lubricant factor; default: that of the oil. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
    /// Below 150 N/mm the friction is that at 150 N/mm.
    #[serde(default = "yes")]
    pub clamp_line_load: bool,
    /// Maximum coefficient of friction; boundary friction limits the growth of the formula at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn yes() -> bool {
    true
}

/// Friction from line load in N/mm, speed in m/s, radius in mm, viscosity in mPa s and roughness in um.
#[inline(always)]
fn mu<R: Real>(c: &Constants, line_load: R, sum_speed: R, radius: R, eta: R, ra: R, x_l: R) -> R {
    let x_r = (ra / radius).power(c.roughness_exponent) * c.roughness_factor;
    let load = (line_load / (sum_speed * radius)).power(c.load_exponent);
    load * c.factor * eta.power(c.viscosity_exponent) * x_r * x_l
}

impl MeanFrictionLaw for Michaelis {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined> {
        if at.sum_speed.is_zero().any() {
            return Err(Undefined {
                what: "sum of the surface speeds at the pitch point [m/s]",
                value: 0.0,
            });
        }
        let line_load = at.check(&LINE_LOAD, at.line_load.n_mm());
        let held = if self.clamp_line_load {
            line_load.at_least(self.coefficients.least_line_load)
        } else {
            line_load
        };
        let x_l = at.show("X_L", "-", self.x_l.map_or(at.x_l, R::constant));
        let c = &self.coefficients;
        let value = mu(c, held, at.sum_speed, at.radius.mm(), at.eta.mpa_s(), at.ra.um(), x_l);
        at.check(&PITCH_SPEED, at.pitch_speed);
        Ok(at.observe(&MU, value.at_most(self.greatest)))
    }
}

register!(MeanFriction, "michaelis", Michaelis,
    source: "Michaelis 1987; DIN 3990-4:1987",
    example: "{ type: michaelis }",
    evidence: [
        formula(Evidence::Recalled, "formula quoted from memory, not checked against the standard"),
        default_of("x_l", Evidence::Disputed, "tables of X_L differ between standards and tests"),
        default_of("clamp_line_load", Evidence::Recalled, "quoted from memory, not checked against the standard"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ model: { type: michaelis, x_l: 1 }, at: { line_load: 300 N/mm, sum_speed: 8 m/s, radius: 8 mm, eta: 20 mPa s, \
                    ra: 0.4 um } }",
            values: &[("total", "0.0548927")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: michaelis, x_l: 0.8 }, at: { line_load: 200 N/mm, sum_speed: 4 m/s, radius: 12 mm, eta: 60 mPa s, \
                    ra: 0.8 um } }",
            values: &[("total", "0.0436267")],
            ..SIX_DIGITS
        },
    ],
    limits: [LINE_LOAD, PITCH_SPEED], observed: [MU]);
