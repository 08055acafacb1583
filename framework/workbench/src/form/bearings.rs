//! Details of bearings that a template does not have: internal geometry, contact angle, grease, plain bearings and thrust washers. What is typed becomes
//! keys of the bearing; what stays empty is from the catalogue or estimated.

use std::collections::BTreeMap;
use std::ops::Range;

use gearloss_editor::outline::{self, Content, Node};

use super::fields::{Field, FieldKind, Group, at};

/// A detail: key of the bearing, label, how it is typed, a value, what it means.
type Detail = (&'static str, &'static str, FieldKind, &'static str, &'static str);

/// The details in the order in which they are written. Values of choices that are not stated are empty.
const DETAILS: &[Detail] = {
    use FieldKind::{Choice, Integer, Number, Quantity};
    const RADIAL: &str = "of plain bearings";
    const WASHER: &str = "of thrust washers";
    &[
        (
            "kind",
            "Kind instead of the designation",
            Choice,
            "",
            "a plain bearing in oil needs bore, width, clearance and least film; a thrust washer bore, outside diameter and gap",
        ),
        ("bore", "Bore", Quantity, "40 mm", "of a kind without designation"),
        ("outside", "Outside diameter", Quantity, "60 mm", WASHER),
        ("width", "Width", Quantity, "30 mm", RADIAL),
        (
            "film.relative_clearance",
            "Clearance over diameter",
            Number,
            "0.0015",
            RADIAL,
        ),
        (
            "film.least_thickness",
            "Film below which surfaces touch",
            Quantity,
            "3 um",
            RADIAL,
        ),
        ("film.gap", "Oil gap", Quantity, "50 um", WASHER),
        (
            "contact_angle",
            "Contact angle",
            Quantity,
            "25 deg",
            "of angular contact ball and tapered roller bearings, if not that of the catalogue",
        ),
        (
            "internal.elements",
            "Number of rolling elements",
            Integer,
            "9",
            "for friction from contacts and loads of the elements; estimated if empty",
        ),
        (
            "internal.diameter",
            "Diameter of a rolling element",
            Quantity,
            "9.525 mm",
            "mean diameter of a tapered roller",
        ),
        (
            "internal.length",
            "Length of a roller",
            Quantity,
            "14 mm",
            "that carries load; not of balls",
        ),
        (
            "internal.pitch_diameter",
            "Diameter of the circle of centres",
            Quantity,
            "46 mm",
            "mean of bore and outside diameter if empty",
        ),
        (
            "internal.clearance",
            "Radial clearance in operation",
            Quantity,
            "10 um",
            "negative with preload; not of bearings with a contact angle",
        ),
        (
            "internal.material",
            "Material of the rolling elements",
            Choice,
            "",
            "silicon nitride: a hybrid bearing",
        ),
        (
            "lubrication",
            "Lubrication",
            Choice,
            "",
            "bath if not stated; grease also writes the grease among the lubricants",
        ),
        (
            "grease.filling",
            "Grease in the free space",
            Number,
            "0.3",
            "share of it; of a greased bearing",
        ),
        (
            "grease.churning",
            "Churning of grease",
            Number,
            "1",
            "factor on viscous friction: 1 with channels, 2 to 4 fresh or overfilled",
        ),
    ]
};

/// The values of a choice.
fn choices(key: &str) -> &'static [&'static str] {
    match key {
        "kind" => &["", "plain", "thrust_washer"],
        "internal.material" => &["", "steel", "silicon_nitride"],
        "lubrication" => &["", "bath", "jet", "oil_air", "grease"],
        _ => &[],
    }
}

/// The details of the bearing whose designation a field has.
pub(super) fn details(designation: &Field) -> Option<Group> {
    let bearing = designation.path.strip_suffix(".designation")?;
    let field = |(key, label, kind, example, help): &Detail| Field {
        path: format!("{bearing}.{key}"),
        label: (*label).to_owned(),
        kind: *kind,
        value: String::new(),
        help: (*help).to_owned(),
        choices: choices(key),
        example: Some(example),
    };
    Some(Group {
        title: format!("Details of {}", designation.label.replacen('B', "b", 1)),
        fields: DETAILS.iter().map(field).collect(),
        folded: true,
    })
}

/// What was typed of the details: by bearing, the value of each key, as YAML.
pub(super) type Typed = BTreeMap<String, BTreeMap<String, String>>;

/// Notes a detail at its path.
pub(super) fn note(typed: &mut Typed, path: &str, value: String) {
    let mut parts = path.splitn(3, '.');
    if let (Some("bearings"), Some(bearing), Some(key)) = (parts.next(), parts.next(), parts.next()) {
        typed
            .entry(bearing.to_owned())
            .or_default()
            .insert(key.to_owned(), value);
    }
}

/// The changes of the text of a layout for the details that were typed.
pub(super) fn changes(text: &str, document: &Node, typed: &Typed) -> Vec<(Range<usize>, String)> {
    let written = outline::read(include_str!("bearings.yaml"), None);
    let words = |key: &str| written.get(key).and_then(Node::text).unwrap_or_default();
    let mut changes = Vec::new();
    let mut is_greased = false;
    for (bearing, values) in typed {
        let Some(node) = at(document, &format!("bearings.{bearing}")) else {
            continue;
        };
        let Content::Map { entries, flow: true } = &node.content else {
            continue;
        };
        let kind = values
            .get("kind")
            .map(|kind| words(kind))
            .filter(|words| !words.is_empty());
        if let (Some(kind), Some(entry)) = (kind, entries.iter().find(|entry| entry.key == "designation")) {
            changes.push((entry.span.start..entry.value.span.end, kind.to_owned()));
        }
        let mut keys: Vec<(&str, Vec<String>)> = Vec::new();
        for (key, ..) in DETAILS.iter().filter(|(key, ..)| *key != "kind") {
            let Some(value) = values.get(*key) else { continue };
            let (first, entry) = match key.split_once('.') {
                Some((first, second)) => (first, format!("{second}: {value}")),
                None if *key == "lubrication" && value == "grease" => {
                    is_greased = true;
                    (*key, words("grease").to_owned())
                }
                None => (*key, format!("{key}: {value}")),
            };
            match keys.iter_mut().find(|(known, _)| *known == first) {
                Some((_, entries)) => entries.push(entry),
                None => keys.push((first, vec![entry])),
            }
        }
        let is_nested = |first: &str| {
            DETAILS
                .iter()
                .any(|(key, ..)| key.split_once('.').is_some_and(|(own, _)| own == first))
        };
        let added = keys.iter().map(|(first, entries)| {
            let entries = entries.join(", ");
            if is_nested(first) {
                format!(", {first}: {{ {entries} }}")
            } else {
                format!(", {entries}")
            }
        });
        let added: String = added.collect();
        if let Some(end) = text[node.span.clone()].rfind('}').filter(|_| !added.is_empty()) {
            let end = node.span.start + text[node.span.start..node.span.start + end].trim_end().len();
            changes.push((end..end, added));
        }
    }
    if is_greased && let Some(place) = text.find("#grease: ") {
        changes.push((place..place + 1, String::new()));
    }
    changes
}
