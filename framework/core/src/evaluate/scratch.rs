//! Workspace for one evaluation, of one point or of several together, and observations over many.

use std::cell::Cell;
use std::sync::Arc;

use super::found_friction::FoundFriction;
use crate::attach::{Incline, Oil, State};
use crate::flow::{Balance, Status, Work};
use crate::hydraulics::{self, Supplies};
use crate::loads::SupportLoad;
use crate::loss::{Extent, Kept, Loss, Notebook, Seen, Trace, Undefined, nanowatts};
use crate::real::{Mask as _, Points};
use crate::sump::{Lifted, Travel};
use crate::transmission::{Case, Sump, Transmission};

/// What models read, and where they note.
#[derive(Debug, Clone)]
pub(super) struct Conditions<R: Points> {
    pub speeds: Vec<R>,
    pub temperatures: Vec<R>,
    pub oils: Vec<Oil<R>>,
    pub surface: R,
    pub rest: R,
    /// Inclination of the housing in addition to that as built. \[rad\]
    pub inclination: R,
    /// How the housing travels, if a point inclines it.
    pub travel: Option<Travel>,
    /// Flows and pressures of the oil network.
    pub hydraulics: hydraulics::Work<R>,
    pub loads: Vec<SupportLoad<R>>,
    /// Points that are solved; among several, those that are missing must be solved alone.
    pub live: R::Mask,
    /// True if all points have their speeds and temperatures in common.
    pub common: bool,
    /// Values that models keep over the iterations of a point, and over points with the same speeds and temperatures, by instance.
    pub kept: Vec<Cell<Kept<R>>>,
    /// The same for points that are evaluated one by one.
    pub kept_alone: Vec<Cell<Kept<f64>>>,
    pub cells: Vec<Cell<Seen>>,
    /// Target of the steps of models, if they are recorded.
    pub trace: Option<Trace>,
    /// Loss model evaluations for the points.
    pub calls: Cell<usize>,
}

/// The inclination of a housing that travels. \[rad\]
#[inline(always)]
pub(super) fn incline<R>(travel: Option<&Travel>, angle: R) -> Option<Incline<'_, R>> {
    travel.map(|travel| Incline { travel, angle })
}

impl<R: Points> Conditions<R> {
    /// What models read, and the notebook; a closed one unless they note.
    #[inline(always)]
    pub fn open(&self, notes: bool) -> (State<'_, R>, Notebook<'_, R>) {
        let state = State {
            speeds: &self.speeds,
            oils: &self.oils,
            temperatures: &self.temperatures,
            surface: self.surface,
            rest: self.rest,
            incline: incline(self.travel.as_ref(), self.inclination),
            supplies: Supplies {
                elements: &self.hydraulics.supplies,
                pockets: &self.hydraulics.pockets,
            },
            loads: &self.loads,
            calls: &self.calls,
        };
        let book = Notebook {
            cells: if notes { &self.cells } else { &[] },
            points: R::bits(self.live),
            starts: !0,
            kept: &self.kept,
            kept_alone: if self.common { &self.kept_alone } else { &[] },
            trace: self.trace.as_ref(),
        };
        (state, book)
    }

    /// Forgets the notes and the values that models keep.
    pub fn forget(&mut self) {
        self.cells.fill(Cell::new(Seen::NOTHING));
        self.kept.fill(Cell::new(None));
        self.kept_alone.fill(Cell::new(None));
    }

    /// The first of the points that are solved; the first of all if there is none.
    pub fn first(&self) -> usize {
        (0..R::COUNT).find(|point| self.live.at_point(*point)).unwrap_or(0)
    }

    /// What the first point decides by a condition; those that decide otherwise leave.
    #[inline(always)]
    pub fn decide(&mut self, condition: R::Mask) -> bool {
        let decided = condition.at_point(self.first());
        self.live = self.live & if decided { condition } else { !condition };
        decided
    }

    /// True if a model is outside its stated range at a point, among the cells of models.
    pub fn leaves_a_range(&self, point: usize, cells: usize) -> bool {
        let mut seen = self.cells[..cells].iter();
        seen.any(|seen| seen.get().outside() >> point & 1 == 1)
    }
}

/// What models read and return.
#[derive(Debug, Clone)]
pub(super) struct Models<R: Points> {
    pub conditions: Conditions<R>,
    /// Loads and tangential forces with the most loaded planet of each set, and with each of those with other loads; empty if planets share
    /// equally. \[-, N\]
    pub uneven_loads: Vec<Vec<SupportLoad<R>>>,
    pub uneven_forces: Vec<Vec<R>>,
    /// Tangential force of each mesh whose transverse force turns with the carrier; empty if planets share equally. \[N\]
    pub turning: Vec<R>,
    pub passed: Vec<R>,
    /// Closings of pairs with a preload, by member; empty without such pairs. \[m\]
    pub closings: Vec<R>,
    /// Tangential force of each mesh at the present torques; those of chains follow. \[N\]
    pub forces: Vec<R>,
    /// Friction force of each mesh at the present torques, with the sign of the speed of the first gear, and at others of the point; empty
    /// without meshes on axes that cross. \[N\]
    pub friction: Vec<R>,
    pub found_friction: Vec<FoundFriction<R>>,
    /// True if the numbers have derivatives, which change where the numbers themselves do not.
    pub derives: bool,
    /// True if the power flow is ideal: losses change no torque.
    pub ideal: bool,
    pub component_losses: Vec<Result<Loss<R>, Undefined>>,
    pub mesh_losses: Vec<Result<Loss<R>, Undefined>>,
    /// That of each chain, joint and differential.
    pub transfer_losses: Vec<Result<Loss<R>, Undefined>>,
    pub drag_losses: Vec<Result<Loss<R>, Undefined>>,
    /// What each gear lifts out of the sump.
    pub lifted: Vec<Lifted<R>>,
    /// Relative speed of each component. \[rad/s\]
    pub relative: Vec<R>,
    /// True for each component that is stationary.
    pub rests: Vec<bool>,
    /// Evaluations of laws at the point so far, and the one in which the loads of each group of supports were found.
    pub round: usize,
    pub loaded: Vec<usize>,
}

/// Workspace for evaluating the points of one case. All of it is allocated once.
#[derive(Debug, Clone)]
pub struct Scratch<R: Points = f64> {
    pub(super) models: Models<R>,
    pub(super) prescribed: Vec<R>,
    pub(super) work: Work<R>,
    pub(super) watts: Vec<R>,
    pub(super) sum: R,
    pub(super) undefined: Option<(usize, Undefined)>,
    pub(super) balance: Balance<R>,
    /// Of each point.
    pub(super) status: Vec<Status>,
    /// True if nothing rotates.
    pub(super) standing: bool,
    /// True if the power flow is ideal.
    pub(super) ideal: bool,
    pub(super) passes: R,
    /// Loss model evaluations for previous points.
    pub(super) called: usize,
    /// Observed extents of every limit and observed quantity since the scratch was made, one count per point.
    pub totals: Vec<Extent>,
    /// As [`Transmission::limited`].
    limited: Arc<[(usize, usize)]>,
}

impl<R: Points> Scratch<R> {
    /// Loss model evaluations for all points so far.
    pub(crate) fn all_calls(&self) -> usize {
        self.called + self.models.conditions.calls.get()
    }

    /// Observed extents since the scratch was made or since the last call.
    pub fn take_totals(&mut self) -> Vec<Extent> {
        let empty = vec![Extent::EMPTY; self.totals.len()];
        std::mem::replace(&mut self.totals, empty)
    }

    /// Counts the observations at the last evaluated points as those of further points.
    pub(crate) fn count_seen(&mut self) {
        let c = &self.models.conditions;
        let solved = R::bits(c.live);
        for (total, seen) in self.totals.iter_mut().zip(&c.cells) {
            total.count(seen.get().among(solved));
        }
        for (cell, part) in &*self.limited {
            let outside = c.cells[*cell].get().among(solved).outside();
            let points = (0..R::COUNT).filter(|point| outside >> point & 1 == 1);
            let total = &mut self.totals[*cell].lost_outside;
            for point in points {
                *total = total.saturating_add(nanowatts(self.watts[*part].at_point(point)));
            }
        }
    }

    /// Output power of a point with losses; with ideal power flow the input minus the losses, `None` if they exceed it. \[W\]
    pub(super) fn output_power(&self, point: usize) -> Option<f64> {
        let balance = self.balance.at_point(point);
        match self.status[point] {
            Status::LossAboveInput => None,
            _ if self.ideal => Some((balance.input - self.sum.at_point(point)).max(0.0)),
            _ => Some(balance.output),
        }
    }

    pub(super) fn new(transmission: &Transmission, case: &Case) -> Self {
        let columns = case.flow.columns();
        let (supports, meshes) = (transmission.supports.len(), transmission.meshes.len());
        let instances = transmission.instances.len();
        let forces = transmission.force_factors().count();
        let zeros = |count: usize| vec![R::ZERO; count];
        // Not evaluated yet.
        let losses = |count: usize| vec![Ok(Loss::POWERS); count];
        let with_friction = if transmission.has_crossed_meshes() { meshes } else { 0 };
        Self {
            models: Models {
                conditions: Conditions {
                    speeds: zeros(columns),
                    temperatures: Vec::with_capacity(transmission.nodes()),
                    oils: vec![Oil::default(); transmission.oils.len()],
                    surface: R::ZERO,
                    rest: R::ZERO,
                    inclination: R::ZERO,
                    travel: None,
                    hydraulics: hydraulics::Work::new(&transmission.hydraulics),
                    loads: vec![SupportLoad::default(); supports],
                    live: R::mask(|_| true),
                    common: false,
                    kept: vec![Cell::new(None); instances],
                    kept_alone: vec![Cell::new(None); instances],
                    cells: vec![Cell::new(Seen::NOTHING); transmission.cells],
                    trace: None,
                    calls: Cell::new(0),
                },
                uneven_loads: vec![vec![SupportLoad::default(); supports]; transmission.uneven],
                uneven_forces: vec![zeros(forces); transmission.uneven],
                turning: zeros(if transmission.uneven > 0 { forces } else { 0 }),
                passed: zeros(transmission.loads.scratch_len()),
                closings: zeros(if transmission.pairs.iter().any(|pair| pair.preload.is_some()) {
                    transmission.members.len()
                } else {
                    0
                }),
                forces: zeros(forces),
                friction: zeros(with_friction),
                found_friction: vec![FoundFriction::NONE; with_friction],
                derives: false,
                ideal: false,
                component_losses: losses(transmission.components.len()),
                mesh_losses: losses(meshes),
                transfer_losses: losses(transmission.transfers.len()),
                drag_losses: losses(transmission.drags.len()),
                lifted: vec![Lifted::default(); transmission.oils.sump.as_ref().map_or(0, Sump::lifts)],
                relative: zeros(transmission.components.len()),
                rests: vec![false; transmission.components.len()],
                round: 0,
                loaded: vec![0; transmission.loads.groups().len()],
            },
            prescribed: zeros(case.speed_ports.len() + case.ruled_speeds),
            work: case.flow.work(),
            watts: zeros(transmission.parts.len()),
            sum: R::ZERO,
            undefined: None,
            balance: Balance {
                input: R::ZERO,
                output: R::ZERO,
            },
            status: vec![Status::Standstill; R::COUNT],
            standing: false,
            ideal: false,
            passes: R::ZERO,
            called: 0,
            totals: vec![Extent::EMPTY; transmission.cells],
            limited: Arc::clone(&transmission.limited),
        }
    }
}

impl Scratch {
    /// Loss model evaluations for the last evaluated point.
    pub fn calls(&self) -> usize {
        self.models.conditions.calls.get()
    }

    /// Losses of all parts at the last evaluated point, in their order; zero if undefined. \[W\]
    pub fn watts(&self) -> &[f64] {
        &self.watts
    }

    /// Limits that are exceeded at the last point: cell of the notes and loss of a component that uses the model. \[W\]
    pub fn lost_outside(&self) -> impl Iterator<Item = (usize, f64)> {
        let cells = &self.models.conditions.cells;
        let exceeded = self
            .limited
            .iter()
            .filter(|(cell, _)| cells[*cell].get().outside() != 0);
        exceeded.map(|(cell, part)| (*cell, self.watts[*part]))
    }

    /// Counts what heat models note as one more point.
    pub(crate) fn note_heat<T>(&mut self, run: impl FnOnce(&[Cell<Seen>]) -> T) -> T {
        let cells = vec![Cell::new(Seen::NOTHING); self.totals.len()];
        let result = run(&cells);
        for (total, seen) in self.totals.iter_mut().zip(cells) {
            *total = total.merge(seen.get().extent());
        }
        result
    }

    /// Speeds of the members. \[rad/s\]
    pub fn speeds(&self) -> &[f64] {
        &self.models.conditions.speeds
    }

    /// Operating state of the transmission.
    pub fn status(&self) -> Status {
        self.status[0]
    }

    /// Input and output power. \[W\]
    pub fn power(&self) -> [f64; 2] {
        [self.balance.input, self.balance.output]
    }

    /// Torque that a port of a member applies. \[Nm\]
    pub fn port_torque(&self, member: usize) -> f64 {
        self.work.ports[member]
    }
}
