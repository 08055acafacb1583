//! Paths into the resolved document: keys joined by dots; `*` matches one key.

use serde_json::Value;

use crate::codes;
use crate::document::{Diagnostic, did_you_mean};

/// The value at a path.
pub fn lookup<'a>(value: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(value, |value, key| step(value, key))
}

fn step<'a>(value: &'a Value, key: &str) -> Option<&'a Value> {
    match value {
        Value::Object(map) => map.get(key),
        Value::Array(list) => list.get(key.parse::<usize>().ok()?),
        _ => None,
    }
}

/// True if a pattern matches a path or one above it; `*` matches any key.
pub fn meets(pattern: &str, path: &str) -> bool {
    let mut keys = path.split('.');
    pattern == path
        || pattern
            .split('.')
            .all(|part| keys.next().is_some_and(|key| part == "*" || part == key))
}

/// All paths that a pattern matches, in the order of the document. The last key may be missing if its parent exists: the schema
/// then decides whether it may be written.
pub fn matches(value: &Value, pattern: &str) -> Vec<String> {
    let keys: Vec<&str> = pattern.split('.').collect();
    let mut found = Vec::new();
    descend(value, &keys, &mut String::new(), &mut found);
    found
}

fn descend(value: &Value, keys: &[&str], path: &mut String, found: &mut Vec<String>) {
    let Some((key, rest)) = keys.split_first() else {
        found.push(path.clone());
        return;
    };
    let mut visit = |key: &str, value: &Value| {
        let length = path.len();
        if length > 0 {
            path.push('.');
        }
        path.push_str(key);
        descend(value, rest, path, found);
        path.truncate(length);
    };
    match value {
        Value::Object(map) if *key == "*" => map.iter().for_each(|(key, value)| visit(key, value)),
        Value::Object(map) => match map.get(*key) {
            Some(value) => visit(key, value),
            None if rest.is_empty() => visit(key, &Value::Null),
            None => {}
        },
        Value::Array(list) if *key == "*" => list
            .iter()
            .enumerate()
            .for_each(|(i, value)| visit(&i.to_string(), value)),
        Value::Array(list) => {
            if let Some(value) = key.parse::<usize>().ok().and_then(|i| list.get(i)) {
                visit(key, value);
            }
        }
        _ => {}
    }
}

/// The value at a path, to be changed.
pub(crate) fn lookup_mut<'a>(value: &'a mut Value, path: &str) -> Option<&'a mut Value> {
    path.split('.').try_fold(value, |value, key| match value {
        Value::Object(map) => map.get_mut(key),
        Value::Array(list) => list.get_mut(key.parse::<usize>().ok()?),
        _ => None,
    })
}

/// Writes a value at a path whose parent exists; otherwise false.
pub(super) fn write(value: &mut Value, path: &str, new: Value) -> bool {
    let (parent, key) = match path.rsplit_once('.') {
        Some((parent, key)) => (lookup_mut(value, parent), key),
        None => (Some(value), path),
    };
    match parent {
        Some(Value::Object(map)) => {
            map.insert(key.to_owned(), new);
            true
        }
        Some(Value::Array(list)) => match key.parse::<usize>().ok().and_then(|i| list.get_mut(i)) {
            Some(place) => {
                *place = new;
                true
            }
            None => false,
        },
        _ => false,
    }
}

/// The file of a table, for a path to its values.
fn file_of<'a>(at: &'a Value, path: &str, key: &str) -> Option<&'a str> {
    if path.rsplit('.').next() == Some("file") {
        return at.as_str();
    }
    let means_values = ["values", "table", "axes"].contains(&key) || key.parse::<usize>().is_ok();
    at.get("file").and_then(Value::as_str).filter(|_| means_values)
}

/// The error for a pattern without a match: names the first key that fails.
pub fn no_match(value: &Value, pattern: &str) -> Diagnostic {
    let mut at = value;
    let mut good = String::new();
    for key in pattern.split('.') {
        let next = if key == "*" {
            at.as_object()
                .and_then(|m| m.values().next())
                .or_else(|| at.as_array().and_then(|list| list.first()))
        } else {
            step(at, key)
        };
        let Some(next) = next else {
            if let Some(file) = file_of(at, &good, key) {
                let error = missing(pattern, format!("the values of the table are in the file `{file}`"));
                return error.help(
                    "only values of the document have paths: write the table there, as `axes:` and `values:` of `type: table` in \
                     place of `file:`",
                );
            }
            if let Some(list) = at.as_array() {
                let last = list.len().saturating_sub(1);
                let error = missing(pattern, format!("`{good}` is a list and has no entry `{key}`"));
                return error.help(format!("write a number from 0 to {last}, or `*` for all"));
            }
            let place = if good.is_empty() {
                "the resolved document".to_owned()
            } else {
                format!("`{good}`")
            };
            let error = missing(pattern, format!("{place} has no `{key}`"));
            let keys: Vec<&str> = at.as_object().into_iter().flatten().map(|(k, _)| k.as_str()).collect();
            if ["models", "model_sets"].contains(&key) {
                return error.help(
                    "in the resolved document each component has its own model: write `meshes.*.model.x_l`, for example",
                );
            }
            let error = if keys.is_empty() {
                error
            } else {
                error.note(format!("available: {}", keys.join(", ")))
            };
            return match did_you_mean(key, keys.iter().copied()) {
                Some(close) => error.help(format!("write `{close}`")),
                None => error.help("`gearloss check --resolved` prints every path"),
            };
        };
        if !good.is_empty() {
            good.push('.');
        }
        good.push_str(key);
        at = next;
    }
    missing(pattern, "the path matches nothing")
}

/// A path that the resolved description does not have.
fn missing(pattern: &str, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(pattern, message).code(codes::UNKNOWN_PATH)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_wildcard_meets_all_and_an_absent_last_key_its_parent() {
        let value = json!({ "bearings": { "B1": { "bore": 1.0 }, "B2": { "bore": 2.0 } }, "axis": [1.0, 2.0] });
        assert_eq!(
            matches(&value, "bearings.*.bore"),
            ["bearings.B1.bore", "bearings.B2.bore"]
        );
        assert_eq!(matches(&value, "bearings.B1.c0"), ["bearings.B1.c0"]);
        assert_eq!(matches(&value, "axis.1"), ["axis.1"]);
        assert!(matches(&value, "seals.D1.diameter").is_empty());
    }

    #[test]
    fn a_path_that_meets_nothing_names_the_first_bad_key() {
        let value = json!({ "bearings": { "left_one": { "bore": 1.0 } } });
        let error = no_match(&value, "bearings.left_on.bore");
        assert!(
            error.message.contains("`bearings` has no `left_on`"),
            "{}",
            error.message
        );
    }

    #[test]
    fn entries_of_lists_have_paths_and_those_of_files_have_none() {
        let value = json!({ "seals": { "D1": { "model": { "type": "table", "values": [1.0, 2.0] } },
                                       "D2": { "model": { "type": "table", "file": "d2.csv" } } } });
        assert_eq!(
            matches(&value, "seals.D1.model.values.*"),
            ["seals.D1.model.values.0", "seals.D1.model.values.1"]
        );
        let message = |path: &str| {
            let error = no_match(&value, path);
            format!("{}; {}", error.message, error.help.unwrap_or_default())
        };
        assert_eq!(
            message("seals.D1.model.values.2"),
            "`seals.D1.model.values` is a list and has no entry `2`; write a number from 0 to 1, or `*` for all"
        );
        for path in [
            "seals.D2.model.values.1",
            "seals.D2.model.table.values.1",
            "seals.D2.model.file.1",
        ] {
            assert!(
                message(path).contains("the values of the table are in the file `d2.csv`; only values of the document")
            );
        }
    }
}
