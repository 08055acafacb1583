//! From the checked description to the resolved one: still pure data with paths.
//!
//! Every component gets its own model, catalogue values and defaults; `models` and `model_sets` are then removed. A written path is
//! an override of this document, so a change is: write it, resolve again, build again.

mod bearing_designation;
mod bearing_series;
mod catalogue;
mod choice;
mod designation;
mod follow;
mod linked_catalogue;
mod network;
mod paths;
mod ratings;

use std::collections::BTreeMap;

use serde_json::{Map, Value};

pub use bearing_designation::{Designation, read as read_designation};
pub use bearing_series::{BasicDesignation, basic_designation};
pub use catalogue::{CatalogueHits, CatalogueRow, CatalogueTable, ESTIMATED};
pub use choice::{Choice, ModelSet, OWN_MODELS, called_own, expand_set, sets_of};
pub use designation::known_start;
pub use linked_catalogue::LinkedCatalogue;
pub use paths::{lookup, matches};

pub use paths::{meets, no_match};
pub use ratings::RATINGS;

pub(crate) use linked_catalogue::Fault;
pub(crate) use paths::lookup_mut;

use crate::codes;
use crate::document::{Diagnostic, did_you_mean};
use crate::language::{DIFFERENTIALS, DRAGS, HEAT, Language};
use crate::registry::Files;

/// Origin of a value of the resolved document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ValueSource {
    /// Written in the document, or the default of an omitted key; the positions of the check distinguish them.
    Document,
    /// From a catalogue.
    Catalogue {
        /// Designation of the row.
        designation: String,
        /// The row's confidence.
        confidence: String,
    },
    /// From `models`, by mechanism.
    Models,
    /// From a set of models.
    Set(String),
    /// From `surface` of the gearbox.
    Surface,
    /// From the recipe behind `network: auto`.
    Network,
    /// From an override.
    Override,
}

/// The resolved document.
#[derive(Debug, Clone, Default)]
pub struct Resolved {
    /// Complete plain data in SI.
    pub value: Value,
    /// Origins of values by path; a path covers everything below it. Values that are not listed come from the document.
    pub sources: BTreeMap<String, ValueSource>,
    /// Models of the set in use that no component uses, because each has its own or there is none.
    pub unreached: Vec<String>,
    /// Components without a chosen model, not even `none`: their loss is zero. One line for each section.
    pub without: Vec<String>,
    /// Designations with suffixes, and what they were read as. One line for each.
    pub designations: Vec<String>,
}

impl Resolved {
    /// Origin of the value at a path.
    pub fn source_of(&self, path: &str) -> &ValueSource {
        let mut end = path.len();
        loop {
            if let Some(source) = self.sources.get(&path[..end]) {
                return source;
            }
            match path[..end].rfind('.') {
                Some(dot) => end = dot,
                None => return &ValueSource::Document,
            }
        }
    }
}

/// Resolves a checked description with a model set and overrides.
///
/// # Errors
/// All findings at once: unknown designations, sets that do not exist, overrides that match nothing or are invalid.
pub fn resolve(
    language: &Language,
    files: &Files,
    walked: &Value,
    choice: &Choice,
) -> Result<Resolved, Vec<Diagnostic>> {
    Draft::new(language, files, walked, choice).finish(language, &[]).0
}

/// True for an override that is applied before the catalogues, which depend on it.
pub(crate) fn precedes_catalogues(pattern: &str) -> bool {
    pattern.ends_with(".designation")
}

/// One place that an override has written: the number of the override, and the path.
pub(crate) type Written = (usize, String);

/// A description with everything that a choice states, but before a network is generated: further overrides may follow.
#[derive(Debug, Clone)]
pub(crate) struct Draft {
    resolved: Resolved,
    /// Overrides inside a network: they are applied after it is generated.
    inside: Vec<(String, Value)>,
    /// Paths and formulas of values that follow others.
    follows: Vec<(String, String)>,
    /// Patterns of the overrides of the choice.
    overridden: Vec<String>,
    found: Vec<Diagnostic>,
}

impl Draft {
    pub fn new(language: &Language, files: &Files, walked: &Value, choice: &Choice) -> Self {
        let mut found = Vec::new();
        let mut value = walked.clone();
        let mut sources = BTreeMap::new();
        let mut unreached = Vec::new();

        let set = match &choice.set {
            Some(name) => choice::find(language, &value, &choice.sets, name, &mut found).map(|set| (name.clone(), set)),
            None => None,
        };
        let of_set = set.iter().flat_map(|(_, set)| &set.changes);
        let (first, later): (Vec<_>, Vec<_>) = own_overrides(&value)
            .into_iter()
            .chain(of_set.map(|(path, value, _)| (path.clone(), value.clone())))
            .chain(choice.overrides.iter().cloned())
            .partition(|(path, _)| precedes_catalogues(path));
        apply(language, &mut value, first.iter().enumerate(), &mut sources, &mut found);
        let mut designations = Vec::new();
        catalogue::fill(language, files, &mut value, &mut sources, &mut designations, &mut found);
        surfaces(&mut value, &mut sources);

        let defaults = value.get("models").cloned().unwrap_or(Value::Null);
        let without = give_models(
            language,
            &mut value,
            &defaults,
            set.as_ref(),
            &mut sources,
            &mut unreached,
        );
        if let Some(document) = value.as_object_mut() {
            for key in ["models", "model_sets", "extends", "set"] {
                document.shift_remove(key);
            }
        }
        // A generated network depends on all other changes, and changes inside it are applied afterwards.
        let (inside, later): (Vec<_>, Vec<_>) = later.into_iter().partition(|(path, _)| network::meets_inside(path));
        ratings::fill(
            language,
            &mut value,
            later.iter().map(|(path, _)| path.as_str()),
            &mut found,
        );
        apply(language, &mut value, later.iter().enumerate(), &mut sources, &mut found);
        Self {
            resolved: Resolved {
                value,
                sources,
                unreached,
                without,
                designations,
            },
            inside,
            follows: choice.follows.clone(),
            overridden: choice.overrides.iter().map(|(pattern, _)| pattern.clone()).collect(),
            found,
        }
    }

    /// The resolved document with further overrides, of which none [precedes the catalogues](precedes_catalogues), and where each of them
    /// was written.
    pub fn finish(
        self,
        language: &Language,
        more: &[(String, Value)],
    ) -> (Result<Resolved, Vec<Diagnostic>>, Vec<Written>) {
        let Self {
            mut resolved,
            inside,
            follows,
            overridden,
            mut found,
        } = self;
        let Resolved { value, sources, .. } = &mut resolved;
        let (more_inside, outside): (Vec<_>, Vec<_>) =
            (more.iter().enumerate()).partition(|(_, (path, _))| network::meets_inside(path));
        ratings::fill(language, value, more.iter().map(|(path, _)| path.as_str()), &mut found);
        let mut written = apply(language, value, outside.into_iter(), sources, &mut found);
        let overridden: Vec<&str> = overridden
            .iter()
            .chain(more.iter().map(|(pattern, _)| pattern))
            .map(String::as_str)
            .collect();
        let (follows_inside, follows): (Vec<_>, Vec<_>) =
            follows.iter().partition(|(target, _)| network::meets_inside(target));
        follow::follow(language, value, follows.into_iter(), &overridden, sources, &mut found);
        if network::expand(language, value, sources, &mut found) {
            apply(language, value, inside.iter().enumerate(), sources, &mut found);
            written.extend(apply(language, value, more_inside.into_iter(), sources, &mut found));
            follow::follow(
                language,
                value,
                follows_inside.into_iter(),
                &overridden,
                sources,
                &mut found,
            );
        }
        let resolved = if found.is_empty() { Ok(resolved) } else { Err(found) };
        (resolved, written)
    }
}

/// Overrides that the document itself states with `extends`.
fn own_overrides(value: &Value) -> Vec<(String, Value)> {
    let set = value.get("set").and_then(Value::as_object);
    set.into_iter()
        .flatten()
        .map(|(path, value)| (path.clone(), value.clone()))
        .collect()
}

fn surfaces(value: &mut Value, sources: &mut BTreeMap<String, ValueSource>) {
    let Some(surface) = value.get("surface").filter(|s| s.is_object()).cloned() else {
        return;
    };
    for (id, gear) in entries_mut(value, "gears") {
        if gear.get("surface").is_none_or(Value::is_null) {
            gear.insert("surface".to_owned(), surface.clone());
            sources.insert(format!("gears.{id}.surface"), ValueSource::Surface);
        }
    }
}

/// The same place in each gear that has the surface of the gearbox and no override of its own there, for a path in that surface.
fn gears_of_surface(value: &Value, sources: &BTreeMap<String, ValueSource>, path: &str) -> Vec<String> {
    if path != "surface" && !path.starts_with("surface.") {
        return Vec::new();
    }
    let gears = value.get("gears").and_then(Value::as_object).into_iter().flatten();
    gears
        .filter(|(id, _)| sources.get(&format!("gears.{id}.surface")) == Some(&ValueSource::Surface))
        .map(|(id, _)| format!("gears.{id}.{path}"))
        .filter(|path| sources.get(path) != Some(&ValueSource::Override))
        .collect()
}

fn entries_mut<'a>(
    value: &'a mut Value,
    section: &str,
) -> impl Iterator<Item = (&'a String, &'a mut Map<String, Value>)> + use<'a> {
    value
        .get_mut(section)
        .and_then(Value::as_object_mut)
        .into_iter()
        .flatten()
        .filter_map(|(id, entry)| entry.as_object_mut().map(|entry| (id, entry)))
}

fn absent(entry: &Map<String, Value>, key: &str) -> bool {
    entry.get(key).is_none_or(Value::is_null)
}

/// Gives every component its model: its own, the set's for that component, the set's default, the gearbox's default, or `none`.
/// Lists components without any chosen model.
fn give_models(
    language: &Language,
    value: &mut Value,
    defaults: &Value,
    set: Option<&(String, ModelSet)>,
    sources: &mut BTreeMap<String, ValueSource>,
    unreached: &mut Vec<String>,
) -> Vec<String> {
    let mut giving = Giving {
        defaults,
        set,
        sources,
        unreached,
    };
    let mut without = Vec::new();
    for (section, key) in language.sections() {
        let bare = giving.give_section(value, section, key);
        if !bare.is_empty() {
            without.push(format!(
                "{section}: no model is chosen for {}, so the loss is zero",
                bare.join(", ")
            ));
        }
    }
    giving.give_housing(value);
    giving.give_gears_and_meshes(language, value);
    without
}

/// The models to give to components that have none of their own, with what is reported about them.
struct Giving<'a> {
    /// Defaults of the gearbox.
    defaults: &'a Value,
    set: Option<&'a (String, ModelSet)>,
    sources: &'a mut BTreeMap<String, ValueSource>,
    unreached: &'a mut Vec<String>,
}

impl<'a> Giving<'a> {
    /// The model of the set for one path, with the name of the set.
    fn named(&self, path: &str) -> Option<(&'a String, &'a Value)> {
        self.set.and_then(|(name, s)| s.named(path).map(|model| (name, model)))
    }

    /// The default of the set, else of the gearbox.
    fn default_of(&self, key: &str) -> Option<(Value, ValueSource)> {
        match self.set {
            Some((name, s)) if s.models.contains_key(key) => {
                Some((s.models[key].clone(), ValueSource::Set(name.clone())))
            }
            _ => self
                .defaults
                .get(key)
                .filter(|v| !v.is_null())
                .map(|v| (v.clone(), ValueSource::Models)),
        }
    }

    /// The defaults of named slots: those of a gear, a mesh or the housing replace the ones of the same name. The defaults of drags are
    /// in one place in the document, because only the model's scope determines whether they belong to gears or meshes.
    fn slots_of(&self, key: &str) -> (Map<String, Value>, ValueSource) {
        let (slots, from) = self.default_of(key).unwrap_or((Value::Null, ValueSource::Models));
        (slots.as_object().cloned().unwrap_or_default(), from)
    }

    /// Returns the components of a section for which no model is chosen.
    fn give_section(&mut self, value: &mut Value, section: &str, key: &str) -> Vec<String> {
        let default = self.default_of(key);
        let mut taken = 0;
        let (mut kept, mut bare) = (Vec::new(), Vec::new());
        for (id, entry) in entries_mut(value, section) {
            let path = format!("{section}.{id}.model");
            if let Some((name, model)) = self.named(&path) {
                entry.insert("model".to_owned(), model.clone());
                self.sources.insert(path, ValueSource::Set(name.clone()));
            } else if absent(entry, "model") && default.is_none() && section == DIFFERENTIALS {
                // A differential without a model has gears without friction; that is no omission.
            } else if absent(entry, "model") {
                taken += 1;
                if default.is_none() {
                    bare.push(id.clone());
                }
                let (model, from) = default.clone().unwrap_or((Value::from("none"), ValueSource::Models));
                entry.insert("model".to_owned(), model);
                self.sources.insert(path, from);
            } else {
                kept.push(id.clone());
            }
        }
        if let Some((name, s)) = self.set {
            if s.models.contains_key(key) && !kept.is_empty() {
                self.unreached.push(format!(
                    "{section}: {} keep their own model under `{name}`",
                    kept.join(", ")
                ));
            } else if s.models.contains_key(key) && taken == 0 && s.models[key] != "none" {
                self.unreached
                    .push(format!("`{name}` states a {key} model, but no component uses it"));
            }
        }
        bare
    }

    /// Ways of heat from the housing.
    fn give_housing(&mut self, value: &mut Value) {
        let (ways, from) = self.slots_of(HEAT);
        let Some(thermal) = value.get_mut("thermal").and_then(Value::as_object_mut) else {
            return;
        };
        let written = written_slots(thermal, HEAT);
        let path = |slot: &str| format!("thermal.{HEAT}.{slot}");
        if let Some((name, s)) = self.set {
            let kept: Vec<&str> = ways
                .keys()
                .filter(|slot| written.contains_key(*slot))
                .map(String::as_str)
                .collect();
            if s.models.contains_key(HEAT) && !kept.is_empty() {
                self.unreached.push(format!(
                    "thermal.{HEAT}: {} keep their own model under `{name}`",
                    kept.join(", ")
                ));
            }
        }
        let mut slots = Map::new();
        for (slot, model) in ways.iter().filter(|(slot, _)| !written.contains_key(*slot)) {
            slots.insert(slot.clone(), model.clone());
            self.sources.insert(path(slot), from.clone());
        }
        slots.extend(written);
        for (slot, model) in &mut slots {
            if let Some((name, named)) = self.named(&path(slot)) {
                *model = named.clone();
                self.sources.insert(path(slot), ValueSource::Set(name.clone()));
            }
        }
        thermal.insert(HEAT.to_owned(), Value::Object(slots));
    }

    /// Drags of gears and meshes.
    fn give_gears_and_meshes(&mut self, language: &Language, value: &mut Value) {
        let (drags, from) = self.slots_of(DRAGS);
        for section in ["gears", "meshes"] {
            for (id, entry) in entries_mut(value, section) {
                let written = written_slots(entry, "drag");
                let mut slots = Map::new();
                for (slot, model) in &drags {
                    if !written.contains_key(slot) && language.fits_scope(section, model) {
                        slots.insert(slot.clone(), model.clone());
                        self.sources.insert(format!("{section}.{id}.drag.{slot}"), from.clone());
                    }
                }
                slots.extend(written);
                for slot in self.set.into_iter().flat_map(|(_, s)| s.drag_slots(section, id)) {
                    let path = format!("{section}.{id}.drag.{slot}");
                    if let Some((name, model)) = self.named(&path) {
                        slots.insert(slot, model.clone());
                        self.sources.insert(path, ValueSource::Set(name.clone()));
                    }
                }
                entry.insert("drag".to_owned(), Value::Object(slots));
            }
        }
    }
}

/// The named slots of an entry as written.
fn written_slots(entry: &Map<String, Value>, key: &str) -> Map<String, Value> {
    let slots = entry.get(key).and_then(Value::as_object);
    slots.cloned().unwrap_or_default()
}

/// Writes numbered overrides into the resolved document, each checked against the schema at its path; returns where.
fn apply<'o>(
    language: &Language,
    value: &mut Value,
    overrides: impl Iterator<Item = (usize, &'o (String, Value))>,
    sources: &mut BTreeMap<String, ValueSource>,
    found: &mut Vec<Diagnostic>,
) -> Vec<Written> {
    let mut written = Vec::new();
    for (number, (pattern, new)) in overrides {
        let mut hits = matches(value, pattern);
        if hits.is_empty() {
            found.push(paths::no_match(value, pattern));
            continue;
        }
        // A key that the chosen `type` does not have would be ignored; of several matches those with the key are used.
        hits.retain(|path| language.has_place(value, path));
        if hits.is_empty() {
            let key = pattern.rsplit('.').next().unwrap_or(pattern);
            found.push(no_place(value, pattern, key));
            continue;
        }
        let shared: Vec<String> = (hits.iter())
            .flat_map(|path| gears_of_surface(value, sources, path))
            .collect();
        let hits = hits.into_iter().map(|path| (path, ValueSource::Override));
        let shared = shared.into_iter().map(|path| (path, ValueSource::Surface));
        for (path, source) in hits.chain(shared) {
            match language.checked_in(value, new, &path) {
                Ok(checked) => {
                    if !paths::write(value, &path, checked) {
                        found.push(Diagnostic::error(&path, "cannot be set here").help("set the key above it"));
                        break;
                    }
                    sources.insert(path.clone(), source);
                    written.push((number, path));
                }
                Err(more) => {
                    found.extend(more);
                    break;
                }
            }
        }
    }
    written
}

/// The error for a path whose last key does not exist: suggests a similar key, or where the keys are listed.
fn no_place(value: &Value, pattern: &str, key: &str) -> Diagnostic {
    let error = Diagnostic::error(pattern, format!("the key `{key}` does not exist here")).code(codes::UNKNOWN_PATH);
    let above = pattern.rsplit_once('.').map_or("", |(above, _)| above);
    let records = matches(value, above);
    let record = records.iter().find_map(|path| lookup(value, path)?.as_object());
    let keys: Vec<&str> = record.into_iter().flatten().map(|(key, _)| key.as_str()).collect();
    match did_you_mean(key, keys.iter().copied()) {
        Some(close) => error.help(format!("write `{close}`")),
        None if keys.contains(&"type") => {
            error.help("a model has the keys of its own `type`: `gearloss models MECHANISM MODEL` lists them")
        }
        None => error.help("`gearloss check --resolved` prints every path"),
    }
}
