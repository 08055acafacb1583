//! Point contact of crossed helical teeth.

use nalgebra::{Matrix2, Vector2};

use super::pitch_cones::PitchCones;

/// Contact of crossed helical teeth at the pitch point. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossedPoint {
    /// Radii of curvature of both flanks, perpendicular to their generatrices.
    pub radius: [f64; 2],
    /// Inclinations of the generatrices to the trace of the teeth. \[rad\]
    pub inclination: [f64; 2],
    /// Principal relative radii, the smaller first.
    pub relative_radius: [f64; 2],
}

impl CrossedPoint {
    /// Of a pair of cylinders with a normal pressure angle in rad.
    pub fn new(cylinders: &PitchCones, pressure_angle: f64) -> Self {
        let flank = |i: usize| {
            let (beta, radius) = (cylinders.spiral_angle[i], cylinders.radius[i]);
            let transverse = (pressure_angle.tan() / beta.cos()).atan();
            let base_helix = (beta.sin() * pressure_angle.cos()).asin();
            let inclination = (beta.tan() * pressure_angle.sin()).atan();
            (radius * transverse.sin() / base_helix.cos(), inclination)
        };
        let flanks = [flank(0), flank(1)];
        let curvature = flanks.iter().map(|(radius, inclination)| {
            let across = Vector2::new(-inclination.sin(), inclination.cos());
            across * across.transpose() / *radius
        });
        let mut principal: [f64; 2] = curvature.sum::<Matrix2<f64>>().symmetric_eigenvalues().into();
        principal.sort_by(|a, b| b.total_cmp(a));
        Self {
            radius: flanks.map(|(radius, _)| radius),
            inclination: flanks.map(|(_, inclination)| inclination),
            relative_radius: principal.map(f64::recip),
        }
    }
}
