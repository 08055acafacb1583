//! One point: speeds, torques, loads, losses. Pure; allocates nothing; never iterates on temperature.

mod batch;
mod grip;
mod readings;
mod scratch;
mod solution;

pub use batch::{Batch, BatchScratch, Block};
pub(crate) use readings::readings;
pub use readings::{MemberTorques, Reading};
pub use scratch::Scratch;
pub use solution::{PartLoss, Solution};

use std::cell::Cell;

use crate::attach::State;
use crate::flow::{Balance, Drive, FlowState, Outcome, Status, Tolerance};
use crate::loads::{LEAST_STATIC_SAFETY, SupportLoad};
use crate::loss::{Extent, Loss, NoteBase, Notebook, Undefined};
use crate::mechanism::gear_drag::GearDragAt;
use crate::mechanism::gear_mesh::GearMeshAt;
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Component, Sharing, Transmission};

/// Iterations without notes. The torques of the first are a guess, those of the second are rarely the last; if they are, the models
/// are evaluated once more.
const SILENT: usize = 2;

/// Whether torque downstream is reduced by upstream losses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PowerFlow {
    /// Torque downstream is reduced by the losses (real power flow).
    #[default]
    Real,
    /// Torques without losses; all losses are computed from them (ideal power flow).
    Ideal,
}

/// Destination of the notes of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Noting {
    /// Nothing is noted.
    Muted,
    /// They are kept in the scratch, for `Scratch::count_seen`.
    Seen,
    /// They are counted among those of all points.
    Counted,
}

/// One operating point of a case. Fields that are not set have their default: `Point { speeds: &[..], torques: &[..],
/// ..Point::default() }`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Point<'a> {
    /// Speeds at the case's speed ports. \[rad/s\]
    pub speeds: &'a [f64],
    /// Torques at the case's torque ports, as applied to the transmission. \[Nm\]
    pub torques: &'a [f64],
    /// Real or ideal power flow.
    pub flow: PowerFlow,
    /// Tolerance of the agreement between loads and losses.
    pub tolerance: Tolerance,
}

impl Transmission {
    /// Workspace for evaluating one case; one per thread.
    pub fn scratch(&self, case: &Case) -> Scratch {
        Scratch::new(self, case)
    }

    /// Evaluates a point at the temperatures of the nodes (degC, [`Transmission::nodes`] of them), or with one temperature for all;
    /// with one temperature the mesh models compute the gear temperatures themselves.
    ///
    /// # Panics
    /// If the number of speeds or torques does not match the ports of the case, or there is neither one temperature nor one per
    /// node: a bug of the caller.
    pub fn evaluate<'s>(
        &'s self,
        case: &'s Case,
        point: &Point<'_>,
        temperatures: &[f64],
        scratch: &'s mut Scratch,
    ) -> Solution<'s> {
        self.solve(case, point, temperatures, scratch, Noting::Counted);
        Solution {
            transmission: self,
            case,
            scratch,
            ideal: point.flow == PowerFlow::Ideal,
        }
    }

    /// The sum of all losses at trial temperatures: without notes or counts. \[W\]
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn probe(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperatures: &[f64],
        scratch: &mut Scratch,
    ) -> Result<f64, Unbalanced> {
        self.try_point(case, point, temperatures, scratch, Noting::Muted)?;
        Ok(scratch.sum)
    }

    /// As [`Transmission::evaluate`]; a point without losses is an error.
    ///
    /// # Errors
    /// Why there are none.
    pub fn try_point(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperatures: &[f64],
        scratch: &mut Scratch,
        noting: Noting,
    ) -> Result<(), Unbalanced> {
        self.solve(case, point, temperatures, scratch, noting);
        match (scratch.undefined, scratch.status) {
            (Some((part, reason)), _) => Err(Unbalanced::Part(part, reason)),
            (None, status) if !status.has_flow() => Err(Unbalanced::Flow),
            (None, _) => Ok(()),
        }
    }

    /// Computes speeds, oils and all values that are independent of torque; true if nothing rotates.
    fn settle(&self, case: &Case, point: &Point<'_>, temperatures: &[f64], s: &mut Scratch, quiet: bool) -> bool {
        assert_eq!(
            point.speeds.len(),
            case.speed_ports.len(),
            "one speed for each speed port of the case"
        );
        assert_eq!(
            point.torques.len(),
            case.torque_ports.len(),
            "one torque for each torque port of the case"
        );
        s.prescribed[..point.speeds.len()].copy_from_slice(point.speeds);
        s.prescribed[point.speeds.len()..].fill(0.0);
        case.motion.speeds(&s.prescribed, &mut s.speeds);
        s.given[..point.torques.len()].copy_from_slice(point.torques);
        s.given[point.torques.len()..].fill(0.0);
        assert!(
            temperatures.len() == 1 || temperatures.len() == self.nodes(),
            "one temperature for all, or one for each node"
        );
        s.temperatures.clear();
        s.temperatures.extend_from_slice(temperatures);
        self.oils.write_states(temperatures, &mut s.oils);
        s.surface = self.oils.surface(&s.speeds);
        s.cells.fill(Extent::EMPTY);
        s.idle_drags.fill(0.0);
        for kept in &mut s.kept {
            kept[0] = f64::NAN;
        }
        s.passes = 0;
        s.called += s.calls.replace(0);
        s.loads.fill(SupportLoad::default());
        let standing = s.speeds.iter().all(|w| *w == 0.0);

        // Models that are independent of torque are evaluated once.
        {
            let cells = Cell::from_mut(s.cells.as_mut_slice()).as_slice_of_cells();
            let state = State {
                speeds: &s.speeds,
                oils: &s.oils,
                temperatures: &s.temperatures,
                surface: s.surface,
                loads: &s.loads,
                calls: &s.calls,
            };
            let book = Notebook {
                cells: if quiet { &[] } else { cells },
                ..Notebook::CLOSED
            };
            let losses = s.component_losses.iter_mut().zip(&mut s.relative);
            s.braking.clear();
            for (i, (component, (loss, relative))) in self.components.iter().zip(losses).enumerate() {
                let speed = state.relative(component.between[0], component.between[1]);
                *relative = speed;
                if component.off {
                    continue;
                }
                if component.loaded {
                    // Stationary components have no drag; they are evaluated once, at the end.
                    if speed != 0.0 {
                        s.braking.push(i);
                    }
                } else {
                    let answer = component_loss(component, &state, &book);
                    let moment = moment(&answer, speed) * self.copies(i, &s.speeds);
                    brake(component.between, speed, moment, &mut s.idle_drags);
                    *loss = answer;
                }
            }
            for (i, loss) in s.drag_losses.iter_mut().enumerate() {
                let model = &self.drags[i].model;
                if model.off {
                    continue;
                }
                *loss = self.drag(i, &state, &book);
                self.brake_gears(i, loss, &s.speeds, &mut s.idle_drags);
            }
        }
        standing
    }

    fn solve(&self, case: &Case, point: &Point<'_>, temperatures: &[f64], s: &mut Scratch, noting_as: Noting) {
        let quiet = noting_as == Noting::Muted;
        let standing = self.settle(case, point, temperatures, s, quiet);
        let Scratch {
            speeds,
            given,
            temperatures,
            oils,
            surface,
            loads,
            uneven_loads,
            uneven_forces,
            passed,
            tangential,
            cells,
            kept,
            component_losses,
            mesh_losses,
            idle_drags,
            relative,
            braking,
            calls,
            work,
            ..
        } = s;
        let calls = &*calls;
        let (speeds, given, oils, surface) = (&*speeds, &*given, &*oils, *surface);
        let temperatures = &temperatures[..];
        let (idle_drags, relative) = (&*idle_drags, &*relative);
        let cells = Cell::from_mut(cells.as_mut_slice()).as_slice_of_cells();
        let kept = Cell::from_mut(kept.as_mut_slice()).as_slice_of_cells();
        let iterates = point.flow == PowerFlow::Real && !standing;
        let silent = if iterates { SILENT } else { 0 };
        let mut pass = 0;
        let losses = |flow: &mut FlowState<'_>| {
            let book = Notebook {
                cells: if quiet || pass < silent { &[] } else { cells },
                kept,
                ..Notebook::CLOSED
            };
            pass += 1;
            // Meshes are the first rows, in the same order.
            for ((mesh, tangential), multiplier) in self.meshes.iter().zip(tangential.iter_mut()).zip(flow.multipliers)
            {
                *tangential = multiplier * mesh.force_per_multiplier;
            }
            let mut support = |forces: &[f64], loads: &mut [SupportLoad]| {
                self.loads.evaluate(forces, speeds, passed, loads);
                self.correct_loads(case, flow.ports, loads);
            };
            support(tangential, loads);
            if self.uneven {
                for (which, loads) in uneven_loads.iter_mut().enumerate() {
                    for ((force, mean), mesh) in uneven_forces.iter_mut().zip(&*tangential).zip(&self.meshes) {
                        *force = mean * mesh.sharing.map_or(1.0, |s| s.factors()[which]);
                    }
                    support(uneven_forces, loads);
                }
            }
            let state = State {
                speeds,
                oils,
                temperatures,
                surface,
                loads,
                calls,
            };
            flow.drags[..idle_drags.len()].copy_from_slice(idle_drags);
            for &i in &*braking {
                let (component, speed) = (&self.components[i], relative[i]);
                // Kept when all of it has been read: a copy waits for values that were just written.
                let loss = loaded_loss(component, &state, uneven_loads, &book);
                let moment = moment(&loss, speed) * self.copies(i, speeds);
                brake(component.between, speed, moment, flow.drags);
                component_losses[i] = loss;
            }
            self.lose_in_meshes(flow, tangential, mesh_losses, &state, &book);
        };
        let outcome = if iterates {
            case.flow.real(speeds, given, idle_drags, point.tolerance, work, losses)
        } else {
            case.flow.ideal(speeds, given, work);
            work.once(speeds, losses);
            Outcome::Converged { passes: 1 }
        };
        if !quiet && matches!(outcome, Outcome::Converged { passes } if passes <= silent) {
            self.note(s);
        }
        self.rest(s, quiet);
        if !quiet && matches!(outcome, Outcome::Converged { .. }) {
            self.note_static_safety(s);
        }
        self.finish(standing, point.flow, outcome, s);
        if noting_as == Noting::Counted && matches!(outcome, Outcome::Converged { .. }) {
            s.count_seen();
        }
    }

    /// Losses of all meshes at their tangential forces, and the power that each takes from the flow.
    #[inline]
    fn lose_in_meshes(
        &self,
        flow: &mut FlowState<'_>,
        tangential: &[f64],
        losses: &mut [Result<Loss, Undefined>],
        state: &State<'_>,
        book: &Notebook<'_>,
    ) {
        for (i, loss) in losses.iter_mut().enumerate() {
            let mesh = &self.meshes[i];
            if mesh.model.off {
                continue;
            }
            let drives = flow.drives[i];
            let answer = self.mesh(i, tangential[i], drives, state, book);
            let speed = self.mesh_speed(i, state.speeds);
            flow.mesh_loss[i] = match &answer {
                Ok(loss) if speed != 0.0 => {
                    loss.total_watts(speed) * mesh.seat.count * mesh.loss_factor * self.mesh_grip(i, state.speeds)
                }
                _ => 0.0,
            };
            *loss = answer;
        }
    }

    /// Notes the contexts of the models at the torques of their last results.
    fn note(&self, s: &mut Scratch) {
        let cells = Cell::from_mut(s.cells.as_mut_slice()).as_slice_of_cells();
        let kept = Cell::from_mut(s.kept.as_mut_slice()).as_slice_of_cells();
        let book = Notebook {
            cells,
            kept,
            ..Notebook::CLOSED
        };
        let state = State {
            speeds: &s.speeds,
            oils: &s.oils,
            temperatures: &s.temperatures,
            surface: s.surface,
            loads: &s.loads,
            calls: &s.calls,
        };
        for &i in &s.braking {
            let _ = loaded_loss(&self.components[i], &state, &s.uneven_loads, &book);
        }
        for i in (0..self.meshes.len()).filter(|i| !self.meshes[*i].model.off) {
            let _ = self.mesh(i, s.tangential[i], s.work.drives[i], &state, &book);
        }
    }

    /// Notes the static safety of bearings; on a planet that of the most loaded one.
    fn note_static_safety(&self, s: &mut Scratch) {
        let first = self.rated_cells();
        for (rated, cell) in self.rated.iter().zip(&mut s.cells[first..]) {
            let load = if rated.uneven {
                s.uneven_loads[0][rated.support]
            } else {
                s.loads[rated.support]
            };
            if let Some(safety) = rated.rating.safety(load.radial, load.axial) {
                *cell = Extent::point(safety, safety, safety < LEAST_STATIC_SAFETY);
            }
        }
    }

    /// Moments of stationary components that carry load.
    fn rest(&self, s: &mut Scratch, quiet: bool) {
        let cells = Cell::from_mut(s.cells.as_mut_slice()).as_slice_of_cells();
        let state = State {
            speeds: &s.speeds,
            oils: &s.oils,
            temperatures: &s.temperatures,
            surface: s.surface,
            loads: &s.loads,
            calls: &s.calls,
        };
        let book = Notebook {
            cells: if quiet { &[] } else { cells },
            ..Notebook::CLOSED
        };
        for ((component, loss), speed) in self.components.iter().zip(&mut s.component_losses).zip(&s.relative) {
            if component.loaded && !component.off && *speed == 0.0 {
                *loss = loaded_loss(component, &state, &s.uneven_loads, &book);
            }
        }
    }

    /// Loss of one drag model.
    fn drag(&self, index: usize, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
        state.calls.set(state.calls.get() + 1);
        sound(self.drags[index].model.loss(&self.drag_at(index, state, book)))
    }

    /// The context of a drag model, one copy.
    fn drag_at<'a>(&'a self, index: usize, state: &State<'_>, book: &Notebook<'a>) -> GearDragAt<'a> {
        let drag = &self.drags[index];
        let seat = &drag.seat;
        let oil = &state.oils[drag.oil as usize];
        let speed = seat.members.map(|m| state.speeds[m]);
        let level = seat
            .levels
            .map(|level| state.level(&crate::attach::Spot { oil: drag.oil, level }));
        let towards = |i: usize| f64::from(u8::from(seat.mates[i].iter().any(|y| speed[i] * y > 0.0)));
        GearDragAt {
            part: &drag.part,
            speed: speed[0],
            speed_2: speed[1],
            tip_dip: level[0].dip(seat.radii[0][0]),
            dip: level[0].dip(seat.radii[0][1]),
            tip_dip_2: if seat.pair { level[1].dip(seat.radii[1][0]) } else { 0.0 },
            dip_2: if seat.pair { level[1].dip(seat.radii[1][1]) } else { 0.0 },
            towards_mesh: towards(0),
            towards_mesh_2: if seat.pair { towards(1) } else { 0.0 },
            temperature: oil.temperature,
            nu: oil.nu,
            eta: oil.eta,
            rho: oil.rho,
            notes: book.notes(drag.model.notes),
        }
    }

    /// Loss of one mesh, one copy; the mean over the copies if their loads differ.
    fn mesh(
        &self,
        index: usize,
        tangential: f64,
        drives: Drive,
        state: &State<'_>,
        book: &Notebook<'_>,
    ) -> Result<Loss, Undefined> {
        let mesh = &self.meshes[index];
        book.clear(mesh.model.notes);
        let one = |factor: f64| {
            state.calls.set(state.calls.get() + 1);
            let at = self.mesh_at(index, factor * tangential, drives, state, book);
            sound(mesh.model.loss(&at))
        };
        match mesh.sharing {
            None => one(1.0),
            Some(sharing) => over_planets(sharing, book, mesh.model.notes, |which| one(sharing.factors()[which])),
        }
    }

    /// The context of a mesh model, one copy.
    fn mesh_at<'a>(
        &'a self,
        index: usize,
        tangential: f64,
        drives: Drive,
        state: &State<'_>,
        book: &Notebook<'a>,
    ) -> GearMeshAt<'a> {
        let mesh = &self.meshes[index];
        let oil = &state.oils[mesh.oil as usize];
        // With one temperature for all nodes, the gear bodies have none of their own.
        let known = mesh.bodies.filter(|_| state.temperatures.len() > 1);
        let bodies = known.map(|nodes| nodes.map(|node| state.temperatures[node]));
        GearMeshAt {
            part: &mesh.part,
            torque: (tangential * mesh.seat.pair.working_radius[0]).abs(),
            speed: self.mesh_speed(index, state.speeds),
            first_drives: f64::from(u8::from(drives != Drive::Second)),
            temperature: oil.temperature,
            nu: oil.nu,
            eta: oil.eta,
            rho: oil.rho,
            alpha: oil.alpha,
            beta: oil.beta,
            conductivity: oil.conductivity,
            x_l: oil.x_l,
            bodies_known: f64::from(u8::from(bodies.is_some())),
            temperature_1: bodies.map_or(oil.temperature, |b| b[0]),
            temperature_2: bodies.map_or(oil.temperature, |b| b[1]),
            notes: book.notes(mesh.model.notes),
        }
    }

    /// Speed of a mesh's first gear in its carrier's frame; zero if it is rounding error. \[rad/s\]
    fn mesh_speed(&self, index: usize, speeds: &[f64]) -> f64 {
        let seat = &self.meshes[index].seat;
        let (own, carrier) = (speeds[seat.members[0]], seat.carrier.map_or(0.0, |c| speeds[c]));
        if (own - carrier).abs() <= 1e-12 * own.abs().max(carrier.abs()) {
            0.0
        } else {
            own - carrier
        }
    }

    /// Applies the loss of a drag model to its gears.
    fn brake_gears(&self, index: usize, loss: &Result<Loss, Undefined>, speeds: &[f64], drags: &mut [f64]) {
        let Ok(loss) = loss else { return };
        let seat = &self.drags[index].seat;
        let [first, second] = seat.members;
        let watts = loss.total_watts(speeds[first]) * seat.count * self.drags[index].loss_factor;
        if !seat.pair {
            if speeds[first] != 0.0 {
                drags[first] -= watts / speeds[first];
            }
            return;
        }
        let share = match (speeds[first] != 0.0, speeds[second] != 0.0) {
            (true, true) => loss.first_share(),
            (true, false) => 1.0,
            (false, true) => 0.0,
            (false, false) => return,
        };
        if share > 0.0 {
            drags[first] -= share * watts / speeds[first];
        }
        if share < 1.0 {
            drags[second] -= (1.0 - share) * watts / speeds[second];
        }
    }

    fn correct_loads(&self, case: &Case, ports: &[f64], loads: &mut [SupportLoad]) {
        let torque = |port: usize| ports[self.ports[port].member];
        if let Some(imported) = &self.imported {
            for (i, load) in loads.iter_mut().enumerate() {
                if let Some(own) = imported.load(case.state, i, torque(imported.port)) {
                    *load = own;
                }
            }
        }
        for (load, factors) in loads.iter_mut().zip(&self.load_factors) {
            load.radial *= factors.radial.value_at(torque);
            load.axial *= factors.axial.value_at(torque);
        }
    }

    fn finish(&self, standing: bool, flow: PowerFlow, outcome: Outcome, s: &mut Scratch) {
        let mut undefined = None;
        let mut sum = 0.0;
        for (place, part) in self.parts.iter().enumerate() {
            match self.part_watts(part, s) {
                Ok(watts) => {
                    s.watts[place] = watts;
                    sum += watts;
                }
                Err(error) => {
                    s.watts[place] = 0.0;
                    undefined.get_or_insert((place, error));
                }
            }
        }
        s.sum = sum;
        // Without a power flow no load is defined, and no loss has its own reason.
        s.undefined = undefined.filter(|_| matches!(outcome, Outcome::Converged { .. }));
        let powers = self.ports.iter().map(|p| s.work.ports[p.member] * s.speeds[p.member]);
        s.balance = Balance::from_powers(powers.clone());
        s.status = match outcome {
            Outcome::SelfLocking => Status::SelfLocking,
            Outcome::NoConvergence => Status::NoConvergence,
            Outcome::Converged { passes } => {
                s.passes = passes;
                if undefined.is_some() {
                    Status::Undefined
                } else if standing {
                    Status::Standstill
                } else if flow == PowerFlow::Ideal && s.balance.input > 0.0 && sum > s.balance.input {
                    Status::LossAboveInput
                } else {
                    Status::from_powers(powers, self.reference_port())
                }
            }
        };
    }
}

/// Loss of one copy of a component. If no bearing of the shaft takes its thrust, the load of its bearings is unknown and so is
/// their loss, unless it was switched off.
#[inline]
pub(crate) fn component_loss(component: &Component, state: &State<'_>, book: &Notebook<'_>) -> Result<Loss, Undefined> {
    state.calls.set(state.calls.get() + 1);
    let answer = component.placed.loss(state, book);
    let untaken = component.support.map_or(0.0, |n| state.loads[n as usize].untaken);
    match &answer {
        Ok(loss) if !loss.is_sound() => Err(unsound(loss)),
        Ok(loss) if untaken != 0.0 && loss.sum() > 0.0 => Err(Undefined {
            what: "thrust that no bearing of the shaft takes [N]",
            value: untaken,
        }),
        _ => answer,
    }
}

/// Loss of one copy of a component that carries load; the mean over the copies if their loads differ.
#[inline(always)]
fn loaded_loss(
    component: &Component,
    state: &State<'_>,
    uneven: &[Vec<SupportLoad>; 2],
    book: &Notebook<'_>,
) -> Result<Loss, Undefined> {
    book.clear(component.notes);
    match component.sharing {
        None => component_loss(component, state, book),
        Some(sharing) => over_planets(sharing, book, component.notes, |which| {
            let loads = &uneven[which];
            component_loss(component, &State { loads, ..*state }, book)
        }),
    }
}

/// The mean over the planets of a set: the most loaded one and the others, each evaluated once. The notes of the others are added
/// to those of the first.
fn over_planets(
    sharing: Sharing,
    book: &Notebook<'_>,
    base: NoteBase,
    evaluate: impl Fn(usize) -> Result<Loss, Undefined>,
) -> Result<Loss, Undefined> {
    let notes = book.notes(base);
    notes.branch("the most loaded planet");
    let most = evaluate(0)?;
    notes.branch("each other planet");
    Ok(most.mean(sharing.weight, evaluate(1)?))
}

/// A model's result is accepted only if it is finite and not negative.
fn sound(answer: Result<Loss, Undefined>) -> Result<Loss, Undefined> {
    match &answer {
        Ok(loss) if !loss.is_sound() => Err(unsound(loss)),
        _ => answer,
    }
}

#[cold]
fn unsound(loss: &Loss) -> Undefined {
    Undefined {
        what: "result of the model, which is negative or not finite",
        value: loss.sum(),
    }
}

/// Moment of a loss about its relative speed; zero at standstill, where statics does not determine friction.
fn moment(loss: &Result<Loss, Undefined>, speed: f64) -> f64 {
    match loss {
        Ok(loss) if speed != 0.0 => loss.total_moment(speed),
        _ => 0.0,
    }
}

/// Applies a moment between two members, against their relative speed.
fn brake(between: [Option<u16>; 2], speed: f64, moment: f64, drags: &mut [f64]) {
    if speed == 0.0 {
        return;
    }
    let signed = moment * speed.signum();
    if let Some(a) = between[0] {
        drags[a as usize] -= signed;
    }
    if let Some(b) = between[1] {
        drags[b as usize] += signed;
    }
}
