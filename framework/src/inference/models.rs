//! Comparison of models that were fitted to the same points with the same accuracies.
//!
//! Sources: Hurvich, Tsai, Biometrika 76 (1989) 297-307; Burnham, Anderson: Model Selection and Multimodel Inference (Springer
//! 2002). The limits below which two models are not told apart are conventions.

use super::{Accuracy, Validation};

/// Difference of the criteria below which models are not told apart.
const DIFFERENCE: f64 = 4.0;
/// Standard errors within which the mean difference of the folds is zero.
const ERRORS: f64 = 2.0;

/// Akaike's criterion, corrected for small samples. `parameters` counts all that were identified, those on a bound too.
///
/// With given accuracies `squares` is the sum of squares in units of the standard uncertainties; with estimated ones any sum
/// of squares of the points, whose scale then counts as one parameter more. Absent where there are too few points, or the sum
/// has no logarithm.
pub fn akaike(squares: f64, points: usize, parameters: usize, accuracy: Accuracy) -> Option<f64> {
    let count = points as f64;
    let (misfit, k) = match accuracy {
        Accuracy::Given => (squares, parameters as f64),
        Accuracy::Estimated => (count * (squares / count).ln(), parameters as f64 + 1.0),
    };
    let rest = count - k - 1.0;
    let criterion = misfit + 2.0 * k + 2.0 * k * (k + 1.0) / rest;
    (rest > 0.0 && criterion.is_finite()).then_some(criterion)
}

/// A model after its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedModel {
    /// Name in reports.
    pub name: String,
    /// Number of identified parameters.
    pub parameters: usize,
    /// Akaike's criterion, [`akaike`].
    pub criterion: f64,
    /// Errors over folds, if it was validated.
    pub validation: Option<Validation>,
}

/// Two models side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Criterion of the first less that of the second.
    pub difference: f64,
    /// Mean over folds of the difference of mean squares, first less second, and its standard error; absent unless both were
    /// validated on the same number of folds, two at least.
    pub folds: Option<[f64; 2]>,
}

impl Comparison {
    /// Compares two models.
    pub fn of(a: &FittedModel, b: &FittedModel) -> Self {
        let lists = a.validation.as_ref().zip(b.validation.as_ref());
        let folds = lists.and_then(|(a, b)| {
            let count = a.mean_squares.len() as f64;
            let pairs = || a.mean_squares.iter().zip(&b.mean_squares).map(|(a, b)| a - b);
            let mean = pairs().sum::<f64>() / count;
            let squares: f64 = pairs().map(|d| (d - mean) * (d - mean)).sum();
            let same = a.mean_squares.len() == b.mean_squares.len() && count > 1.0;
            same.then(|| [mean, (squares / (count - 1.0) / count).sqrt()])
        });
        Self {
            difference: a.criterion - b.criterion,
            folds,
        }
    }

    /// Whether the points do not tell the models apart: by the criterion, or by the folds. Neither is then preferred.
    pub fn is_indistinguishable(&self) -> bool {
        let folds = self.folds.is_some_and(|[mean, error]| mean.abs() <= ERRORS * error);
        self.difference.abs() < DIFFERENCE || folds
    }

    /// What there is to say of two models with these names.
    pub fn words(&self, first: &str, second: &str) -> String {
        let far = self.difference.abs() >= DIFFERENCE;
        if self.is_indistinguishable() && !far {
            return format!("the points do not tell {first} and {second} apart");
        }
        let [better, other] = if self.difference < 0.0 {
            [first, second]
        } else {
            [second, first]
        };
        if self.is_indistinguishable() {
            return format!(
                "{better} describes the points better than {other}, but does not predict bands of torque that were left out better"
            );
        }
        format!("{better} describes the points better than {other}")
    }
}

/// Places of models in the order in which they are shown: first those that cannot be told from the best, the fewest parameters
/// before, then the others, the best before.
pub fn ranking(models: &[FittedModel]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..models.len()).collect();
    order.sort_by(|a, b| models[*a].criterion.total_cmp(&models[*b].criterion));
    let Some(best) = order.first().copied() else {
        return order;
    };
    let alike = |i: &usize| *i == best || Comparison::of(&models[*i], &models[best]).is_indistinguishable();
    let (mut first, rest): (Vec<usize>, Vec<usize>) = order.into_iter().partition(alike);
    first.sort_by_key(|i| models[*i].parameters);
    first.extend(rest);
    first
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn model(name: &str, parameters: usize, criterion: f64, folds: Option<&[f64]>) -> FittedModel {
        let validation = folds.map(|m| Validation {
            mean_squares: m.to_vec(),
            rms: 1.0,
        });
        FittedModel {
            name: name.to_owned(),
            parameters,
            criterion,
            validation,
        }
    }

    #[test]
    fn check_7_4_criteria() {
        // Printed with six places.
        let near = |squares: f64, parameters: usize, y: f64| {
            assert!((akaike(squares, 440, parameters, Accuracy::Given).unwrap() - y).abs() < 1e-6);
        };
        near(468.403446, 8, 484.737553);
        near(470.851687, 7, 485.110947);
        near(471.470102, 7, 485.729361);
        near(468.488149, 7, 482.747409);
    }

    #[test]
    fn criteria_need_points() {
        assert_eq!(akaike(1.0, 9, 8, Accuracy::Given), None);
        assert!(akaike(1.0, 10, 8, Accuracy::Given).is_some());
        assert_eq!(akaike(1.0, 10, 8, Accuracy::Estimated), None);
        assert_eq!(akaike(0.0, 20, 8, Accuracy::Estimated), None);
        // m ln(RSS/m) + 2 (k + 1) + 2 (k + 1) (k + 2)/(m - k - 2).
        assert!((akaike(10.0, 10, 2, Accuracy::Estimated).unwrap() - 10.0).abs() < 1e-12);
    }

    #[test]
    fn models_are_told_apart_only_by_criterion_and_folds() {
        let a = model("a", 8, 100.0, Some(&[1.0, 1.1, 1.2]));
        let near = model("b", 7, 103.0, None);
        let far = model("c", 5, 200.0, Some(&[5.0, 5.1, 5.3]));
        let scattered = model("d", 6, 200.0, Some(&[0.5, 9.0, 0.7]));
        assert!(Comparison::of(&a, &near).is_indistinguishable());
        assert!(!Comparison::of(&a, &far).is_indistinguishable());
        assert!(Comparison::of(&a, &scattered).is_indistinguishable());
        assert_eq!(
            Comparison::of(&far, &a).words("c", "a"),
            "a describes the points better than c"
        );
        assert!(Comparison::of(&a, &near).words("a", "b").contains("do not tell"));
        let both = Comparison::of(&a, &scattered).words("a", "d");
        assert!(both.starts_with("a describes the points better than d, but"), "{both}");
        assert_eq!(ranking(&[a, near, far, scattered]), [3, 1, 0, 2]);
        assert!(ranking(&[]).is_empty());
    }
}
