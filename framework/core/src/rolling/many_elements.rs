//! Bearings with very many elements of a fixed contact angle: integrals of Sjoevall.
//!
//! Source: Sjoevall 1933, as in textbooks and catalogues. With the load zone eps = (1 + delta_a tan a/delta_r)/2 the load at an angle psi from
//! the most loaded element is Q_max (1 - (1 - cos psi)/(2 eps))^n, and J_r, J_a are its means around the bearing, J_r weighted with cos psi:
//! Fr = Z Q_max J_r cos a, Fa = Z Q_max J_a sin a. n = 3/2 for points and 10/9 for lines.

use std::f64::consts::{FRAC_PI_2, PI};

use super::root::{root, root_of_growing};

/// Contact of a rolling element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// In a point: balls.
    Point,
    /// In a line: rollers.
    Line,
}

impl Contact {
    /// Exponent of the approach in the load.
    pub fn exponent(self) -> f64 {
        match self {
            Self::Point => 1.5,
            Self::Line => 10.0 / 9.0,
        }
    }
}

/// Mean around the bearing of the relative load with a power, and the same weighted with the cosine: with the exponent n of a contact the
/// integrals J_a and J_r. `zone` is eps, positive; at infinity all elements carry the same load.
pub fn load_integral(zone: f64, power: f64) -> [f64; 2] {
    if zone <= 0.0 {
        return [0.0; 2];
    }
    let half_width = if zone < 1.0 { 2.0 * zone.sqrt().asin() } else { PI };
    // Double exponential quadrature from the middle to the end of the zone, where the load has a root.
    let step = 1.0 / 32.0;
    let mut sums = [0.0; 2];
    for i in -128..=128 {
        let t = f64::from(i) * step;
        let sinh = FRAC_PI_2 * t.sinh();
        let psi = half_width / (1.0 + (-2.0 * sinh).exp());
        let weight = FRAC_PI_2 * t.cosh() / (2.0 * sinh.cosh().powi(2));
        let half = (0.5 * psi).sin();
        let load = (1.0 - half * half / zone).max(0.0).powf(power);
        sums[0] += weight * load;
        sums[1] += weight * load * psi.cos();
    }
    sums.map(|sum| sum * step * half_width / PI)
}

/// A row of very many elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManyElements {
    /// Number of elements.
    pub number: f64,
    /// Load of an element over the power n of its approach, in SI.
    pub stiffness: f64,
    /// Contact angle, positive. \[rad\]
    pub contact_angle: f64,
    /// Contact.
    pub contact: Contact,
}

impl ManyElements {
    /// Radial and axial load at displacements of the inner ring, the radial one not negative. \[N\]
    fn loads(&self, axial: f64, radial: f64) -> [f64; 2] {
        let (sin, cos) = self.contact_angle.sin_cos();
        let greatest = radial * cos + axial * sin;
        if greatest <= 0.0 {
            return [0.0; 2];
        }
        let n = self.contact.exponent();
        // eps is the greatest approach over twice the radial one.
        let [j_a, j_r] = load_integral(0.5 * greatest / (radial * cos), n);
        let sum = self.number * self.stiffness * greatest.powf(n);
        [sum * j_r * cos, sum * j_a * sin]
    }

    /// Thrust at an axial displacement under a radial load; `None` if no radial displacement balances the load. \[N\]
    pub fn thrust(&self, radial_load: f64, axial: f64) -> Option<f64> {
        if radial_load <= 0.0 {
            return Some(self.loads(axial, 0.0)[1]);
        }
        let (sin, cos) = self.contact_angle.sin_cos();
        // Without overlap of the most loaded element there is no load.
        let start = (-axial * sin / cos).max(0.0);
        let alone = (radial_load / (self.number * self.stiffness * cos)).powf(1.0 / self.contact.exponent());
        let radial = root_of_growing(|r| self.loads(axial, r)[0] - radial_load, start, alone / cos, 60)?;
        Some(self.loads(axial, radial)[1])
    }

    /// Axial displacement at a thrust without radial load. \[m\]
    pub fn approach(&self, thrust: f64) -> f64 {
        let sin = self.contact_angle.sin();
        let load = thrust.max(0.0) / (self.number * sin);
        (load / self.stiffness).powf(1.0 / self.contact.exponent()) / sin
    }

    /// Load zone eps under a radial load and a thrust; infinite without radial load, `None` below the least thrust Fr tan a, with which a single
    /// element carries all.
    pub fn zone(&self, radial_load: f64, thrust: f64) -> Option<f64> {
        if radial_load <= 0.0 {
            return (thrust > 0.0).then_some(f64::INFINITY);
        }
        let wanted = radial_load * self.contact_angle.tan() / thrust;
        let n = self.contact.exponent();
        // J_r/J_a falls from one to zero.
        let ratio = |log: f64| {
            let [j_a, j_r] = load_integral(log.exp(), n);
            j_r / j_a - wanted
        };
        root(ratio, 1e-6_f64.ln(), 1e6_f64.ln()).map(f64::exp)
    }
}
