//! Parameters of a study, and analyses that refer to them by name.

use schemars::JsonSchema;
use serde_json::{Map, Value};

use super::IdentifiedEntry;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::{Diagnostic, did_you_mean};

/// Parameters as in `identify`.
// Only its schema is used: names are replaced before the study is read into types.
#[derive(JsonSchema)]
#[serde(untagged)]
pub enum NamesOrParameters {
    /// Names of parameters from `parameters` of the study.
    #[schemars(extend("x-refers-to" = "parameters"))]
    Names(#[schemars(length(min = 1))] Vec<String>),
    /// The parameters by name.
    Own(Ordered<IdentifiedEntry>),
}

/// One quantity with its range, as in other analyses.
// Only its schema is used, as above.
#[derive(JsonSchema)]
#[serde(untagged)]
pub enum NameOr<T> {
    /// Name of a parameter from `parameters` of the study; its range is `from` and `to`.
    #[schemars(extend("x-refers-to" = "parameters"))]
    Name(String),
    /// The quantity and its range.
    Own(T),
}

/// Keys of a parameter that define a range.
const OF_RANGE: [&str; 6] = ["path", "paths", "values", "tie", "from", "to"];

/// The key of an analysis whose entries may be names of parameters of the study, and what an entry then receives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKey {
    /// The whole parameter, by its name; see [`NamesOrParameters`].
    Whole(&'static str),
    /// The path and range of the parameter, in a list; see [`NameOr`].
    Range(&'static str),
}

/// References to parameters: the path in the analysis, and the path under `parameters`.
pub(super) type TakenOver = Vec<(String, String)>;

/// The path under `parameters` of a key below an analysis, if it refers to a parameter.
pub(super) fn written_at(taken_over: &TakenOver, path: &str) -> Option<String> {
    taken_over.iter().find_map(|(at, from)| {
        let rest = path.strip_prefix(at.as_str())?;
        (rest.is_empty() || rest.starts_with('.')).then(|| format!("{from}{rest}"))
    })
}

/// Replaces names of parameters of a walked study by the parameters, in the key that each type of analysis has for them.
///
/// # Errors
/// Every unknown name, and every parameter without both ends if a range is needed.
pub(super) fn replace_names(
    study: &mut Value,
    key_of: impl Fn(&str) -> Option<ParameterKey>,
) -> Result<TakenOver, Vec<Diagnostic>> {
    let stated = study.get("parameters").and_then(Value::as_object).cloned();
    let stated = stated.unwrap_or_default();
    let (mut found, mut taken_over) = (Vec::new(), Vec::new());
    let analyses = study.get_mut("analyses").and_then(Value::as_object_mut);
    for (name, analysis) in analyses.into_iter().flatten() {
        let kind = analysis.get("type").and_then(Value::as_str);
        let (key, identifies) = match kind.and_then(&key_of) {
            Some(ParameterKey::Whole(key)) => (key, true),
            Some(ParameterKey::Range(key)) => (key, false),
            None => continue,
        };
        let place = format!("analyses.{name}.{key}");
        let Some(written) = analysis.get_mut(key) else { continue };
        let Some(list) = written.as_array_mut() else { continue };
        let mut named = Map::new();
        for (i, entry) in list.iter_mut().enumerate() {
            let Some(parameter) = entry.as_str().map(str::to_owned) else {
                continue;
            };
            let entry_place = format!("{place}.{i}");
            let at = if identifies {
                format!("{place}.{parameter}")
            } else {
                entry_place.clone()
            };
            taken_over.push((at, format!("parameters.{parameter}")));
            let place = entry_place;
            match stated.get(&parameter) {
                None => found.push(unknown(&place, &parameter, &stated)),
                Some(_) if identifies && named.contains_key(&parameter) => {
                    found.push(Diagnostic::error(place, format!("`{parameter}` is listed twice")).help("list it once"));
                }
                Some(whole) if identifies => {
                    named.insert(parameter, whole.clone());
                }
                Some(whole) => match range(&parameter, whole) {
                    Ok(range) => *entry = range,
                    Err(fault) => found.push(Diagnostic { path: place, ..fault }),
                },
            }
        }
        if identifies {
            *written = Value::Object(named);
        }
    }
    if found.is_empty() { Ok(taken_over) } else { Err(found) }
}

fn unknown(place: &str, name: &str, stated: &Map<String, Value>) -> Diagnostic {
    let names: Vec<&str> = stated.keys().map(String::as_str).collect();
    let error = Diagnostic::error(place, format!("the study has no parameter `{name}`"));
    match did_you_mean(name, names.iter().copied()) {
        Some(close) => error.help(format!("write `{close}`")),
        None if names.is_empty() => error.help(format!(
            "state it: `parameters: {{ {name}: {{ path: ..., from: ..., to: ... }} }}`"
        )),
        None => error.help(format!("use one of {}, or add it under `parameters`", names.join(", "))),
    }
}

/// The range of a parameter.
fn range(name: &str, whole: &Value) -> Result<Value, Diagnostic> {
    let stated = |key: &str| whole.get(key).is_some_and(|value| !value.is_null());
    if stated("over") {
        let message = format!("`{name}` has several values over torque, but a range is needed");
        return Err(Diagnostic::error("", message).help("write the quantity with its own range"));
    }
    // Rows are a range of their own.
    let rows = whole
        .get("values")
        .and_then(Value::as_array)
        .is_some_and(|rows| !rows.is_empty());
    let ends = stated("from") && stated("to");
    if !rows && !ends {
        let message = format!("the parameter `{name}` states no range");
        return Err(Diagnostic::error("", message).help(format!("give `parameters.{name}` both `from` and `to`")));
    }
    let is_empty = |key: &str| whole[key].as_array().is_some_and(Vec::is_empty);
    let stated_keys = OF_RANGE.iter().filter(|key| stated(key) && !is_empty(key));
    Ok(stated_keys
        .map(|key| ((*key).to_owned(), whole[*key].clone()))
        .collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::json;

    use super::*;

    fn study(parameters: Value, analysis: Value) -> Value {
        json!({ "parameters": parameters, "analyses": { "a": analysis } })
    }

    fn key_of(kind: &str) -> Option<ParameterKey> {
        match kind {
            "identify" => Some(ParameterKey::Whole("parameters")),
            "uncertainty" => Some(ParameterKey::Range("inputs")),
            "sensitivity" => Some(ParameterKey::Range("parameters")),
            _ => None,
        }
    }

    #[test]
    fn names_give_way_to_what_they_stand_for() {
        let whole = json!({ "path": "p", "from": "1 mm", "to": "2 mm", "scale": "log", "start": null });
        let mut identify = study(
            json!({ "x": whole }),
            json!({ "type": "identify", "parameters": ["x"] }),
        );
        replace_names(&mut identify, key_of).unwrap();
        assert_eq!(identify["analyses"]["a"]["parameters"]["x"], whole);
        let stated = json!({ "path": "q", "percent": 5.0 });
        let mut uncertainty = study(
            json!({ "x": whole }),
            json!({ "type": "uncertainty", "inputs": ["x", stated] }),
        );
        let taken_over = replace_names(&mut uncertainty, key_of).unwrap();
        let written = |path: &str| written_at(&taken_over, path);
        assert_eq!(
            written("analyses.a.inputs.0.from").as_deref(),
            Some("parameters.x.from")
        );
        assert_eq!(written("analyses.a.inputs.01"), None);
        let range = json!({ "path": "p", "from": "1 mm", "to": "2 mm" });
        assert_eq!(uncertainty["analyses"]["a"]["inputs"], json!([range, stated]));
    }

    #[test]
    fn every_wrong_name_is_found_at_once() {
        let stated = json!({ "x": { "path": "p", "from": 1 }, "y": { "path": "p", "from": 1, "to": 2, "over": {} } });
        let mut sensitivity = study(
            stated.clone(),
            json!({ "type": "sensitivity", "parameters": ["x", "z", "y"] }),
        );
        let found = replace_names(&mut sensitivity, key_of).unwrap_err();
        let words: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(found.len(), 3, "{words:?}");
        assert!(
            words[0].contains("states no range") && words[0].starts_with("analyses.a.parameters.0"),
            "{words:?}"
        );
        assert!(words[1].contains("no parameter `z`"), "{words:?}");
        assert!(words[2].contains("several values over torque"), "{words:?}");
        let mut identify = study(stated, json!({ "type": "identify", "parameters": ["x", "x"] }));
        assert!(
            replace_names(&mut identify, key_of).unwrap_err()[0]
                .message
                .contains("twice")
        );
    }
}
