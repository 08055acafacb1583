//! Linear algebra of one iteration, based on orthogonal factors, never on J^T J.

use nalgebra::linalg::{QR, SVD};
use nalgebra::{DMatrix, DVector, Dyn};

/// Singular values below this share of the largest are dropped.
const CUT: f64 = 1e-12;
/// Maximum number of sweeps of the singular value decomposition for each row and column.
const ROUNDS: usize = 100;

/// J D^-1 = Q R, with q = Q^T r.
pub(super) struct Factors {
    qr: QR<f64, Dyn, Dyn>,
    pub r: DMatrix<f64>,
    pub q: DVector<f64>,
}

impl Factors {
    /// Factors of scaled columns and a residual.
    pub fn new(columns: DMatrix<f64>, residual: &DVector<f64>) -> Self {
        let qr = columns.qr();
        let r = qr.r();
        let mut factors = Self {
            qr,
            r,
            q: DVector::zeros(0),
        };
        factors.q = factors.project(residual.clone());
        factors
    }

    /// Q^T of a column.
    pub fn project(&self, mut column: DVector<f64>) -> DVector<f64> {
        self.qr.q_tr_mul(&mut column);
        column.rows(0, self.r.nrows()).into_owned()
    }
}

/// The shortest x that minimises |a x - b|. Absent if no finite one is found.
pub(super) fn nearest(a: DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    if a.ncols() == 0 {
        return Some(DVector::zeros(0));
    }
    let svd = decompose(a, true)?;
    let cut = CUT * svd.singular_values.max();
    if cut == 0.0 {
        return Some(DVector::zeros(svd.v_t.map_or(0, |v| v.ncols())));
    }
    let x = svd.solve(b, cut).ok()?;
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// Smallest over largest singular value of columns divided by their norms; 1 without columns.
pub(super) fn independence(columns: &DMatrix<f64>) -> f64 {
    if columns.ncols() == 0 {
        return 1.0;
    }
    let mut unit = columns.clone();
    for mut column in unit.column_iter_mut() {
        let norm = column.norm();
        if norm > 0.0 {
            column /= norm;
        }
    }
    // The triangle has the same singular values and is small.
    let small = if unit.nrows() > unit.ncols() {
        unit.qr().r()
    } else {
        unit
    };
    if small.nrows() < small.ncols() {
        return 0.0;
    }
    decompose(small, false).map_or(0.0, |svd| svd.singular_values.min() / svd.singular_values.max())
}

/// Right singular vectors with their singular values in descending order. Absent if the decomposition fails, or with fewer rows than
/// columns.
pub(super) fn directions(a: DMatrix<f64>) -> Option<Vec<(DVector<f64>, f64)>> {
    if a.ncols() == 0 {
        return Some(Vec::new());
    }
    if a.nrows() < a.ncols() {
        return None;
    }
    let svd = decompose(a.qr().r(), true)?;
    let rows = svd.v_t?;
    Some(
        rows.row_iter()
            .zip(&svd.singular_values)
            .map(|(row, s)| (row.transpose(), *s))
            .collect(),
    )
}

fn decompose(a: DMatrix<f64>, vectors: bool) -> Option<SVD<f64, Dyn, Dyn>> {
    if !a.iter().all(|x| x.is_finite()) {
        return None;
    }
    let rounds = ROUNDS * (a.nrows() + a.ncols());
    SVD::try_new(a, vectors, vectors, f64::EPSILON, rounds)
}

/// Some columns of a matrix.
pub(super) fn columns(matrix: &DMatrix<f64>, which: &[usize]) -> DMatrix<f64> {
    matrix.select_columns(which)
}
