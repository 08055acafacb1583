//! Calls of the residual function, counted.

use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::DVector;

use super::fault::{Fault, Finding};
use super::problem::Problem;
use super::space::Space;

/// Maximum residual; squares of larger ones would overflow.
const GREATEST: f64 = 1e150;

/// Why there is no residual.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Miss {
    /// It has no value here.
    Undefined(String),
    /// Interrupted by the user.
    Interrupted,
}

/// A function that returns whether to stop.
pub(super) type Interrupt<'a> = &'a (dyn Fn() -> bool + Sync);

/// Counts calls of a residual function and appends rows of priors.
pub(super) struct Evaluator<'p> {
    problem: &'p Problem<'p>,
    pub space: &'p Space<'p>,
    interrupt: Option<Interrupt<'p>>,
    /// Rows of data; those of priors follow.
    pub rows: usize,
    // Sums of integers do not depend on the order of threads.
    evaluations: AtomicUsize,
    undefined: AtomicUsize,
}

impl<'p> Evaluator<'p> {
    /// Evaluates the residual at the start.
    ///
    /// # Errors
    /// If there is none, or if it has fewer rows than there are free parameters.
    pub fn start(
        problem: &'p Problem<'p>,
        space: &'p Space<'p>,
        interrupt: Option<Interrupt<'p>>,
    ) -> Result<(Self, DVector<f64>), Fault> {
        let mut evaluator = Self {
            problem,
            space,
            interrupt: None,
            rows: 0,
            evaluations: AtomicUsize::new(0),
            undefined: AtomicUsize::new(0),
        };
        let theta = space.theta(&space.start);
        let data = problem.residual(&theta);
        evaluator.rows = data.as_ref().map_or(0, Vec::len);
        evaluator.evaluations.fetch_add(1, Ordering::Relaxed);
        let residual = data
            .and_then(|data| evaluator.complete(data, &space.start))
            .map_err(|message| {
                let help = "choose a start where every residual has a value";
                Finding::new("residuals at the start", message, help)
            })?;
        let (rows, free) = (residual.len(), space.len());
        if rows < free {
            let message = format!("{rows} rows, including priors, for {free} free parameters");
            let help = "fix parameters, or give some of them a prior";
            return Err(Finding::new("residuals", message, help).into());
        }
        // The first call is never interrupted, because there would be no point to return.
        evaluator.interrupt = interrupt;
        Ok((evaluator, residual))
    }

    /// Rows of data, then of priors, at coordinates of the free parameters.
    pub fn residual(&self, u: &[f64]) -> Result<DVector<f64>, Miss> {
        if self.interrupted() {
            return Err(Miss::Interrupted);
        }
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        let residual = self
            .problem
            .residual(&self.space.theta(u))
            .and_then(|data| self.complete(data, u));
        residual.map_err(|message| {
            self.undefined.fetch_add(1, Ordering::Relaxed);
            Miss::Undefined(message)
        })
    }

    /// As [`Self::residual`], absent if it has no value; the only error is an interruption.
    pub fn try_residual(&self, u: &[f64]) -> Result<Option<DVector<f64>>, Miss> {
        match self.residual(u) {
            Ok(residual) => Ok(Some(residual)),
            Err(Miss::Undefined(_)) => Ok(None),
            Err(Miss::Interrupted) => Err(Miss::Interrupted),
        }
    }

    /// Whether the user has interrupted.
    pub fn interrupted(&self) -> bool {
        self.interrupt.is_some_and(|stop| stop())
    }

    /// Calls so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Calls so far without a value.
    pub fn undefined(&self) -> usize {
        self.undefined.load(Ordering::Relaxed)
    }

    fn complete(&self, mut data: Vec<f64>, u: &[f64]) -> Result<DVector<f64>, String> {
        if data.len() != self.rows {
            return Err(format!("{} residuals, but {} at the start", data.len(), self.rows));
        }
        if let Some(i) = data.iter().position(|r| r.is_nan() || r.abs() > GREATEST) {
            return Err(format!("residual {} of {} is {}", i + 1, self.rows, data[i]));
        }
        data.extend(self.space.priors(u));
        Ok(DVector::from_vec(data))
    }
}
