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

/// Length of a vector with its padding to groups of four.
pub(super) fn padded(n: usize) -> usize {
    n.next_multiple_of(4)
}

/// A square matrix for [`product`]: four rows at a time, column by column, padded with zeros.
#[derive(Debug, Clone)]
pub(super) struct Panels {
    parts: Vec<[f64; 4]>,
    columns: usize,
}

impl Panels {
    /// A matrix from its columns.
    pub fn new(matrix: &[f64], n: usize) -> Self {
        let entry = |row: usize, column: usize| if row < n { matrix[column * n + row] } else { 0.0 };
        let parts = (0..padded(n))
            .step_by(4)
            .flat_map(|first| (0..n).map(move |column| [0, 1, 2, 3].map(|i| entry(first + i, column))))
            .collect();
        Self { parts, columns: n }
    }

    /// Row, column and value of the nonzero entries, row by row.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let panels = self.parts.chunks_exact(self.columns.max(1)).enumerate();
        panels.flat_map(|(panel, columns)| {
            (0..4).flat_map(move |row| {
                let entries = columns
                    .iter()
                    .enumerate()
                    .map(move |(column, part)| (column, part[row]));
                entries
                    .filter(|(_, x)| *x != 0.0)
                    .map(move |(column, x)| (4 * panel + row, column, x))
            })
        })
    }
}

/// The larger of two numbers; the first if the second is NaN. Cheaper than `max`, which handles NaN in both.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Adds a factor times a vector; both are padded.
pub(super) fn add(factor: f64, vector: &[f64], sum: &mut [f64]) {
    for (sum, part) in sum.iter_mut().zip(vector) {
        *sum += factor * part;
    }
}

/// Writes a matrix times a vector; the vectors are padded.
pub(super) fn product(matrix: &Panels, x: &[f64], y: &mut [f64]) {
    let panels = matrix.parts.chunks_exact(matrix.columns);
    for (y, panel) in y.as_chunks_mut::<4>().0.iter_mut().zip(panels) {
        let mut total = [0.0; 4];
        for (part, x) in panel.iter().zip(x) {
            for (total, part) in total.iter_mut().zip(part) {
                *total += part * x;
            }
        }
        *y = total;
    }
}
