//! Rigid bodies: shafts, side plates and pins that rigid couplings join are one member of a gearbox.

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

/// All members. The name of a member is the smallest id of its shafts.
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

impl Members {
    pub fn new(source: &Source<'_>) -> Self {
        let mut union = Union::default();
        let mut open: Vec<(Id, Id, Option<Id>, Option<Vec<bool>>)> = Vec::new();
        let kind = |id: Id| source.component(id).map_or("", |component| component.kind.as_str());
        let is_body = |id: Id| matches!(kind(id), "shaft" | "side_plate");
        for relation in source.relations("side") {
            let Some(coupling) = relation.role("assembly").and_then(|id| source.component(id)) else {
                continue;
            };
            if !matches!(coupling.kind.as_str(), "coupling" | "switchable_coupling") {
                continue;
            }
            let sides = [relation.role("inner_part"), relation.role("outer_part")];
            let bodies: Vec<Id> = sides.into_iter().flatten().filter(|id| is_body(*id)).collect();
            let switched = (coupling.kind == "switchable_coupling")
                .then(|| source.flags(coupling, "is_engaged").unwrap_or_default());
            match bodies.as_slice() {
                [a, b] if switched.is_none() => {
                    if is_rigid(source, coupling) {
                        union.unite(*a, *b);
                    } else {
                        open.push((coupling.id, *a, Some(*b), None));
                    }
                }
                [a, b] => open.push((coupling.id, *a, Some(*b), switched)),
                [a] => open.push((coupling.id, *a, None, switched)),
                _ => source.note(format!("{} joins no shafts and was ignored", coupling.label())),
            }
        }
        let mut carriers_of = BTreeMap::new();
        for stage in source.components("planetary_stage") {
            let shafts: Vec<Id> = carrier_shafts(source, stage.id).filter(|id| is_body(*id)).collect();
            for pair in shafts.windows(2) {
                union.unite(pair[0], pair[1]);
            }
            carriers_of.extend(shafts.first().map(|first| (stage.id, *first)));
        }
        let mut planets_of: BTreeMap<Id, BTreeSet<Id>> = BTreeMap::new();
        for relation in source.relations("planet_shaft") {
            if let (Some(stage), Some(shaft)) = (relation.role("planetary_stage"), relation.role("shaft")) {
                planets_of.entry(stage).or_default().insert(shaft);
            }
        }
        // Pins that no coupling joins to anything are fixed in the carrier.
        let coupled: BTreeSet<Id> = source
            .relations("side")
            .filter(|side| side.role("assembly").is_some_and(|id| kind(id) == "coupling"))
            .flat_map(|side| [side.role("inner_part"), side.role("outer_part")])
            .flatten()
            .collect();
        for relation in source.relations("planet_pin") {
            let (Some(stage), Some(pin)) = (relation.role("planetary_stage"), relation.role("shaft")) else {
                continue;
            };
            if let (false, Some(carrier)) = (coupled.contains(&pin), carriers_of.get(&stage)) {
                union.unite(pin, *carrier);
            }
        }
        let bodies: Vec<Id> = source
            .model
            .components
            .keys()
            .copied()
            .filter(|id| is_body(*id))
            .collect();
        // A member is named after a shaft.
        let mut names: BTreeMap<Id, Id> = BTreeMap::new();
        for id in bodies.iter().filter(|id| kind(**id) == "shaft") {
            names.entry(union.root(*id)).or_insert(*id);
        }
        let mut of = BTreeMap::new();
        for id in &bodies {
            let root = union.root(*id);
            if let Some(name) = names.get(&root) {
                of.insert(*id, *name);
            }
        }
        let mut members = Self {
            joints: Vec::new(),
            carriers: BTreeMap::new(),
            planets: BTreeMap::new(),
            of,
        };
        members.carriers = carriers_of
            .iter()
            .filter_map(|(stage, id)| Some((*stage, members.of(*id)?)))
            .collect();
        members.planets = planets_of
            .iter()
            .map(|(stage, ids)| (*stage, ids.iter().filter_map(|id| members.of(*id)).collect()))
            .collect();
        for (id, first, second, engaged) in open {
            members.join(id, first, second, engaged);
        }
        members
    }

    /// The member of a shaft or plate.
    pub fn of(&self, id: Id) -> Option<Id> {
        self.of.get(&id).copied()
    }

    /// All members, by id.
    pub fn all(&self) -> BTreeSet<Id> {
        self.of.values().copied().collect()
    }

    /// The shafts and plates of a member.
    pub fn parts(&self, member: Id) -> impl Iterator<Item = Id> {
        self.of
            .iter()
            .filter(move |(_, own)| **own == member)
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
