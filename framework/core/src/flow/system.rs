//! The equations of equilibrium: multipliers of rows and torques of ports, at given losses.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::order::{Laws, Order};
use super::structure::matching;
use super::work::Drive;
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
    /// True if it may lose more than half of its power and still turn, as a worm drive: its loss is followed up to all of the power.
    pub steep: bool,
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

/// A drag whose law depends on torques of the flow.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedDrag {
    /// Number of its component, for the caller.
    pub component: usize,
    /// Columns between which it acts.
    pub between: [Option<usize>; 2],
    /// What its law depends on, the most important first.
    pub reads: Vec<Reading>,
    /// Drags with a common group are evaluated together.
    pub group: Option<usize>,
}

/// A torque on which a law depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// The multiplier of a row.
    Row(usize),
    /// The torque of the port on a column.
    Port(usize),
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

/// Orders that are kept: more patterns of driving gears than a study of one gear state meets.
const MOST_KEPT: usize = 64;

/// The equilibrium of one gear state for one choice of given torques. Laws are numbered: those of the meshes first, then those of the
/// drags.
#[derive(Debug, Clone)]
pub struct Flow {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Unknowns of each equation with their coefficients: equilibrium of each column, then the splits. An unknown is the multiplier of
    /// a row over its scale, then the torque of a port.
    pub(super) equations: Vec<Vec<(usize, f64)>>,
    /// The equation that each unknown is matched with.
    pub(super) matched: Vec<usize>,
    pub(super) scale: Vec<f64>,
    pub(super) meshes: Vec<MeshRow>,
    /// For each mesh what a lost multiplier adds to the right-hand sides of equations: if the second gear is driven, and if the first
    /// one is.
    pub(super) friction: Vec<[Vec<(usize, f64)>; 2]>,
    pub(super) drags: Vec<LoadedDrag>,
    pub(super) unknown: Vec<usize>,
    pub(super) given: Vec<usize>,
    /// All laws.
    pub(super) laws: Laws,
    /// The order without losses.
    pub(super) lossless: Arc<Order>,
    /// Orders with losses that were needed so far, by the pattern of driven gears.
    orders: Arc<Mutex<Vec<Arc<Order>>>>,
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
        (unknown, given): (Vec<usize>, Vec<usize>),
        drags: Vec<LoadedDrag>,
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
        let mut entries: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        let mut scale = Vec::with_capacity(m);
        for (k, row) in train.rows.iter().enumerate() {
            let terms = row.entries();
            let largest = terms
                .iter()
                .fold(0.0_f64, |most, (_, x)| most.max(x.abs()))
                .max(f64::MIN_POSITIVE);
            scale.push(1.0 / largest);
            entries.extend(terms.iter().map(|(i, x)| ((*i, k), x / largest)));
        }
        for (k, port) in unknown.iter().enumerate() {
            entries.insert((*port, m + k), 1.0);
        }
        // Scaled columns: a torque is the entry times the unknown in both rows of a split, so the scales cancel.
        let parts: Vec<(usize, f64, usize, usize)> = shares
            .into_iter()
            .enumerate()
            .flat_map(|(r, Share { member, a, b })| [(a.0, b.1, member, n + r), (b.0, -a.1, member, n + r)])
            .collect();
        for &(row, part, member, equation) in &parts {
            let torque = entries.get(&(member, row)).copied().unwrap_or(0.0);
            entries.insert((equation, row), part * torque);
        }
        let mut equations = vec![Vec::new(); size];
        for ((equation, unknown), entry) in entries.into_iter().filter(|(_, entry)| *entry != 0.0) {
            equations[equation].push((unknown, entry));
        }
        let friction = meshes.iter().map(|mesh| {
            [(mesh.second, mesh.sz2), (mesh.first, mesh.z1)].map(|(driven, coefficient)| {
                let mut change: BTreeMap<usize, f64> = BTreeMap::new();
                if let Some(driven) = driven {
                    *change.entry(driven).or_default() += coefficient * scale[mesh.row];
                }
                if let Some(carrier) = mesh.carrier {
                    *change.entry(carrier).or_default() -= coefficient * scale[mesh.row];
                }
                for &(_, part, member, equation) in parts.iter().filter(|part| part.0 == mesh.row) {
                    let torque = change.get(&member).copied().unwrap_or(0.0);
                    *change.entry(equation).or_default() += part * torque;
                }
                change.into_iter().filter(|(_, x)| *x != 0.0).collect()
            })
        });
        let mut flow = Self {
            columns: n,
            rows: m,
            matched: matching(&equations).ok_or(FlowFault::Singular)?,
            friction: friction.collect(),
            laws: Laws {
                meshes: (0..meshes.len()).collect(),
                drags: (0..drags.len()).collect(),
            },
            equations,
            scale,
            meshes,
            drags,
            unknown,
            given,
            lossless: Arc::default(),
            orders: Arc::default(),
        };
        flow.lossless = Arc::new(Order::new(&flow, None).ok_or(FlowFault::Singular)?);
        Ok(flow)
    }

    /// The meshes among the rows.
    pub fn meshes(&self) -> &[MeshRow] {
        &self.meshes
    }

    /// The drags that depend on torques.
    pub fn drags(&self) -> &[LoadedDrag] {
        &self.drags
    }

    /// The order for these driving gears. `None` only if rounding makes a loop singular.
    pub(super) fn order(&self, drives: &[Drive]) -> Option<Arc<Order>> {
        let mut kept = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(order) = kept.iter().find(|order| order.is_of(drives)) {
            return Some(Arc::clone(order));
        }
        let driven: Vec<Driven> = drives.iter().map(|drive| drive.driven()).collect();
        let order = Arc::new(Order::new(self, Some(&driven))?);
        if kept.len() < MOST_KEPT {
            kept.push(Arc::clone(&order));
        }
        Some(order)
    }

    /// Number of an unknown.
    pub(super) fn unknown_of(&self, reading: Reading) -> Option<usize> {
        match reading {
            Reading::Row(row) => Some(row),
            Reading::Port(column) => {
                let port = self.unknown.iter().position(|port| *port == column)?;
                Some(self.rows + port)
            }
        }
    }
}

/// The driven gear of a mesh, which loses torque: the second one, or the first.
pub(super) type Driven = usize;
