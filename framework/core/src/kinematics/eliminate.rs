//! Gauss-Jordan elimination in three groups of columns: members, ports without, ports with a prescribed speed. The order provides
//! the diagnosis: a member is free only if nothing constrains it.

use std::collections::BTreeSet;

use super::Train;

/// Entries of scaled rows below this are rounding error; tooth numbers differ by far more.
const ZERO: f64 = 1e-10;

/// Relative to the largest entry of a row or motion, entries below this are rounding error.
const ROUNDING: f64 = 1e-9;

/// Why a state cannot move as prescribed. Columns and rows by number.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// Some columns can rotate freely relative to the others.
    Under {
        /// The columns that rotate together.
        columns: Vec<usize>,
        /// Ports among them, which could prescribe the speed.
        ports: Vec<usize>,
    },
    /// Prescribed ports depend on each other.
    Tied {
        /// The port that the others already determine.
        port: usize,
        /// The others and the factor on each.
        others: Vec<(usize, f64)>,
        /// Rows that relate them.
        rows: Vec<usize>,
    },
    /// A prescribed port cannot rotate.
    Locked {
        /// The port.
        port: usize,
        /// Rows that lock it.
        rows: Vec<usize>,
    },
}

/// Sparse rows, reduced: a constraint has two or three terms, and a column is in few rows.
pub(super) struct Reduced {
    columns: usize,
    /// Reduced rows: column and entry, by column, without zeros.
    rows: Vec<Vec<(usize, f64)>>,
    /// Rows with an entry in each column.
    holders: Vec<Vec<usize>>,
    /// Scale of each original row.
    scales: Vec<f64>,
    /// What was done to the rows, from which [`Reduced::origin`] follows.
    steps: Vec<Step>,
    /// Pivot column of each row; `None` for rows that became zero.
    pivots: Vec<Option<usize>>,
}

/// One operation on rows.
enum Step {
    Divide { row: usize, by: f64 },
    Subtract { from: usize, row: usize, factor: f64 },
}

impl Reduced {
    pub fn new(train: &Train, ports: &[usize], prescribed: &[usize]) -> Self {
        let mut holders = vec![Vec::new(); train.columns];
        let (mut rows, mut scales) = (Vec::new(), Vec::new());
        for (i, row) in train.rows.iter().enumerate() {
            let mut row = row.entries();
            let largest = row.iter().fold(0.0_f64, |most, (_, x)| most.max(x.abs()));
            let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            for (column, x) in &mut row {
                *x *= scale;
                holders[*column].push(i);
            }
            rows.push(row);
            scales.push(scale);
        }
        let mut reduced = Self {
            columns: train.columns,
            pivots: vec![None; rows.len()],
            rows,
            holders,
            scales,
            steps: Vec::new(),
        };
        let mut groups = vec![0; train.columns];
        for (columns, group) in [(ports, 1), (prescribed, 2)] {
            for column in columns {
                groups[*column] = group;
            }
        }
        for group in 0..3 {
            reduced.eliminate((0..train.columns).filter(|column| groups[*column] == group));
        }
        reduced
    }

    /// Eliminates columns, those in the fewest rows first, so that few rows are changed.
    fn eliminate(&mut self, columns: impl Iterator<Item = usize>) {
        let mut open: BTreeSet<(usize, usize)> = columns.map(|column| (self.holders[column].len(), column)).collect();
        while let Some((_, column)) = open.pop_first() {
            let Some(row) = self.pivot_row(column) else { continue };
            let pivot = self.entry(row, column);
            for (place, x) in &mut self.rows[row] {
                *x = if *place == column { 1.0 } else { *x / pivot };
            }
            self.steps.push(Step::Divide { row, by: pivot });
            self.pivots[row] = Some(column);
            let of_pivot = self.rows[row].clone();
            for from in std::mem::replace(&mut self.holders[column], vec![row]) {
                if from != row {
                    self.subtract(from, row, &of_pivot, column, &mut open);
                }
            }
        }
    }

    /// The row with the largest entry in a column among those without a pivot, if that is not rounding error; of equal ones the first.
    fn pivot_row(&self, column: usize) -> Option<usize> {
        let mut rows: Vec<usize> = self.holders[column].clone();
        rows.retain(|row| self.pivots[*row].is_none());
        rows.sort_unstable();
        let mut best = (ZERO, None);
        for row in rows {
            let size = self.entry(row, column).abs();
            if size > best.0 * (1.0 + 1e-9) {
                best = (size, Some(row));
            }
        }
        best.1
    }

    /// Subtracts the multiple of a pivot row that makes the entry of another row in the pivot column zero.
    fn subtract(
        &mut self,
        from: usize,
        row: usize,
        of_pivot: &[(usize, f64)],
        pivot: usize,
        open: &mut BTreeSet<(usize, usize)>,
    ) {
        let factor = self.entry(from, pivot);
        self.steps.push(Step::Subtract { from, row, factor });
        let reduced_from = std::mem::take(&mut self.rows[from]);
        let mut reduced = Vec::with_capacity(reduced_from.len() + of_pivot.len());
        let (mut entries, mut other) = (reduced_from.into_iter().peekable(), of_pivot.iter().peekable());
        while let Some(column) = [entries.peek().map(|x| x.0), other.peek().map(|y| y.0)]
            .into_iter()
            .flatten()
            .min()
        {
            let x = entries.next_if(|x| x.0 == column).map(|x| x.1);
            let y = other.next_if(|y| y.0 == column).map(|y| y.1);
            let entry = y.map_or(x.unwrap_or(0.0), |y| x.unwrap_or(0.0) - factor * y);
            if column == pivot {
                continue;
            }
            match (x.is_some(), entry != 0.0) {
                (false, true) => self.hold(column, open, |holders| holders.push(from)),
                (true, false) => self.hold(column, open, |holders| holders.retain(|row| *row != from)),
                _ => {}
            }
            if entry != 0.0 {
                reduced.push((column, entry));
            }
        }
        self.rows[from] = reduced;
    }

    /// Changes the rows with an entry in a column, and its place in the order of elimination.
    fn hold(&mut self, column: usize, open: &mut BTreeSet<(usize, usize)>, change: impl FnOnce(&mut Vec<usize>)) {
        let holders = &mut self.holders[column];
        let waits = open.remove(&(holders.len(), column));
        change(holders);
        if waits {
            open.insert((holders.len(), column));
        }
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        let row = &self.rows[row];
        row.binary_search_by_key(&column, |entry| entry.0)
            .map_or(0.0, |place| row[place].1)
    }

    /// A reduced row as a combination of the original ones.
    fn origin(&self, row: usize) -> Vec<f64> {
        let mut shares = vec![0.0; self.rows.len()];
        shares[row] = 1.0;
        for step in self.steps.iter().rev() {
            match step {
                Step::Divide { row, by } => shares[*row] /= by,
                Step::Subtract { from, row, factor } => shares[*row] -= factor * shares[*from],
            }
        }
        shares
            .iter()
            .zip(&self.scales)
            .map(|(share, scale)| share * scale)
            .collect()
    }

    /// Operations on rows, and the entries that are left.
    #[cfg(test)]
    pub fn work(&self) -> usize {
        self.steps.len() + self.rows.iter().map(Vec::len).sum::<usize>()
    }

    pub fn rank(&self) -> usize {
        self.pivots.iter().flatten().count()
    }

    fn free(&self) -> Vec<usize> {
        let mut free = vec![true; self.columns];
        for pivot in self.pivots.iter().flatten() {
            free[*pivot] = false;
        }
        (0..self.columns).filter(|column| free[*column]).collect()
    }

    /// The motion in which one free column has speed one and the other free ones are stationary.
    pub(crate) fn null_vector(&self, free: usize) -> Vec<f64> {
        let mut vector = vec![0.0; self.columns];
        vector[free] = 1.0;
        for row in &self.holders[free] {
            if let Some(pivot) = self.pivots[*row] {
                vector[pivot] = -self.entry(*row, free);
            }
        }
        let largest = vector.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for x in &mut vector {
            if x.abs() <= 1e-13 * largest {
                *x = 0.0;
            }
        }
        vector
    }

    /// Original rows of each row that became zero.
    pub fn loops(&self) -> Vec<Vec<usize>> {
        let zero = self.pivots.iter().enumerate().filter(|(_, pivot)| pivot.is_none());
        zero.map(|(row, _)| big(&self.origin(row))).collect()
    }

    pub fn faults(&self, ports: &[usize], prescribed: &[usize]) -> Vec<Fault> {
        let mut faults = Vec::new();
        for free in self.free().into_iter().filter(|c| !prescribed.contains(c)) {
            let columns = big(&self.null_vector(free));
            let among = columns.iter().copied().filter(|c| ports.contains(c)).collect();
            faults.push(Fault::Under { columns, ports: among });
        }
        for (i, pivot) in self.pivots.iter().enumerate() {
            let Some(port) = pivot.filter(|p| prescribed.contains(p)) else {
                continue;
            };
            let rows = big(&self.origin(i));
            let largest = self.rows[i].iter().fold(0.0_f64, |most, (_, x)| most.max(x.abs()));
            let others = self.rows[i]
                .iter()
                .filter(|(c, x)| *c != port && x.abs() > ROUNDING * largest);
            let others: Vec<(usize, f64)> = others.map(|(c, x)| (*c, -x)).collect();
            faults.push(if others.is_empty() {
                Fault::Locked { port, rows }
            } else {
                Fault::Tied { port, others, rows }
            });
        }
        faults
    }
}

/// Indices of entries that are not rounding error.
fn big(vector: &[f64]) -> Vec<usize> {
    let largest = vector.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (0..vector.len())
        .filter(|i| vector[*i].abs() > ROUNDING * largest && vector[*i] != 0.0)
        .collect()
}
