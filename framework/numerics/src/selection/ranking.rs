//! Cross-validated errors of combinations.

use rayon::prelude::*;

use super::{Losses, MeasuredLosses};
use crate::least_squares::bounded_linear;
use crate::statistics::Statistics;

/// Distance from a bound, relative to the range, below which a factor is at it.
const ON_BOUND: f64 = 1e-9;

/// Lower and upper bound of the factors on the losses of the mechanisms; without bounds every factor is one.
pub type Bounds = Option<[f64; 2]>;

/// Errors of one combination.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination {
    /// Index of the candidate of each mechanism.
    pub places: Vec<usize>,
    /// Factor on the loss of each mechanism, fitted to all points; one without a fit. \[-\]
    pub factors: Vec<f64>,
    /// Mechanisms whose factor is at a bound.
    pub on_bound: Vec<usize>,
    /// Mean square of the predicted residuals of each fold with a valid point. \[-\]
    pub mean_squares: Vec<f64>,
    /// Root mean square of all residuals, each predicted with factors fitted to the other folds, relative to the accuracy. \[-\]
    pub predicted: f64,
    /// Errors in the printed unit; absent if no point has one.
    pub printed: Option<Printed>,
}

/// Errors in the printed unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Printed {
    /// Root mean square of the predicted errors.
    pub predicted: f64,
    /// The same of the worst fold.
    pub worst: f64,
    /// Root mean square of the errors with factors fitted to all points.
    pub fitted: f64,
    /// Their mean.
    pub mean: f64,
}

/// The factors of a combination fitted to some of the points.
fn factors(
    losses: &Losses<'_>,
    measured: &MeasuredLosses,
    bounds: Bounds,
    places: &[usize],
    rows: &[usize],
) -> Option<Vec<f64>> {
    let Some(bounds) = bounds else {
        return Some(vec![1.0; places.len()]);
    };
    let scale = |i: usize| measured.weights[i].max(0.0).sqrt() / measured.deviations[i];
    let column =
        |(mechanism, place): (&Vec<&[f64]>, &usize)| rows.iter().map(|i| mechanism[*place][*i] * scale(*i)).collect();
    let columns: Vec<Vec<f64>> = losses.mechanisms.iter().zip(places).map(column).collect();
    let target: Vec<f64> = rows
        .iter()
        .map(|i| (measured.losses[*i] - losses.rest[*i]) * scale(*i))
        .collect();
    bounded_linear(&columns, &target, &vec![bounds; places.len()])
}

/// Losses of a combination, each point predicted with factors fitted to the other folds. \[W\]
fn predictions(losses: &Losses<'_>, measured: &MeasuredLosses, bounds: Bounds, places: &[usize]) -> Option<Vec<f64>> {
    let mut predicted = vec![f64::NAN; measured.len()];
    for fold in &measured.folds {
        let others: Vec<usize> = match bounds {
            Some(_) => (0..measured.len()).filter(|i| !fold.contains(i)).collect(),
            None => Vec::new(),
        };
        let factors = factors(losses, measured, bounds, places, &others)?;
        for i in fold {
            predicted[*i] = losses.loss(places, &factors, *i);
        }
    }
    predicted.iter().all(|loss| loss.is_finite()).then_some(predicted)
}

/// Cross-validates one combination. Absent if its factors cannot be fitted, or there is no valid point.
pub fn validate(
    losses: &Losses<'_>,
    measured: &MeasuredLosses,
    bounds: Bounds,
    places: Vec<usize>,
) -> Option<Combination> {
    let all: Vec<usize> = (0..measured.len()).collect();
    let factors = factors(losses, measured, bounds, &places, &all)?;
    let fitted = losses.of_combination(&places, &factors);
    let predicted = predictions(losses, measured, bounds, &places)?;
    let residuals = measured.residuals(&predicted);
    let weighted = |rows: &[usize]| Statistics::weighted(rows.iter().map(|i| (residuals[*i], measured.weights[*i])));
    let squares = measured
        .folds
        .iter()
        .filter_map(|fold| weighted(fold).map(|s| s.rms * s.rms));
    let on_bound = bounds.map_or_else(Vec::new, |[low, high]| {
        let near = |f: f64| (f - low).min(high - f) <= ON_BOUND * (high - low);
        (0..factors.len()).filter(|k| near(factors[*k])).collect()
    });
    let printed = |list: &[f64], rows: &[usize]| {
        let error = |i: &usize| {
            Some((
                measured.units[*i]? * (list[*i] - measured.losses[*i]),
                measured.weights[*i],
            ))
        };
        Statistics::weighted(rows.iter().filter_map(error))
    };
    let worst = measured
        .folds
        .iter()
        .filter_map(|fold| printed(&predicted, fold))
        .map(|s| s.rms);
    let worst = worst.fold(0.0, f64::max);
    let whole = printed(&predicted, &all).zip(printed(&fitted, &all));
    Some(Combination {
        mean_squares: squares.collect(),
        predicted: weighted(&all)?.rms,
        printed: whole.map(|(predicted, fitted)| Printed {
            predicted: predicted.rms,
            worst,
            fitted: fitted.rms,
            mean: fitted.mean,
        }),
        places,
        factors,
        on_bound,
    })
}

/// All combinations that can be fitted, sorted by predicted error. `going` is called before each combination and can stop the work.
pub fn rank(
    losses: &Losses<'_>,
    measured: &MeasuredLosses,
    bounds: Bounds,
    going: &(dyn Fn() -> bool + Sync),
) -> Vec<Combination> {
    let numbers = (0..losses.count()).into_par_iter();
    let all = numbers.filter_map(|number| {
        going()
            .then(|| validate(losses, measured, bounds, losses.combination(number)))
            .flatten()
    });
    let mut all: Vec<Combination> = all.collect();
    all.sort_by(|a, b| a.predicted.total_cmp(&b.predicted));
    all
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::inference::PointSet;

    /// Losses over 4 torques and 6 speeds: `[load, drag, load of another shape]`.
    pub fn shapes() -> [Vec<f64>; 3] {
        let points = || (1..=4).flat_map(|t| (1..=6).map(move |w| (f64::from(t), f64::from(w))));
        [
            points().map(|(t, w)| 10.0 * t * w).collect(),
            points().map(|(_, w)| 2.0 * w * w).collect(),
            points().map(|(t, w)| 6.0 * t * t * w).collect(),
        ]
    }

    pub fn measured(losses: Vec<f64>, deviation: f64) -> MeasuredLosses {
        let count = losses.len();
        MeasuredLosses {
            deviations: vec![deviation; count],
            weights: vec![1.0; count],
            units: vec![Some(1.0); count],
            folds: (0..4).map(|k| (6 * k..6 * k + 6).collect()).collect(),
            points: PointSet {
                cells: (0..count / 3).map(|k| (3 * k..3 * k + 3).collect()).collect(),
                shapes: vec![vec![1.0; count]],
            },
            losses,
        }
    }

    #[test]
    fn the_shape_that_made_the_points_wins() {
        let [load, drag, other] = shapes();
        let truth: Vec<f64> = load.iter().zip(&drag).map(|(a, b)| 1.2 * a + 0.8 * b).collect();
        let measured = measured(truth, 1.0);
        let rest = vec![0.0; load.len()];
        let losses = Losses {
            rest: &rest,
            mechanisms: vec![vec![other.as_slice(), load.as_slice()], vec![drag.as_slice()]],
        };
        assert_eq!((losses.count(), losses.combination(1)), (2, vec![1, 0]));
        let ranked = rank(&losses, &measured, Some([0.5, 2.0]), &|| true);
        assert_eq!(ranked[0].places, [1, 0]);
        assert!(ranked[0].predicted < 1e-9 && (ranked[0].factors[0] - 1.2).abs() < 1e-9);
        assert!(ranked[0].on_bound.is_empty() && ranked[1].predicted > 1.0);
        let bounded = rank(&losses, &measured, Some([0.5, 1.1]), &|| true);
        assert_eq!(bounded[0].on_bound, [0]);
        let plain = rank(&losses, &measured, None, &|| true);
        assert_eq!(plain[0].factors, [1.0, 1.0]);
        assert!(rank(&losses, &measured, None, &|| false).is_empty());
    }

    #[test]
    fn points_without_the_printed_quantity_still_count() {
        let [load, drag, _] = shapes();
        let mut measured = measured(load.iter().map(|x| x + 3.0).collect(), 2.0);
        measured.units = (0..load.len()).map(|i| (i > 5).then_some(0.1)).collect();
        let rest = drag.iter().map(|_| 0.0).collect::<Vec<f64>>();
        let losses = Losses {
            rest: &rest,
            mechanisms: vec![vec![load.as_slice()]],
        };
        let found = validate(&losses, &measured, None, vec![0]).unwrap();
        assert!((found.predicted - 1.5).abs() < 1e-12);
        let printed = found.printed.unwrap();
        assert!((printed.predicted - 0.3).abs() < 1e-12 && (printed.mean + 0.3).abs() < 1e-12);
        measured.units = vec![None; load.len()];
        assert_eq!(validate(&losses, &measured, None, vec![0]).unwrap().printed, None);
    }
}
