//! The elliptic contact of Hertz.
//!
//! Source: Hertz 1881, as in textbooks. With 1/R = 1/R_x + 1/R_y the ratio chi = a/b of the semi-axes is the root of
//! (1/R_x - 1/R_y) R = 1 - 2/(chi^2 - 1) (K/E - 1) with the parameter m = 1 - 1/chi^2, and
//! a = (3 chi^2 E Q R/(pi E*))^(1/3), p0 = 3 Q/(2 pi a b), delta = 3 K Q/(2 pi a E*).

use std::f64::consts::PI;

use super::elliptic::Elliptic;
use super::root::root;

/// Smallest ratio of the semi-axes for which the ratio is solved; a longer ellipse is a line.
const SMALLEST_RATIO: f64 = 1e-7;

/// Two bodies that touch in a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointContact {
    /// Relative radius R of both curvatures. \[m\]
    radius: f64,
    /// Contact modulus E*. \[Pa\]
    modulus: f64,
    /// Short over long semi-axis.
    ratio: f64,
    /// True if the long semi-axis is across the direction of rolling.
    is_across: bool,
    integrals: Elliptic,
    /// Load over the power 3/2 of the approach. \[N/m^1.5\]
    stiffness: f64,
}

/// A contact under load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ellipse {
    /// Semi-axis across the direction of rolling. \[m\]
    pub across: f64,
    /// Semi-axis along the direction of rolling. \[m\]
    pub along: f64,
    /// Maximum pressure p0. \[Pa\]
    pub pressure: f64,
    /// Approach of the bodies. \[m\]
    pub approach: f64,
}

impl PointContact {
    /// The contact of bodies with relative radii along and across the direction of rolling, both positive (m), and the contact modulus
    /// E* (Pa).
    pub fn new(along: f64, across: f64, modulus: f64) -> Self {
        let radius = 1.0 / (1.0 / along + 1.0 / across);
        let difference = ((1.0 / along - 1.0 / across) * radius).abs();
        // 2/(chi^2 - 1) (K/E - 1), with chi^2 - 1 = m chi^2.
        let excess = |log: f64| {
            let ratio = log.exp();
            1.0 - difference - 2.0 * ratio * ratio * Elliptic::complementary(ratio).excess
        };
        let log = root(excess, SMALLEST_RATIO.ln(), 0.0);
        let ratio = log.map_or(SMALLEST_RATIO, f64::exp);
        let integrals = Elliptic::complementary(ratio);
        let mut contact = Self {
            radius,
            modulus,
            ratio,
            is_across: across >= along,
            integrals,
            stiffness: 1.0,
        };
        contact.stiffness = contact.under(1.0).approach.powf(-1.5);
        contact
    }

    /// Load over the power 3/2 of the approach. \[N/m^1.5\]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Short over long semi-axis.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Complete elliptic integral of the second kind of the ellipse.
    pub fn second_integral(&self) -> f64 {
        self.integrals.second
    }

    /// The contact under a load; without load a point.
    pub fn under(&self, load: f64) -> Ellipse {
        if load <= 0.0 {
            return Ellipse::default();
        }
        let Elliptic { first, second, .. } = self.integrals;
        let long = (3.0 * second * load * self.radius / (PI * self.modulus * self.ratio * self.ratio)).cbrt();
        let short = self.ratio * long;
        let [across, along] = if self.is_across { [long, short] } else { [short, long] };
        Ellipse {
            across,
            along,
            pressure: 1.5 * load / (PI * long * short),
            approach: 1.5 * first * load / (PI * long * self.modulus),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rolling::Material;
    use crate::testing::assert_close;
    use proptest::prelude::*;

    fn steel() -> f64 {
        Material::STEEL.contact_modulus(&Material::STEEL)
    }

    /// A sphere with a radius of 5 mm on a plane under 100 N: a^3 = 3 Q R/(4 E*), p0 = 3 Q/(2 pi a^2), delta = a^2/R.
    #[test]
    fn a_sphere_touches_in_a_circle() {
        let radius = 5e-3;
        let found = PointContact::new(radius, radius, steel()).under(100.0);
        let a = (0.75 * 100.0 * radius / steel()).cbrt();
        assert_close(found.across, a, 1e-14);
        assert_close(found.along, a, 1e-14);
        assert_close(found.pressure, 150.0 / (PI * a * a), 1e-14);
        assert_close(found.approach, a * a / radius, 1e-14);
    }

    proptest! {
        /// Directions exchanged, semi-axes exchanged; stiffness and load agree; the mean pressure is two thirds of the maximum; the ratio is
        /// near the fit (R_y/R_x)^(2/pi) of Hamrock and Brewe.
        #[test]
        fn laws_of_hertz(along in 1e-3..0.1_f64, ratio in 1e-3..1e3_f64, load in 1e-3..1e5_f64) {
            let contact = PointContact::new(along, along * ratio, steel());
            let turned = PointContact::new(along * ratio, along, steel());
            let (one, other) = (contact.under(load), turned.under(load));
            prop_assert!((one.across / other.along - 1.0).abs() < 1e-12);
            prop_assert!((one.pressure / other.pressure - 1.0).abs() < 1e-12);
            prop_assert!((contact.stiffness() * one.approach.powf(1.5) / load - 1.0).abs() < 1e-12);
            prop_assert!((PI * one.across * one.along * one.pressure / 1.5 / load - 1.0).abs() < 1e-12);
            prop_assert!((one.across >= one.along) == (ratio >= 1.0));
            let fit = ratio.max(1.0 / ratio).powf(2.0 / PI);
            prop_assert!((contact.ratio() * fit - 1.0).abs() < 0.2, "{}", contact.ratio() * fit);
        }
    }
}
