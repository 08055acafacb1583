//! Whether a set of points can distinguish two models.
//!
//! Errors of a measurement are partly common to all points: a gain, an offset of the loss, an offset of a torque meter. Averaging over many
//! points reduces the independent part of the errors only. With the covariance matrix S = v ((1 - rho) I + rho/m sum u_j u_j') of the
//! errors, in units of the stated variance, the squared distance of the predictions of two models is d^2 = delta' S^-1 delta with their
//! difference delta. The m shapes u_j of the common errors over the points have mean square one, so that rho is the mean share of the
//! common errors in the variance; with the single shape u = 1 it is the correlation between any two points. The inverse is closed (Sherman,
//! Morrison, Woodbury): S^-1 = (I - U ((1 - rho) m/rho I + U'U)^-1 U') / (v (1 - rho)).
//!
//! If one of the two models is right, the logarithm of their likelihood ratio is normal with mean d^2/2 and variance d^2, so that the wrong
//! one looks more likely with probability Phi(-d/2) (Kullback: Information Theory and Statistics, Wiley 1959, chapter 9). A set of points
//! distinguishes two models if this is at most 5 %: d >= 2 * 1.645, d^2 >= 10.82.
//!
//! A difference does not show which model is better: with a common error of all points, a wrong model may be closer. Therefore the misfits
//! Q = r' S^-1 r of the two are also compared, in which a common error has little weight. The better one must be 19 times as likely (95 to
//! 5 %): a difference of Q of 2 ln 19 = 5.89.

use nalgebra::{DMatrix, DVector};

use super::Decision;
use crate::statistics::bands;

/// Minimum squared distance of distinguishable models: (2 z)^2 with the 95 % quantile z = 1.644854 of the normal distribution.
pub const VISIBLE: f64 = 10.822_175;
/// Difference of misfits at which one model is 19 times as likely as the other: 2 ln 19.
const EVIDENT: f64 = 5.888_878;
/// Maximum share of common errors. An assumption: one percent of the variance is always independent, so that points without noise do not
/// distinguish arbitrarily close models.
const LARGEST: f64 = 0.99;
/// Neighbouring points of a cell.
const CELL: usize = 3;
/// Difference of oil temperatures above which points belong to different cells. An assumption, as for lines of constant torque. \[K\]
const APART: f64 = 3.0;

/// Information on the errors of a set of points in addition to their stated accuracy.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointSet {
    /// Indices of neighbouring points, [`neighbours`].
    pub cells: Vec<Vec<usize>>,
    /// Shapes of common errors over the points, in units of the stated standard deviations, with any scale.
    pub shapes: Vec<Vec<f64>>,
}

/// Errors of a set of points: variance and its common part.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorModel {
    /// Variance over the stated one. \[-\]
    pub variance: f64,
    /// Mean share of common errors in the variance, 0 to 0.99: the correlation between the errors of any two points. \[-\]
    pub correlation: f64,
    /// Shapes of the common errors in columns, of mean square one.
    shapes: DMatrix<f64>,
    /// ((1 - rho) m/rho I + U'U)^-1.
    core: DMatrix<f64>,
}

impl ErrorModel {
    /// From a variance in units of the stated one, the share of common errors in it, and their shapes. Shapes that are zero or not finite
    /// are ignored; without shapes there are no common errors.
    pub fn new(variance: f64, correlation: f64, shapes: &[Vec<f64>]) -> Self {
        let unit = |shape: &Vec<f64>| {
            let square = shape.iter().map(|x| x * x).sum::<f64>() / shape.len().max(1) as f64;
            let usable = square > 0.0 && square.is_finite();
            usable.then(|| DVector::from_iterator(shape.len(), shape.iter().map(|x| x / square.sqrt())))
        };
        let columns: Vec<DVector<f64>> = shapes.iter().filter_map(unit).collect();
        let correlation = if columns.is_empty() {
            0.0
        } else {
            correlation.clamp(0.0, LARGEST)
        };
        let matrix = if columns.is_empty() {
            DMatrix::zeros(0, 0)
        } else {
            DMatrix::from_columns(&columns)
        };
        let count = columns.len();
        let ratio = (1.0 - correlation) * count as f64 / correlation;
        let core = if correlation > 0.0 {
            let core = matrix.tr_mul(&matrix) + DMatrix::identity(count, count) * ratio;
            // The sum of a Gram matrix and a positive diagonal always has an inverse.
            core.cholesky().map(|root| root.inverse())
        } else {
            None
        };
        Self {
            variance,
            correlation,
            core: core.unwrap_or_else(|| DMatrix::zeros(count, count)),
            shapes: matrix,
        }
    }

    /// From residuals over their stated standard deviation: the intraclass correlation about zero over cells of neighbouring points.
    ///
    /// The scatter within the cells is the independent part. The total is the mean square of the residuals, but at least the stated
    /// variance: if points scatter less than stated, the remainder must be common to them. Absent without a cell of two points, or if a
    /// residual is not finite.
    pub fn estimated(residuals: &[f64], points: &PointSet) -> Option<Self> {
        let (mut within, mut freedom) = (0.0, 0_usize);
        for cell in &points.cells {
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
        let correlation = 1.0 - within / freedom as f64 / variance;
        let whole = freedom > 0 && variance.is_finite() && correlation.is_finite();
        whole.then(|| Self::new(variance, correlation, &points.shapes))
    }

    /// Squared norm of errors in units of their stated standard deviations: the sum of squares if they are independent.
    ///
    /// # Panics
    /// If the shapes of common errors are those of another number of points.
    pub fn square(&self, errors: &[f64]) -> f64 {
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let common = if self.correlation > 0.0 {
            assert_eq!(self.shapes.nrows(), errors.len(), "shapes of other points");
            let along = self.shapes.tr_mul(&DVector::from_row_slice(errors));
            along.dot(&(&self.core * &along))
        } else {
            0.0
        };
        (squares - common).max(0.0) / (self.variance * (1.0 - self.correlation))
    }
}

/// Separation of the predictions of two models for a set of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// Squared distance, d^2. \[-\]
    pub square: f64,
    /// Misfit of the second minus that of the first, allowing for common errors. \[-\]
    pub evidence: f64,
    /// Correlation of the errors used. \[-\]
    pub correlation: f64,
}

impl Separation {
    /// From the residuals of two models in units of the stated standard deviations.
    pub fn new([first, second]: [&[f64]; 2], errors: &ErrorModel) -> Self {
        let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
        Self {
            square: errors.square(&differences),
            evidence: errors.square(second) - errors.square(first),
            correlation: errors.correlation,
        }
    }

    /// Whether the set of points distinguishes the models.
    pub fn is_visible(&self) -> bool {
        self.square >= VISIBLE
    }

    /// Whether the misfits support a decision, allowing for common errors.
    pub fn supports(&self, decision: Decision) -> bool {
        match decision {
            Decision::Better => self.evidence >= EVIDENT,
            Decision::Worse => self.evidence <= -EVIDENT,
            Decision::NotDecided => true,
        }
    }
}

/// Cells of up to three points of neighbouring torque and speed: points of one oil temperature and one band of torque, grouped by three in
/// order of speed. Use zero for unknown temperatures.
pub fn neighbours(torques: &[f64], speeds: &[f64], oils: &[f64]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..torques.len()).collect();
    order.sort_by(|a, b| oils[*a].total_cmp(&oils[*b]));
    let mut cells = Vec::new();
    for group in order.chunk_by(|a, b| oils[*b] - oils[*a] <= APART) {
        let torques_of_group: Vec<f64> = group.iter().map(|i| torques[*i]).collect();
        for (_, band) in bands(&torques_of_group) {
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
    use super::*;
    use crate::inference::probability::normal_below;

    #[test]
    fn the_closed_form_is_that_of_the_matrix() {
        let delta = DVector::from_vec(vec![0.3, -1.2, 2.0, 0.7, 0.1]);
        let shapes = [vec![2.0; 5], vec![0.1, 0.2, 0.3, 0.4, 0.5]];
        for (variance, correlation, count) in [(1.0, 0.0, 1), (1.0, 0.4, 1), (2.5, 0.9, 2)] {
            let mut matrix = DMatrix::<f64>::identity(5, 5) * (1.0 - correlation);
            for shape in &shapes[..count] {
                let shape = DVector::from_row_slice(shape);
                let scale = correlation / count as f64 / (shape.norm_squared() / 5.0);
                matrix += &shape * shape.transpose() * scale;
            }
            let solved = (matrix * variance).lu().solve(&delta).unwrap();
            let found = ErrorModel::new(variance, correlation, &shapes[..count]).square(delta.as_slice());
            assert!((found - delta.dot(&solved)).abs() < 1e-12);
        }
        // One shape that is the same at all points: |delta|^2 - rho (sum delta)^2/(1 + (n - 1) rho), over 1 - rho.
        let found = ErrorModel::new(1.0, 0.4, &shapes[..1]).square(delta.as_slice());
        let (squares, sum) = (delta.norm_squared(), delta.sum());
        assert!((found - (squares - 0.4 * sum * sum / 2.6) / 0.6).abs() < 1e-12);
        assert_eq!(ErrorModel::new(1.0, 0.4, &[vec![0.0; 5]]).correlation, 0.0);
    }

    #[test]
    #[should_panic(expected = "shapes of other points")]
    fn shapes_are_those_of_the_points() {
        ErrorModel::new(1.0, 0.4, &[vec![1.0; 4]]).square(&[1.0; 5]);
    }

    #[test]
    fn the_limit_is_an_error_of_one_in_twenty() {
        assert!((normal_below(-0.5 * VISIBLE.sqrt()).unwrap() - 0.05).abs() < 1e-7);
    }

    #[test]
    fn what_is_common_to_all_points_stays() {
        // 2 % everywhere against an accuracy of 1 % that is mostly common: a thousand points see no more than a few.
        let square = |count: usize, correlation: f64| {
            let errors = ErrorModel::new(1.0, correlation, &[vec![1.0; count]]);
            Separation::new([&vec![0.0; count], &vec![2.0; count]], &errors)
        };
        let (few, many) = (square(5, 0.9), square(1000, 0.9));
        assert!(!few.is_visible() && !many.is_visible() && many.square < 1.1 * few.square);
        assert!(square(5, 0.0).is_visible());
        // The same size with changing signs is detected.
        let shape: Vec<f64> = (0..10).map(|i| if i % 2 == 0 { 2.0 } else { -2.0 }).collect();
        let errors = ErrorModel::new(1.0, 0.9, &[vec![1.0; 10]]);
        assert!(Separation::new([&[0.0; 10], &shape], &errors).is_visible());
        // Points that all read three accuracies too much: the right model is farther from them, and more likely.
        let right = [3.0; 10];
        let wrong: Vec<f64> = (0..10).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let found = Separation::new([&wrong, &right], &errors);
        assert!(found.is_visible() && !found.supports(Decision::Better) && found.supports(Decision::Worse));
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
        let points = PointSet {
            cells,
            shapes: vec![vec![1.0; 30]],
        };
        let noise: Vec<f64> = (0..30).map(|i| f64::from(i % 3) - 1.0).collect();
        let errors = ErrorModel::estimated(&noise, &points).unwrap();
        assert_eq!((errors.variance, errors.correlation), (1.0, 0.0));
        let small: Vec<f64> = noise.iter().map(|r| 0.5 * r).collect();
        assert!((ErrorModel::estimated(&small, &points).unwrap().correlation - 0.75).abs() < 1e-12);
        let shifted: Vec<f64> = noise.iter().map(|r| 3.0 + r).collect();
        let errors = ErrorModel::estimated(&shifted, &points).unwrap();
        assert!(errors.variance > 9.0 && errors.correlation > 0.89, "{errors:?}");
        assert_eq!(ErrorModel::estimated(&[1.0], &PointSet::default()), None);
    }
}
