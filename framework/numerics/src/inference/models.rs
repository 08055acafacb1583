//! Comparison of models fitted to the same points with the same accuracies.
//!
//! A comparison has three results: better, worse, undecided. If there are folds, they decide, because they are predictions: the errors are
//! paired fold by fold ([`Paired`]), and the set of points must be able to distinguish the models ([`Separation`]). Akaike's criterion
//! decides only if there are no folds and both models reproduce the points: it assumes independent residuals and a correct accuracy, and
//! with a wrong model shape even differences of hundreds are meaningless. If criterion and folds contradict each other, the comparison is
//! undecided, and the sentence reports it.
//!
//! Sources: Hurvich, Tsai, Biometrika 76 (1989) 297-307; Burnham, Anderson: Model Selection and Multimodel Inference (Springer 2002). The
//! limit below which the criterion does not distinguish two models is their convention.

use super::separation::{ErrorModel, PointSet, Separation};
use super::{Accuracy, Decision, Paired, Validation};

/// Difference of the criteria below which models are not distinguished.
const DIFFERENCE: f64 = 4.0;
/// Root mean square of a fold, relative to the accuracy, below which errors count as equal. An assumption.
pub const FLOOR: f64 = 0.01;

/// Akaike's criterion, corrected for small samples. `parameters` includes parameters at a bound.
///
/// With given accuracies `squares` is the sum of squares in units of the standard uncertainties; with estimated accuracies any sum of
/// squares of the points, whose scale then counts as an additional parameter. Absent if there are too few points, or the sum has no
/// logarithm.
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
    /// Residuals of the points of the set over their standard deviation.
    pub residuals: Vec<f64>,
    /// Standard deviation of residuals that is used as the accuracy: one if accuracies are given.
    pub scatter: f64,
    /// Whether residuals contradict the model: lack of fit, or correlated neighbours.
    pub is_suspect: bool,
}

impl FittedModel {
    /// Residuals in units of the accuracy, given or estimated.
    fn scaled(&self) -> Vec<f64> {
        self.residuals.iter().map(|r| r / self.scatter).collect()
    }
}

/// Reason of the decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// The interval of the ratio of the errors of the folds excludes one.
    Folds,
    /// The interval contains one.
    FoldsUndecided,
    /// The folds decide, but the set of points cannot distinguish the predictions.
    TooClose,
    /// The folds decide, but errors common to all points could reverse the decision.
    CommonErrors,
    /// Folds and criterion contradict each other.
    Contradiction,
    /// There are no folds, and the criterion decides.
    Criterion,
    /// There are no folds, and the difference of the criteria is too small.
    CriterionUndecided,
    /// There are no folds, and the residuals of a model violate the assumptions of the criterion.
    Suspect,
}

impl Reason {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Folds => "folds",
            Self::FoldsUndecided => "folds_undecided",
            Self::TooClose => "too_close",
            Self::CommonErrors => "common_errors",
            Self::Contradiction => "contradiction",
            Self::Criterion => "criterion",
            Self::CriterionUndecided => "criterion_undecided",
            Self::Suspect => "residuals_suspect",
        }
    }
}

/// Comparison of two models.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Criterion of the first minus that of the second.
    pub difference: f64,
    /// Errors of the folds; absent unless both were validated on the same number of folds, at least two.
    pub folds: Option<Paired>,
    /// Separation of the predictions; absent without residuals of the same points.
    pub separation: Option<Separation>,
    /// Whether the first is better.
    pub decision: Decision,
    /// Why.
    pub reason: Reason,
}

impl Comparison {
    /// Compares two models.
    pub fn new(a: &FittedModel, b: &FittedModel, points: &PointSet) -> Self {
        let difference = a.criterion - b.criterion;
        let lists = a.validation.as_ref().zip(b.validation.as_ref());
        let floor = FLOOR * a.scatter.min(b.scatter);
        let folds = lists.and_then(|(a, b)| Paired::from_folds(&a.mean_squares, &b.mean_squares, floor));
        let separation = separation(a, b, points);
        let of_criterion = match difference {
            d if d <= -DIFFERENCE => Decision::Better,
            d if d >= DIFFERENCE => Decision::Worse,
            _ => Decision::NotDecided,
        };
        let (decision, reason) = match folds.map(|folds| folds.decision()) {
            Some(Decision::NotDecided) => (Decision::NotDecided, Reason::FoldsUndecided),
            Some(found) if ![found, Decision::NotDecided].contains(&of_criterion) => {
                (Decision::NotDecided, Reason::Contradiction)
            }
            Some(_) if separation.is_some_and(|s| !s.is_visible()) => (Decision::NotDecided, Reason::TooClose),
            Some(found) if separation.is_some_and(|s| !s.supports(found)) => {
                (Decision::NotDecided, Reason::CommonErrors)
            }
            Some(found) => (found, Reason::Folds),
            None if of_criterion == Decision::NotDecided => (Decision::NotDecided, Reason::CriterionUndecided),
            None if a.is_suspect || b.is_suspect => (Decision::NotDecided, Reason::Suspect),
            None => (of_criterion, Reason::Criterion),
        };
        Self {
            difference,
            folds,
            separation,
            decision,
            reason,
        }
    }

    /// The result for two models with these names, as a clause.
    pub fn words(&self, first: &str, second: &str) -> String {
        let [better, other] = match self.decision {
            Decision::Worse => [second, first],
            Decision::Better | Decision::NotDecided => [first, second],
        };
        let turned = self.folds.is_some_and(|folds| folds.ratio > 1.0);
        let smaller = if turned { second } else { first };
        let folds = self
            .folds
            .map_or_else(String::new, |folds| folds_in_words(&folds, smaller));
        let [lower, higher] = if self.difference < 0.0 {
            [first, second]
        } else {
            [second, first]
        };
        let gap = self.difference.abs();
        match self.reason {
            Reason::Folds => format!("{better} predicts left-out points better than {other}: {folds}"),
            Reason::FoldsUndecided if gap >= DIFFERENCE => format!(
                "undecided between {first} and {second}: {folds}; Akaike's criterion is lower by {gap:.1} for {lower}, but a \
                 better fit to the fitted points does not imply better predictions"
            ),
            Reason::FoldsUndecided => format!("undecided between {first} and {second}: {folds}"),
            Reason::TooClose => format!(
                "undecided between {first} and {second}: {folds}, but their predictions differ by {:.1} standard deviations of the whole \
                 set of points, less than the required {:.1} (correlation of the errors {:.2})",
                self.separation.map_or(0.0, |s| s.square.sqrt()),
                super::separation::VISIBLE.sqrt(),
                self.separation.map_or(0.0, |s| s.correlation),
            ),
            Reason::CommonErrors => format!(
                "undecided between {first} and {second}: {folds}, but errors common to all points could be the reason (correlation \
                 of the errors {:.2})",
                self.separation.map_or(0.0, |s| s.correlation),
            ),
            Reason::Contradiction => format!(
                "undecided between {first} and {second}: two measures contradict each other, {folds}, but Akaike's criterion is lower \
                 by {gap:.1} for {lower} than for {higher}"
            ),
            Reason::Criterion => {
                format!("{better} describes the points better than {other}: Akaike's criterion is lower by {gap:.1}")
            }
            Reason::CriterionUndecided => format!(
                "undecided between {first} and {second}: Akaike's criterion differs by {gap:.1}, and there is no cross-validation"
            ),
            Reason::Suspect => format!(
                "undecided between {first} and {second}: Akaike's criterion is lower by {gap:.1} for {lower}, but it is not \
                 valid if residuals are correlated or larger than the accuracy; use cross-validation instead"
            ),
        }
    }
}

/// The ratio of the folds as text, for the model with the smaller errors.
fn folds_in_words(folds: &Paired, smaller: &str) -> String {
    let (ratio, [low, high], won) = if folds.ratio > 1.0 {
        let [low, high] = folds.interval;
        (1.0 / folds.ratio, [1.0 / high, 1.0 / low], folds.folds - folds.won)
    } else {
        (folds.ratio, folds.interval, folds.won)
    };
    format!(
        "errors of {smaller} are {ratio:.2} times as large (95 % {low:.2} to {high:.2}) and smaller in {won} of {} bands",
        folds.folds
    )
}

/// Separation of the predictions. If accuracies are given, the errors are those of the model with the smaller residuals; if they are
/// estimated from the scatter, common errors cannot be distinguished from model errors, and the larger correlation is used.
fn separation(a: &FittedModel, b: &FittedModel, points: &PointSet) -> Option<Separation> {
    let [first, second] = [a, b].map(FittedModel::scaled);
    if first.is_empty() || first.len() != second.len() {
        return None;
    }
    let square = |list: &[f64]| list.iter().map(|r| r * r).sum::<f64>();
    let [of_first, of_second] = [&first, &second].map(|list| ErrorModel::estimated(list, points));
    let errors = if (a.scatter, b.scatter) == (1.0, 1.0) {
        if square(&first) <= square(&second) {
            of_first
        } else {
            of_second
        }
    } else {
        let all = [of_first, of_second].into_iter().flatten();
        all.max_by(|a, b| a.correlation.total_cmp(&b.correlation))
    };
    let scatter = a.scatter.min(b.scatter);
    let in_one_unit = |model: &FittedModel| model.residuals.iter().map(|r| r / scatter).collect::<Vec<f64>>();
    Some(Separation::new([&in_one_unit(a), &in_one_unit(b)], &errors?))
}

/// Indices of models in display order: first those that are not significantly worse than the best, by number of parameters, then the
/// others. The best has the smallest prediction error, or the smallest criterion without predictions.
pub fn ranking(models: &[FittedModel], points: &PointSet) -> Vec<usize> {
    let mut order: Vec<usize> = (0..models.len()).collect();
    let validated = models.iter().all(|model| model.validation.is_some());
    let error = |i: usize| match &models[i].validation {
        Some(validation) if validated => validation.rms,
        _ => models[i].criterion,
    };
    order.sort_by(|a, b| error(*a).total_cmp(&error(*b)));
    let Some(best) = order.first().copied() else {
        return order;
    };
    let alike =
        |i: &usize| *i == best || Comparison::new(&models[best], &models[*i], points).decision != Decision::Better;
    let (mut first, rest): (Vec<usize>, Vec<usize>) = order.into_iter().partition(alike);
    first.sort_by_key(|i| models[*i].parameters);
    first.extend(rest);
    first
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn model(name: &str, parameters: usize, criterion: f64, rms: Option<&[f64]>) -> FittedModel {
        let squares = |list: &[f64]| list.iter().map(|x| x * x).collect::<Vec<f64>>();
        let validation = rms.map(|list| Validation {
            rms: (squares(list).iter().sum::<f64>() / list.len() as f64).sqrt(),
            mean_squares: squares(list),
            errors: list.to_vec(),
        });
        FittedModel {
            name: name.to_owned(),
            parameters,
            criterion,
            validation,
            residuals: Vec::new(),
            scatter: 1.0,
            is_suspect: false,
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

    /// Fold errors of two sets on a map of an electric vehicle's reducer; one wins every fold.
    const WINS: [f64; 5] = [1.76, 1.13, 2.35, 0.95, 1.72];
    const LOSES: [f64; 5] = [3.95, 4.93, 18.5, 5.2, 4.3];

    #[test]
    fn a_set_that_wins_every_fold_predicts_better() {
        let [a, b] = [model("a", 7, 300.0, Some(&WINS)), model("b", 7, 2000.0, Some(&LOSES))];
        let found = Comparison::new(&a, &b, &PointSet::default());
        assert_eq!((found.decision, found.reason), (Decision::Better, Reason::Folds));
        let words = "a predicts left-out points better than b: errors of a are 0.25 times as large (95 % 0.13 to 0.48) and smaller in 5 of 5 bands";
        assert_eq!(found.words("a", "b"), words);
        let turned = Comparison::new(&b, &a, &PointSet::default());
        assert_eq!(
            (turned.decision, turned.words("b", "a").as_str()),
            (Decision::Worse, words)
        );
        assert_eq!(ranking(&[b, a], &PointSet::default()), [1, 0]);
    }

    #[test]
    fn contradictions_decide_nothing_and_are_said() {
        let [a, b] = [model("a", 7, 2000.0, Some(&WINS)), model("b", 7, 300.0, Some(&LOSES))];
        let found = Comparison::new(&a, &b, &PointSet::default());
        assert_eq!(
            (found.decision, found.reason),
            (Decision::NotDecided, Reason::Contradiction)
        );
        assert!(
            found.words("a", "b").contains("contradict"),
            "{}",
            found.words("a", "b")
        );
        // A difference that the criterion does not see contradicts nothing.
        let near = model("b", 7, 1998.0, Some(&LOSES));
        assert_eq!(
            Comparison::new(&a, &near, &PointSet::default()).decision,
            Decision::Better
        );
    }

    #[test]
    fn without_folds_the_criterion_decides_where_it_holds() {
        let [a, near, far] = [100.0, 103.0, 200.0].map(|criterion| model("x", 5, criterion, None));
        assert_eq!(
            Comparison::new(&a, &near, &PointSet::default()).reason,
            Reason::CriterionUndecided
        );
        assert_eq!(
            Comparison::new(&a, &far, &PointSet::default()).decision,
            Decision::Better
        );
        assert_eq!(
            Comparison::new(&far, &a, &PointSet::default()).decision,
            Decision::Worse
        );
        let wrong = FittedModel {
            is_suspect: true,
            ..far
        };
        let found = Comparison::new(&a, &wrong, &PointSet::default());
        assert_eq!((found.decision, found.reason), (Decision::NotDecided, Reason::Suspect));
    }

    #[test]
    fn predictions_nearer_than_the_accuracy_of_the_set_are_not_decided() {
        let points = 30;
        let set = PointSet {
            cells: (0..points / 3).map(|k| (3 * k..3 * k + 3).collect()).collect(),
            shapes: vec![vec![1.0; points]],
        };
        let with = |mut model: FittedModel, shift: f64| {
            // Scatter of a tenth of what is stated: the rest is common to all points.
            model.residuals = (0..points).map(|i| 0.1 * ((i % 3) as f64 - 1.0) + shift).collect();
            model
        };
        let a = with(model("a", 7, 300.0, Some(&[0.1, 0.1, 0.11])), 0.0);
        let b = with(model("b", 7, 350.0, Some(&[0.9, 1.0, 1.1])), 1.0);
        let found = Comparison::new(&a, &b, &set);
        assert_eq!((found.decision, found.reason), (Decision::NotDecided, Reason::TooClose));
        assert!(found.words("a", "b").contains("standard deviations of the whole"));
        let far = with(model("c", 7, 900.0, Some(&[4.9, 5.0, 5.1])), 5.0);
        assert_eq!(Comparison::new(&a, &far, &set).decision, Decision::Better);
    }

    #[test]
    fn models_that_are_not_worse_than_the_best_come_first() {
        let a = model("a", 8, 100.0, Some(&[1.0, 1.1, 1.2]));
        let far = model("c", 5, 200.0, Some(&[5.0, 5.1, 5.3]));
        let scattered = model("d", 6, 200.0, Some(&[0.5, 9.0, 0.7]));
        assert_eq!(ranking(&[far, a, scattered], &PointSet::default()), [2, 1, 0]);
        assert!(ranking(&[], &PointSet::default()).is_empty());
    }
}
