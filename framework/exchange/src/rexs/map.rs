//! What all parts of the conversion use: positions, members, planets, names.

use std::collections::{BTreeMap, BTreeSet};

use super::members::Members;
use super::model::{Component, Id};
use super::pose::{Frame, Pose, Poses, Vector, cross, dot, sum};
use super::source::Source;

/// An external force on a member in each load case.
#[derive(Debug)]
pub struct Force {
    pub component: Id,
    pub member: Id,
    pub comment: String,
    pub at: f64,
    /// Force in N and bending moment in Nm, in the coordinates of gearbox files.
    pub by_case: Vec<(Vector, [f64; 2])>,
}

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
    /// Loose gears without a shaft of their own: gear and the member on which it turns.
    pub loose: BTreeMap<Id, Id>,
    /// Number of bearings of each member in the housing.
    pub housing_bearings: BTreeMap<Id, usize>,
    /// Members that are part of the gearbox.
    pub connected: BTreeSet<Id>,
    /// External forces.
    pub forces: Vec<Force>,
    /// Name of the oil of the housing.
    pub sump: Option<String>,
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
        Self {
            source,
            poses,
            frame,
            members,
            shaft_of,
            parts,
            references,
            planets,
            copies: BTreeSet::new(),
            loose: BTreeMap::new(),
            housing_bearings: BTreeMap::new(),
            connected: BTreeSet::new(),
            forces: Vec::new(),
            sump: None,
            gravity: source
                .components("gear_unit")
                .next()
                .is_some_and(|unit| source.flag(unit, "account_for_gravity") == Some(true)),
        }
    }

    /// Finds loose gears, and how many bearings of each member are in the housing.
    pub fn find_supports(&mut self) {
        for side in self.source.relations("side") {
            let kind = side.role("assembly").and_then(|id| self.source.component(id));
            if !kind.is_some_and(|bearing| bearing.kind.contains("bearing")) {
                continue;
            }
            let [inner, outer] = ["inner_part", "outer_part"].map(|role| self.members.of(side.role(role)?));
            match (inner, outer) {
                (Some(member), None) | (None, Some(member)) => *self.housing_bearings.entry(member).or_default() += 1,
                (Some(inner), Some(outer)) if self.is_single_gear(outer) => {
                    self.loose.entry(outer).or_insert(inner);
                }
                _ => {}
            }
        }
    }

    fn is_single_gear(&self, member: Id) -> bool {
        let kind = self.source.component(member).map(|component| component.kind.as_str());
        kind.is_some_and(|kind| is_gear(kind) && kind != "ring_gear")
            && !self.planets.contains(&member)
            && self.members.parts(member).count() == 1
    }

    /// The axis of a member that is not parallel to x: a point where positions are zero, and the direction. Planets have that of their carrier.
    pub fn line(&self, member: Id) -> Option<&Pose> {
        let stage = self
            .members
            .planets
            .iter()
            .find(|(_, planets)| planets.contains(&member));
        let carrier = stage.and_then(|(stage, _)| self.members.carriers.get(stage));
        let pose = self.poses.get(*carrier.unwrap_or(&member))?;
        (!self.frame.is_parallel(pose.u)).then_some(pose)
    }

    /// Position of a point along the axis of a member.
    pub fn along(&self, member: Id, point: Vector) -> f64 {
        match self.line(member) {
            None => self.frame.coordinates(point)[0],
            Some(line) => dot(sum(point, line.origin, -1.0), line.u),
        }
    }

    /// The sense of an axis along that of a member: 1 or -1.
    pub fn sense(&self, member: Id, u: Vector) -> f64 {
        match self.line(member) {
            None => self.frame.sense(u),
            Some(line) => {
                if dot(u, line.u) < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
        }
    }

    /// Distance of a point from the axis of a member. \[mm\]
    pub fn beside(&self, member: Id, point: Vector) -> Option<f64> {
        let axis = self.poses.get(member)?;
        let between = sum(point, axis.origin, -1.0);
        Some(match self.line(member) {
            None => {
                let [_, y, z] = self.frame.coordinates(between);
                y.hypot(z)
            }
            Some(line) => {
                let across = cross(between, line.u);
                dot(across, across).sqrt()
            }
        })
    }

    /// A bending moment in the two directions across the axis of a member in which gearbox files state it.
    pub fn bending(&self, member: Id, moment: Vector) -> [f64; 2] {
        let moment = self.frame.coordinates(moment);
        let Some(line) = self.line(member) else {
            return [moment[1] + 0.0, moment[2] + 0.0];
        };
        let [x, y, z] = self.frame.coordinates(line.u);
        let horizontal = x.hypot(y);
        let up = if horizontal < 1e-9 {
            [-z, 0.0, 0.0]
        } else {
            [-z * x / horizontal, -z * y / horizontal, horizontal]
        };
        [dot(moment, cross(up, [x, y, z])) + 0.0, dot(moment, up) + 0.0]
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

    /// The component of a type that refers to another one, such as the points of a set of data.
    pub fn origin(&self, referenced: Id, kind: &str) -> Option<&'a Component> {
        let origins = self.references.iter().filter(|(_, all)| all.contains(&referenced));
        let mut origins = origins.filter_map(|(origin, _)| self.source.component(*origin));
        origins.find(|origin| origin.kind == kind)
    }

    /// The member of a gear, or of the shaft that carries a load.
    pub fn member_with(&self, part: Id) -> Option<Id> {
        self.members
            .of(part)
            .or_else(|| self.members.of(*self.shaft_of.get(&part)?))
    }

    /// Planets that are copies, and what belongs to them: gears, flanks, stages, bearings.
    pub fn copied_parts(&self) -> BTreeSet<Id> {
        let is_copy = |id: Id| self.member_with(id).is_some_and(|member| self.copies.contains(&member));
        let mut copied: BTreeSet<Id> = self
            .source
            .model
            .components
            .keys()
            .copied()
            .filter(|id| is_copy(*id))
            .collect();
        for (kind, of, parts) in [
            ("side", ["inner_part", "outer_part"], ["assembly", ""]),
            ("stage", ["gear_1", "gear_2"], ["stage", ""]),
            ("flank", ["gear", ""], ["left", "right"]),
        ] {
            for relation in self.source.relations(kind) {
                let belongs = of.iter().filter_map(|role| relation.role(role)).any(is_copy);
                copied.extend(parts.iter().filter(|_| belongs).filter_map(|role| relation.role(role)));
            }
        }
        for relation in self.source.relations("stage_gear_data") {
            if relation.role("stage").is_some_and(|stage| copied.contains(&stage)) {
                copied.extend(relation.role("stage_gear_data"));
            }
        }
        copied
    }

    /// Name of a member in gearbox files.
    pub fn member_name(&self, member: Id) -> String {
        let kind = if self.loose.contains_key(&member) {
            "gear"
        } else if self.planets.contains(&member) {
            "planet"
        } else if self.members.carriers.values().any(|carrier| *carrier == member) {
            "carrier"
        } else if self.source.component(member).is_some_and(|body| body.kind == "shaft") {
            "shaft"
        } else {
            "body"
        };
        id(kind, member)
    }
}

/// True for the types of gears.
pub fn is_gear(kind: &str) -> bool {
    matches!(
        kind,
        "cylindrical_gear" | "ring_gear" | "bevel_gear" | "worm_gear" | "worm_wheel"
    )
}

/// A component in comments: id and name.
pub fn named(component: &Component) -> String {
    let name = one_line(&component.name, 60);
    if name.is_empty() {
        format!("{} {}", component.kind, component.id)
    } else {
        format!("{} \"{name}\"", component.id)
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
