//! The posterior of the parameters.
//!
//! The prior is uniform over the range (for a logarithmic parameter in the logarithm), in addition to `prior`.

use super::{Fitted, Identification, Identified};
use crate::study::ScaleEntry;
use gearloss_numerics::inference::{Accuracy, Draws, Ensemble, Marginal};

/// Default number of walkers for each parameter, and minimum number.
const WALKERS: [usize; 2] = [4, 16];
/// Standard errors about the fit in which the walkers start.
const BEGIN: f64 = 0.1;

/// Draws from a posterior.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// One for each parameter, in the unit of its path; absent for fixed parameters.
    pub marginals: Vec<Option<Marginal>>,
    /// The draws of the free parameters.
    pub draws: Draws,
    /// Whether the sampling has converged.
    pub is_settled: bool,
}

impl Identified {
    /// Scale.
    fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            ScaleEntry::Linear => value,
            ScaleEntry::Log => value.ln(),
        }
    }

    /// Its value at a coordinate, within the bounds.
    fn value_at(&self, coordinate: f64) -> f64 {
        let value = match self.scale {
            ScaleEntry::Linear => coordinate,
            ScaleEntry::Log => coordinate.exp(),
        };
        value.clamp(self.bounds[0], self.bounds[1])
    }

    /// Minimum and maximum coordinate.
    fn ends(&self) -> [f64; 2] {
        self.bounds.map(|bound| self.coordinate(bound))
    }
}

impl Identification<'_> {
    /// Default number of walkers.
    pub fn walkers(&self) -> usize {
        WALKERS[1].max(WALKERS[0] * self.parameters.len())
    }

    /// Draws from the posterior, starting near a fit.
    ///
    /// # Errors
    /// If no parameter is free, or after an interruption.
    pub fn posterior(
        &self,
        fitted: &Fitted,
        ensemble: &Ensemble,
        interrupt: Option<&(dyn Fn() -> bool + Sync)>,
    ) -> Result<Posterior, String> {
        let is_free = |k: &usize| self.parameters[*k].bounds[0] < self.parameters[*k].bounds[1];
        let free: Vec<usize> = (0..self.parameters.len()).filter(is_free).collect();
        if free.is_empty() {
            return Err("no parameter is free".to_owned());
        }
        let begin: Vec<[f64; 2]> = free.iter().map(|k| self.beginning(fitted, *k)).collect();
        let density = |u: &[f64]| self.log_density(fitted.theta(), &free, u);
        let draws = ensemble.draws(density, &begin, interrupt).ok_or("interrupted")?;
        let mut marginals = vec![None; self.parameters.len()];
        for (place, k) in free.iter().enumerate() {
            marginals[*k] = Some(draws.marginal(place, |u| self.parameters[*k].value_at(u)));
        }
        Ok(Posterior {
            is_settled: draws.is_settled(marginals.iter().copied().flatten()),
            marginals,
            draws,
        })
    }

    /// Start range of the walkers: near the fit, within the bounds.
    fn beginning(&self, fitted: &Fitted, k: usize) -> [f64; 2] {
        let parameter = &self.parameters[k];
        let [low, high] = parameter.ends();
        let fit = parameter.coordinate(fitted.theta()[k]).clamp(low, high);
        // Parameters that are not identifiable start anywhere.
        let reach = fitted.inference.deviation(k).map_or(high - low, |d| BEGIN * d);
        [(fit - reach).max(low), (fit + reach).min(high)]
    }

    /// Logarithm of the posterior density at coordinates of the free parameters; the others are constant.
    fn log_density(&self, held: &[f64], free: &[usize], u: &[f64]) -> f64 {
        let mut theta = held.to_vec();
        let mut priors = 0.0;
        for (k, u) in free.iter().zip(u) {
            let parameter = &self.parameters[*k];
            let [low, high] = parameter.ends();
            if !(low..=high).contains(u) {
                return f64::NEG_INFINITY;
            }
            theta[*k] = parameter.value_at(*u);
            if let Some(prior) = parameter.prior {
                priors += ((u - parameter.coordinate(prior.mean)) / prior.deviation).powi(2);
            }
        }
        let Ok(residuals) = self.residuals(&theta) else {
            return f64::NEG_INFINITY;
        };
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        // The prior of an unknown accuracy is uniform in the logarithm.
        let misfit = match self.accuracy() {
            Accuracy::Given => squares,
            Accuracy::Estimated => residuals.len() as f64 * squares.ln(),
        };
        -0.5 * (misfit + priors)
    }
}
