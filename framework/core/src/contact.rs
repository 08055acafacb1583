//! Films and mixing in line contacts, and the path of contact of a mesh, for models and analyses that need them.
//!
//! Sources: Dowson and Higginson 1961 (minimum film of a line contact); Hamrock and Dowson 1977 (central film, here for a long
//! ellipse); thermal reduction according to Gupta et al. in the form of Arana et al. 2019; weights of mixed friction according to Doleschel,
//! Matsumoto, Diab, and Olver and Spikes as collected by Arana et al. 2019.

use crate::mechanism::tooth_friction::{ContactAt, PathAt, PathNode};
use crate::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod cut_off;
pub mod path;
pub mod sharing;

/// Film thickness formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Film {
    /// Minimum film of a line contact, Dowson and Higginson.
    #[default]
    DowsonHigginson,
    /// Central film of a long contact, Hamrock and Dowson.
    HamrockDowson,
}

impl Film {
    /// All formulas, in the order of the enumeration.
    const ALL: [Self; 2] = [Self::DowsonHigginson, Self::HamrockDowson];

    /// The films of all formulas at a node, with one for every quantity that does not belong to it; none without load. \[m\]
    pub(crate) fn at_node(rolling: f64, radius: f64, share: f64) -> [f64; 2] {
        let thickness = |film: Self| radius * film.over_radius(rolling / radius, 1.0, share / radius, 1.0 / radius);
        Self::ALL.map(|film| if share > 0.0 { thickness(film) } else { 0.0 })
    }

    /// Film over radius from U = eta v_e/(E' R), G = alpha E', w/(E' R) and the length of the line of contact over the radius.
    #[inline(always)]
    fn over_radius<R: Real>(self, u: R, g: R, w: R, length: R) -> R {
        match self {
            Self::DowsonHigginson => dowson_higginson(u, g, w),
            Self::HamrockDowson => hamrock_dowson(u, g, w * length),
        }
    }
}

/// Minimum film over radius from U = eta v_e/(E' R), G = alpha E', W = w/(E' R).
#[inline(always)]
pub fn dowson_higginson<R: Real>(u: R, g: R, w: R) -> R {
    u.power(0.7) * 2.65 * g.power(0.54) * w.power(-0.13)
}

/// Central film over radius of a long contact from U, G and W = F/(E' R^2).
#[inline(always)]
pub fn hamrock_dowson<R: Real>(u: R, g: R, w: R) -> R {
    u.power(0.67) * 2.69 * g.power(0.53) * w.power(-0.067)
}

/// Reduction factor of the film by inlet heating, from p_H/E', slide-to-roll ratio and L = eta beta v_e^2/k.
#[inline(always)]
pub fn thermal_factor<R: Real>(pressure: R, slide_roll: R, l: R) -> R {
    thinned(thermal_terms(pressure, slide_roll, l))
}

/// The terms of pressure and of sliding in the reduction factor; each grows with its own power of L.
#[inline(always)]
pub(crate) fn thermal_terms<R: Real>(pressure: R, slide_roll: R, l: R) -> [R; 2] {
    let slides = slide_roll.power(0.83) * 2.23 + 1.0;
    let [pressed, slid] = heating(l);
    [pressure * 13.2 * pressed, slides * 0.213 * slid]
}

/// The powers of L in the terms of pressure and of sliding.
#[inline(always)]
pub fn heating<R: Real>(l: R) -> [R; 2] {
    [l.power(0.42), l.power(0.64)]
}

/// The reduction factor from both terms.
#[inline(always)]
pub fn thinned<R: Real>([pressure, sliding]: [R; 2]) -> R {
    // Beyond the fit the numerator is negative; the film stays positive.
    ((R::constant(1.0) - pressure) / (sliding + 1.0))
        .at_least(0.05)
        .at_most(1.0)
}

/// Film thickness in a contact, optionally with inlet heating; zero at standstill. \[m\]
#[inline(always)]
pub fn film<R: Real>(at: &ContactAt<'_, R>, film: Film, thermal: bool) -> R {
    let v_e = at.sum_speed * 0.5;
    let none = v_e.is_zero() | at.line_load.is_zero();
    let u = at.eta * v_e / (at.modulus * at.radius);
    let g = at.alpha * at.modulus;
    let w = at.line_load / (at.modulus * at.radius);
    let h = at.radius * film.over_radius(u, g, w, at.length / at.radius);
    let h = if thermal {
        let heating = at.eta * at.beta * v_e * v_e / at.conductivity;
        h * thermal_factor(at.pressure / at.modulus, at.slide_roll(), heating)
    } else {
        h
    };
    R::select(none, R::ZERO, h)
}

/// Film thicknesses at the nodes of a path. They are products of powers, so that what does not change along the path is computed once.
pub struct Films<R: Real> {
    film: Film,
    /// Where there is none, at standstill and without load.
    none: R::Mask,
    /// Film at a node for which all factors of its geometry are one. \[m\]
    scale: R,
    /// The terms of inlet heating at such a node, unless it is neglected.
    heating: Option<[R; 2]>,
}

impl<R: Real> Films<R> {
    /// The films of a path, optionally with inlet heating.
    #[inline(always)]
    pub fn new(path: &PathAt<'_, R>, film: Film, thermal: bool) -> Self {
        let u = path.eta * path.speed / path.modulus;
        let length = R::constant(path.length);
        let scale = film.over_radius(u, path.alpha * path.modulus, path.line_load / path.modulus, length);
        let heating = thermal.then(
            #[inline(always)]
            || {
                let [pressed, slid] = heating(path.eta * path.beta * path.speed * path.speed / path.conductivity);
                [path.unit_pressure() / path.modulus * pressed, slid]
            },
        );
        Self {
            film,
            none: path.speed.is_zero() | path.line_load.is_zero(),
            scale: scale / film.over_radius(1.0, 1.0, 1.0, 1.0),
            heating,
        }
    }

    /// The film at a node. \[m\]
    #[inline(always)]
    pub fn at(&self, node: &PathNode) -> R {
        let mut h = self.scale * node.films[self.film as usize];
        if let Some([pressed, slid]) = self.heating {
            h = h * thinned([pressed * node.heating[0], slid * node.heating[1]]);
        }
        R::select(self.none, R::ZERO, h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn b12_films_and_thermal_factor() {
        let (modulus, radius) = (226.374e9, 0.010);
        let u = 20e-3 * 5.0 / (modulus * radius);
        let g = 20e-9 * modulus;
        close(
            dowson_higginson(u, g, 3e5 / (modulus * radius)) * radius * 1e6,
            0.449916,
        );
        close(
            hamrock_dowson(u, g, 6000.0 / (modulus * radius * radius)) * radius * 1e6,
            0.466939,
        );
        close(thermal_factor(1e9 / 226.374e9, 0.3, 0.05), 0.930381);
    }
}
