//! Standard deviations of measured losses whose accuracy is not stated point by point.

/// Share of the loss that is assumed where nothing is stated. \[%\]
const ASSUMED_PERCENT: f64 = 5.0;
/// Share of the root mean square of all losses below which no error is assumed to fall. \[-\]
const ASSUMED_FLOOR: f64 = 0.01;

/// Errors of losses: a share of the loss and a constant, which add as squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossErrors {
    /// Standard deviation over the loss. \[%\]
    pub percent: f64,
    /// Standard deviation at every point. \[W\]
    pub absolute: f64,
}

impl LossErrors {
    /// What is taken where nothing is stated: 5 % of the loss and 1 % of the root mean square of all losses. Both are assumptions, the
    /// order of size of a good rig: the first treats points of any size alike, the second keeps points of
    /// almost no loss from counting for more than all the others.
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
