//! Mean friction of a mesh according to ISO/TR 13989-1, intended for scuffing.
//!
//! Source: ISO/TR 13989-1:2000 and ISO/TS 6336-20, quoted from memory: mu = 0.060 (w_Bt/(v_SC rho_relC))^0.2 X_L X_R with
//! X_R = ((Ra1 + Ra2)/2)^0.25 and X_L = X_L0 eta^-0.05; w_Bt in N/mm, v_SC in m/s, rho_relC in mm, eta in mPa s, Ra in um.
//! It equals the formula of Schlenk with a factor of 1.25: conservative for scuffing, too high for efficiency.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::boundary::greatest;
use crate::checks::SIX_DIGITS;

limits! {
    PITCH_SPEED = ("v_t", "pitch line velocity", "m/s", 0.5, 60.0,
        "assumed, not stated by a source: as for Schlenk's formula of the same form");
}
observed! { MU = ("mu_m", "-", "mean coefficient of friction"); }

coefficients! {
    /// Constants of the formula of ISO/TR 13989-1.
    struct Constants {
        /// Factor of the formula.
        factor = 0.060, in 0.03..=0.12;
        /// Exponent of the line load over sum velocity and radius of curvature.
        load_exponent = 0.2, in 0.1..=0.4;
        /// Exponent of the dynamic viscosity in mPa s, in X_L.
        viscosity_exponent = -0.05, in -0.2..=-0.01;
        /// Exponent of the roughness in um, X_R.
        roughness_exponent = 0.25, in 0.0..=0.5;
    }
}

/// Oil type that selects X_L0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OilType {
    /// Mineral oil: 1.
    Mineral,
    /// Polyalphaolefin: 0.8.
    Polyalphaolefin,
    /// Polyglycol not miscible with water: 0.7.
    Polyglycol,
    /// Polyglycol miscible with water: 0.6.
    WaterSolublePolyglycol,
    /// Traction fluid: 1.5; ISO/TR 14179-2 gives 1.3.
    TractionFluid,
    /// Phosphate ester: 1.3; ISO/TR 14179-2 gives 1.5.
    PhosphateEster,
}

impl OilType {
    fn x_l(self) -> f64 {
        match self {
            Self::Mineral => 1.0,
            Self::Polyalphaolefin => 0.8,
            Self::Polyglycol => 0.7,
            Self::WaterSolublePolyglycol => 0.6,
            Self::TractionFluid => 1.5,
            Self::PhosphateEster => 1.3,
        }
    }
}

/// Mean friction of a mesh according to ISO/TR 13989-1, conservative for scuffing.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso13989 {
    /// Lubricant factor X_L0; default: that of `oil`, else that of the lubricant. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
    /// Oil type that selects the lubricant factor.
    pub oil: Option<OilType>,
    /// Maximum coefficient of friction; boundary friction limits the growth of the formula at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
    #[serde(default)]
    coefficients: Constants,
}

/// Friction from line load in N/mm, speed in m/s, radius in mm, viscosity in mPa s and roughness in um.
#[inline(always)]
fn mu<R: Real>(c: &Constants, line_load: R, sum_speed: R, radius: R, eta: R, ra: R, x_l: R) -> R {
    let load = (line_load / (sum_speed * radius)).power(c.load_exponent);
    load * c.factor * x_l * eta.power(c.viscosity_exponent) * ra.power(c.roughness_exponent)
}

impl MeanFrictionLaw for Iso13989 {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined> {
        if at.sum_speed.is_zero().any() {
            return Err(Undefined {
                what: "sum of the surface speeds at the pitch point [m/s]",
                value: 0.0,
            });
        }
        let x_l = self.x_l.or(self.oil.map(OilType::x_l)).map_or(at.x_l, R::constant);
        let x_l = at.show("X_L0", "-", x_l);
        let w = at.show("w_Bt", "N/mm", at.line_load.n_mm());
        at.check(&PITCH_SPEED, at.pitch_speed);
        let c = &self.coefficients;
        let value = mu(c, w, at.sum_speed, at.radius.mm(), at.eta.mpa_s(), at.ra.um(), x_l);
        Ok(at.observe(&MU, value.at_most(self.greatest)))
    }
}

register!(MeanFriction, "iso_13989", Iso13989,
    source: "ISO/TR 13989-1:2000; ISO/TS 6336-20",
    example: "{ type: iso_13989, oil: mineral }",
    evidence: [
        formula(Evidence::Recalled, "formula quoted from memory, not checked against the standard"),
        default_of("x_l", Evidence::Disputed, "tables of X_L differ between standards"),
        default_of("oil", Evidence::Disputed, "tables of X_L differ between standards"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ model: { type: iso_13989, x_l: 1 }, at: { line_load: 300 N/mm, sum_speed: 8 m/s, radius: 8 mm, eta: 20 mPa s, \
                    ra: 0.4 um } }",
            values: &[("total", "0.0559504")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: iso_13989, x_l: 0.8 }, at: { line_load: 200 N/mm, sum_speed: 4 m/s, radius: 12 mm, eta: 60 mPa s, \
                    ra: 0.8 um } }",
            values: &[("total", "0.0492112")],
            ..SIX_DIGITS
        },
    ],
    limits: [PITCH_SPEED], observed: [MU]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lubricant_factor_is_that_of_the_standard() {
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/lubricant_factor.csv"));
        for line in table.rows() {
            let oil = match line.text("oil") {
                "mineral" => OilType::Mineral,
                "polyalphaolefin" => OilType::Polyalphaolefin,
                "polyglycol" => OilType::Polyglycol,
                "water_soluble_polyglycol" => OilType::WaterSolublePolyglycol,
                "traction_fluid" => OilType::TractionFluid,
                "phosphate_ester" => OilType::PhosphateEster,
                _ => {
                    assert_eq!(line.cell("iso13989"), None);
                    continue;
                }
            };
            line.is("iso13989", oil.x_l());
        }
    }
}
