//! The fit of an identification, and what is asked of it afterwards: statistics, profiles, folds.

use rayon::prelude::*;

use super::{Identification, ModelKink};
use crate::study::Quantity;
use gearloss_numerics::inference::{self, Fold, ProfileFault, ProfileInterval, Refit, RobustRows, Validation};
use gearloss_numerics::least_squares::{
    Differences, Fault, Loss, Minima, Minimum, Noise, Options, Problem, Scale, Status, UNTOLD, multistart, solve,
};

/// Confidence of intervals by profile.
const CONFIDENCE: f64 = 0.95;
/// Distance from its limit at which an end of such an interval is found: a thousandth of its half-width.
const FOUND: f64 = 1e-3;
/// Rounds in which factors of accuracies settle at most, and the relative change at which they have.
const ROUNDS: usize = 10;
const SETTLED: f64 = 0.01;

/// Remaining shift in standard errors at which a search ends.
const REMAINING: f64 = 1e-3;
/// Relative noise of the residuals: the remaining change of the iterated flow of power.
const NOISE: f64 = 1e-9;
/// The same for a search: jumps of published laws make the misfit uneven. A search ends where derivatives promise a fall that is a
/// thousand times this share of the misfit or less, in the worst case a fifth of a standard error along one combination.
const UNEVEN: f64 = 1e-7;
/// Jumps of single residuals over all: published laws change at a regime without meeting, by a percent of one component's loss. Steps
/// of differences are a hundredth of usual sizes, so that a jump inside of one is no slope. The needle cages of the two-speed example
/// jump by 2e-5 of its residuals where Palmgren's product of viscosity and speed passes 2000.
pub(super) const JUMPS: f64 = 1e-5;
/// Relative step at which a search ends: beside a jump no direction lowers the misfit, and what derivatives promise is never met. Such a search
/// is finished without derivatives.
const SMALLEST: f64 = 1e-5;

/// A hook that says whether to stop.
type Interrupt<'s> = Option<&'s (dyn Fn() -> bool + Sync)>;

/// How an identification is solved.
#[derive(Clone, Copy)]
pub struct Settings<'s> {
    /// What a residual costs.
    pub loss: Loss,
    /// Residual from which on a point counts as far. \[-\]
    pub loss_scale: f64,
    /// Number of starts.
    pub starts: usize,
    /// Whether the accuracies of quantities are given up to a factor each.
    pub accuracy_factors: bool,
    /// Asked again and again: whether to stop.
    pub interrupt: Interrupt<'s>,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            loss: Loss::Linear,
            loss_scale: 2.0,
            starts: 1,
            accuracy_factors: false,
            interrupt: None,
        }
    }
}

/// A fitted identification.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// All minima that were found; the first is the fit.
    pub minima: Minima,
    /// Factors by which the accuracies of the quantities were found to be wrong; empty where that was not asked.
    pub factors: Vec<(Quantity, f64)>,
    /// What it says of the parameters.
    pub inference: inference::Fit,
    /// Models whose kinks hold the minimum; none at a smooth one.
    pub kinks: Vec<ModelKink>,
}

impl Fitted {
    /// The fit.
    pub fn fit(&self) -> &gearloss_numerics::least_squares::Fit {
        &self.minima.minima[0].fit
    }

    /// Whether a kink lies across a parameter, so that its linearised interval is a guess.
    pub fn is_kinked(&self, parameter: usize) -> bool {
        self.fit().kinks.iter().any(|kink| kink.parameter == parameter)
    }

    /// Distance of a parameter at another minimum, in its standard errors at the fit; absent where it has none.
    pub fn distance(&self, minimum: &Minimum, parameter: usize) -> Option<f64> {
        let deviation = self.inference.deviation(parameter).filter(|d| *d > 0.0)?;
        Some((minimum.fit.u[parameter] - self.fit().u[parameter]) / deviation)
    }

    /// Values of the parameters, each in the unit of its path.
    pub fn theta(&self) -> &[f64] {
        &self.fit().theta
    }
}

/// An interval by profile, or why there is none.
pub type Profiled = Result<ProfileInterval, String>;

impl<'s> Settings<'s> {
    /// With what the search is called, for those who call it themselves: on [`Identification::problem`], say, with every call
    /// noted down.
    pub fn options(&self, accuracy: inference::Accuracy) -> Options<'s> {
        let mut options = Options {
            loss: self.loss,
            loss_scale: self.loss_scale,
            estimate_spread: accuracy == inference::Accuracy::Estimated,
            // Central differences are taken once, at the end, for the intervals.
            differences: Differences::Forward,
            noise: Noise::Known(UNEVEN),
            jumps: JUMPS,
            polish: true,
            // Other starts take the place of other steps.
            attempts: false,
            interrupt: self.interrupt,
            ..Options::fit()
        };
        options.forward.relative_offset = REMAINING;
        options.forward.step = SMALLEST;
        options.forward.cost = SMALLEST * SMALLEST;
        // A tenth of a step tells no curvature where laws have kinks.
        options.steps.second_order = false;
        options
    }
}

impl Identification<'_> {
    /// Finds the parameters.
    ///
    /// # Errors
    /// If the problem makes no sense, or the end of the search says nothing of the parameters.
    pub fn fit(&mut self, settings: &Settings<'_>) -> Result<Fitted, Fault> {
        let options = settings.options(self.accuracy);
        let mut minima = multistart(&self.problem(), &options, settings.starts.max(1))?;
        for minimum in &mut minima.minima {
            self.keep_unseen(&mut minimum.fit);
        }
        let mut fitted = self.fitted(minima, &options)?;
        if settings.accuracy_factors && self.accuracy == inference::Accuracy::Given {
            self.settle(&mut fitted, &options)?;
        }
        Ok(fitted)
    }

    /// What no residual depends on stays where the search of the user began, whichever start led to the minimum.
    fn keep_unseen(&self, fit: &mut gearloss_numerics::least_squares::Fit) {
        let Some(derivative) = &fit.derivative else { return };
        let start = self.start();
        for (k, parameter) in self.parameters.iter().enumerate() {
            if derivative.unseen[k] && !fit.fixed[k] {
                fit.theta[k] = start[k];
                fit.u[k] = match parameter.fitted().scale {
                    Scale::Linear => start[k],
                    Scale::Log => start[k].ln(),
                };
            }
        }
    }

    /// Finds factors of the accuracies: the scatter of each quantity, less what its points have lost to the parameters.
    fn settle(&mut self, fitted: &mut Fitted, options: &Options<'_>) -> Result<(), Fault> {
        let mut quantities: Vec<Quantity> = Vec::new();
        for observation in &self.observations {
            if !quantities.contains(&observation.quantity) {
                quantities.push(observation.quantity);
            }
        }
        let mut factors: Vec<(Quantity, f64)> = quantities.into_iter().map(|q| (q, 1.0)).collect();
        for _ in 0..ROUNDS {
            let mut settled = true;
            for (quantity, factor) in &mut factors {
                let own = |(i, o): (usize, &super::Observation)| (o.quantity == *quantity).then_some(i);
                let places: Vec<usize> = self.observations.iter().enumerate().filter_map(own).collect();
                let squares: f64 = places.iter().map(|i| fitted.inference.residuals()[*i].powi(2)).sum();
                let lost: f64 = places.iter().map(|i| fitted.inference.leverage()[*i]).sum();
                let step = (squares / (places.len() as f64 - lost)).sqrt();
                if !(step.is_finite() && step > 0.0) {
                    continue;
                }
                settled &= (step - 1.0).abs() < SETTLED;
                *factor *= step;
                for i in places {
                    self.observations[i].deviation *= step;
                }
            }
            let problem = self.problem_from(fitted.theta(), None);
            let mut again = multistart(&problem, options, 1)?;
            let mut fit = again.minima.swap_remove(0).fit;
            self.keep_unseen(&mut fit);
            // Other starts and minima are those of the first round.
            let mut minima = fitted.minima.clone();
            minima.minima[0].fit = fit;
            minima.evaluations += again.evaluations;
            *fitted = self.fitted(minima, options)?;
            if settled {
                break;
            }
        }
        fitted.factors = factors;
        Ok(())
    }

    /// The problem with the search beginning elsewhere; with one parameter held where it begins.
    fn problem_from(&self, theta: &[f64], held: Option<usize>) -> Problem<'_> {
        let parameters = self
            .parameters
            .iter()
            .zip(theta)
            .enumerate()
            .map(|(k, (parameter, value))| {
                let mut parameter = parameter.fitted();
                parameter.start = *value;
                if held == Some(k) {
                    parameter = parameter.within(*value, *value);
                }
                parameter
            });
        Problem::new(|theta: &[f64]| self.residuals(theta), parameters.collect())
    }

    /// What a fit says of the parameters.
    fn fitted(&self, minima: Minima, options: &Options<'_>) -> Result<Fitted, Fault> {
        let fit = &minima.minima[0].fit;
        let none = |message: String| Fault::single("the end of the search", message, "begin with other values");
        let Some(derivative) = &fit.derivative else {
            let reason = fit.reason.name();
            return Err(none(format!("it ended ({reason}) where residuals have no derivatives")));
        };
        let mut parameters = Vec::new();
        for (k, (parameter, theta)) in self.parameters.iter().zip(&fit.theta).enumerate() {
            let [low, high] = parameter.bounds;
            let mut stated = parameter.stated(theta.clamp(low, high)).map_err(none)?;
            // The solver knows which bounds hold.
            stated.standing = match fit.active[k] {
                _ if fit.fixed[k] => inference::Standing::Fixed,
                None => inference::Standing::Free,
                Some(gearloss_numerics::least_squares::Side::Lower) => {
                    inference::Standing::Active(inference::Side::Lower)
                }
                Some(gearloss_numerics::least_squares::Side::Upper) => {
                    inference::Standing::Active(inference::Side::Upper)
                }
            };
            parameters.push(stated);
        }
        let priors = fit.residuals.len() - fit.rows;
        let inference = if options.loss == Loss::Linear {
            inference::Fit::new(parameters, &derivative.jacobian, &fit.residuals, priors, self.accuracy)
        } else {
            let rows = RobustRows::new(options.loss, fit.loss_scale, &fit.residuals[..fit.rows]);
            let residuals = &fit.residuals;
            inference::Fit::robust(
                parameters,
                &derivative.jacobian,
                residuals,
                priors,
                (self.accuracy, &rows),
            )
        };
        Ok(Fitted {
            inference: inference.map_err(none)?,
            factors: Vec::new(),
            kinks: self.model_kinks(fit).map_err(none)?,
            minima,
        })
    }

    /// Intervals of all parameters by profile; absent for those that are held or not seen. All others follow in each fit.
    pub fn profiles(&self, fitted: &Fitted, interrupt: Interrupt<'_>) -> Vec<Option<Profiled>> {
        let of = |k: usize| {
            let mut profile = fitted.inference.to_profile(k, CONFIDENCE)?;
            profile.found = FOUND;
            let refit = |k: usize, v: f64, from: &[f64]| self.refit(fitted, (k, v), from, interrupt);
            let found = fitted.inference.profiled(&profile, CONFIDENCE, refit);
            Some(found.map_err(|fault| match fault {
                ProfileFault::BetterOptimum(found) => {
                    format!("a better fit was found on the way, of objective {:.6}", found.objective)
                }
                ProfileFault::Failed(reason) | ProfileFault::Meaningless(reason) => reason,
            }))
        };
        (0..self.parameters.len())
            .into_par_iter()
            .with_max_len(1)
            .map(of)
            .collect()
    }

    /// The best that is left when one parameter is held at a coordinate, from coordinates of all.
    pub(super) fn refit(
        &self,
        fitted: &Fitted,
        (k, v): (usize, f64),
        from: &[f64],
        interrupt: Interrupt<'_>,
    ) -> Result<Refit, String> {
        // The others begin where the linearised fit takes them.
        let follow = |j: usize| {
            let slope = fitted.inference.covariance(j, k) / fitted.inference.covariance(k, k);
            if slope.is_finite() { slope * (v - from[k]) } else { 0.0 }
        };
        let theta: Vec<f64> = self
            .parameters
            .iter()
            .zip(from)
            .enumerate()
            .map(|(i, (parameter, u))| {
                let u = if i == k { v } else { u + follow(i) };
                let value = match parameter.fitted().scale {
                    Scale::Linear => u,
                    Scale::Log => u.exp(),
                };
                value.clamp(parameter.bounds[0], parameter.bounds[1])
            })
            .collect();
        let options = Options {
            // It begins near its end, and a hundredth of a standard error raises the misfit by no more than a thousandth.
            differences: Differences::Forward,
            noise: Noise::Known(NOISE),
            jumps: JUMPS,
            // Where kinks hold the minimum they hold the ends of these searches, too.
            polish: !fitted.kinks.is_empty(),
            attempts: false,
            interrupt,
            ..Options::fit()
        };
        let fit = solve(&self.problem_from(&theta, Some(k)), &options).map_err(|fault| fault.to_string())?;
        if fit.status == Status::Interrupted {
            return Err("broken off".to_owned());
        }
        // The row of its prior falls away with a parameter that is held, but it still counts.
        let own = self.parameters[k].prior.map_or(0.0, |prior| {
            let row = match self.parameters[k].fitted().scale {
                Scale::Linear => (v - prior.mean) / prior.deviation,
                Scale::Log => (v - prior.mean.ln()) / prior.deviation,
            };
            row * row
        });
        let mut u = fit.u;
        u[k] = v;
        let mut objective = 2.0 * fit.cost + own;
        // Beside a kink the minimum is one of many that the data cannot tell apart: a hair below it is no better optimum.
        let least = fitted.inference.objective();
        if !fitted.kinks.is_empty() && least - objective <= UNTOLD * fitted.fit().scatter() {
            objective = objective.max(least);
        }
        Ok(Refit { objective, u })
    }

    /// Errors of each fold, predicted with the parameters that the others give. The folds are those of
    /// [`Identification::groups`].
    ///
    /// # Errors
    /// If a fit fails.
    pub fn validate(&self, fitted: &Fitted, folds: &[Fold], settings: &Settings<'_>) -> Result<Validation, String> {
        let count = self.observations.len();
        let leave_out = |fold: &Fold| -> Result<Vec<(usize, f64)>, String> {
            let others: Vec<usize> = (0..count).filter(|i| !fold.points.contains(i)).collect();
            let problem = self.problem_from(fitted.theta(), None);
            let partial = |theta: &[f64]| {
                let all = problem.residual(theta)?;
                Ok(others.iter().map(|i| all[*i]).collect())
            };
            let partial = Problem::new(partial, problem.parameters().to_vec());
            let options = settings.options(self.accuracy);
            let fit = solve(&partial, &options).map_err(|fault| fault.to_string())?;
            if fit.status == Status::Interrupted {
                return Err("broken off".to_owned());
            }
            let all = self.residuals(&fit.theta)?;
            Ok(fold.points.iter().map(|i| (*i, all[*i])).collect())
        };
        let found: Vec<Vec<(usize, f64)>> = folds
            .par_iter()
            .with_max_len(1)
            .map(leave_out)
            .collect::<Result<_, _>>()?;
        let mut errors = vec![0.0; count];
        for (i, error) in found.into_iter().flatten() {
            errors[i] = error;
        }
        Validation::new(folds, &errors).ok_or_else(|| "a fold has no points".to_owned())
    }
}
