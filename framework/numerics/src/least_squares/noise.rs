//! Noise of residuals and of their cost.

use nalgebra::DVector;

use super::evaluate::{Evaluator, Miss};

/// Distance of the values for noise estimation, in typical sizes.
const SPACING: f64 = 1e-6;
/// Factor on a stated noise of a call below which changes of the cost are insignificant.
const TOLD: f64 = 1e3;
/// The same for a noise estimated at the point: 2 for the square, 10 for safety.
const FOUND: f64 = 20.0;

/// Relative noise of the cost in a run.
pub(super) struct CostNoise {
    /// The noise over the cost.
    pub share: f64,
    sounded: bool,
}

impl CostNoise {
    /// From the stated noise of a call relative to the residuals.
    pub fn stated(noise: f64) -> Self {
        Self {
            share: TOLD * noise,
            sounded: false,
        }
    }

    /// Estimates it at a point by six calls, once in a run. A stated noise is relative to the residuals, but rounding is relative to the
    /// values whose differences they are.
    pub fn sound(&mut self, evaluator: &Evaluator<'_>, u: &[f64], r: &DVector<f64>) -> Result<(), Miss> {
        if !std::mem::replace(&mut self.sounded, true) {
            match estimate(evaluator, u, r) {
                Ok(noise) => self.share = self.share.max(FOUND * noise),
                Err(Miss::Undefined(_)) => {}
                Err(Miss::Interrupted) => return Err(Miss::Interrupted),
            }
        }
        Ok(())
    }
}

/// Relative noise of one call, from third differences of seven calls along one direction; not below rounding.
///
/// Hamming, "Numerical Methods for Scientists and Engineers" (1962), on tables of differences.
pub(super) fn estimate(evaluator: &Evaluator<'_>, u: &[f64], r: &DVector<f64>) -> Result<f64, Miss> {
    let space = evaluator.space;
    let away: Vec<f64> = (0..u.len())
        .map(|j| {
            let (down, up, step) = (u[j] - space.lower[j], space.upper[j] - u[j], SPACING * space.typical[j]);
            if up >= down {
                step.min(up / 6.0)
            } else {
                -step.min(down / 6.0)
            }
        })
        .collect();
    let mut values = vec![r.clone()];
    for k in 1..7 {
        let there: Vec<f64> = u.iter().zip(&away).map(|(u, step)| u + f64::from(k) * step).collect();
        values.push(evaluator.residual(&there)?);
    }
    let third = |w: &[DVector<f64>]| (&w[3] - &w[0] + (&w[1] - &w[2]) * 3.0).norm_squared();
    let squares: f64 = values.windows(4).map(third).sum();
    // Weights 1, 3, 3, 1: the mean square of a third difference is 20 times that of the noise.
    let noise = (squares / (4.0 * 20.0)).sqrt() / r.norm();
    Ok(if noise.is_finite() {
        noise.max(f64::EPSILON)
    } else {
        f64::EPSILON
    })
}
