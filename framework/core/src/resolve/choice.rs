//! Choice of models and overrides of a calculation.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use crate::codes;
use crate::document::{Diagnostic, did_you_mean};
use crate::language::Language;

/// A model set and overrides of single values.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    /// Name of the model set; `None`: the `models` of the gearbox.
    pub set: Option<String>,
    /// Model sets of a study; they take precedence over those of the gearbox and over those that crates ship.
    pub sets: Map<String, Value>,
    /// Path patterns and values, in the order of application.
    pub overrides: Vec<(String, Value)>,
    /// Paths and formulas of values that follow others, such as `gears.W2.z` and `107 - gears.P2.z`: evaluated after all overrides, in this
    /// order, with the numbers of each path in its documented unit.
    pub follows: Vec<(String, String)>,
}

impl Choice {
    /// A model set by its name.
    pub fn of_set(name: impl Into<String>) -> Self {
        Self {
            set: Some(name.into()),
            ..Self::default()
        }
    }

    /// Adds an override: a path or a pattern, and the value in its written form, `"1.5 l"` or a bare number in the documented unit.
    pub fn with(mut self, path: impl Into<String>, value: impl Into<Value>) -> Self {
        self.overrides.push((path.into(), value.into()));
        self
    }
}

/// A model set with everything that it extends.
#[derive(Debug, Clone, Default)]
pub struct ModelSet {
    /// Default by mechanism.
    pub models: Map<String, Value>,
    /// Models of single components, by path pattern.
    pub components: Vec<(String, Value)>,
    /// Path patterns and values that belong to the set, in the order of application, each with the set that states it.
    pub changes: Vec<(String, Value, String)>,
}

impl ModelSet {
    /// The model that the set gives to the component at a path; later patterns take precedence.
    pub fn named(&self, path: &str) -> Option<&Value> {
        self.components
            .iter()
            .rev()
            .find(|(pattern, _)| fits(pattern, path))
            .map(|(_, model)| model)
    }
}

impl ModelSet {
    /// Names of the drag slots that the set gives to one gear or mesh.
    pub(super) fn drag_slots(&self, section: &str, id: &str) -> Vec<String> {
        let owner = format!("{section}.{id}.drag");
        let slot = |(pattern, _): &(String, Value)| {
            let (parent, slot) = pattern.rsplit_once('.')?;
            fits(parent, &owner).then(|| slot.to_owned())
        };
        self.components.iter().filter_map(slot).collect()
    }
}

fn fits(pattern: &str, path: &str) -> bool {
    let (pattern, path): (Vec<_>, Vec<_>) = (pattern.split('.').collect(), path.split('.').collect());
    pattern.len() == path.len() && pattern.iter().zip(&path).all(|(p, k)| *p == "*" || p == k)
}

/// All available sets by name: shipped ones, those of the gearbox, those of a study; later ones take precedence.
pub fn sets_of(language: &Language, gearbox: &Value, study: &Map<String, Value>) -> BTreeMap<String, Value> {
    let mut sets: BTreeMap<String, Value> = language.shipped_sets().clone();
    for (name, set) in gearbox
        .get("model_sets")
        .and_then(Value::as_object)
        .into_iter()
        .flatten()
        .chain(study)
    {
        sets.insert(name.clone(), set.clone());
    }
    sets
}

/// The name of a gearbox's own models in lists of model sets.
pub const OWN_MODELS: &str = "own";

/// Rejects a set with the name of the own models.
pub fn called_own<'a>(mut names: impl Iterator<Item = &'a String>) -> Option<Diagnostic> {
    names.find(|name| *name == OWN_MODELS).map(|name| {
        Diagnostic::error(
            format!("model_sets.{name}"),
            format!("`{name}` is reserved for the gearbox's own models"),
        )
        .help("give the set another name")
    })
}

/// Expands a set with everything that it extends.
///
/// # Errors
/// If a name is unknown or sets extend each other in a loop.
pub fn expand_set(sets: &BTreeMap<String, Value>, name: &str) -> Result<ModelSet, Diagnostic> {
    let mut chain: Vec<&str> = Vec::new();
    let mut next = Some(name);
    while let Some(name) = next {
        let Some((known, set)) = sets.get_key_value(name) else {
            // A set cannot extend the gearbox's own models.
            let own_models = chain.is_empty().then_some(OWN_MODELS);
            let names: Vec<&str> = sets.keys().map(String::as_str).chain(own_models).collect();
            let path = chain
                .last()
                .map_or_else(|| "model_sets".to_owned(), |last| format!("model_sets.{last}.extends"));
            let error = Diagnostic::error(path, format!("no model set is called `{name}`"))
                .note(format!("available: {}", names.join(", ")))
                .code(codes::UNKNOWN_NAME);
            return Err(match did_you_mean(name, names.iter().copied()) {
                Some(close) => error.help(format!("write `{close}`")),
                None => error.help("use one of them, or add it under `model_sets`"),
            });
        };
        if chain.contains(&known.as_str()) {
            return Err(Diagnostic::error(
                format!("model_sets.{known}.extends"),
                "model sets extend each other in a loop",
            )
            .code(codes::EXTENDS)
            .note(format!("the loop: {}", chain.join(", ")))
            .help("remove one `extends`"));
        }
        chain.push(known);
        next = set.get("extends").and_then(Value::as_str);
    }
    let mut whole = ModelSet::default();
    for name in chain.iter().rev() {
        for (key, value) in sets[*name].as_object().into_iter().flatten() {
            match key.as_str() {
                "extends" => {}
                "components" => {
                    whole.components.extend(
                        value
                            .as_object()
                            .into_iter()
                            .flatten()
                            .map(|(k, v)| (k.clone(), v.clone())),
                    );
                }
                "set" => {
                    let changes = value.as_object().into_iter().flatten();
                    whole
                        .changes
                        .extend(changes.map(|(path, value)| (path.clone(), value.clone(), (*name).to_owned())));
                }
                _ if value.is_null() => {}
                _ => {
                    whole.models.insert(key.clone(), value.clone());
                }
            }
        }
    }
    Ok(whole)
}

pub(super) fn find(
    language: &Language,
    gearbox: &Value,
    study: &Map<String, Value>,
    name: &str,
    found: &mut Vec<Diagnostic>,
) -> Option<ModelSet> {
    match expand_set(&sets_of(language, gearbox, study), name) {
        Ok(mut set) => {
            // The check of the document leaves them as written, because their keys are paths.
            for (pattern, model) in &mut set.components {
                match language.checked(model, pattern) {
                    Ok(checked) => *model = checked,
                    Err(more) => found.extend(more),
                }
            }
            Some(set)
        }
        Err(error) => {
            found.push(error);
            None
        }
    }
}
