//! The square system of equilibrium: multipliers of rows and torques of ports.

use std::collections::BTreeMap;

use super::factors::Elimination;
use super::linear::inverse;
use super::sparse::{SparseMatrix, SparseVector};
use crate::kinematics::Train;

/// A mesh among the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshRow {
    /// Number of the row.
    pub row: usize,
    /// Column of the first gear.
    pub first: Option<usize>,
    /// Coefficient of the first gear.
    pub z1: f64,
    /// Column of the second gear.
    pub second: Option<usize>,
    /// Coefficient of the second gear, with its sign.
    pub sz2: f64,
    /// Column of the carrier.
    pub carrier: Option<usize>,
}

/// Torque split of a member between two rows: `part_b * torque_a = part_a * torque_b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Column of the member.
    pub member: usize,
    /// First row and its part.
    pub a: (usize, f64),
    /// Second row and its part.
    pub b: (usize, f64),
}

/// Why no torques can be found.
#[derive(Debug, Clone, PartialEq)]
pub enum FlowFault {
    /// The wrong number of given torques.
    Count {
        /// Torques that must be given.
        needed: usize,
        /// Torques that are given.
        given: usize,
    },
    /// Redundant loops without a torque split: the rows of each.
    Redundant {
        /// Rows of each loop.
        loops: Vec<Vec<usize>>,
    },
    /// The given torques depend on each other, or the splits do not resolve their loops.
    Singular,
}

/// Change of the column of a mesh by friction, for either driven gear.
#[derive(Debug, Clone)]
pub(super) struct Friction {
    pub row: usize,
    /// Second gear driven, first gear driven.
    pub sides: [Side; 2],
}

/// One driven side of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Side {
    /// Change of the column per share of loss: less torque on the driven gear, the reaction on the carrier.
    pub change: SparseVector,
}

/// The inverse times the change of a side.
#[derive(Debug, Clone)]
pub(super) struct Response {
    pub response: SparseVector,
    /// Its entries at the rows of all meshes.
    pub coupling: Vec<f64>,
}

/// How the equilibrium is solved.
#[derive(Debug, Clone)]
pub(super) enum Solver {
    /// Of gearboxes: the inverse without friction, and the responses of each mesh for both sides, of which friction is a change of low
    /// rank. Their entries grow with the square of the number of members.
    Inverse {
        inverse: SparseMatrix,
        responses: Vec<[Response; 2]>,
    },
    /// Of larger trains: elimination for each friction; entries of each mesh that friction changes, for both sides.
    Elimination {
        elimination: Elimination,
        changed: Vec<[Vec<(usize, f64)>; 2]>,
    },
}

/// Size of the largest system whose inverse is computed: beyond it, elimination is faster.
const LARGEST_INVERSE: usize = 64;

/// The equilibrium of one gear state for one choice of given torques.
#[derive(Debug, Clone)]
pub struct Flow {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) size: usize,
    /// The matrix without friction.
    pub(super) base: SparseMatrix,
    pub(super) solver: Solver,
    /// Scale of each row: the unknown is the multiplier over its scale.
    pub(super) scale: Vec<f64>,
    pub(super) meshes: Vec<MeshRow>,
    /// Effect of friction on the column of each mesh.
    pub(super) friction: Vec<Friction>,
    pub(super) unknown: Vec<usize>,
    pub(super) given: Vec<usize>,
}

impl Flow {
    /// The flow of a train. `unknown` and `given` are the columns of ports without and with a given torque; `loops` are
    /// those of `Motion`.
    ///
    /// # Errors
    /// If the number of given torques or of splits does not match, or the system is singular.
    pub fn new(
        train: &Train,
        meshes: Vec<MeshRow>,
        shares: Vec<Share>,
        loops: &[Vec<usize>],
        unknown: Vec<usize>,
        given: Vec<usize>,
    ) -> Result<Self, FlowFault> {
        let (n, m) = (train.columns, train.rows.len());
        let rank = m - loops.len();
        let freedom = n - rank;
        if unknown.len() != freedom {
            let ports = unknown.len() + given.len();
            return Err(FlowFault::Count {
                needed: ports.saturating_sub(freedom),
                given: given.len(),
            });
        }
        if shares.len() != loops.len() {
            return Err(FlowFault::Redundant { loops: loops.to_vec() });
        }
        let size = m + unknown.len();
        let mut base: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        let mut scale = Vec::with_capacity(m);
        for (k, row) in train.rows.iter().enumerate() {
            let entries = row.entries();
            let largest = entries
                .iter()
                .fold(0.0_f64, |most, (_, x)| most.max(x.abs()))
                .max(f64::MIN_POSITIVE);
            scale.push(1.0 / largest);
            base.extend(entries.iter().map(|(i, x)| ((*i, k), x / largest)));
        }
        for (k, port) in unknown.iter().enumerate() {
            base.insert((*port, m + k), 1.0);
        }
        // Scaled columns: a torque is the entry times the unknown in both rows of a split, so the scales cancel.
        let parts: Vec<(usize, f64, usize, usize)> = shares
            .into_iter()
            .enumerate()
            .flat_map(|(r, Share { member, a, b })| [(a.0, b.1, member, n + r), (b.0, -a.1, member, n + r)])
            .collect();
        for &(row, part, member, equation) in &parts {
            let torque = base.get(&(member, row)).copied().unwrap_or(0.0);
            base.insert((equation, row), part * torque);
        }
        base.retain(|_, entry| *entry != 0.0);
        let friction: Vec<Friction> = meshes
            .iter()
            .map(|mesh| Friction {
                row: mesh.row,
                sides: [(mesh.second, mesh.sz2), (mesh.first, mesh.z1)].map(|(driven, coefficient)| {
                    let mut change: BTreeMap<usize, f64> = BTreeMap::new();
                    if let Some(driven) = driven {
                        *change.entry(driven).or_default() -= coefficient * scale[mesh.row];
                    }
                    if let Some(carrier) = mesh.carrier {
                        *change.entry(carrier).or_default() += coefficient * scale[mesh.row];
                    }
                    for &(_, part, member, equation) in parts.iter().filter(|part| part.0 == mesh.row) {
                        let torque = change.get(&member).copied().unwrap_or(0.0);
                        *change.entry(equation).or_default() += part * torque;
                    }
                    Side {
                        change: SparseVector::new(change),
                    }
                }),
            })
            .collect();
        let solver = if size <= LARGEST_INVERSE {
            Solver::inverse(&base, size, &friction)
        } else {
            Solver::elimination(&base, size, &friction)
        };
        Ok(Self {
            columns: n,
            rows: m,
            size,
            base: SparseMatrix::new(base, size),
            solver: solver.ok_or(FlowFault::Singular)?,
            scale,
            meshes,
            friction,
            unknown,
            given,
        })
    }

    /// The meshes among the rows.
    pub fn meshes(&self) -> &[MeshRow] {
        &self.meshes
    }
}

impl Solver {
    /// The solver by the inverse; absent if the matrix is singular.
    fn inverse(base: &BTreeMap<(usize, usize), f64>, size: usize, friction: &[Friction]) -> Option<Self> {
        let mut dense = vec![0.0; size * size];
        for (&(row, column), &entry) in base {
            dense[column * size + row] = entry;
        }
        let dense = inverse(dense, size)?;
        let entries = (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
        let entries = entries.map(|(row, column)| ((row, column), dense[column * size + row]));
        let inverse = SparseMatrix::new(entries.filter(|(_, entry)| *entry != 0.0), size);
        let response = |side: &Side| {
            let mut change = vec![0.0; size];
            side.change.add(1.0, &mut change);
            let mut response = vec![0.0; size];
            inverse.product(&change, &mut response);
            Response {
                coupling: friction.iter().map(|other| response[other.row]).collect(),
                response: SparseVector::new(response.into_iter().enumerate()),
            }
        };
        Some(Self::Inverse {
            responses: friction
                .iter()
                .map(|mesh| mesh.sides.each_ref().map(response))
                .collect(),
            inverse,
        })
    }

    /// The solver by elimination; absent if the matrix is singular.
    fn elimination(base: &BTreeMap<(usize, usize), f64>, size: usize, friction: &[Friction]) -> Option<Self> {
        let elimination = Elimination::new(base, size)?;
        let changed = |mesh: &Friction| {
            mesh.sides.each_ref().map(|side| {
                // Friction changes the torques of a mesh, which are entries already.
                let entries = side.change.entries();
                entries
                    .filter_map(|(row, x)| Some((elimination.place(row, mesh.row)?, x)))
                    .collect()
            })
        };
        Some(Self::Elimination {
            changed: friction.iter().map(changed).collect(),
            elimination,
        })
    }

    /// Length of the factors for so many meshes.
    pub(crate) fn factor_count(&self, meshes: usize) -> usize {
        match self {
            Self::Inverse { .. } => meshes * meshes,
            Self::Elimination { elimination, .. } => elimination.len(),
        }
    }
}
