//! Shafts with their sections, external forces and masses.

use std::collections::{BTreeMap, BTreeSet};

use super::draft::{Axis, Load, Section, Shaft};
use super::map::{Map, is_gear, named};
use super::model::{Component, Id};
use super::pose::{PARALLEL, Pose, dot, sum};
use super::units::Quantity;
use crate::codes;

/// The shafts that are written, and the planets that are copies.
pub fn shafts(map: &Map<'_>) -> Vec<Shaft> {
    let source = map.source;
    let mut shafts = Vec::new();
    for member in map.members.all() {
        if map.copies.contains(&member) || !map.connected.contains(&member) || map.loose.contains_key(&member) {
            continue;
        }
        let parts: Vec<&Component> = map
            .members
            .parts(member)
            .filter_map(|id| source.component(id))
            .filter(|part| part.id == member || !is_gear(&part.kind))
            .collect();
        let names: Vec<String> = parts.iter().map(|part| named(part)).collect();
        let mut comment = names.iter().take(6).cloned().collect::<Vec<_>>().join(" + ");
        if names.len() > 6 {
            comment.push_str(&format!(" + {} more", names.len() - 6));
        }
        let pose = map.poses.get(member);
        let is_planet = map.planets.contains(&member);
        let coordinates = pose.map(|pose| map.frame.coordinates(pose.origin));
        shafts.push(Shaft {
            id: map.member_name(member),
            comment,
            axis: coordinates.filter(|_| !is_planet).map(|at| match map.line(member) {
                None => Axis::AlongX([at[1], at[2]]),
                Some(line) => Axis::Directed(at, map.frame.coordinates(line.u)),
            }),
            sections: merged(
                parts
                    .iter()
                    .filter(|part| is_coaxial(map, member, part.id))
                    .flat_map(|part| sections(map, member, part))
                    .collect(),
            ),
            mass: if map.gravity { mass(map, member, &parts) } else { None },
            loads: loads(map, member),
            unsupported: false,
        });
    }
    shafts
}

/// Pins of planets are parts of a carrier that are beside its axis.
fn is_coaxial(map: &Map<'_>, member: Id, part: Id) -> bool {
    let beside = map.poses.get(part).and_then(|part| map.beside(member, part.origin));
    beside.is_some_and(|beside| beside < 1e-2)
}

/// All shafts have positions, and planets are parallel to their carrier.
pub fn check_axes(map: &Map<'_>) {
    for shaft in map.source.components("shaft") {
        let Some(pose) = map.poses.get(shaft.id) else {
            map.source.error(
                shaft,
                codes::REXS_VALUE,
                "it has no position (support_vector)",
                "state support_vector, u_axis_vector, w_axis_vector and reference_component_for_position",
            );
            continue;
        };
        let member = map.members.of(shaft.id);
        let Some(member) = member.filter(|member| map.planets.contains(member)) else {
            continue;
        };
        let axis = map.line(member).map_or(map.frame.x, |line| line.u);
        if dot(axis, pose.u).abs() < PARALLEL {
            map.source.error(
                shaft,
                codes::REXS_PART,
                "it is a planet whose axis crosses that of its carrier: bevel gears that orbit are not imported",
                "import the other stages, and add a differential under `differentials`",
            );
        }
    }
}

/// Position of a coordinate of a shaft along the axis of its member.
pub fn along(map: &Map<'_>, member: Id, pose: &Pose, coordinate: f64) -> f64 {
    map.along(member, sum(pose.origin, pose.u, coordinate))
}

/// The sections of a shaft or plate.
pub fn sections(map: &Map<'_>, member: Id, part: &Component) -> Vec<Section> {
    let source = map.source;
    let Some(pose) = map.poses.get(part.id) else {
        return Vec::new();
    };
    let section = |of: &Component, start: f64| {
        let length = source.positive(of, "length", Quantity::Length)?;
        let diameter = |which: &str| {
            let [begin, end] =
                ["begin", "end"].map(|at| source.number(of, &format!("{which}_diameter_{at}"), Quantity::Length));
            let single = || source.number(of, &format!("{which}_diameter"), Quantity::Length);
            let (begin, end) = (begin.or(end).or_else(single)?, end.or(begin).or_else(single)?);
            if (begin - end).abs() > 1e-6 {
                source.assume("conical shaft sections have their mean diameter");
            }
            Some(0.5 * (begin + end))
        };
        let outer = diameter("outer").filter(|outer| *outer > 0.0)?;
        let inner = diameter("inner").unwrap_or(0.0).max(0.0);
        if inner >= outer {
            source.note(format!(
                "{}: the bore is not smaller than the outside; the section was ignored",
                of.label()
            ));
            return None;
        }
        let ends = [start, start + length].map(|at| along(map, member, pose, at));
        Some(Section {
            from: ends[0].min(ends[1]),
            to: ends[0].max(ends[1]),
            outer,
            inner,
        })
    };
    if part.kind == "side_plate" {
        return section(part, 0.0).into_iter().collect();
    }
    let parts = map.parts_of(part.id);
    let sections = parts.iter().filter(|part| part.kind == "shaft_section");
    sections
        .filter_map(|part| {
            let start = source
                .number(part, "u_coordinate_on_shaft", Quantity::Length)
                .unwrap_or(0.0);
            section(part, start)
        })
        .collect()
}

/// Sections one after the other: where several lie inside each other, as a hollow shaft on a pin, one with the sum of their bending
/// stiffness and the largest diameter.
fn merged(mut sections: Vec<Section>) -> Vec<Section> {
    sections.sort_by(|a, b| a.from.total_cmp(&b.from).then(a.to.total_cmp(&b.to)));
    // Rounded, so that ends that meet are equal.
    let rounded = |x: f64| (x * 1e6).round() as i64;
    let mut ends: Vec<i64> = sections.iter().flat_map(|s| [rounded(s.from), rounded(s.to)]).collect();
    ends.sort_unstable();
    ends.dedup();
    // A file with thousands of sections on one shaft is none of a gearbox.
    if sections.len() > 2000 {
        return sections;
    }
    let mut merged: Vec<Section> = Vec::new();
    for pair in ends.windows(2) {
        let inside: Vec<&Section> = sections
            .iter()
            .filter(|s| rounded(s.from) <= pair[0] && pair[1] <= rounded(s.to))
            .collect();
        let Some(outer) = inside.iter().map(|s| s.outer).max_by(f64::total_cmp) else {
            continue;
        };
        let stiffness: f64 = inside.iter().map(|s| s.outer.powi(4) - s.inner.powi(4)).sum();
        let inner = match inside.as_slice() {
            [only] => only.inner,
            _ => (outer.powi(4) - stiffness).max(0.0).powf(0.25),
        };
        let [from, to] = [pair[0], pair[1]].map(|x| x as f64 / 1e6);
        match merged.last_mut() {
            Some(last) if (last.to, last.outer, last.inner) == (from, outer, inner) => last.to = to,
            _ => merged.push(Section { from, to, outer, inner }),
        }
    }
    merged
}

/// Mass and its position: of shafts and of what is on them, as far as stated.
fn mass(map: &Map<'_>, member: Id, parts: &[&Component]) -> Option<(f64, f64)> {
    let (mut total, mut moment) = (0.0, 0.0);
    for part in parts {
        let on: Vec<&Component> = map.parts_of(part.id);
        for component in std::iter::once(*part).chain(on) {
            let Some(mass) = map.source.positive(component, "mass_of_component", Quantity::Mass) else {
                continue;
            };
            let at = if component.kind == "shaft" {
                let sections = sections(map, member, component);
                let [from, to] = [sections.first()?.from, sections.last()?.to];
                0.5 * (from + to)
            } else {
                map.along(member, map.poses.get(component.id)?.origin)
            };
            total += mass;
            moment += mass * at;
        }
    }
    (total > 0.0).then(|| (total, moment / total))
}

/// Forces of the loads on a member that are not zero in any load case; their values are those of the first.
fn loads(map: &Map<'_>, member: Id) -> Vec<Load> {
    let mut loads = Vec::new();
    for load in &map.forces {
        if load.member == member {
            let (force, moment) = load.by_case.first().copied().unwrap_or_default();
            loads.push(Load {
                comment: load.comment.clone(),
                at: load.at,
                force,
                moment,
            });
        }
    }
    loads
}

/// Members that a gear, a bearing, a load or a coupling touches; the others are alone.
pub fn connected(map: &Map<'_>) -> BTreeSet<Id> {
    let mut connected = BTreeSet::new();
    let mut touch = |id: Option<Id>| connected.extend(id.and_then(|id| map.members.of(id)));
    let source = map.source;
    let shaft_of: BTreeMap<Id, Id> = map.shaft_of.clone();
    for (part, shaft) in &shaft_of {
        let kind = source.component(*part).map_or("", |part| part.kind.as_str());
        if kind == "external_load" {
            touch(Some(*shaft));
        }
    }
    for component in source
        .model
        .components
        .values()
        .filter(|component| is_gear(&component.kind))
    {
        touch(Some(component.id));
    }
    for relation in source.relations("side") {
        touch(relation.role("inner_part"));
        touch(relation.role("outer_part"));
    }
    for joint in &map.members.joints {
        touch(Some(joint.first));
        touch(joint.second);
    }
    connected.extend(map.members.carriers.values());
    connected
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(from: f64, to: f64, outer: f64, inner: f64) -> Section {
        Section { from, to, outer, inner }
    }

    #[test]
    fn sections_inside_each_other_become_one_as_stiff() {
        let found = merged(vec![
            section(0.0, 10.0, 20.0, 0.0),
            section(5.0, 8.0, 30.0, 20.0),
            section(10.0, 12.0, 20.0, 0.0),
        ]);
        assert_eq!(
            found,
            [
                section(0.0, 5.0, 20.0, 0.0),
                section(5.0, 8.0, 30.0, 0.0),
                section(8.0, 12.0, 20.0, 0.0)
            ]
        );
    }
}
