//! Result of a model that is evaluated without a gearbox.

use crate::loss::{Extent, Limit, Observed, Step};

/// Result of a model.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Evaluated {
    /// The named values of the result; watts for a loss.
    pub values: Vec<(&'static str, f64)>,
    /// Their sum.
    pub total: f64,
    /// Moment about the relative speed for a loss, N m; the coefficient otherwise.
    pub moment: Option<f64>,
    /// Observed quantities with the path of their model.
    pub observed: Vec<(String, Observed, Extent)>,
    /// Limits with the path of their model.
    pub limits: Vec<(String, Limit, Extent)>,
    /// Quantities derived from stated ones: name, value in the documented unit, unit and law.
    pub followed: Vec<(&'static str, f64, &'static str, &'static str)>,
    /// Every step of the formula, with the path of its model.
    pub steps: Vec<(String, Step)>,
}

impl Evaluated {
    /// The value of a step of the formula, in the unit of its source; the last one if it was taken several times.
    pub fn step(&self, symbol: &str) -> Option<f64> {
        step(&self.steps, symbol)
    }

    /// Names of the limits that the point exceeds.
    pub fn outside(&self) -> impl Iterator<Item = &'static str> {
        self.limits
            .iter()
            .filter(|(_, _, e)| e.outside > 0)
            .map(|(_, limit, _)| limit.name)
    }
}

/// The value of a step by its symbol; the last one if it was taken several times.
pub(super) fn step(steps: &[(String, Step)], symbol: &str) -> Option<f64> {
    steps.iter().rev().find_map(|(_, step)| match step {
        Step::Value {
            symbol: name, value, ..
        } if *name == symbol => Some(*value),
        _ => None,
    })
}
