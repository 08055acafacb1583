//! Reads the things to draw from the transmission and its resolved description.

use serde_json::{Map, Value};

use super::{Axle, Contact, Kind, Member, Part, Strand, Symbol, Wheel};
use gearloss_framework::transmission::Transmission;

/// Axes that are closer are the same. \[m\]
const COAXIAL: f64 = 1e-6;

/// Entries of a section; empty if there is no such section.
fn section<'a>(
    resolved: &'a Value,
    name: &str,
) -> impl Iterator<Item = (&'a String, &'a Map<String, Value>)> + use<'a> {
    let entries = resolved.get(name).and_then(Value::as_object);
    entries
        .into_iter()
        .flatten()
        .filter_map(|(id, entry)| entry.as_object().map(|entry| (id, entry)))
}

fn text<'a>(entry: &'a Map<String, Value>, key: &str) -> Option<&'a str> {
    entry.get(key).and_then(Value::as_str)
}

fn number(entry: &Map<String, Value>, key: &str) -> Option<f64> {
    entry.get(key).and_then(Value::as_f64).filter(|x| x.is_finite())
}

pub(super) fn members(transmission: &Transmission, resolved: &Value) -> (Vec<Member>, usize) {
    let names = transmission.members();
    let number_of = |name: &str| names.iter().position(|m| m == name);
    let mut members: Vec<Member> = names
        .iter()
        .map(|name| Member {
            name: name.clone(),
            kind: Kind::Shaft,
            line: 0,
            count: 1.0,
        })
        .collect();
    for (id, gear) in section(resolved, "gears") {
        if text(gear, "mounted") == Some("loose")
            && let (Some(member), Some(shaft)) = (number_of(id), text(gear, "shaft").and_then(number_of))
        {
            members[member].kind = Kind::Loose(shaft);
        }
    }
    for (_, set) in section(resolved, "planetary_sets") {
        let Some(carrier) = text(set, "carrier").and_then(number_of) else {
            continue;
        };
        let planets = set.get("planets").and_then(Value::as_array);
        for planet in planets.into_iter().flatten().filter_map(Value::as_str) {
            if let Some(planet) = number_of(planet) {
                members[planet].kind = Kind::Planet(carrier);
                members[planet].count = number(set, "count").unwrap_or(1.0);
            }
        }
    }
    let lines = lines(&mut members, resolved);
    (members, lines)
}

/// Assigns the index of its axis to every member; returns the number of axes.
fn lines(members: &mut [Member], resolved: &Value) -> usize {
    let mut axes: Vec<Option<[f64; 2]>> = Vec::new();
    let place = |name: &str| {
        let axis = resolved.get("shafts")?.get(name)?.get("axis")?.as_array()?;
        Some([axis.first()?.as_f64()?, axis.get(1)?.as_f64()?])
    };
    for i in 0..members.len() {
        let axis = place(&members[carrying(members, i)].name);
        let same = |other: &Option<[f64; 2]>| match (axis, other) {
            (Some(a), Some(b)) => (a[0] - b[0]).hypot(a[1] - b[1]) < COAXIAL,
            _ => false,
        };
        members[i].line = axes.iter().position(same).unwrap_or_else(|| {
            axes.push(axis);
            axes.len() - 1
        });
    }
    axes.len().max(1)
}

/// The member with a fixed axis that finally carries another member.
fn carrying(members: &[Member], member: usize) -> usize {
    let mut at = member;
    // Carriers can be planets of other carriers, but not in a loop.
    for _ in 0..members.len() {
        match members[at].kind {
            Kind::Shaft => break,
            Kind::Loose(next) | Kind::Planet(next) => at = next,
        }
    }
    at
}

pub(super) fn wheels(transmission: &Transmission) -> Vec<Wheel> {
    let tips = transmission.gears().iter().map(|g| 0.5 * g.diameters[1]);
    // A gear without a mesh has no diameter; it is drawn a little smaller than the others.
    let usual = Some(0.5 * tips.fold(0.0, f64::max))
        .filter(|r| *r > 0.0)
        .unwrap_or(0.03);
    transmission
        .gears()
        .iter()
        .map(|gear| Wheel {
            id: gear.id.clone(),
            member: gear.member,
            at: gear.at,
            moved: 0.0,
            width: gear.facewidth,
            radius: Some(0.5 * gear.diameters[1]).filter(|r| *r > 0.0).unwrap_or(usual),
            ring: gear.ring,
            z: gear.z,
            stated: gear.diameters[1] > 0.0,
        })
        .collect()
}

/// Separates gear trains that overlap at the position zero because no position is stated.
pub(super) fn spread(wheels: &mut [Wheel], contacts: &[Contact], members: &[Member]) {
    let trains = trains(wheels.len(), contacts);
    let edge = |w: &Wheel, side: f64| w.at + side * 0.5 * w.width;
    let clash = |a: &Wheel, b: &Wheel| {
        let (on, of) = (&members[a.member], &members[b.member]);
        let planets = |m: &Member| matches!(m.kind, Kind::Planet(_));
        on.line == of.line
            && a.ring == b.ring
            && planets(on) == planets(of)
            && edge(a, -1.0) < edge(b, 1.0)
            && edge(b, -1.0) < edge(a, 1.0)
    };
    for (i, train) in trains.iter().enumerate() {
        let unplaced = train.iter().all(|g| wheels[*g].at == 0.0);
        let before = || trains[..i].iter().flatten();
        let after = || trains[i + 1..].iter().flatten();
        let clashes = |other: &usize| train.iter().any(|g| clash(&wheels[*g], &wheels[*other]));
        let (blocked, clashing) = (before().any(clashes), before().chain(after()).any(clashes));
        if !unplaced || !clashing {
            continue;
        }
        let width = train.iter().map(|g| wheels[*g].width).fold(0.0, f64::max);
        let right = before()
            .map(|g| edge(&wheels[*g], 1.0))
            .fold(f64::NEG_INFINITY, f64::max);
        let shift = if blocked { right + 1.3 * width } else { 0.0 };
        for g in train {
            wheels[*g].at += shift;
            wheels[*g].moved = shift;
            wheels[*g].stated = false;
        }
    }
}

/// Gears that are connected by meshes.
fn trains(count: usize, contacts: &[Contact]) -> Vec<Vec<usize>> {
    let mut train: Vec<usize> = (0..count).collect();
    for contact in contacts {
        let [a, b] = contact.gears.map(|g| train[g]);
        train.iter_mut().filter(|t| **t == b).for_each(|t| *t = a);
    }
    let mut trains: Vec<Vec<usize>> = Vec::new();
    for g in 0..count {
        match trains.iter_mut().find(|t| train[t[0]] == train[g]) {
            Some(train) => train.push(g),
            None => trains.push(vec![g]),
        }
    }
    trains
}

/// Sections of the framework that hold no components of mechanisms.
const FRAMEWORK: [&str; 9] = [
    "gears",
    "meshes",
    "bevel_meshes",
    "worm_meshes",
    "crossed_helical_meshes",
    "shafts",
    "planetary_sets",
    "differentials",
    "chains",
];

pub(super) fn parts(members: &[Member], wheels: &[Wheel], resolved: &Value) -> Vec<Part> {
    let sections = resolved.as_object().into_iter().flatten().map(|(name, _)| name);
    let mut parts = Vec::new();
    for name in sections.filter(|name| !FRAMEWORK.contains(&name.as_str())) {
        for (id, entry) in section(resolved, name) {
            parts.extend(part(members, wheels, name, id, entry));
        }
    }
    parts
}

/// A component; absent if the entry is not a component, as in `housing`.
fn part(members: &[Member], wheels: &[Wheel], section: &str, id: &str, entry: &Map<String, Value>) -> Option<Part> {
    // The outer absence: no such member. The inner absence: the housing.
    let side = |name: &str| match name {
        "housing" => Some(None),
        _ => members.iter().position(|m| m.name == name).map(Some),
    };
    let between = if let Some([a, b]) = entry.get("between").and_then(Value::as_array).map(Vec::as_slice) {
        [side(a.as_str()?)?, side(b.as_str()?)?]
    } else {
        let outer = text(entry, "outer").map_or(Some(None), side)?;
        [side(text(entry, "shaft")?)?, outer]
    };
    let symbol = match section {
        "seals" => Symbol::Seal,
        "clutches" => Symbol::Clutch,
        _ if entry.contains_key("between") => Symbol::Sleeve,
        _ if section == "bearings" || entry.contains_key("outer") || entry.contains_key("axial") => Symbol::Bearing,
        _ => Symbol::Other,
    };
    // Only bearings must state their position; for others an absent position was resolved to zero.
    let at = number(entry, "at").filter(|at| symbol == Symbol::Bearing || *at != 0.0);
    let carried = |w: &&Wheel| {
        let on_it = between.contains(&Some(w.member)) && members[w.member].kind != Kind::Shaft;
        on_it && at.is_some_and(|at| (at - (w.at - w.moved)).abs() <= 0.5 * w.width)
    };
    let moved = wheels.iter().find(carried).map_or(0.0, |w| w.moved);
    let height = number(entry, "outside")
        .zip(number(entry, "bore"))
        .map(|(outside, bore)| 0.5 * (outside - bore));
    let copies = between.iter().flatten().map(|m| members[*m].count).fold(1.0, f64::max);
    Some(Part {
        path: format!("{section}.{id}"),
        id: id.to_owned(),
        symbol,
        between,
        at: at.map(|at| at + moved),
        size: [number(entry, "width"), height],
        count: number(entry, "count").unwrap_or(1.0) * copies,
    })
}

pub(super) fn axles(members: &[Member], resolved: &Value) -> Vec<Axle> {
    let read = |id: &str, entry: &Map<String, Value>| {
        let member = |key: &str| members.iter().position(|m| Some(m.name.as_str()) == text(entry, key));
        Some(Axle {
            id: id.to_owned(),
            case: member("case")?,
            sides: [member("left")?, member("right")?],
        })
    };
    section(resolved, "differentials")
        .filter_map(|(id, entry)| read(id, entry))
        .collect()
}

pub(super) fn chains(members: &[Member], resolved: &Value) -> Vec<Strand> {
    let read = |id: &str, entry: &Map<String, Value>| {
        let wheels = entry.get("wheels")?.as_array()?;
        let [first, second] = [wheels.first()?.as_object()?, wheels.get(1)?.as_object()?];
        let member = |wheel: &Map<String, Value>| {
            members
                .iter()
                .position(|m| Some(m.name.as_str()) == text(wheel, "shaft"))
        };
        let kind = text(entry, "kind").unwrap_or("chain").replace('_', " ");
        let teeth = number(first, "z").zip(number(second, "z"));
        let pitch = number(entry, "pitch");
        // The pulleys of a belt of variable ratio have no stated radius.
        let radius = |z: f64| pitch.map_or(0.03, |pitch| z * pitch / std::f64::consts::TAU);
        Some(Strand {
            id: id.to_owned(),
            members: [member(first)?, member(second)?],
            at: number(first, "at").unwrap_or(0.0),
            radii: teeth.map_or([0.03; 2], |(first, second)| [radius(first), radius(second)]),
            what: match teeth {
                Some((first, second)) => format!("{kind} over {first} and {second} teeth"),
                None => kind,
            },
        })
    };
    section(resolved, "chains")
        .filter_map(|(id, entry)| read(id, entry))
        .collect()
}
