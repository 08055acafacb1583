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
    /// A matrix from its entries in the order of rows, then of columns.
    pub fn new(entries: impl IntoIterator<Item = ((usize, usize), f64)>, size: usize) -> Self {
        let mut sparse = Self {
            ends: vec![0; size],
            ..Self::default()
        };
        for ((row, column), entry) in entries {
            sparse.entries.push((column, entry));
            sparse.ends[row] = sparse.entries.len();
        }
        for row in 1..size {
            sparse.ends[row] = sparse.ends[row].max(sparse.ends[row - 1]);
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
    /// The vector without its zeros.
    pub fn new(entries: impl IntoIterator<Item = (usize, f64)>) -> Self {
        Self(entries.into_iter().filter(|(_, x)| *x != 0.0).collect())
    }

    pub fn entries(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.0.iter().copied()
    }

    /// Adds the vector times a factor.
    #[inline(always)]
    pub fn add<R: Real>(&self, factor: R, sum: &mut [R]) {
        for (row, entry) in &self.0 {
            sum[*row] += factor * *entry;
        }
    }
}
