//! Options of the solver.

use std::fmt;

use nalgebra::DMatrix;

use super::evaluate::Interrupt;
use super::fault::{Fault, Finding};
use super::fit::Fit;
use super::robust::Loss;

/// Method for steps that leave the ball or the bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subproblem {
    /// Cone program.
    Cone,
    /// Along the projected gradient, then towards the minimum on the free face.
    Dogleg,
}

/// Differences for derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Differences {
    /// One-sided, then central after convergence.
    Switched,
    /// One-sided.
    Forward,
    /// Central: for laws with kinks, such as tables.
    Central,
}

/// Relative noise of one call of the residual function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// Rounding only.
    Rounding,
    /// Known, for instance the relative tolerance of an inner iteration. \[-\]
    Known(f64),
    /// Estimated from third differences of seven calls at the start.
    Estimated,
}

/// Tolerances of convergence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Of the first-order measure. \[-\]
    pub first_order: f64,
    /// Of the remaining shift in standard errors; 0 to disable. \[-\]
    pub relative_offset: f64,
    /// Of the relative change of any coordinate. \[-\]
    pub step: f64,
    /// Of the relative change of the cost. \[-\]
    pub cost: f64,
}

/// Limits of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// First radius over the length of the start. \[-\]
    pub radius: f64,
    /// Maximum change of a coordinate over its size. \[-\]
    pub bound: f64,
    /// Memory of the scale of a column from one iteration to the next. \[-\]
    pub memory: f64,
    /// Whether steps are corrected to second order.
    pub second_order: bool,
}

/// Options of the solver.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Loss function.
    pub loss: Loss,
    /// Scale of the loss; ignored for the linear loss. \[-\]
    pub loss_scale: f64,
    /// Whether the residuals are not weighted: the scale of the loss is then relative to their spread from a soft_l1 fit.
    pub estimate_spread: bool,
    /// Method for steps.
    pub subproblem: Subproblem,
    /// Differences for derivatives.
    pub differences: Differences,
    /// Relative noise of one call.
    pub noise: Noise,
    /// Relative discontinuities of single residuals: steps of differences are chosen for a noise of this size, but the noise of the cost is
    /// unaffected. 0 if there are none. \[-\]
    pub jumps: f64,
    /// Tolerances with one-sided differences.
    pub forward: Tolerances,
    /// Tolerances with central differences.
    pub central: Tolerances,
    /// Limits of steps of the first attempt.
    pub steps: Steps,
    /// Whether a run without progress by short differences, for example near a kink or jump, is completed without derivatives.
    pub polish: bool,
    /// Whether a failed run is repeated with other steps.
    pub attempts: bool,
    /// Maximum number of steps of one attempt.
    pub iterations: usize,
    /// Maximum number of calls of one attempt.
    pub evaluations: usize,
    /// Called before each call except the first: whether to stop.
    pub interrupt: Option<Interrupt<'a>>,
    /// Who runs the searches of several starts; absent, the threads of this process.
    pub searches: Option<&'a Searches<'a>>,
    /// Derivatives that are known from a point near the start; absent, differences.
    pub known: Option<Known<'a>>,
}

/// Derivatives from a point nearby. The search corrects them with the residuals of its own steps (Broyden, Math. Comput. 19 (1965)
/// 577-593) and returns them as they are at its end; it takes differences where a step fails.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// Derivative of the rows of data, without those of priors, by the coordinates of all parameters.
    pub jacobian: &'a DMatrix<f64>,
    /// Whether the search may end before it has taken differences at any point.
    pub sufficient: bool,
}

/// Runs the searches of so many starts and gives their fits in the order of the starts.
pub type Searches<'a> = dyn Fn(usize, &OneSearch<'_>) -> Vec<Result<Fit, Fault>> + Sync + 'a;

/// The search from the start of a number.
pub type OneSearch<'a> = dyn Fn(usize) -> Result<Fit, Fault> + Sync + 'a;

impl Options<'_> {
    /// For fits with intervals: stops if the remaining shift is a small part of the standard errors.
    pub fn fit() -> Self {
        let mut options = Self::exact();
        options.forward.relative_offset = 1e-2;
        options.central.relative_offset = 1e-4;
        options
    }

    /// To the maximum accuracy of differences.
    pub fn exact() -> Self {
        Self {
            loss: Loss::Linear,
            loss_scale: 2.0,
            estimate_spread: false,
            subproblem: Subproblem::Cone,
            differences: Differences::Switched,
            noise: Noise::Rounding,
            jumps: 0.0,
            forward: Tolerances {
                first_order: 1e-6,
                relative_offset: 0.0,
                step: 1e-5,
                cost: 1e-8,
            },
            central: Tolerances {
                first_order: 1e-10,
                relative_offset: 0.0,
                step: 1e-10,
                cost: 1e-14,
            },
            // With this radius and bound most of the certified NIST problems are solved in one attempt; with a memory below 1 the scale of
            // a column can decrease.
            steps: Steps {
                radius: 1.0,
                bound: 5.0,
                memory: 0.7,
                second_order: true,
            },
            polish: false,
            attempts: true,
            iterations: 400,
            evaluations: 100_000,
            interrupt: None,
            searches: None,
            known: None,
        }
    }

    /// # Errors
    /// If a number is invalid.
    pub(super) fn check(&self) -> Result<(), Fault> {
        let mut findings = Vec::new();
        let mut above_zero = |place: &str, x: f64| {
            if !(x > 0.0 && x.is_finite()) {
                findings.push(Finding::new(
                    place,
                    format!("{x} is not positive"),
                    "give a positive number",
                ));
            }
        };
        above_zero("option loss_scale", self.loss_scale);
        above_zero("option steps.radius", self.steps.radius);
        above_zero("option steps.bound", self.steps.bound);
        above_zero("option steps.memory", self.steps.memory);
        if let Noise::Known(noise) = self.noise {
            above_zero("option noise", noise);
        }
        if self.steps.memory > 1.0 {
            let message = format!("{} is above 1", self.steps.memory);
            findings.push(Finding::new("option steps.memory", message, "give a share"));
        }
        if findings.is_empty() {
            Ok(())
        } else {
            Err(Fault { findings })
        }
    }
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self::fit()
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("loss", &self.loss)
            .field("subproblem", &self.subproblem)
            .field("differences", &self.differences)
            .field("noise", &self.noise)
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}
