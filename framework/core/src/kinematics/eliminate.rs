//! Gauss-Jordan elimination in three groups of columns: members, ports without, ports with a prescribed speed. The order provides
//! the diagnosis: a member is free only if nothing constrains it.

use super::Train;

/// Entries of scaled rows below this are rounding error; tooth numbers differ by far more.
const ZERO: f64 = 1e-10;

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

pub(super) struct Reduced {
    columns: usize,
    /// Reduced rows.
    rows: Vec<Vec<f64>>,
    /// Each reduced row as a combination of the original ones.
    history: Vec<Vec<f64>>,
    /// Pivot column of each row; `None` for rows that became zero.
    pivots: Vec<Option<usize>>,
}

impl Reduced {
    pub fn new(train: &Train, ports: &[usize], prescribed: &[usize]) -> Self {
        let n = train.columns;
        let m = train.rows.len();
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(m);
        let mut history = Vec::with_capacity(m);
        for (i, row) in train.rows.iter().enumerate() {
            let mut dense = row.dense(n);
            let largest = dense.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            for x in &mut dense {
                *x *= scale;
            }
            rows.push(dense);
            let mut unit = vec![0.0; m];
            unit[i] = scale;
            history.push(unit);
        }
        let mut reduced = Self {
            columns: n,
            rows,
            history,
            pivots: vec![None; m],
        };
        let group = |column: usize| {
            if prescribed.contains(&column) {
                2
            } else {
                usize::from(ports.contains(&column))
            }
        };
        for wanted in 0..3 {
            let columns: Vec<usize> = (0..n).filter(|c| group(*c) == wanted).collect();
            reduced.eliminate(&columns);
        }
        reduced
    }

    fn eliminate(&mut self, columns: &[usize]) {
        loop {
            let mut best = (ZERO, None);
            for i in 0..self.rows.len() {
                if self.pivots[i].is_some() {
                    continue;
                }
                for &j in columns {
                    let size = self.rows[i][j].abs();
                    if size > best.0 * (1.0 + 1e-9) {
                        best = (size, Some((i, j)));
                    }
                }
            }
            let Some((i, j)) = best.1 else { return };
            let pivot = self.rows[i][j];
            self.rows[i].iter_mut().for_each(|x| *x /= pivot);
            self.history[i].iter_mut().for_each(|x| *x /= pivot);
            self.rows[i][j] = 1.0;
            self.pivots[i] = Some(j);
            let (row, past) = (self.rows[i].clone(), self.history[i].clone());
            for k in 0..self.rows.len() {
                let factor = self.rows[k][j];
                if k == i || factor == 0.0 {
                    continue;
                }
                for (x, y) in self.rows[k].iter_mut().zip(&row) {
                    *x -= factor * y;
                }
                for (x, y) in self.history[k].iter_mut().zip(&past) {
                    *x -= factor * y;
                }
                self.rows[k][j] = 0.0;
            }
        }
    }

    pub fn rank(&self) -> usize {
        self.pivots.iter().flatten().count()
    }

    fn free(&self) -> Vec<usize> {
        (0..self.columns).filter(|c| !self.pivots.contains(&Some(*c))).collect()
    }

    /// The motion in which one free column has speed one and the other free ones are stationary.
    pub fn null_vector(&self, free: usize) -> Vec<f64> {
        let mut vector = vec![0.0; self.columns];
        vector[free] = 1.0;
        for (row, pivot) in self.rows.iter().zip(&self.pivots) {
            if let Some(pivot) = pivot {
                vector[*pivot] = -row[free];
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
        self.history
            .iter()
            .zip(&self.pivots)
            .filter(|(_, pivot)| pivot.is_none())
            .map(|(past, _)| big(past))
            .collect()
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
            let rows = big(&self.history[i]);
            let others: Vec<(usize, f64)> = big(&self.rows[i])
                .into_iter()
                .filter(|c| *c != port)
                .map(|c| (c, -self.rows[i][c]))
                .collect();
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
        .filter(|i| vector[*i].abs() > 1e-9 * largest && vector[*i] != 0.0)
        .collect()
}
