//! Singular values and directions of the columns of a Jacobian that can move.
//!
//! The product of the Jacobian with itself is never formed: it would square the condition and lose the small directions. The
//! columns are scaled to unit length, factored by Householder reflections, and the triangle is taken apart by singular values;
//! Belsley, Kuh, Welsch: Regression Diagnostics (Wiley 1980), chapter 3, on why unit columns.

use nalgebra::DMatrix;

/// Singular value over the greatest below which a direction is not resolved.
const RESOLVED: f64 = 1e-9;

/// Unit columns = U S V^T, direction by direction.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Factors {
    /// Parameters whose columns these are; columns of zeros are left out.
    pub columns: Vec<usize>,
    /// Lengths of the columns before they were scaled.
    pub norms: Vec<f64>,
    /// Triangle of the scaled columns.
    triangle: DMatrix<f64>,
    /// Singular values, the greatest first.
    pub singular: Vec<f64>,
    /// Directions V: one row for each column, one column for each singular value.
    pub directions: DMatrix<f64>,
    /// How many directions are resolved.
    pub resolved: usize,
}

impl Factors {
    /// Of some columns of a matrix of finite numbers. Absent where the decomposition fails.
    pub fn new(jacobian: &DMatrix<f64>, columns: &[usize]) -> Option<Self> {
        let norms: Vec<f64> = columns.iter().map(|j| jacobian.column(*j).norm()).collect();
        let kept: Vec<usize> = (0..columns.len()).filter(|i| norms[*i] > 0.0).collect();
        let columns: Vec<usize> = kept.iter().map(|i| columns[*i]).collect();
        let norms: Vec<f64> = kept.iter().map(|i| norms[*i]).collect();
        let unit = DMatrix::from_fn(jacobian.nrows(), columns.len(), |i, k| {
            jacobian[(i, columns[k])] / norms[k]
        });
        if columns.is_empty() {
            let (triangle, directions) = (DMatrix::zeros(0, 0), DMatrix::zeros(0, 0));
            let (singular, resolved) = (Vec::new(), 0);
            return Some(Self {
                columns,
                norms,
                triangle,
                singular,
                directions,
                resolved,
            });
        }
        // With fewer rows than columns the triangle is filled up with zeros, so that every column has its directions.
        let triangle = unit.qr().r().resize_vertically(columns.len(), 0.0);
        let (singular, directions) = decompose(triangle.clone())?;
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

    /// Singular values of the columns with other lengths than one.
    pub fn scaled(&self, lengths: &[f64]) -> Option<Vec<f64>> {
        let mut triangle = self.triangle.clone();
        for (mut column, length) in triangle.column_iter_mut().zip(lengths) {
            column *= *length;
        }
        Some(decompose(triangle)?.0)
    }

    /// Root of the inverse: columns V/S of the resolved directions, each row divided by the length of its column. Times its
    /// transpose it is the covariance for a variance of one.
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
            (0..self.resolved).map(|k| entry(k).powi(2)).sum::<f64>().min(1.0)
        };
        (0..jacobian.nrows()).map(row).collect()
    }
}

/// Singular values and right directions of a square matrix, the greatest first.
fn decompose(matrix: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    if matrix.is_empty() {
        return Some((Vec::new(), matrix));
    }
    // With an end: entries that are no numbers would keep the iteration going.
    let svd = matrix.try_svd(false, true, f64::EPSILON, 10_000)?;
    let directions = svd.v_t?.transpose();
    Some((svd.singular_values.iter().copied().collect(), directions))
}
