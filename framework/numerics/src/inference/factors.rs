//! Singular values and directions of the columns of free parameters of a Jacobian.
//!
//! The normal matrix is never formed, because it would square the condition number and lose the small directions. The columns are scaled to
//! unit length and factored by Householder reflections, followed by a singular value decomposition of the triangle; Belsley, Kuh, Welsch:
//! Regression Diagnostics (Wiley 1980), chapter 3, on why unit columns.

use nalgebra::DMatrix;

/// Ratio of a singular value to the largest below which a direction is not resolved.
const RESOLVED: f64 = 1e-9;

/// Unit columns = U S V^T, direction by direction.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Factors {
    /// Parameters of the columns; columns of zeros are omitted.
    pub columns: Vec<usize>,
    /// Lengths of the columns before scaling.
    pub norms: Vec<f64>,
    /// Triangle of the scaled columns.
    triangle: DMatrix<f64>,
    /// Singular values in descending order.
    pub singular: Vec<f64>,
    /// Directions V: one row for each column, one column for each singular value.
    pub directions: DMatrix<f64>,
    /// Number of resolved directions.
    pub resolved: usize,
}

impl Factors {
    /// Factors of some columns of a matrix of finite numbers. Absent if the decomposition fails.
    pub fn new(jacobian: &DMatrix<f64>, columns: &[usize]) -> Option<Self> {
        let norms: Vec<f64> = columns.iter().map(|j| jacobian.column(*j).norm()).collect();
        let kept: Vec<usize> = (0..columns.len()).filter(|i| norms[*i] > 0.0).collect();
        let columns: Vec<usize> = kept.iter().map(|i| columns[*i]).collect();
        let norms: Vec<f64> = kept.iter().map(|i| norms[*i]).collect();
        let unit = DMatrix::from_fn(jacobian.nrows(), columns.len(), |i, k| {
            jacobian[(i, columns[k])] / norms[k]
        });
        let (triangle, singular, directions) = if columns.is_empty() {
            (DMatrix::zeros(0, 0), Vec::new(), DMatrix::zeros(0, 0))
        } else {
            // With fewer rows than columns the triangle is padded with zeros, so that every column has directions.
            let triangle = unit.qr().r().resize_vertically(columns.len(), 0.0);
            let (singular, directions) = decompose(triangle.clone())?;
            (triangle, singular, directions)
        };
        let greatest = singular.first().copied().unwrap_or(0.0);
        let resolved = singular.iter().take_while(|s| **s > RESOLVED * greatest).count();
        Some(Self {
            columns,
            norms,
            triangle,
            singular,
            directions,
            resolved,
        })
    }

    /// Singular values of the columns with the given lengths.
    pub fn scaled(&self, lengths: &[f64]) -> Option<Vec<f64>> {
        let mut triangle = self.triangle.clone();
        for (mut column, length) in triangle.column_iter_mut().zip(lengths) {
            column *= *length;
        }
        Some(decompose(triangle)?.0)
    }

    /// Root of the inverse: columns V/S of the resolved directions, each row divided by the length of its column. Its product with its
    /// transpose is the covariance for unit variance.
    pub fn root(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.columns.len(), self.resolved, |i, k| {
            self.directions[(i, k)] / self.singular[k] / self.norms[i]
        })
    }

    /// Diagonal of the projection onto the columns, row by row of the Jacobian.
    pub fn leverage(&self, jacobian: &DMatrix<f64>) -> Vec<f64> {
        let root = self.root();
        let row = |i: usize| {
            let entry = |k: usize| -> f64 {
                let terms = self
                    .columns
                    .iter()
                    .enumerate()
                    .map(|(c, j)| jacobian[(i, *j)] * root[(c, k)]);
                terms.sum()
            };
            // The sum of no numbers is -0.
            0.0 + (0..self.resolved).map(|k| entry(k).powi(2)).sum::<f64>().min(1.0)
        };
        (0..jacobian.nrows()).map(row).collect()
    }
}

/// Singular values in descending order and right singular vectors of a square matrix.
fn decompose(matrix: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    if matrix.is_empty() {
        return Some((Vec::new(), matrix));
    }
    // Limited, because the iteration does not terminate if entries are NaN.
    let svd = matrix.try_svd(false, true, f64::EPSILON, 10_000)?;
    let directions = svd.v_t?.transpose();
    Some((svd.singular_values.iter().copied().collect(), directions))
}
