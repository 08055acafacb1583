//! Speeds of all members: homogeneous constraint rows, degrees of freedom, and the causes if a state cannot move.
//!
//! Rows are exact kinematic constraints (Willis); nothing here depends on the kind of gearbox.

mod eliminate;

pub use eliminate::Fault;
use eliminate::Reduced;

use crate::real::Real;

/// One constraint: the sum of coefficient times speed over columns is zero. Columns may repeat; their coefficients add.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Column and coefficient. The housing has no column.
    pub terms: Vec<(usize, f64)>,
}

impl Row {
    /// Gears 1 and 2 of a mesh on a carrier: `z1 (w1 - wc) + s z2 (w2 - wc) = 0`. A column of `None` is stationary.
    pub fn mesh(first: Option<usize>, z1: f64, second: Option<usize>, sz2: f64, carrier: Option<usize>) -> Self {
        let terms = [(first, z1), (second, sz2), (carrier, -(z1 + sz2))];
        Self {
            terms: terms
                .into_iter()
                .filter_map(|(column, z)| column.map(|c| (c, z)))
                .collect(),
        }
    }

    /// Two columns with equal speed; `None` is the housing.
    pub fn joined(a: Option<usize>, b: Option<usize>) -> Self {
        Self {
            terms: a.map(|a| (a, 1.0)).into_iter().chain(b.map(|b| (b, -1.0))).collect(),
        }
    }

    /// A column that is the difference of two others, each with a factor.
    pub fn difference(left: (usize, f64), right: (usize, f64), difference: usize) -> Self {
        Self {
            terms: vec![left, (right.0, -right.1), (difference, -1.0)],
        }
    }

    /// Column and coefficient by column, each column once, without zeros.
    pub fn entries(&self) -> Vec<(usize, f64)> {
        let mut entries = self.terms.clone();
        entries.sort_by_key(|(column, _)| *column);
        entries.dedup_by(|next, first| {
            let repeats = next.0 == first.0;
            if repeats {
                first.1 += next.1;
            }
            repeats
        });
        entries.retain(|(_, coefficient)| *coefficient != 0.0);
        entries
    }
}

/// The columns and rows of one gear state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Train {
    /// Number of columns: members, and differences that may be prescribed.
    pub columns: usize,
    /// Constraints.
    pub rows: Vec<Row>,
}

/// Speeds as a linear map of the prescribed ones. Built once per state and set of prescribed ports.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    columns: usize,
    /// Column by column of the map, `columns` numbers for each prescribed port.
    map: Vec<f64>,
    /// Rows of each redundant loop.
    pub loops: Vec<Vec<usize>>,
}

impl Motion {
    /// The motion of a train whose speeds are prescribed at some columns. `ports` are all columns at which speeds could be
    /// prescribed.
    ///
    /// # Errors
    /// Every fault of the state for this prescription; redundant loops are not a fault here.
    pub fn new(train: &Train, ports: &[usize], prescribed: &[usize]) -> Result<Self, Vec<Fault>> {
        let reduced = Reduced::new(train, ports, prescribed);
        let faults = reduced.faults(ports, prescribed);
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut map = vec![0.0; train.columns * prescribed.len()];
        for (k, port) in prescribed.iter().enumerate() {
            for (column, value) in reduced.null_vector(*port).into_iter().enumerate() {
                map[k * train.columns + column] = value;
            }
        }
        Ok(Self {
            columns: train.columns,
            map,
            loops: reduced.loops(),
        })
    }

    /// Degrees of freedom of a train.
    pub fn freedom(train: &Train) -> usize {
        train.columns - Reduced::new(train, &[], &[]).rank()
    }

    /// Speeds of all columns from those of the prescribed ports.
    pub fn speeds<R: Real>(&self, prescribed: &[R], speeds: &mut [R]) {
        let speeds = &mut speeds[..self.columns];
        speeds.fill(R::ZERO);
        for (column, prescribed) in self.map.chunks_exact(self.columns.max(1)).zip(prescribed) {
            for (speed, factor) in speeds.iter_mut().zip(column) {
                *speed += *prescribed * *factor;
            }
        }
        let fastest = speeds.iter().fold(R::ZERO, |most, w| most.max(w.abs()));
        for speed in speeds {
            let moves = speed.abs().is_above(fastest * 1e-12);
            *speed = R::select(moves, *speed, R::ZERO);
        }
    }
}

#[cfg(test)]
mod tests;
