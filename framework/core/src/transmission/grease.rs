//! Checks of greased gears, meshes and bearings: grease has no level, its base oil is stated, and channels have room.

use serde::Deserialize;
use serde_json::Value;

use super::members::Members;
use super::oils::OilNumbers;
use super::seats::GearSeat;
use crate::attach::{Level, Places};
use crate::codes;
use crate::description::{GearboxEntry, LubricantEntry};
use crate::document::Diagnostic;
use crate::mechanism::bearing::{BearingPart, Lubrication};

/// Bearings of the resolved description.
fn bearings(document: &Value) -> impl Iterator<Item = (&String, &Value)> {
    let section = document.get("bearings").and_then(Value::as_object);
    section.into_iter().flatten()
}

fn text<'a>(value: &'a Value, key: &str) -> Option<&'a str> {
    value.get(key).and_then(Value::as_str)
}

/// Reports levels of greases, and bearings that have a grease as their oil.
pub(super) fn faults(document: &Value, entry: &GearboxEntry) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    if !entry.has_grease() {
        return found;
    }
    let mut report = |path: String, message: String, help: &str| {
        found.push(Diagnostic::error(path, message).help(help).code(codes::LUBRICANT));
    };
    if let Some(oil) = &entry.housing.oil
        && entry.is_greased(Some(&oil.lubricant))
    {
        let keys = [
            ("level", oil.level.is_some()),
            ("running_level", oil.running_level.is_some()),
        ];
        for (key, _) in keys.iter().filter(|(_, stated)| *stated) {
            report(
                format!("housing.oil.{key}"),
                format!("`{}` is a grease, which has no level", oil.lubricant),
                "delete the level; or delete `grease` of the lubricant if it flows like an oil",
            );
        }
    }
    for (id, gear) in entry.gears.iter() {
        if gear.level.is_some() && entry.is_greased(gear.oil.lubricant.as_deref()) {
            report(
                format!("gears.{id}.level"),
                "the lubricant of the gear is a grease, which has no level".to_owned(),
                "delete `level`, or name an oil as `lubricant`",
            );
        }
    }
    for (id, bearing) in bearings(document) {
        let is_oiled = text(bearing, "lubrication").is_none_or(|lubrication| lubrication != "grease");
        if let Some((name, _)) = entry.lubricant(text(bearing, "lubricant"))
            && is_oiled
            && entry.is_greased(Some(name))
        {
            report(
                format!("bearings.{id}"),
                format!("its lubricant `{name}` is a grease, but `lubrication` is not `grease`"),
                "write `lubrication: grease`, or name an oil as `lubricant`",
            );
        }
    }
    found
}

/// Reports what is probably wrong with grease, and what is not included in the losses.
pub(super) fn doubts(
    document: &Value,
    entry: &GearboxEntry,
    members: &Members,
    gears: &[GearSeat],
    oils: &OilNumbers<'_>,
) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (id, value) in bearings(document).filter(|(_, value)| text(value, "lubrication") == Some("grease")) {
        if let Ok(part) = BearingPart::deserialize(value) {
            of_bearing(id, value, &part, entry, &mut found);
            found.extend(in_oil(id, value, &part, members, oils));
        }
    }
    if entry.has_grease() {
        of_gears(entry, gears, oils, &mut found);
    }
    found
}

fn of_bearing(id: &str, value: &Value, part: &BearingPart, entry: &GearboxEntry, found: &mut Vec<Diagnostic>) {
    let path = format!("bearings.{id}");
    let mut report = |key: &str, message: String, help: String| {
        found.push(Diagnostic::warning(format!("{path}.{key}"), message).help(help));
    };
    match entry.lubricant(text(value, "lubricant")) {
        Some((name, LubricantEntry { grease: None, .. })) => report(
            "lubrication",
            format!("the bearing is greased, but its lubricant `{name}` is described as an oil"),
            format!(
                "if `{name}` is the base oil, add `grease: {{}}` to it; else describe the grease, as in `lubricants: {{ grease: {{ viscosity: {{ kv40: 100 \
                 mm2/s, kv100: 11 mm2/s }}, grease: {{ consistency: \"2\" }} }} }}`, and name it as `lubricant`"
            ),
        ),
        Some((
            name,
            LubricantEntry {
                grease: Some(grease), ..
            },
        )) if grease.consistency.is_some_and(|class| !class.suits_rolling_bearings()) => {
            report(
                "lubrication",
                format!("the consistency of `{name}` is not one of those of rolling bearings, 1 to 3"),
                "check `consistency`: a softer grease flows back to the rolling elements, a stiffer one gives off little oil".to_owned(),
            );
        }
        _ => {}
    }
    if let Some(filling) = part.grease.and_then(|grease| grease.overfilled()) {
        report(
            "grease.filling",
            format!(
                "a bearing filled by {:.0} % churns its grease unless it is slow",
                100.0 * filling
            ),
            "state `churning`: 1 for a slow bearing, 2 to 4 else".to_owned(),
        );
    }
}

/// By how much the oil of the housing reaches over the lowest place at a radius around an axis, if it has a level. \[m\]
fn depth(oils: &OilNumbers<'_>, member: usize, at: f64, radius: f64) -> Option<f64> {
    match oils.level(Some(member as u16), at) {
        Level::Sump {
            height, slope, orbit, ..
        } => Some((oils.highest()? - height) * slope + orbit + radius),
        Level::Dry | Level::Own(_) => None,
    }
}

/// Reports a greased bearing without contact seals in the oil of the housing, which washes the grease out.
fn in_oil(id: &str, value: &Value, part: &BearingPart, members: &Members, oils: &OilNumbers<'_>) -> Option<Diagnostic> {
    let is_sealed = part.seals.is_some_and(|seals| seals.design.is_contact());
    if part.lubrication != Lubrication::Grease || is_sealed {
        return None;
    }
    let shaft = text(value, "shaft")?;
    let member = members.names.iter().position(|name| name == shaft)?;
    let at = value.get("at").and_then(Value::as_f64).unwrap_or(0.0);
    let depth = depth(oils, member, at, part.raceway).filter(|depth| *depth > 0.0)?;
    Some(
        Diagnostic::warning(
            format!("bearings.{id}.lubrication"),
            format!(
                "the oil of the housing reaches {:.3} mm into this greased bearing",
                1e3 * depth
            ),
        )
        .note("its loss is that of a greased bearing; oil would wash the grease out")
        .help("write `lubrication: bath`; or state `seals` of the bearing, if they keep the oil out"),
    )
}

fn of_gears(entry: &GearboxEntry, gears: &[GearSeat], oils: &OilNumbers<'_>, found: &mut Vec<Diagnostic>) {
    let lubricant = |gear: &str| entry.gears.get(gear).and_then(|gear| gear.oil.lubricant.as_deref());
    let greased: Vec<&GearSeat> = gears
        .iter()
        .filter(|gear| entry.is_greased(lubricant(&gear.id)))
        .collect();
    for gear in &greased {
        let radius = 0.5 * gear.diameters[1].max(gear.diameters[2]);
        if let Some(depth) = depth(oils, gear.member, gear.tip_at, radius).filter(|depth| *depth > 0.0) {
            found.push(
                Diagnostic::warning(
                    format!("gears.{}.lubricant", gear.id),
                    format!(
                        "the gear runs in grease, but the oil of the housing reaches {:.3} mm into it",
                        1e3 * depth
                    ),
                )
                .note("its drag is that of a gear out of the oil")
                .help("name the oil as its `lubricant`, or correct the level"),
            );
        }
    }
    if let Some(first) = greased.first() {
        let names: Vec<String> = greased.iter().map(|gear| format!("`{}`", gear.id)).collect();
        found.push(
            Diagnostic::warning(
                format!("gears.{}", first.id),
                format!("no law of the churning of grease is known: that of {} is not included", names.join(", ")),
            )
            .help("if it matters, add it as measured, with `drag: { churning: { type: table, file: drag.csv } }` of a gear")
            .code(codes::UNCOUNTED),
        );
    }
    for (path, gears, of_mesh) in entry.all_meshes() {
        let is_greased = entry.is_greased(of_mesh);
        if let Some(other) = gears
            .iter()
            .find(|gear| entry.is_greased(lubricant(gear)) != is_greased)
        {
            let [mesh_has, gear_has] = if is_greased {
                ["grease", "oil"]
            } else {
                ["oil", "grease"]
            };
            found.push(
                Diagnostic::warning(
                    format!("{path}.lubricant"),
                    format!("the teeth run in {mesh_has}, but the lubricant of `{other}`, for its drag, is {gear_has}"),
                )
                .help("name the same `lubricant` for the mesh and its gears"),
            );
        }
    }
}
