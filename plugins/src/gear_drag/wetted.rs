//! Wetted surface of an immersed gear.

/// Faces, rim and teeth of a gear from the radius of the reference circle, its immersion depth, face width (m), number of teeth,
/// tooth height (m), normal pressure angle and helix angle (rad).
pub struct Wetted {
    /// Both faces. \[m2\]
    pub side: f64,
    /// Rim. \[m2\]
    pub rim: f64,
    /// Flanks of the teeth. \[m2\]
    pub teeth: f64,
}

impl Wetted {
    #[allow(clippy::too_many_arguments)]
    pub fn new(radius: f64, dip: f64, b: f64, z: f64, height: f64, alpha_n: f64, beta: f64) -> Self {
        let theta = (1.0 - (dip / radius).clamp(0.0, 2.0)).acos();
        Self {
            side: radius * radius * (2.0 * theta - (2.0 * theta).sin()),
            rim: 2.0 * radius * b * theta,
            teeth: 2.0 * z * theta * height * b / (std::f64::consts::PI * alpha_n.cos() * beta.cos()),
        }
    }

    pub fn sum(&self) -> f64 {
        self.side + self.rim + self.teeth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c1_wetted_surface() {
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        let w = Wetted::new(
            0.0796,
            0.030,
            0.020,
            96.0,
            0.0036,
            20.0_f64.to_radians(),
            15.0_f64.to_radians(),
        );
        // The faces correspond to an immersion angle of 0.898076 rad.
        close(w.side, 0.00520477);
        close(w.rim, 0.00285948);
        close(w.teeth, 0.00435379);
        close(w.sum(), 0.012418);
        let deep = Wetted::new(0.050, 0.200, 0.020, 40.0, 0.005, 20.0_f64.to_radians(), 0.0);
        close(deep.sum(), 0.0305046);
    }
}
