//! Losses by one law of a tournament, with the error of that law.

use gearloss_numerics::inference::Further;

/// Losses by a law with a known error.
#[derive(Clone)]
pub struct LossOfLaw {
    /// Factor on them.
    pub factor: Further,
    /// By point. \[W\]
    pub loss: Vec<f64>,
}
