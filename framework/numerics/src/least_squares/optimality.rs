//! Measures of the distance from a minimum within the bounds.

use nalgebra::{DMatrix, DVector};

use super::fit::Side;
use super::linear;
use super::space::Space;

/// Error of central differences, relative to a column.
const ROUNDING: f64 = 1e-9;

/// The active bound of each coordinate.
pub(super) fn active(space: &Space<'_>, u: &[f64], gradient: &DVector<f64>) -> Vec<Option<Side>> {
    let side = |j: usize| match gradient[j] {
        g if g > 0.0 && u[j] <= space.lower[j] => Some(Side::Lower),
        g if g < 0.0 && u[j] >= space.upper[j] => Some(Side::Upper),
        _ => None,
    };
    (0..u.len()).map(side).collect()
}

/// The first-order measure: the largest cosine between a column and the residual, limited by the distance to a bound. Pure number; zero at
/// an active bound, continuous near it.
pub(super) fn first_order(space: &Space<'_>, u: &[f64], jacobian: &DMatrix<f64>, residual: &DVector<f64>) -> f64 {
    let length = residual.norm();
    let measure = |j: usize| {
        let column = jacobian.column(j);
        let norm = column.norm();
        if norm == 0.0 || length == 0.0 {
            return 0.0;
        }
        let along = column.dot(residual);
        let room = if along > 0.0 {
            u[j] - space.lower[j]
        } else {
            space.upper[j] - u[j]
        };
        (along.abs() / (norm * length)).min(room * norm / length)
    };
    (0..u.len()).map(measure).fold(0.0, f64::max)
}

/// Indices of the coordinates that no bound holds: those not at a bound, and those at one with a gradient not larger than that remaining in
/// the other columns. A column that is a combination of the others is never above that, so that its bound cannot hide the singularity.
pub(super) fn unheld(jacobian: &DMatrix<f64>, residual: &DVector<f64>, active: &[Option<Side>]) -> Vec<usize> {
    let free = inactive(active);
    let left = linear::Factors::new(linear::columns(jacobian, &free), residual)
        .q
        .norm();
    let noise = ROUNDING * residual.norm();
    let holds = |j: usize| {
        let column = jacobian.column(j);
        column.dot(residual).abs() > (2.0 * left + noise) * column.norm()
    };
    (0..active.len())
        .filter(|j| active[*j].is_none() || !holds(*j))
        .collect()
}

/// The relative offset: part of the residual in the space of the free columns relative to the part outside it, each over its degrees of
/// freedom. Absent without degrees of freedom.
pub(super) fn relative_offset(
    jacobian: &DMatrix<f64>,
    residual: &DVector<f64>,
    active: &[Option<Side>],
) -> Option<f64> {
    let free: Vec<usize> = inactive(active);
    let (rows, n) = (residual.len(), free.len());
    if n == 0 || rows <= n {
        return None;
    }
    let inside = linear::Factors::new(linear::columns(jacobian, &free), residual)
        .q
        .norm_squared();
    let outside = residual.norm_squared() - inside;
    (outside > 0.0).then(|| (inside / n as f64).sqrt() / (outside / (rows - n) as f64).sqrt())
}

/// Indices of the coordinates that are not at a bound.
pub(super) fn inactive(active: &[Option<Side>]) -> Vec<usize> {
    (0..active.len()).filter(|j| active[*j].is_none()).collect()
}
