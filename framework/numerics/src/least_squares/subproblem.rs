//! The minimum of a linear model of the residuals inside a ball and a box.

use nalgebra::DVector;

use super::cone;
use super::dogleg;
use super::fit::How;
use super::model::{Model, Region};
use super::options::Subproblem;

/// A step with its method.
pub(super) struct Step {
    pub z: DVector<f64>,
    pub how: How,
    /// Whether a cone program was solved.
    pub cone: bool,
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
