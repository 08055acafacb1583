//! Small dense linear systems, column by column: factors, solutions, inverse.

/// LU factors of a matrix, column by column, with partial pivoting; false if it is singular.
pub(super) fn factor(matrix: &mut [f64], order: &mut [usize], n: usize) -> bool {
    // Few meshes have friction at once. A size known at compile time lets the compiler unroll the loops.
    match n {
        1 => eliminate(matrix, order, 1),
        2 => eliminate(matrix, order, 2),
        3 => eliminate(matrix, order, 3),
        4 => eliminate(matrix, order, 4),
        _ => eliminate(matrix, order, n),
    }
}

#[inline(always)]
fn eliminate(matrix: &mut [f64], order: &mut [usize], n: usize) -> bool {
    let (matrix, order) = (&mut matrix[..n * n], &mut order[..n]);
    for (k, place) in order.iter_mut().enumerate() {
        let (left, right) = matrix.split_at_mut((k + 1) * n);
        let (before, column) = left.split_at_mut(k * n);
        let mut pivot = k;
        for i in k + 1..n {
            if column[i].abs() > column[pivot].abs() {
                pivot = i;
            }
        }
        *place = pivot;
        // Entries are of order one, because rows are scaled.
        if column[pivot].abs() < 1e-13 {
            return false;
        }
        if pivot != k {
            column.swap(k, pivot);
            for other in before.chunks_exact_mut(n).chain(right.chunks_exact_mut(n)) {
                other.swap(k, pivot);
            }
        }
        // The inverse of the pivot is stored.
        column[k] = 1.0 / column[k];
        let inverse = column[k];
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
    match n {
        1 => substitute(factors, order, 1, x),
        2 => substitute(factors, order, 2, x),
        3 => substitute(factors, order, 3, x),
        4 => substitute(factors, order, 4, x),
        _ => substitute(factors, order, n, x),
    }
}

#[inline(always)]
fn substitute(factors: &[f64], order: &[usize], n: usize, x: &mut [f64]) {
    let (factors, order, x) = (&factors[..n * n], &order[..n], &mut x[..n]);
    for (k, place) in order.iter().enumerate() {
        x.swap(k, *place);
    }
    for (k, column) in factors.chunks_exact(n).enumerate() {
        for i in k + 1..n {
            x[i] -= column[i] * x[k];
        }
    }
    for (k, column) in factors.chunks_exact(n).enumerate().rev() {
        x[k] *= column[k];
        for i in 0..k {
            x[i] -= column[i] * x[k];
        }
    }
}

/// The inverse of a matrix; `None` if it is singular.
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
