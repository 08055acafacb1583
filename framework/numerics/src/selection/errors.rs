//! Standard deviations of measured losses without a stated accuracy for each point.

/// Assumed relative error if none is stated. \[%\]
const ASSUMED_PERCENT: f64 = 5.0;
/// Assumed minimum error relative to the root mean square of all losses. \[-\]
const ASSUMED_FLOOR: f64 = 0.01;

/// Errors of losses: a relative and a constant part, added as squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossErrors {
    /// Standard deviation over the loss. \[%\]
    pub percent: f64,
    /// Standard deviation at every point. \[W\]
    pub absolute: f64,
}

impl LossErrors {
    /// Default if nothing is stated: 5 % of the loss and 1 % of the root mean square of all losses. Both are assumptions with the order of
    /// magnitude of a good rig; the second limits the weight of points with very small losses.
    pub fn assumed(losses: &[f64]) -> Self {
        let squares: f64 = losses.iter().map(|loss| loss * loss).sum();
        Self {
            percent: ASSUMED_PERCENT,
            absolute: ASSUMED_FLOOR * (squares / losses.len().max(1) as f64).sqrt(),
        }
    }

    /// Standard deviation of a measured loss. \[W\]
    pub fn standard_deviation(&self, loss: f64) -> f64 {
        (0.01 * self.percent * loss).hypot(self.absolute)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_constants_add_as_squares() {
        let errors = LossErrors {
            percent: 3.0,
            absolute: 4.0,
        };
        assert!((errors.standard_deviation(-100.0) - 5.0).abs() < 1e-12);
        let assumed = LossErrors::assumed(&[300.0, -400.0, 0.0]);
        assert!((assumed.absolute - 0.01 * (250_000.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!(assumed.standard_deviation(0.0) > 0.0);
    }
}
