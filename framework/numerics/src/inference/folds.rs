//! Cross-validation by blocks of neighbouring points, or by other groups.
//!
//! Points are not left out singly: neighbours are correlated and would reveal the result (Roberts et al., Ecography 40 (2017) 913-929).

use crate::sampling::Generator;
use crate::statistics::levels;

/// Default number of folds.
pub const FOLDS: usize = 5;
/// Ratio of the error of a fold to that of the fit above which a model does not extrapolate.
const EXTRAPOLATES: f64 = 1.5;

/// Points that are left out together.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// Common property of its points if it is not a band.
    pub label: Option<String>,
    /// Minimum and maximum of the coordinate; absent for groups by labels or random groups.
    pub band: Option<[f64; 2]>,
    /// Indices of the points, ascending.
    pub points: Vec<usize>,
}

/// Folds of neighbouring values of a coordinate, usually torque: `most` folds, or one for each value if there are fewer. Values within two
/// percent are considered equal.
///
/// # Errors
/// If there are fewer than two values or folds, or a value is not finite.
pub fn folds(coordinate: &[f64], most: usize) -> Result<Vec<Fold>, String> {
    if let Some(bad) = coordinate.iter().find(|x| !x.is_finite()) {
        return Err(format!("{bad} has no neighbours"));
    }
    let levels = levels(coordinate);
    let count = most.min(levels.len());
    if count < 2 {
        return Err(format!(
            "{} values in {most} folds: cross-validation needs at least two of both",
            levels.len()
        ));
    }
    let fold = |k: usize| {
        let mut points = levels[k * levels.len() / count..(k + 1) * levels.len() / count].concat();
        let ends = [points[0], points[points.len() - 1]].map(|i| coordinate[i]);
        points.sort_unstable();
        Fold {
            label: None,
            band: Some(ends),
            points,
        }
    };
    Ok((0..count).map(fold).collect())
}

/// A fold for each label, in the order of their first points.
///
/// # Errors
/// If there are fewer than two labels.
pub fn labelled_folds(labels: &[String]) -> Result<Vec<Fold>, String> {
    let mut folds: Vec<Fold> = Vec::new();
    for (i, label) in labels.iter().enumerate() {
        match folds.iter_mut().find(|fold| fold.label.as_ref() == Some(label)) {
            Some(fold) => fold.points.push(i),
            None => folds.push(Fold {
                label: Some(label.clone()),
                band: None,
                points: vec![i],
            }),
        }
    }
    match folds.as_slice() {
        [] => Err("there are no points".to_owned()),
        [only] => {
            let label = only.label.as_deref().unwrap_or_default();
            Err(format!(
                "all points belong to one group, `{label}`: cross-validation needs at least two"
            ))
        }
        _ => Ok(folds),
    }
}

/// Random folds, determined by the seed. Points of one row, which share the errors of its instruments, stay together.
///
/// Errors of neighbouring points are correlated. A random fold has fitted neighbours on all sides, so its error describes interpolation
/// only and is too optimistic for extrapolation (Roberts et al. 2017).
///
/// # Errors
/// If there are fewer than two rows or folds.
pub fn random_folds(rows: &[usize], most: usize, seed: u64) -> Result<Vec<Fold>, String> {
    let mut order = rows.to_vec();
    order.sort_unstable();
    order.dedup();
    let count = most.min(order.len());
    if count < 2 {
        return Err(format!(
            "{} rows in {most} folds: cross-validation needs at least two of both",
            order.len()
        ));
    }
    Generator::new(seed).shuffle(&mut order);
    let fold = |k: usize| {
        let groups: Vec<usize> = order.iter().skip(k).step_by(count).copied().collect();
        Fold {
            label: Some(format!("random group {}", k + 1)),
            band: None,
            points: (0..rows.len()).filter(|i| groups.contains(&rows[*i])).collect(),
        }
    };
    Ok((0..count).map(fold).collect())
}

/// Errors of predictions over folds, in units of the standard uncertainty of the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Validation {
    /// Mean square of each fold.
    pub mean_squares: Vec<f64>,
    /// Root mean square over all points.
    pub rms: f64,
    /// Error of each point.
    pub errors: Vec<f64>,
}

impl Validation {
    /// From the error of each point, calculated with the parameters fitted without its fold. Absent if a fold is empty or contains an
    /// unknown point.
    pub fn new(folds: &[Fold], errors: &[f64]) -> Option<Self> {
        let sum = |fold: &Fold| -> Option<f64> {
            let list = fold.points.iter().map(|i| errors.get(*i).map(|e| e * e));
            list.sum::<Option<f64>>().filter(|_| !fold.points.is_empty())
        };
        let sums = folds.iter().map(sum).collect::<Option<Vec<f64>>>()?;
        let count: usize = folds.iter().map(|f| f.points.len()).sum();
        (count > 0).then(|| Self {
            mean_squares: sums
                .iter()
                .zip(folds)
                .map(|(sum, fold)| sum / fold.points.len() as f64)
                .collect(),
            rms: (sums.iter().sum::<f64>() / count as f64).sqrt(),
            errors: errors.to_vec(),
        })
    }

    /// Root mean square of each fold.
    pub fn fold_rms(&self) -> Vec<f64> {
        self.mean_squares.iter().map(|m| m.sqrt()).collect()
    }

    /// Indices of the folds to which the model does not extrapolate, given the root mean square of the whole fit.
    pub fn strange(&self, in_sample: f64) -> Vec<usize> {
        let rms = self.fold_rms();
        (0..rms.len()).filter(|k| rms[*k] > EXTRAPOLATES * in_sample).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn neighbouring_values_stay_together() {
        let torque = [20.0, 2.0, 6.0, 4.0, 2.001, 8.0];
        let folds = folds(&torque, 2).unwrap();
        assert_eq!(folds[0].points, [1, 3, 4]);
        assert_eq!((folds[0].band, folds[1].band), (Some([2.0, 4.0]), Some([6.0, 20.0])));
        assert_eq!(folds[1].points, [0, 2, 5]);
    }

    #[test]
    fn errors_of_folds() {
        let folds = folds(&[1.0, 1.0, 2.0, 2.0], FOLDS).unwrap();
        let found = Validation::new(&folds, &[1.0, 1.0, 3.0, 4.0]).unwrap();
        assert_eq!(found.mean_squares, [1.0, 12.5]);
        assert!((found.rms - 6.75_f64.sqrt()).abs() < 1e-15);
        assert_eq!(found.strange(1.0), [1]);
        assert_eq!(Validation::new(&folds, &[1.0]), None);
        assert_eq!(Validation::new(&[], &[1.0]), None);
    }

    #[test]
    fn labels_and_lots_make_folds() {
        let labels = ["b", "a", "b", "c"].map(str::to_owned);
        let found = labelled_folds(&labels).unwrap();
        let points: Vec<(&str, &[usize])> = found
            .iter()
            .map(|f| (f.label.as_deref().unwrap(), f.points.as_slice()))
            .collect();
        assert_eq!(points, [("b", &[0, 2][..]), ("a", &[1]), ("c", &[3])]);
        assert!(labelled_folds(&labels[..1]).is_err() && labelled_folds(&[]).is_err());
        // Two numbers of each of seven rows: they stay together, and every row is left out once.
        let rows: Vec<usize> = (0..14).map(|i| i / 2).collect();
        let found = random_folds(&rows, 3, 1).unwrap();
        assert_eq!(found, random_folds(&rows, 3, 1).unwrap());
        assert_ne!(found, random_folds(&rows, 3, 2).unwrap());
        let mut all: Vec<usize> = found.iter().flat_map(|f| f.points.clone()).collect();
        all.sort_unstable();
        assert_eq!(all, (0..14).collect::<Vec<_>>());
        assert!(
            found
                .iter()
                .all(|f| f.points.chunks(2).all(|pair| pair[0] + 1 == pair[1]))
        );
        assert!(random_folds(&[0, 0], 3, 1).is_err() && random_folds(&rows, 1, 1).is_err());
    }

    #[test]
    fn what_cannot_be_folded_is_refused() {
        assert!(folds(&[1.0, 1.0], 5).is_err());
        assert!(folds(&[1.0, 2.0], 1).is_err());
        assert!(folds(&[], 5).is_err());
        assert!(folds(&[1.0, f64::NAN], 5).is_err());
    }

    proptest! {
        #[test]
        fn every_point_is_left_out_once(torque in proptest::collection::vec(0..30_i32, 2..60), most in 2..8_usize) {
            let coordinate: Vec<f64> = torque.iter().map(|t| f64::from(*t)).collect();
            if let Ok(folds) = folds(&coordinate, most) {
                let mut all: Vec<usize> = folds.iter().flat_map(|f| f.points.clone()).collect();
                all.sort_unstable();
                prop_assert_eq!(all, (0..coordinate.len()).collect::<Vec<_>>());
                prop_assert!(folds.len() <= most && folds.iter().all(|f| !f.points.is_empty()));
                prop_assert!(folds.windows(2).all(|w| w[0].band.unwrap()[1] < w[1].band.unwrap()[0]));
            }
        }
    }
}
