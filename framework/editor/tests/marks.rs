//! The schema states what a text names. A new text of a document is either marked, or listed as free here.

use std::collections::BTreeSet;

use gearloss_framework::language::Kind;
use serde_json::Value;

use super::common::language;

/// Keys of texts that name nothing of a document: titles, notes, formulas, columns, conditions, units, names that others may use.
const FREE: &str = "title source question note about because name series formula c_m rows units column columns ColumnEntry time \
                    temperatures where by HoldOutEntry hold_out rating property slot \
                    sheet group missing element leave_out";

fn unmarked(
    schema: &Value,
    key: &str,
    marked: bool,
    definitions: &Value,
    seen: &mut BTreeSet<(String, bool)>,
    found: &mut BTreeSet<String>,
) {
    let Some(object) = schema.as_object() else { return };
    let marks = ["x-refers-to", "x-defines", "x-keys"];
    let marked = marked || marks.iter().any(|mark| object.contains_key(*mark));
    if let Some(name) = object
        .get("$ref")
        .and_then(Value::as_str)
        .and_then(|r| r.rsplit('/').next())
    {
        if seen.insert((format!("{key}/{name}"), marked)) {
            let key = if name.ends_with("Entry") && key.is_empty() {
                name
            } else {
                key
            };
            unmarked(&definitions[name], key, marked, definitions, seen, found);
        }
        return;
    }
    let is_text = object.get("type").is_some_and(|kind| kind == "string");
    if is_text && !marked && !object.contains_key("enum") && !object.contains_key("const") {
        found.insert(key.to_owned());
    }
    for list in ["oneOf", "anyOf", "allOf"] {
        for inner in object.get(list).and_then(Value::as_array).into_iter().flatten() {
            unmarked(
                inner.get("then").unwrap_or(inner),
                key,
                marked,
                definitions,
                seen,
                found,
            );
        }
    }
    if let Some(items) = object.get("items") {
        unmarked(items, key, marked, definitions, seen, found);
    }
    for (name, inner) in object
        .get("properties")
        .and_then(Value::as_object)
        .into_iter()
        .flatten()
    {
        unmarked(inner, name, false, definitions, seen, found);
    }
    if let Some(inner) = object.get("additionalProperties") {
        unmarked(inner, key, marked, definitions, seen, found);
    }
}

#[test]
fn every_text_is_marked_or_free() {
    let free: BTreeSet<&str> = FREE.split_whitespace().collect();
    let mut found = BTreeSet::new();
    for kind in [Kind::Gearbox, Kind::Study] {
        let schema = language().published(kind);
        unmarked(
            &schema,
            "",
            false,
            &schema["definitions"],
            &mut BTreeSet::new(),
            &mut found,
        );
    }
    let new: Vec<&String> = found.iter().filter(|key| !free.contains(key.as_str())).collect();
    assert!(
        new.is_empty(),
        "{new:?}: add `#[schemars(extend(\"x-refers-to\" = \"SECTION\"))]` to the field, or its key to the free texts of this test"
    );
}
