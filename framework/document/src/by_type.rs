//! Records whose `type` determines their keys: models, analyses.
//!
//! schemars writes them as `oneOf`. Editors cannot determine which alternative is meant: they report errors for the keys of another one,
//! and omit alternatives with required keys from completion. The published schema is therefore one record with the possible types, and a
//! condition for each type: if the type is this, then these are the keys.

use serde_json::{Map, Value, json};

/// Converts every choice among records with a `type` into conditions, recursively.
pub(super) fn choose_by_type(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            object.values_mut().for_each(choose_by_type);
            conditions(object);
        }
        Value::Array(list) => list.iter_mut().for_each(choose_by_type),
        _ => {}
    }
}

fn type_of(record: &Value) -> Option<&str> {
    record.get("properties")?.get("type")?.get("const")?.as_str()
}

fn conditions(object: &mut Map<String, Value>) {
    let is_choice = |variants: &Value| variants.as_array()?.iter().find_map(type_of).map(|_| ());
    if object.get("oneOf").and_then(is_choice).is_none() {
        return;
    }
    // Moved, not copied: records contain the records of nested models.
    let Some(Value::Array(variants)) = object.get_mut("oneOf").map(Value::take) else {
        return;
    };
    let (records, others): (Vec<Value>, Vec<Value>) = variants.into_iter().partition(|v| type_of(v).is_some());
    let mut types = Vec::new();
    let mut branches = Vec::new();
    for record in records {
        let name = type_of(&record).unwrap_or_default();
        let meaning = record.get("description").cloned().unwrap_or_default();
        types.push(json!({ "const": name, "description": meaning }));
        let mut branch = Map::new();
        let is_named = json!({ "properties": { "type": { "const": name } }, "required": ["type"] });
        branch.insert("if".to_owned(), is_named);
        branch.insert("then".to_owned(), record);
        branches.push(Value::Object(branch));
    }
    let mut choice = Map::new();
    choice.insert("type".to_owned(), json!("object"));
    let properties = json!({ "type": { "description": "The type; it determines the other keys.", "oneOf": types } });
    choice.insert("properties".to_owned(), properties);
    choice.insert("required".to_owned(), json!(["type"]));
    choice.insert("allOf".to_owned(), Value::Array(branches));
    if others.is_empty() {
        object.shift_remove("oneOf");
        object.extend(choice);
    } else {
        // The record is first, because editors compare with it if nothing matches.
        let either: Vec<Value> = std::iter::once(Value::Object(choice)).chain(others).collect();
        object.insert("oneOf".to_owned(), Value::Array(either));
    }
}

/// The records by `type` of a published schema that is a choice among them, or that has such an alternative.
pub fn records_by_type(schema: &Value) -> Vec<(&str, &Value)> {
    let alternatives = schema.get("oneOf").and_then(Value::as_array).into_iter().flatten();
    std::iter::once(schema)
        .chain(alternatives)
        .filter_map(|choice| choice.get("allOf")?.as_array())
        .flatten()
        .filter_map(|branch| {
            let record = branch.get("then")?;
            Some((type_of(record)?, record))
        })
        .collect()
}
