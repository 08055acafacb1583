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

    /// The surface of a bevel gear, whose outer circle this one is about: the inner face is smaller, and the toothed face is a cone. The immersion
    /// angle is that of the outer circle. At a pitch angle of zero both radii are equal, and nothing changes.
    pub fn on_cone(self, inner: f64, outer: f64) -> Self {
        if inner == outer {
            return self;
        }
        let share = inner.max(0.0) / outer;
        Self {
            side: self.side * 0.5 * (1.0 + share * share),
            rim: self.rim * 0.5 * (1.0 + share),
            teeth: self.teeth,
        }
    }

    pub fn sum(&self) -> f64 {
        self.side + self.rim + self.teeth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Surfaces of a frustum that is immersed wholly: the cone is pi b (r_e + r_i).
    #[test]
    fn a_bevel_gear_has_the_surface_of_a_frustum() {
        let (outer, inner, b) = (0.085_f64, 0.057_f64, 0.030);
        let whole = Wetted::new(outer, 0.200, b, 42.0, 0.008, 20.0_f64.to_radians(), 0.6).on_cone(inner, outer);
        let close = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-12, "{value} {expected}");
        close(whole.rim, std::f64::consts::PI * b * (outer + inner));
        close(whole.side, std::f64::consts::PI * (outer * outer + inner * inner));
        let flat = Wetted::new(outer, 0.020, b, 42.0, 0.008, 0.35, 0.6);
        let (sum, same) = (flat.sum(), flat.on_cone(outer, outer).sum());
        assert_eq!(sum.to_bits(), same.to_bits());
    }

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
