//! Mean friction of a mesh according to Fernandes, FEUP.
//!
//! Source: Fernandes, Marques, Martins, Seabra, Tribol. Int. 2015, as in the author's public programs: mu = 0.014 (1/S_p)^0.25
//! S_g^0.25 X_L with S_p = v_SC eta alpha^0.5/F_bn^0.5 and S_g = Ra/(l rho_redC)^0.5, SI throughout; l is the minimum total length
//! of the lines of contact. X_L was fitted to wind-turbine gear oils: 0.846 mineral, 0.65 polyalphaolefin and ester, 0.585
//! polyglycol.
//! An older script uses Ra^2/(eps_alpha l rho) with half the exponent: a factor of eps_alpha^-0.125.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! { PITCH_SPEED = ("v_t", "pitch line velocity", "m/s", 0.5, 20.0, "FZG tests behind X_L, quoted from memory"); }
observed! { MU = ("mu_m", "-", "mean coefficient of friction"); }

coefficients! {
    /// Constants of the formula of Fernandes.
    struct Constants {
        /// Factor of the formula.
        factor = 0.014, in 0.007..=0.028;
        /// Exponent of the inverse modified Hersey number, 1/S_p.
        load_exponent = 0.25, in 0.1..=0.5;
        /// Exponent of the specific roughness S_g.
        roughness_exponent = 0.25, in 0.0..=0.5;
    }
}

/// Mean friction of a mesh according to Fernandes, from a dimensionless load and roughness.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Lubricant factor; default: that of the oil. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
    /// Minimum total length of the lines of contact; default: that of one pair: face width over the cosine of the base helix angle.
    /// [mm]
    #[schemars(range(min = 0.1, max = 5000.0))]
    pub contact_length: Option<f64>,
    /// Maximum coefficient of friction; boundary friction limits the growth of the formula at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

struct Fernandes {
    x_l: Option<f64>,
    length: f64,
    greatest: f64,
    coefficients: Constants,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Fernandes, Diagnostic> {
    let part = cx.own_part::<MeanFriction>()?;
    Ok(Fernandes {
        x_l: params.x_l,
        length: params.contact_length.unwrap_or(part.pair.line_length()),
        greatest: params.greatest,
        coefficients: params.coefficients,
    })
}

#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn mu<R: Real>(c: &Constants, sum_speed: R, eta: R, alpha: R, force: R, ra: R, length: f64, radius: R, x_l: R) -> R {
    let s_p = sum_speed * eta * alpha.sqrt() / force.sqrt();
    let s_g = ra / (radius * length).sqrt();
    let powers = if c.load_exponent == c.roughness_exponent {
        (s_g / s_p).power(c.load_exponent)
    } else {
        s_g.power(c.roughness_exponent) * s_p.power(-c.load_exponent)
    };
    powers * c.factor * x_l
}

impl MeanFrictionLaw for Fernandes {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined> {
        if at.sum_speed.is_zero().any() {
            return Err(Undefined {
                what: "sum of the surface speeds at the pitch point [m/s]",
                value: 0.0,
            });
        }
        let x_l = at.show("X_L", "-", self.x_l.map_or(at.x_l, R::constant));
        let force = at.show("F_bn", "N", at.normal_force);
        at.check(&PITCH_SPEED, at.pitch_speed);
        let value = mu(
            &self.coefficients,
            at.sum_speed,
            at.eta,
            at.alpha,
            force,
            at.ra,
            self.length,
            at.radius,
            x_l,
        );
        Ok(at.observe(&MU, value.at_most(self.greatest)))
    }
}

register!(MeanFriction, "fernandes", Params,
    source: "Fernandes et al., FEUP, Tribol. Int. 2015 and public programs GEARpie",
    example: "{ type: fernandes, x_l: 0.846 }",
    evidence: [
        formula(Evidence::OneSource, "public programs of the author; an older script differs by eps_alpha^-0.125"),
        default_of("x_l", Evidence::Disputed, "the formula was fitted with its own factors, 0.585 to 0.846"),
        default_of("contact_length", Evidence::Assumed, "one pair; for spur gears the minimum length"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ model: { type: fernandes, x_l: 0.846, contact_length: 14 mm }, at: { sum_speed: 4.7 m/s, eta: 13.28 mPa s, \
                    alpha: 20.47 1/GPa, normal_force: 5912 N, ra: 0.4 um, radius: 8.4 mm } }",
            values: &[("total", "0.0499995")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: fernandes, x_l: 0.65, contact_length: 20 mm }, at: { sum_speed: 10 m/s, eta: 30 mPa s, \
                    alpha: 15 1/GPa, normal_force: 3000 N, ra: 0.5 um, radius: 10 mm } }",
            values: &[("total", "0.024519")],
            ..SIX_DIGITS
        },
    ],
    limits: [PITCH_SPEED], observed: [MU], prepare: prepare);
