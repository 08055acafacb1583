//! What became of a problem.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::kink::Kink;
use super::subproblem::How;

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// Nothing is left of the residuals.
    ZeroResidual,
    /// No direction inside the bounds lowers the cost to first order.
    FirstOrder,
    /// What remains is a small part of the standard errors.
    RelativeOffset,
    /// Steps have become small.
    Step,
    /// The cost changes no more.
    Cost,
    /// A pattern of neighbours that shrank to a thousandth of a standard error has none that is lower: the end of [`super::Options::polish`].
    Pattern,
    /// The ball has shrunk to nothing without a step that lowers the cost.
    Radius,
    /// As many steps as were allowed.
    IterationLimit,
    /// As many calls as were allowed.
    EvaluationLimit,
    /// Beside the point the residuals have no value, however near.
    DerivativeNotFinite,
    /// The user has had enough.
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

/// What a fit is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// A minimum.
    Converged,
    /// A test of convergence was met, and yet a combination of parameters does not change the residuals: no success.
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

/// One step that was tried.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Iteration {
    /// Number of the attempt, from 1.
    pub attempt: usize,
    /// Cost before the step.
    pub cost: f64,
    /// First-order measure before the step. \[-\]
    pub first_order: f64,
    /// Remaining shift in standard errors before the step, where there are more rows than free parameters. \[-\]
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
    /// Fall of the cost that was expected.
    pub predicted: f64,
    /// Fall of the cost; minus infinity where the residuals have no value.
    pub actual: f64,
    /// Whether the step was taken.
    pub accepted: bool,
}

/// How much work it was, over all attempts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Calls of the residual function, those for differences among them.
    pub evaluations: usize,
    /// Those of them that finished searches without derivatives.
    pub polishing: usize,
    /// Calls that had no value.
    pub undefined: usize,
    /// Steps that were tried.
    pub steps: usize,
    /// Cone programs.
    pub cone_solves: usize,
    /// Cone programs without answer, where the dogleg stepped in.
    pub cone_failures: usize,
    /// Runs from the start: one, further attempts, and soft_l1 fits beforehand.
    pub runs: usize,
}

/// Derivatives at the end, by central differences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Derivative {
    /// Derivative of the rows by the coordinates u of all parameters: as many rows as there are residuals, columns of zeros
    /// for fixed parameters. Weighted by uncertainties as the residuals are, not by the loss.
    pub jacobian: DMatrix<f64>,
    /// Derivative of the cost by the coordinates, the loss in it.
    pub gradient: Vec<f64>,
    /// Smallest singular value over the greatest, of the columns of free parameters that are on no bound, each divided by
    /// its norm. Below 1e-9 the fit is singular. \[-\]
    pub independence: f64,
    /// Whether each parameter is free and has not moved a residual anywhere on the way.
    pub unseen: Vec<bool>,
}

/// A fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Parameters in their own units.
    pub theta: Vec<f64>,
    /// Their coordinates: themselves, or their logarithms.
    pub u: Vec<f64>,
    /// The cost F.
    pub cost: f64,
    /// The residuals as the function gives them, then a row for each prior of a free parameter.
    pub residuals: Vec<f64>,
    /// How many of them are residuals.
    pub rows: usize,
    /// Derivatives; absent after an interruption and where they are not finite.
    pub derivative: Option<Derivative>,
    /// On which bound each parameter stands with the data pulling outward.
    pub active: Vec<Option<Side>>,
    /// Whether each parameter is fixed by equal bounds.
    pub fixed: Vec<bool>,
    /// What the fit is worth.
    pub status: Status,
    /// Why the run ended.
    pub reason: Reason,
    /// Number of the attempt that is given back, from 1.
    pub attempt: usize,
    /// Residual from which on a row counts as far, the spread in it where that was estimated.
    pub loss_scale: f64,
    /// All steps of all attempts.
    pub log: Vec<Iteration>,
    /// How much work it was.
    pub counts: Counts,
    /// Kinks and jumps that hold the minimum; none where the search ended by its derivatives.
    pub kinks: Vec<Kink>,
    /// What the user should know: moved starts, fixed and unseen parameters, failures on the way.
    pub notes: Vec<String>,
}

impl Fit {
    /// Whether it is a minimum.
    pub fn converged(&self) -> bool {
        self.status == Status::Converged
    }

    /// Variance of a residual by the scatter of all; 1 where there are no more residuals than free parameters. \[-\]
    pub fn scatter(&self) -> f64 {
        let free = self.fixed.iter().filter(|fixed| !**fixed).count();
        match self.residuals.len().checked_sub(free) {
            Some(freedom) if freedom > 0 => self.chi2() / freedom as f64,
            _ => 1.0,
        }
    }

    /// Twice the cost: the sum of squares, where the loss is linear.
    pub fn chi2(&self) -> f64 {
        2.0 * self.cost
    }
}
