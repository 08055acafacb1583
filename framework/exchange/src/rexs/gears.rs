//! Gears, meshes and planetary sets.

use std::collections::{BTreeMap, BTreeSet};

use super::draft::{Gear, Material, Mesh, Set};
use super::map::{Map, id, named};
use super::model::{Component, Id};
use super::pair::{Basic, distance, matching_shift};
use super::pose::{PARALLEL, cross, dot, sum, unit};
use super::units::Quantity;
use super::yaml::number;
use crate::codes;

/// Difference of centre distances that is rounding. \[mm\]
const ROUNDING: f64 = 1e-3;

/// A gear as read.
#[derive(Debug, Clone)]
pub struct ReadGear<'a> {
    pub component: &'a Component,
    pub member: Id,
    ring: bool,
    at: f64,
    pub z: i64,
    facewidth: f64,
    pub normal_module: f64,
    /// Signed. \[deg\]
    pub helix: f64,
    pub pressure_angle: Option<f64>,
    shift: Option<f64>,
}

/// A pair of gears as read.
#[derive(Debug)]
struct Pair<'a> {
    stage: &'a Component,
    gears: [Id; 2],
}

/// All gears by id.
pub fn read<'a>(map: &Map<'a>) -> BTreeMap<Id, ReadGear<'a>> {
    let source = map.source;
    let mut gears = BTreeMap::new();
    for component in source.model.components.values() {
        let ring = match component.kind.as_str() {
            "cylindrical_gear" => false,
            "ring_gear" => true,
            _ => continue,
        };
        let Some(member) = map.member_with(component.id) else {
            source.error(
                component,
                codes::REXS_MODEL,
                "it is on no shaft: there is no relation `assembly` or `side` with it",
                "put the gear on a shaft in the program that exported the model",
            );
            continue;
        };
        let Some(pose) = map.poses.get(component.id) else {
            source.error(
                component,
                codes::REXS_VALUE,
                "it has no position (support_vector)",
                "state support_vector and reference_component_for_position",
            );
            continue;
        };
        let [pressure_angle, shift] = flanks(map, component);
        let z = source.needed(component, "number_of_teeth", Quantity::Number);
        let z = if z == 0.0 {
            0
        } else {
            source.integer(component, "number_of_teeth").unwrap_or(0)
        };
        gears.insert(
            component.id,
            ReadGear {
                component,
                member,
                ring,
                at: map.along(member, pose.origin),
                z: z.abs(),
                facewidth: source.needed(component, "face_width", Quantity::Length),
                normal_module: source.needed(component, "normal_module", Quantity::Length),
                helix: source
                    .number(component, "helix_angle_reference_diameter", Quantity::Angle)
                    .unwrap_or(0.0),
                pressure_angle,
                shift,
            },
        );
    }
    gears
}

/// Pressure angle and profile shift coefficient of a gear, which its flanks state; both flanks are equal.
fn flanks(map: &Map<'_>, gear: &Component) -> [Option<f64>; 2] {
    let source = map.source;
    let relation = source
        .relations("flank")
        .find(|relation| relation.role("gear") == Some(gear.id));
    let flanks: Vec<&Component> = ["left", "right"]
        .into_iter()
        .filter_map(|role| relation?.role(role))
        .filter_map(|id| source.component(id))
        .collect();
    let module = source.positive(gear, "normal_module", Quantity::Length);
    let shift = |flank: &Component| {
        let length = || Some(source.number(flank, "addendum_modification", Quantity::Length)? / module?);
        source
            .number(flank, "addendum_modification_coefficient", Quantity::Number)
            .or_else(length)
    };
    let angle = |flank: &Component| source.number(flank, "normal_pressure_angle", Quantity::Angle);
    let both = |what: &str, values: Vec<Option<f64>>| {
        let stated: Vec<f64> = values.into_iter().flatten().collect();
        if let [left, right] = stated[..]
            && (left - right).abs() > 1e-9
        {
            source.error(
                gear,
                codes::REXS_PART,
                &format!("its flanks have different {what}: {left} and {right}"),
                "gearbox files describe symmetric teeth; give both flanks one value",
            );
        }
        stated.first().copied()
    };
    [
        both("pressure angles", flanks.iter().map(|flank| angle(flank)).collect()),
        both(
            "profile shift coefficients",
            flanks.iter().map(|flank| shift(flank)).collect(),
        ),
    ]
}

/// True if the axes of two members are not parallel.
pub fn crosses(map: &Map<'_>, members: [Id; 2]) -> bool {
    let axes = members.map(|member| map.poses.get(member).map(|pose| pose.u));
    matches!(axes, [Some(a), Some(b)] if dot(a, b).abs() < PARALLEL)
}

/// All pairs of gears.
fn pairs<'a>(map: &Map<'a>, gears: &BTreeMap<Id, ReadGear<'a>>) -> Vec<Pair<'a>> {
    let source = map.source;
    let mut pairs = Vec::new();
    for stage in source.components("cylindrical_stage") {
        let relation = source
            .relations("stage")
            .find(|relation| relation.role("stage") == Some(stage.id));
        let ids = relation.and_then(|relation| Some([relation.role("gear_1")?, relation.role("gear_2")?]));
        let Some(ids) = ids else {
            source.error(
                stage,
                codes::REXS_MODEL,
                "it names no gears: there is no relation `stage` with gear_1 and gear_2",
                "add the relation, or delete the stage",
            );
            continue;
        };
        if ids.iter().all(|id| gears.contains_key(id)) {
            pairs.push(Pair { stage, gears: ids });
        } else if ids
            .iter()
            .any(|id| source.component(*id).is_some_and(|gear| !gear.kind.ends_with("gear")))
        {
            source.error(
                stage,
                codes::REXS_MODEL,
                "one of its gears is no gear",
                "correct the relation `stage`",
            );
        }
    }
    pairs
}

/// What a model has of cylindrical gears.
#[derive(Debug)]
pub struct Cylindrical<'a> {
    pub gears: Vec<Gear>,
    pub meshes: Vec<Mesh>,
    pub sets: Vec<Set>,
    /// Stages on axes that cross, with their gears.
    pub crossed: Vec<(&'a Component, [ReadGear<'a>; 2])>,
}

/// Gears, meshes and planetary sets. Marks the planets that are copies.
pub fn gears<'a>(map: &mut Map<'a>) -> Cylindrical<'a> {
    let gears = read(map);
    let (crossed, pairs): (Vec<Pair<'a>>, Vec<Pair<'a>>) = pairs(map, &gears)
        .into_iter()
        .partition(|pair| crosses(map, pair.gears.map(|id| gears[&id].member)));
    let sets = sets(map, &gears, &pairs);
    let map = &*map;
    let mut shifts: BTreeMap<Id, Option<f64>> = BTreeMap::new();
    let mut meshes = Vec::new();
    for pair in &pairs {
        let [a, b] = pair.gears.map(|id| &gears[&id]);
        if map.copies.contains(&a.member) || map.copies.contains(&b.member) {
            continue;
        }
        meshes.extend(mesh(map, pair.stage, a, b, &mut shifts));
    }
    let mut hands = BTreeSet::new();
    let mut written = Vec::new();
    for (id, gear) in &gears {
        if map.copies.contains(&gear.member) {
            continue;
        }
        let hand = match gear.helix {
            // That of a ring follows from its mate.
            helix if helix.abs() < 1e-9 || gear.ring => None,
            helix if helix > 0.0 => Some("right"),
            _ => Some("left"),
        };
        hands.extend(hand);
        let is_crossed = crossed.iter().any(|pair| pair.gears.contains(id));
        let shift = shifts.get(id).copied().unwrap_or(gear.shift);
        let shift = shift.filter(|shift| !is_crossed || *shift != 0.0);
        written.push(written_gear(map, gear, hand, shift));
    }
    if !hands.is_empty() {
        map.source.assume(
            "a positive helix angle is a right-hand helix; the sense changes the direction of the axial forces only",
        );
    }
    Cylindrical {
        gears: written,
        meshes,
        sets,
        crossed: crossed
            .into_iter()
            .map(|pair| (pair.stage, pair.gears.map(|id| gears[&id].clone())))
            .collect(),
    }
}

fn written_gear(map: &Map<'_>, gear: &ReadGear<'_>, hand: Option<&'static str>, shift: Option<f64>) -> Gear {
    let source = map.source;
    let component = gear.component;
    let reference = gear.z as f64 * gear.normal_module / gear.helix.to_radians().cos();
    let sign = if gear.ring { -1.0 } else { 1.0 };
    // Tips are outside of the reference circle, roots inside, and the other way around for rings; a shift moves both.
    let moved = 2.0 * shift.unwrap_or(0.0) * gear.normal_module;
    let diameter = |id: &str, side: f64| {
        let stated = source.number(component, id, Quantity::Length)?.abs();
        let from_middle = (stated - reference) * sign - moved;
        if from_middle * side > 0.0 && from_middle.abs() < 6.0 * gear.normal_module {
            return Some(stated);
        }
        source.note(format!(
            "{}: {id} {} mm does not fit the reference diameter {} mm and was ignored",
            component.label(),
            number(stated),
            number((reference * 1e3).round() / 1e3)
        ));
        None
    };
    let mut tip_diameter = diameter("tip_diameter", 1.0);
    if gear.ring && tip_diameter.is_none() {
        // Basic rack with an addendum of one module; a shift moves the tips towards the axis.
        tip_diameter = Some(reference - 2.0 * gear.normal_module * (1.0 + shift.unwrap_or(0.0)));
        source.assume(format!(
            "{}: the file states no tip diameter; that of the basic rack with an addendum of one module was taken",
            component.label()
        ));
    }
    let ra = source.positive(
        component,
        "arithmetic_mean_roughness_flank_iso_4287_1997",
        Quantity::Roughness,
    );
    if let Some(temperature) = source.number(component, "bulk_temperature", Quantity::Temperature) {
        source.note(format!(
            "{}: the bulk temperature {} degC was not used: gearbox files state that of the oil",
            component.label(),
            number(temperature)
        ));
    }
    Gear {
        id: id(if gear.ring { "ring" } else { "gear" }, component.id),
        comment: named(component),
        shaft: map.member_name(map.loose.get(&gear.member).copied().unwrap_or(gear.member)),
        loose: map.loose.contains_key(&gear.member),
        at: Some(gear.at),
        z: gear.z,
        facewidth: gear.facewidth,
        ring: gear.ring,
        hand,
        faces: None,
        profile_shift: shift,
        tip_diameter,
        root_diameter: diameter("root_diameter", -1.0),
        ra,
    }
}

/// A mesh; `None` if its gears do not fit, which is reported.
fn mesh(
    map: &Map<'_>,
    stage: &Component,
    a: &ReadGear<'_>,
    b: &ReadGear<'_>,
    shifts: &mut BTreeMap<Id, Option<f64>>,
) -> Option<Mesh> {
    let source = map.source;
    // A ring is the second gear.
    let (a, b) = if a.ring { (b, a) } else { (a, b) };
    if let Some(message) = mismatch(a, b) {
        source.error(
            stage,
            codes::REXS_MODEL,
            &message,
            "correct the gears in the program that exported the model",
        );
        return None;
    }
    let pressure_angle = a.pressure_angle.or(b.pressure_angle).unwrap_or_else(|| {
        source.assume(format!(
            "{}: the file states no pressure angle; 20 deg was taken",
            stage.label()
        ));
        20.0
    });
    let actual = centre_distance(map, stage, a, b)?;
    let orbits = [a.member, b.member].iter().any(|member| map.planets.contains(member));
    let geometry = Basic {
        z: [a.z as f64, if b.ring { -(b.z as f64) } else { b.z as f64 }],
        module: a.normal_module,
        pressure_angle: pressure_angle.to_radians(),
        helix: a.helix.abs().to_radians(),
    };
    check_shifts(map, stage, [a, b], &geometry, actual, shifts);
    let material = |gear: &ReadGear<'_>| {
        map.referenced(gear.component.id, "material")
            .or_else(|| map.referenced(*map.shaft_of.get(&gear.component.id)?, "material"))
    };
    let Elasticity {
        modulus,
        poisson,
        materials,
    } = elasticity(map, [material(a), material(b)]);
    let oil = map.referenced(stage.id, "lubricant");
    Some(Mesh {
        id: id("stage", stage.id),
        comment: named(stage),
        gears: [a, b].map(|gear| id(if gear.ring { "ring" } else { "gear" }, gear.component.id)),
        normal_module: a.normal_module,
        pressure_angle,
        helix_angle: a.helix.abs(),
        centre_distance: orbits.then_some(actual),
        modulus,
        poisson,
        materials,
        lubricant: oil
            .map(|oil| id("lubricant", oil.id))
            .filter(|oil| Some(oil) != map.sump.as_ref()),
        shares: None,
    })
}

/// Why two gears cannot mesh.
fn mismatch(a: &ReadGear<'_>, b: &ReadGear<'_>) -> Option<String> {
    if a.ring {
        return Some("both of its gears have internal teeth".to_owned());
    }
    if a.member == b.member {
        return Some("both of its gears are on one shaft".to_owned());
    }
    let differ = |what: &str, a: f64, b: f64, unit: &str| Some(format!("its gears have the {what} {a} and {b} {unit}"));
    if (a.normal_module - b.normal_module).abs() > 1e-6 {
        return differ("normal modules", a.normal_module, b.normal_module, "mm");
    }
    // Of an external pair the hands differ. The sign of a ring is not relied on.
    let sum = if b.ring {
        a.helix.abs() - b.helix.abs()
    } else {
        a.helix + b.helix
    };
    if sum.abs() > 1e-4 {
        return differ("helix angles", a.helix, b.helix, "deg");
    }
    match (a.pressure_angle, b.pressure_angle) {
        (Some(a), Some(b)) if (a - b).abs() > 1e-6 => differ("pressure angles", a, b, "deg"),
        _ => None,
    }
}

/// The distance of the axes, which the stage repeats. \[mm\]
fn centre_distance(map: &Map<'_>, stage: &Component, a: &ReadGear<'_>, b: &ReadGear<'_>) -> Option<f64> {
    let of_axes = map.beside(a.member, map.poses.get(b.member)?.origin)?;
    let stated = map.source.positive(stage, "center_distance", Quantity::Length);
    match stated {
        Some(stated) if (stated - of_axes).abs() > ROUNDING => {
            map.source.note(format!(
                "{}: center_distance is {} mm, but the axes are {of_axes:.4} mm apart, which counts",
                stage.label(),
                number(stated)
            ));
            Some(of_axes)
        }
        _ => Some(stated.unwrap_or(of_axes)),
    }
}

/// Keeps the profile shifts of a pair if they give its centre distance; otherwise that of the second gear is left out.
fn check_shifts(
    map: &Map<'_>,
    stage: &Component,
    [a, b]: [&ReadGear<'_>; 2],
    geometry: &Basic,
    actual: f64,
    shifts: &mut BTreeMap<Id, Option<f64>>,
) {
    let shift_a = *shifts.entry(a.component.id).or_insert(a.shift);
    let shift_b = *shifts.entry(b.component.id).or_insert(b.shift);
    let (Some(x1), Some(x2)) = (shift_a, shift_b) else {
        return;
    };
    // The sign of a ring's shift differs between programs: that which fits the centre distance counts.
    let signs: &[f64] = if b.ring && x2 != 0.0 { &[1.0, -1.0] } else { &[1.0] };
    let fits = |x2: f64| distance(geometry, x1 + x2).is_some_and(|a| (a - actual).abs() < 0.01 * geometry.module);
    let fitting = signs.iter().map(|sign| sign * x2).find(|x2| fits(*x2));
    shifts.insert(b.component.id, fitting);
    if fitting.is_none() {
        let needed = matching_shift(geometry, actual);
        map.source.note(format!(
            "{}: the profile shifts {} and {} do not give the centre distance {} mm{}; that of {} was left out and follows from the centre \
             distance",
            stage.label(),
            number(x1),
            number(x2),
            number(actual),
            needed.map_or_else(String::new, |sum| format!(", which needs a sum of {sum:.4}")),
            b.component.label()
        ));
    }
}

/// Elastic constants of a pair.
#[derive(Default)]
struct Elasticity {
    /// Young's modulus of both gears, if it is not the usual one. \[GPa\]
    modulus: Option<f64>,
    /// Poisson's ratio of both gears, if it is not the usual one.
    poisson: Option<f64>,
    /// Their materials, if they differ or are soft.
    materials: Option<[Material; 2]>,
}

/// Young's modulus and Poisson's ratio of a pair: one value for both gears, or two materials.
fn elasticity(map: &Map<'_>, materials: [Option<&Component>; 2]) -> Elasticity {
    let source = map.source;
    let read = |material: Option<&Component>| {
        let component = material?;
        let modulus = source.positive(component, "elastic_modulus", Quantity::Modulus)?;
        let poisson = source
            .number(component, "poisson_ratio", Quantity::Number)
            .unwrap_or(0.3);
        let known = (0.1..=1000.0).contains(&modulus) && (0.0..0.5).contains(&poisson);
        known.then(|| Material {
            id: id("material", component.id),
            comment: named(component),
            modulus,
            poisson,
        })
    };
    let one = match materials.map(read) {
        [Some(a), Some(b)] if (a.modulus, a.poisson) == (b.modulus, b.poisson) && !a.is_soft() => a,
        [Some(a), Some(b)] => {
            return Elasticity {
                materials: Some([a, b]),
                ..Elasticity::default()
            };
        }
        [Some(one), None] | [None, Some(one)] => one,
        [None, None] => return Elasticity::default(),
    };
    let unlike = |value: f64, usual: f64| (value - usual).abs() > 1e-9 * usual;
    Elasticity {
        modulus: Some(one.modulus).filter(|value| unlike(*value, 206.0)),
        poisson: Some(one.poisson).filter(|value| unlike(*value, 0.3)),
        materials: None,
    }
}

/// Planetary sets: of equal planets, or groups of planets that mesh with each other, one is written with their number.
fn sets<'a>(map: &mut Map<'a>, gears: &BTreeMap<Id, ReadGear<'a>>, pairs: &[Pair<'a>]) -> Vec<Set> {
    let source = map.source;
    let mut sets = Vec::new();
    for (stage_id, planets) in map.members.planets.clone() {
        let Some(stage) = source.component(stage_id) else {
            continue;
        };
        let Some(&carrier) = map.members.carriers.get(&stage_id) else {
            source.error(
                stage,
                codes::REXS_MODEL,
                "it has planets and no carrier",
                "add the relation planet_carrier_shaft with the shaft of the carrier",
            );
            continue;
        };
        if planets.contains(&carrier) {
            source.error(
                stage,
                codes::REXS_MODEL,
                "a planet is rigidly joined to the carrier",
                "put a bearing between the pin and the planet",
            );
            continue;
        }
        let trains = trains(&planets, gears, pairs);
        let signatures: Vec<String> = trains.iter().map(|train| signature(map, train, gears, pairs)).collect();
        if signatures.iter().any(|signature| *signature != signatures[0]) {
            source.error(
                stage,
                codes::REXS_PART,
                "its planets differ",
                "gearbox files describe sets of equal planets; check teeth, positions and meshes of all planets",
            );
            continue;
        }
        if trains.len() < 2 {
            source.error(
                stage,
                codes::REXS_PART,
                "it has a single planet",
                "gearbox files describe sets of at least two equal planets",
            );
            continue;
        }
        check_spacing(map, stage, carrier, &trains);
        map.copies.extend(trains.iter().skip(1).flatten());
        sets.push(Set {
            id: id("set", stage_id),
            comment: named(stage),
            carrier: map.member_name(carrier),
            planets: trains[0].iter().map(|planet| map.member_name(*planet)).collect(),
            count: trains.len(),
        });
    }
    sets
}

/// Groups of planets that mesh with each other; the first has the smallest id.
fn trains(planets: &BTreeSet<Id>, gears: &BTreeMap<Id, ReadGear<'_>>, pairs: &[Pair<'_>]) -> Vec<Vec<Id>> {
    let mut group: BTreeMap<Id, Id> = planets.iter().map(|id| (*id, *id)).collect();
    for pair in pairs {
        let [a, b] = pair.gears.map(|id| gears[&id].member);
        if let (Some(&a), Some(&b)) = (group.get(&a), group.get(&b)) {
            for first in group.values_mut().filter(|first| **first == a.max(b)) {
                *first = a.min(b);
            }
        }
    }
    let mut trains: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
    for (planet, first) in group {
        trains.entry(first).or_default().push(planet);
    }
    trains.into_values().collect()
}

/// What planets of one set have in common: gears with their positions and the central gears that they mesh with.
fn signature(map: &Map<'_>, train: &[Id], gears: &BTreeMap<Id, ReadGear<'_>>, pairs: &[Pair<'_>]) -> String {
    let mut lines = Vec::new();
    for gear in gears.values().filter(|gear| train.contains(&gear.member)) {
        let id = gear.component.id;
        let mut mates: Vec<String> = pairs
            .iter()
            .filter(|pair| pair.gears.contains(&id))
            .map(|pair| {
                let mate = if pair.gears[0] == id {
                    pair.gears[1]
                } else {
                    pair.gears[0]
                };
                let mate = &gears[&mate];
                if map.planets.contains(&mate.member) {
                    format!("planet with {}", mate.z)
                } else {
                    mate.component.id.to_string()
                }
            })
            .collect();
        mates.sort();
        lines.push(format!(
            "{} {:.5} {:.5} {:.5} {:.5} {:.5} {:?}",
            gear.z,
            gear.normal_module,
            gear.facewidth,
            gear.at,
            gear.helix + 0.0,
            gear.shift.unwrap_or(0.0) + 0.0,
            mates
        ));
    }
    lines.sort();
    lines.join("; ")
}

/// Planets at equal angles about the carrier; other angles are a note.
fn check_spacing(map: &Map<'_>, stage: &Component, carrier: Id, trains: &[Vec<Id>]) {
    let (along, up) = match map.line(carrier) {
        None => (map.frame.x, map.frame.z),
        Some(line) => (line.u, line.w),
    };
    let angle = |planet: Id| {
        let axis = map.poses.get(carrier)?.origin;
        let arm = sum(map.poses.get(planet)?.origin, axis, -1.0);
        let arm = unit(sum(arm, along, -dot(arm, along)))?;
        let beside = cross(along, up);
        Some(dot(arm, beside).atan2(dot(arm, up)).to_degrees())
    };
    let mut angles: Vec<f64> = trains.iter().filter_map(|train| angle(*train.first()?)).collect();
    angles.sort_by(f64::total_cmp);
    let Some(first) = angles.first().copied() else {
        return;
    };
    let step = 360.0 / trains.len() as f64;
    let uneven = angles
        .iter()
        .enumerate()
        .any(|(i, angle)| (angle - first - i as f64 * step).abs() > 1.0);
    if uneven || angles.len() != trains.len() {
        map.source.assume(format!(
            "{}: its planets are not equally spaced; they are described as if they were",
            stage.label()
        ));
    }
}
