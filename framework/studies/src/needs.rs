//! `models --needs`: the inputs of each model beyond those of every gearbox, and their origin in this gearbox.
//!
//! Needs are found by trial: an input is needed if building fails without it.

use std::collections::BTreeMap;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::{DRAGS, HELD, Language};
use gearloss_framework::mechanism::Mechanism as _;
use gearloss_framework::mechanism::bearing::{Bearing, BearingPart};
use gearloss_framework::registry::{Entry, Files, MechanismEntry, from_resolved};
use gearloss_framework::resolve::{CatalogueTable, Choice, Resolved, ValueSource, lookup};
use gearloss_framework::transmission::Transmission;
use serde_json::{Map, Value};

/// An input of a model beyond the inputs of every gearbox.
#[derive(Debug, Clone)]
pub struct Need {
    /// Mechanism of the model.
    pub mechanism: &'static str,
    /// Name of the model.
    pub model: &'static str,
    /// Path of the input, or the components that lack it.
    pub input: String,
    /// Where the gearbox has it from, or what is missing.
    pub origin: String,
}

/// The inputs that the models of all mechanisms, or of one, need in a gearbox.
///
/// # Errors
/// Everything that resolving the gearbox finds.
pub fn needs(language: &Language, gearbox: &Gearbox, only: Option<&str>) -> Result<Vec<Need>, Findings> {
    let resolved = gearbox.resolve(language, &Choice::default())?;
    let mut needs = Vec::new();
    for mechanism in language.registry().mechanisms() {
        let slots = slots(&resolved, mechanism);
        if slots.is_empty() || only.is_some_and(|key| key != mechanism.key) {
            continue;
        }
        let models = language.registry().models(mechanism.key);
        for entry in models.filter(|e| !e.is_user_defined()) {
            let Ok((example, _)) = language.example_of(entry) else {
                continue;
            };
            let rows = inputs(language, gearbox, &resolved, entry, &slots, &example);
            needs.extend(rows.into_iter().map(|(input, origin)| Need {
                mechanism: mechanism.key,
                model: entry.name,
                input,
                origin,
            }));
        }
    }
    Ok(needs)
}

/// What a model of bearing losses lacks in the bearings of a catalogue.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingNeeds {
    /// Name of the model.
    pub model: &'static str,
    /// Number of bearings that it can be used for as they are.
    pub ready: usize,
    /// Reasons with help, and the designations of the other bearings.
    pub lacks: Vec<(String, Vec<String>)>,
}

/// What each linked model of the losses of rolling bearings lacks in a catalogue. The models are built for the bearings, one of each kind, series and set
/// of keys; bearings without a kind are not considered.
///
/// # Errors
/// Values that are no values of a bearing.
pub fn bearing_needs(language: &Language, table: &CatalogueTable) -> Result<Vec<BearingNeeds>, Vec<Diagnostic>> {
    let registry = language.registry();
    let Some(mechanism) = registry.mechanism(Bearing::KEY) else {
        return Ok(Vec::new());
    };
    let mut alike: BTreeMap<String, (Map<String, Value>, Vec<String>)> = BTreeMap::new();
    for (designation, row) in &table.0 {
        let mut part = Map::new();
        for (key, value) in &row.values {
            part.insert(key.clone(), language.checked(value, &format!("bearings.own.{key}"))?);
        }
        let Some(kind) = part.get("kind") else { continue };
        let keys: Vec<&String> = part.keys().collect();
        let sort = format!("{kind} {:?} {keys:?}", part.get("series"));
        alike
            .entry(sort)
            .or_insert_with(|| (part, Vec::new()))
            .1
            .push(designation.clone());
    }
    let mut all = Vec::new();
    for entry in registry
        .models(Bearing::KEY)
        .filter(|entry| !entry.is_user_defined() && entry.name != "none")
    {
        let (model, example) = language.example_of(entry)?;
        // A catalogue has rolling bearings only.
        if from_resolved::<BearingPart>(&example).is_ok_and(|part| !part.kind.rolls()) {
            continue;
        }
        let files = Files::default();
        for (name, text) in entry.files {
            files.put(name, text);
        }
        let mut needs = BearingNeeds {
            model: entry.name,
            ready: 0,
            lacks: Vec::new(),
        };
        for (part, designations) in alike.values() {
            match (mechanism.eval)(registry, &files, &model, &Value::Object(part.clone()), &Map::new()) {
                Ok(_) => needs.ready += designations.len(),
                Err(error) => {
                    let reason = reason(error);
                    match needs.lacks.iter_mut().find(|(known, _)| *known == reason) {
                        Some((_, all)) => all.extend(designations.iter().cloned()),
                        None => needs.lacks.push((reason, designations.clone())),
                    }
                }
            }
        }
        all.push(needs);
    }
    Ok(all)
}

/// What is missing, with the help.
fn reason(error: Diagnostic) -> String {
    match error.help {
        Some(help) => format!("{}; {help}", error.message),
        None => error.message,
    }
}

/// Paths of the model slots of a mechanism, and of the records that its parts are built from.
fn slots(resolved: &Resolved, mechanism: &MechanismEntry) -> Vec<String> {
    let section = match &mechanism.section {
        Some(section) => section.name,
        None if mechanism.key == DRAGS => "meshes",
        None => match HELD.iter().find(|(_, key)| *key == mechanism.key) {
            Some((section, _)) => section,
            None => return Vec::new(),
        },
    };
    let ids = resolved.value.get(section).and_then(Value::as_object);
    ids.into_iter()
        .flatten()
        .map(|(id, _)| format!("{section}.{id}"))
        .collect()
}

fn with_model(resolved: &Resolved, entry: &Entry, slots: &[String], model: &Value, language: &Language) -> Resolved {
    let mut changed = resolved.clone();
    let first = slots[0].split('.').next().unwrap_or_default().to_owned();
    let section = if entry.mechanism == DRAGS {
        if language.fits_scope("gears", model) {
            "gears".to_owned()
        } else {
            "meshes".to_owned()
        }
    } else {
        first
    };
    if entry.mechanism == DRAGS {
        for side in ["gears", "meshes"] {
            for (_, record) in records(&mut changed.value, side) {
                record.insert("drag".to_owned(), Value::Object(serde_json::Map::new()));
            }
        }
    }
    for (_, record) in records(&mut changed.value, &section) {
        if entry.mechanism == DRAGS {
            record.insert("drag".to_owned(), serde_json::json!({ "churning": model }));
        } else {
            record.insert("model".to_owned(), model.clone());
        }
    }
    changed
}

fn records<'a>(
    value: &'a mut Value,
    section: &str,
) -> impl Iterator<Item = (&'a String, &'a mut serde_json::Map<String, Value>)> + use<'a> {
    value
        .get_mut(section)
        .and_then(Value::as_object_mut)
        .into_iter()
        .flatten()
        .filter_map(|(id, record)| record.as_object_mut().map(|record| (id, record)))
}

fn inputs(
    language: &Language,
    gearbox: &Gearbox,
    resolved: &Resolved,
    entry: &Entry,
    slots: &[String],
    model: &Value,
) -> Vec<(String, String)> {
    let with = with_model(resolved, entry, slots, model, language);
    let without = with_model(resolved, entry, slots, &Value::from("none"), language);
    let builds = |resolved: &Resolved| Transmission::new(language, &gearbox.files, resolved);
    let mut rows = Vec::new();
    if let Err(list) = builds(&with) {
        // One row for each distinct reason, with its components.
        let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
        for error in list {
            let place = error.path.split('.').take(2).collect::<Vec<_>>().join(".");
            let text = reason(error);
            match reasons.iter_mut().find(|(reason, _)| *reason == text) {
                Some((_, places)) => places.push(place),
                None => reasons.push((text, vec![place])),
            }
        }
        rows.extend(
            reasons
                .into_iter()
                .map(|(reason, places)| (places.join(", "), format!("missing: {reason}"))),
        );
    }
    let mut candidates = Vec::new();
    for slot in slots {
        leaves(slot, lookup(&resolved.value, slot), &mut candidates);
    }
    leaves("housing", resolved.value.get("housing"), &mut candidates);
    candidates.extend(["housing.section", "housing.clearance"].map(str::to_owned));
    for path in candidates
        .into_iter()
        .filter(|p| !p.contains(".model") && !p.contains(".drag"))
    {
        let remove = |resolved: &Resolved| {
            let mut changed = resolved.clone();
            let (parent, key) = path.rsplit_once('.').unwrap_or(("", &path));
            let parent = format!("/{}", parent.replace('.', "/"));
            if let Some(record) = changed.value.pointer_mut(&parent).and_then(Value::as_object_mut) {
                record.shift_remove(key);
            }
            changed
        };
        let own_fault = |list: Vec<gearloss_framework::document::Diagnostic>| {
            let component = path.split('.').take(2).collect::<Vec<_>>().join(".");
            list.iter()
                .any(|d| d.path.starts_with(&component) || component.starts_with("housing"))
        };
        if builds(&remove(&without)).is_ok()
            && builds(&with).map_or_else(|list| !own_fault(list), |_| true)
            && builds(&remove(&with)).is_err_and(own_fault)
        {
            rows.push((path.clone(), state(gearbox, resolved, &path)));
        }
    }
    if rows.is_empty() {
        rows.push(("none beyond those of every gearbox".to_owned(), "given".to_owned()));
    }
    rows
}

/// Paths of all values below a path.
fn leaves(path: &str, value: Option<&Value>, found: &mut Vec<String>) {
    match value {
        Some(Value::Object(map)) => map
            .iter()
            .for_each(|(key, value)| leaves(&format!("{path}.{key}"), Some(value), found)),
        Some(Value::Null | Value::Array(_)) | None => {}
        Some(_) => found.push(path.to_owned()),
    }
}

fn state(gearbox: &Gearbox, resolved: &Resolved, path: &str) -> String {
    let assumed = resolved
        .value
        .get("assumed")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .any(|entry| {
            entry["paths"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str)
                .any(|pattern| covers(pattern, path))
        });
    match resolved.source_of(path) {
        ValueSource::Catalogue {
            designation,
            confidence,
        } => format!("derived (catalogue {designation}, confidence {confidence})"),
        ValueSource::Network => "derived (network: auto)".to_owned(),
        _ if assumed => "assumed".to_owned(),
        _ if gearbox.places.is_written(path) => "given".to_owned(),
        _ => "default".to_owned(),
    }
}

/// True if a pattern matches a path or a parent of it.
fn covers(pattern: &str, path: &str) -> bool {
    let (pattern, path): (Vec<&str>, Vec<&str>) = (pattern.split('.').collect(), path.split('.').collect());
    pattern.len() <= path.len() && pattern.iter().zip(&path).all(|(p, k)| *p == "*" || p == k)
}
