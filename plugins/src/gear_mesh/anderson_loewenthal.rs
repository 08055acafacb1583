//! Loss of spur gear meshes evaluated at one point of the path of contact, according to Anderson and Loewenthal.
//!
//! Source: Anderson, Loewenthal: Spur gear system efficiency at part and full load, NASA TP-1622 (1980) with its errata sheet,
//! quoted from memory: sliding with the friction of Benedict and Kelley, and rolling with the film of Hamrock and Dowson, both a quarter
//! of the path away from the pitch point. v_S = 0.02618 n_p (1 + m_g)/m_g l, v_T = 0.2094 n_p (D_p/2 sin phi - 0.125 (m_g - 1)/m_g l),
//! f = 0.0127 lg(0.02966 (W/b)/(eta v_S v_T^2)), P_S = f W v_S, h = 2.051e-7 (v_T eta)^0.67 W^-0.067 R^0.464,
//! P_R = 9e7 h b v_T eps_alpha. The speed constants are exact; the full load W acts at a mean sliding speed. The original limits f
//! to 0.01 to 0.02 (quoted from memory, not checked); here that is an option. External spur gears of steel; a rough model that
//! usually gives more than the path integral. For helical gears, which are outside its range, W is the normal force and b the length of
//! its line of contact.

use std::f64::consts::LOG10_E;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! {
    SLIDING = load("sliding");
    ROLLING = load("rolling");
}
limits! { HELIX = ("beta", "helix angle", "deg", 0.0, 0.0, "spur gears"); }
observed! {
    F = ("f", "-", "coefficient of friction a quarter of the path from the pitch point");
    FILM = ("h", "um", "central film a quarter of the path from the pitch point");
}

coefficients! {
    /// Constants of the formulas of Anderson and Loewenthal.
    struct Constants {
        /// Factor of the logarithm in f.
        friction_factor = 0.0127, in 0.00635..=0.0254;
        /// Factor inside the logarithm.
        argument_factor = 0.02966, in 0.01483..=0.05932;
        /// Factor of the film h.
        film_factor = 2.051e-7, in 1.0255e-7..=4.102e-7;
        /// Exponent of rolling speed times viscosity in h.
        film_speed_exponent = 0.67, in 0.335..=1.34;
        /// Exponent of the load in h.
        film_load_exponent = -0.067, in -0.134..=-0.0335;
        /// Exponent of the radius of curvature in h.
        film_radius_exponent = 0.464, in 0.232..=0.928;
        /// Factor of the rolling loss.
        rolling_factor = 9.0e7, in 4.5e7..=18.0e7;
    }
}

/// Sliding and rolling loss of spur gears from one point of the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Minimum and maximum coefficient of friction; default: no limits. [-]
    #[schemars(inner(range(min = 0.0, max = 0.2)))]
    pub f_limits: Option<[f64; 2]>,
    #[serde(default)]
    coefficients: Constants,
}

/// Geometry of the pinion and its mate.
struct OnePoint {
    coefficients: Constants,
    limits: Option<[f64; 2]>,
    pinion: usize,
    ratio: f64,
    diameter: f64,
    angle: f64,
    /// One for spur gears.
    cos_base_helix: f64,
    path: f64,
    contact_ratio: f64,
    /// Length of the line of contact of one pair.
    line_length: f64,
}

struct Answer<R> {
    f: R,
    film: R,
    sliding: R,
    rolling: R,
}

impl OnePoint {
    fn new(pair: &Pair, limits: Option<[f64; 2]>, coefficients: Constants) -> Self {
        let pinion = usize::from(pair.z[0] > pair.z[1]);
        let [start, .., end] = pair.points;
        Self {
            coefficients,
            limits,
            pinion,
            ratio: f64::from(pair.z[1 - pinion]) / f64::from(pair.z[pinion]),
            diameter: 2.0 * pair.working_radius[pinion],
            angle: pair.working_angle,
            cos_base_helix: pair.base_helix.cos(),
            path: end - start,
            contact_ratio: pair.contact_ratio,
            line_length: pair.line_length(),
        }
    }

    /// Torque in N m and speed in rad/s of the pinion, viscosity in Pa s.
    #[inline(always)]
    fn answer<R: Real>(&self, torque: R, speed: R, eta: R) -> Answer<R> {
        let c = &self.coefficients;
        let (m, l) = (self.ratio, self.path);
        let sin = self.angle.sin();
        // The published 0.02618 and 0.2094 are a quarter of and twice one rpm in rad/s.
        let v_s = speed * (0.25 * (1.0 + m) / m * l);
        let v_t = speed * 2.0 * (0.5 * self.diameter * sin - 0.125 * (m - 1.0) / m * l);
        let load = torque * 2.0 / (self.diameter * self.angle.cos() * self.cos_base_helix);
        let argument = load * (c.argument_factor / self.line_length) / (eta * v_s * v_t * v_t);
        let f = (argument.ln() * (c.friction_factor * LOG10_E)).at_least(0.0);
        let f = self.limits.map_or(f, |[least, most]| f.at_least(least).at_most(most));
        let rho_1 = 0.5 * self.diameter * sin + 0.25 * l;
        let rho_2 = 0.5 * m * self.diameter * sin - 0.25 * l;
        let radius = rho_1 * rho_2 / (rho_1 + rho_2);
        let film = (v_t * eta.mpa_s()).power(c.film_speed_exponent)
            * load.power(c.film_load_exponent)
            * (c.film_factor * radius.powf(c.film_radius_exponent));
        Answer {
            f,
            film,
            sliding: f * load * v_s,
            rolling: film * c.rolling_factor * self.line_length * v_t * self.contact_ratio,
        }
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<OnePoint, Diagnostic> {
    let part = cx.own_part::<GearMesh>()?;
    if part.pair.internal {
        return Err(cx
            .error("anderson_loewenthal applies to external gear pairs only")
            .help("give this mesh its own model, such as `wimmer`"));
    }
    if params.f_limits.is_some_and(|[least, most]| least > most) {
        return Err(cx
            .error("the values of `f_limits` do not increase")
            .help("write the minimum first"));
    }
    let model = OnePoint::new(&part.pair, params.f_limits, params.coefficients);
    if model.ratio * 0.5 * model.diameter * model.angle.sin() <= 0.25 * model.path {
        return Err(cx.error("the point at a quarter of the path from the pitch point is inside the base circle"));
    }
    Ok(model)
}

impl GearMeshLaw for OnePoint {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let pair = &at.part.pair;
        at.check(&HELIX, R::constant(pair.helix_angle.to_degrees()));
        let ratio = pair.working_radius[self.pinion] / pair.working_radius[0];
        let answer = self.answer(at.torque * ratio, at.speed.abs() / ratio, at.eta);
        at.observe(&F, answer.f);
        at.observe(&FILM, answer.film.um());
        let [sliding, rolling] = [("P_S", answer.sliding), ("P_R", answer.rolling)]
            .map(|(symbol, watts)| R::select(idle, R::ZERO, at.show(symbol, "W", watts)));
        Ok(Loss::POWERS.with(&SLIDING, sliding).with(&ROLLING, rolling))
    }
}

register!(GearMesh, "anderson_loewenthal", Params,
    source: "Anderson, Loewenthal, NASA TP-1622 (1980) and its errata sheet",
    example: "{ type: anderson_loewenthal }",
    evidence: [
        formula(Evidence::Recalled, "speed constants derived, the others quoted from memory, not checked"),
        default_of("f_limits", Evidence::Disputed, "the original seems to limit f to 0.01 to 0.02"),
    ],
    checks: [
        Check {
            input: "{ at: { torque: 200 Nm, speed: 1500 rpm, eta: 13.28 mPa s } }",
            values: &[("f", "0.0588951"), ("h", "0.185452 um"), ("sliding", "442.773 W"), ("rolling", "1.41296 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: anderson_loewenthal, f_limits: [0.01, 0.02] }, at: { torque: 200 Nm, speed: 1500 rpm, \
                    eta: 13.28 mPa s } }",
            values: &[("f", "0.02"), ("sliding", "150.36 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [HELIX], terms: [SLIDING, ROLLING], observed: [F, FILM], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    const fn point(limits: Option<[f64; 2]>) -> OnePoint {
        OnePoint {
            coefficients: Constants::PUBLISHED,
            limits,
            pinion: 0,
            ratio: 1.5,
            diameter: 73.2e-3,
            angle: 22.4388 * std::f64::consts::PI / 180.0,
            cos_base_helix: 1.0,
            path: 19.4291e-3,
            contact_ratio: 1.46253,
            line_length: 14e-3,
        }
    }

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn b15_fast_and_light() {
        let model = OnePoint {
            ratio: 3.0,
            diameter: 60e-3,
            angle: 20.0_f64.to_radians(),
            path: 14e-3,
            contact_ratio: 1.6,
            line_length: 20e-3,
            ..point(None)
        };
        let answer = model.answer(20.0, 6000.0 * std::f64::consts::PI / 30.0, 20e-3);
        // The published values carry more digits of 0.02966 than the formula.
        assert!((answer.f / 0.027152 - 1.0).abs() < 2e-5, "{}", answer.f);
        close(answer.film * 1e6, 0.569523);
        assert!((answer.sliding / 56.4821 - 1.0).abs() < 2e-5, "{}", answer.sliding);
        close(answer.rolling, 18.7441);
    }
}
