//! Bearing loads: unit cases solved once, combined at every point.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::SupportLoad;
use super::layout::{Layout, LoadFault, MemberLayout, Senses, SupportLayout};
use super::pair::{Pair, PairLoads};
use super::statics::{Action, Reaction, Statics};
use super::thrust::Taking;
use crate::real::{Points, Real};

/// Loads of all supports as a function of the tangential force of each mesh.
#[derive(Debug, Clone)]
pub struct ShaftLoads {
    layout: Arc<Layout>,
    /// Reactions by support.
    pub(super) cases: Vec<Cases>,
    /// Supports whose outer member is the carried one.
    pub(super) turned: Vec<bool>,
    /// Members from the supported to the supporting, without those whose thrust passes through their supports.
    pub(super) order: Vec<Axially>,
    /// Supports whose loads are found together, and the group of each support.
    groups: Vec<Group>,
    group_of: Vec<usize>,
}

/// Forces of the teeth of all meshes.
#[derive(Debug, Clone, Copy)]
pub struct ToothForces<'a, R> {
    /// Tangential force of the first gear of one copy of each mesh, signed. \[N\]
    pub tangential: &'a [R],
    /// Friction force of each mesh, with the sign of the speed of the first gear; may be shorter, without those that no case needs. \[N\]
    pub friction: &'a [R],
    /// Force of one planet in the direction of the first one whose transverse force on the gear and the carrier is that of all copies of a
    /// mesh, but for its direction, which turns with the carrier; empty if all planets share equally. \[N\]
    pub turning: &'a [R],
}

/// The value of a pair of cases for the sign of a force.
#[inline(always)]
fn by_sense<R: Real>(backwards: R::Mask, [ahead, back]: [f64; 2]) -> R {
    R::select(backwards, R::constant(back), R::constant(ahead))
}

impl<R: Real> ToothForces<'_, R> {
    /// Friction of a mesh with the cases that hold for its sense and that of the speed.
    #[inline(always)]
    fn friction(&self, mesh: usize, cases: Senses<f64>) -> R {
        let friction = self.friction.get(mesh).copied().unwrap_or(R::ZERO);
        let (backwards, reverse) = (self.tangential[mesh].is_below(R::ZERO), friction.is_below(R::ZERO));
        friction * R::select(backwards, by_sense(reverse, cases[1]), by_sense(reverse, cases[0]))
    }
}

/// The supports of a member, or one through which thrust passes, and what their loads depend on.
#[derive(Debug, Clone, Default)]
pub struct Group {
    /// Numbers of the supports.
    pub supports: Vec<usize>,
    /// Meshes whose tangential forces load them, those with the largest forces first.
    pub meshes: Vec<usize>,
    /// Places of the member, last, and of those that pass thrust on to it, in the order.
    members: Vec<usize>,
}

/// Reactions of one support, without zero entries.
#[derive(Debug, Clone, Default)]
pub(super) struct Cases {
    /// To permanent loads.
    always: Reaction,
    /// To one newton of the tangential force of a mesh: of a positive one, and of a negative one.
    meshes: Vec<(usize, [Reaction; 2])>,
    /// To one newton of friction of a mesh.
    friction: Vec<(usize, Senses<Reaction>)>,
    /// To the centrifugal force of a planet body per squared speed of its carrier.
    planets: Vec<(usize, Reaction)>,
    /// To one newton of the tangential force of one copy of a mesh on a planet, as those of meshes: forces that turn with the carrier, for each
    /// planet body on its own.
    turning: Vec<Vec<(usize, [Reaction; 2])>>,
    /// True if there can be a couple.
    couples: bool,
    /// If a single mesh loads the support: the length of the force per newton, positive and negative.
    only: Option<(usize, [f64; 2])>,
}

impl Cases {
    /// From the reactions to permanent loads, to the units of each mesh that loads the support, and to the centrifugal force of each
    /// planet body that does.
    fn new(
        always: Reaction,
        units: &BTreeMap<usize, [Reaction; 2]>,
        friction: Vec<(usize, Senses<Reaction>)>,
        planets: Vec<(usize, Reaction)>,
        turning: Vec<BTreeMap<usize, [Reaction; 2]>>,
    ) -> Self {
        let nothing = Reaction::default();
        let meshes = by_senses(units);
        let turning: Vec<_> = turning
            .iter()
            .map(by_senses)
            .filter(|of_body| !of_body.is_empty())
            .collect();
        let torqueless = always.force != [0.0; 2] || planets.iter().any(|(_, planet)| planet.force != [0.0; 2]);
        let only = match &meshes[..] {
            [(mesh, senses)] if !torqueless && friction.is_empty() => {
                Some((*mesh, senses.map(|reaction| length(reaction.force))))
            }
            _ => None,
        };
        let of_friction = friction.iter().flat_map(|(_, senses)| senses.as_flattened());
        let of_turning = turning
            .iter()
            .flatten()
            .flat_map(|(_, senses): &(usize, [Reaction; 2])| senses);
        let mut reactions = (units.values().flatten())
            .chain(planets.iter().map(|(_, planet)| planet))
            .chain(of_friction)
            .chain(of_turning);
        Self {
            only,
            couples: always.couple != [0.0; 2] || reactions.any(|reaction| reaction.couple != [0.0; 2]),
            always,
            meshes,
            friction,
            planets: planets
                .into_iter()
                .filter(|(_, reaction)| *reaction != nothing)
                .collect(),
            turning,
        }
    }

    /// Adds the forces, or the couples, that turn with a carrier to the length of those that stand: the root of the mean square over a turn.
    /// The mean is at most 10 % less, the cubic mean of a bearing's life at most 6.3 % more; both are equal to it if one part is zero.
    #[inline(always)]
    fn with_turning<R: Real>(
        &self,
        standing: R,
        part: impl Fn(&Reaction) -> [f64; 2],
        teeth: &ToothForces<'_, R>,
    ) -> R {
        if self.turning.is_empty() || teeth.turning.is_empty() {
            return standing;
        }
        let mut square = standing * standing;
        for meshes in &self.turning {
            let [y, z] = of_meshes([R::ZERO; 2], meshes, &part, teeth.turning);
            square += y * y + z * z;
        }
        square.sqrt()
    }

    /// The radial load of the support.
    #[inline(always)]
    fn radial<R: Real>(&self, teeth: &ToothForces<'_, R>, speeds: &[R]) -> R {
        let standing = match &self.only {
            Some((mesh, lengths)) => under(lengths, teeth.tangential[*mesh]),
            None => length(self.sum(|reaction| reaction.force, teeth, speeds)),
        };
        self.with_turning(standing, |reaction| reaction.force, teeth)
    }

    /// The force, or the couple, on the support; `part` chooses it. The part that is independent of torque depends on the squared
    /// speed of carriers.
    #[inline(always)]
    fn sum<R: Real>(&self, part: impl Fn(&Reaction) -> [f64; 2], teeth: &ToothForces<'_, R>, speeds: &[R]) -> [R; 2] {
        let [mut y, mut z] = part(&self.always).map(R::constant);
        for (carrier, reaction) in &self.planets {
            let (case, factor) = (part(reaction), speeds[*carrier] * speeds[*carrier]);
            y += factor * case[0];
            z += factor * case[1];
        }
        [y, z] = of_meshes([y, z], &self.meshes, &part, teeth.tangential);
        for (mesh, senses) in &self.friction {
            let along = |axis: usize| senses.map(|turns| turns.map(|reaction| part(&reaction)[axis]));
            y += teeth.friction(*mesh, along(0));
            z += teeth.friction(*mesh, along(1));
        }
        [y, z]
    }
}

/// The reactions to a positive and to a negative newton of each mesh, without those that are zero; the part that depends on the magnitude of a
/// force is added to or subtracted from the linear part.
fn by_senses(units: &BTreeMap<usize, [Reaction; 2]>) -> Vec<(usize, [Reaction; 2])> {
    let of_senses = |pair: &[Reaction; 2]| {
        [1.0, -1.0].map(|sense| {
            let mut sum = pair[0];
            add(&mut sum, &pair[1], sense);
            sum
        })
    };
    units
        .iter()
        .map(|(mesh, pair)| (*mesh, of_senses(pair)))
        .filter(|(_, pair)| *pair != [Reaction::default(); 2])
        .collect()
}

/// Adds the forces, or the couples, by the tangential forces of meshes.
#[inline(always)]
fn of_meshes<R: Real>(
    [mut y, mut z]: [R; 2],
    meshes: &[(usize, [Reaction; 2])],
    part: impl Fn(&Reaction) -> [f64; 2],
    tangential: &[R],
) -> [R; 2] {
    for (mesh, [ahead, back]) in meshes {
        let force = tangential[*mesh];
        let backwards = force.is_below(R::ZERO);
        let (ahead, back) = (part(ahead), part(back));
        y += force * R::select(backwards, R::constant(back[0]), R::constant(ahead[0]));
        z += force * R::select(backwards, R::constant(back[1]), R::constant(ahead[1]));
    }
    [y, z]
}

#[derive(Debug, Clone)]
pub(super) struct Axially {
    /// Permanent thrust. \[N\]
    pub always: f64,
    /// Magnitude of the forces in its sum. \[N\]
    pub size: f64,
    /// Mesh and thrust per newton of its tangential force.
    pub meshes: Vec<(usize, f64)>,
    /// Meshes whose thrust depends on the sense of the force and on friction.
    pub crossed: Vec<CrossedThrust>,
    pub taking: Taking,
    /// Index in the order of the member that takes the thrust of the supports, with the number of copies.
    pub carrier: Option<(usize, f64)>,
}

/// Thrust of a mesh of gears on axes that cross.
#[derive(Debug, Clone, Copy)]
pub(super) struct CrossedThrust {
    mesh: usize,
    /// Per newton of a positive and of a negative tangential force.
    normal: [f64; 2],
    /// Per newton of friction.
    friction: Senses<f64>,
}

impl CrossedThrust {
    /// That of several copies.
    fn times(self, copies: f64) -> Self {
        Self {
            mesh: self.mesh,
            normal: self.normal.map(|thrust| thrust * copies),
            friction: self.friction.map(|turns| turns.map(|thrust| thrust * copies)),
        }
    }
}

impl Axially {
    /// The thrust with that which other members pass on, and the magnitude of the forces in its sum.
    #[inline(always)]
    fn thrust<R: Real>(&self, teeth: &ToothForces<'_, R>, passed: R, size: R) -> (R, R) {
        let (mut thrust, mut scale) = (R::constant(self.always), R::constant(self.size));
        for (mesh, factor) in &self.meshes {
            let force = teeth.tangential[*mesh] * *factor;
            thrust += force;
            scale += force.abs();
        }
        for own in &self.crossed {
            let tangential: R = teeth.tangential[own.mesh];
            let normal: R = tangential * by_sense::<R>(tangential.is_below(R::ZERO), own.normal);
            let friction = teeth.friction(own.mesh, own.friction);
            thrust += normal + friction;
            scale += normal.abs() + friction.abs();
        }
        (thrust + passed, scale + size)
    }
}

impl Group {
    /// The groups of all supports.
    fn all(cases: &[Cases], order: &[Axially]) -> Vec<Self> {
        let mut alone = vec![true; cases.len()];
        let mut groups = Vec::new();
        for (place, member) in order.iter().enumerate() {
            let supports = member.taking.supports();
            if supports.is_empty() {
                continue;
            }
            // Those that pass thrust on precede the members to which they do.
            let mut members = vec![place];
            for earlier in (0..place).rev() {
                let carrier = order[earlier].carrier;
                if carrier.is_some_and(|(carrier, _)| members.contains(&carrier)) {
                    members.push(earlier);
                }
            }
            members.reverse();
            for support in supports {
                alone[*support] = false;
            }
            groups.push(Self {
                supports: supports.to_vec(),
                members,
                meshes: Vec::new(),
            });
        }
        let alone = (0..cases.len()).filter(|support| alone[*support]);
        groups.extend(alone.map(|support| Self {
            supports: vec![support],
            ..Self::default()
        }));
        for group in &mut groups {
            let mut forces: BTreeMap<usize, f64> = BTreeMap::new();
            let turning = group
                .supports
                .iter()
                .flat_map(|support| cases[*support].turning.iter().flatten());
            let standing = group.supports.iter().flat_map(|support| &cases[*support].meshes);
            for (mesh, senses) in standing.chain(turning) {
                let sizes = senses.iter().map(|reaction| length(reaction.force));
                *forces.entry(*mesh).or_default() += sizes.sum::<f64>();
            }
            for (mesh, factor) in group.members.iter().flat_map(|place| &order[*place].meshes) {
                *forces.entry(*mesh).or_default() += factor.abs();
            }
            for own in group.members.iter().flat_map(|place| &order[*place].crossed) {
                *forces.entry(own.mesh).or_default() += own.normal.iter().map(|thrust| thrust.abs()).sum::<f64>();
            }
            for (mesh, senses) in group.supports.iter().flat_map(|support| &cases[*support].friction) {
                let sizes = senses.as_flattened().iter().map(|reaction| length(reaction.force));
                *forces.entry(*mesh).or_default() += sizes.sum::<f64>();
            }
            let mut forces: Vec<(usize, f64)> = forces.into_iter().collect();
            forces.sort_by(|a, b| b.1.total_cmp(&a.1));
            group.meshes = forces.into_iter().map(|(mesh, _)| mesh).collect();
        }
        groups
    }
}

impl ShaftLoads {
    /// Solves the unit cases.
    ///
    /// # Errors
    /// All faults of the arrangement.
    pub fn new(layout: &Layout) -> Result<Self, Vec<LoadFault>> {
        let system = System::new(layout)?;
        let units = system.units();
        let cases = system.permanent().into_iter().zip(&units);
        let cases = cases.zip(system.friction()).zip(system.planets()).zip(system.turning());
        let cases: Vec<Cases> = cases
            .map(|((((always, units), friction), planets), turning)| {
                Cases::new(always, units, friction, planets, turning)
            })
            .collect();
        let turned = layout.supports.iter();
        let turned = turned
            .map(|support| layout.carried(support).0 != support.inner)
            .collect();
        let order = passed_on(system.axial());
        let groups = Group::all(&cases, &order);
        let mut group_of = vec![0; cases.len()];
        for (number, group) in groups.iter().enumerate() {
            for support in &group.supports {
                group_of[*support] = number;
            }
        }
        Ok(Self {
            layout: Arc::new(layout.clone()),
            cases,
            turned,
            order,
            groups,
            group_of,
        })
    }

    /// What the loads were calculated from.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Length of the scratch of [`ShaftLoads::evaluate`].
    pub fn scratch_len(&self) -> usize {
        2 * self.order.len()
    }

    /// Supports whose loads are found together.
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// The group of a support.
    pub fn group_of(&self, support: usize) -> usize {
        self.group_of[support]
    }

    /// Writes the loads of the supports of a group. `teeth` are the forces of the meshes, `speeds`
    /// are those of all members (rad/s), `closings` those of pairs with a stated preload by member (m), the length of `passed` is
    /// [`ShaftLoads::scratch_len`].
    #[inline(always)]
    pub fn evaluate<R: Points>(
        &self,
        group: &Group,
        teeth: ToothForces<'_, R>,
        speeds: &[R],
        closings: &[R],
        passed: &mut [R],
        loads: &mut [SupportLoad<R>],
    ) {
        for &support in &group.supports {
            let cases = &self.cases[support];
            loads[support] = SupportLoad {
                radial: cases.radial(&teeth, speeds),
                axial: R::ZERO,
                // Few supports take a couple, and a square root is expensive.
                tilting: if cases.couples {
                    let standing = length(cases.sum(|reaction| reaction.couple, &teeth, speeds));
                    cases.with_turning(standing, |reaction| reaction.couple, &teeth)
                } else {
                    R::ZERO
                },
                untaken: R::ZERO,
            };
        }
        if let Some(own) = group.members.last() {
            let (thrust, scale) = self.thrust(group, *own, &teeth, passed);
            self.order[*own].taking.share(thrust, scale, closings, loads);
        }
    }

    /// The thrust towards +x of the last member of a group, with that which others pass on to it, and the magnitude of the forces in its
    /// sum.
    #[inline(always)]
    fn thrust<R: Real>(&self, group: &Group, own: usize, teeth: &ToothForces<'_, R>, passed: &mut [R]) -> (R, R) {
        // Thrust that members pass on, and the magnitude of the forces in its sum.
        let (passed, sizes) = passed.split_at_mut(self.order.len());
        for &place in &group.members {
            (passed[place], sizes[place]) = (R::ZERO, R::ZERO);
        }
        for &place in group.members.iter().filter(|place| **place != own) {
            let member = &self.order[place];
            let (thrust, scale) = member.thrust(teeth, passed[place], sizes[place]);
            // However the supports share it, the net thrust goes to the supporting member.
            if let Some((carrier, copies)) = member.carrier {
                passed[carrier] += (thrust - member.taking.untaken(thrust, scale)) * copies;
                sizes[carrier] += scale * copies;
            }
        }
        self.order[own].thrust(teeth, passed[own], sizes[own])
    }

    /// Pairs of opposed bearings, each of one member.
    pub fn pairs(&self) -> impl Iterator<Item = &Pair> {
        self.order.iter().filter_map(|member| member.taking.pair())
    }

    /// The loads of a pair before load factors, by the number of one of its supports; the other arguments are those of
    /// [`ShaftLoads::evaluate`]. `None` if the support is in no pair.
    #[inline(always)]
    pub fn pair_loads<R: Points>(
        &self,
        support: usize,
        teeth: ToothForces<'_, R>,
        speeds: &[R],
        closings: &[R],
        passed: &mut [R],
    ) -> Option<PairLoads<R>> {
        let group = &self.groups[self.group_of[support]];
        let own = *group.members.last()?;
        let taking = &self.order[own].taking;
        let pair = taking.pair()?;
        let (thrust, _) = self.thrust(group, own, &teeth, passed);
        let closing = closings.get(pair.member).copied().unwrap_or(R::ZERO);
        Some(pair.loads(taking.with_springs(thrust), closing, |support| {
            self.cases[support].radial(&teeth, speeds)
        }))
    }

    /// By how much each bearing of a pair with a stated preload is closed; the arguments are those of [`ShaftLoads::pair_loads`]. `None` of
    /// other supports. \[m\]
    pub fn pair_closings<R: Points>(
        &self,
        support: usize,
        teeth: ToothForces<'_, R>,
        speeds: &[R],
        closings: &[R],
        passed: &mut [R],
    ) -> Option<[R; 2]> {
        let loads = self.pair_loads(support, teeth, speeds, closings, passed)?;
        let own = *self.groups[self.group_of[support]].members.last()?;
        let pair = self.order[own].taking.pair()?;
        let radial = [0, 1].map(|side| self.cases[pair.sides[side][0].support].radial(&teeth, speeds));
        let closing = closings.get(pair.member).copied()?;
        Some(pair.stiff.as_ref()?.closings(loads.axial, radial, closing))
    }

    /// The force of each support on its member, y and z, for given forces of the teeth, with carriers at standstill. \[N\]
    pub fn vectors(&self, teeth: ToothForces<'_, f64>) -> Vec<[f64; 2]> {
        // Carriers are the only members whose speed matters.
        let carriers = self.cases.iter().flat_map(|cases| &cases.planets);
        let still = vec![0.0; carriers.map(|(carrier, _)| carrier + 1).max().unwrap_or(0)];
        let sum = |cases: &Cases| cases.sum(|reaction| reaction.force, &teeth, &still);
        self.cases.iter().map(sum).collect()
    }

    /// Length of the force of a support that turns with a carrier. \[N\]
    pub(crate) fn turning(&self, support: usize, teeth: ToothForces<'_, f64>) -> f64 {
        self.cases[support].with_turning(0.0, |reaction| reaction.force, &teeth)
    }

    /// The force of each support on its inner member, y and z, at the speeds of all members (rad/s). On a planet, y points away from the
    /// axis of the carrier. \[N\]
    pub(crate) fn on_inner(&self, teeth: ToothForces<'_, f64>, speeds: &[f64]) -> Vec<[f64; 2]> {
        let supports = self.cases.iter().zip(&self.turned);
        supports
            .map(|(cases, turned)| {
                let force = cases.sum(|reaction| reaction.force, &teeth, speeds);
                if *turned { force.map(|part| -part) } else { force }
            })
            .collect()
    }
}

/// A support as the member that it carries sees it: thrust of a shaft towards +x is thrust towards -x of the members that it supports.
fn from_the_carried(layout: &Layout, support: &SupportLayout) -> SupportLayout {
    let (carried, carrier) = layout.carried(support);
    let turned = carried != support.inner;
    SupportLayout {
        outer: carrier,
        inner: carried,
        axial: if turned {
            support.axial.opposite()
        } else {
            support.axial
        },
        spring: if turned { -support.spring } else { support.spring },
        ..*support
    }
}

/// Where loads can act on each member: its own forces and moments, meshes, members that it carries, a planet's centrifugal force. \[m\]
fn loaded_places(layout: &Layout, own: &[Vec<(usize, SupportLayout)>], meshes_of: &[Vec<usize>]) -> Vec<Vec<f64>> {
    let mut loaded: Vec<Vec<f64>> = Vec::with_capacity(layout.members.len());
    for (m, (loads, meshes)) in layout.members.iter().zip(meshes_of).enumerate() {
        let forces = loads.forces.iter().map(|f| f.0);
        let moments = loads.moments.iter().map(|f| f.0);
        let meshes = meshes.iter().map(|mesh| {
            let mesh = &layout.meshes[*mesh];
            mesh.at(usize::from(mesh.members()[0] != m), loads.start)
        });
        loaded.push(forces.chain(moments).chain(meshes).collect());
    }
    for support in &layout.supports {
        if let Some(carrier) = layout.carried(support).1 {
            loaded[carrier].push(support.at);
        }
    }
    for ((body, member), meshes) in layout.members.iter().enumerate().zip(meshes_of) {
        // Forces of planets without bearings act on their carrier directly.
        if let Some(planet) = member.planet.filter(|planet| planet.uneven && own[body].is_empty()) {
            let start = layout.members[planet.carrier].start;
            let places = meshes.iter().map(|mesh| &layout.meshes[*mesh]);
            loaded[planet.carrier].extend(places.map(|mesh| mesh.at(usize::from(mesh.members()[0] != body), start)));
        }
    }
    for ((places, member), own) in loaded.iter_mut().zip(&layout.members).zip(own) {
        if member.planet.is_some() && !own.is_empty() {
            places.push(middle(own));
        }
    }
    loaded
}

/// Centre of the supports of a planet, where its centrifugal force acts.
fn middle(supports: &[(usize, SupportLayout)]) -> f64 {
    supports.iter().map(|s| s.1.at).sum::<f64>() / supports.len().max(1) as f64
}

/// Length of a vector; forces are far from overflow, so `hypot` is not needed.
#[inline(always)]
fn length<R: Real>([y, z]: [R; 2]) -> R {
    (y * y + z * z).sqrt()
}

/// The length of the force on a support that a single mesh loads.
#[inline(always)]
fn under<R: Real>([ahead, back]: &[f64; 2], force: R) -> R {
    let backwards = force.is_below(R::ZERO);
    force.abs() * R::select(backwards, R::constant(*back), R::constant(*ahead))
}

fn add(sum: &mut Reaction, case: &Reaction, factor: f64) {
    sum.force[0] += factor * case.force[0];
    sum.force[1] += factor * case.force[1];
    sum.couple[0] += factor * case.couple[0];
    sum.couple[1] += factor * case.couple[1];
}

/// Members from the supported to the supporting, or those in a loop.
fn sort(carrier_of: &[Vec<usize>]) -> Result<Vec<usize>, Vec<usize>> {
    let n = carrier_of.len();
    let mut waiting: Vec<usize> = vec![0; n];
    for carriers in carrier_of {
        for &c in carriers {
            waiting[c] += 1;
        }
    }
    let mut order = Vec::new();
    let mut ready: BTreeSet<usize> = (0..n).filter(|m| waiting[*m] == 0).collect();
    while let Some(next) = ready.pop_first() {
        order.push(next);
        for &c in &carrier_of[next] {
            waiting[c] -= 1;
            if waiting[c] == 0 {
                ready.insert(c);
            }
        }
    }
    if order.len() < n {
        let sorted: BTreeSet<usize> = order.into_iter().collect();
        return Err((0..n).filter(|m| !sorted.contains(m)).collect());
    }
    Ok(order)
}

fn always(member: &MemberLayout) -> Vec<Action> {
    let forces = member.forces.iter().map(|(at, force)| Action {
        at: *at,
        force: *force,
        ..Action::default()
    });
    let moments = member.moments.iter().map(|(at, moment)| Action {
        at: *at,
        moment: *moment,
        ..Action::default()
    });
    forces.chain(moments).collect()
}

/// The static systems of all members.
pub(super) struct System<'a> {
    layout: &'a Layout,
    /// Supports by number of each member that they carry, as it sees them.
    own: Vec<Vec<(usize, SupportLayout)>>,
    /// Those of them that take radial forces.
    radial: Vec<Vec<(usize, SupportLayout)>>,
    /// Meshes of each member.
    meshes: Vec<Vec<usize>>,
    /// Members from the supported to the supporting.
    order: Vec<usize>,
    /// Place of each member in the order.
    places: Vec<usize>,
    statics: Vec<Statics>,
    /// How each member's supports take thrust, in the order.
    takings: Vec<Taking>,
}

impl<'a> System<'a> {
    /// What the members are.
    pub(super) fn layout(&self) -> &Layout {
        self.layout
    }

    /// Supports of a member that take radial forces, by number.
    pub(super) fn radial(&self, member: usize) -> &[(usize, SupportLayout)] {
        &self.radial[member]
    }

    /// What acts on each member under the tangential forces of all meshes, with the permanent loads and what the members that it carries pass
    /// on. \[N\]
    pub(super) fn actions(&self, tangential: &[f64]) -> Vec<Vec<Action>> {
        let permanent = self.layout.members.iter().map(always).enumerate();
        let meshes = self.layout.meshes.iter().zip(tangential);
        let teeth = meshes.flat_map(|(mesh, force)| {
            let gears = (0..2).filter(|gear| !mesh.is_central(*gear));
            gears.map(move |gear| {
                let [along, of_size] = mesh.forces(gear);
                let member = mesh.members()[gear];
                let action = Action {
                    at: mesh.at(gear, self.layout.members[member].start),
                    arm: mesh.arm(gear),
                    force: std::array::from_fn(|axis| force * along[axis] + force.abs() * of_size[axis]),
                    moment: [0.0; 2],
                };
                (member, vec![action])
            })
        });
        let mut all = vec![Vec::new(); self.layout.members.len()];
        self.pass(permanent.chain(teeth), |member, actions, _| {
            all[member].extend_from_slice(actions);
        });
        all
    }

    pub(super) fn new(layout: &'a Layout) -> Result<Self, Vec<LoadFault>> {
        let n = layout.members.len();
        let mut own: Vec<Vec<(usize, SupportLayout)>> = vec![Vec::new(); n];
        let mut radial = own.clone();
        let mut carrier_of: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (i, support) in layout.supports.iter().enumerate() {
            let support = from_the_carried(layout, support);
            carrier_of[support.inner].extend(support.outer);
            own[support.inner].push((i, support));
            if support.takes_radial {
                radial[support.inner].push((i, support));
            }
        }
        let order = sort(&carrier_of).map_err(|members| vec![LoadFault::Cycle { members }])?;
        let mut places = vec![0; n];
        for (place, m) in order.iter().enumerate() {
            places[*m] = place;
        }
        let meshes = layout.meshes_by_member();
        let loaded = loaded_places(layout, &radial, &meshes);
        let mut system = Self {
            layout,
            own,
            radial,
            meshes,
            order,
            places,
            statics: vec![Statics::None; n],
            takings: Vec::with_capacity(n),
        };
        let faults = system.support(&loaded);
        if faults.is_empty() { Ok(system) } else { Err(faults) }
    }

    /// Finds how the supports of each member take its loads.
    fn support(&mut self, loaded: &[Vec<f64>]) -> Vec<LoadFault> {
        let mut faults = Vec::new();
        for &m in &self.order {
            let (own, radial) = (&self.own[m], &self.radial[m]);
            if radial.is_empty() && !own.is_empty() {
                faults.push(LoadFault::Mechanism {
                    member: m,
                    supports: own.iter().map(|(support, _)| *support).collect(),
                });
            }
            match Statics::new(m, &self.layout.members[m], radial, &loaded[m]) {
                Ok(found) => self.statics[m] = found,
                Err(fault) => faults.push(fault),
            }
            match Taking::new(m, own) {
                Ok(taking) => self.takings.push(taking),
                Err(found) => faults.extend(found),
            }
        }
        faults
    }

    /// Reactions of each support to the permanent loads.
    fn permanent(&self) -> Vec<Reaction> {
        let mut permanent = vec![Reaction::default(); self.layout.supports.len()];
        for (support, reaction) in self.reactions(self.layout.members.iter().map(always).enumerate()) {
            permanent[support] = reaction;
        }
        permanent
    }

    /// Reactions of each support to the units of each mesh that loads it.
    fn units(&self) -> Vec<BTreeMap<usize, [Reaction; 2]>> {
        let mut units = vec![BTreeMap::new(); self.layout.supports.len()];
        for (i, mesh) in self.layout.meshes.iter().enumerate() {
            for unit in 0..2 {
                let gears = (0..2).filter(|gear| !mesh.is_central(*gear));
                let actions = gears.map(|gear| {
                    let member = mesh.members()[gear];
                    let action = Action {
                        at: mesh.at(gear, self.layout.members[member].start),
                        arm: mesh.arm(gear),
                        force: mesh.forces(gear)[unit],
                        moment: [0.0; 2],
                    };
                    (member, vec![action])
                });
                for (support, reaction) in self.reactions(actions) {
                    units[support].entry(i).or_insert([Reaction::default(); 2])[unit] = reaction;
                }
            }
        }
        units
    }

    /// Reactions of each support to a newton of friction of each mesh that has friction in its forces.
    fn friction(&self) -> Vec<Vec<(usize, Senses<Reaction>)>> {
        let mut units = vec![Vec::new(); self.layout.supports.len()];
        for (i, mesh) in self.layout.meshes.iter().enumerate() {
            let [Some(first), Some(second)] = [0, 1].map(|gear| mesh.friction(gear)) else {
                continue;
            };
            let mut own = BTreeMap::new();
            for (sense, turn) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let actions = [first, second].into_iter().enumerate().map(|(gear, cases)| {
                    let (force, moment) = cases[sense][turn];
                    let member = mesh.members()[gear];
                    let action = Action {
                        at: mesh.at(gear, self.layout.members[member].start),
                        arm: mesh.arm(gear),
                        force,
                        moment,
                    };
                    (member, vec![action])
                });
                for (support, reaction) in self.reactions(actions) {
                    let cases: &mut Senses<Reaction> = own.entry(support).or_default();
                    cases[sense][turn] = reaction;
                }
            }
            for (support, cases) in own {
                units[support].push((i, cases));
            }
        }
        units
    }

    /// Reactions of each support of other members to the units of each mesh of one copy of each planet body whose planets share unequally: on
    /// the gears on the central axis, and on the carrier.
    fn turning(&self) -> Vec<Vec<BTreeMap<usize, [Reaction; 2]>>> {
        let layout = self.layout;
        let mut turning = vec![Vec::new(); layout.supports.len()];
        for (body, planet) in layout
            .members
            .iter()
            .enumerate()
            .filter_map(|(i, member)| Some((i, member.planet?)))
        {
            if !planet.uneven {
                continue;
            }
            let mut own = vec![BTreeMap::new(); layout.supports.len()];
            for (&i, unit) in self.meshes[body].iter().flat_map(|i| [(i, 0), (i, 1)]) {
                let mesh = &layout.meshes[i];
                let acts = |gear: usize, on: usize| Action {
                    at: mesh.at(gear, layout.members[on].start),
                    arm: mesh.arm(gear),
                    force: mesh.forces(gear)[unit],
                    moment: [0.0; 2],
                };
                let mut open = Vec::new();
                for gear in 0..2 {
                    let member = mesh.members()[gear];
                    if mesh.is_central(gear) {
                        open.push((member, vec![acts(gear, member)]));
                    } else if member == body {
                        open.push((planet.carrier, self.on_carrier(body, planet.carrier, &acts(gear, body))));
                    }
                }
                for (support, reaction) in self.reactions(open) {
                    let of_mesh: &mut [Reaction; 2] = own[support].entry(i).or_default();
                    add(&mut of_mesh[unit], &reaction, 1.0);
                }
            }
            for (turning, own) in turning.iter_mut().zip(own).filter(|(_, own)| !own.is_empty()) {
                turning.push(own);
            }
        }
        turning
    }

    /// What a force on a planet does to its carrier, through its supports; without any at its own place.
    fn on_carrier(&self, body: usize, carrier: usize, action: &Action) -> Vec<Action> {
        let start = |member: usize| self.layout.members[member].start;
        let supports = &self.radial[body];
        if supports.is_empty() {
            return vec![Action {
                at: action.at + start(body) - start(carrier),
                ..*action
            }];
        }
        let found = self.statics[body].reactions(std::slice::from_ref(action));
        let through = supports.iter().zip(found).map(|((_, seat), reaction)| Action {
            at: seat.at,
            arm: [0.0; 2],
            force: [0.0, -reaction.force[0], -reaction.force[1]],
            moment: [-reaction.couple[0], -reaction.couple[1]],
        });
        through.collect()
    }

    /// Reactions of each support to the centrifugal forces of planets, with their carriers.
    fn planets(&self) -> Vec<Vec<(usize, Reaction)>> {
        let mut planets = vec![Vec::new(); self.layout.supports.len()];
        for (m, member) in self.layout.members.iter().enumerate() {
            let Some(planet) = member.planet else { continue };
            let action = Action {
                at: middle(&self.radial[m]),
                force: [0.0, planet.mass * planet.orbit, 0.0],
                ..Action::default()
            };
            for (support, reaction) in self.reactions([(m, vec![action])]) {
                planets[support].push((planet.carrier, reaction));
            }
        }
        planets
    }

    /// Reactions of supports to actions on some members: of these members and of those that carry them. All others are zero.
    fn reactions(&self, actions: impl IntoIterator<Item = (usize, Vec<Action>)>) -> Vec<(usize, Reaction)> {
        let mut reactions = Vec::new();
        self.pass(actions, |member, _, found| {
            let supports = self.radial[member].iter().map(|(support, _)| *support);
            reactions.extend(supports.zip(found.iter().copied()));
        });
        reactions
    }

    /// Goes through the members on which something acts, from the supported to the supporting, with all that acts on them and the reactions
    /// of their supports.
    fn pass(
        &self,
        actions: impl IntoIterator<Item = (usize, Vec<Action>)>,
        mut each: impl FnMut(usize, &[Action], &[Reaction]),
    ) {
        let mut open: BTreeMap<usize, Vec<Action>> = BTreeMap::new();
        for (member, actions) in actions {
            open.entry(self.places[member]).or_default().extend(actions);
        }
        while let Some((place, actions)) = open.pop_first() {
            let m = self.order[place];
            let found = self.statics[m].reactions(&actions);
            each(m, &actions, &found);
            for ((_, seat), reaction) in self.radial[m].iter().zip(&found) {
                // Planets of one set balance each other on their carrier.
                if let (Some(carrier), None) = (seat.outer, self.layout.members[m].planet) {
                    open.entry(self.places[carrier]).or_default().push(Action {
                        at: seat.at,
                        arm: [0.0; 2],
                        force: [0.0, -reaction.force[0], -reaction.force[1]],
                        moment: [-reaction.couple[0], -reaction.couple[1]],
                    });
                }
            }
        }
    }

    /// Axial forces on each member, in the order.
    fn axial(mut self) -> Vec<(Axially, bool)> {
        let takings = std::mem::take(&mut self.takings);
        let members = self.order.iter().zip(takings);
        members.map(|(m, taking)| self.axially(*m, taking)).collect()
    }

    /// Axial forces on one member; true if no support takes thrust, so that it passes through to the supporting member.
    fn axially(&self, m: usize, taking: Taking) -> (Axially, bool) {
        let (member, own) = (&self.layout.members[m], &self.own[m]);
        let (mut meshes, mut crossed) = (Vec::new(), Vec::new());
        for &i in &self.meshes[m] {
            let mesh = &self.layout.meshes[i];
            for gear in (0..2).filter(|gear| mesh.members()[*gear] == m && mesh.has_thrust()) {
                let [along, of_size] = mesh.forces(gear).map(|force| force[0]);
                match mesh.friction(gear) {
                    None => {
                        let copies = if mesh.is_central(gear) { mesh.count() } else { 1.0 };
                        meshes.push((i, along * copies));
                    }
                    Some(friction) => crossed.push(CrossedThrust {
                        mesh: i,
                        normal: [along + of_size, along - of_size],
                        friction: friction.map(|turns| turns.map(|(force, _)| force[0])),
                    }),
                }
            }
        }
        let carrier = own.iter().find_map(|(_, s)| s.outer);
        let copies = member.planet.map_or(1.0, |p| p.count);
        let passes = carrier.is_some()
            && own
                .iter()
                .all(|(_, s)| s.axial == crate::attach::Axial::None && s.spring == 0.0);
        let axially = Axially {
            always: member.forces.iter().map(|f| f.1[0]).sum(),
            size: member.forces.iter().map(|f| f.1[0].abs()).sum(),
            meshes,
            crossed,
            taking,
            carrier: carrier.map(|carrier| (self.places[carrier], copies)),
        };
        (axially, passes)
    }
}

/// Passes thrust on to the supporting members, and removes the members through which it passes.
fn passed_on(mut order: Vec<(Axially, bool)>) -> Vec<Axially> {
    for place in 0..order.len() {
        let (member, passes) = &mut order[place];
        let (true, Some((carrier, copies))) = (*passes, member.carrier) else {
            continue;
        };
        let (always, size, meshes) = (member.always, member.size, std::mem::take(&mut member.meshes));
        let crossed = std::mem::take(&mut member.crossed);
        let carrier = &mut order[carrier].0;
        carrier.always += always * copies;
        carrier.size += size * copies;
        carrier
            .meshes
            .extend(meshes.into_iter().map(|(mesh, factor)| (mesh, factor * copies)));
        carrier.crossed.extend(crossed.into_iter().map(|own| own.times(copies)));
    }
    let passing: Vec<Option<(usize, f64)>> = order
        .iter()
        .map(|(member, passes)| member.carrier.filter(|_| *passes))
        .collect();
    // Places without the members through which thrust passes.
    let mut left = vec![None; order.len()];
    for (number, place) in (0..order.len()).filter(|place| passing[*place].is_none()).enumerate() {
        left[place] = Some(number);
    }
    let members = order.into_iter().map(|(mut member, _)| {
        // Thrust passed to a member that also passes it through is passed on to its supporting member.
        while let Some((carrier, copies)) = member.carrier {
            let Some((behind, further)) = passing[carrier] else {
                break;
            };
            member.carrier = Some((behind, copies * further));
        }
        member.carrier = member
            .carrier
            .and_then(|(carrier, copies)| Some((left[carrier]?, copies)));
        member
    });
    let members = members.zip(&passing).filter(|(_, passes)| passes.is_none());
    members.map(|(member, _)| member).collect()
}
