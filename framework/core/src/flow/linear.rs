//! Small dense linear systems, column by column, of one point or of several: factors and solutions.

use std::ops::Mul;

use crate::real::{Mask as _, Points, Real};

/// LU factors of a matrix, column by column; returns where it is regular. A point that is solved alone exchanges rows where another
/// pivot is larger; among several, those that would are solved alone, which they hardly ever are: the matrix is close to identity.
#[inline(always)]
pub(super) fn eliminate<R: Points>(matrix: &mut [R], order: &mut [usize]) -> R::Mask {
    let n = order.len();
    let mut regular = R::mask(|_| true);
    for k in 0..n {
        let mut most = R::ZERO;
        for row in k + 1..n {
            most = most.max(matrix[k * n + row].abs());
        }
        order[k] = k;
        let smaller = matrix[k * n + k].abs().is_below(most);
        if smaller.any() {
            if R::COUNT == 1 {
                let rows = k + 1..n;
                let own = rows.clone().find(|row| matrix[k * n + row].abs().is_equal(most).any());
                order[k] = own.unwrap_or(k);
                for column in 0..n {
                    matrix.swap(column * n + k, column * n + order[k]);
                }
            } else {
                regular = regular & !smaller;
            }
        }
        // Entries are of order one, because rows are scaled.
        regular = regular & !matrix[k * n + k].abs().is_below(R::constant(1e-13));
        // The inverse of the pivot is stored.
        let inverse = R::constant(1.0) / matrix[k * n + k];
        matrix[k * n + k] = inverse;
        for row in k + 1..n {
            matrix[k * n + row] = matrix[k * n + row] * inverse;
        }
        for later in k + 1..n {
            let upper = matrix[later * n + k];
            for row in k + 1..n {
                let lower = matrix[k * n + row];
                matrix[later * n + row] -= lower * upper;
            }
        }
    }
    regular
}

/// Solves with the factors of [`eliminate`], in place.
#[inline(always)]
pub(super) fn substitute<F: Copy, R: Real + Mul<F, Output = R>>(factors: &[F], order: &[usize], x: &mut [R]) {
    let n = order.len();
    for (k, row) in order.iter().enumerate() {
        x.swap(k, *row);
    }
    for k in 0..n {
        let found = x[k];
        for row in k + 1..n {
            x[row] -= found * factors[k * n + row];
        }
    }
    for k in (0..n).rev() {
        let found = x[k] * factors[k * n + k];
        x[k] = found;
        for row in 0..k {
            x[row] -= found * factors[k * n + row];
        }
    }
}
