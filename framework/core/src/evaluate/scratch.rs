//! Space for one evaluation, and what was seen over many.

use std::cell::Cell;

use crate::attach::Oil;
use crate::flow::{Balance, Status, Work};
use crate::loads::SupportLoad;
use crate::loss::{Extent, Loss, MOST_KEPT, Undefined};
use crate::transmission::{Case, Transmission};

/// A loss that was not evaluated yet.
const NOT_YET: Result<Loss, Undefined> = Ok(Loss::POWERS);

/// Space for evaluating the points of one case. Everything is allocated here, once.
#[derive(Debug, Clone)]
pub struct Scratch {
    pub(super) prescribed: Vec<f64>,
    pub(super) given: Vec<f64>,
    pub(super) speeds: Vec<f64>,
    pub(super) temperatures: Vec<f64>,
    pub(super) oils: Vec<Oil>,
    pub(super) surface: f64,
    pub(super) loads: Vec<SupportLoad>,
    /// Loads with the most loaded planet of each set, and with each of the others; empty where planets share equally.
    pub(super) uneven_loads: [Vec<SupportLoad>; 2],
    /// Tangential forces with those of a planet's meshes; empty where planets share equally.
    pub(super) uneven_forces: Vec<f64>,
    pub(super) passed: Vec<f64>,
    pub(super) tangential: Vec<f64>,
    pub(super) component_losses: Vec<Result<Loss, Undefined>>,
    pub(super) mesh_losses: Vec<Result<Loss, Undefined>>,
    pub(super) drag_losses: Vec<Result<Loss, Undefined>>,
    pub(super) idle_drags: Vec<f64>,
    /// Relative speed of each component. \[rad/s\]
    pub(super) relative: Vec<f64>,
    /// Components that carry load and turn: they are asked in every pass.
    pub(super) braking: Vec<usize>,
    /// What the models keep over the passes of a point or the points of a row, by instance.
    pub(super) kept: Vec<[f64; MOST_KEPT]>,
    pub(super) cells: Vec<Extent>,
    pub(super) work: Work,
    pub(super) watts: Vec<f64>,
    pub(super) sum: f64,
    pub(super) undefined: Option<(usize, Undefined)>,
    pub(super) balance: Balance,
    pub(super) status: Status,
    pub(super) passes: usize,
    /// Loss models asked for the point.
    pub(super) asked: Cell<usize>,
    /// Loss models asked for the points before.
    pub(super) called: usize,
    /// What was seen of every limit and observed quantity since the scratch was made, one count for each point.
    pub totals: Vec<Extent>,
}

impl Scratch {
    /// Calls of loss models for the point that was evaluated last.
    pub fn calls(&self) -> usize {
        self.asked.get()
    }

    /// What was seen since the scratch was made or this was asked last.
    pub fn take_totals(&mut self) -> Vec<Extent> {
        let empty = vec![Extent::EMPTY; self.totals.len()];
        std::mem::replace(&mut self.totals, empty)
    }

    /// Losses of all parts at the point that was evaluated last, in their order; zero where undefined. \[W\]
    pub fn watts(&self) -> &[f64] {
        &self.watts
    }

    /// Speeds of the members there (rad/s), and where laws of heat note what they see.
    pub(crate) fn speeds_and_cells(&mut self) -> (&[f64], &[Cell<Extent>]) {
        (&self.speeds, Cell::from_mut(&mut self.cells[..]).as_slice_of_cells())
    }

    /// Calls of loss models for all points so far.
    pub fn all_calls(&self) -> usize {
        self.called + self.asked.get()
    }

    /// Speeds of the members there. \[rad/s\]
    pub fn speeds(&self) -> &[f64] {
        &self.speeds
    }

    /// What the transmission does there.
    pub fn status(&self) -> Status {
        self.status
    }

    /// Power in and out there. \[W\]
    pub fn power(&self) -> [f64; 2] {
        [self.balance.input, self.balance.output]
    }

    /// Torque that a port of a member applies there. \[Nm\]
    pub fn port_torque(&self, member: usize) -> f64 {
        self.work.ports[member]
    }

    /// Share of the heat of a mesh that goes into its first gear.
    pub(crate) fn first_heat(&self, mesh: usize) -> f64 {
        self.mesh_losses[mesh].as_ref().map_or(0.5, Loss::first_heat)
    }

    /// What was seen at the point that was evaluated last counts as one more point.
    pub(crate) fn count_seen(&mut self) {
        for (total, seen) in self.totals.iter_mut().zip(&self.cells) {
            if seen.seen > 0 {
                *total = total.merge(seen.once());
            }
        }
    }

    /// Where models of heat dissipation note what they saw; it counts over all points.
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
            asked: Cell::new(0),
            called: 0,
            totals: vec![Extent::EMPTY; transmission.cells],
        }
    }
}
