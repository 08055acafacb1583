//! Batched points that differ in one torque.
//!
//! Speeds, oils and all values that depend only on them, including notes, are computed once per batch. The numbers of [`Batch::solve`]
//! are those of [`Transmission::evaluate`] to the bit, except for the sign of zero; the same holds for points that are evaluated
//! one by one, see [`Block::alone`].

mod block;
mod shared;

use std::cell::Cell;

pub use block::Block;
use shared::Shared;

use super::{Point, PowerFlow, Scratch, Solution};
use crate::attach::State;
use crate::flow::{Drive, FlowLanes, TaskLanes, TorqueHistory, WorkLanes};
use crate::lanes::{LANES, Lane, LaneNotes, LossLanes, Powers, count, each, is_even, over, weighted, wide};
use crate::loads::{LEAST_STATIC_SAFETY, LoadLanes, SupportLoad};
use crate::loss::{Extent, Measure, NoteBase, Notebook, Notes};
use crate::transmission::{Case, Component, PartInfo, PartKind, Transmission};

/// No untaken thrust.
static NO_THRUST: Lane = Lane::ZERO;

/// Workspace for the batches of one case. All of it is allocated once, except the values that [`Batch::follow`] keeps of previous batches.
#[derive(Debug, Clone)]
pub struct BatchScratch {
    /// The state of the batch.
    state: Scratch,
    /// For points that are evaluated one by one.
    alone: Scratch,
    work: WorkLanes,
    /// One for each block of a batch, in their order.
    histories: Vec<TorqueHistory>,
    /// For each of these blocks the remembered values of its components and meshes.
    powers: Vec<Vec<Powers>>,
    /// The next block.
    next: usize,
    /// The given values of the previous batch, except its first speed and its first torque.
    before: Vec<f64>,
    given: Vec<Lane>,
    /// Torques of ports for load corrections.
    ports: Vec<Lane>,
    tangential: Vec<Lane>,
    /// Torques on the first gears of the meshes.
    mesh_torques: Vec<Lane>,
    passed: Vec<Lane>,
    loads: Vec<LoadLanes>,
    /// Loads and port torques of one lane.
    one: Vec<SupportLoad>,
    one_ports: Vec<f64>,
    components: Vec<LossLanes>,
    meshes: Vec<LossLanes>,
    /// Ratio of the power used in the balance to the last result, times copies, by mesh.
    factors: Vec<Lane>,
    watts: Vec<Lane>,
    sum: Lane,
    alone_lanes: [bool; LANES],
    outside: [Cell<bool>; LANES],
    /// Notes shared by all lanes of a block, and those of each lane.
    common: Vec<Extent>,
    own: Vec<Extent>,
    totals: Vec<Extent>,
    /// Points of the batch for which the shared notes have not been counted yet.
    points: u32,
    /// True if a shared note is outside the range of a model.
    row_outside: bool,
    /// Results of components and meshes in blocks where all lanes have equal loads.
    shared_loads: Vec<Shared<SupportLoad>>,
    shared_torques: Vec<Shared<(f64, Drive)>>,
    called: usize,
}

impl BatchScratch {
    /// Observed extents of every limit and observed quantity since the last call, one count per point.
    pub fn take_totals(&mut self) -> Vec<Extent> {
        self.count_row();
        let pairs = self.totals.iter_mut().zip(self.alone.take_totals());
        pairs
            .map(|(row, alone)| std::mem::replace(row, Extent::EMPTY).merge(alone))
            .collect()
    }

    /// Forgets the previous batches, so that [`Batch::follow`] starts again.
    pub fn forget(&mut self) {
        self.histories.iter_mut().for_each(TorqueHistory::clear);
        self.powers.iter_mut().flatten().for_each(Powers::forget);
    }

    /// Counts the shared notes for the points of the batch.
    fn count_row(&mut self) {
        let points = std::mem::take(&mut self.points);
        for (total, seen) in self.totals.iter_mut().zip(&self.state.cells) {
            if points > 0 && seen.seen > 0 {
                *total = total.merge(seen.times(points));
            }
        }
    }

    /// Number of loss model evaluations for all points so far. An evaluation of a block counts once for each of its points, also if
    /// the result is that of the previous block because all points have equal loads.
    pub fn calls(&self) -> usize {
        self.called + self.state.all_calls() + self.alone.all_calls()
    }
}

/// Points that differ in the first given torque.
pub struct Batch<'a> {
    transmission: &'a Transmission,
    case: &'a Case,
    point: Point<'a>,
    temperatures: &'a [f64],
    /// False if every point must be evaluated one by one.
    together: bool,
    s: &'a mut BatchScratch,
}

impl Transmission {
    /// Workspace for evaluating the batches of a case; one per thread.
    pub fn batch_scratch(&self, case: &Case) -> BatchScratch {
        let lanes = |count: usize| vec![Lane::all(0.0); count];
        let supports = self.supports.len();
        BatchScratch {
            state: self.scratch(case),
            alone: self.scratch(case),
            work: case.flow.work_batched(),
            histories: Vec::new(),
            powers: Vec::new(),
            next: 0,
            before: Vec::new(),
            given: lanes(case.torque_ports.len() + case.ruled_torques),
            ports: lanes(case.flow.columns()),
            tangential: lanes(self.meshes.len()),
            mesh_torques: lanes(self.meshes.len()),
            passed: lanes(self.loads.scratch_len()),
            loads: vec![LoadLanes::NONE; supports],
            one: vec![SupportLoad::default(); supports],
            one_ports: vec![0.0; case.flow.columns()],
            components: vec![LossLanes::NONE; self.components.len()],
            meshes: vec![LossLanes::NONE; self.meshes.len()],
            factors: lanes(self.meshes.len()),
            watts: lanes(self.parts.len()),
            sum: Lane::all(0.0),
            alone_lanes: [false; LANES],
            outside: std::array::from_fn(|_| Cell::new(false)),
            common: vec![Extent::EMPTY; self.cells],
            own: vec![Extent::EMPTY; LANES * self.cells],
            totals: vec![Extent::EMPTY; self.cells],
            points: 0,
            row_outside: false,
            shared_loads: vec![Shared::NONE; self.components.len()],
            shared_torques: vec![Shared::NONE; self.meshes.len()],
            called: 0,
        }
    }

    /// False for parts whose loss is computed once per batch.
    fn depends_on_torque(&self, part: &PartInfo) -> bool {
        match part.kind {
            PartKind::Component(i) => self.components[i].loaded && !self.components[i].off,
            PartKind::Mesh(_) => true,
            PartKind::Drag(_) => false,
        }
    }

    /// Writes the notes that are independent of load, once for all points of a batch.
    fn note_row(&self, s: &mut Scratch) {
        let cells = Cell::from_mut(s.cells.as_mut_slice()).as_slice_of_cells();
        let kept = Cell::from_mut(s.kept.as_mut_slice()).as_slice_of_cells();
        let state = State {
            speeds: &s.speeds,
            oils: &s.oils,
            temperatures: &s.temperatures,
            surface: s.surface,
            loads: &s.loads,
            calls: &s.calls,
        };
        for component in &self.components {
            if !component.loaded || component.off || component.notes_depend_on_load {
                continue;
            }
            let common = Notes::fresh(cells, component.notes).keeping(kept);
            let notes = LaneNotes {
                common,
                own: &[],
                totals: &[],
                counted: &[false; LANES],
                points: 0,
                outside: &std::array::from_fn(|_| Cell::new(false)),
                handed: &Cell::new(false),
                base: component.notes,
            };
            if !component.placed.note(&state, &LoadLanes::NONE, notes) {
                let _ = component.placed.loss(&state, &common.book);
            }
        }
    }

    /// Prepares a batch of points at the temperatures of the nodes, or at one for all nodes. \[degC\]
    ///
    /// # Panics
    /// As [`Transmission::evaluate`], and if the case gives no torque: bugs of the caller.
    pub fn batch<'a>(
        &'a self,
        case: &'a Case,
        point: &Point<'a>,
        temperatures: &'a [f64],
        scratch: &'a mut BatchScratch,
    ) -> Batch<'a> {
        assert!(!case.torque_ports.is_empty(), "a case that gives a torque");
        let speeds = point.speeds.get(1..).unwrap_or_default().iter();
        let rest = speeds
            .chain(&point.torques[1..])
            .chain(temperatures)
            .chain([&point.tolerance.power]);
        if !scratch.before.iter().eq(rest.clone()) {
            scratch.before.clear();
            scratch.before.extend(rest);
            scratch.forget();
        }
        scratch.next = 0;
        let torques = point.torques.iter().copied().chain(std::iter::repeat(0.0));
        for (given, torque) in scratch.given.iter_mut().zip(torques) {
            *given = Lane::all(torque);
        }
        scratch.count_row();
        scratch.shared_loads.fill(Shared::NONE);
        scratch.shared_torques.fill(Shared::NONE);
        let s = &mut scratch.state;
        let standing = self.settle(case, point, temperatures, s, false);
        let sound = |part: &PartInfo| match part.kind {
            PartKind::Component(i) => self.components[i].loaded || s.component_losses[i].is_ok(),
            PartKind::Drag(i) => s.drag_losses[i].is_ok(),
            PartKind::Mesh(_) => true,
        };
        let cheap = self.meshes.iter().all(|mesh| mesh.model.off || !mesh.model.is_costly());
        let together =
            point.flow == PowerFlow::Real && !standing && !self.uneven && cheap && self.parts.iter().all(sound);
        if together {
            self.note_row(s);
            scratch.row_outside = s.cells.iter().any(|seen| seen.outside > 0);
            for (part, watts) in self.parts.iter().zip(&mut scratch.watts) {
                if !self.depends_on_torque(part) {
                    *watts = Lane::all(self.part_watts(part, s).unwrap_or(0.0));
                }
            }
        }
        Batch {
            transmission: self,
            case,
            point: *point,
            temperatures,
            together,
            s: scratch,
        }
    }
}

impl Batch<'_> {
    /// Solves the points with these first torques, at most [`LANES`]. \[Nm\]
    ///
    /// # Panics
    /// If there are none or too many: a bug of the caller.
    pub fn solve(&mut self, torques: &[f64]) -> Block<'_> {
        self.block(torques, false)
    }

    /// As [`Batch::solve`], with the first torques extrapolated from the blocks with the same number and torques in previous batches
    /// that differ only in the first speed, and with remembered powers of loads. One iteration is then often enough, and the losses
    /// agree with those of [`Batch::solve`] within the tolerance, not to the bit.
    ///
    /// # Panics
    /// As [`Batch::solve`].
    pub fn follow(&mut self, torques: &[f64]) -> Block<'_> {
        self.block(torques, true)
    }

    fn block(&mut self, torques: &[f64], following: bool) -> Block<'_> {
        assert!((1..=LANES).contains(&torques.len()), "1 to {LANES} torques");
        self.s.alone_lanes = [true; LANES];
        if self.together {
            wide(
                #[inline(always)]
                || self.solve_together(torques, following),
            );
        }
        Block {
            transmission: self.transmission,
            reference: self.transmission.reference_port(),
            s: self.s,
        }
    }

    /// Evaluates a single point of the batch.
    pub fn alone(&mut self, torque: f64) -> Solution<'_> {
        let count = self.point.torques.len();
        let torques = &mut self.s.state.given[..count];
        torques[0] = torque;
        let point = Point { torques, ..self.point };
        self.transmission
            .evaluate(self.case, &point, self.temperatures, &mut self.s.alone)
    }

    #[inline(always)]
    #[expect(clippy::too_many_lines, reason = "one iteration borrows parts of the scratch apart")]
    fn solve_together(&mut self, torques: &[f64], following: bool) {
        let (t, case) = (self.transmission, self.case);
        let BatchScratch {
            state: settled,
            work,
            histories,
            powers,
            next,
            given,
            ports,
            tangential,
            mesh_torques,
            passed,
            loads,
            one,
            one_ports,
            components,
            meshes,
            factors,
            watts,
            sum,
            alone_lanes,
            outside,
            common,
            own,
            totals,
            points: row_points,
            row_outside,
            shared_loads,
            shared_torques,
            called,
            ..
        } = &mut *self.s;
        // Lanes without a point repeat the last one and are not read.
        let (first, others) = given[0].split_at_mut(torques.len());
        first.copy_from_slice(torques);
        others.fill(torques[torques.len() - 1]);
        *alone_lanes = [false; LANES];
        let points: [bool; LANES] = std::array::from_fn(|i| i < torques.len());
        for losses in components.iter_mut().chain(&mut *meshes) {
            losses.clear(&points);
        }
        let followed = self.point.speeds.first().filter(|_| following).map(|speed| {
            let number = *next;
            *next += 1;
            if histories.len() == number {
                histories.push(TorqueHistory::default());
            }
            (number, speed.abs().ln())
        });
        let mut remembered = followed.map(|(number, _)| {
            while powers.len() <= number {
                powers.push(vec![Powers::remembering(); components.len() + meshes.len()]);
            }
            &mut powers[number]
        });
        exchange(&mut remembered, components, meshes);
        let kept = Cell::from_mut(settled.kept.as_mut_slice()).as_slice_of_cells();
        // Notes are written once, for the last results.
        let book = Notebook {
            kept,
            ..Notebook::CLOSED
        };
        let state = State {
            speeds: &settled.speeds,
            oils: &settled.oils,
            temperatures: &settled.temperatures,
            surface: settled.surface,
            loads: &settled.loads,
            calls: &settled.calls,
        };
        let corrected = t.imported.is_some() || !t.load_factors.is_empty();
        let braking = &settled.braking;
        let losses = |flow: &mut FlowLanes<'_>| {
            wide(
                #[inline(always)]
                || {
                    let some_done = flow.done.contains(&true);
                    let rows = t.meshes.iter().zip(tangential.iter_mut()).zip(flow.multipliers);
                    for ((mesh, tangential), multiplier) in rows {
                        let force = |i: usize| multiplier[i] * mesh.force_per_multiplier;
                        *tangential = if some_done {
                            each(|i| if flow.done[i] { tangential[i] } else { force(i) })
                        } else {
                            each(force)
                        };
                    }
                    if corrected {
                        loads.fill(LoadLanes::NONE);
                    }
                    t.loads.evaluate_batched(tangential, state.speeds, passed, loads);
                },
            );
            if corrected {
                for (own, flow_ports) in ports.iter_mut().zip(flow.ports) {
                    *own = each(|i| if flow.done[i] { own[i] } else { flow_ports[i] });
                }
                t.correct_lanes(case, ports, (one, one_ports), loads);
            }
            let (wanted, calls) = wide(
                #[inline(always)]
                || {
                    for (drags, idle) in flow.drags.iter_mut().zip(&settled.idle_drags) {
                        *drags = Lane::all(*idle);
                    }
                    let mut wanted = [false; LANES];
                    for i in 0..LANES {
                        wanted[i] = points[i] && !flow.done[i] && !alone_lanes[i];
                    }
                    (wanted, count(|i| wanted[i]) as usize)
                },
            );
            for &i in braking {
                let (component, speed) = (&t.components[i], settled.relative[i]);
                *called += calls;
                if calls < torques.len() {
                    components[i].want(&wanted);
                }
                let untaken = evaluate_component(
                    component,
                    &state,
                    loads,
                    one,
                    &book,
                    &mut shared_loads[i],
                    &mut components[i],
                );
                wide(
                    #[inline(always)]
                    || {
                        let sum = components[i].sound_sum(untaken);
                        let count = t.copies(i, state.speeds);
                        let between = component.between;
                        brake_lanes(between, count, speed, &sum, components[i].measure(), flow.drags);
                    },
                );
                leave(alone_lanes, &components[i]);
            }
            for (i, mesh) in t.meshes.iter().enumerate() {
                if mesh.model.off {
                    continue;
                }
                let at = t.mesh_at(i, 0.0, flow.drives[i], &state, &book);
                let radius = mesh.seat.pair.working_radius[0];
                let own_torques = &mut mesh_torques[i];
                let even = wide(
                    #[inline(always)]
                    || {
                        *own_torques = over(&tangential[i], |force| (force * radius).abs());
                        is_even(own_torques)
                    },
                );
                *called += calls;
                if calls < torques.len() {
                    meshes[i].want(&wanted);
                }
                if even {
                    let at = at.with(|to| to.torque = own_torques[0]);
                    let answer = shared_torques[i].answer((own_torques[0], flow.drives[i]), || mesh.model.loss(&at));
                    meshes[i].put_all(answer);
                } else {
                    mesh.model.losses(&at, own_torques, &mut meshes[i]);
                }
                wide(
                    #[inline(always)]
                    || {
                        meshes[i].sound_sum(&NO_THRUST);
                        flow.mesh_loss[i] = if at.speed == 0.0 {
                            Lane::all(0.0)
                        } else {
                            let grip = t.mesh_grip(i, state.speeds);
                            meshes[i].total_watts(at.speed, |watts| watts * mesh.seat.count * mesh.loss_factor * grip)
                        };
                    },
                );
                leave(alone_lanes, &meshes[i]);
            }
        };
        let task = TaskLanes {
            speeds: state.speeds,
            torques: given,
            steady: &settled.idle_drags,
            tolerance: self.point.tolerance,
        };
        let history = followed.map(|(number, place)| (&mut histories[number], place));
        case.flow.real_batched(&task, history, work, losses);
        for (own, flow) in alone_lanes.iter_mut().zip(&work.alone) {
            *own |= flow;
        }
        exchange(&mut remembered, components, meshes);
        // Stationary components that carry load have no drag, but their loss may be undefined.
        let resting = |i: &usize| {
            let component = &t.components[*i];
            component.loaded && !component.off && settled.relative[*i] == 0.0
        };
        for i in (0..t.components.len()).filter(resting) {
            *called += torques.len();
            let untaken = evaluate_component(
                &t.components[i],
                &state,
                loads,
                one,
                &book,
                &mut shared_loads[i],
                &mut components[i],
            );
            components[i].sound_sum(untaken);
            leave(alone_lanes, &components[i]);
        }

        // Notes of the last results, once.
        let counted: [bool; LANES] = std::array::from_fn(|i| i < torques.len() && !alone_lanes[i]);
        let points = counted.iter().filter(|counted| **counted).count() as u32;
        if points == 0 {
            return;
        }
        for flag in &*outside {
            flag.set(*row_outside);
        }
        *row_points += points;
        {
            let handed = Cell::new(false);
            let common = Cell::from_mut(&mut common[..]).as_slice_of_cells();
            let own = Cell::from_mut(&mut own[..]).as_slice_of_cells();
            let totals = Cell::from_mut(&mut totals[..]).as_slice_of_cells();
            let notes = |base: NoteBase| {
                handed.set(false);
                LaneNotes {
                    common: Notes::new(common, base).keeping(kept),
                    own,
                    totals,
                    counted: &counted,
                    points,
                    outside,
                    handed: &handed,
                    base,
                }
            };
            // Notes of one part.
            let gather = |base: NoteBase| {
                if handed.get() {
                    gather(base, own, totals, &counted, outside);
                }
                for cell in base.limits()..base.end() {
                    let seen = common[cell].get();
                    if seen.seen > 0 {
                        totals[cell].set(totals[cell].get().merge(seen.times(points)));
                        if seen.outside > 0 {
                            for flag in &*outside {
                                flag.set(true);
                            }
                        }
                    }
                }
            };
            for (i, component) in t.components.iter().enumerate() {
                let Some(support) = component
                    .support
                    .filter(|_| component.loaded && !component.off && component.notes_depend_on_load)
                else {
                    continue;
                };
                let notes = notes(component.notes);
                let own_loads = &loads[support as usize];
                // Notes common to all lanes are written once.
                if own_loads.is_even() {
                    let load = own_loads.lane(0);
                    shared_loads[i].note(load, || {
                        one[support as usize] = load;
                        let state = State { loads: one, ..state };
                        component.placed.loss(&state, &notes.all().anew().book)
                    });
                    gather(component.notes);
                    continue;
                }
                shared_loads[i].overwritten();
                notes.all().anew();
                if component.placed.note(&state, own_loads, notes) {
                    gather(component.notes);
                    continue;
                }
                for lane in (0..LANES).filter(|lane| counted[*lane]) {
                    one[support as usize] = own_loads.lane(lane);
                    let state = State { loads: one, ..state };
                    let _ = component.placed.loss(&state, &notes.lane(lane).book);
                }
                gather(component.notes);
            }
            for (i, mesh) in t.meshes.iter().enumerate() {
                if mesh.model.off {
                    continue;
                }
                let notes = notes(mesh.model.notes);
                let at = t.mesh_at(i, 0.0, work.drives[i], &state, &notes.all().book);
                let own_torques = &mesh_torques[i];
                let even = wide(
                    #[inline(always)]
                    || is_even(own_torques),
                );
                if even {
                    shared_torques[i].note((own_torques[0], work.drives[i]), || {
                        notes.all().anew();
                        mesh.model.loss(&at.with(|to| to.torque = own_torques[0]))
                    });
                    gather(mesh.model.notes);
                    continue;
                }
                shared_torques[i].overwritten();
                notes.all().anew();
                mesh.model.note(&at, own_torques, &meshes[i], notes);
                gather(mesh.model.notes);
            }
            for (rated, total) in t.rated.iter().zip(&totals[t.rated_cells()..]) {
                let loads = &loads[rated.support];
                for lane in (0..LANES).filter(|lane| counted[*lane]) {
                    if let Some(safety) = rated.rating.safety(loads.radial[lane], loads.axial[lane]) {
                        let seen = Extent::point(safety, safety, safety < LEAST_STATIC_SAFETY);
                        total.set(total.get().merge(seen));
                    }
                }
            }
        }
        wide(
            #[inline(always)]
            || {
                let torqued = t
                    .parts
                    .iter()
                    .zip(&mut *watts)
                    .filter(|(part, _)| t.depends_on_torque(part));
                for (part, watts) in torqued {
                    *watts = match part.kind {
                        PartKind::Component(i) if settled.relative[i] == 0.0 => Lane::ZERO,
                        PartKind::Component(i) => {
                            let count = t.copies(i, state.speeds);
                            components[i].total_watts(settled.relative[i], |watts| watts * count)
                        }
                        PartKind::Mesh(i) => {
                            let count = t.meshes[i].seat.count * t.meshes[i].loss_factor;
                            let speed = t.mesh_speed(i, state.speeds);
                            let total = meshes[i].total_watts(speed, |watts| watts);
                            let used = &work.mesh_loss[i];
                            factors[i] = each(|lane| {
                                let returned = total[lane] * count;
                                count * if returned > 0.0 { used[lane] / returned } else { 1.0 }
                            });
                            if speed == 0.0 {
                                Lane::ZERO
                            } else {
                                each(|lane| total[lane] * factors[i][lane])
                            }
                        }
                        // Computed once per batch.
                        PartKind::Drag(_) => *watts,
                    };
                }
                *sum = weighted(watts.iter().map(|watts| (1.0, watts)));
            },
        );
    }
}

/// Evaluates the model of a component in all lanes; returns the untaken thrust.
fn evaluate_component<'a>(
    component: &Component,
    state: &State<'_>,
    loads: &'a [LoadLanes],
    one: &mut [SupportLoad],
    book: &Notebook<'_>,
    shared: &mut Shared<SupportLoad>,
    losses: &mut LossLanes,
) -> &'a Lane {
    let Some(support) = component.support.map(usize::from) else {
        return &NO_THRUST;
    };
    let own = &loads[support];
    if own.is_even() {
        let load = own.lane(0);
        losses.put_all(shared.answer(load, || {
            one[support] = load;
            component.placed.loss(&State { loads: one, ..*state }, book)
        }));
    } else if !component.placed.losses(state, own, book, losses) {
        for lane in 0..LANES {
            if !losses.wanted(lane) {
                continue;
            }
            one[support] = own.lane(lane);
            losses.put(lane, component.placed.loss(&State { loads: one, ..*state }, book));
        }
    }
    &own.untaken
}

/// Moves the remembered values of a block to components and meshes, or back.
fn exchange(remembered: &mut Option<&mut Vec<Powers>>, components: &mut [LossLanes], meshes: &mut [LossLanes]) {
    if let Some(remembered) = remembered {
        for (losses, own) in components.iter_mut().chain(meshes).zip(remembered.iter_mut()) {
            std::mem::swap(losses.powers(), own);
        }
    }
}

/// Lanes that a model excludes from the batch.
fn leave(alone: &mut [bool; LANES], losses: &LossLanes) {
    for (alone, left) in alone.iter_mut().zip(losses.alone()) {
        *alone |= left;
    }
}

/// As [`brake`] in all lanes.
#[inline(always)]
fn brake_lanes(between: [Option<u16>; 2], count: f64, speed: f64, sums: &Lane, measure: Measure, drags: &mut [Lane]) {
    for (member, sense) in between.into_iter().zip([-1.0, 1.0]) {
        let Some(member) = member else { continue };
        let drags = &mut drags[member as usize];
        let signed = |moment: f64| moment * count * speed.signum() * sense;
        *drags = match measure {
            Measure::Moment => each(|i| drags[i] + signed(sums[i])),
            Measure::Power => each(|i| drags[i] + signed(sums[i] / speed.abs())),
        };
    }
}

/// Counts the notes of individual lanes, and clears their cells.
fn gather(
    base: NoteBase,
    own: &[Cell<Extent>],
    totals: &[Cell<Extent>],
    counted: &[bool; LANES],
    outside: &[Cell<bool>; LANES],
) {
    let width = own.len() / LANES;
    for (lane, counted) in counted.iter().enumerate() {
        for cell in base.limits()..base.end() {
            let seen = own[lane * width + cell].replace(Extent::EMPTY);
            if *counted && seen.seen > 0 {
                totals[cell].set(totals[cell].get().merge(seen.once()));
                if seen.outside > 0 {
                    outside[lane].set(true);
                }
            }
        }
    }
}

impl Transmission {
    /// As [`Transmission::correct_loads`] in all lanes.
    fn correct_lanes(
        &self,
        case: &Case,
        ports: &[Lane],
        (one, one_ports): (&mut [SupportLoad], &mut [f64]),
        loads: &mut [LoadLanes],
    ) {
        for lane in 0..LANES {
            for (one, port) in one_ports.iter_mut().zip(ports) {
                *one = port[lane];
            }
            for (one, loads) in one.iter_mut().zip(&*loads) {
                *one = loads.lane(lane);
            }
            self.correct_loads(case, one_ports, one);
            for (one, loads) in one.iter().zip(&mut *loads) {
                loads.set(lane, *one);
            }
        }
    }
}
