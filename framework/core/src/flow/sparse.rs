//! Sparse matrices and vectors, applied to one point or to several.

use crate::real::Real;

/// A square sparse matrix.
#[derive(Debug, Clone, Default)]
pub(super) struct SparseMatrix {
    /// For each row the end of its entries.
    ends: Vec<usize>,
    /// Column and value, row by row.
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    /// A matrix from its columns.
    pub fn new(matrix: &[f64], size: usize) -> Self {
        let mut sparse = Self::default();
        for row in 0..size {
            let entries = (0..size).map(|column| (column, matrix[column * size + row]));
            sparse.entries.extend(entries.filter(|(_, x)| *x != 0.0));
            sparse.ends.push(sparse.entries.len());
        }
        sparse
    }

    /// Writes the product with a vector.
    #[inline(always)]
    pub fn product<R: Real>(&self, x: &[R], y: &mut [R]) {
        let mut start = 0;
        for (y, end) in y.iter_mut().zip(&self.ends) {
            let mut sum = R::ZERO;
            for (column, entry) in &self.entries[start..*end] {
                sum += x[*column] * *entry;
            }
            *y = sum;
            start = *end;
        }
    }
}

/// A sparse vector: indices and entries.
#[derive(Debug, Clone, Default)]
pub(super) struct SparseVector(Vec<(usize, f64)>);

impl SparseVector {
    pub fn new(vector: &[f64]) -> Self {
        let entries = vector.iter().copied().enumerate().filter(|(_, x)| *x != 0.0);
        Self(entries.collect())
    }

    /// Adds the vector times a factor.
    #[inline(always)]
    pub fn add<R: Real>(&self, factor: R, sum: &mut [R]) {
        for (row, entry) in &self.0 {
            sum[*row] += factor * *entry;
        }
    }
}
