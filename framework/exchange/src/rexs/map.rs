//! What all parts of the conversion use: positions, members, planets, names.

use std::collections::{BTreeMap, BTreeSet};

use super::loads::Force;
use super::members::Members;
use super::model::{Component, Id};
use super::pose::{Frame, Poses};
use super::source::Source;

/// A model with its geometry and its members.
#[derive(Debug)]
pub struct Map<'a> {
    pub source: &'a Source<'a>,
    pub poses: Poses,
    pub frame: Frame,
    pub members: Members,
    /// Shaft of each gear, load and section.
    pub shaft_of: BTreeMap<Id, Id>,
    /// Parts of each shaft.
    parts: BTreeMap<Id, Vec<Id>>,
    /// Lubricant or material of a component.
    references: BTreeMap<Id, Vec<Id>>,
    /// Members that are planets.
    pub planets: BTreeSet<Id>,
    /// Planets that are copies of another one.
    pub copies: BTreeSet<Id>,
    /// Members that are part of the gearbox.
    pub connected: BTreeSet<Id>,
    /// External forces.
    pub forces: Vec<Force>,
    /// Whether weights count.
    pub gravity: bool,
}

impl<'a> Map<'a> {
    pub fn new(source: &'a Source<'a>) -> Self {
        let poses = Poses::new(source);
        let first = source.components("shaft").find_map(|shaft| poses.get(shaft.id));
        let frame = Frame::new(source, first);
        let members = Members::new(source);
        let mut shaft_of = BTreeMap::new();
        let mut parts: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
        for relation in source.relations("assembly") {
            let (Some(assembly), Some(part)) = (relation.role("assembly"), relation.role("part")) else {
                continue;
            };
            if source
                .component(assembly)
                .is_some_and(|component| component.kind == "shaft")
            {
                shaft_of.insert(part, assembly);
                parts.entry(assembly).or_default().push(part);
            }
        }
        for of_shaft in parts.values_mut() {
            of_shaft.sort_unstable();
            of_shaft.dedup();
        }
        let mut references: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
        for relation in source.relations("reference") {
            if let (Some(origin), Some(to)) = (relation.role("origin"), relation.role("referenced")) {
                references.entry(origin).or_default().push(to);
            }
        }
        let planets = members.planets.values().flatten().copied().collect();
        let mut map = Self {
            source,
            poses,
            frame,
            members,
            shaft_of,
            parts,
            references,
            planets,
            copies: BTreeSet::new(),
            connected: BTreeSet::new(),
            forces: Vec::new(),
            gravity: source
                .components("gear_unit")
                .next()
                .is_some_and(|unit| source.flag(unit, "account_for_gravity") == Some(true)),
        };
        map.connected = super::shafts::connected(&map);
        map
    }

    /// The parts of a shaft.
    pub fn parts_of(&self, shaft: Id) -> Vec<&'a Component> {
        let parts = self.parts.get(&shaft).into_iter().flatten();
        parts.filter_map(|id| self.source.component(*id)).collect()
    }

    /// The component of a type that another one refers to, such as its lubricant.
    pub fn referenced(&self, origin: Id, kind: &str) -> Option<&'a Component> {
        let all = self.references.get(&origin)?.iter();
        all.filter_map(|id| self.source.component(*id))
            .find(|to| to.kind == kind)
    }

    /// The member of the shaft that carries a part.
    pub fn member_with(&self, part: Id) -> Option<Id> {
        self.members.of(*self.shaft_of.get(&part)?)
    }

    /// Name of a member in gearbox files.
    pub fn member_name(&self, member: Id) -> String {
        let kind = if self.planets.contains(&member) {
            "planet"
        } else if self.members.carriers.values().any(|carrier| *carrier == member) {
            "carrier"
        } else {
            "shaft"
        };
        id(kind, member)
    }

    /// A component in comments: id and name.
    pub fn named(&self, component: &Component) -> String {
        let name = one_line(&component.name, 60);
        if name.is_empty() {
            format!("{} {}", component.kind, component.id)
        } else {
            format!("{} \"{name}\"", component.id)
        }
    }
}

/// An id of gearbox files: letters, digits and underscores.
pub fn id(kind: &str, id: Id) -> String {
    if id < 0 {
        format!("{kind}_minus_{}", id.unsigned_abs())
    } else {
        format!("{kind}_{id}")
    }
}

/// A text of a file in a comment: one line of limited length, without control characters and marks of direction.
pub fn one_line(text: &str, longest: usize) -> String {
    let strange = |c: char| {
        c.is_control()
            || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let plain: String = text.chars().map(|c| if strange(c) { ' ' } else { c }).collect();
    let plain = plain.trim();
    if plain.chars().count() <= longest {
        plain.to_owned()
    } else {
        let cut: String = plain.chars().take(longest.saturating_sub(3)).collect();
        format!("{cut}...")
    }
}
