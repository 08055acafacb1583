//! Kinks and jumps at a minimum.
//!
//! If one parameter moves and all others follow, twice the cost of a smooth minimum increases by the square of the distance in standard
//! errors. If it increases several times as much on either side, slopes or values of residuals are discontinuous, and standard errors from
//! derivatives are invalid for that parameter. The rows concerned are those whose three values, on both sides and in between, deviate most
//! from a straight line.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::context::{Context, Point};
use super::evaluate::Miss;
use super::fit::Kink;
use super::polish::{Axes, inside, moved};

/// Distances from the minimum on both sides, in standard errors by scatter, tried in turn: not below the accuracy of the completion. \[-\]
const ASIDE: [f64; 3] = [0.05, 0.01, 0.002];
/// Distance of a second pair over that of the first, to distinguish a jump from a kink: a jump does not shrink. \[-\]
const NEARER: f64 = 0.125;
/// Minimum share of the distance within the bounds. \[-\]
const CUT: f64 = 0.2;
/// Ratio of the increase to that of a smooth minimum above which there is a kink. \[-\]
const STEEP: f64 = 4.0;
/// Share of the largest deviation from a straight line above which a row is concerned. \[-\]
const CONCERNED: f64 = 0.25;
/// Remaining share of a deviation at the nearer pair above which it is a jump. \[-\]
const JUMP: f64 = 0.5;

/// The kinks at a minimum, with the derivatives there.
///
/// # Errors
/// If it is interrupted.
pub(super) fn kinks(context: &Context<'_>, point: &Point, jacobian: &DMatrix<f64>) -> Result<Vec<Kink>, Miss> {
    let Some(axes) = Axes::between_bounds(context, point, jacobian) else {
        return Ok(Vec::new());
    };
    let found: Vec<Option<Kink>> = (0..context.evaluator.space.len())
        .into_par_iter()
        .with_max_len(1)
        .map(|j| {
            for distance in ASIDE {
                if let Some(kink) = along(context, point, &axes, (j, distance))? {
                    return Ok(Some(kink));
                }
            }
            Ok(None)
        })
        .collect::<Result<_, _>>()?;
    Ok(found.into_iter().flatten().collect())
}

/// The kink along one parameter at a distance, if there is one.
fn along(context: &Context<'_>, point: &Point, axes: &Axes, (j, distance): (usize, f64)) -> Result<Option<Kink>, Miss> {
    let (space, evaluator) = (context.evaluator.space, context.evaluator);
    // One standard error of the parameter with all others following: its row of the root times the root.
    let mut step = DVector::zeros(space.len());
    let principal = &axes.steps[..axes.principal];
    for axis in principal {
        step += axis * axis[j];
    }
    let deviation = principal.iter().map(|axis| axis[j].powi(2)).sum::<f64>().sqrt();
    if deviation == 0.0 {
        return Ok(None);
    }
    step /= deviation;
    // The same distance on both sides, limited by the bounds.
    let room = [-distance, distance].map(|length| inside(space, &point.u, &step, length).abs());
    let aside = room[0].min(room[1]);
    if aside < CUT * distance {
        return Ok(None);
    }
    let sides = |distance: f64| [-distance, distance].map(|length| moved(space, &point.u, &(&step * length)));
    let wide = sides(aside);
    let mut values = Vec::with_capacity(2);
    for u in &wide {
        values.push(evaluator.try_residual(u)?);
    }
    let smooth = axes.variance * aside * aside;
    let steepness = |r: &Option<DVector<f64>>| {
        let rise = |r: &DVector<f64>| -2.0 * context.robust.fall(&point.r, r) / smooth;
        r.as_ref().map(rise)
    };
    let steepness = [steepness(&values[0]), steepness(&values[1])];
    if !steepness.iter().flatten().any(|rise| *rise > STEEP) {
        return Ok(None);
    }
    let [Some(below), Some(above)] = [&values[0], &values[1]] else {
        return Ok(None);
    };
    let bend = |below: &DVector<f64>, above: &DVector<f64>| below + above - &point.r * 2.0;
    let bent = bend(below, above);
    let greatest = bent.amax();
    if greatest == 0.0 {
        return Ok(None);
    }
    let rows: Vec<usize> = (0..evaluator.rows)
        .filter(|i| bent[*i].abs() >= CONCERNED * greatest)
        .collect();
    let near = sides(NEARER * aside);
    let nearer = [evaluator.try_residual(&near[0])?, evaluator.try_residual(&near[1])?];
    let jumps = match &nearer {
        [Some(below), Some(above)] => bend(below, above)[bent.iamax()].abs() >= JUMP * greatest,
        _ => false,
    };
    Ok(Some(Kink {
        parameter: space.free[j],
        rows,
        sides: wide.map(|u| space.theta(&u)),
        steepness,
        jumps,
    }))
}
