//! Result of a point: a view into the scratch. Totals derive from terms.

use super::Scratch;
use crate::flow::Status;
use crate::geometry::crossed::Flank;
use crate::loads::{PairLoads, SupportLoad, ToothForces};
use crate::loss::{Extent, Loss, Notebook, Trace, Undefined};
use crate::mechanism::bevel_mesh::BevelMeshAt;
use crate::mechanism::crossed_helical_mesh::CrossedHelicalMeshAt;
use crate::mechanism::gear_mesh::GearMeshAt;
use crate::mechanism::worm_mesh::WormMeshAt;
use crate::real::{Points, Real};
use crate::transmission::{Case, MeshLaw, PartInfo, PartKind, PlanetShares, Transmission};

/// Loss of one part, all copies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartLoss {
    /// The model's result for one copy.
    pub result: Result<Loss, Undefined>,
    /// Relative speed opposed by the moments. \[rad/s\]
    pub speed: f64,
    /// Copies, times the factor on the loss.
    pub factor: f64,
    /// True if nothing moves, so that no power is lost.
    pub still: bool,
}

impl PartLoss {
    /// Power; zero if it is undefined, which the solution reports. \[W\]
    pub fn watts(&self) -> f64 {
        match self.result {
            Ok(loss) if !self.still => loss.total_watts(self.speed) * self.factor,
            _ => 0.0,
        }
    }

    /// Power of one term. \[W\]
    pub fn term_watts(&self, index: usize) -> f64 {
        match self.result {
            Ok(loss) if !self.still => loss.watts(index, self.speed) * self.factor,
            _ => 0.0,
        }
    }

    /// Moment of one copy about its relative speed; the model's limit at standstill. \[Nm\]
    pub fn moment(&self) -> Option<f64> {
        self.result.ok().map(|loss| loss.total_moment(self.speed))
    }
}

/// Preload of a pair of bearings at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreloadAt {
    /// Temperatures of shaft and housing. \[degC\]
    pub temperatures: [f64; 2],
    /// Closing of the pair at them, negative with end play. \[m\]
    pub closing: f64,
    /// Force with which the bearings would press against each other without other loads; zero with end play. \[N\]
    pub force: f64,
    /// By how much each bearing is closed under its loads, the one that takes thrust towards -x first; below zero less than half of its elements
    /// carry, none without radial load. \[m\]
    pub closings: [f64; 2],
}

/// Results of a model at some points, with their relative speed, the factor on them, and where the part is stationary.
type PartState<'s, R> = (&'s Result<Loss<R>, Undefined>, R, R, <R as Real>::Mask);

impl Transmission {
    pub(super) fn part_loss(&self, part: &PartInfo, s: &Scratch) -> PartLoss {
        let (result, speed, factor, still) = self.part_state(part, s);
        PartLoss {
            result: *result,
            speed,
            factor,
            still,
        }
    }

    /// Powers of a part, as [`PartLoss::watts`].
    #[inline(always)]
    pub(super) fn part_watts<R: Points>(&self, part: &PartInfo, s: &Scratch<R>) -> Result<R, Undefined> {
        let (loss, speed, factor, still) = self.part_state(part, s);
        let loss = loss.as_ref().map_err(|reason| *reason)?;
        Ok(R::select(still, R::ZERO, loss.total_watts(speed) * factor))
    }

    /// Powers of one term of a part by number, as [`PartLoss::term_watts`].
    #[inline(always)]
    pub(super) fn term_watts<R: Points>(&self, part: usize, term: usize, s: &Scratch<R>) -> R {
        let (loss, speed, factor, still) = self.part_state(&self.parts[part], s);
        let watts = loss.as_ref().map_or(R::ZERO, |loss| loss.watts(term, speed) * factor);
        R::select(still, R::ZERO, watts)
    }

    #[inline(always)]
    fn part_state<'s, R: Points>(&self, part: &PartInfo, s: &'s Scratch<R>) -> PartState<'s, R> {
        let m = &s.models;
        let speeds = &m.conditions.speeds[..];
        match part.kind {
            PartKind::Component(i) => {
                let relative = m.relative[i];
                (
                    &m.component_losses[i],
                    relative,
                    self.copies(i, speeds),
                    relative.is_zero(),
                )
            }
            PartKind::Mesh(i) => {
                let speed = self.mesh_speed(i, speeds);
                let count = self.meshes[i].seat.count * self.meshes[i].loss_factor;
                let factor = R::constant(count) * self.mesh_grip(i, speeds);
                (&m.mesh_losses[i], speed, factor, speed.is_zero())
            }
            PartKind::Transfer(i) => {
                let transfer = &self.transfers[i];
                let speed = super::transfers::transfer_speed(transfer, speeds);
                let factor = self.transfer_grip(transfer, speeds) * transfer.loss_factor;
                (&m.transfer_losses[i], speed, factor, speed.is_zero())
            }
            PartKind::Drag(i) => {
                let seat = &self.drags[i].seat;
                let [first, second] = seat.members.map(|m| speeds[m]);
                let alone = R::mask(|_| !seat.pair);
                let still = first.is_zero() & (alone | second.is_zero());
                let factor = R::constant(seat.count * self.drags[i].loss_factor);
                (&m.drag_losses[i], first, factor, still)
            }
        }
    }
}

/// Force of teeth on axes that cross, x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothForceAt {
    /// Mean point. \[m\]
    pub place: [f64; 3],
    /// Force at the mean point. \[N\]
    pub force: [f64; 3],
    /// Moment about the mean point in addition, by friction along the path of contact. \[Nm\]
    pub moment: [f64; 3],
    /// Which flanks touch.
    pub flank: Flank,
}

/// A solved point.
pub struct Solution<'a> {
    pub(super) transmission: &'a Transmission,
    pub(super) case: &'a Case,
    pub(super) scratch: &'a Scratch,
}

impl Solution<'_> {
    /// Operating state of the transmission.
    pub fn status(&self) -> Status {
        self.scratch.status()
    }

    /// True if losses are defined: the power flow converged and no loss is undefined.
    pub fn is_complete(&self) -> bool {
        self.has_flow() && self.status() != Status::Undefined
    }

    /// False if no torques were found; then no torque, load or loss of the solution is defined.
    pub fn has_flow(&self) -> bool {
        self.status().has_flow()
    }

    /// Paths of the meshes whose driving gear changed during the iteration; if the transmission is self-locking, of the locking
    /// meshes.
    pub fn turned_meshes(&self) -> impl Iterator<Item = &str> {
        let paths = |mesh| {
            let kind = self.transmission.kind_of_row(mesh);
            let parts = &mut self.transmission.parts.iter();
            parts.find(|part| part.kind == kind).map(|part| part.path.as_str())
        };
        self.scratch.work.doubtful().filter_map(paths)
    }

    /// Paths of the worm drives in which the wheel pushes and cannot drive the worm: their loss is at least the power of the wheel.
    pub fn locked_worms(&self) -> impl Iterator<Item = &str> {
        let t = self.transmission;
        let locked = |mesh: &usize| {
            let Some(at) = self.worm_mesh_at(*mesh) else {
                return false;
            };
            let loss = self.scratch.models.mesh_losses[*mesh].as_ref();
            let watts = loss.map_or(0.0, |loss| loss.total_watts(at.speed));
            !at.worm_drives() && at.input() > 0.0 && watts >= at.input()
        };
        (0..t.meshes.len())
            .filter(locked)
            .map(|mesh| t.meshes[mesh].seat.path.as_str())
    }

    /// Why a loss is undefined: its part and the reason.
    pub fn undefined(&self) -> Option<(&PartInfo, Undefined)> {
        self.scratch
            .undefined
            .map(|(part, reason)| (&self.transmission.parts[part], reason))
    }

    /// Number of the part whose loss is undefined, and the reason.
    pub fn undefined_part(&self) -> Option<(usize, Undefined)> {
        self.scratch.undefined
    }

    /// Sum of all losses; `None` if one is undefined. \[W\]
    pub fn loss(&self) -> Option<f64> {
        self.is_complete().then_some(self.scratch.sum)
    }

    /// Input power; with ideal power flow that of the driving ports. \[W\]
    pub fn input_power(&self) -> Option<f64> {
        self.is_complete().then_some(self.scratch.balance.input)
    }

    /// Output power; with ideal power flow the input minus the losses, `None` if they exceed it. \[W\]
    pub fn output_power(&self) -> Option<f64> {
        self.loss().and_then(|_| self.scratch.output_power(0))
    }

    /// Output power over input power; `None` if the output is zero.
    pub fn efficiency(&self) -> Option<f64> {
        let (input, output) = (self.input_power()?, self.output_power()?);
        (output > 0.0 && input > 0.0).then(|| output / input)
    }

    /// Loss over the speed of the reference port; `None` at standstill. \[Nm\]
    pub fn loss_torque(&self) -> Option<f64> {
        let t = self.transmission;
        let speed = self.scratch.models.conditions.speeds[t.ports[t.reference_port()].member].abs();
        let loss = self.loss()?;
        (speed > 0.0).then(|| loss / speed)
    }

    /// Power balance error: input minus output minus losses; zero to rounding with real power flow, `None` with ideal power flow.
    /// \[W\]
    pub fn residual(&self) -> Option<f64> {
        let t = self.transmission;
        if self.scratch.ideal {
            return None;
        }
        let power: f64 = t
            .ports
            .iter()
            .map(|p| self.scratch.work.ports[p.member] * self.scratch.models.conditions.speeds[p.member])
            .sum();
        Some(power - self.loss()?)
    }

    /// Largest internal power: rolling powers and those of ports. \[W\]
    pub fn largest_power(&self) -> f64 {
        self.scratch.work.largest
    }

    /// Evaluations of the laws of the loop of torques and losses that needs the most; one without loops.
    pub fn passes(&self) -> usize {
        self.scratch.passes as usize
    }

    /// Speed of a member by number. \[rad/s\]
    pub fn speed(&self, member: usize) -> f64 {
        self.scratch.models.conditions.speeds[member]
    }

    /// Torque that a port of a member applies. \[Nm\]
    pub fn port_torque(&self, member: usize) -> f64 {
        self.scratch.port_torque(member)
    }

    /// Torque that a port applies to the transmission. \[Nm\]
    pub fn torque(&self, port: usize) -> f64 {
        self.scratch.work.ports[self.transmission.ports[port].member]
    }

    /// The same, `None` if no power flow was found, or for an output of an ideal power flow whose losses exceed its input. \[Nm\]
    pub fn known_torque(&self, port: usize) -> Option<f64> {
        let torque = self.torque(port);
        let leaves = self.speed(self.transmission.ports[port].member) * torque < 0.0;
        let nothing_left = self.status() == Status::LossAboveInput && leaves;
        (self.has_flow() && !nothing_left).then_some(torque)
    }

    /// Load sharing of each planetary set whose planets carry different loads, by the first of its meshes.
    pub fn planet_shares(&self) -> Vec<PlanetShares> {
        let mut found: Vec<PlanetShares> = Vec::new();
        for (mesh, force) in self.transmission.meshes.iter().zip(&self.scratch.models.forces) {
            let Some(sharing) = &mesh.sharing else { continue };
            if found.iter().all(|known| known.set != sharing.set.set) {
                found.extend(sharing.set.shares(*force * sharing.pin));
            }
        }
        found
    }

    /// Load of a support by number on the most loaded planet of its set; `None` if planets share equally.
    pub fn most_loaded(&self, support: usize) -> Option<SupportLoad> {
        let of = self
            .transmission
            .components
            .iter()
            .find(|c| c.support == Some(support as u16))?;
        of.sharing.as_ref()?;
        self.scratch.models.uneven_loads.first()?.get(support).copied()
    }

    /// Load of a support by number; the mean over the planets if it is on one.
    pub fn load(&self, support: usize) -> SupportLoad {
        self.scratch.models.conditions.loads[support]
    }

    /// Loads of a pair of the transmission by its number, before load factors; with the mean loads of planets, or with those of the most
    /// loaded one.
    pub fn pair_loads(&self, pair: usize, most_loaded: bool) -> Option<PairLoads> {
        let t = self.transmission;
        let models = &self.scratch.models;
        let support = t.pairs.get(pair)?.supports().next()?;
        let most = models.uneven_forces.first().filter(|_| most_loaded);
        let mut passed = vec![0.0; t.loads.scratch_len()];
        t.loads.pair_loads(
            support,
            ToothForces {
                tangential: most.unwrap_or(&models.forces),
                friction: &models.friction,
                turning: &models.turning,
            },
            &models.conditions.speeds,
            &models.closings,
            &mut passed,
        )
    }

    /// The preload of a pair of the transmission by its number, with the mean loads of planets; `None` without one.
    pub fn preload(&self, pair: usize) -> Option<PreloadAt> {
        let t = self.transmission;
        let own = t.pairs.get(pair)?;
        let preload = own.preload.as_ref()?;
        let models = &self.scratch.models;
        let c = &models.conditions;
        let temperatures = preload.temperatures(&c.temperatures, &c.oils);
        let closing = preload.closing_at(temperatures);
        let mut passed = vec![0.0; t.loads.scratch_len()];
        let support = own.supports().next()?;
        let closings = t
            .loads
            .pair_closings(support, self.teeth(), &c.speeds, &models.closings, &mut passed)?;
        Some(PreloadAt {
            temperatures,
            closing,
            force: preload.bearings.force(closing),
            closings,
        })
    }

    /// The part of the axial load of a support that induced thrust adds, with its load factor; on the most loaded planet if this is
    /// requested. `None` if the support is in no pair, in one with a spring or a preload, or if its load is imported. \[N\]
    pub fn induced(&self, support: usize, most_loaded: bool) -> Option<f64> {
        let t = self.transmission;
        let number = t
            .pairs
            .iter()
            .position(|pair| pair.supports().any(|own| own == support))?;
        let pair = &t.pairs[number];
        let imported = t.imported.as_ref();
        if pair.spring.is_some()
            || pair.preload.is_some()
            || imported.is_some_and(|own| own.reads(self.case.state, support).is_some())
        {
            return None;
        }
        let loads = self.pair_loads(number, most_loaded)?;
        let side = pair.side_of(support)?;
        let axial = if most_loaded {
            self.most_loaded(support)?.axial
        } else {
            self.load(support).axial
        };
        // The same share and factor apply to both.
        Some(if loads.axial[side] > 0.0 {
            axial * (loads.mutual() / loads.axial[side])
        } else {
            0.0
        })
    }

    /// The part of the radial load of a support that turns with a carrier, whose planets carry different loads, with its load factor; zero for
    /// an imported load. \[N\]
    pub fn turning_load(&self, support: usize) -> f64 {
        let t = self.transmission;
        let imported = t.imported.as_ref();
        if imported.is_some_and(|own| own.reads(self.case.state, support).is_some()) {
            return 0.0;
        }
        let teeth = self.teeth();
        let turning = t.loads.turning(support, teeth);
        if turning > 0.0 {
            let standing = t.loads.on_inner(teeth, self.scratch.speeds())[support];
            let all = standing[0].hypot(standing[1]).hypot(turning);
            turning * self.load(support).radial / all
        } else {
            0.0
        }
    }

    /// The radial force of each support on its inner member, y and z, with its factor, without the part that turns with a carrier; the mean over the planets if it is on one, where y
    /// points away from the axis of the carrier. `None` if the load is imported, which has no direction. \[N\]
    pub fn radial_forces(&self) -> Vec<Option<[f64; 2]>> {
        let t = self.transmission;
        let models = &self.scratch.models;
        let teeth = ToothForces {
            tangential: &models.forces,
            friction: &models.friction,
            turning: &models.turning,
        };
        let forces = t.loads.on_inner(teeth, &models.conditions.speeds);
        let of_support = |(support, force): (usize, [f64; 2])| {
            let imported = t.imported.as_ref();
            if imported.is_some_and(|own| own.tables[self.case.state][support].is_some()) {
                return None;
            }
            let length = force[0].hypot(force[1]);
            let all = match t.loads.turning(support, teeth) {
                0.0 => length,
                turning => length.hypot(turning),
            };
            let factor = if all > 0.0 {
                self.load(support).radial / all
            } else {
                1.0
            };
            Some(force.map(|part| part * factor))
        };
        forces.into_iter().enumerate().map(of_support).collect()
    }

    /// Torque of one copy of a mesh on its first gear, signed. \[Nm\]
    pub fn mesh_torque(&self, mesh: usize) -> f64 {
        self.scratch.models.forces[mesh] * self.transmission.meshes[mesh].seat.radius()
    }

    /// The context of the model of a mesh of cylindrical gears, one copy, with muted notes; `None` of other gears.
    pub fn mesh_at(&self, mesh: usize) -> Option<GearMeshAt<'_>> {
        let s = self.scratch;
        let state = self.state();
        let part = self.transmission.meshes[mesh].law.cylindrical()?;
        Some(self.transmission.mesh_at(
            (mesh, part),
            s.models.forces[mesh],
            s.work.drives[mesh],
            &state,
            &Notebook::CLOSED,
        ))
    }

    /// The context of the model of a mesh of bevel gears, with muted notes; `None` of other gears.
    pub fn bevel_mesh_at(&self, mesh: usize) -> Option<BevelMeshAt<'_>> {
        let (s, state) = (self.scratch, self.state());
        let MeshLaw::Bevel { part, .. } = &self.transmission.meshes[mesh].law else {
            return None;
        };
        Some(self.transmission.bevel_mesh_at(
            (mesh, part),
            s.models.forces[mesh],
            s.work.drives[mesh],
            &state,
            &Notebook::CLOSED,
        ))
    }

    /// The flanks that carry as a mesh with a path of contact, with muted notes: of cylindrical gears, and of bevel gears with the normal force
    /// that their torque causes without friction. `None` of other gears.
    pub fn flanks_at(&self, mesh: usize) -> Option<GearMeshAt<'_>> {
        match self.bevel_mesh_at(mesh) {
            Some(at) => Some(at.on_flank(at.flank().ok()?)),
            None => self.mesh_at(mesh),
        }
    }

    /// The context of the model of a crossed helical mesh, with muted notes; `None` of other meshes.
    pub fn crossed_helical_mesh_at(&self, mesh: usize) -> Option<CrossedHelicalMeshAt<'_>> {
        let (s, state) = (self.scratch, self.state());
        let MeshLaw::CrossedHelical { part, .. } = &self.transmission.meshes[mesh].law else {
            return None;
        };
        let flanks = self.transmission.mesh_at(
            (mesh, &part.flanks),
            s.models.forces[mesh],
            s.work.drives[mesh],
            &state,
            &Notebook::CLOSED,
        );
        Some(CrossedHelicalMeshAt::of_flanks(part, &flanks))
    }

    /// The context of the model of a worm drive, with muted notes; `None` of other meshes.
    pub fn worm_mesh_at(&self, mesh: usize) -> Option<WormMeshAt<'_>> {
        let (s, state) = (self.scratch, self.state());
        let MeshLaw::Worm { part, .. } = &self.transmission.meshes[mesh].law else {
            return None;
        };
        Some(self.transmission.worm_mesh_at(
            (mesh, part),
            s.models.forces[mesh],
            s.work.drives[mesh],
            &state,
            &Notebook::CLOSED,
        ))
    }

    /// Force of the teeth of a mesh on axes that cross on the first gear, with friction; that on the second gear is opposite. `None` of
    /// cylindrical gears.
    pub fn tooth_force(&self, mesh: usize) -> Option<ToothForceAt> {
        let teeth = self.transmission.meshes.get(mesh)?.seat.crossed()?;
        let models = &self.scratch.models;
        let (force, friction) = (models.forces[mesh], models.friction[mesh]);
        let flank = teeth.flanks[usize::from(force < 0.0)];
        // The teeth act against the motion of the first gear if it drives.
        let driving = usize::from((force < 0.0) == (friction < 0.0));
        let of_friction = flank.friction[driving];
        Some(ToothForceAt {
            place: teeth.mean_point.into(),
            force: (flank.normal * force.abs() + of_friction.force * friction).into(),
            moment: (of_friction.moment * friction).into(),
            flank: flank.flank,
        })
    }

    /// Tangential force on the first gear of one copy of each mesh, signed; after those of the meshes those of strands. \[N\]
    pub(crate) fn tangential_forces(&self) -> &[f64] {
        &self.scratch.models.forces
    }

    /// Forces of all teeth.
    fn teeth(&self) -> ToothForces<'_, f64> {
        ToothForces {
            tangential: &self.scratch.models.forces,
            friction: &self.scratch.models.friction,
            turning: &self.scratch.models.turning,
        }
    }

    /// Loss of each part, in the order of the parts.
    pub fn parts(&self) -> impl Iterator<Item = (&PartInfo, PartLoss)> {
        self.transmission
            .parts
            .iter()
            .map(|part| (part, self.transmission.part_loss(part, self.scratch)))
    }

    /// Powers of all parts, in their order; zero if undefined. \[W\]
    pub fn watts(&self) -> &[f64] {
        &self.scratch.watts
    }

    /// Observed extents of limits and observed quantities at this point.
    pub fn extents(&self) -> Vec<Extent> {
        let cells = &self.scratch.models.conditions.cells;
        cells.iter().map(|seen| seen.get().extent()).collect()
    }

    /// True if a model was outside a stated range.
    pub fn leaves_a_range(&self) -> bool {
        let models = self.transmission.rated_cells();
        self.scratch.models.conditions.leaves_a_range(0, models)
    }

    /// Static safety of a bearing by the number of its support, on the most loaded planet if it is on planets; `None` without load
    /// or if its rating is not known.
    pub fn static_safety(&self, support: usize) -> Option<f64> {
        let t = self.transmission;
        let rated = t.rated.iter().position(|rated| rated.support == support)?;
        let seen = self.scratch.models.conditions.cells[t.rated_cells() + rated]
            .get()
            .extent();
        (seen.seen > 0).then_some(seen.least)
    }

    /// Evaluates one part again, recording every step. The numbers are those of the solution.
    pub fn explain(&self, part: usize) -> (PartLoss, Trace) {
        let t = self.transmission;
        let s = self.scratch;
        let trace = Trace::default();
        let state = self.state();
        let info = &t.parts[part];
        let book = Notebook {
            trace: Some(&trace),
            ..Notebook::CLOSED
        };
        let mut loss = t.part_loss(info, s);
        loss.result = match info.kind {
            PartKind::Component(i) => {
                super::loaded_loss(&t.components[i], &state, &s.models.uneven_loads, &book, &mut true)
            }
            PartKind::Mesh(i) => t.mesh(i, s.models.forces[i], s.work.drives[i], &state, &book, &mut true),
            PartKind::Drag(i) => t.drag(i, &state, &book, &mut true),
            PartKind::Transfer(i) => {
                let drives = s.work.drives[t.meshes.len() + i];
                let at = (i, t.transfer_torque(self.case, i, &s.work.multipliers), drives);
                t.transfer_loss(self.case, at, &state, &book, &mut true)
            }
        };
        (loss, trace)
    }

    /// Name of the gear state.
    pub fn gear(&self) -> &str {
        &self.transmission.states[self.case.state].name
    }
}
