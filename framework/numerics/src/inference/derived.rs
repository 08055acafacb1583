//! Quantities calculated with identified parameters, and their uncertainty.
//!
//! The full covariance is used; without correlations the bands are wrong.

use super::Fit;

/// Distance from zero or one, in deviations, within which the band of a share is computed from its logit.
const NEAR: f64 = 2.0;

/// A calculated quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derived {
    /// Its value.
    pub value: f64,
    /// Its standard deviation; absent if the data do not determine it.
    pub deviation: Option<f64>,
}

impl Derived {
    /// Band of `deviations` standard deviations on either side; absent if the data do not determine it.
    pub fn band(&self, deviations: f64) -> Option<[f64; 2]> {
        let half = deviations * self.deviation?;
        Some([self.value - half, self.value + half])
    }

    /// Band of a share of a whole: within zero to one if the share is; computed from the logit near the limits.
    pub fn share_band(&self, deviations: f64) -> Option<[f64; 2]> {
        let (value, deviation) = (self.value, self.deviation?);
        let near = value - NEAR * deviation < 0.0 || value + NEAR * deviation > 1.0;
        if !(near && value > 0.0 && value < 1.0) {
            return self.band(deviations);
        }
        let middle = (value / (1.0 - value)).ln();
        let half = deviations * deviation / (value * (1.0 - value));
        Some([middle - half, middle + half].map(|x| 1.0 / (1.0 + (-x).exp())))
    }
}

/// The smallest band that contains two bands. For a parameter at its bound the second band is evaluated at its one-sided end.
pub fn hull(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Parts of a whole with their shares.
#[derive(Debug, Clone, PartialEq)]
pub struct Breakdown {
    /// The parts.
    pub parts: Vec<Derived>,
    /// Their sum.
    pub total: Derived,
    /// Parts over the sum; empty if the sum is zero.
    pub shares: Vec<Derived>,
}

impl Fit {
    /// A quantity from its value and its gradient over the coordinates.
    pub fn derived(&self, value: f64, gradient: &[f64]) -> Derived {
        let deviation = self.deviation_along(gradient);
        Derived { value, deviation }
    }

    /// Parts of a whole from their values and gradients over the coordinates, one list for each part.
    ///
    /// Parameters of the rig may be among the coordinates; they widen the bands.
    ///
    /// # Errors
    /// If the number of gradients differs from the number of parts, or the length of a gradient from the number of parameters.
    pub fn breakdown(&self, values: &[f64], gradients: &[Vec<f64>]) -> Result<Breakdown, String> {
        let count = self.parameters().len();
        if values.len() != gradients.len() || gradients.iter().any(|g| g.len() != count) {
            return Err("a breakdown needs one gradient for each part, over all parameters".to_owned());
        }
        let whole: f64 = values.iter().sum();
        let sum: Vec<f64> = (0..count).map(|j| gradients.iter().map(|g| g[j]).sum()).collect();
        let pairs = || values.iter().zip(gradients);
        let share = |(value, gradient): (&f64, &Vec<f64>)| {
            let share = value / whole;
            let gradient: Vec<f64> = gradient
                .iter()
                .zip(&sum)
                .map(|(g, s)| (g - share * s) / whole)
                .collect();
            self.derived(share, &gradient)
        };
        Ok(Breakdown {
            parts: pairs()
                .map(|(value, gradient)| self.derived(*value, gradient))
                .collect(),
            total: self.derived(whole, &sum),
            shares: if values.iter().all(|v| (v / whole).is_finite()) {
                pairs().map(share).collect()
            } else {
                Vec::new()
            },
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn bands_of_shares_stay_between_zero_and_one() {
        let share = |value, deviation| Derived {
            value,
            deviation: Some(deviation),
        };
        let [low, high] = share(0.05, 0.05).share_band(1.96).unwrap();
        assert!(0.0 < low && low < 0.05 && 0.05 < high && high < 1.0);
        assert_eq!(share(0.5, 0.1).share_band(1.0), Some([0.4, 0.6]));
        // A share outside has no logit.
        assert_eq!(share(-0.25, 0.25).share_band(1.0), Some([-0.5, 0.0]));
        let unknown = Derived {
            value: 0.5,
            deviation: None,
        };
        assert!(unknown.band(2.0).is_none() && unknown.share_band(2.0).is_none());
        assert_eq!(hull([0.0, 2.0], [-1.0, 1.0]), [-1.0, 2.0]);
    }
}
