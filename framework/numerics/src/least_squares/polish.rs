//! The finish without derivatives, for residuals with kinks and jumps.
//!
//! Where a law behind the residuals changes its regime, its slope jumps and often its value too. Differences over short steps then promise
//! a fall that no step brings, the ball shrinks to nothing, and a search ends wherever it meets the first such place: the sum of squares
//! is a smooth valley with many small steps on it, each a minimum of its own. A bundle of gradients from both sides of a kink would
//! end at each of these steps too, because beside a jump no slope shows what lies behind it.
//!
//! The method here is implicit filtering (Gilmore and Kelley, "An implicit filtering algorithm for optimization of functions with many
//! local minima", SIAM J. Optim. 5 (1995) 269-285; for least squares Kelley, "Implicit Filtering" (SIAM 2011)): points on both sides
//! along each axis are compared, and the differences over these long steps give one more Gauss-Newton step. The lowest point wins; where
//! none is lower by a share of the squared step (Kolda, Lewis and Torczon, SIAM Review 45 (2003) 385-482, section 3.7), the steps are
//! axes are turned as a whole, since along a kink no axis of a fixed set may lead downhill, in directions from an even sequence as Abramson, Audet, Dennis
//! and Le Digabel, "OrthoMADS", SIAM J. Optim. 20 (2009) 948-966, take them; where none is lower again, the steps are halved. Axes are the principal axes of the linearised fit and steps are counted in standard errors along them, so that steps on the
//! sum of squares that the data cannot tell are stepped over while the steps are long, and what is left in the end is a point whose
//! neighbours at a thousandth of a standard error are all higher. Decisions depend on no clock and no chance, bounds are kept exactly,
//! and the calls are limited.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::evaluate::Miss;
use super::fit::Side;
use super::iterate::{Context, Point};
use super::linear;
use super::optimality;
use super::points;
use super::space::Space;

/// First and last step, in standard errors. \[-\]
const STEPS: [f64; 2] = [2.0, 1e-3];
/// Sweeps over all axes with one step at most.
const SWEEPS: usize = 8;
/// Least fall of twice the cost, over the variance and the squared step, with which a point is taken. \[-\]
const ENOUGH: f64 = 1e-3;
/// Longest Gauss-Newton step in standard errors. \[-\]
const FARTHEST: f64 = 5.0;
/// Shares of the Gauss-Newton step that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];
/// A step that a bound cuts to less than this share is not taken. \[-\]
const CUT: f64 = 0.01;
/// Calls for each axis at most.
const CALLS: usize = 400;

/// Axes along which neighbours are compared, over the coordinates of the free parameters.
pub(super) struct Axes {
    /// Steps of one standard error: along the principal axes, then along coordinates that a bound holds.
    pub steps: Vec<DVector<f64>>,
    /// How many of them are principal axes.
    pub principal: usize,
    /// Variance of a residual by the scatter of all. \[-\]
    pub variance: f64,
}

/// How a finish ended.
pub(super) struct Polished {
    pub point: Point,
    /// Whether the steps shrank to the last one, rather than the calls running out.
    pub settled: bool,
}

impl Axes {
    /// Principal axes of the columns that are free, and the coordinates that a bound holds.
    pub fn principal(context: &Context<'_>, point: &Point, jacobian: &DMatrix<f64>) -> Option<Self> {
        Self::with_held(context, point, jacobian, false)
    }

    /// The same inside of the bounds: whatever stands on a bound is held there, although derivatives would lead it away. Beside a jump they
    /// tell little, and along axes that lead out of the bounds there is no room on either side.
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

    /// The axes turned as a whole by a mirror whose normal comes from an even sequence.
    fn turned(&self, turn: usize) -> Vec<DVector<f64>> {
        let count = self.steps.len();
        let mut normal = DVector::from_vec(points::spread(turn, count)).map(|x| 2.0 * x - 1.0);
        let length = normal.norm();
        if length > 0.0 {
            normal /= length;
        }
        let mirrored = |i: usize| {
            let mut step = self.steps[i].clone();
            for (k, own) in self.steps.iter().enumerate() {
                step -= own * (2.0 * normal[i] * normal[k]);
            }
            step
        };
        (0..count).map(mirrored).collect()
    }
}

/// Shortens a step along what the data hardly tell to the usual sizes of its coordinates.
fn no_longer_than_usual(space: &Space<'_>, step: DVector<f64>) -> DVector<f64> {
    let size = |j: usize| step[j].abs() / space.typical[j];
    let longest = (0..step.len()).map(size).fold(1.0, f64::max);
    step / longest
}

/// Part of a step that leaves no bound.
pub(super) fn inside(space: &Space<'_>, u: &[f64], step: &DVector<f64>, length: f64) -> f64 {
    let room = |j: usize| match length * step[j] {
        d if d > 0.0 => (space.upper[j] - u[j]) / d,
        d if d < 0.0 => (space.lower[j] - u[j]) / d,
        _ => f64::INFINITY,
    };
    length * (0..u.len()).map(room).fold(1.0, f64::min)
}

/// Finishes a search from its end, with the derivatives there.
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

/// The lowest of the neighbours on the axes and of the points along the Gauss-Newton step that they give; absent where none has a value.
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

/// Coordinates a step away, held inside the bounds.
pub(super) fn moved(space: &Space<'_>, u: &[f64], step: &DVector<f64>) -> Vec<f64> {
    (0..u.len())
        .map(|j| (u[j] + step[j]).clamp(space.lower[j], space.upper[j]))
        .collect()
}
