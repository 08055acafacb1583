//! From generated schemas to the published one: quantities may have units, records are closed, defaults are in the documented unit, and
//! error messages for editors are added.

use serde_json::{Map, Value, json};

use super::by_type::choose_by_type;
use super::unit::{Dimension, Unit};

/// Pattern of ids. Words that many YAML readers convert into booleans are excluded.
pub(super) const ID: &str = "^(?!([yY]|[nN]|[yY]es|YES|[nN]o|NO|[oO]n|ON|[oO]ff|OFF|[tT]rue|TRUE|[fF]alse|FALSE|[nN]ull|NULL)$)[A-Za-z][A-Za-z0-9_]*$";

/// Names of gear states: ids that may start with a digit.
pub(super) const STATE_ID: &str = "^(?!([yY]|[nN]|[yY]es|YES|[nN]o|NO|[oO]n|ON|[oO]ff|OFF|[tT]rue|TRUE|[fF]alse|FALSE|[nN]ull|NULL)$)[A-Za-z0-9][A-Za-z0-9_]*$";

/// Mark of a map in a generated schema whose ids may start with a digit.
const DIGITS_FIRST: &str = "x-digits-first";

/// Editor message for an invalid name of a gear state.
const NO_STATE_ID: &str = "The name of a gear consists of letters, digits and `_`; many YAML readers treat words such as `on`, `no` and `y` as booleans.";

/// Editor message for an invalid id.
const NO_ID: &str = "An id starts with a letter and consists of letters, digits and `_`. Words such as `on`, `no` and `y` are booleans to \
                     many YAML readers.";

/// Mark of a number in a generated schema that is in the unit of something else, so that `%` has no meaning.
const BARE: &str = "x-bare";

/// Publishes a composed schema.
pub fn publish(mut schema: Value) -> Value {
    visit(&mut schema, None, false);
    choose_by_type(&mut schema);
    schema
}

/// Visits a schema with the unit of the list or choice that contains it, and whether its number is bare.
fn visit(schema: &mut Value, inherited: Option<&'static Unit>, is_bare: bool) {
    let Some(object) = schema.as_object_mut() else { return };
    let is_root = has(object, "$schema");
    object.retain(|key, _| key != "format" && (key != "title" || is_root));
    drop_null(object);
    let is_bare = is_bare || (has(object, BARE) && object.shift_remove(BARE).is_some());
    let unit = object
        .get("description")
        .and_then(Value::as_str)
        .and_then(Unit::of_doc)
        .or(inherited);
    for (key, inner) in object.iter_mut() {
        match (key.as_str(), inner) {
            ("oneOf" | "anyOf", Value::Array(list)) => list.iter_mut().for_each(|inner| visit(inner, unit, is_bare)),
            ("allOf", Value::Array(list)) => list.iter_mut().for_each(|inner| visit(inner, None, false)),
            ("items", items) => visit(items, unit, is_bare),
            ("properties" | "definitions", Value::Object(named)) => {
                named.values_mut().for_each(|inner| visit(inner, None, false));
            }
            _ => {}
        }
    }
    let is = |object: &Map<String, Value>, name: &str| object.get("type").and_then(Value::as_str) == Some(name);
    if is(object, "number") || is(object, "integer") {
        quantity(object, unit, is_bare);
    } else if is(object, "object") {
        record(object);
    }
    let default = match (object.get("default"), unit) {
        (Some(Value::Null), _) => Some(None),
        // The fields of a record have their own defaults.
        (Some(Value::Object(_)), _) => Some(Some(json!({}))),
        (Some(value), Some(unit)) if !is(object, "integer") => Some(Some(in_unit(value, unit))),
        _ => None,
    };
    match default {
        Some(Some(value)) => {
            object.insert("default".to_owned(), value);
        }
        Some(None) => {
            object.shift_remove("default");
        }
        None => {}
    }
}

/// Whether a schema has a key. It has so few keys that comparing them is faster than a lookup.
fn has(object: &Map<String, Value>, key: &str) -> bool {
    object.keys().any(|known| known == key)
}

/// `Option` allows null; in a document an optional key is omitted instead.
fn drop_null(object: &mut Map<String, Value>) {
    // Null is among the alternatives of a list.
    if !object.values().any(Value::is_array) {
        return;
    }
    if let Some(types) = object.get_mut("type").and_then(Value::as_array_mut) {
        types.retain(|t| t != "null");
        if types.len() == 1 {
            let only = types.remove(0);
            object.insert("type".to_owned(), only);
        }
    }
    if let Some(variants) = object.get_mut("anyOf").and_then(Value::as_array_mut) {
        variants.retain(|v| v.get("type").and_then(Value::as_str) != Some("null"));
        if variants.len() == 1 {
            let only = variants.remove(0);
            object.shift_remove("anyOf");
            if object.is_empty() {
                if let Value::Object(inner) = only {
                    *object = inner;
                }
            } else {
                object.insert("allOf".to_owned(), json!([only]));
            }
        }
    }
    if let Some(values) = object.get_mut("enum").and_then(Value::as_array_mut) {
        values.retain(|v| !v.is_null());
    }
}

fn quantity(object: &mut Map<String, Value>, unit: Option<&'static Unit>, is_bare: bool) {
    let Some(unit) = unit else { return };
    object.insert("x-unit".to_owned(), json!(unit.symbol));
    if object.get("type").and_then(Value::as_str) != Some("number") {
        return;
    }
    if !is_bare {
        object.insert("type".to_owned(), json!(["number", "string"]));
        object.insert("pattern".to_owned(), json!(unit.pattern()));
    }
    let message = if is_bare {
        "Expected a plain number, without unit and quotes.".to_owned()
    } else if unit.dimension == Dimension::None {
        "Expected a plain number without quotes, or a percentage such as `95 %`.".to_owned()
    } else {
        let symbols: Vec<&str> = Unit::symbols(unit.dimension).collect();
        format!(
            "Expected {} with its unit, such as `20 {}`, or a bare number in {}. Usual units: {}.",
            unit.dimension.with_article(),
            unit.symbol,
            unit.symbol,
            symbols.join(", ")
        )
    };
    // Not part of JSON Schema; the language servers of YAML and JSON show it for a wrong type or a text that does not match.
    object.insert("errorMessage".to_owned(), json!(message));
}

fn record(object: &mut Map<String, Value>) {
    match object.get_mut("additionalProperties") {
        None => {
            object.insert("additionalProperties".to_owned(), json!(false));
        }
        Some(Value::Bool(false)) => {}
        Some(inner) => {
            visit(inner, None, false);
            let anything = matches!(inner, Value::Bool(true)) || inner.as_object().is_some_and(Map::is_empty);
            if !anything {
                let names = if object.remove(DIGITS_FIRST).is_some() {
                    json!({ "pattern": STATE_ID, "title": "gear", "patternErrorMessage": NO_STATE_ID })
                } else {
                    json!({ "pattern": ID, "title": "id", "patternErrorMessage": NO_ID })
                };
                object.insert("propertyNames".to_owned(), names);
            }
        }
    }
}

fn in_unit(value: &Value, unit: &Unit) -> Value {
    match value {
        Value::Number(n) => {
            let x = unit.from_si(n.as_f64().unwrap_or(0.0));
            // The conversion of a default such as 20 deg from radians has a rounding error in its last digit.
            let rounded = (x * 1e9).round() / 1e9;
            json!(if (rounded - x).abs() <= 1e-12 * x.abs() {
                rounded
            } else {
                x
            })
        }
        Value::Array(list) => Value::Array(list.iter().map(|v| in_unit(v, unit)).collect()),
        other => other.clone(),
    }
}
