//! Whether a set of points can see the difference between two models at all.
//!
//! Errors of a measurement are partly common to all points: a gain, an offset, a temperature that reads low. Averaging over many
//! points removes the independent part of the errors, not the common part. With the covariance matrix
//! S = v ((1 - rho) I + rho 1 1') of the errors, in units of the stated variance, the squared distance of the predictions of two models is
//! d^2 = delta' S^-1 delta with their difference delta, and in closed form (Sherman, Morrison)
//! d^2 = (|delta|^2 - rho (sum delta)^2 / (1 + (n - 1) rho)) / (v (1 - rho)).
//!
//! If one of the two models is right, the logarithm of their likelihood ratio is normal with mean d^2/2 and variance d^2, so that the
//! wrong one looks more likely with probability Phi(-d/2) (Kullback: Information Theory and Statistics, Wiley 1959, chapter 9). A set
//! of points is taken to see a difference where this is 5 % at most: d >= 2 * 1.645, d^2 >= 10.82.

use crate::analysis::bands;

/// Squared distance from which on a set of points sees a difference: (2 z)^2 with the 95 % quantile z = 1.644854 of the
/// normal distribution.
pub const VISIBLE: f64 = 10.822_175;
/// The largest correlation that is used. An assumption: a hundredth of the variance is always independent, so that points
/// without noise do not see differences of any size.
const LARGEST: f64 = 0.99;
/// Neighbouring points of a cell.
const CELL: usize = 3;
/// Temperatures of the oil that are farther apart belong to different cells. An assumption, as for lines of constant torque. \[K\]
const APART: f64 = 3.0;

/// Variance of the errors of points in units of their stated variance, and what of it is common to all points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorModel {
    /// Variance over the stated one. \[-\]
    pub variance: f64,
    /// Correlation between the errors of any two points, 0 to 0.99. \[-\]
    pub correlation: f64,
}

impl ErrorModel {
    /// The stated variance with a stated correlation.
    pub fn stated(correlation: f64) -> Self {
        Self {
            variance: 1.0,
            correlation: correlation.clamp(0.0, LARGEST),
        }
    }

    /// From residuals over their stated standard deviation, and cells of neighbouring points: the intraclass correlation about zero.
    ///
    /// The scatter within the cells is the independent part. The whole is the mean square of the residuals, but the
    /// stated variance at least: where points scatter less than was stated, what was stated must be common to them, whether a model happens to
    /// absorb it or not. Absent without a cell of two points, or where a residual is not finite.
    pub fn estimated(residuals: &[f64], cells: &[Vec<usize>]) -> Option<Self> {
        let (mut within, mut freedom) = (0.0, 0_usize);
        for cell in cells {
            let list = cell
                .iter()
                .map(|i| residuals.get(*i).copied())
                .collect::<Option<Vec<f64>>>()?;
            let mean = list.iter().sum::<f64>() / list.len().max(1) as f64;
            within += list.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>();
            freedom += list.len().saturating_sub(1);
        }
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let variance = (squares / residuals.len() as f64).max(1.0);
        let correlation = (1.0 - within / freedom as f64 / variance).clamp(0.0, LARGEST);
        (freedom > 0 && variance.is_finite() && correlation.is_finite()).then_some(Self { variance, correlation })
    }

    /// Square of errors in units of their stated standard deviations: their sum of squares where they are independent.
    pub fn square(&self, errors: &[f64]) -> f64 {
        let rho = self.correlation;
        let (mut squares, mut sum) = (0.0, 0.0);
        for e in errors {
            squares += e * e;
            sum += e;
        }
        let common = rho * sum * sum / (1.0 + (errors.len().max(1) - 1) as f64 * rho);
        (squares - common).max(0.0) / (self.variance * (1.0 - rho))
    }
}

/// How far apart the predictions of two models are for a set of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// Squared distance, d^2. \[-\]
    pub square: f64,
    /// The errors it is measured in.
    pub errors: ErrorModel,
}

impl Separation {
    /// From the difference of two predictions in units of the stated standard deviations.
    pub fn new(differences: &[f64], errors: ErrorModel) -> Self {
        Self {
            square: errors.square(differences),
            errors,
        }
    }

    /// Whether the set of points sees the difference.
    pub fn is_visible(&self) -> bool {
        self.square >= VISIBLE
    }
}

/// Cells of up to three points of neighbouring torque and speed: points of one temperature of the oil and in one band of torque, three
/// after three by speed. Zero stands for a temperature that is not known.
pub fn neighbours(torques: &[f64], speeds: &[f64], oils: &[f64]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..torques.len()).collect();
    order.sort_by(|a, b| oils[*a].total_cmp(&oils[*b]));
    let mut cells = Vec::new();
    for group in order.chunk_by(|a, b| oils[*b] - oils[*a] <= APART) {
        let own: Vec<f64> = group.iter().map(|i| torques[*i]).collect();
        for (_, band) in bands(&own) {
            let mut band: Vec<usize> = band.into_iter().map(|k| group[k]).collect();
            band.sort_by(|a, b| speeds[*a].total_cmp(&speeds[*b]));
            cells.extend(band.chunks(CELL).map(<[usize]>::to_vec));
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::inference::probability::normal_below;

    #[test]
    fn the_closed_form_is_that_of_the_matrix() {
        let delta = DVector::from_vec(vec![0.3, -1.2, 2.0, 0.7, 0.1]);
        for (variance, correlation) in [(1.0, 0.0), (1.0, 0.4), (2.5, 0.9)] {
            let identity = DMatrix::<f64>::identity(5, 5);
            let matrix = (identity * (1.0 - correlation)).add_scalar(correlation) * variance;
            let solved = matrix.lu().solve(&delta).unwrap();
            let found = ErrorModel { variance, correlation }.square(delta.as_slice());
            assert!((found - delta.dot(&solved)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_limit_is_an_error_of_one_in_twenty() {
        assert!((normal_below(-0.5 * VISIBLE.sqrt()).unwrap() - 0.05).abs() < 1e-7);
    }

    #[test]
    fn what_is_common_to_all_points_stays() {
        // 2 % everywhere against an accuracy of 1 % that is mostly common: a thousand points see no more than a few.
        let errors = ErrorModel::stated(0.9);
        let few = Separation::new(&[2.0; 5], errors);
        let many = Separation::new(&[2.0; 1000], errors);
        assert!(!few.is_visible() && !many.is_visible() && many.square < 1.1 * few.square);
        assert!(Separation::new(&[2.0; 5], ErrorModel::stated(0.0)).is_visible());
        // The same size with changing signs is seen.
        let shape: Vec<f64> = (0..10).map(|i| if i % 2 == 0 { 2.0 } else { -2.0 }).collect();
        assert!(Separation::new(&shape, errors).is_visible());
    }

    #[test]
    fn points_that_scatter_less_than_stated_share_the_rest() {
        let torques: Vec<f64> = (0..30).map(|i| f64::from(i / 6)).collect();
        let speeds: Vec<f64> = (0..30).map(|i| f64::from(i % 6)).collect();
        let cells = neighbours(&torques, &speeds, &[40.0; 30]);
        assert_eq!((cells.len(), cells.iter().map(Vec::len).sum::<usize>()), (10, 30));
        assert!(cells.iter().all(|c| c.iter().all(|i| torques[*i] == torques[c[0]])));
        let warm: Vec<f64> = (0..30).map(|i| if i % 2 == 0 { 40.0 } else { 100.0 }).collect();
        let apart = neighbours(&torques, &speeds, &warm);
        assert!(apart.len() == 10 && apart.iter().all(|c| c.iter().all(|i| warm[*i] == warm[c[0]])));
        let noise: Vec<f64> = (0..30).map(|i| f64::from(i % 3) - 1.0).collect();
        let errors = ErrorModel::estimated(&noise, &cells).unwrap();
        assert_eq!((errors.variance, errors.correlation), (1.0, 0.0));
        let small: Vec<f64> = noise.iter().map(|r| 0.5 * r).collect();
        assert!((ErrorModel::estimated(&small, &cells).unwrap().correlation - 0.75).abs() < 1e-12);
        let shifted: Vec<f64> = noise.iter().map(|r| 3.0 + r).collect();
        let errors = ErrorModel::estimated(&shifted, &cells).unwrap();
        assert!(errors.variance > 9.0 && errors.correlation > 0.89, "{errors:?}");
        assert_eq!(ErrorModel::estimated(&[1.0], &[vec![0]]), None);
    }
}
