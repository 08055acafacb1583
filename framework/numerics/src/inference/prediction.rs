//! Predictions of measurements that were not fitted: bands and their coverage.
//!
//! A new measurement differs from its prediction by its own scatter and by the uncertainty of the parameters: var = g' C g + sigma^2 with
//! the gradient g of the prediction and the covariance C of all parameters.
//!
//! Sources: Seber, Wild: Nonlinear Regression (Wiley 1989), section 5.1; for the interval of a share Wilson, J. Amer. Statist.
//! Assoc. 22 (1927) 209-212, recommended by Brown, Cai, DasGupta, Statist. Sci. 16 (2001) 101-133.

use super::{Fit, LackOfFit, Succession};
use crate::sampling::inverse_normal;

/// Factors by which standard deviations of a fit are too small because the model does not fit the points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widening {
    /// Factor on standard deviations of parameters and of derived quantities.
    pub parameters: f64,
    /// Factor on the scatter of one measurement about the model.
    pub scatter: f64,
}

impl Default for Widening {
    fn default() -> Self {
        Self {
            parameters: 1.0,
            scatter: 1.0,
        }
    }
}

impl Widening {
    /// From the checks of a fit. A lack of fit widens both. Correlated neighbours widen only the parameters; the deviation of one point
    /// from the model does not change.
    pub fn from_checks(lack: Option<&LackOfFit>, succession: Option<&Succession>) -> Self {
        let lack = lack.and_then(LackOfFit::widening).unwrap_or(1.0).max(1.0);
        let together = succession.filter(|s| s.is_suspect()).map_or(1.0, Succession::widening);
        Self {
            parameters: lack.max(together),
            scatter: lack,
        }
    }

    /// Whether any factor differs from one.
    pub fn is_some(&self) -> bool {
        self.parameters > 1.0 || self.scatter > 1.0
    }
}

/// A predicted measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// The calculated value.
    pub value: f64,
    /// Standard deviation due to the parameters; absent if the fitted points do not determine it.
    pub deviation: Option<f64>,
    /// Prediction band of one new measurement with the confidence; absent without the deviation.
    pub band: Option<[f64; 2]>,
}

impl Fit {
    /// The prediction band of one new measurement, from value, gradient over the coordinates and standard deviation of one measurement, in
    /// the unit of the value. Normal quantiles if the accuracies are given, Student's if they are estimated.
    pub fn predict(&self, value: f64, gradient: &[f64], sigma: f64, widening: Widening, confidence: f64) -> Prediction {
        let deviation = self.deviation_along(gradient);
        let half = deviation
            .zip(self.quantile(confidence))
            .map(|(deviation, quantile)| quantile * (widening.parameters * deviation).hypot(widening.scatter * sigma));
        Prediction {
            value,
            deviation,
            band: half
                .filter(|half| half.is_finite())
                .map(|half| [value - half, value + half]),
        }
    }
}

/// Coverage of bands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coverage {
    /// Number of measurements inside their bands.
    pub inside: usize,
    /// Number of measurements with a band.
    pub count: usize,
}

impl Coverage {
    /// From a flag for each measurement; absent if there are none.
    pub fn count(list: impl IntoIterator<Item = bool>) -> Option<Self> {
        let mut found = Self { inside: 0, count: 0 };
        for is_inside in list {
            found.count += 1;
            found.inside += usize::from(is_inside);
        }
        (found.count > 0).then_some(found)
    }

    /// Share inside. \[-\]
    pub fn share(&self) -> f64 {
        self.inside as f64 / self.count as f64
    }

    /// Wilson interval of the expected share, for independent measurements. Absent if the confidence is not between zero and one.
    pub fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        let z = inverse_normal(0.5 + 0.5 * confidence).filter(|z| *z > 0.0)?;
        let (count, share) = (self.count as f64, self.share());
        let weight = z * z / count;
        let middle = (share + 0.5 * weight) / (1.0 + weight);
        let half = (share * (1.0 - share) * weight + 0.25 * weight * weight).sqrt() / (1.0 + weight);
        Some([(middle - half).max(0.0), (middle + half).min(1.0)])
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::{Accuracy, Parameter, Scale};

    /// A straight line through points at -1, 0 and 1 that miss it by 1, -2 and 1.
    fn line(accuracy: Accuracy) -> Fit {
        let parameter = |name: &str| Parameter::new(name, Scale::Linear, 0.0, [-10.0, 10.0]).unwrap();
        let jacobian = DMatrix::from_row_slice(3, 2, &[1.0, -1.0, 1.0, 0.0, 1.0, 1.0]);
        let parameters = vec![parameter("level"), parameter("slope")];
        Fit::new(parameters, &jacobian, &[1.0, -2.0, 1.0], 0, accuracy).unwrap()
    }

    #[test]
    fn bands_of_a_line_are_those_of_textbooks() {
        // Variance of the line at x is 1/3 + x^2/2, of a new point one more; the estimate is 6 over one degree of freedom.
        let at = |x: f64, accuracy, widening| line(accuracy).predict(5.0, &[1.0, x], 1.0, widening, 0.95);
        let given = at(2.0, Accuracy::Given, Widening::default());
        let expected = 1.959_963_985 * (1.0_f64 / 3.0 + 2.0 + 1.0).sqrt();
        assert!((given.band.unwrap()[1] - 5.0 - expected).abs() < 1e-8);
        assert!((given.deviation.unwrap() - (7.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        let fit = line(Accuracy::Estimated);
        let sigma = fit.scatter();
        assert!((sigma - 6.0_f64.sqrt()).abs() < 1e-12);
        let estimated = fit.predict(5.0, &[1.0, 2.0], sigma, Widening::default(), 0.95);
        let expected = 12.706_204_736 * 6.0_f64.sqrt() * (10.0_f64 / 3.0).sqrt();
        assert!((estimated.band.unwrap()[1] - 5.0 - expected).abs() < 1e-7);
        let wide = Widening {
            parameters: 3.0,
            scatter: 2.0,
        };
        let widened = at(2.0, Accuracy::Given, wide).band.unwrap();
        let expected = 1.959_963_985 * (9.0 * 7.0_f64 / 3.0 + 4.0).sqrt();
        assert!((widened[1] - 5.0 - expected).abs() < 1e-8 && (widened[0] + widened[1] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_determined_has_no_band() {
        let parameter = |name: &str| Parameter::new(name, Scale::Linear, 0.0, [-10.0, 10.0]).unwrap();
        let jacobian = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 1.0, 0.0]);
        let fit = Fit::new(
            vec![parameter("level"), parameter("unseen")],
            &jacobian,
            &[1.0, -1.0],
            0,
            Accuracy::Given,
        )
        .unwrap();
        assert!(
            fit.predict(0.0, &[1.0, 1.0], 1.0, Widening::default(), 0.95)
                .band
                .is_none()
        );
        assert!(
            fit.predict(0.0, &[1.0, 0.0], 1.0, Widening::default(), 0.95)
                .band
                .is_some()
        );
        assert!(
            fit.predict(0.0, &[1.0, 0.0], f64::NAN, Widening::default(), 0.95)
                .band
                .is_none()
        );
    }

    #[test]
    fn intervals_of_shares_are_wilsons() {
        let coverage = Coverage { inside: 9, count: 10 };
        // As scipy's binomtest(9, 10).proportion_ci(method="wilson") gives it.
        let [low, high] = coverage.interval(0.95).unwrap();
        assert!(
            (low - 0.595_849_973).abs() < 1e-8 && (high - 0.982_123_787).abs() < 1e-8,
            "{low} {high}"
        );
        let all = Coverage::count([true; 4]).unwrap();
        assert_eq!((all.share(), all.interval(0.95).unwrap()[1]), (1.0, 1.0));
        assert!(all.interval(0.95).unwrap()[0] > 0.5 && all.interval(1.0).is_none() && all.interval(-1.0).is_none());
        assert_eq!(Coverage::count([]), None);
    }
}
