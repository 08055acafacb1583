//! Bearings, with the catalogue of the program for their designations.

use std::collections::BTreeSet;

use gearloss_framework::language::Language;
use gearloss_framework::resolve::{CatalogueTable, read_designation};
use serde_json::Value;

use super::draft::{Bearing, Film};
use super::map::{Map, id, named, one_line};
use super::model::{Component, Id};
use super::oil::is_grease;
use super::units::Quantity;

/// Bearing types of REXS and kinds of gearbox files; `None` where there is none.
const KINDS: &[(&str, Option<&str>)] = &[
    ("radial_grooved_ball_bearing", Some("deep_groove_ball")),
    ("angular_contact_ball_bearing", Some("angular_contact_ball")),
    ("four_point_contact_ball_bearing", Some("four_point_contact_ball")),
    ("axial_four_point_contact_ball_bearing", Some("four_point_contact_ball")),
    ("radial_self_aligning_ball_bearing", Some("self_aligning_ball")),
    ("radial_roller_bearing", Some("cylindrical_roller")),
    ("radial_needle_roller_bearing", Some("needle_cage")),
    ("radial_tapered_roller_bearing", Some("tapered_roller")),
    ("radial_spherical_roller_bearing", Some("spherical_roller")),
    ("radial_self_aligning_roller_bearing", Some("spherical_roller")),
    ("axial_grooved_ball_bearing", Some("thrust_ball")),
    ("axial_angular_contact_ball_bearing", Some("thrust_ball")),
    ("axial_roller_bearing", Some("cylindrical_roller_thrust")),
    ("axial_needle_roller_bearing", Some("needle_roller_thrust")),
    ("axial_self_aligning_roller_bearing", Some("spherical_roller_thrust")),
    ("axial_tapered_roller_bearing", None),
    ("crossed_roller_bearing", None),
];

/// Components that are plain bearings.
const PLAIN: [&str; 2] = ["slide_bearing", "hydrodynamic_radial_plain_bearing"];

/// Relative clearances of plain bearings, which tell the unit of a clearance that has none.
const CLEARANCES: std::ops::Range<f64> = 2e-4..1e-2;
/// Relative clearance where none is stated, in the middle of the usual ones.
const PLACEHOLDER_CLEARANCE: f64 = 0.0015;
/// Film at which surfaces touch, which REXS does not have, and its greatest share of the clearance of the radius. \[um\]
const LEAST_THICKNESS: (f64, f64) = (3.0, 0.2);

/// Ratio of outside to bore diameter where nothing is known; bearings have 1.2 to 2.6.
const PLACEHOLDER_RATIO: f64 = 1.6;
/// Bore where not even the shaft states its diameter. \[mm\]
const PLACEHOLDER_BORE: f64 = 50.0;
/// Stiffness from which a bearing counts as rigid, as it is by default. \[N/mm\]
const RIGID: f64 = 1e9;

/// All bearings. Placeholders are returned as paths with their reasons.
pub fn bearings(map: &Map<'_>, language: &Language) -> (Vec<Bearing>, Vec<(Vec<String>, String)>) {
    let source = map.source;
    let (mut bearings, mut assumed) = (Vec::new(), Vec::new());
    let placed: BTreeSet<Id> = source
        .relations("side")
        .filter_map(|side| side.role("assembly"))
        .collect();
    for component in source.model.components.values() {
        let is_bearing = component.kind.contains("bearing") && placed.contains(&component.id);
        let kind = component.kind.as_str();
        let holds = kind == "concept_bearing" || kind.starts_with("rolling_bearing_with") || PLAIN.contains(&kind);
        if !is_bearing && holds {
            source.note(format!("{} has no relation `side` and was ignored", component.label()));
        }
        if is_bearing && let Some(bearing) = bearing(map, language, component, &mut assumed) {
            bearings.push(bearing);
        }
    }
    (bearings, assumed)
}

fn bearing(
    map: &Map<'_>,
    language: &Language,
    component: &Component,
    assumed: &mut Vec<(Vec<String>, String)>,
) -> Option<Bearing> {
    let source = map.source;
    let side = source
        .relations("side")
        .find(|side| side.role("assembly") == Some(component.id))?;
    let (inner, outer) = (side.role("inner_part"), side.role("outer_part"));
    let member = |part: Option<Id>| part.and_then(|id| map.members.of(id));
    let (inside, outside) = (member(inner), member(outer));
    // A shaft around a fixed pin is supported by the housing, too; its thrust has the other sign.
    let (shaft, around, flipped) = match (inside, outside) {
        (Some(inside), Some(outside)) if is_carried(map, outside, inside) => (outside, Some(inside), true),
        (Some(inside), around) => (inside, around, false),
        (None, Some(outside)) => (outside, None, true),
        (None, None) => {
            source.note(format!("{} supports no shaft and was ignored", component.label()));
            return None;
        }
    };
    if [Some(shaft), around]
        .into_iter()
        .flatten()
        .any(|member| map.copies.contains(&member))
    {
        return None;
    }
    if Some(shaft) == around {
        source.note(format!(
            "{} is between parts that are rigidly joined and was ignored",
            component.label()
        ));
        return None;
    }
    let pose = map.poses.get(component.id);
    let Some(pose) = pose else {
        source.error(
            component,
            crate::codes::REXS_VALUE,
            "it has no position (support_vector)",
            "state support_vector and reference_component_for_position",
        );
        return None;
    };
    let name = id("bearing", component.id);
    let mut bearing = Bearing {
        comment: named(component),
        shaft: map.member_name(shaft),
        outer: around.map(|member| map.member_name(member)),
        at: map.along(shaft, pose.origin),
        axial: axial(
            map,
            component,
            map.sense(shaft, pose.u) * if flipped { -1.0 } else { 1.0 },
        ),
        radial_stiffness: source
            .positive(component, "radial_stiffness", Quantity::Stiffness)
            .filter(|value| (1.0..RIGID).contains(value)),
        tilting_stiffness: source
            .positive(component, "bending_stiffness", Quantity::TiltingStiffness)
            .filter(|value| (1.0..RIGID).contains(value)),
        lubricant: map
            .referenced(component.id, "lubricant")
            .map(|oil| id("lubricant", oil.id)),
        lubrication: lubrication(map, component),
        oil_height: source
            .number(component, "depth_of_immersion_in_oil", Quantity::Length)
            .filter(|height| *height >= 0.0),
        id: name,
        ..Bearing::default()
    };
    if source.flag(component, "radial_force_absorption") == Some(false) {
        source.note(format!(
            "{} takes no radial force; in gearbox files every bearing takes some, so the loads of this shaft are wrong",
            component.label()
        ));
    }
    if PLAIN.contains(&component.kind.as_str()) {
        plain(map, inner, component, &mut bearing, assumed);
        return Some(bearing);
    }
    grease(map, component, &mut bearing);
    data(map, component, &mut bearing);
    catalogue(map, language, component, &mut bearing);
    placeholders(map, [inner, outer], component, &mut bearing, assumed);
    Some(bearing)
}

/// A bearing whose lubricant is a grease is greased, and a greased one has no oil level.
fn grease(map: &Map<'_>, component: &Component, bearing: &mut Bearing) {
    let source = map.source;
    let of_housing = || {
        let mut oils = source.components("lubricant");
        oils.find(|oil| Some(id("lubricant", oil.id)) == map.sump)
    };
    let oil = map.referenced(component.id, "lubricant").or_else(of_housing);
    if oil.is_some_and(|oil| is_grease(map, oil)) {
        bearing.lubrication = Some("grease");
    }
    if bearing.lubrication == Some("grease") && bearing.oil_height.take().is_some_and(|height| height > 0.0) {
        source.note(format!(
            "{}: it is greased; its depth in the oil was ignored",
            component.label()
        ));
    }
}

/// A plain bearing: its journal, and the clearance of its film.
fn plain(
    map: &Map<'_>,
    inner: Option<Id>,
    component: &Component,
    bearing: &mut Bearing,
    assumed: &mut Vec<(Vec<String>, String)>,
) {
    let source = map.source;
    let length = |id: &str| source.positive(component, id, Quantity::Length);
    bearing.kind = Some("plain");
    if bearing.axial != "none" {
        source.note(format!(
            "{}: plain bearings carry no thrust in gearbox files; its thrust was left out",
            component.label()
        ));
        bearing.axial = "none";
    }
    if bearing.lubrication == Some("grease") {
        source.note(format!(
            "{}: gearbox files know no greased plain bearing; it counts as one in oil",
            component.label()
        ));
        bearing.lubrication = None;
    }
    let (bore, width) = (length("inner_diameter"), length("width"));
    let clearance = bore.and_then(|bore| relative_clearance(map, component, bore));
    let lacks: Vec<&str> = [
        ("bore", bore.is_none()),
        ("width", width.is_none()),
        ("film.relative_clearance", clearance.is_none()),
    ]
    .into_iter()
    .filter_map(|(key, lacks)| lacks.then_some(key))
    .collect();
    let bore = bore
        .or_else(|| diameter_near(map, inner, bearing.at, false))
        .unwrap_or(PLACEHOLDER_BORE);
    let relative_clearance = clearance.unwrap_or(PLACEHOLDER_CLEARANCE);
    let (touching, share) = LEAST_THICKNESS;
    bearing.bore = Some(bore);
    bearing.width = Some(width.unwrap_or(0.8 * bore));
    bearing.film = Some(Film {
        relative_clearance,
        least_thickness: touching.min(share * 0.5e3 * relative_clearance * bore),
    });
    bearing.model = Some(if lacks.is_empty() { "journal_film" } else { "none" });
    let path = format!("bearings.{}", bearing.id);
    assumed.push((
        vec![format!("{path}.film.least_thickness")],
        "placeholder: REXS does not have it; 3 um, less in a small clearance".to_owned(),
    ));
    if lacks.is_empty() {
        return;
    }
    assumed.push((
        lacks.iter().map(|key| format!("{path}.{key}")).collect(),
        "placeholder: the REXS file does not state it; the bearing carries load and has no loss".to_owned(),
    ));
    source.missing(format!(
        "{} ({}): {}; without them its loss is left out (`model: none`)",
        bearing.id,
        bearing.comment,
        lacks.join(", ")
    ));
}

/// Clearance over diameter of a plain bearing. The specification gives the clearance no unit: if a file states none either, the one counts that
/// makes it a clearance of plain bearings.
fn relative_clearance(map: &Map<'_>, component: &Component, bore: f64) -> Option<f64> {
    let source = map.source;
    let stated = source.positive(component, "relative_clearance_plain_bearing", Quantity::Number);
    let possible = |clearance: &f64| CLEARANCES.contains(clearance);
    let id = "diameter_clearance_plain_bearing";
    let of_diameter = || {
        let length = source.positive(component, id, Quantity::Length)?;
        let unit = component.attribute(id).map(|attribute| attribute.unit.trim());
        if !unit.is_none_or(|unit| unit.is_empty() || unit == "none") {
            return Some(length / bore);
        }
        let found = [("mm", 1.0), ("um", 1e-3)]
            .map(|(unit, millimetres)| (unit, length * millimetres / bore))
            .into_iter()
            .find(|(_, relative)| possible(relative));
        let (unit, relative) = found?;
        source.assume(format!(
            "{}: its clearance has no unit; {unit} fits its diameter",
            component.label()
        ));
        Some(relative)
    };
    let found = stated.or_else(of_diameter);
    if let Some(clearance) = found.filter(|clearance| !possible(clearance)) {
        source.note(format!(
            "{}: a relative clearance of {clearance} is none of a plain bearing and was ignored",
            component.label()
        ));
    }
    found.filter(possible)
}

/// Diameter of a part at a place: of its bore, or outside.
fn diameter_near(map: &Map<'_>, part: Option<Id>, at: f64, inner: bool) -> Option<f64> {
    let part = map.source.component(part?)?;
    let sections = super::shafts::sections(map, map.members.of(part.id).unwrap_or(part.id), part);
    let here = sections
        .iter()
        .find(|section| section.from - 1e-6 <= at && at <= section.to + 1e-6)?;
    Some(if inner { here.inner } else { here.outer }).filter(|diameter| *diameter > 0.5)
}

/// True if a bearing between two shafts supports the outer one: `shaft` of a bearing is the one that it supports. Planets and loose gears are
/// supported either way.
fn is_carried(map: &Map<'_>, outer: Id, inner: Id) -> bool {
    let is_free = |member: &Id| map.planets.contains(member) || map.loose.contains_key(member);
    let count = |member: Id| map.housing_bearings.get(&member).copied().unwrap_or(0);
    ![outer, inner].iter().any(is_free) && count(outer) < count(inner)
}

/// The directions in which a bearing takes thrust of its shaft.
fn axial(map: &Map<'_>, component: &Component, sense: f64) -> &'static str {
    let source = map.source;
    let directions = source.word(component, "axial_force_absorption");
    match (directions.as_deref(), sense > 0.0) {
        (Some("both_directions"), _) => "both",
        (Some("positive"), true) | (Some("negative"), false) => "right",
        (Some("negative"), true) | (Some("positive"), false) => "left",
        (Some("no_direction"), _) => "none",
        (Some(other), _) => {
            let other = one_line(other, 40);
            source.note(format!(
                "{}: axial_force_absorption `{other}` is unknown; none was taken",
                component.label()
            ));
            "none"
        }
        (None, _) => {
            source.assume(format!(
                "{}: the file states no axial direction; none was taken",
                component.label()
            ));
            "none"
        }
    }
}

fn lubrication(map: &Map<'_>, component: &Component) -> Option<&'static str> {
    match map.source.word(component, "lubrication_type")?.as_str() {
        "oil_injection" => Some("jet"),
        "oil_air" | "oil_spot" => Some("oil_air"),
        "grease" => Some("grease"),
        // A bath is the default.
        _ => None,
    }
}

/// What the file states.
fn data(map: &Map<'_>, component: &Component, bearing: &mut Bearing) {
    let source = map.source;
    let length = |id: &str| source.positive(component, id, Quantity::Length);
    bearing.bore = length("inner_diameter");
    bearing.outside = length("outer_diameter");
    bearing.width = length("width");
    if let (Some(bore), Some(outside)) = (bearing.bore, bearing.outside)
        && outside <= bore
    {
        source.note(format!(
            "{}: outer_diameter does not exceed inner_diameter; both were ignored",
            component.label()
        ));
        (bearing.bore, bearing.outside) = (None, None);
    }
    let force = |ids: [&str; 2]| {
        ids.into_iter()
            .find_map(|id| source.positive(component, id, Quantity::LoadRating))
    };
    bearing.c = force(["radial_dynamic_load_rating", "axial_dynamic_load_rating"]);
    bearing.c0 = force(["radial_static_load_rating", "axial_static_load_rating"]);
    bearing.pu = source.positive(component, "fatigue_limit_load", Quantity::LoadRating);
    let factor = |id: &str| source.positive(component, id, Quantity::Number);
    let factors = [
        factor("catalogue_value_e"),
        factor("axial_factor_y_2"),
        factor("axial_factor_y_0"),
    ];
    let Some(kind) = source.word(component, "bearing_type") else {
        return;
    };
    let double = source.number(component, "number_of_bearing_rows", Quantity::Number) == Some(2.0);
    bearing.kind = match KINDS.iter().find(|(known, _)| *known == kind) {
        Some((_, Some("deep_groove_ball"))) if double => Some("deep_groove_ball_double_row"),
        Some((_, Some("angular_contact_ball"))) if double => Some("angular_contact_ball_double_row"),
        Some((_, Some(kind))) => Some(kind),
        _ => {
            source.note(format!(
                "{}: gearbox files have no kind for the bearing type `{}`",
                component.label(),
                one_line(&kind, 60)
            ));
            None
        }
    };
    if kind == "radial_self_aligning_roller_bearing" {
        source.assume(format!(
            "{}: its type is described as a spherical roller bearing; some programs write toroidal (CARB) bearings so",
            component.label()
        ));
    }
    // Of radial ball and cylindrical roller bearings the factors depend on the load or are none.
    let has_factors = !matches!(
        bearing.kind,
        Some("deep_groove_ball" | "deep_groove_ball_double_row" | "cylindrical_roller" | "needle_cage")
    );
    if has_factors {
        [bearing.e, bearing.y, bearing.y0] = factors;
    }
}

/// Fills what the catalogue knows of the designation.
fn catalogue(map: &Map<'_>, language: &Language, component: &Component, bearing: &mut Bearing) {
    let source = map.source;
    let Some(written) = source.text(component, "catalogue_designation") else {
        let table = language.catalogue("bearings");
        bearing.known = table
            .and_then(|table| in_name(&component.name, table))
            .map(str::to_owned);
        return;
    };
    let shown = one_line(written, 60);
    let table = language.catalogue("bearings");
    let row = table.and_then(|table| {
        if let Some((name, row)) = table.0.get_key_value(written) {
            return Some((name.as_str(), None, row));
        }
        let read = read_designation(written, table.0.keys().map(String::as_str))?;
        let row = table.0.get(read.base)?;
        Some((read.base, Some(read), row))
    });
    let Some((base, read, row)) = row else {
        bearing.designation = Some(shown.clone());
        bearing.series = bearing.kind.and_then(|kind| series(kind, written)).map(str::to_owned);
        source.note(format!(
            "{}: the designation `{shown}` is not in the catalogue",
            component.label()
        ));
        return;
    };
    let of_row = |key: &str| {
        row.values
            .iter()
            .find(|(known, _)| known == key)
            .map(|(_, value)| value)
    };
    // A row of other dimensions is another bearing.
    let differs = [
        ("bore", bearing.bore),
        ("outside", bearing.outside),
        ("width", bearing.width),
    ]
    .into_iter()
    .any(|(key, stated)| {
        let listed = of_row(key)
            .and_then(Value::as_str)
            .and_then(|text| text.strip_suffix(" mm")?.parse::<f64>().ok());
        matches!((stated, listed), (Some(a), Some(b)) if (a - b).abs() > 0.1)
    });
    let other_kind = matches!((bearing.kind, of_row("kind").and_then(Value::as_str)), (Some(a), Some(b)) if a != b);
    if differs || other_kind {
        bearing.series = bearing.kind.and_then(|kind| series(kind, written)).map(str::to_owned);
        // Under its own name the row would fill what the file omits.
        bearing.designation = Some(format!("{shown} (file)"));
        source.note(format!(
            "{}: the catalogue's `{base}` has another kind or other dimensions than the file's `{shown}`; those of the file count",
            component.label()
        ));
        return;
    }
    bearing.kind = None;
    // Gearbox files read the suffixes.
    if let Some(read) = read {
        source.note(format!("{}: `{shown}`: {}", component.label(), read.words()));
    }
    bearing.designation = Some(shown);
}

/// A designation of the catalogue that the name of a component contains as a word.
fn in_name<'t>(name: &str, table: &'t CatalogueTable) -> Option<&'t str> {
    let words = name
        .split(|c: char| c.is_whitespace() || "()[],;:".contains(c))
        .take(100);
    words
        .filter(|word| word.len() >= 4)
        .find_map(|word| table.0.get_key_value(word).map(|(name, _)| name.as_str()))
}

/// The dimension series of a designation after ISO 15 and ISO 355: its digits without the last two, which are those of the bore.
fn series<'t>(kind: &str, designation: &'t str) -> Option<&'t str> {
    let letters = designation.find(|c: char| c.is_ascii_digit())?;
    let (head, rest) = designation.split_at(letters);
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let of_kind = match kind {
        "deep_groove_ball" => head.is_empty() && (4..=5).contains(&digits),
        "tapered_roller" => head.is_empty() && digits == 5,
        "cylindrical_roller" => matches!(head, "N" | "NU" | "NJ" | "NUP") && (3..=4).contains(&digits),
        _ => false,
    };
    of_kind.then(|| &rest[..digits - 2])
}

/// Kind and sizes that gearbox files need and the file does not have. Such a bearing has no loss.
fn placeholders(
    map: &Map<'_>,
    parts: [Option<Id>; 2],
    component: &Component,
    bearing: &mut Bearing,
    assumed: &mut Vec<(Vec<String>, String)>,
) {
    let from_catalogue = bearing.designation.is_some() && bearing.kind.is_none() && bearing.series.is_none();
    let in_catalogue = from_catalogue
        && bearing
            .designation
            .as_deref()
            .is_some_and(|name| !name.ends_with("(file)"));
    let lacks: Vec<&str> = [
        ("kind", bearing.kind.is_none()),
        ("bore", bearing.bore.is_none()),
        ("outside", bearing.outside.is_none()),
    ]
    .into_iter()
    .filter_map(|(key, lacks)| lacks.then_some(key))
    .collect();
    if in_catalogue && component.attribute("catalogue_designation").is_some() || lacks.is_empty() {
        return;
    }
    bearing.kind.get_or_insert("deep_groove_ball");
    let on_shaft = diameter_near(map, parts[0], bearing.at, false);
    let bore = bearing.bore.or(on_shaft).unwrap_or(PLACEHOLDER_BORE);
    let bore = bearing.outside.map_or(bore, |outside| bore.min(outside / 1.2));
    let around = diameter_near(map, parts[1], bearing.at, true).filter(|outside| *outside > 1.05 * bore);
    let outside = bearing.outside.or(around).unwrap_or(PLACEHOLDER_RATIO * bore);
    (bearing.bore, bearing.outside) = (Some(bore), Some(outside));
    bearing.model = Some("none");
    let path = format!("bearings.{}", bearing.id);
    assumed.push((
        lacks.iter().map(|key| format!("{path}.{key}")).collect(),
        "placeholder: the REXS file does not state it; the bearing carries load and has no loss".to_owned(),
    ));
    map.source.missing(format!(
        "{} ({}): {}; without them its loss is left out (`model: none`)",
        bearing.id,
        bearing.comment,
        lacks.join(", ")
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_of_designations() {
        for (kind, designation, expected) in [
            ("deep_groove_ball", "6305-2Z", Some("63")),
            ("deep_groove_ball", "61906", Some("619")),
            ("deep_groove_ball", "625", None),
            ("tapered_roller", "33014", Some("330")),
            ("tapered_roller", "LM501349", None),
            ("cylindrical_roller", "NUP204-E-XL-TVP2", Some("2")),
            ("cylindrical_roller", "NU1010", Some("10")),
            ("spherical_roller", "22208 E", None),
        ] {
            assert_eq!(series(kind, designation), expected, "{designation}");
        }
    }
}
