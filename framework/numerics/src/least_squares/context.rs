//! What the runs of a problem share, and the points that they pass on.

use nalgebra::DVector;

use super::evaluate::Evaluator;
use super::options::Options;
use super::robust::Robust;

/// A point with its residual.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub u: Vec<f64>,
    pub r: DVector<f64>,
}

/// Shared data of all runs of a problem.
pub(super) struct Context<'a> {
    pub evaluator: &'a Evaluator<'a>,
    pub options: &'a Options<'a>,
    pub robust: Robust,
    /// Relative noise of one call.
    pub noise: f64,
    /// The same for steps of differences, which are longer with jumps.
    pub rough: f64,
    /// Whether central differences are useless because of noise, so that one-sided differences end the run.
    pub noisy: bool,
}
