//! The winner of a ranking, and the combinations that are not distinguishable from it.

use super::{Combination, Losses, MeasuredLosses};
use crate::inference::{Decision, ErrorModel, FLOOR, Paired, Separation};

/// Comparison of one combination with another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Errors of the folds, first over second; absent with fewer than two folds with valid points.
    pub folds: Option<Paired>,
    /// Separation of the predictions.
    pub separation: Separation,
    /// Whether the first is better: the folds decide so, the set of points distinguishes the predictions, and common errors cannot be the
    /// reason.
    pub decision: Decision,
}

/// Compares two combinations.
pub fn compare_pair(
    [first, second]: [&Combination; 2],
    losses: &Losses<'_>,
    measured: &MeasuredLosses,
    errors: &ErrorModel,
) -> Standing {
    let folds = Paired::from_folds(&first.mean_squares, &second.mean_squares, FLOOR);
    let residuals =
        |c: &Combination| measured.weighted(&measured.residuals(&losses.of_combination(&c.places, &c.factors)));
    let separation = Separation::new([&residuals(first), &residuals(second)], errors);
    let found = folds.map_or(Decision::NotDecided, |folds| folds.decision());
    Standing {
        folds,
        separation,
        decision: if separation.is_visible() && separation.supports(found) {
            found
        } else {
            Decision::NotDecided
        },
    }
}

/// The outcome of a ranking.
#[derive(Debug, Clone, PartialEq)]
pub struct Winner {
    /// Index of the winner in the ranking: the best without a mark, unless the best of all is significantly better.
    pub place: usize,
    /// Index of the best combination without a mark; absent if all are marked.
    pub unmarked: Option<usize>,
    /// The best of all compared with the best without a mark; absent if they are the same, or all are marked.
    pub best_against_unmarked: Option<Standing>,
    /// The winner compared with every combination of the ranking.
    pub standings: Vec<Standing>,
    /// Errors of the measurement, with their correlation.
    pub errors: ErrorModel,
    /// Whether the correlation was estimated from the residuals of the best combination.
    pub is_estimated: bool,
}

/// Chooses the winner of a ranking. `correlation` is the correlation between the errors of any two points; if absent, it is estimated from
/// the residuals of the best combination. Absent if the ranking is empty.
pub fn winner(
    ranked: &[Combination],
    is_marked: &dyn Fn(&Combination) -> bool,
    losses: &Losses<'_>,
    measured: &MeasuredLosses,
    correlation: Option<f64>,
) -> Option<Winner> {
    let best = ranked.first()?;
    let fitted = losses.of_combination(&best.places, &best.factors);
    let estimated = || ErrorModel::estimated(&measured.weighted(&measured.residuals(&fitted)), &measured.points);
    // Without neighbours the correlation is unknown, and errors count as independent.
    let stated = |correlation: f64| ErrorModel::new(1.0, correlation, &measured.points.shapes);
    let errors = correlation.map_or_else(|| estimated().unwrap_or_else(|| stated(0.0)), stated);
    let unmarked = ranked.iter().position(|c| !is_marked(c));
    let against = |a: usize, b: usize| compare_pair([&ranked[a], &ranked[b]], losses, measured, &errors);
    let best_against_unmarked = unmarked.filter(|place| *place > 0).map(|place| against(0, place));
    let place = match (unmarked, best_against_unmarked) {
        (Some(place), Some(standing)) if standing.decision != Decision::Better => place,
        _ => 0,
    };
    Some(Winner {
        place,
        unmarked,
        best_against_unmarked,
        standings: (0..ranked.len()).map(|other| against(place, other)).collect(),
        errors,
        is_estimated: correlation.is_none(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::rank;
    use super::super::ranking::tests::{measured, shapes};
    use super::*;

    #[test]
    fn a_marked_combination_wins_only_where_it_is_decidedly_better() {
        let [load, drag, other] = shapes();
        let noise = |i: usize| [0.6, -0.9, 0.2, 0.8, -0.5, -0.3, 0.4][i % 7];
        let measured = measured(load.iter().enumerate().map(|(i, x)| x + noise(i)).collect(), 1.0);
        let near: Vec<f64> = load.iter().map(|x| x + 0.2).collect();
        let rest = vec![0.0; drag.len()];
        let losses = Losses {
            rest: &rest,
            mechanisms: vec![vec![load.as_slice(), near.as_slice(), other.as_slice()]],
        };
        let ranked = rank(&losses, &measured, None, &|| true);
        let order: Vec<usize> = ranked.iter().map(|c| c.places[0]).collect();
        assert_eq!(order, [0, 1, 2]);
        let chosen = |marked: &[usize]| {
            let is_marked = |c: &Combination| marked.contains(&c.places[0]);
            winner(&ranked, &is_marked, &losses, &measured, None).unwrap()
        };
        let found = chosen(&[]);
        assert_eq!(
            (found.place, found.unmarked, found.best_against_unmarked),
            (0, Some(0), None)
        );
        assert_eq!(found.standings[0].decision, Decision::NotDecided);
        assert_eq!(found.standings[2].decision, Decision::Better);
        // The near one is not distinguishable from the best, so the mark decides; the far one is.
        assert_eq!(chosen(&[0]).place, 1);
        let found = chosen(&[0, 1]);
        assert_eq!((found.place, found.unmarked), (0, Some(2)));
        assert_eq!(found.best_against_unmarked.unwrap().decision, Decision::Better);
        let found = chosen(&[0, 1, 2]);
        assert_eq!((found.place, found.unmarked), (0, None));
        assert_eq!(winner(&[], &|_| false, &losses, &measured, None), None);
    }
}
