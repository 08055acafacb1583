//! Rigid bodies: shafts, side plates, pins and gears that rigid couplings join are one member of a gearbox.

use std::collections::{BTreeMap, BTreeSet};

use super::model::{Component, Id};
use super::source::Source;
use super::units::Quantity;

/// Stiffness from which a coupling is rigid. \[N/m\] and \[N mm/rad\]
const RIGID: f64 = 1e12;

/// A coupling between two members, or between a member and the housing, that a gear state engages.
#[derive(Debug)]
pub struct Joint {
    /// The REXS couplings; several between the same members act as one.
    pub ids: Vec<Id>,
    pub first: Id,
    /// None for the housing.
    pub second: Option<Id>,
    /// For each gear whether it is engaged; always, if it is not switchable.
    pub engaged: Option<Vec<bool>>,
}

/// All members. The id of a member is the smallest id of its shafts; that of a loose gear, if it has no shaft.
#[derive(Debug)]
pub struct Members {
    of: BTreeMap<Id, Id>,
    pub joints: Vec<Joint>,
    /// Carrier of each planetary stage.
    pub carriers: BTreeMap<Id, Id>,
    /// Planets of each planetary stage.
    pub planets: BTreeMap<Id, BTreeSet<Id>>,
}

/// Sets of ids that are united pair by pair.
#[derive(Debug, Default)]
struct Union(BTreeMap<Id, Id>);

impl Union {
    fn root(&mut self, id: Id) -> Id {
        let mut root = id;
        while let Some(&above) = self.0.get(&root).filter(|above| **above != root) {
            root = above;
        }
        // Later searches are short.
        let mut next = id;
        while let Some(above) = self
            .0
            .insert(next, root)
            .filter(|above| *above != root && *above != next)
        {
            next = above;
        }
        root
    }

    /// Unites two sets under the smaller id.
    fn unite(&mut self, a: Id, b: Id) {
        let (a, b) = (self.root(a), self.root(b));
        self.0.insert(a.max(b), a.min(b));
    }
}

/// A coupling that does not join its sides for ever: id, sides, whether it is engaged in each gear.
type Open = (Id, Id, Option<Id>, Option<Vec<bool>>);

impl Members {
    pub fn new(source: &Source<'_>) -> Self {
        let mut union = Union::default();
        let loose = loose_gears(source);
        for relation in source.relations("assembly") {
            if let (Some(shaft), Some(gear)) = (relation.role("assembly"), relation.role("part"))
                && kind_of(source, shaft) == "shaft"
                && is_gear(source, gear)
                && !loose.contains(&gear)
            {
                union.unite(shaft, gear);
            }
        }
        let open = couple(source, &mut union);
        let mut carriers_of = BTreeMap::new();
        for stage in source.components("planetary_stage") {
            let shafts: Vec<Id> = carrier_shafts(source, stage.id)
                .filter(|id| is_body(source, *id))
                .collect();
            for pair in shafts.windows(2) {
                union.unite(pair[0], pair[1]);
            }
            carriers_of.extend(shafts.first().map(|first| (stage.id, *first)));
        }
        fix_pins(source, &mut union, &carriers_of);
        let of = names(source, &mut union, &loose);
        let mut planets: BTreeMap<Id, BTreeSet<Id>> = BTreeMap::new();
        for relation in source.relations("planet_shaft") {
            if let (Some(stage), Some(shaft)) = (relation.role("planetary_stage"), relation.role("shaft")) {
                planets.entry(stage).or_default().extend(of.get(&shaft));
            }
        }
        let carriers = carriers_of
            .iter()
            .filter_map(|(stage, id)| Some((*stage, *of.get(id)?)));
        let mut members = Self {
            carriers: carriers.collect(),
            planets,
            of,
            joints: Vec::new(),
        };
        for (id, first, second, engaged) in open {
            members.join(id, first, second, engaged);
        }
        members
    }

    /// The member of a shaft, a plate or a gear.
    pub fn of(&self, id: Id) -> Option<Id> {
        self.of.get(&id).copied()
    }

    /// All members, by id.
    pub fn all(&self) -> BTreeSet<Id> {
        self.of.values().copied().collect()
    }

    /// The shafts, plates and gears of a member.
    pub fn parts(&self, member: Id) -> impl Iterator<Item = Id> {
        self.of
            .iter()
            .filter(move |(_, its_member)| **its_member == member)
            .map(|(id, _)| *id)
    }

    fn join(&mut self, id: Id, first: Id, second: Option<Id>, engaged: Option<Vec<bool>>) {
        let (Some(first), second) = (self.of(first), second.map(|id| self.of(id))) else {
            return;
        };
        let second = match second {
            Some(None) => return,
            Some(Some(member)) if member == first => return,
            Some(member) => member,
            None => None,
        };
        let same = self
            .joints
            .iter_mut()
            .find(|joint| (joint.first, joint.second, &joint.engaged) == (first, second, &engaged));
        match same {
            Some(joint) => joint.ids.push(id),
            None => self.joints.push(Joint {
                ids: vec![id],
                first,
                second,
                engaged,
            }),
        }
    }
}

fn kind_of<'a>(source: &Source<'a>, id: Id) -> &'a str {
    source.component(id).map_or("", |component| component.kind.as_str())
}

fn is_gear(source: &Source<'_>, id: Id) -> bool {
    super::map::is_gear(kind_of(source, id))
}

/// True for what can be a part of a member.
fn is_body(source: &Source<'_>, id: Id) -> bool {
    matches!(kind_of(source, id), "shaft" | "side_plate") || is_gear(source, id)
}

/// A gear turns with the shaft that it is part of, unless a bearing or a clutch is between them.
fn loose_gears(source: &Source<'_>) -> BTreeSet<Id> {
    let mut loose = BTreeSet::new();
    for side in source.relations("side") {
        let between = side.role("assembly").map_or("", |id| kind_of(source, id));
        if between == "switchable_coupling" || between.contains("bearing") {
            let parts = [side.role("inner_part"), side.role("outer_part")];
            loose.extend(parts.into_iter().flatten().filter(|id| is_gear(source, *id)));
        }
    }
    loose
}

/// Unites what rigid couplings, fits, keys and splines join; the other couplings are returned.
fn couple(source: &Source<'_>, union: &mut Union) -> Vec<Open> {
    let mut open = Vec::new();
    for relation in source.relations("side") {
        let coupling = relation.role("assembly").and_then(|id| source.component(id));
        let Some(coupling) = coupling.filter(|coupling| !coupling.kind.contains("bearing")) else {
            continue;
        };
        let sides = [relation.role("inner_part"), relation.role("outer_part")];
        let bodies: Vec<Id> = sides.into_iter().flatten().filter(|id| is_body(source, *id)).collect();
        let switched =
            (coupling.kind == "switchable_coupling").then(|| source.flags(coupling, "is_engaged").unwrap_or_default());
        match bodies.as_slice() {
            [a, b] if switched.is_none() && is_rigid(source, coupling) => union.unite(*a, *b),
            [a, b] => open.push((coupling.id, *a, Some(*b), switched)),
            [a] => open.push((coupling.id, *a, None, switched)),
            _ => source.note(format!("{} joins no shafts and was ignored", coupling.label())),
        }
    }
    open
}

/// Pins that no coupling joins to anything are fixed in the carrier.
fn fix_pins(source: &Source<'_>, union: &mut Union, carriers: &BTreeMap<Id, Id>) {
    let coupled: BTreeSet<Id> = source
        .relations("side")
        .filter(|side| {
            side.role("assembly")
                .is_some_and(|id| !kind_of(source, id).contains("bearing"))
        })
        .flat_map(|side| [side.role("inner_part"), side.role("outer_part")])
        .flatten()
        .collect();
    for relation in source.relations("planet_pin") {
        let (Some(stage), Some(pin)) = (relation.role("planetary_stage"), relation.role("shaft")) else {
            continue;
        };
        if let (false, Some(carrier)) = (coupled.contains(&pin), carriers.get(&stage)) {
            union.unite(pin, *carrier);
        }
    }
}

/// The member of each body: its first shaft, or a loose gear itself.
fn names(source: &Source<'_>, union: &mut Union, loose: &BTreeSet<Id>) -> BTreeMap<Id, Id> {
    let all = source.model.components.keys().copied();
    let bodies: Vec<Id> = all.filter(|id| is_body(source, *id)).collect();
    let mut names: BTreeMap<Id, Id> = BTreeMap::new();
    let shafts = bodies.iter().filter(|id| kind_of(source, **id) == "shaft");
    let gears = bodies
        .iter()
        .filter(|id| loose.contains(id) || kind_of(source, **id) == "ring_gear");
    for id in shafts.chain(gears) {
        names.entry(union.root(*id)).or_insert(*id);
    }
    let named = bodies
        .iter()
        .filter_map(|id| Some((*id, *names.get(&union.root(*id))?)));
    named.collect()
}

/// Shafts of the carrier of a stage: stated as such, or parts of its planet carrier that are no pins.
fn carrier_shafts(source: &Source<'_>, stage: Id) -> impl Iterator<Item = Id> {
    let stated = source
        .relations("planet_carrier_shaft")
        .filter(move |relation| relation.role("planetary_stage") == Some(stage))
        .filter_map(|relation| relation.role("shaft"));
    let is_carrier = |id: &Id| source.component(*id).is_some_and(|part| part.kind == "planet_carrier");
    let carriers: BTreeSet<Id> = source
        .relations("assembly")
        .filter(move |relation| relation.role("assembly") == Some(stage))
        .filter_map(|relation| relation.role("part"))
        .filter(is_carrier)
        .collect();
    let pins: BTreeSet<Id> = source
        .relations("planet_pin")
        .filter_map(|pin| pin.role("shaft"))
        .collect();
    let parts = source
        .relations("assembly")
        .filter(move |relation| relation.role("assembly").is_some_and(|id| carriers.contains(&id)))
        .filter_map(|relation| relation.role("part"))
        .filter(move |id| !pins.contains(id));
    let mut all: Vec<Id> = stated.chain(parts).collect();
    all.sort_unstable();
    all.dedup();
    all.into_iter()
}

/// True if no stiffness of a coupling is stated below that of rigid ones.
fn is_rigid(source: &Source<'_>, coupling: &Component) -> bool {
    // Factors of the units of gearbox files.
    let stiffness = [
        ("radial_stiffness", Quantity::Stiffness),
        ("bending_stiffness", Quantity::TiltingStiffness),
        ("rotational_stiffness", Quantity::TiltingStiffness),
    ];
    let soft: Vec<&str> = stiffness
        .into_iter()
        .filter(|(id, quantity)| {
            source
                .number(coupling, id, *quantity)
                .is_some_and(|value| value < RIGID * 1e-3)
        })
        .map(|(id, _)| id)
        .collect();
    if !soft.is_empty() {
        source.note(format!(
            "{} is not rigid ({}): both sides have one speed, and it transmits no transverse force",
            coupling.label(),
            soft.join(", ")
        ));
    }
    soft.is_empty()
}
