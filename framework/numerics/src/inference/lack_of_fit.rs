//! Whether a model reproduces its data within their stated accuracy.

use super::probability::{chi_square_above, f_above};
use super::{Accuracy, Fit};

/// Probabilities outside of which something is said.
const SAID: [f64; 2] = [0.01, 0.99];

/// How the scatter of a fit goes with the accuracy that was stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// Sum of the squared residuals, those of priors with them.
    pub objective: f64,
    /// Degrees of freedom of this sum.
    pub freedom: f64,
    /// Probability of a sum as great or greater if model and accuracies are right.
    pub probability: f64,
}

impl LackOfFit {
    /// Factor by which intervals are too small at least, where the model does not reproduce the data; both intervals are then
    /// to be shown.
    pub fn widening(&self) -> Option<f64> {
        (self.probability < SAID[0]).then(|| (self.objective / self.freedom).sqrt())
    }

    /// What there is to say; nothing where scatter and accuracy go together.
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
    /// The test of the whole fit; absent where the accuracies are estimated from the same scatter, outliers pull
    /// less, or nothing is left over.
    ///
    /// Rows of priors count in the sum as they count in the degrees of freedom: a prior that the data contradict is a lack of
    /// fit too.
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

/// The scatter of repeated points set against what is left over.
///
/// Source: Draper, Smith: Applied Regression Analysis (Wiley 1998), section 2.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PureError {
    /// Sum of squares about the means of repeated points, and its degrees of freedom.
    pub pure: [f64; 2],
    /// Sum of squares that is left, and its degrees of freedom.
    pub lack: [f64; 2],
    /// Ratio of the mean squares, lack over pure.
    pub ratio: f64,
    /// Probability of a ratio as great or greater if the model is right, whatever the accuracy.
    pub probability: f64,
}

/// Splits what is left over by points that were measured again: groups of places with the same settings and accuracy.
///
/// Points in no group count as measured once. Absent where nothing is repeated, nothing is left over, or repetitions agree to
/// the last digit.
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
