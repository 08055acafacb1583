//! Result of a problem.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// The residuals are zero.
    ZeroResidual,
    /// No direction within the bounds reduces the cost to first order.
    FirstOrder,
    /// The remaining shift is a small part of the standard errors.
    RelativeOffset,
    /// The steps are small.
    Step,
    /// The cost no longer changes.
    Cost,
    /// No neighbour at a thousandth of a standard error is lower: the end of [`super::Options::polish`].
    Pattern,
    /// The ball has shrunk to zero without a step that reduces the cost.
    Radius,
    /// The maximum number of steps is reached.
    IterationLimit,
    /// The maximum number of calls is reached.
    EvaluationLimit,
    /// The residuals have no value near the point.
    DerivativeNotFinite,
    /// Interrupted by the user.
    Interrupted,
}

impl Reason {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::ZeroResidual => "zero residual",
            Self::FirstOrder => "first-order",
            Self::RelativeOffset => "relative offset",
            Self::Step => "step",
            Self::Cost => "cost",
            Self::Pattern => "pattern",
            Self::Radius => "radius",
            Self::IterationLimit => "iteration limit",
            Self::EvaluationLimit => "evaluation limit",
            Self::DerivativeNotFinite => "derivative not finite",
            Self::Interrupted => "interrupted",
        }
    }

    /// Whether a test of convergence was met.
    pub fn is_convergence(self) -> bool {
        matches!(
            self,
            Self::ZeroResidual | Self::FirstOrder | Self::RelativeOffset | Self::Step | Self::Cost | Self::Pattern
        )
    }
}

/// Status of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// A minimum.
    Converged,
    /// A test of convergence was met, but a combination of parameters has no effect on the residuals.
    Singular,
    /// The best point of a run that met no test of convergence.
    Failed,
    /// The best point so far.
    Interrupted,
}

impl Status {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Singular => "singular",
            Self::Failed => "failed",
            Self::Interrupted => "interrupted",
        }
    }
}

/// One of two bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The lower one.
    Lower,
    /// The upper one.
    Upper,
}

/// Method that found a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum How {
    /// The Gauss-Newton step is inside ball and bounds.
    Shortcut,
    /// Cone program.
    Cone,
    /// Dogleg after a failed cone program.
    Fallback,
    /// Dogleg by option.
    Dogleg,
}

impl How {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shortcut => "gauss-newton",
            Self::Cone => "cone program",
            Self::Fallback => "dogleg, because the cone program had no solution",
            Self::Dogleg => "dogleg",
        }
    }
}

/// One trial step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Iteration {
    /// Number of the attempt, starting at 1.
    pub attempt: usize,
    /// Cost before the step.
    pub cost: f64,
    /// First-order measure before the step. \[-\]
    pub first_order: f64,
    /// Remaining shift in standard errors before the step, if there are more rows than free parameters. \[-\]
    pub relative_offset: Option<f64>,
    /// Whether the derivatives are central differences.
    pub central: bool,
    /// How the step was found.
    pub how: How,
    /// Whether it was corrected to second order.
    pub corrected: bool,
    /// Radius of the ball.
    pub radius: f64,
    /// Length of the step in the metric of the ball.
    pub length: f64,
    /// Expected decrease of the cost.
    pub predicted: f64,
    /// Decrease of the cost; minus infinity if the residuals have no value.
    pub actual: f64,
    /// Whether the step was accepted.
    pub accepted: bool,
}

/// Counts of work over all attempts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Calls of the residual function, including those for differences.
    pub evaluations: usize,
    /// Calls for the completion without derivatives.
    pub polishing: usize,
    /// Calls without a value.
    pub undefined: usize,
    /// Trial steps.
    pub steps: usize,
    /// Cone programs.
    pub cone_solves: usize,
    /// Failed cone programs, replaced by dogleg.
    pub cone_failures: usize,
    /// Runs from the start: one, further attempts, and preliminary soft_l1 fits.
    pub runs: usize,
}

/// Derivatives at the end, by central differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Derivative {
    /// Derivative of the rows by the coordinates u of all parameters: one row for each residual, columns of zeros for fixed parameters.
    /// Weighted by uncertainties like the residuals, not by the loss.
    pub jacobian: DMatrix<f64>,
    /// Derivative of the cost by the coordinates, including the loss.
    pub gradient: Vec<f64>,
    /// Smallest over largest singular value of the columns of free parameters that are not at a bound, each divided by its norm. Below 1e-9
    /// the fit is singular. \[-\]
    pub independence: f64,
    /// Whether each parameter is free but never had an effect on a residual.
    pub unseen: Vec<bool>,
}

/// A kink or jump at a minimum along one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kink {
    /// The parameter that moves; all others follow.
    pub parameter: usize,
    /// Rows with discontinuous slope or value, in order.
    pub rows: Vec<usize>,
    /// All parameters on the lower and on the upper side, in their own units.
    pub sides: [Vec<f64>; 2],
    /// Increase of twice the cost to either side relative to a smooth minimum; absent if there is no value. \[-\]
    pub steepness: [Option<f64>; 2],
    /// Whether the value of the strongest row is discontinuous, not only its slope.
    pub jumps: bool,
}

/// A fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Parameters in their own units.
    pub theta: Vec<f64>,
    /// Coordinates: the parameters or their logarithms.
    pub u: Vec<f64>,
    /// The cost F.
    pub cost: f64,
    /// The residuals of the function, then a row for each prior of a free parameter.
    pub residuals: Vec<f64>,
    /// Number of residuals among them.
    pub rows: usize,
    /// Derivatives; absent after an interruption or if they are not finite.
    pub derivative: Option<Derivative>,
    /// The active bound of each parameter.
    pub active: Vec<Option<Side>>,
    /// Whether each parameter is fixed by equal bounds.
    pub fixed: Vec<bool>,
    /// Status of the fit.
    pub status: Status,
    /// Why the run ended.
    pub reason: Reason,
    /// Number of the returned attempt, starting at 1.
    pub attempt: usize,
    /// Scale of the loss, including the spread if that was estimated.
    pub loss_scale: f64,
    /// All steps of all attempts.
    pub log: Vec<Iteration>,
    /// Counts of work.
    pub counts: Counts,
    /// Kinks and jumps at the minimum; empty if the search ended by its derivatives.
    pub kinks: Vec<Kink>,
    /// Notes: moved starts, fixed parameters and parameters without effect, failures.
    pub notes: Vec<String>,
}

impl Fit {
    /// Whether it is a minimum.
    pub fn converged(&self) -> bool {
        self.status == Status::Converged
    }

    /// Variance of a residual from the scatter of all; 1 unless there are more residuals than free parameters. \[-\]
    pub fn scatter(&self) -> f64 {
        let free = self.fixed.iter().filter(|fixed| !**fixed).count();
        match self.residuals.len().checked_sub(free) {
            Some(freedom) if freedom > 0 => self.chi2() / freedom as f64,
            _ => 1.0,
        }
    }

    /// Twice the cost: the sum of squares if the loss is linear.
    pub fn chi2(&self) -> f64 {
        2.0 * self.cost
    }
}
