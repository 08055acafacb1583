//! Factors of a sparse matrix whose entries change from solve to solve, at one point or at several, and whose pivots do not.

use std::collections::{BTreeMap, BTreeSet};

use crate::real::{Points, Real};

/// Entries of scaled rows below this are rounding error.
const ZERO: f64 = 1e-13;
/// A pivot is at least this share of the largest entry of its column.
const THRESHOLD: f64 = 0.1;

/// The order in which a matrix is eliminated, and the operations on its entries.
#[derive(Debug, Clone, Default)]
pub(super) struct Elimination {
    /// The matrix without changes; zero where elimination makes an entry.
    values: Vec<f64>,
    /// Number of each entry among the values, by row and column.
    places: BTreeMap<(usize, usize), usize>,
    steps: Vec<Step>,
}

/// Elimination of one unknown.
#[derive(Debug, Clone)]
struct Step {
    row: usize,
    column: usize,
    pivot: usize,
    /// Later rows with an entry in the column of the pivot, and the number of that entry.
    below: Vec<(usize, usize)>,
    /// Later columns with an entry in the row of the pivot, and the number of that entry.
    right: Vec<(usize, usize)>,
    /// For each of the rows and in it for each of the columns the number of the entry that changes.
    changed: Vec<usize>,
}

impl Elimination {
    /// The elimination of a matrix of this size; absent if it is singular. The pivot of each step is in the column and then in the row
    /// with the fewest entries (Markowitz), so that few entries are made.
    pub fn new(matrix: &BTreeMap<(usize, usize), f64>, size: usize) -> Option<Self> {
        let mut made = Self::default();
        let mut values = Vec::new();
        let mut rows = vec![BTreeSet::new(); size];
        let mut columns = vec![BTreeSet::new(); size];
        for (&(row, column), &value) in matrix {
            made.places.insert((row, column), values.len());
            values.push(value);
            rows[row].insert(column);
            columns[column].insert(row);
        }
        made.values.clone_from(&values);
        let mut open: BTreeSet<(usize, usize)> = (0..size).map(|column| (columns[column].len(), column)).collect();
        while let Some((_, column)) = open.pop_first() {
            let size_of = |row: usize| f64::abs(values[made.places[&(row, column)]]);
            let largest = columns[column]
                .iter()
                .fold(0.0_f64, |most, row| most.max(size_of(*row)));
            let large = |row: &&usize| size_of(**row) >= THRESHOLD * largest && largest > ZERO;
            let row = *columns[column]
                .iter()
                .filter(large)
                .min_by_key(|row| rows[**row].len())?;
            let others = |own: &BTreeSet<usize>, pivot: usize| {
                own.iter().copied().filter(|other| *other != pivot).collect::<Vec<_>>()
            };
            let (below, right) = (others(&columns[column], row), others(&rows[row], column));
            for own in &right {
                let waits = open.remove(&(columns[*own].len(), *own));
                columns[*own].remove(&row);
                columns[*own].extend(&below);
                if waits {
                    open.insert((columns[*own].len(), *own));
                }
            }
            for own in &below {
                rows[*own].remove(&column);
                rows[*own].extend(&right);
            }
            let mut changed = Vec::with_capacity(below.len() * right.len());
            let pivot = made.places[&(row, column)];
            for lower in &below {
                let factor = values[made.places[&(*lower, column)]] / values[pivot];
                for upper in &right {
                    let next = values.len();
                    let place = *made.places.entry((*lower, *upper)).or_insert(next);
                    if place == next {
                        values.push(0.0);
                    }
                    values[place] -= factor * values[made.places[&(row, *upper)]];
                    changed.push(place);
                }
            }
            made.steps.push(Step {
                row,
                column,
                pivot,
                below: below
                    .iter()
                    .map(|lower| (*lower, made.places[&(*lower, column)]))
                    .collect(),
                right: right
                    .iter()
                    .map(|upper| (*upper, made.places[&(row, *upper)]))
                    .collect(),
                changed,
            });
        }
        made.values.resize(values.len(), 0.0);
        Some(made)
    }

    /// Number of entries, those made by elimination included.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The number of an entry of the matrix.
    pub fn place(&self, row: usize, column: usize) -> Option<usize> {
        self.places.get(&(row, column)).copied()
    }

    /// Writes the entries of the matrix.
    #[inline(always)]
    pub fn write<R: Real>(&self, factors: &mut [R]) {
        for (factor, value) in factors.iter_mut().zip(&self.values) {
            *factor = R::constant(*value);
        }
    }

    /// Makes factors of the entries, in place. Returns where the matrix is regular.
    #[inline(always)]
    pub fn eliminate<R: Points>(&self, factors: &mut [R]) -> R::Mask {
        let mut regular = R::mask(|_| true);
        for step in &self.steps {
            regular = regular & !factors[step.pivot].abs().is_below(R::constant(ZERO));
            // The inverse of the pivot is stored.
            let inverse = R::constant(1.0) / factors[step.pivot];
            factors[step.pivot] = inverse;
            let mut changed = step.changed.iter();
            for (_, lower) in &step.below {
                let factor = factors[*lower] * inverse;
                factors[*lower] = factor;
                for ((_, upper), place) in step.right.iter().zip(&mut changed) {
                    let upper = factors[*upper];
                    factors[*place] -= factor * upper;
                }
            }
        }
        regular
    }

    /// Solves with the factors; the right-hand side is lost.
    #[inline(always)]
    pub fn solve<R: Real>(&self, factors: &[R], right: &mut [R], x: &mut [R]) {
        for step in &self.steps {
            let own = right[step.row];
            for (row, lower) in &step.below {
                right[*row] -= factors[*lower] * own;
            }
        }
        for step in self.steps.iter().rev() {
            let mut own = right[step.row];
            for (column, upper) in &step.right {
                own -= factors[*upper] * x[*column];
            }
            x[step.column] = own * factors[step.pivot];
        }
    }

    /// Multiplications of one elimination and one solution.
    #[cfg(test)]
    pub(crate) fn multiplications(&self) -> usize {
        let step = |step: &Step| step.changed.len() + 2 * step.below.len() + step.right.len() + 1;
        self.steps.iter().map(step).sum()
    }
}
