//! Heating of flanks and film of a line contact by friction.
//!
//! Sources: Blok 1937 and Jaeger, Proc. R. Soc. NSW 76 (1942) 203-224 (moving bands; here the mean over the band for uniform heat);
//! Tian and Kennedy, J. Tribol. 116 (1994) 167-174 (circles at any speed); the film relative to its surfaces as a plate with its
//! heat in the mid-plane or spread evenly. All formulas are linear in the heat, so a contact needs only their coefficients.

use gearloss_framework::material::Conductor;
use gearloss_framework::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact::Contact;

/// Maximum flash temperature of a Hertzian band between two flanks according to Blok. \[K\] Of different materials each flank takes the
/// heat in the ratio of effusivity and root of speed.
pub fn blok(mu: f64, contact: &Contact, [first, second]: &[Conductor; 2]) -> f64 {
    let [u1, u2] = contact.speeds;
    // Of one material the sliding over the sum of both roots is the difference of the roots.
    let (slid, effusivity) = if first == second {
        ((u1.sqrt() - u2.sqrt()).abs(), first.effusivity())
    } else {
        let swept = first.effusivity() * u1.sqrt() + second.effusivity() * u2.sqrt();
        ((u1 - u2).abs(), swept.max(f64::MIN_POSITIVE))
    };
    1.11 * mu * contact.line_load * slid / (effusivity * (2.0 * contact.half_width).sqrt())
}

/// Location of the heat source in the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilmHeat {
    /// In its middle, where the shear is.
    #[default]
    MidPlane,
    /// Evenly over its thickness.
    Even,
}

impl FilmHeat {
    /// Mean temperature rise of the film over its surfaces per heat, from film thickness (m), conductivity of the oil (W/(m K)) and
    /// area (m2). \[K/W\]
    #[inline(always)]
    pub fn resistance<R: Real>(self, film: R, conductivity: R, area: R) -> R {
        let n = match self {
            Self::MidPlane => 8.0,
            Self::Even => 12.0,
        };
        film / (conductivity * n * area)
    }
}

/// Share of the heat that enters the first body if both sides of the film have the same temperature, from the steady resistances of
/// the band and from body to oil.
#[inline(always)]
pub fn first_share<R: Real>(bands: [R; 2], bodies: [R; 2]) -> R {
    let resistances = [bands[0] + bodies[0], bands[1] + bodies[1]];
    resistances[1] / (resistances[0] + resistances[1])
}

/// Heat into the first body between bodies at given temperatures. \[W\] Without friction it is the heat from the warmer body to the
/// other through the contact, so it may be negative or above the friction heat.
#[inline(always)]
pub fn first_heat<R: Real>(heat: R, bands: [R; 2], bodies: [R; 2]) -> R {
    (bands[1] * heat + bodies[1] - bodies[0]) / (bands[0] + bands[1])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use gearloss_framework::material::FAST;

    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::{STEEL, close};

    #[test]
    fn u4a_band() {
        close(STEEL.resistance(1.5e-4, 0.030, 5.0), 0.04985650);
    }

    #[test]
    fn u4b_film() {
        let area = 2.0 * 1.5e-4 * 0.030;
        close(200.0 * FilmHeat::MidPlane.resistance(3e-7, 0.14, area), 5.952381);
        close(200.0 * FilmHeat::Even.resistance(3e-7, 0.14, area), 3.968254);
    }

    #[test]
    fn u4c_circle() {
        close(STEEL.circle(1e8, 1e-4, 5.0), 32.98295);
    }

    /// Mean rise over a moving band according to Jaeger at any Peclet number, over q'' a/k: the modified Bessel function K0 as its
    /// integral, and the band as a line source weighted by the part of the band at each distance.
    fn jaeger(pe: f64) -> f64 {
        let steps = 3000;
        let mut sum = 0.0;
        for i in 0..steps {
            // A cubic substitution removes the logarithmic singularity at the source.
            let v = (f64::from(i) + 0.5) / f64::from(steps);
            let u = 2.0 * pe * v.powi(3);
            let k0: f64 = (0..400)
                .map(|j| {
                    let t = (f64::from(j) + 0.5) * 0.03;
                    (-u * t.cosh()).exp() * 0.03
                })
                .sum();
            sum += 2.0 * u.cosh() * k0 * (2.0 * pe - u) * 6.0 * pe * v * v / f64::from(steps);
        }
        sum / (2.0 * pe) * 2.0 / PI / (2.0 * pe)
    }

    #[test]
    fn fast_bands_are_those_of_jaeger_down_to_the_limit() {
        for pe in [FAST, 0.3, 0.5, 1.0, 3.0, 5.0, 10.0] {
            let (half, length) = (1e-4, 0.03);
            let speed = 2.0 * pe * STEEL.diffusivity() / half;
            // One watt on the area 2 a L.
            let band = STEEL.resistance(half, length, speed) * 2.0 * length * STEEL.conductivity;
            let ratio = band / jaeger(pe);
            assert!((0.935..1.08).contains(&ratio), "{pe}: {ratio}");
        }
    }

    #[test]
    fn slow_bands_keep_a_finite_resistance() {
        let slow = STEEL.resistance(1e-4, 0.03, 0.0);
        let at_limit = 2.0 * FAST * STEEL.diffusivity() / 1e-4;
        assert_eq!(slow, STEEL.resistance(1e-4, 0.03, at_limit));
        assert!((STEEL.peclet(1e-4, at_limit) - FAST).abs() < 1e-12);
    }

    #[test]
    fn blok_agrees_with_the_band() {
        // One flank is stationary against a fast one: the fast one receives nearly all heat, and the maximum rise of a uniform band
        // is within a few percent of that of a Hertzian one.
        let contact = Contact::new(2e5, 0.008, 226e9, 0.03, [20.0, 0.0]);
        let heat = 0.05 * contact.line_load * contact.length * 20.0;
        let even = 1.5 * heat * STEEL.resistance(contact.half_width, contact.length, 20.0);
        let ratio = blok(0.05, &contact, &[STEEL; 2]) / even;
        assert!((0.9..1.1).contains(&ratio), "{ratio}");
    }

    #[test]
    fn heat_is_shared_so_that_both_sides_meet() {
        let (bands, bodies) = ([0.05, 0.03], [0.2, 0.1]);
        let share = first_share(bands, bodies);
        let rise = |i: usize, part: f64| 100.0 * part * (bands[i] + bodies[i]);
        close(rise(0, share), rise(1, 1.0 - share));
        let first = first_heat(100.0, bands, [80.0, 60.0]);
        close(80.0 + first * bands[0], 60.0 + (100.0 - first) * bands[1]);
        // Without friction the warmer body supplies the heat.
        assert!(first_heat(0.0, bands, [80.0, 60.0]) < 0.0);
        assert_eq!(first_heat(0.0, bands, [70.0, 70.0]), 0.0);
    }
}
