//! One point: speeds, torques, loads, losses. Pure; allocates nothing; never iterates on temperature.

mod batch;
mod derive;
mod found_friction;
mod grip;
mod oil_level;
mod oil_supply;
mod ratings;
mod readings;
mod scratch;
mod snapshot;
mod solution;
mod transfers;

pub use batch::{Batch, BatchScratch, Block};
pub use derive::{GivenQuantity, NoSlopes, Slope, Slopes};
use found_friction::FoundFriction;
pub use oil_level::{LevelEstimate, LevelFrom, OilLevels};
pub use oil_supply::{ChamberLevel, ElementFlow, OilSupply, PocketLevel, SupplyFinding, WindowFlow};
pub use ratings::{ComponentRating, Ratings};
pub(crate) use readings::readings;
pub use readings::{MemberTorques, Reading};
pub use scratch::Scratch;
use scratch::{Models, incline};
pub(crate) use snapshot::Asked;
pub use snapshot::Snapshot;
pub use solution::{PartLoss, PreloadAt, Solution, ToothForceAt};

use crate::attach::{Oil, State};
use crate::flow::{Balance, Drive, FlowState, Outcome, Start, Status, Tolerance};
use crate::geometry::crossed::Flank;
use crate::hydraulics::{Inputs, Window};
use crate::loads::{Group, LEAST_STATIC_SAFETY, SupportLoad, ToothForces};
use crate::loss::{Loss, NoteBase, Notebook, Seen, Undefined};
use crate::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt, BevelPart};
use crate::mechanism::crossed_helical_mesh::{CrossedHelicalMesh, CrossedHelicalMeshAt};
use crate::mechanism::gear_drag::{GearDrag, GearDragAt};
use crate::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use crate::mechanism::worm_mesh::{WormMesh, WormMeshAt, WormPart};
use crate::mechanism::{Answers, with_oil};
use crate::real::{Mask as _, Points, Real};
use crate::sump::CAPTURE;
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Component, CrossedTeeth, MeshLaw, Pockets, Sharing, Surface, Transmission};

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
    /// Inclination of the housing in its direction of travel, in addition to that as built; not used if the housing states none. \[rad\]
    pub inclination: f64,
}

impl Point<'_> {
    /// The point with at least this tolerance of the power flow; see [`Tolerance::power`].
    pub(crate) fn with_tolerance_at_least(&self, least: f64) -> Self {
        let power = self.tolerance.power.max(least);
        Self {
            tolerance: Tolerance {
                power,
                ..self.tolerance
            },
            ..*self
        }
    }
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
        self.solve(case, point, temperatures, Start::Lossless, scratch, Noting::Counted);
        Solution {
            transmission: self,
            case,
            scratch,
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
        self.try_point_from(Start::Lossless, case, point, temperatures, scratch, noting)
    }

    /// As [`Transmission::try_point`], starting with other losses.
    pub(crate) fn try_point_from(
        &self,
        start: Start,
        case: &Case,
        point: &Point<'_>,
        temperatures: &[f64],
        scratch: &mut Scratch,
        noting: Noting,
    ) -> Result<(), Unbalanced> {
        self.solve(case, point, temperatures, start, scratch, noting);
        match (scratch.undefined, scratch.status()) {
            (Some((part, reason)), _) => Err(Unbalanced::Part(part, reason)),
            (None, status) if !status.has_flow() => Err(Unbalanced::Flow),
            (None, _) => Ok(()),
        }
    }

    /// Computes speeds, oils and all values that are independent of torque.
    fn settle(&self, case: &Case, point: &Point<'_>, temperatures: &[f64], s: &mut Scratch, noting: Noting) {
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
        assert!(
            temperatures.len() == 1 || temperatures.len() == self.nodes(),
            "one temperature for all, or one for each node"
        );
        s.prescribed[..point.speeds.len()].copy_from_slice(point.speeds);
        s.prescribed[point.speeds.len()..].fill(0.0);
        s.work.given[..point.torques.len()].copy_from_slice(point.torques);
        s.work.given[point.torques.len()..].fill(0.0);
        s.models.conditions.temperatures.clear();
        s.models.conditions.temperatures.extend_from_slice(temperatures);
        s.models.conditions.common = true;
        s.models.conditions.live = true;
        s.models.conditions.inclination = self.inclination_of(point);
        self.settle_prescribed(case, s, !0, noting);
    }

    /// Inclination of a point, in addition to that as built; none if the housing does not travel. \[rad\]
    fn inclination_of(&self, point: &Point<'_>) -> f64 {
        if self.oils.travel().is_some() {
            point.inclination
        } else {
            0.0
        }
    }

    /// Computes speeds, oils and all values that are independent of torque, from what is prescribed. Points that do not differ in it from
    /// the one before, whose bit in `starts` is not set, take its values.
    fn settle_prescribed<R: Answers>(&self, case: &Case, s: &mut Scratch<R>, starts: u32, noting: Noting) {
        let m = &mut s.models;
        let c = &mut m.conditions;
        case.motion.speeds(&s.prescribed, &mut c.speeds);
        self.oils.write_states(&c.temperatures, &mut c.oils);
        c.rest = self.oils.at_rest(&c.speeds, &c.oils);
        // Until the drag of the gears is known, no oil is lifted.
        c.surface = self.oils.running(&c.speeds, c.rest);
        c.travel = self.oils.travel().filter(|_| !c.inclination.is_zero().all()).copied();
        if let Some(sump) = self.oils.sump.as_ref().filter(|_| c.travel.is_some()) {
            // The level is that of the same oil.
            let rest = sump.inclined(c.rest, c.inclination);
            c.surface = match self.oils.surface() {
                Surface::AtRest | Surface::Estimated(_) => rest,
                Surface::Fixed(_) | Surface::Over { .. } => sump.inclined(c.surface, c.inclination),
            };
            c.rest = rest;
        }
        self.write_closings(&c.temperatures, &c.oils, &mut m.closings);
        self.hydraulics.solve(
            &Inputs {
                speeds: &c.speeds,
                oils: &c.oils,
                surface: c.surface,
                incline: incline(c.travel.as_ref(), c.inclination),
            },
            &mut c.hydraulics,
        );
        c.forget();
        s.called += c.calls.replace(0);
        c.loads.fill(SupportLoad::default());
        let standing = c.speeds.iter().fold(R::mask(|_| true), |all, w| all & w.is_zero());
        s.standing = c.decide(standing);
        for (i, component) in self.components.iter().enumerate() {
            let (state, _) = c.open(false);
            m.relative[i] = state.relative(component.between[0], component.between[1]);
            // Stationary components have no drag; they are evaluated once, at the end.
            m.rests[i] = c.decide(m.relative[i].is_zero());
        }

        // Models that are independent of torque are evaluated once.
        let drags = &mut s.work.steady;
        drags.fill(R::ZERO);
        let mut live = c.live;
        let (state, book) = c.open(noting != Noting::Muted);
        let book = Notebook { starts, ..book };
        for (i, loss) in m.drag_losses.iter_mut().enumerate() {
            if !self.drags[i].model.off {
                *loss = self.drag(i, &state, &book, &mut live);
            }
        }
        let estimated = self.oils.estimated().filter(|(sump, _)| sump.read);
        let wetting = self.oils.sump.as_ref().filter(|_| self.hydraulics.catches());
        if let Some(sump) = wetting.or(estimated.map(|(sump, _)| sump)) {
            sump.lift(&self.drags, &m.drag_losses, &state, &mut m.lifted);
            let at = Inputs {
                speeds: &c.speeds,
                oils: &c.oils,
                surface: c.surface,
                incline: incline(c.travel.as_ref(), c.inclination),
            };
            let held = self.hydraulics.held(&c.hydraulics, &at);
            let (wet, length) = {
                let catchers = Pockets {
                    network: &self.hydraulics,
                    work: &c.hydraulics,
                    speeds: &c.speeds,
                    oils: &c.oils,
                };
                let running = sump.running((c.rest, c.inclination), held, &c.oils, &m.lifted, (catchers, starts));
                if let Some((_, place)) = estimated {
                    c.surface = if place == 0.0 {
                        running.film_level(CAPTURE[1])
                    } else {
                        running.band().at(place)
                    };
                }
                let wet = wetting.map(|_| running.outside(|x| x, c.surface, CAPTURE[1]).wetting);
                (wet, running.walls.length)
            };
            if let Some(wet) = wet {
                let thrown = |window: &Window| sump.through(window, (&c.speeds, c.surface), &m.lifted).1;
                self.hydraulics.catch((wet, length), thrown, &at, &mut c.hydraulics);
            }
        }
        let (state, book) = c.open(noting != Noting::Muted);
        let book = Notebook { starts, ..book };
        for (i, component) in self.components.iter().enumerate() {
            if !component.loaded && !component.off {
                let answer = component_loss(component, &state, &book, &mut live);
                let moment = moment(&answer, m.relative[i]) * self.copies(i, state.speeds);
                brake(component.between, m.relative[i], moment, drags);
                m.component_losses[i] = answer;
            }
        }
        for (i, loss) in m.drag_losses.iter().enumerate() {
            if !self.drags[i].model.off {
                self.brake_gears(i, loss, state.speeds, drags);
            }
        }
        c.live = live;
        s.work.speeds.copy_from_slice(&c.speeds);
    }

    fn solve(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperatures: &[f64],
        start: Start,
        s: &mut Scratch,
        noting: Noting,
    ) {
        self.settle(case, point, temperatures, s, noting);
        self.solve_settled(case, (point.flow, point.tolerance), start, s, noting);
    }

    /// Solves the given torques at the settled speeds and oils.
    fn solve_settled<R: Answers>(
        &self,
        case: &Case,
        (power_flow, tolerance): (PowerFlow, Tolerance<R>),
        start: Start,
        s: &mut Scratch<R>,
        noting: Noting,
    ) {
        let notes = noting != Noting::Muted;
        s.ideal = power_flow == PowerFlow::Ideal;
        let (work, models) = (&mut s.work, &mut s.models);
        models.loaded.fill(0);
        models.ideal = s.ideal;
        models.friction.fill(R::ZERO);
        models.found_friction.fill(FoundFriction::NONE);
        models.round = 0;
        work.live = models.conditions.live;
        let losses = |flow: &mut FlowState<'_, R>| self.lose(case, flow, models, notes);
        let outcome = if power_flow == PowerFlow::Real && !s.standing {
            case.flow.real(tolerance, start, work, losses)
        } else {
            case.flow.ideal(work);
            work.once(&case.flow, losses);
            Outcome::Converged { passes: 1 }
        };
        models.conditions.live = work.live;
        let converged = matches!(outcome, Outcome::Converged { .. });
        if converged && !s.ideal && !s.standing {
            self.accept(case, s);
        }
        self.rest(case, s, notes);
        if notes && converged {
            self.note_static_safety(&mut s.models);
            self.note_pairs(case, &mut s.models);
        }
        self.finish(outcome, s);
        if noting == Noting::Counted && converged {
            s.count_seen();
        }
    }

    /// Brings the losses of loops to the accepted torques; the loads of their bearings are found anew.
    fn accept<R: Answers>(&self, case: &Case, s: &mut Scratch<R>) {
        let (work, m) = (&s.work, &mut s.models);
        R::wide(
            #[inline(always)]
            || {
                for laws in work.loops() {
                    for &i in &laws.meshes {
                        let loss = match i.checked_sub(self.meshes.len()) {
                            Some(transfer) => &mut m.transfer_losses[transfer],
                            None => &mut m.mesh_losses[i],
                        };
                        *loss = loss.map(|loss| loss.times(work.accepted[i]));
                    }
                    for &drag in &laws.drags {
                        let i = case.flow.drags()[drag].component;
                        let share = work.accepted[case.flow.meshes().len() + drag];
                        m.component_losses[i] = m.component_losses[i].map(|loss| loss.times(share));
                        if let Some(group) = self.components[i].group(&self.loads) {
                            m.loaded[group] = 0;
                        }
                    }
                }
            },
        );
    }

    /// Losses of some laws at the torques of the flow.
    fn lose<R: Answers>(&self, case: &Case, flow: &mut FlowState<'_, R>, m: &mut Models<R>, notes: bool) {
        R::wide(
            #[inline(always)]
            || {
                m.round += 1;
                self.forces(flow.multipliers, m);
                // Bearings read the friction of these meshes.
                let crossed_first = !m.friction.is_empty();
                for &i in flow.laws.meshes.iter().filter(|_| crossed_first) {
                    if self.meshes.get(i).is_some_and(|mesh| mesh.seat.crossed().is_some()) {
                        self.lose_at_mesh(i, flow, m, notes);
                    }
                }
                for &drag in &flow.laws.drags {
                    let i = flow.drags[drag].component;
                    let component = &self.components[i];
                    if m.rests[i] {
                        flow.moments[drag] = R::ZERO;
                        continue;
                    }
                    m.conditions.live = *flow.live;
                    self.load(case, component, (flow.ports, flow.drives), m);
                    *flow.live = m.conditions.live;
                    let (state, book) = m.conditions.open(notes);
                    let loss = loaded_loss(component, &state, &m.uneven_loads, &book, flow.live);
                    let speed = m.relative[i];
                    let moment = moment(&loss, speed) * self.copies(i, state.speeds);
                    flow.moments[drag] = R::select(speed.is_below(R::ZERO), -moment, moment);
                    m.component_losses[i] = loss;
                }
                for &i in &flow.laws.meshes {
                    let Some(mesh) = self.meshes.get(i) else {
                        self.lose_at_transfer(case, i - self.meshes.len(), flow, m, notes);
                        continue;
                    };
                    if !crossed_first || mesh.seat.crossed().is_none() {
                        self.lose_at_mesh(i, flow, m, notes);
                    }
                }
            },
        );
    }

    /// Loss of a mesh at the torques of the flow; of one on axes that cross also its friction force.
    #[inline(always)]
    fn lose_at_mesh<R: Answers>(&self, i: usize, flow: &mut FlowState<'_, R>, m: &mut Models<R>, notes: bool) {
        let mesh = &self.meshes[i];
        if mesh.law.off() {
            return;
        }
        m.conditions.live = *flow.live;
        let (state, book) = m.conditions.open(notes);
        let answer = self.mesh(i, m.forces[i], flow.drives[i], &state, &book, flow.live);
        let speed = self.mesh_speed(i, state.speeds);
        flow.mesh_loss[i] = match &answer {
            Ok(loss) => {
                let watts = loss.total_watts(speed) * mesh.seat.count * mesh.loss_factor;
                R::select(speed.is_zero(), R::ZERO, watts * self.mesh_grip(i, state.speeds))
            }
            Err(_) => R::ZERO,
        };
        if let Some(teeth) = mesh.seat.crossed().filter(|_| !m.ideal) {
            let force = m.forces[i];
            m.friction[i] = self.friction_of(i, teeth, force, &answer, state.speeds);
            let found = &mut m.found_friction[i];
            found.turn(flow.drives[i]);
            found.add(!force.is_equal(found.force[0]), force, m.friction[i]);
            found.round = m.round;
        }
        m.mesh_losses[i] = answer;
    }

    /// Tangential forces of all meshes and chains. They are the first rows, in the same order.
    #[inline(always)]
    fn forces<R: Points>(&self, multipliers: &[R], m: &mut Models<R>) {
        for ((factor, force), multiplier) in self.force_factors().zip(&mut m.forces).zip(multipliers) {
            *force = *multiplier * factor;
        }
        if self.uneven > 0 {
            self.share(m);
        }
    }

    /// Shares the forces of all meshes among the planets of their sets.
    #[inline(never)]
    fn share<R: Points>(&self, m: &mut Models<R>) {
        let sharing = |mesh: usize| self.meshes.get(mesh).and_then(|mesh| mesh.sharing.as_ref());
        for (which, forces) in m.uneven_forces.iter_mut().enumerate() {
            for (i, (force, mean)) in forces.iter_mut().zip(&m.forces).enumerate() {
                *force = sharing(i).map_or(*mean, |own| own.force(which, *mean));
            }
        }
        for (i, (force, mean)) in m.turning.iter_mut().zip(&m.forces).enumerate() {
            *force = sharing(i).map_or(R::ZERO, |own| own.across(*mean));
        }
    }

    /// Loads of the supports of the group of a component, unless they are known for these torques.
    #[inline(always)]
    fn load<R: Answers>(&self, case: &Case, component: &Component, flow: (&[R], &[Drive]), m: &mut Models<R>) {
        if let Some(group) = component.group(&self.loads)
            && std::mem::replace(&mut m.loaded[group], m.round) != m.round
        {
            self.load_group(case, group, flow, m);
        }
    }

    /// Loads of the supports of a group, at the torques of ports and with the driving gears of meshes.
    #[inline(always)]
    fn load_group<R: Answers>(&self, case: &Case, group: usize, (ports, drives): (&[R], &[Drive]), m: &mut Models<R>) {
        let group = &self.loads.groups()[group];
        if !m.friction.is_empty() {
            self.find_friction(group, drives, m);
        }
        let c = &mut m.conditions;
        let teeth = ToothForces {
            tangential: &m.forces,
            friction: &m.friction,
            turning: &m.turning,
        };
        self.loads
            .evaluate(group, teeth, &c.speeds, &m.closings, &mut m.passed, &mut c.loads);
        self.correct_loads(case, group, ports, &mut c.loads);
        for (forces, loads) in m.uneven_forces.iter().zip(&mut m.uneven_loads) {
            let teeth = ToothForces {
                tangential: forces,
                ..teeth
            };
            self.loads
                .evaluate(group, teeth, &c.speeds, &m.closings, &mut m.passed, loads);
            self.correct_loads(case, group, ports, loads);
        }
    }

    /// Friction forces of the meshes of a group at the present torques, unless they are known for these or follow from those at others.
    #[inline(never)]
    fn find_friction<R: Answers>(&self, group: &Group, drives: &[Drive], m: &mut Models<R>) {
        for &i in &group.meshes {
            let mesh = &self.meshes[i];
            let Some(teeth) = mesh.seat.crossed().filter(|_| !mesh.law.off() && !m.ideal) else {
                continue;
            };
            let found = &mut m.found_friction[i];
            if std::mem::replace(&mut found.round, m.round) == m.round {
                continue;
            }
            found.turn(drives[i]);
            let force = m.forces[i];
            let known = if m.derives { R::Mask::NEVER } else { found.gives(force) };
            if !(known | !m.conditions.live).all() {
                // The law is evaluated again with its part of the flow, with notes.
                let mut live = m.conditions.live;
                let (state, book) = m.conditions.open(false);
                let answer = self.mesh(i, force, drives[i], &state, &book, &mut live);
                let friction = self.friction_of(i, teeth, force, &answer, state.speeds);
                m.found_friction[i].add(!known, force, friction);
                if R::COUNT > 1 {
                    // A point alone has an answer where several have none.
                    m.conditions.live = m.conditions.live & (known | live);
                }
            }
            m.friction[i] = m.found_friction[i].at(force);
        }
    }

    /// Friction force of a mesh on axes that cross, which has its loss, with the sign of the speed of the first gear. \[N\]
    #[inline(always)]
    fn friction_of<R: Points>(
        &self,
        index: usize,
        teeth: &CrossedTeeth,
        force: R,
        answer: &Result<Loss<R>, Undefined>,
        speeds: &[R],
    ) -> R {
        let Ok(loss) = answer else { return R::ZERO };
        let speed = self.mesh_speed(index, speeds);
        let watts = loss.total_watts(speed) * self.meshes[index].loss_factor;
        let [ahead, back] = teeth.flanks.map(|flank| R::constant(flank.sliding));
        let sliding = speed * R::select(force.is_below(R::ZERO), back, ahead);
        R::select(sliding.is_zero(), R::ZERO, watts / sliding)
    }

    /// Notes the static safety of bearings; on a planet that of the most loaded one.
    fn note_static_safety<R: Points>(&self, m: &mut Models<R>) {
        let c = &m.conditions;
        for (rated, cell) in self.rated.iter().zip(&c.cells[self.rated_cells()..]) {
            let loads = if rated.uneven { &m.uneven_loads[0] } else { &c.loads };
            let load = &loads[rated.support];
            let safety = rated.rating.safety(load.radial, load.axial);
            // Infinite without load.
            let loaded = R::bits(c.live & safety.is_below(R::constant(f64::INFINITY)));
            let outside = loaded & safety.is_below(R::constant(LEAST_STATIC_SAFETY)).bits();
            cell.set(Seen::new(safety.extremes(loaded), loaded, outside));
        }
    }

    /// Writes the closing of each pair with a preload at the temperatures of its surroundings, by its member. \[m\]
    fn write_closings<R: Points>(&self, temperatures: &[R], oils: &[Oil<R>], closings: &mut [R]) {
        for pair in &self.pairs {
            if let Some(preload) = &pair.preload {
                closings[pair.member] = preload.closing_at(preload.temperatures(temperatures, oils));
            }
        }
    }

    /// Notes of pairs, on planets with the mean load: with a spring, by how much the axial loads exceed the thrust that their radial loads
    /// induce; with a preload, the closing of each bearing in um. Imported loads do not follow from it.
    fn note_pairs<R: Points>(&self, case: &Case, m: &mut Models<R>) {
        let c = &m.conditions;
        let teeth = ToothForces {
            tangential: &m.forces,
            friction: &m.friction,
            turning: &m.turning,
        };
        let noted = self
            .pairs
            .iter()
            .filter(|pair| pair.spring.is_some() || pair.preload.is_some());
        for (pair, cells) in noted.zip(c.cells[self.pair_cells()..].chunks(2)) {
            let Some(support) = pair.supports().next() else {
                continue;
            };
            let reserves = if let Some(spring) = pair.spring {
                let loads = self
                    .loads
                    .pair_loads(support, teeth, &c.speeds, &m.closings, &mut m.passed);
                loads.map(|loads| loads.reserve(spring))
            } else {
                let closings = self
                    .loads
                    .pair_closings(support, teeth, &c.speeds, &m.closings, &mut m.passed);
                closings.map(|closings| closings.map(|own| own * 1e6))
            };
            let reserves = reserves.unwrap_or([R::ZERO; 2]);
            let imported = self.imported.as_ref();
            for ((support, reserve), cell) in pair.noted().zip(reserves).zip(cells) {
                if imported.is_none_or(|own| own.reads(case.state, support).is_none()) {
                    let live = R::bits(c.live);
                    let outside = live & reserve.is_below(R::ZERO).bits();
                    cell.set(Seen::new(reserve.extremes(live), live, outside));
                }
            }
        }
    }

    /// What no torque depends on: forces of meshes, loads of supports without a law and of loops at the accepted torques, moments of stationary
    /// components that carry load.
    fn rest<R: Answers>(&self, case: &Case, s: &mut Scratch<R>, notes: bool) {
        let m = &mut s.models;
        R::wide(
            #[inline(always)]
            || {
                self.forces(&s.work.multipliers, m);
                for i in 0..m.friction.len() {
                    // That of the losses of the flow.
                    let mesh = &self.meshes[i];
                    if let Some(teeth) = mesh.seat.crossed().filter(|_| !mesh.law.off() && !m.ideal) {
                        let speeds = &m.conditions.speeds;
                        m.friction[i] = self.friction_of(i, teeth, m.forces[i], &m.mesh_losses[i], speeds);
                        m.found_friction[i].round = m.round;
                    }
                }
                for group in 0..self.loads.groups().len() {
                    if m.loaded[group] == 0 {
                        self.load_group(case, group, (&s.work.ports, &s.work.drives), m);
                    }
                }
            },
        );
        let mut live = m.conditions.live;
        let (state, book) = m.conditions.open(notes);
        let losses = m.component_losses.iter_mut().zip(&m.relative);
        for (component, (loss, speed)) in self.components.iter().zip(losses) {
            if component.loaded && !component.off && (speed.is_zero() & live).any() {
                *loss = loaded_loss(component, &state, &m.uneven_loads, &book, &mut live);
            }
        }
        m.conditions.live = live;
    }

    /// Loss of one drag model.
    fn drag<R: Answers>(
        &self,
        index: usize,
        state: &State<'_, R>,
        book: &Notebook<'_, R>,
        live: &mut R::Mask,
    ) -> Result<Loss<R>, Undefined> {
        state.count_call(*live);
        let answer = R::answer::<GearDrag>(&*self.drags[index].model, &self.drag_at(index, state, book));
        accepted(answer, R::ZERO, live)
    }

    /// The context of a drag model, one copy.
    fn drag_at<'a, R: Points>(
        &'a self,
        index: usize,
        state: &State<'_, R>,
        book: &Notebook<'a, R>,
    ) -> GearDragAt<'a, R> {
        let drag = &self.drags[index];
        let seat = &drag.seat;
        let oil = &state.oils[drag.oil as usize];
        let speed = seat.members.map(|m| state.speeds[m]);
        let level = seat.levels.map(|level| state.level_at_rest(level));
        let towards = |i: usize| {
            let turns = |point: usize| {
                let own = speed[i].at_point(point);
                seat.mates[i].iter().any(|mate| own * mate.y > 0.0)
            };
            R::each(|point| f64::from(u8::from(turns(point))))
        };
        // The highest mesh towards which the lowest point moves.
        let mesh_height = |i: usize| {
            let highest = |point: usize| {
                let own = speed[i].at_point(point);
                let drawn = seat.mates[i].iter().filter(|mate| own * mate.y > 0.0);
                drawn.fold(0.0, |highest: f64, mate| highest.max(mate.height))
            };
            R::each(highest)
        };
        let second = |x: R| if seat.pair { x } else { R::ZERO };
        with_oil!(from oil, GearDragAt {
            part: &drag.part,
            speed: speed[0],
            speed_2: speed[1],
            tip_dip: level[0].dip(seat.radii[0][0]),
            dip: level[0].dip(seat.radii[0][1]),
            tip_dip_2: second(level[1].dip(seat.radii[1][0])),
            dip_2: second(level[1].dip(seat.radii[1][1])),
            towards_mesh: towards(0),
            towards_mesh_2: second(towards(1)),
            mesh_height: mesh_height(0),
            mesh_height_2: second(mesh_height(1)),
            injected: state.supply(drag.supply).flow.max(R::ZERO),
            notes: book.notes(drag.model.notes),
        })
    }

    /// Loss of one mesh, one copy; the mean over the copies if their loads differ.
    #[inline(always)]
    fn mesh<R: Answers>(
        &self,
        index: usize,
        tangential: R,
        drives: Drive,
        state: &State<'_, R>,
        book: &Notebook<'_, R>,
        live: &mut R::Mask,
    ) -> Result<Loss<R>, Undefined> {
        let mesh = &self.meshes[index];
        book.clear(mesh.law.notes());
        match &mesh.sharing {
            None => self.one_mesh(index, tangential, drives, state, book, live),
            Some(sharing) => over_planets(&sharing.set, book, mesh.law.notes(), |which| {
                let tangential = sharing.force(which, tangential);
                self.one_mesh(index, tangential, drives, state, book, live)
            }),
        }
    }

    /// Loss of one copy of a mesh at its own load.
    #[inline(always)]
    fn one_mesh<R: Answers>(
        &self,
        index: usize,
        tangential: R,
        drives: Drive,
        state: &State<'_, R>,
        book: &Notebook<'_, R>,
        live: &mut R::Mask,
    ) -> Result<Loss<R>, Undefined> {
        state.count_call(*live);
        let answer = match &self.meshes[index].law {
            MeshLaw::Cylindrical { part, model } => {
                let at = self.mesh_at((index, part), tangential, drives, state, book);
                R::answer::<GearMesh>(&**model, &at)
            }
            MeshLaw::Bevel { part, model } => {
                let at = self.bevel_mesh_at((index, part), tangential, drives, state, book);
                R::answer::<BevelMesh>(&**model, &at)
            }
            MeshLaw::Worm { part, model } => {
                let at = self.worm_mesh_at((index, part), tangential, drives, state, book);
                R::answer::<WormMesh>(&**model, &at)
            }
            MeshLaw::CrossedHelical { part, model } => {
                let mesh = self.mesh_at((index, &part.flanks), tangential, drives, state, book);
                R::answer::<CrossedHelicalMesh>(&**model, &CrossedHelicalMeshAt::of_flanks(part, &mesh))
            }
        };
        accepted(answer, R::ZERO, live)
    }

    /// The context of the model of a mesh of cylindrical gears with this part, one copy.
    #[inline(always)]
    fn mesh_at<'a, R: Points>(
        &'a self,
        (index, part): (usize, &'a MeshPart),
        tangential: R,
        drives: Drive,
        state: &State<'_, R>,
        book: &Notebook<'a, R>,
    ) -> GearMeshAt<'a, R> {
        let mesh = &self.meshes[index];
        let oil = &state.oils[mesh.oil as usize];
        // With one temperature for all nodes, the gear bodies have none of their own.
        let known = mesh.bodies.filter(|_| state.temperatures.len() > 1);
        let bodies = known.map(|nodes| nodes.map(|node| state.temperatures[node]));
        let flag = |holds: bool| R::constant(f64::from(u8::from(holds)));
        let notes = book.notes(mesh.law.notes());
        if mesh.greased {
            notes.branch("grease: the oil is its base oil");
        }
        with_oil!(of contacts from oil, GearMeshAt {
            part,
            torque: (tangential * mesh.seat.radius()).abs(),
            speed: self.mesh_speed(index, state.speeds),
            first_drives: flag(drives != Drive::Second),
            bodies_known: flag(bodies.is_some()),
            temperature_1: bodies.map_or(oil.temperature, |b| b[0]),
            temperature_2: bodies.map_or(oil.temperature, |b| b[1]),
            notes,
        })
    }

    /// The context of the model of a mesh of bevel gears with this part.
    #[inline(always)]
    fn bevel_mesh_at<'a, R: Points>(
        &'a self,
        (index, part): (usize, &'a BevelPart),
        tangential: R,
        drives: Drive,
        state: &State<'_, R>,
        book: &Notebook<'a, R>,
    ) -> BevelMeshAt<'a, R> {
        let [drive, _] = &part.flanks;
        let mesh = self.mesh_at((index, drive), tangential, drives, state, book);
        let carries = |which: usize| {
            let teeth = self.meshes[index].seat.crossed();
            teeth.is_none_or(|teeth| teeth.flanks[which].flank == Flank::Drive)
        };
        let [ahead, back] = [0, 1].map(|which| R::constant(f64::from(u8::from(carries(which)))));
        BevelMeshAt::on_flanks(part, &mesh, R::select(tangential.is_below(R::ZERO), back, ahead))
    }

    /// The context of the model of a worm drive with this part.
    #[inline(always)]
    fn worm_mesh_at<'a, R: Points>(
        &'a self,
        (index, part): (usize, &'a WormPart),
        tangential: R,
        drives: Drive,
        state: &State<'_, R>,
        book: &Notebook<'a, R>,
    ) -> WormMeshAt<'a, R> {
        let mesh = &self.meshes[index];
        let oil = &state.oils[mesh.oil as usize];
        let notes = book.notes(mesh.law.notes());
        if mesh.greased {
            notes.branch("grease: the oil is its base oil");
        }
        with_oil!(from oil, WormMeshAt {
            part,
            torque: (tangential * mesh.seat.radius()).abs(),
            speed: self.mesh_speed(index, state.speeds),
            first_drives: R::constant(f64::from(u8::from(drives != Drive::Second))),
            notes,
        })
    }

    /// Speed of a mesh's first gear in its carrier's frame; zero if it is rounding error. \[rad/s\]
    #[inline(always)]
    fn mesh_speed<R: Real>(&self, index: usize, speeds: &[R]) -> R {
        let seat = &self.meshes[index].seat;
        let (own, carrier) = (speeds[seat.members[0]], seat.carrier.map_or(R::ZERO, |c| speeds[c]));
        let rounding = own.abs().max(carrier.abs()) * 1e-12;
        R::select((own - carrier).abs().is_above(rounding), own - carrier, R::ZERO)
    }

    /// Applies the loss of a drag model to its gears.
    fn brake_gears<R: Points>(&self, index: usize, loss: &Result<Loss<R>, Undefined>, speeds: &[R], drags: &mut [R]) {
        let Ok(loss) = loss else { return };
        let seat = &self.drags[index].seat;
        let [first, second] = seat.members;
        let watts = loss.total_watts(speeds[first]) * seat.count * self.drags[index].loss_factor;
        let [one, none] = [R::constant(1.0), R::ZERO];
        let [rests, second_rests] = [first, second].map(|member| speeds[member].is_zero());
        let share = if seat.pair {
            R::select(second_rests, one, R::select(rests, none, loss.first_share()))
        } else {
            one
        };
        drags[first] -= R::select(rests | share.is_zero(), none, share * watts / speeds[first]);
        if seat.pair {
            let rest = one - share;
            drags[second] -= R::select(second_rests | rest.is_zero(), none, rest * watts / speeds[second]);
        }
    }

    fn correct_loads<R: Points>(&self, case: &Case, group: &Group, ports: &[R], loads: &mut [SupportLoad<R>]) {
        let torque = |port: usize| ports[self.ports[port].member];
        for &support in &group.supports {
            let load = &mut loads[support];
            if let Some(imported) = &self.imported
                && let Some(read) = imported.load(case.state, support, torque(imported.port))
            {
                *load = read;
            }
            if let Some(factors) = self.load_factors.get(support) {
                load.radial = load.radial * factors.radial.value_at(torque);
                load.axial = load.axial * factors.axial.value_at(torque);
            }
        }
    }

    fn finish<R: Points>(&self, outcome: Outcome, s: &mut Scratch<R>) {
        let mut undefined = None;
        s.sum = R::wide(
            #[inline(always)]
            || {
                let mut sum = R::ZERO;
                for (place, part) in self.parts.iter().enumerate() {
                    s.watts[place] = self.part_watts(part, s).unwrap_or_else(|reason| {
                        undefined.get_or_insert((place, reason));
                        R::ZERO
                    });
                    sum += s.watts[place];
                }
                sum
            },
        );
        // Without a power flow no load is defined, and no loss has its own reason.
        s.undefined = undefined.filter(|_| matches!(outcome, Outcome::Converged { .. }));
        s.passes = match outcome {
            Outcome::Converged { .. } => s.work.passes,
            _ => R::ZERO,
        };
        let (work, speeds) = (&s.work, &s.models.conditions.speeds);
        let powers = self
            .ports
            .iter()
            .map(|port| work.ports[port.member] * speeds[port.member]);
        s.balance = Balance::from_powers(powers.clone());
        let regime = Status::from_powers(s.balance, powers, self.reference_port());
        let exceeded = s.balance.input.is_above(R::ZERO) & s.sum.is_above(s.balance.input);
        for (point, status) in s.status.iter_mut().enumerate() {
            *status = match outcome {
                Outcome::SelfLocking => Status::SelfLocking,
                Outcome::NoConvergence => Status::NoConvergence,
                Outcome::Converged { .. } if undefined.is_some() => Status::Undefined,
                Outcome::Converged { .. } if s.standing => Status::Standstill,
                Outcome::Converged { .. } if s.ideal && exceeded.at_point(point) => Status::LossAboveInput,
                Outcome::Converged { .. } => regime(point),
            };
        }
    }
}

/// Loss of one copy of a component. If no bearing of the shaft takes its thrust, the load of its bearings is unknown and so is
/// their loss, unless it was switched off.
#[inline(always)]
fn component_loss<R: Answers>(
    component: &Component,
    state: &State<'_, R>,
    book: &Notebook<'_, R>,
    live: &mut R::Mask,
) -> Result<Loss<R>, Undefined> {
    state.count_call(*live);
    let answer = R::placed(&*component.placed, state, book);
    let untaken = component.support.map_or(R::ZERO, |n| state.loads[n as usize].untaken);
    accepted(answer, untaken, live)
}

/// Loss of one copy of a component that carries load; the mean over the copies if their loads differ.
#[inline(always)]
fn loaded_loss<R: Answers>(
    component: &Component,
    state: &State<'_, R>,
    uneven: &[Vec<SupportLoad<R>>],
    book: &Notebook<'_, R>,
    live: &mut R::Mask,
) -> Result<Loss<R>, Undefined> {
    book.clear(component.notes);
    match &component.sharing {
        None => component_loss(component, state, book, live),
        Some(sharing) => over_planets(sharing, book, component.notes, |which| {
            let loads = &uneven[which];
            component_loss(component, &State { loads, ..*state }, book, live)
        }),
    }
}

/// The mean over the planets of a set: those with different loads, the most loaded one first, each evaluated once. The notes of the others
/// are added to those of the first.
fn over_planets<R: Points>(
    sharing: &Sharing,
    book: &Notebook<'_, R>,
    base: NoteBase,
    mut evaluate: impl FnMut(usize) -> Result<Loss<R>, Undefined>,
) -> Result<Loss<R>, Undefined> {
    let notes = book.notes(base);
    notes.branch("the most loaded planet");
    let counts = sharing.counts();
    let (mut mean, mut planets) = (evaluate(0)?, counts[0]);
    for (which, count) in counts.iter().enumerate().skip(1) {
        notes.branch(if counts.len() == 2 {
            "each other planet"
        } else {
            "another planet"
        });
        let all = planets + count;
        mean = mean.mean(planets / all, evaluate(which)?);
        planets = all;
    }
    Ok(mean)
}

/// A model's result is accepted only if it is finite and not negative, and if it is zero where thrust is untaken. Among several
/// points, those where it is not leave.
#[inline(always)]
fn accepted<R: Points>(
    answer: Result<Loss<R>, Undefined>,
    untaken: R,
    live: &mut R::Mask,
) -> Result<Loss<R>, Undefined> {
    let loss = answer?;
    let (sound, taken) = (loss.is_sound(), untaken.is_zero() | !loss.sum().is_above(R::ZERO));
    if (sound & taken).all() {
        return Ok(loss);
    }
    if R::COUNT > 1 {
        *live = *live & sound & taken;
        return Ok(loss.only_where(sound));
    }
    Err(if sound.all() {
        Undefined {
            what: "thrust that no bearing of the shaft takes [N]",
            value: untaken.at_point(0),
        }
    } else {
        Undefined {
            what: "result of the model, which is negative or not finite",
            value: loss.sum().at_point(0),
        }
    })
}

/// Moment of a loss about its relative speed; zero at standstill, where statics does not determine friction.
#[inline(always)]
fn moment<R: Real>(loss: &Result<Loss<R>, Undefined>, speed: R) -> R {
    match loss {
        Ok(loss) => R::select(speed.is_zero(), R::ZERO, loss.total_moment(speed)),
        _ => R::ZERO,
    }
}

/// Applies a moment between two members, against their relative speed.
#[inline(always)]
fn brake<R: Points>(between: [Option<u16>; 2], speed: R, moment: R, drags: &mut [R]) {
    let signed = R::select(speed.is_below(R::ZERO), -moment, moment);
    if let Some(a) = between[0] {
        drags[a as usize] -= signed;
    }
    if let Some(b) = between[1] {
        drags[b as usize] += signed;
    }
}
