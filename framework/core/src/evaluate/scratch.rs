//! Workspace for one evaluation, and observations over many.

use std::cell::Cell;

use crate::attach::Oil;
use crate::flow::{Balance, Status, Work};
use crate::loads::SupportLoad;
use crate::loss::{Extent, Loss, MOST_KEPT, Undefined};
use crate::transmission::{Case, Transmission};

/// A loss that has not been evaluated yet.
const NOT_YET: Result<Loss, Undefined> = Ok(Loss::POWERS);

/// Workspace for evaluating the points of one case. All of it is allocated once.
#[derive(Debug, Clone)]
pub struct Scratch {
    pub(super) prescribed: Vec<f64>,
    pub(super) given: Vec<f64>,
    pub(super) speeds: Vec<f64>,
    pub(super) temperatures: Vec<f64>,
    pub(super) oils: Vec<Oil>,
    pub(super) surface: f64,
    pub(super) loads: Vec<SupportLoad>,
    /// Loads with the most loaded planet of each set, and with each other planet; empty if planets share equally.
    pub(super) uneven_loads: [Vec<SupportLoad>; 2],
    /// Tangential forces with those of a planet's meshes; empty if planets share equally.
    pub(super) uneven_forces: Vec<f64>,
    pub(super) passed: Vec<f64>,
    pub(super) tangential: Vec<f64>,
    pub(super) component_losses: Vec<Result<Loss, Undefined>>,
    pub(super) mesh_losses: Vec<Result<Loss, Undefined>>,
    pub(super) drag_losses: Vec<Result<Loss, Undefined>>,
    pub(super) idle_drags: Vec<f64>,
    /// Relative speed of each component. \[rad/s\]
    pub(super) relative: Vec<f64>,
    /// Rotating components that carry load: they are evaluated in every iteration.
    pub(super) braking: Vec<usize>,
    /// Values that models keep over the iterations of a point or the points of a batch, by instance.
    pub(super) kept: Vec<[f64; MOST_KEPT]>,
    pub(super) cells: Vec<Extent>,
    pub(super) work: Work,
    pub(super) watts: Vec<f64>,
    pub(super) sum: f64,
    pub(super) undefined: Option<(usize, Undefined)>,
    pub(super) balance: Balance,
    pub(super) status: Status,
    pub(super) passes: usize,
    /// Loss model evaluations for the point.
    pub(super) calls: Cell<usize>,
    /// Loss model evaluations for previous points.
    pub(super) called: usize,
    /// Observed extents of every limit and observed quantity since the scratch was made, one count per point.
    pub totals: Vec<Extent>,
}

impl Scratch {
    /// Loss model evaluations for the last evaluated point.
    pub fn calls(&self) -> usize {
        self.calls.get()
    }

    /// Observed extents since the scratch was made or since the last call.
    pub fn take_totals(&mut self) -> Vec<Extent> {
        let empty = vec![Extent::EMPTY; self.totals.len()];
        std::mem::replace(&mut self.totals, empty)
    }

    /// Losses of all parts at the last evaluated point, in their order; zero if undefined. \[W\]
    pub fn watts(&self) -> &[f64] {
        &self.watts
    }

    /// Speeds of the members (rad/s), and the note cells of heat models.
    pub(crate) fn speeds_and_cells(&mut self) -> (&[f64], &[Cell<Extent>]) {
        (&self.speeds, Cell::from_mut(&mut self.cells[..]).as_slice_of_cells())
    }

    /// Loss model evaluations for all points so far.
    pub fn all_calls(&self) -> usize {
        self.called + self.calls.get()
    }

    /// Speeds of the members. \[rad/s\]
    pub fn speeds(&self) -> &[f64] {
        &self.speeds
    }

    /// Operating state of the transmission.
    pub fn status(&self) -> Status {
        self.status
    }

    /// Input and output power. \[W\]
    pub fn power(&self) -> [f64; 2] {
        [self.balance.input, self.balance.output]
    }

    /// Torque that a port of a member applies. \[Nm\]
    pub fn port_torque(&self, member: usize) -> f64 {
        self.work.ports[member]
    }

    /// Share of the heat of a mesh that enters its first gear.
    pub(crate) fn first_heat(&self, mesh: usize) -> f64 {
        self.mesh_losses[mesh].as_ref().map_or(0.5, Loss::first_heat)
    }

    /// Counts the observations at the last evaluated point as one more point.
    pub(crate) fn count_seen(&mut self) {
        for (total, seen) in self.totals.iter_mut().zip(&self.cells) {
            if seen.seen > 0 {
                *total = total.merge(seen.once());
            }
        }
    }

    /// Note cells of heat dissipation models; they count over all points.
    pub(crate) fn heat_cells(&mut self) -> &mut [Extent] {
        &mut self.totals
    }

    pub(super) fn new(transmission: &Transmission, case: &Case) -> Self {
        let columns = case.flow.columns();
        let supports = transmission.supports.len();
        Self {
            prescribed: vec![0.0; case.speed_ports.len() + case.ruled_speeds],
            given: vec![0.0; case.torque_ports.len() + case.ruled_torques],
            speeds: vec![0.0; columns],
            temperatures: Vec::with_capacity(transmission.nodes()),
            oils: vec![Oil::default(); transmission.oils.len()],
            surface: 0.0,
            loads: vec![SupportLoad::default(); supports],
            uneven_loads: [(); 2].map(|()| {
                let count = if transmission.uneven { supports } else { 0 };
                vec![SupportLoad::default(); count]
            }),
            uneven_forces: vec![
                0.0;
                if transmission.uneven {
                    transmission.meshes.len()
                } else {
                    0
                }
            ],
            passed: vec![0.0; transmission.loads.scratch_len()],
            tangential: vec![0.0; transmission.meshes.len()],
            component_losses: vec![NOT_YET; transmission.components.len()],
            mesh_losses: vec![NOT_YET; transmission.meshes.len()],
            drag_losses: vec![NOT_YET; transmission.drags.len()],
            idle_drags: vec![0.0; columns],
            relative: vec![0.0; transmission.components.len()],
            braking: Vec::with_capacity(transmission.components.len()),
            kept: vec![[f64::NAN; MOST_KEPT]; transmission.instances.len()],
            cells: vec![Extent::EMPTY; transmission.cells],
            work: case.flow.work(),
            watts: vec![0.0; transmission.parts.len()],
            sum: 0.0,
            undefined: None,
            balance: Balance {
                input: 0.0,
                output: 0.0,
            },
            status: Status::Standstill,
            passes: 0,
            calls: Cell::new(0),
            called: 0,
            totals: vec![Extent::EMPTY; transmission.cells],
        }
    }
}
