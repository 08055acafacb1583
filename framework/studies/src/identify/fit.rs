//! The fit of an identification, with statistics, profiles and cross-validation.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::{Identification, ModelKink};
use crate::distinct::distinct;
use crate::study::Quantity;
use gearloss_numerics::inference::{self, Fold, ProfileFault, ProfileInterval, Refit, RobustRows, Validation};
use gearloss_numerics::least_squares::{
    Differences, Fault, Known, Loss, Minima, Minimum, Noise, Options, Problem, Scale, Searches, Status, UNTOLD,
    multistart, solve,
};

/// Confidence of profile intervals.
const CONFIDENCE: f64 = 0.95;
/// Tolerance of the ends of such an interval: a thousandth of its half-width.
const FOUND: f64 = 1e-3;
/// Maximum number of rounds for factors of accuracies, and their relative tolerance.
const ROUNDS: usize = 10;
const SETTLED: f64 = 0.01;

/// Remaining shift in standard errors at which a search ends.
const REMAINING: f64 = 1e-3;
/// Relative noise of the residuals: the error to which the flow of power is iterated.
const NOISE: f64 = 1e-9;
/// The same for a search: discontinuities of published laws make the misfit uneven. A search ends if derivatives predict a decrease of at
/// most a thousand times this share of the misfit, in the worst case a fifth of a standard error along one combination.
const UNEVEN: f64 = 1e-7;
/// Relative discontinuities of single residuals: published laws are discontinuous at a change of regime by a percent of one component's
/// loss. Steps of differences are a hundredth of typical sizes, so that a jump within a step is not a slope. The needle cages of the
/// two-speed example jump by 2e-5 of its residuals if Palmgren's product of viscosity and speed passes 2000.
pub(super) const JUMPS: f64 = 1e-5;
/// Relative step at which a search ends: near a jump no direction reduces the misfit as derivatives predict. Such a search is completed
/// without derivatives.
const SMALLEST: f64 = 1e-5;

/// A function that returns whether to stop.
type Interrupt<'s> = Option<&'s (dyn Fn() -> bool + Sync)>;

/// Settings of an identification.
#[derive(Clone, Copy)]
pub struct Settings<'s> {
    /// Loss function.
    pub loss: Loss,
    /// Scale of the loss. \[-\]
    pub loss_scale: f64,
    /// Number of starts.
    pub starts: usize,
    /// Whether each accuracy has an unknown factor.
    pub accuracy_factors: bool,
    /// Called repeatedly: whether to stop.
    pub interrupt: Interrupt<'s>,
    /// Who runs the searches of several starts; absent, the threads of this process.
    pub searches: Option<&'s Searches<'s>>,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            loss: Loss::Linear,
            loss_scale: 2.0,
            starts: 1,
            accuracy_factors: false,
            interrupt: None,
            searches: None,
        }
    }
}

/// A fitted identification.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// All minima that were found; the first is the fit.
    pub minima: Minima,
    /// Estimated factors on the accuracies of the quantities; empty if not requested.
    pub factors: Vec<(Quantity, f64)>,
    /// Inference on the parameters.
    pub inference: inference::Fit,
    /// Models with kinks at the minimum; empty if it is smooth.
    pub kinks: Vec<ModelKink>,
}

impl Fitted {
    /// The fit.
    pub fn fit(&self) -> &gearloss_numerics::least_squares::Fit {
        &self.minima.minima[0].fit
    }

    /// Whether there is a kink along a parameter, so that its linearised interval is only approximate.
    pub fn is_kinked(&self, parameter: usize) -> bool {
        self.fit().kinks.iter().any(|kink| kink.parameter == parameter)
    }

    /// Distance of a parameter at another minimum, in its standard errors at the fit; absent if it has none.
    pub fn distance(&self, minimum: &Minimum, parameter: usize) -> Option<f64> {
        let deviation = self.inference.deviation(parameter).filter(|d| *d > 0.0)?;
        Some((minimum.fit.u[parameter] - self.fit().u[parameter]) / deviation)
    }

    /// Derivatives of the residuals of data by the coordinates.
    fn derivatives(&self) -> Option<DMatrix<f64>> {
        of_data(self.fit())
    }

    /// Values of the parameters, each in the unit of its path.
    pub fn theta(&self) -> &[f64] {
        &self.fit().theta
    }
}

/// Derivatives at the end of a fit, without the rows of priors.
fn of_data(fit: &gearloss_numerics::least_squares::Fit) -> Option<DMatrix<f64>> {
    let derivative = fit.derivative.as_ref()?;
    Some(derivative.jacobian.rows(0, fit.rows).into_owned())
}

/// A profile interval, or why there is none.
pub type Profiled = Result<ProfileInterval, String>;

impl<'s> Settings<'s> {
    /// Options of the search, for direct calls with [`Identification::problem`].
    pub fn options(&self, accuracy: inference::Accuracy) -> Options<'s> {
        let mut options = Options {
            loss: self.loss,
            loss_scale: self.loss_scale,
            estimate_spread: accuracy == inference::Accuracy::Estimated,
            // Central differences are used once, at the end, for the intervals.
            differences: Differences::Forward,
            noise: Noise::Known(UNEVEN),
            jumps: JUMPS,
            polish: true,
            // Other starts replace attempts with other steps.
            attempts: false,
            interrupt: self.interrupt,
            searches: self.searches,
            ..Options::fit()
        };
        options.forward.relative_offset = REMAINING;
        options.forward.step = SMALLEST;
        options.forward.cost = SMALLEST * SMALLEST;
        // With kinks a tenth of a step gives no valid curvature.
        options.steps.second_order = false;
        options
    }
}

impl Identification<'_> {
    /// Finds the parameters.
    ///
    /// # Errors
    /// If the problem is invalid, or inference at the end of the search is impossible.
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

    /// Parameters without effect keep the user's start value, whichever start led to the minimum.
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

    /// Estimates factors of the accuracies from the scatter of each quantity, corrected for fitted parameters.
    fn settle(&mut self, fitted: &mut Fitted, options: &Options<'_>) -> Result<(), Fault> {
        let quantities = distinct(self.observations.iter().map(|observation| observation.quantity));
        let mut factors: Vec<(Quantity, f64)> = quantities.into_iter().map(|q| (q, 1.0)).collect();
        for _ in 0..ROUNDS {
            let mut settled = true;
            for (quantity, factor) in &mut factors {
                let of_quantity = |(i, o): (usize, &super::Observation)| (o.quantity == *quantity).then_some(i);
                let places: Vec<usize> = self.observations.iter().enumerate().filter_map(of_quantity).collect();
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
            // Other starts and minima are from the first round.
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

    /// The problem with another start, and with one parameter fixed at its start.
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

    /// Inference on the parameters of a fit.
    fn fitted(&self, minima: Minima, options: &Options<'_>) -> Result<Fitted, Fault> {
        let fit = &minima.minima[0].fit;
        let none = |message: String| Fault::single("the end of the search", message, "use other start values");
        let Some(derivative) = &fit.derivative else {
            let reason = fit.reason.name();
            return Err(none(format!(
                "it ended ({reason}) at a point without derivatives of the residuals"
            )));
        };
        let mut parameters = Vec::new();
        for (k, (parameter, theta)) in self.parameters.iter().zip(&fit.theta).enumerate() {
            let [low, high] = parameter.bounds;
            let mut stated = parameter.stated(theta.clamp(low, high)).map_err(none)?;
            // The solver reports the active bounds.
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

    /// Profile intervals of all parameters; absent for those that are fixed or without effect. All others follow in each fit.
    pub fn profiles(&self, fitted: &Fitted, interrupt: Interrupt<'_>) -> Vec<Option<Profiled>> {
        let of = |k: usize| {
            let mut profile = fitted.inference.to_profile(k, CONFIDENCE)?;
            profile.found = FOUND;
            // The first fit on a side starts with the derivatives at the optimum, the others with those of the fit before them.
            let mut known: [Option<DMatrix<f64>>; 2] = [None, None];
            let refit = |k: usize, v: f64, from: &[f64]| {
                let side = usize::from(v > fitted.fit().u[k]);
                self.refit(fitted, (k, v), from, &mut known[side], interrupt)
            };
            let found = fitted.inference.profiled(&profile, CONFIDENCE, refit);
            Some(found.map_err(|fault| match fault {
                ProfileFault::BetterOptimum(found) => {
                    format!(
                        "a better fit was found on the way, with objective {:.6}",
                        found.objective
                    )
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

    /// The optimum of the others with one parameter fixed at a coordinate, starting from coordinates of all, and from known derivatives
    /// near them; gives those at its end.
    pub(super) fn refit(
        &self,
        fitted: &Fitted,
        (k, v): (usize, f64),
        from: &[f64],
        known: &mut Option<DMatrix<f64>>,
        interrupt: Interrupt<'_>,
    ) -> Result<Refit, String> {
        // The others start at the prediction of the linearised fit.
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
        // Derivatives on the other side of a kink are of no use.
        let smooth = fitted.kinks.is_empty();
        let at_optimum = fitted.derivatives().filter(|_| smooth);
        let sufficient = known.is_some();
        let nearest = known.take().or(at_optimum);
        let mut options = Options {
            // It starts near its end, and a hundredth of a standard error increases the misfit by at most a thousandth.
            differences: Differences::Forward,
            noise: Noise::Known(NOISE),
            jumps: JUMPS,
            // Kinks at the minimum also occur at the ends of these searches.
            polish: !smooth,
            attempts: false,
            interrupt,
            known: nearest.as_ref().map(|jacobian| Known { jacobian, sufficient }),
            ..Options::fit()
        };
        // A second call for each step is worth as much as a second step there.
        options.steps.second_order = !smooth;
        let fit = solve(&self.problem_from(&theta, Some(k)), &options).map_err(|fault| fault.to_string())?;
        if fit.status == Status::Interrupted {
            return Err("interrupted".to_owned());
        }
        // The row of the prior is absent for a fixed parameter, but its contribution remains.
        let penalty = self.parameters[k].prior.map_or(0.0, |prior| {
            let row = match self.parameters[k].fitted().scale {
                Scale::Linear => (v - prior.mean) / prior.deviation,
                Scale::Log => (v - prior.mean.ln()) / prior.deviation,
            };
            row * row
        });
        *known = of_data(&fit).filter(|_| smooth);
        let mut u = fit.u;
        u[k] = v;
        let mut objective = 2.0 * fit.cost + penalty;
        // Near a kink the minimum is one of many indistinguishable ones: a slightly lower value is not a better optimum.
        let least = fitted.inference.objective();
        if !smooth && least - objective <= UNTOLD * fitted.fit().scatter() {
            objective = objective.max(least);
        }
        Ok(Refit { objective, u })
    }

    /// Errors of each fold, predicted with the parameters fitted to the others. The folds are those of [`Identification::groups`].
    ///
    /// # Errors
    /// If a fit fails.
    pub fn validate(&self, fitted: &Fitted, folds: &[Fold], settings: &Settings<'_>) -> Result<Validation, String> {
        let count = self.observations.len();
        let leave_out = |fold: &Fold| -> Result<Vec<(usize, f64)>, String> {
            // Means belong to no fold.
            let all = count + self.means.list.len();
            let others: Vec<usize> = (0..all).filter(|i| !fold.points.contains(i)).collect();
            let problem = self.problem_from(fitted.theta(), None);
            let partial = |theta: &[f64]| {
                let all = problem.residual(theta)?;
                Ok(others.iter().map(|i| all[*i]).collect())
            };
            let partial = Problem::new(partial, problem.parameters().to_vec());
            let known = fitted
                .derivatives()
                .filter(|_| settings.loss == Loss::Linear && fitted.kinks.is_empty());
            let known = known.map(|jacobian| jacobian.select_rows(&others));
            let options = Options {
                known: known.as_ref().map(|jacobian| Known {
                    jacobian,
                    sufficient: false,
                }),
                ..settings.options(self.accuracy)
            };
            let fit = solve(&partial, &options).map_err(|fault| fault.to_string())?;
            if fit.status == Status::Interrupted {
                return Err("interrupted".to_owned());
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
