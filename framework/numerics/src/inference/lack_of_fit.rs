//! Whether a model reproduces its data within their stated accuracy.

use super::probability::{chi_square_above, f_above};
use super::{Accuracy, Fit};

/// Probabilities outside which a note is printed.
const SAID: [f64; 2] = [0.01, 0.99];

/// Consistency of the scatter of a fit with the stated accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// Sum of the squared residuals, including those of priors.
    pub objective: f64,
    /// Degrees of freedom of this sum.
    pub freedom: f64,
    /// Probability of a sum at least this large if model and accuracies are correct.
    pub probability: f64,
}

impl LackOfFit {
    /// Minimum factor by which intervals are too small if the model does not reproduce the data; both intervals should then be shown.
    pub fn widening(&self) -> Option<f64> {
        (self.probability < SAID[0]).then(|| (self.objective / self.freedom).sqrt())
    }

    /// A note; absent if scatter and accuracy are consistent.
    pub fn words(&self) -> Option<String> {
        if let Some(widening) = self.widening() {
            return Some(format!(
                "the model does not reproduce the data within the stated accuracy; intervals are too small by at least {widening:.2}"
            ));
        }
        (self.probability > SAID[1]).then(|| "the stated accuracy is pessimistic".to_owned())
    }
}

impl Fit {
    /// The test of the whole fit; absent if the accuracies are estimated from the same scatter, the loss is robust, or there are no degrees
    /// of freedom.
    ///
    /// Rows of priors are included in the sum and in the degrees of freedom: a prior that contradicts the data is also a lack of fit.
    pub fn lack_of_fit(&self) -> Option<LackOfFit> {
        let [objective, freedom] = [self.objective(), self.freedom()];
        (self.accuracy() == Accuracy::Given && !self.robust).then_some(())?;
        Some(LackOfFit {
            objective,
            freedom,
            probability: chi_square_above(objective, freedom)?,
        })
    }
}

/// The scatter of repeated points compared with the remaining residuals.
///
/// Source: Draper, Smith: Applied Regression Analysis (Wiley 1998), section 2.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PureError {
    /// Sum of squares about the means of repeated points, and its degrees of freedom.
    pub pure: [f64; 2],
    /// Remaining sum of squares, and its degrees of freedom.
    pub lack: [f64; 2],
    /// Ratio of the mean squares, lack over pure.
    pub ratio: f64,
    /// Probability of a ratio at least this large if the model is correct, independent of the accuracy.
    pub probability: f64,
}

/// Splits the residuals by repeated points: groups of indices with the same settings and accuracy.
///
/// Points in no group count as measured once. Absent if there are no repetitions, no remaining degrees of freedom, or identical
/// repetitions.
pub fn pure_error(fit: &Fit, groups: &[Vec<usize>]) -> Option<PureError> {
    let r = fit.residuals();
    let (mut pure, mut repeats) = (0.0, 0_usize);
    for group in groups {
        let list = group.iter().map(|i| r.get(*i).copied()).collect::<Option<Vec<f64>>>()?;
        let mean = list.iter().sum::<f64>() / list.len().max(1) as f64;
        pure += list.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>();
        repeats += list.len().saturating_sub(1);
    }
    let repeats = repeats as f64;
    let rest = fit.freedom() - repeats;
    let left = (fit.objective() - pure).max(0.0);
    let ratio = (left / rest) / (pure / repeats);
    let probability = f_above(ratio, [rest, repeats])?;
    ratio.is_finite().then_some(PureError {
        pure: [pure, repeats],
        lack: [left, rest],
        ratio,
        probability,
    })
}
