//! Fluid friction of an EHL film: Eyring's law with a limiting shear stress.
//!
//! Source: Arana et al. 2019, equation 13: mu = min[2 L/(alpha p) asinh(eta_p alpha v_g/(2 L h)), L] with the mean Hertz pressure
//! p = pi/4 p_H, the viscosity eta_p at that pressure (Roelands, isothermal), the film thickness h reduced by inlet heating (by a
//! factor of twenty at most, where the fit ends), and the slope L of the limiting stress over pressure: 0.047 to 0.053 mineral,
//! 0.035 polyalphaolefin, 0.044 polyglycol.
//! Friction of the film only; usable as the fluid part of mixed friction.

use gearloss_framework::loss::Undefined;
use gearloss_framework::lubricant::pressure::roelands;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{CUT_OFF, ContactAt, ToothFriction, ToothFrictionModel};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use gearloss_framework::contact::{self, Film};

limits! { SUM_SPEED = ("v_S", "m/s", 0.1, 100.0, "assumed, not stated by a source: speeds with a lubricant film"); }
observed! {
    MU = ("mu_f", "-", "Coefficient of friction.");
    THICKNESS = ("h", "um", "Film thickness.");
}

/// Fluid friction of an EHL film: Eyring's law with a limiting shear stress.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Eyring {
    /// Slope of the limiting shear stress over pressure. [-]
    #[serde(default = "mineral")]
    #[schemars(range(min = 0.001, max = 0.2))]
    pub limiting_slope: f64,
    /// Film thickness formula.
    #[serde(default = "central")]
    pub film: Film,
    /// Inlet heating thins the film.
    #[serde(default = "yes")]
    pub thermal: bool,
}

fn mineral() -> f64 {
    0.047
}
fn central() -> Film {
    Film::HamrockDowson
}
fn yes() -> bool {
    true
}

/// Friction from the slope of the limit (-), 1/Pa, Pa, Pa s, m/s and m.
fn mu(slope: f64, alpha: f64, p_mean: f64, eta_p: f64, sliding: f64, film: f64) -> f64 {
    let argument = eta_p * alpha * sliding / (2.0 * slope * film);
    (2.0 * slope / (alpha * p_mean) * argument.asinh()).min(slope)
}

impl ToothFrictionModel for Eyring {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        at.check(&SUM_SPEED, at.sum_speed);
        if at.sliding == 0.0 || at.line_load == 0.0 || at.pressure == 0.0 {
            at.branch("no sliding or no load: no friction");
            return Ok(at.observe(&MU, 0.0));
        }
        let h = contact::film(at, self.film, self.thermal);
        at.observe(&THICKNESS, h.um());
        if h == 0.0 {
            at.branch("no film: the limiting stress");
            return Ok(at.observe(&MU, self.limiting_slope));
        }
        let p_mean = at.show("p_mean", "GPa", 0.25 * std::f64::consts::PI * at.pressure.gpa()) * 1e9;
        let eta_p = roelands(at.eta, at.alpha, p_mean, at.temperature, at.temperature, 1.0);
        // Far above gear pressures the viscosity overflows; the stress reaches its limit long before.
        let eta_p = at.show("eta_p", "Pa s", eta_p.min(1e300));
        Ok(at.observe(&MU, mu(self.limiting_slope, at.alpha, p_mean, eta_p, at.sliding, h)))
    }

    /// Friction is cut off where it reaches its limits.
    fn order(&self) -> usize {
        CUT_OFF
    }
}

register!(ToothFriction, "eyring", Eyring,
    source: "Arana et al., Proc. IMechE (2019), equation 13; Roelands 1966",
    example: "{ type: eyring, limiting_slope: 0.035 }",
    evidence: [
        formula(Evidence::OneSource, "one article"),
        default_of("limiting_slope", Evidence::OneSource, "mineral oil in the same article"),
        default_of("film", Evidence::OneSource, "the same article"),
        default_of("thermal", Evidence::OneSource, "the same article"),
    ],
    limits: [SUM_SPEED], observed: [MU, THICKNESS]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn b12_eyring_friction() {
        for (sliding, printed) in [(1.0, 0.0440167), (0.001, 0.00043845)] {
            let value = mu(0.047, 12e-9, 0.8e9, 100.0, sliding, 0.95 * 0.3e-6);
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}
