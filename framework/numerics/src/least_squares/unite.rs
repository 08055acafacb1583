//! Merges ends of searches into minima.
//!
//! On a sum of squares with many small steps searches rarely end at the same point. Ends are one minimum if the data cannot distinguish
//! them: if twice their costs differ by less than the square of half a standard error, and twice the cost increases by no more on the
//! straight line between them. Standard errors are based on the scatter of the residuals.

use super::evaluate::Evaluator;
use super::fault::Fault;
use super::finish::{finish, is_stuck};
use super::fit::Fit;
use super::multistart::{BETWEEN, Minimum, level, near};
use super::options::Options;
use super::problem::Problem;
use super::robust::Robust;
use super::space::Space;

/// Insignificant increase of twice the cost over the variance by scatter, [`Fit::scatter`]: half a standard error. \[-\]
pub const UNTOLD: f64 = 0.25;
/// Decrease of the same between two ends above which a search starts between them. \[-\]
const LOWER: f64 = 1e-3;
/// Maximum number of searches from points between ends.
const SEARCHES: usize = 10;

/// Relation of two ends.
enum Between {
    /// They are one minimum.
    Nothing,
    /// The data distinguish them.
    Barrier,
    /// Coordinates between them with a lower cost than at both.
    Lower(Vec<f64>),
}

/// Merges ends of searches into minima, the lowest first; completes searches without progress if needed.
///
/// # Errors
/// If the problem has no residuals at a point where it had some.
pub(super) fn unite(
    problem: &Problem<'_>,
    options: &Options<'_>,
    space: &Space<'_>,
    fits: Vec<(usize, Fit)>,
    begun: f64,
) -> Result<(Vec<Minimum>, usize), Fault> {
    let mut minima: Vec<Minimum> = Vec::new();
    let share = 1.0 / fits.len().max(1) as f64;
    let (mut evaluations, mut searches) = (0, 0);
    for (i, fit) in fits {
        let mut fit = fit;
        let mut joined = None;
        loop {
            let mut lower = None;
            for (k, old) in minima.iter().enumerate() {
                if level(&old.fit, &fit, begun) && near(space, &old.fit, &fit) {
                    joined = Some(k);
                    break;
                }
                match between(problem, options, space, [&old.fit, &fit], &mut evaluations)? {
                    Between::Nothing => joined = Some(k),
                    Between::Lower(u) => lower = Some(u),
                    Between::Barrier => continue,
                }
                break;
            }
            let from = match lower {
                Some(u) if searches < SEARCHES => {
                    searches += 1;
                    Some(u)
                }
                None if joined.is_none() && is_stuck(&fit) => None,
                _ => break,
            };
            let before = fit.counts.evaluations;
            fit = finish(problem, options, space, fit, from.as_deref())?;
            evaluations += fit.counts.evaluations - before;
        }
        match joined {
            Some(k) => {
                let old = &mut minima[k];
                old.starts.push(i);
                old.share += share;
                if fit.cost < old.fit.cost && fit.converged() {
                    old.fit = fit;
                }
            }
            None => minima.push(Minimum {
                fit,
                starts: vec![i],
                share,
            }),
        }
    }
    minima.sort_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
    Ok((minima, evaluations))
}

/// Relation of two ends, from points on a straight line.
fn between(
    problem: &Problem<'_>,
    options: &Options<'_>,
    space: &Space<'_>,
    [a, b]: [&Fit; 2],
    evaluations: &mut usize,
) -> Result<Between, Fault> {
    let least = a.cost.min(b.cost);
    let variance = if a.cost <= b.cost { a.scatter() } else { b.scatter() };
    let rise = |cost: f64| 2.0 * (cost - least) / variance;
    // A combination without effect is a valley and reported as one.
    let known = a.converged() && b.derivative.is_some();
    let untold = rise(a.cost.max(b.cost)) <= UNTOLD;
    if !(known && untold) {
        return Ok(Between::Barrier);
    }
    let [from, to] = [a, b].map(|fit| -> Vec<f64> { space.free.iter().map(|i| fit.u[*i]).collect() });
    let start = space.starting(&from);
    let (evaluator, _) = Evaluator::start(problem, &start, options.interrupt)?;
    let robust = Robust {
        loss: options.loss,
        scale: a.loss_scale,
        rows: evaluator.rows,
    };
    let mut found = Between::Nothing;
    let mut lowest = least;
    for k in 1..=BETWEEN {
        let share = k as f64 / (BETWEEN + 1) as f64;
        let u: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + share * (b - a)).collect();
        let Some(cost) = evaluator.residual(&u).ok().map(|r| robust.cost(&r)) else {
            found = Between::Barrier;
            break;
        };
        if rise(cost) > UNTOLD {
            found = Between::Barrier;
            break;
        }
        if cost < lowest && rise(cost) < -LOWER {
            lowest = cost;
            found = Between::Lower(u);
        }
    }
    *evaluations += evaluator.evaluations();
    Ok(found)
}
