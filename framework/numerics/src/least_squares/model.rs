//! Linear model of the residuals in a step, and the region of the step.

use nalgebra::{DMatrix, DVector};

use super::linear;

/// 1/2 |R z + q|^2.
pub(super) struct Model<'a> {
    pub r: &'a DMatrix<f64>,
    pub q: &'a DVector<f64>,
}

impl Model<'_> {
    /// Decrease of the model from zero to z, without cancellation.
    pub fn fall(&self, z: &DVector<f64>) -> f64 {
        let step = self.r * z;
        -self.q.dot(&step) - 0.5 * step.norm_squared()
    }

    /// Negative slope of the model from zero towards z.
    pub fn slope(&self, z: &DVector<f64>) -> f64 {
        -self.q.dot(&(self.r * z))
    }

    /// Gradient at z.
    pub fn gradient(&self, z: &DVector<f64>) -> DVector<f64> {
        self.r.tr_mul(&(self.r * z + self.q))
    }

    /// The minimum over some components, the others as in z.
    pub fn minimum(&self, z: &DVector<f64>, free: &[usize]) -> Option<DVector<f64>> {
        let mut held = z.clone();
        for j in free {
            held[*j] = 0.0;
        }
        let target = -(self.r * &held + self.q);
        let part = linear::nearest(linear::columns(self.r, free), &target)?;
        for (j, x) in free.iter().zip(part.iter()) {
            held[*j] = *x;
        }
        Some(held)
    }
}

/// |z| <= radius and lower <= z <= upper; zero is inside.
pub(super) struct Region {
    pub radius: f64,
    pub lower: DVector<f64>,
    pub upper: DVector<f64>,
}

impl Region {
    /// Whether a point is in the box.
    pub fn boxes(&self, z: &DVector<f64>) -> bool {
        (0..z.len()).all(|j| self.lower[j] <= z[j] && z[j] <= self.upper[j])
    }

    /// Whether a point is in ball and box.
    pub fn holds(&self, z: &DVector<f64>) -> bool {
        z.norm() <= self.radius && self.boxes(z)
    }

    /// Moves a point into the box.
    pub fn clip(&self, z: &mut DVector<f64>) {
        for j in 0..z.len() {
            z[j] = z[j].clamp(self.lower[j], self.upper[j]);
        }
    }
}
