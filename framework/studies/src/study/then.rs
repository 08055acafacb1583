//! Model sets with values from an analysis, for later analyses.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use serde_json::{Map, Value, json};

use super::StudyEntry;
use gearloss_framework::document::Diagnostic;

/// The model set of an analysis for later analyses.
#[derive(Debug, Clone, Copy)]
pub struct Then<'a> {
    /// Name of the set.
    pub set: &'a str,
    /// Sets that the analysis fits; the new set extends the first.
    pub model_sets: &'a [String],
}

/// A model set from `then` of an analysis.
struct Promised {
    /// The analysis.
    by: String,
    /// Resolved path to value, after the analysis.
    values: Option<Map<String, Value>>,
}

/// Model sets from analyses, by name.
#[derive(Default)]
pub(super) struct PromisedSets(Mutex<BTreeMap<String, Promised>>);

impl PromisedSets {
    /// The model sets from analyses of a study. They are added with the values of the extended set, so that references can be checked
    /// before the values are known.
    ///
    /// # Errors
    /// If a name is already used, or an analysis fits more than one set.
    pub fn new(entry: &StudyEntry, sets: &mut Map<String, Value>) -> Result<Self, Vec<Diagnostic>> {
        let mut found = Vec::new();
        let mut promised: BTreeMap<String, Promised> = BTreeMap::new();
        for (name, analysis) in entry.analyses.iter() {
            let Some(Then { set, model_sets }) = analysis.then() else {
                continue;
            };
            let wrong =
                |message: String, help: &str| Diagnostic::error(format!("analyses.{name}.then"), message).help(help);
            if let Some(other) = promised.get(set) {
                found.push(wrong(
                    format!("the analysis `{}` already uses the name `{set}`", other.by),
                    "choose another name",
                ));
            } else if sets.contains_key(set) || set == "own" {
                found.push(wrong(
                    format!("there is already a model set `{set}`"),
                    "choose another name",
                ));
            } else if set.is_empty() || set.contains('/') {
                found.push(wrong(
                    format!("`{set}` is not a valid name of a model set"),
                    "write a name without `/`, such as `fitted`",
                ));
            } else if model_sets.len() > 1 {
                found.push(wrong(
                    format!(
                        "{} sets are fitted, but `{set}` can contain the values of only one",
                        model_sets.len()
                    ),
                    "fit the set for later analyses in a separate analysis",
                ));
            } else {
                let base = model_sets.first().map(|set| set.rsplit('/').next().unwrap_or(set));
                let placeholder = match base.filter(|set| *set != "own") {
                    Some(base) => json!({ "extends": base }),
                    None => json!({}),
                };
                sets.insert(set.to_owned(), placeholder);
                let by = name.to_owned();
                promised.insert(set.to_owned(), Promised { by, values: None });
            }
        }
        if found.is_empty() {
            Ok(Self(Mutex::new(promised)))
        } else {
            Err(found)
        }
    }

    /// Stores the values of an analysis for its set.
    pub fn keep(&self, set: &str, values: Map<String, Value>) {
        if let Some(promised) = self.lock().get_mut(set) {
            promised.values = Some(values);
        }
    }

    /// Adds the values to the sets.
    pub fn fill(&self, sets: &mut Map<String, Value>) {
        for (name, promised) in self.lock().iter() {
            if let (Some(values), Some(set)) = (&promised.values, sets.get_mut(name)) {
                set["set"] = Value::Object(values.clone());
            }
        }
    }

    /// The analysis of a set.
    pub fn promised_by(&self, set: &str) -> Option<String> {
        self.lock().get(set).map(|promised| promised.by.clone())
    }

    /// True if a set has no values yet.
    pub fn is_pending(&self, set: &str) -> bool {
        self.lock().get(set).is_some_and(|promised| promised.values.is_none())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, Promised>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
