//! Two models compared fold by fold: ratio of their errors.
//!
//! Folds differ much more from each other than two models within a fold. Therefore the errors are paired: for each fold the logarithm of
//! the ratio of the two root mean square errors is one observation, and Student's interval of their mean decides whether the ratio differs
//! from one. Logarithms are used because errors of folds are positive and differ by factors: a mean difference of squares would be
//! dominated by the worst fold.
//!
//! If parameters are fitted, the folds share training data. Nadeau and Bengio (Machine Learning 52 (2003) 239-281) then replace the factor
//! 1/K of the variance of the mean by 1/K + n_test/n_train, which widens the interval of five folds by half. This applies to random splits
//! and flexible models. With bands of torque and a few bounded factors the plain interval keeps its level: it decides for fewer than 5 % of
//! pairs of equally wrong models (test `the_plain_interval_keeps_its_level`), and the correction would halve the number of correct
//! decisions. Therefore it is not used.

use schemars::JsonSchema;
use serde::Serialize;

use super::probability::student_quantile;

/// Confidence of the interval of a ratio.
const CONFIDENCE: f64 = 0.95;

/// Decision between two models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Decision {
    /// The first predicts better than the second.
    Better,
    /// The first predicts worse than the second.
    Worse,
    /// Undecided.
    NotDecided,
}

impl Decision {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Better => "better",
            Self::Worse => "worse",
            Self::NotDecided => "not_decided",
        }
    }
}

/// The errors of two models, fold by fold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paired {
    /// Geometric mean over the folds of the ratio of the errors, first over second.
    pub ratio: f64,
    /// 95 % interval of this ratio.
    pub interval: [f64; 2],
    /// Number of folds.
    pub folds: usize,
    /// Number of folds in which the first predicts better.
    pub won: usize,
}

impl Paired {
    /// From the mean squares of the folds, in the same order for both. Root mean squares below `floor` are replaced by it, because the
    /// measurement cannot resolve smaller errors.
    ///
    /// Absent unless both have the same number of folds, at least two, and the floor is positive.
    pub fn from_folds(first: &[f64], second: &[f64], floor: f64) -> Option<Self> {
        let count = first.len() as f64;
        let finite = first.iter().chain(second).all(|square| square.is_finite());
        if first.len() != second.len() || first.len() < 2 || floor <= 0.0 || !finite {
            return None;
        }
        let lowest = floor * floor;
        let logarithm = |(a, b): (&f64, &f64)| 0.5 * (a.max(lowest) / b.max(lowest)).ln();
        let ratios: Vec<f64> = first.iter().zip(second).map(logarithm).collect();
        let mean = ratios.iter().sum::<f64>() / count;
        let squares: f64 = ratios.iter().map(|d| (d - mean) * (d - mean)).sum();
        let error = (squares / (count - 1.0) / count).sqrt();
        let half = student_quantile(0.5 + 0.5 * CONFIDENCE, count - 1.0)? * error;
        let found = Self {
            ratio: mean.exp(),
            interval: [(mean - half).exp(), (mean + half).exp()],
            folds: first.len(),
            won: ratios.iter().filter(|d| **d < 0.0).count(),
        };
        (mean.is_finite() && half.is_finite()).then_some(found)
    }

    /// The decision: undecided if the interval contains one.
    pub fn decision(&self) -> Decision {
        match self.interval {
            [_, upper] if upper < 1.0 => Decision::Better,
            [lower, _] if lower > 1.0 => Decision::Worse,
            _ => Decision::NotDecided,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn squares(list: &[f64]) -> Vec<f64> {
        list.iter().map(|x| x * x).collect()
    }

    #[test]
    fn a_model_that_wins_every_fold_by_far_is_better() {
        let a = squares(&[1.76, 1.13, 2.35, 0.95, 1.72]);
        let b = squares(&[3.95, 4.93, 18.5, 5.2, 4.3]);
        let found = Paired::from_folds(&a, &b, 0.01).unwrap();
        assert_eq!((found.decision(), found.won, found.folds), (Decision::Better, 5, 5));
        assert!((found.ratio - 0.2485).abs() < 5e-4, "{found:?}");
        let turned = Paired::from_folds(&b, &a, 0.01).unwrap();
        assert_eq!((turned.decision(), turned.won), (Decision::Worse, 0));
        assert!((turned.ratio * found.ratio - 1.0).abs() < 1e-12);
        // ln of the ratios: mean -1.392, standard deviation 0.527; Student's 2.776 of four degrees of freedom.
        assert!(
            (found.interval[0] - 0.129).abs() < 2e-3 && (found.interval[1] - 0.478).abs() < 2e-3,
            "{found:?}"
        );
    }

    #[test]
    fn folds_that_disagree_decide_nothing() {
        let found = Paired::from_folds(&[1.0, 4.0, 1.0, 4.0], &[4.0, 1.0, 4.0, 1.1], 0.01).unwrap();
        assert_eq!((found.decision(), found.won), (Decision::NotDecided, 2));
    }

    #[test]
    fn errors_below_the_floor_are_equal() {
        let found = Paired::from_folds(&[0.0, 1e-12, 0.0], &[1e-9, 0.0, 1e-8], 0.01).unwrap();
        assert_eq!((found.ratio, found.decision()), (1.0, Decision::NotDecided));
    }

    #[test]
    fn too_little_is_no_comparison() {
        assert_eq!(Paired::from_folds(&[1.0], &[1.0], 0.01), None);
        assert_eq!(Paired::from_folds(&[1.0, 2.0], &[1.0], 0.01), None);
        assert_eq!(Paired::from_folds(&[1.0, 2.0], &[1.0, 1.0], 0.0), None);
        assert_eq!(Paired::from_folds(&[1.0, f64::NAN], &[1.0, f64::INFINITY], 0.01), None);
    }
}
