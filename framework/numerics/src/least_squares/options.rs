//! How a problem is solved.

use std::fmt;

use super::evaluate::Interrupt;
use super::fault::{Fault, Finding};
use super::fit::Fit;
use super::robust::Loss;

/// How a step is found that leaves the ball or the bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subproblem {
    /// As cone program.
    Cone,
    /// Along the projected gradient, then towards the least on the free face.
    Dogleg,
}

/// Which differences stand for derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Differences {
    /// One-sided ones, central ones from where those have converged.
    Switched,
    /// One-sided ones.
    Forward,
    /// Central ones: for laws with kinks, such as tables.
    Central,
}

/// Relative noise of one call of the residual function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// Rounding only.
    Rounding,
    /// Known, for instance the relative tolerance of an iteration inside. \[-\]
    Known(f64),
    /// Told from third differences of seven calls at the start.
    Estimated,
}

/// Bounds below which a run has converged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Of the first-order measure. \[-\]
    pub first_order: f64,
    /// Of the remaining shift in standard errors; 0 where it is not asked. \[-\]
    pub relative_offset: f64,
    /// Of the relative change of any coordinate. \[-\]
    pub step: f64,
    /// Of the relative change of the cost. \[-\]
    pub cost: f64,
}

/// How far a run steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// First radius over the length of the start. \[-\]
    pub radius: f64,
    /// Greatest change of a coordinate over its size. \[-\]
    pub bound: f64,
    /// How much of a column's norm its scale remembers from one iteration to the next. \[-\]
    pub memory: f64,
    /// Whether steps are corrected to second order.
    pub second_order: bool,
}

/// How a problem is solved.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// What a residual costs.
    pub loss: Loss,
    /// Residual from which on a row counts as far; of no meaning for the linear loss. \[-\]
    pub loss_scale: f64,
    /// Whether the residuals are not weighted: the loss scale then counts in their own spread, told from a soft_l1 fit.
    pub estimate_spread: bool,
    /// How steps are found.
    pub subproblem: Subproblem,
    /// Which differences stand for derivatives.
    pub differences: Differences,
    /// Relative noise of one call.
    pub noise: Noise,
    /// Jumps of single residuals over the whole, where the law behind them changes: steps of differences are chosen as for a noise
    /// of this size, while changes of the cost are trusted as before. 0 where there are none. \[-\]
    pub jumps: f64,
    /// Where runs with one-sided differences stop.
    pub forward: Tolerances,
    /// Where runs with central differences stop.
    pub central: Tolerances,
    /// How far the first attempt steps.
    pub steps: Steps,
    /// Whether a run that short differences no longer bring forward, as beside a kink or jump of a law, is finished without derivatives.
    pub polish: bool,
    /// Whether a run that ends badly is tried again with other steps.
    pub attempts: bool,
    /// The most steps of one attempt.
    pub iterations: usize,
    /// The most calls of one attempt.
    pub evaluations: usize,
    /// Asked before each call but the first: whether to stop.
    pub interrupt: Option<Interrupt<'a>>,
    /// Who runs the searches of several starts; absent, the threads of this process.
    pub searches: Option<&'a Searches<'a>>,
}

/// Runs the searches of so many starts and gives their fits in the order of the starts.
pub type Searches<'a> = dyn Fn(usize, &OneSearch<'_>) -> Vec<Result<Fit, Fault>> + Sync + 'a;

/// The search from the start of a number.
pub type OneSearch<'a> = dyn Fn(usize) -> Result<Fit, Fault> + Sync + 'a;

impl Options<'_> {
    /// For fits with intervals: ends where what remains is a small part of the standard errors.
    pub fn fit() -> Self {
        let mut options = Self::exact();
        options.forward.relative_offset = 1e-2;
        options.central.relative_offset = 1e-4;
        options
    }

    /// To as many digits as differences allow.
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
            // Radius and bound are those with which most of the certified problems of the NIST are solved in one attempt;
            // the memory below 1 lets the scale of a column follow it down.
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
        }
    }

    /// # Errors
    /// If a number makes no sense.
    pub(super) fn check(&self) -> Result<(), Fault> {
        let mut findings = Vec::new();
        let mut above_zero = |place: &str, x: f64| {
            if !(x > 0.0 && x.is_finite()) {
                findings.push(Finding::new(
                    place,
                    format!("{x} is not above zero"),
                    "give a number above zero",
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
