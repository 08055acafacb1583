//! Solids of revolution that displace oil: gears and shafts.

/// A disc on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Height of its axis. \[m\]
    pub height: f64,
    /// Radius. \[m\]
    pub radius: f64,
    /// Width along the axis. \[m\]
    pub width: f64,
    /// How much the surface rises across the axis per height of the level: one for a horizontal axis.
    pub slope: f64,
}

impl Disc {
    /// Volume below a level, and its derivative. \[m3 and m2\]
    pub fn below(&self, level: f64) -> [f64; 2] {
        let depth = (level - self.height) * self.slope + self.radius;
        if depth <= 0.0 {
            return [0.0, 0.0];
        }
        let angle = (1.0 - depth.min(2.0 * self.radius) / self.radius).acos();
        let (sine, cosine) = angle.sin_cos();
        let area = self.radius * self.radius * (angle - sine * cosine);
        let chord = if depth < 2.0 * self.radius {
            2.0 * self.radius * sine
        } else {
            0.0
        };
        [self.width * area, self.width * chord * self.slope]
    }
}
