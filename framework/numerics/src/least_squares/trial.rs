//! A trial step: new radius and tests of convergence.

use nalgebra::DVector;

use super::evaluate::{Evaluator, Miss};
use super::fit::Reason;
use super::linearised::Linearised;
use super::noise::CostNoise;
use super::options::Tolerances;

/// Minimum share of the expected decrease of an accepted step.
const ACCEPT: f64 = 1e-4;
/// Expected relative decrease below which noise may hide it.
const FAINT: f64 = 1e-8;
/// Step over its tolerance below which noise may hide a decrease, and a constant cost ends a run.
const NEAR: f64 = 1e3;

/// A trial step.
pub(super) struct Trial {
    /// Expected decrease of the cost.
    pub predicted: f64,
    /// Negative slope of the model along the step.
    pub slope: f64,
    /// Decrease of the cost; minus infinity if the residuals have no value.
    pub actual: f64,
    /// Ratio of actual to expected decrease; 1 for a trusted step.
    pub ratio: f64,
    /// Length in the metric of the ball.
    pub length: f64,
    /// Maximum relative change of a coordinate.
    pub change: f64,
    /// Whether it is the Gauss-Newton step.
    pub shortcut: bool,
}

/// A run's point, for tests that need calls at it.
#[derive(Clone, Copy)]
pub(super) struct Here<'a> {
    pub evaluator: &'a Evaluator<'a>,
    pub local: &'a Linearised<'a>,
    pub u: &'a [f64],
    pub r: &'a DVector<f64>,
    pub tolerances: Tolerances,
}

impl Trial {
    /// Whether it is accepted.
    pub fn accepted(&self) -> bool {
        self.ratio > ACCEPT
    }

    /// Whether it is a Gauss-Newton step that fails only because of noise.
    pub fn drowns(&self, here: Here<'_>, noise: &mut CostNoise) -> Result<bool, Miss> {
        let cost = here.local.cost;
        let faint = self.predicted <= FAINT * cost || self.change <= NEAR * here.tolerances.step;
        if self.accepted() || !self.shortcut || !faint {
            return Ok(false);
        }
        let below = |share: f64| self.predicted <= share * cost && self.actual >= -share * cost;
        if !below(noise.share) {
            noise.sound(here.evaluator, here.u, here.r)?;
        }
        Ok(below(noise.share))
    }

    /// The radius after it.
    pub fn radius(&self, radius: f64) -> f64 {
        match self.ratio {
            // If the cost has increased, to the minimum of the parabola through both ends with the slope at the first.
            ratio if ratio < 0.25 && self.actual.is_finite() && self.actual < 0.0 => {
                let cut = self.slope / (2.0 * (self.slope - self.actual));
                cut.clamp(0.1, 0.5) * self.length.min(radius)
            }
            ratio if ratio < 0.25 => 0.25 * self.length.min(radius),
            ratio if ratio > 0.75 && self.shortcut => radius.max(2.0 * self.length),
            ratio if ratio > 0.75 && self.length >= 0.99 * radius => 2.0 * radius,
            _ => radius,
        }
    }

    /// Whether the run ends, given the radius after the step and the maximum change.
    pub fn stop(&self, here: Here<'_>, noise: &mut CostNoise, radius: f64, bound: f64) -> Result<Option<Reason>, Miss> {
        let (tolerances, cost, accepted) = (here.tolerances, here.local.cost, self.accepted());
        // A small rejected step does not indicate a minimum, unless its expected decrease is below the noise.
        let small = self.change <= tolerances.step && (accepted || self.predicted <= noise.share * cost);
        let level = tolerances.cost * cost;
        let flat = self.actual.abs() <= level && self.predicted <= level && self.ratio <= 2.0;
        let near = self.change <= NEAR * tolerances.step || self.predicted <= 0.01 * f64::EPSILON * cost || !accepted;
        if (small || (flat && near)) && self.settled(here, noise, bound)? {
            return Ok(Some(if small { Reason::Step } else { Reason::Cost }));
        }
        let least = 1e-15 * here.local.length(|j| here.evaluator.space.size(j, here.u[j]));
        Ok((!accepted && radius <= least).then_some(Reason::Radius))
    }

    /// Whether the model predicts no further decrease without the ball: a small ball, for example near a point without residuals, does not
    /// indicate a minimum.
    fn settled(&self, here: Here<'_>, noise: &mut CostNoise, bound: f64) -> Result<bool, Miss> {
        let (promise, cost) = (here.local.promise(bound), here.local.cost);
        if self.shortcut || promise <= FAINT.max(here.tolerances.cost) * cost {
            return Ok(true);
        }
        noise.sound(here.evaluator, here.u, here.r)?;
        Ok(promise <= noise.share * cost)
    }
}
