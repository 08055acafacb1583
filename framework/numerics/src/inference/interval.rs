//! Intervals of parameters and joint regions, from the linearised fit.
//!
//! Source: Seber, Wild: Nonlinear Regression (Wiley 1989), sections 5.1 to 5.3.

use super::probability::{chi_square_quantile, f_quantile, student_quantile};
use super::{Accuracy, Fit, Side, Standing};
use crate::sampling::{Sobol, inverse_normal};

/// An interval of one parameter, in its own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower and upper end, within the bounds.
    pub ends: [f64; 2],
    /// The ends without the bounds.
    pub uncut: [f64; 2],
}

impl Interval {
    /// Whether an end is cut at a bound; a profile interval is then better.
    pub fn is_cut(&self, side: Side) -> bool {
        self.ends[side.place()] != self.uncut[side.place()]
    }
}

impl Fit {
    /// Half-width of a two-sided interval over the standard deviation: normal quantile if the accuracies are given, Student's if they are
    /// estimated. Absent if the confidence is not between zero and one.
    pub fn quantile(&self, confidence: f64) -> Option<f64> {
        let probability = 0.5 + 0.5 * confidence;
        match self.accuracy() {
            _ if !(0.0..1.0).contains(&confidence) => None,
            Accuracy::Given => inverse_normal(probability),
            Accuracy::Estimated => student_quantile(probability, self.freedom()),
        }
    }

    /// Root of the increase of the objective at the ends of a profile interval.
    pub fn profile_limit(&self, confidence: f64) -> Option<f64> {
        Some(self.quantile(confidence)? * self.variance().sqrt())
    }

    /// Interval of a parameter, symmetric in its coordinate.
    ///
    /// The half-width is multiplied by `widening`: one, or the widening of a fit that does not reproduce its data. Absent if the parameter
    /// has no standard deviation.
    pub fn interval(&self, parameter: usize, confidence: f64, widening: f64) -> Option<Interval> {
        let half = self.quantile(confidence)? * self.deviation(parameter)? * widening;
        let parameter = &self.parameters()[parameter];
        let uncut = [parameter.u - half, parameter.u + half];
        let [low, high] = parameter.bounds;
        let ends = [uncut[0].max(low), uncut[1].min(high)];
        let theta = |list: [f64; 2]| list.map(|u| parameter.scale.theta(u));
        half.is_finite().then(|| Interval {
            ends: theta(ends),
            uncut: theta(uncut),
        })
    }

    /// Increase of the linearised objective from the optimum to other coordinates. Only free parameters are considered.
    pub fn rise(&self, u: &[f64]) -> f64 {
        let factors = &self.factors;
        let steps: Vec<f64> = (factors.columns.iter().zip(&factors.norms))
            .map(|(j, norm)| norm * (u[*j] - self.parameters()[*j].u))
            .collect();
        let along = |k: usize| -> f64 {
            let parts = steps.iter().enumerate().map(|(i, s)| s * factors.directions[(i, k)]);
            factors.singular[k] * parts.sum::<f64>()
        };
        (0..factors.singular.len()).map(|k| along(k).powi(2)).sum()
    }

    /// Increase of the objective at the border of the joint confidence region of all free parameters. The exact region has the same
    /// increase of the exact objective.
    pub fn joint_limit(&self, confidence: f64) -> Option<f64> {
        let count = self.factors.resolved as f64;
        match self.accuracy() {
            Accuracy::Given => chi_square_quantile(confidence, count),
            Accuracy::Estimated => Some(count * self.variance() * f_quantile(confidence, [count, self.freedom()])?),
        }
    }

    /// Coordinates distributed over the joint confidence region of all free parameters: normal by the covariance, scaled back into the
    /// region, cut at the bounds. They are generated from Sobol points and are reproducible.
    ///
    /// # Errors
    /// If there are more free parameters than Sobol points have dimensions, or the confidence is not between zero and one.
    pub fn draws(&self, count: u32, confidence: f64) -> Result<Vec<Vec<f64>>, String> {
        let resolved = self.factors.resolved;
        let at: Vec<f64> = self.parameters().iter().map(|p| p.u).collect();
        if resolved == 0 {
            return Ok(vec![at; count as usize]);
        }
        let limit = self
            .joint_limit(confidence)
            .ok_or_else(|| format!("{confidence} is not a confidence between zero and one"))?;
        let sobol = Sobol::new(resolved)?;
        let draw = |index: u32| {
            let shares = sobol.point(index);
            // Coordinates of Sobol points are inside the open interval, where every quantile exists.
            let normal: Vec<f64> = shares.iter().filter_map(|p| inverse_normal(*p)).collect();
            let square: f64 = self.variance() * normal.iter().map(|z| z * z).sum::<f64>();
            let size = self.variance().sqrt() * (limit / square.max(limit)).sqrt();
            let coordinate = |j: usize| {
                let step: f64 = normal.iter().enumerate().map(|(k, z)| z * self.root_entry(j, k)).sum();
                let parameter = &self.parameters()[j];
                match parameter.standing {
                    Standing::Free => (at[j] + size * step).clamp(parameter.bounds[0], parameter.bounds[1]),
                    Standing::Active(_) | Standing::Fixed => at[j],
                }
            };
            (0..at.len()).map(coordinate).collect()
        };
        // Index zero is a corner and index one the middle: all deviations equal, or none.
        Ok((2..count.saturating_add(2)).map(draw).collect())
    }
}
