//! Completion without derivatives, for residuals with kinks and jumps.
//!
//! If a law changes its regime, its slope and often its value are discontinuous. Differences over short steps then predict a decrease that
//! no step achieves, the ball shrinks to zero, and a search ends at the first discontinuity: the sum of squares is a smooth valley with
//! many small steps, each of which is a local minimum. A bundle of gradients from both sides of a kink would also end at each of these
//! steps, because the slope near a jump does not show the value behind it.
//!
//! The method here is implicit filtering (Gilmore and Kelley, "An implicit filtering algorithm for optimization of functions with many
//! local minima", SIAM J. Optim. 5 (1995) 269-285; for least squares Kelley, "Implicit Filtering" (SIAM 2011)): points on both sides along
//! each axis are compared, and the differences over these long steps give one more Gauss-Newton step. The lowest point is used; if none is
//! lower by a share of the squared step (Kolda, Lewis and Torczon, SIAM Review 45 (2003) 385-482, section 3.7), the axes are rotated as a
//! whole, because along a kink no axis of a fixed set may lead downhill, to directions from a low-discrepancy sequence (Abramson, Audet,
//! Dennis and Le Digabel, "OrthoMADS", SIAM J. Optim. 20 (2009) 948-966); if again none is lower, the steps are halved. Axes are the
//! principal axes of the linearised fit, and steps are in standard errors along them, so that long steps skip insignificant steps of the
//! sum of squares. The result is a point whose neighbours at a thousandth of a standard error are all higher. Decisions do not depend on
//! time or random numbers, bounds are satisfied exactly, and the number of calls is limited.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::context::{Context, Point};
use super::evaluate::Miss;
use super::fit::Side;
use super::linear;
use super::optimality;
use super::points;
use super::space::Space;

/// First and last step in standard errors. \[-\]
const STEPS: [f64; 2] = [2.0, 1e-3];
/// Maximum number of sweeps over all axes with one step.
const SWEEPS: usize = 8;
/// Minimum decrease of twice the cost, over the variance and the squared step, of an accepted point. \[-\]
const ENOUGH: f64 = 1e-3;
/// Maximum Gauss-Newton step in standard errors. \[-\]
const FARTHEST: f64 = 5.0;
/// Tried fractions of the Gauss-Newton step.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];
/// Minimum fraction of a step that is cut by a bound. \[-\]
const CUT: f64 = 0.01;
/// Maximum number of calls for each axis.
const CALLS: usize = 400;

/// Axes for the comparison of neighbours, over the coordinates of the free parameters.
pub(super) struct Axes {
    /// Steps of one standard error: along the principal axes, then along coordinates at active bounds.
    pub steps: Vec<DVector<f64>>,
    /// Number of principal axes among them.
    pub principal: usize,
    /// Variance of a residual by the scatter of all. \[-\]
    pub variance: f64,
}

/// Result of the completion.
pub(super) struct Polished {
    pub point: Point,
    /// Whether the steps reached the last one before the limit of calls.
    pub settled: bool,
}

impl Axes {
    /// Principal axes of the free columns, and the coordinates at active bounds.
    pub fn principal(context: &Context<'_>, point: &Point, jacobian: &DMatrix<f64>) -> Option<Self> {
        Self::with_held(context, point, jacobian, false)
    }

    /// The same within the bounds: every coordinate at a bound is fixed there, even if derivatives point inwards. Near a jump derivatives
    /// are unreliable, and axes that leave the bounds are useless.
    pub fn between_bounds(context: &Context<'_>, point: &Point, jacobian: &DMatrix<f64>) -> Option<Self> {
        Self::with_held(context, point, jacobian, true)
    }

    fn with_held(context: &Context<'_>, point: &Point, jacobian: &DMatrix<f64>, at_bounds: bool) -> Option<Self> {
        let space = context.evaluator.space;
        let weighted = context.robust.weighted(&point.r);
        let rows = weighted.rows(jacobian);
        let gradient = rows.tr_mul(&weighted.residual);
        let mut active = optimality::active(space, &point.u, &gradient);
        for (j, active) in active.iter_mut().enumerate().filter(|_| at_bounds) {
            *active = active.or(match point.u[j] {
                u if u <= space.lower[j] => Some(Side::Lower),
                u if u >= space.upper[j] => Some(Side::Upper),
                _ => None,
            });
        }
        let norms: Vec<f64> = rows.column_iter().map(|column| column.norm()).collect();
        let seen = |j: &usize| norms[*j] > 0.0;
        let free: Vec<usize> = optimality::inactive(&active).into_iter().filter(seen).collect();
        let variance = match rows.nrows().checked_sub(free.len()) {
            Some(freedom) if freedom > 0 => 2.0 * context.robust.cost(&point.r) / freedom as f64,
            _ => 1.0,
        };
        if !(variance > 0.0 && variance.is_finite()) {
            return None;
        }
        let deviation = variance.sqrt();
        let mut unit = linear::columns(&rows, &free);
        for (mut column, j) in unit.column_iter_mut().zip(&free) {
            column /= norms[*j];
        }
        let mut steps = Vec::new();
        for (direction, singular) in linear::directions(unit)? {
            let mut step = DVector::zeros(space.len());
            for (i, j) in free.iter().enumerate() {
                step[*j] = deviation * direction[i] / (norms[*j] * singular.max(f64::MIN_POSITIVE));
            }
            steps.push(no_longer_than_usual(space, step));
        }
        let principal = steps.len();
        for j in (0..space.len()).filter(|j| active[*j].is_some()).filter(seen) {
            let mut step = DVector::zeros(space.len());
            step[j] = deviation / norms[j];
            steps.push(no_longer_than_usual(space, step));
        }
        (!steps.is_empty()).then_some(Self {
            steps,
            principal,
            variance,
        })
    }

    /// The axes reflected by a Householder matrix whose normal is from a low-discrepancy sequence.
    fn turned(&self, turn: usize) -> Vec<DVector<f64>> {
        let count = self.steps.len();
        let mut normal = DVector::from_vec(points::spread(turn, count)).map(|x| 2.0 * x - 1.0);
        let length = normal.norm();
        if length > 0.0 {
            normal /= length;
        }
        let mirrored = |i: usize| {
            let mut step = self.steps[i].clone();
            for (k, earlier) in self.steps.iter().enumerate() {
                step -= earlier * (2.0 * normal[i] * normal[k]);
            }
            step
        };
        (0..count).map(mirrored).collect()
    }
}

/// Limits a step along poorly determined directions to the typical sizes of its coordinates.
fn no_longer_than_usual(space: &Space<'_>, step: DVector<f64>) -> DVector<f64> {
    let size = |j: usize| step[j].abs() / space.typical[j];
    let longest = (0..step.len()).map(size).fold(1.0, f64::max);
    step / longest
}

/// Fraction of a step within the bounds.
pub(super) fn inside(space: &Space<'_>, u: &[f64], step: &DVector<f64>, length: f64) -> f64 {
    let room = |j: usize| match length * step[j] {
        d if d > 0.0 => (space.upper[j] - u[j]) / d,
        d if d < 0.0 => (space.lower[j] - u[j]) / d,
        _ => f64::INFINITY,
    };
    length * (0..u.len()).map(room).fold(1.0, f64::min)
}

/// Completes a search from its end, with the derivatives there.
///
/// # Errors
/// If it is interrupted.
pub(super) fn polish(context: &Context<'_>, start: Point, jacobian: &DMatrix<f64>) -> Result<Polished, Miss> {
    let Some(axes) = Axes::principal(context, &start, jacobian) else {
        let (point, settled) = (start, false);
        return Ok(Polished { point, settled });
    };
    let most = context.evaluator.evaluations() + CALLS * axes.steps.len();
    let (mut point, mut step, mut turn) = (start, STEPS[0], 0);
    while step >= STEPS[1] {
        let enough = 0.5 * ENOUGH * axes.variance * step * step;
        for _ in 0..SWEEPS {
            if context.evaluator.evaluations() >= most {
                let settled = false;
                return Ok(Polished { point, settled });
            }
            let falls = |next: &Point| context.robust.fall(&point.r, &next.r) > enough;
            let mut next = lower(context, &axes.steps, &point, step)?.filter(falls);
            if next.is_none() {
                turn += 1;
                next = lower(context, &axes.turned(turn), &point, step)?.filter(falls);
            }
            match next {
                Some(next) => point = next,
                None => break,
            }
        }
        step *= 0.5;
    }
    let settled = true;
    Ok(Polished { point, settled })
}

/// The lowest of the neighbours on the axes and of the points along their Gauss-Newton step; absent if none has a value.
fn lower(context: &Context<'_>, axes: &[DVector<f64>], point: &Point, step: f64) -> Result<Option<Point>, Miss> {
    let (space, evaluator) = (context.evaluator.space, context.evaluator);
    let tries: Vec<(usize, f64)> = (0..axes.len()).flat_map(|k| [(k, step), (k, -step)]).collect();
    let neighbour = |(k, length): &(usize, f64)| -> Result<Option<(f64, Point)>, Miss> {
        let taken = inside(space, &point.u, &axes[*k], *length);
        if taken.abs() < CUT * step {
            return Ok(None);
        }
        let u = moved(space, &point.u, &(&axes[*k] * taken));
        let r = evaluator.try_residual(&u)?;
        Ok(r.map(|r| (taken, Point { u, r })))
    };
    let neighbours: Vec<Option<(f64, Point)>> = tries
        .par_iter()
        .with_max_len(1)
        .map(neighbour)
        .collect::<Result<_, _>>()?;
    let mut columns: Vec<DVector<f64>> = Vec::new();
    let mut moving: Vec<usize> = Vec::new();
    for (k, pair) in neighbours.chunks(2).enumerate() {
        let column = match (&pair[0], &pair[1]) {
            (Some((up, above)), Some((down, below))) => (&above.r - &below.r) / (up - down),
            (Some((taken, there)), None) | (None, Some((taken, there))) => (&there.r - &point.r) / *taken,
            (None, None) => continue,
        };
        columns.push(column);
        moving.push(k);
    }
    let mut found: Vec<Point> = neighbours.into_iter().flatten().map(|(_, there)| there).collect();
    if !columns.is_empty() {
        let weighted = context.robust.weighted(&point.r);
        let rows = weighted.rows(&DMatrix::from_columns(&columns));
        if let Some(gauss_newton) = linear::nearest(rows, &(-&weighted.residual)) {
            let longest = (gauss_newton.norm() / FARTHEST).max(1.0);
            let mut whole = DVector::zeros(space.len());
            for (length, k) in gauss_newton.iter().zip(&moving) {
                whole += &axes[*k] * (length / longest);
            }
            let along = |share: &f64| -> Result<Option<Point>, Miss> {
                let u = moved(space, &point.u, &(&whole * *share));
                let r = evaluator.try_residual(&u)?;
                Ok(r.map(|r| Point { u, r }))
            };
            let along: Vec<Option<Point>> = SHARES.par_iter().with_max_len(1).map(along).collect::<Result<_, _>>()?;
            found.extend(along.into_iter().flatten());
        }
    }
    let cost = |at: &Point| context.robust.cost(&at.r);
    Ok(found.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b))))
}

/// Coordinates after a step, within the bounds.
pub(super) fn moved(space: &Space<'_>, u: &[f64], step: &DVector<f64>) -> Vec<f64> {
    (0..u.len())
        .map(|j| (u[j] + step[j]).clamp(space.lower[j], space.upper[j]))
        .collect()
}
