//! The least of a linear model of the residuals inside a ball and a box.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::cone;
use super::dogleg;
use super::linear;
use super::options::Subproblem;

/// How a step was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum How {
    /// The Gauss-Newton step lies inside ball and bounds.
    Shortcut,
    /// By the cone program.
    Cone,
    /// By dogleg, since the cone program had no answer.
    Fallback,
    /// By dogleg, as the user wants it.
    Dogleg,
}

impl How {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shortcut => "gauss-newton",
            Self::Cone => "cone program",
            Self::Fallback => "dogleg, since the cone program had no answer",
            Self::Dogleg => "dogleg",
        }
    }
}

/// 1/2 |R z + q|^2.
pub(super) struct Model<'a> {
    pub r: &'a DMatrix<f64>,
    pub q: &'a DVector<f64>,
}

/// |z| <= radius and lower <= z <= upper; zero lies inside.
pub(super) struct Region {
    pub radius: f64,
    pub lower: DVector<f64>,
    pub upper: DVector<f64>,
}

/// A step with how it was found.
pub(super) struct Step {
    pub z: DVector<f64>,
    pub how: How,
    /// Whether a cone program was solved on the way.
    pub cone: bool,
}

impl Model<'_> {
    /// By how much the model falls from zero to z. Not the difference of two norms, which cancels.
    pub fn fall(&self, z: &DVector<f64>) -> f64 {
        let step = self.r * z;
        -self.q.dot(&step) - 0.5 * step.norm_squared()
    }

    /// Slope of the model from zero towards z, downwards.
    pub fn slope(&self, z: &DVector<f64>) -> f64 {
        -self.q.dot(&(self.r * z))
    }

    /// Gradient at z.
    pub fn gradient(&self, z: &DVector<f64>) -> DVector<f64> {
        self.r.tr_mul(&(self.r * z + self.q))
    }

    /// The least over some components, the others as they are in z.
    pub fn least(&self, z: &DVector<f64>, free: &[usize]) -> Option<DVector<f64>> {
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

impl Region {
    /// Whether a point lies in the box.
    pub fn boxes(&self, z: &DVector<f64>) -> bool {
        (0..z.len()).all(|j| self.lower[j] <= z[j] && z[j] <= self.upper[j])
    }

    /// Whether a point lies in ball and box.
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

/// The step with the least of the model, or one that falls enough where the cone program has no answer.
pub(super) fn step(model: &Model<'_>, region: &Region, way: Subproblem) -> Step {
    let whole: Vec<usize> = (0..model.r.ncols()).collect();
    let newton = model.least(&DVector::zeros(whole.len()), &whole);
    if let Some(z) = newton.as_ref().filter(|z| region.holds(z)) {
        return Step {
            z: z.clone(),
            how: How::Shortcut,
            cone: false,
        };
    }
    if way == Subproblem::Dogleg {
        return Step {
            z: dogleg::step(model, region),
            how: How::Dogleg,
            cone: false,
        };
    }
    let newton = newton.map_or(f64::INFINITY, |z| z.norm());
    let answer = cone::step(model, region, newton);
    // A comparison that what is not a number fails as well.
    match answer.filter(|z| model.fall(z) > 0.0) {
        Some(z) => Step {
            z,
            how: How::Cone,
            cone: true,
        },
        None => Step {
            z: dogleg::step(model, region),
            how: How::Fallback,
            cone: true,
        },
    }
}
