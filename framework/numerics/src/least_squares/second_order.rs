//! The second-order correction of a step, or geodesic acceleration: Transtrum and Sethna, "Improvements to the
//! Levenberg-Marquardt algorithm for nonlinear least-squares minimization" (2012), arXiv:1201.5885.

use nalgebra::DVector;

use super::linear;
use super::model::{Model, Region};

/// Fraction of the step at which the curvature of the residual is evaluated.
pub(super) const PROBE: f64 = 0.1;
/// Maximum of twice the length of the correction over that of the step.
const LONGEST: f64 = 0.75;

/// Curvature of a residual along a step: from its value at the fraction [`PROBE`] and its slope.
pub(super) fn bend(here: &DVector<f64>, probe: &DVector<f64>, slope: &DVector<f64>) -> DVector<f64> {
    ((probe - here) / PROBE - slope) * (2.0 / PROBE)
}

/// Half the correction of a step, given Q^T of the curvature. Absent if it is too long for the expansion to be valid.
///
/// The step solves a damped problem; the damping follows from the remaining gradient and is used for the correction too.
pub(super) fn correction(
    model: &Model<'_>,
    region: &Region,
    z: &DVector<f64>,
    bend: &DVector<f64>,
) -> Option<DVector<f64>> {
    let free: Vec<usize> = (0..z.len())
        .filter(|j| region.lower[*j] < z[*j] && z[*j] < region.upper[*j])
        .collect();
    let gradient = model.gradient(z);
    let (mut against, mut square) = (0.0, 0.0);
    for j in &free {
        against -= z[*j] * gradient[*j];
        square += z[*j] * z[*j];
    }
    if square == 0.0 {
        return None;
    }
    let damping = (against / square).max(0.0).sqrt();
    let rows = model.r.nrows();
    let mut system = linear::columns(model.r, &free).resize_vertically(rows + free.len(), 0.0);
    for k in 0..free.len() {
        system[(rows + k, k)] = damping;
    }
    let target = (-bend).resize_vertically(rows + free.len(), 0.0);
    let part = linear::nearest(system, &target)?;
    if 2.0 * part.norm() > LONGEST * z.norm() {
        return None;
    }
    let mut half = DVector::zeros(z.len());
    for (j, a) in free.iter().zip(part.iter()) {
        half[*j] = 0.5 * a;
    }
    Some(half)
}
