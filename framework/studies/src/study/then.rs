//! Sets of models that an analysis of the study finds the values of, for the analyses after it.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use serde_json::{Map, Value, json};

use super::StudyEntry;
use gearloss_framework::document::Diagnostic;

/// What an analysis leaves for those after it: a set of models with the values that it finds.
#[derive(Debug, Clone, Copy)]
pub struct Then<'a> {
    /// Name of the set.
    pub set: &'a str,
    /// Sets that the analysis fits; the first is what the new one extends.
    pub model_sets: &'a [String],
}

/// A set that `then` of an analysis names.
struct Promised {
    /// The analysis.
    by: String,
    /// Resolved path to value, once the analysis has found them.
    values: Option<Map<String, Value>>,
}

/// Sets that analyses promise, by name.
#[derive(Default)]
pub(super) struct PromisedSets(Mutex<BTreeMap<String, Promised>>);

impl PromisedSets {
    /// The sets that a study promises. They join its own as what they extend, so that everything that names them can be checked
    /// before any value is found.
    ///
    /// # Errors
    /// Names that are taken, and analyses that fit more than one set.
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
                    format!("the analysis `{}` already calls its set `{set}`", other.by),
                    "give this one another name",
                ));
            } else if sets.contains_key(set) || set == "own" {
                found.push(wrong(
                    format!("a set of models is already called `{set}`"),
                    "choose another name",
                ));
            } else if set.is_empty() || set.contains('/') {
                found.push(wrong(
                    format!("`{set}` cannot name a set of models"),
                    "write a name without `/`, such as `fitted`",
                ));
            } else if model_sets.len() > 1 {
                found.push(wrong(
                    format!(
                        "{} sets are fitted, and `{set}` can hold the values of one",
                        model_sets.len()
                    ),
                    "fit the set that the later analyses shall use in an analysis of its own",
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

    /// Keeps what an analysis has found for its set.
    pub fn keep(&self, set: &str, values: Map<String, Value>) {
        if let Some(promised) = self.lock().get_mut(set) {
            promised.values = Some(values);
        }
    }

    /// Puts the values that were found into the sets.
    pub fn fill(&self, sets: &mut Map<String, Value>) {
        for (name, promised) in self.lock().iter() {
            if let (Some(values), Some(set)) = (&promised.values, sets.get_mut(name)) {
                set["set"] = Value::Object(values.clone());
            }
        }
    }

    /// The analysis that promises a set.
    pub fn promised_by(&self, set: &str) -> Option<String> {
        self.lock().get(set).map(|promised| promised.by.clone())
    }

    /// True where a set is promised and has no values yet.
    pub fn is_pending(&self, set: &str) -> bool {
        self.lock().get(set).is_some_and(|promised| promised.values.is_none())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, Promised>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
