//! Model sets with values from an analysis, for later analyses.

use std::collections::BTreeMap;

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

/// Model sets from `then`: name to analysis.
pub(super) type PromisedSets = BTreeMap<String, String>;

/// The model sets from analyses of a study. They are added with the values of the extended set, so that references can be checked
/// before the values are known.
///
/// # Errors
/// If a name is already used, or an analysis fits more than one set.
pub(super) fn promised_sets(
    entry: &StudyEntry,
    sets: &mut Map<String, Value>,
) -> Result<PromisedSets, Vec<Diagnostic>> {
    let mut found = Vec::new();
    let mut promised = PromisedSets::new();
    for (name, analysis) in entry.analyses.iter() {
        let Some(Then { set, model_sets }) = analysis.then() else {
            continue;
        };
        let wrong =
            |message: String, help: &str| Diagnostic::error(format!("analyses.{name}.then"), message).help(help);
        if let Some(other) = promised.get(set) {
            found.push(wrong(
                format!("the analysis `{other}` already uses the name `{set}`"),
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
            promised.insert(set.to_owned(), name.to_owned());
        }
    }
    if found.is_empty() { Ok(promised) } else { Err(found) }
}
