//! Small dense linear systems, column by column: factors, solutions, inverse.

/// Factors a matrix, column by column, into L and U with partial pivoting; false where it is singular.
pub(super) fn factor(matrix: &mut [f64], order: &mut [usize], n: usize) -> bool {
    for (k, place) in order.iter_mut().enumerate().take(n) {
        let (left, right) = matrix.split_at_mut((k + 1) * n);
        let (before, column) = left.split_at_mut(k * n);
        let mut pivot = k;
        for i in k + 1..n {
            if column[i].abs() > column[pivot].abs() {
                pivot = i;
            }
        }
        *place = pivot;
        // Entries are of the size of one, because rows are scaled.
        if column[pivot].abs() < 1e-13 {
            return false;
        }
        if pivot != k {
            column.swap(k, pivot);
            for other in before.chunks_exact_mut(n).chain(right.chunks_exact_mut(n)) {
                other.swap(k, pivot);
            }
        }
        let inverse = 1.0 / column[k];
        let lower = &mut column[k + 1..];
        for x in lower.iter_mut() {
            *x *= inverse;
        }
        for other in right.chunks_exact_mut(n) {
            let upper = other[k];
            for (x, l) in other[k + 1..].iter_mut().zip(&*lower) {
                *x -= l * upper;
            }
        }
    }
    true
}

/// Solves with the factors of [`factor`], in place.
pub(super) fn back(factors: &[f64], order: &[usize], n: usize, x: &mut [f64]) {
    for (k, place) in order.iter().enumerate().take(n) {
        x.swap(k, *place);
    }
    for (k, column) in factors.chunks_exact(n).enumerate() {
        let value = x[k];
        for (x, l) in x[k + 1..].iter_mut().zip(&column[k + 1..]) {
            *x -= l * value;
        }
    }
    for (k, column) in factors.chunks_exact(n).enumerate().rev() {
        x[k] /= column[k];
        let value = x[k];
        for (x, u) in x[..k].iter_mut().zip(column) {
            *x -= u * value;
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

/// Length of a column with its padding: groups of four need no rest.
pub(super) fn padded(n: usize) -> usize {
    n.next_multiple_of(4)
}

/// A matrix whose columns are padded with zeros.
pub(super) fn pad(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut wide = vec![0.0; n * padded(n)];
    for (wide, column) in wide.chunks_exact_mut(padded(n)).zip(matrix.chunks_exact(n)) {
        wide[..n].copy_from_slice(column);
    }
    wide
}

/// Adds a factor times a vector; both are padded.
pub(super) fn add(factor: f64, vector: &[f64], sum: &mut [f64]) {
    for (sum, part) in sum.iter_mut().zip(vector) {
        *sum += factor * part;
    }
}

/// Adds a factor times a matrix times a vector; columns and vectors are padded.
pub(super) fn add_product(factor: f64, matrix: &[f64], x: &[f64], sum: &mut [f64]) {
    let groups = matrix.as_chunks::<4>().0;
    let stride = sum.len() / 4;
    for (first, sum) in sum.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let mut total = [0.0; 4];
        for (part, x) in groups.iter().skip(first).step_by(stride).zip(x) {
            for (total, part) in total.iter_mut().zip(part) {
                *total += part * x;
            }
        }
        for (sum, total) in sum.iter_mut().zip(total) {
            *sum += factor * total;
        }
    }
}
