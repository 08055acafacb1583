//! Small dense linear systems, column by column: factors, solutions, inverse.

/// Factors a matrix, column by column, into L and U with partial pivoting; false where it is singular.
pub(super) fn factor(matrix: &mut [f64], order: &mut [usize], n: usize) -> bool {
    for k in 0..n {
        let mut pivot = k;
        for i in k + 1..n {
            if matrix[k * n + i].abs() > matrix[k * n + pivot].abs() {
                pivot = i;
            }
        }
        order[k] = pivot;
        // Entries are of the size of one, because rows are scaled.
        if matrix[k * n + pivot].abs() < 1e-13 {
            return false;
        }
        if pivot != k {
            for j in 0..n {
                matrix.swap(j * n + k, j * n + pivot);
            }
        }
        let inverse = 1.0 / matrix[k * n + k];
        for i in k + 1..n {
            matrix[k * n + i] *= inverse;
        }
        for j in k + 1..n {
            let upper = matrix[j * n + k];
            if upper != 0.0 {
                for i in k + 1..n {
                    matrix[j * n + i] -= matrix[k * n + i] * upper;
                }
            }
        }
    }
    true
}

/// Solves with the factors of [`factor`], in place.
pub(super) fn back(factors: &[f64], order: &[usize], n: usize, x: &mut [f64]) {
    for k in 0..n {
        x.swap(k, order[k]);
    }
    for k in 0..n {
        let value = x[k];
        if value != 0.0 {
            for i in k + 1..n {
                x[i] -= factors[k * n + i] * value;
            }
        }
    }
    for k in (0..n).rev() {
        x[k] /= factors[k * n + k];
        let value = x[k];
        for i in 0..k {
            x[i] -= factors[k * n + i] * value;
        }
    }
}

/// The inverse of a matrix; absent where it is singular.
pub(super) fn inverse(mut matrix: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    let mut order = vec![0; n];
    if !factor(&mut matrix, &mut order, n) {
        return None;
    }
    let mut inverse = vec![0.0; n * n];
    for j in 0..n {
        let column = &mut inverse[j * n..(j + 1) * n];
        column[j] = 1.0;
        back(&matrix, &order, n, column);
    }
    Some(inverse)
}

/// Adds a matrix times a vector, times a factor.
pub(super) fn add_product(matrix: &[f64], x: &[f64], factor: f64, sum: &mut [f64]) {
    let n = sum.len();
    for (column, &x) in matrix.chunks_exact(n).zip(x) {
        if x != 0.0 {
            for (y, a) in sum.iter_mut().zip(column) {
                *y += factor * a * x;
            }
        }
    }
}
