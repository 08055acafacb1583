//! Solids of revolution that displace oil: gears and shafts.

use std::f64::consts::PI;

/// A disc on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Height of its axis in its middle. \[m\]
    pub height: f64,
    /// Radius. \[m\]
    pub radius: f64,
    /// Width along the axis. \[m\]
    pub width: f64,
    /// How much the surface rises across the axis per height of the level: one for a horizontal axis.
    pub slope: f64,
    /// How much deeper the surface is at one end than at the other: zero for a horizontal axis. \[m\]
    pub rise: f64,
}

/// Rise over the radius below which the middle stands for the width: its error is smaller than the rounding of the integral.
const LEVEL: f64 = 1e-5;

impl Disc {
    /// Volume below a level, and its derivative. \[m3 and m2\]
    pub fn below(&self, level: f64) -> [f64; 2] {
        let depth = (level - self.height) * self.slope + self.radius;
        let half = 0.5 * self.rise.abs();
        if depth + half <= 0.0 {
            return [0.0, 0.0];
        }
        if self.rise.abs() > LEVEL * self.radius {
            let [low, high] = [depth - half, depth + half].map(|depth| self.segment(depth));
            let part = self.width / (2.0 * half);
            return [part * (high[1] - low[1]), part * (high[0] - low[0]) * self.slope];
        }
        let share = (depth / self.radius).min(2.0);
        let cosine = 1.0 - share;
        let sine = (share * (2.0 - share)).sqrt();
        let area = self.radius * self.radius * (cosine.acos() - sine * cosine);
        let chord = if depth < 2.0 * self.radius {
            2.0 * self.radius * sine
        } else {
            0.0
        };
        [self.width * area, self.width * chord * self.slope]
    }

    /// Area of the segment of a depth, and its integral over the depth. \[m2 and m3\]
    fn segment(&self, depth: f64) -> [f64; 2] {
        let square = self.radius * self.radius;
        if depth <= 0.0 {
            return [0.0, 0.0];
        }
        let over = (depth - 2.0 * self.radius).max(0.0);
        let q = (1.0 - depth / self.radius).max(-1.0);
        let (angle, sine) = (q.acos(), (1.0 - q * q).max(0.0).sqrt());
        let integral = sine - sine * sine * sine / 3.0 - q * angle;
        [
            square * (angle - q * sine),
            square * self.radius * integral + PI * square * over,
        ]
    }
}
