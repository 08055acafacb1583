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
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, FrictionLimits, PathAt, Range, ToothFriction, ToothFrictionLaw,
};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::observe_along;
use crate::powers::asinh;
use gearloss_framework::contact::{self, Film, Films};

limits! { SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.1, 100.0, "assumed, not stated by a source: speeds with a lubricant film"); }
observed! {
    MU = ("mu_f", "-", "coefficient of friction");
    THICKNESS = ("h", "um", "film thickness");
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

/// Friction without a limiting stress, from the slope of the limit (-), 1/Pa, Pa, Pa s, m/s and m.
#[inline(always)]
fn mu<R: Real>(slope: f64, alpha: R, p_mean: R, eta_p: R, sliding: R, film: R) -> R {
    let argument = eta_p * alpha * sliding / (film * (2.0 * slope));
    // Far above gear pressures the viscosity overflows; the stress reaches its limit long before.
    let argument = argument.at_most(1e300);
    R::constant(2.0 * slope) / (alpha * p_mean) * asinh(argument)
}

impl Eyring {
    /// Friction of a film of known thickness, with the mean pressure in Pa and the viscosity there in Pa s.
    #[inline(always)]
    fn friction<R: Real>(&self, at: &ContactAt<'_, R>, h: R) -> Result<[R; 3], Undefined> {
        let idle = at.sliding.is_zero() | at.line_load.is_zero() | at.pressure.is_zero();
        if idle.all() {
            at.branch("no sliding or no load: no friction");
            return Ok([R::ZERO; 3]);
        }
        if (h.is_zero() & !idle).agreed()? {
            at.branch("no film: the limiting stress");
            return Ok([R::constant(self.limiting_slope), R::ZERO, R::ZERO]);
        }
        let p_mean = at.pressure.gpa() * (0.25 * std::f64::consts::PI) * 1e9;
        let eta_p = roelands(at.eta, at.alpha, p_mean).at_most(1e300);
        let mu = mu(self.limiting_slope, at.alpha, p_mean, eta_p, at.sliding, h);
        Ok([R::select(idle, R::ZERO, mu), p_mean, eta_p])
    }
}

impl ToothFrictionLaw for Eyring {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        at.check(&SUM_SPEED, at.sum_speed);
        let idle = at.sliding.is_zero() | at.line_load.is_zero();
        let h = contact::film(at, self.film, self.thermal);
        let [mu, p_mean, eta_p] = self.friction(at, h)?;
        if !idle.all() {
            at.notes.among(!idle).observe(&THICKNESS, h.um());
            at.show("p_mean", "GPa", p_mean.gpa());
            at.show("eta_p", "Pa s", eta_p);
        }
        at.observe(&MU, self.cut_off(mu));
        Ok(mu)
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let films = Films::new(path, self.film, self.thermal);
        let mut thickness = Range::default();
        for (node, mu) in path.nodes.iter().zip(&mut *mu) {
            let h = films.at(node);
            [*mu, ..] = self.friction(&path.contact(node), h)?;
            thickness.extend(node, h);
            R::end_pass();
        }
        for end in 0..2 {
            let sum_speed = path.speed * path.extent.sum_speed[end];
            path.notes.check(&SUM_SPEED, sum_speed);
            path.notes.observe(&THICKNESS, thickness.ends()[end].um());
        }
        observe_along(path, &MU, mu.iter().map(|mu| self.cut_off(*mu)));
        Ok(Along::default())
    }

    /// Near the pitch point the stress rises steeply.
    fn order(&self) -> usize {
        13
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        Some(FrictionLimits::up_to(self.limiting_slope))
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
