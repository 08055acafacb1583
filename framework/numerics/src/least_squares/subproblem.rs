//! The minimum of a linear model of the residuals inside a ball and a box.

use nalgebra::{DMatrix, DVector};

use super::cone;
use super::dogleg;
use super::linear;
use super::options::Subproblem;

/// Method that found a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// The Gauss-Newton step is inside ball and bounds.
    Shortcut,
    /// Cone program.
    Cone,
    /// Dogleg after a failed cone program.
    Fallback,
    /// Dogleg by option.
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

/// |z| <= radius and lower <= z <= upper; zero is inside.
pub(super) struct Region {
    pub radius: f64,
    pub lower: DVector<f64>,
    pub upper: DVector<f64>,
}

/// A step with its method.
pub(super) struct Step {
    pub z: DVector<f64>,
    pub how: How,
    /// Whether a cone program was solved.
    pub cone: bool,
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

/// The step to the minimum of the model, or one with sufficient decrease if the cone program fails.
pub(super) fn step(model: &Model<'_>, region: &Region, way: Subproblem) -> Step {
    let whole: Vec<usize> = (0..model.r.ncols()).collect();
    let newton = model.minimum(&DVector::zeros(whole.len()), &whole);
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
    // A comparison that also fails for NaN.
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
