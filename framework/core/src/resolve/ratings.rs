//! The ratings in the resolved document: parameters by the name of the rating.

use serde_json::{Map, Value};

use crate::document::Diagnostic;
use crate::language::Language;

/// Key of the ratings in a gearbox, and above each of them in its path.
pub const RATINGS: &str = "ratings";

/// True for an override of a rating.
pub(super) fn meets(pattern: &str) -> bool {
    let first = pattern.split('.').next().unwrap_or_default();
    first == RATINGS
}

/// Writes the defaults of all ratings that are not stated, so that an override finds its path. Without overrides of ratings the
/// document stays as it is.
pub(super) fn fill<'a>(
    language: &Language,
    value: &mut Value,
    patterns: impl IntoIterator<Item = &'a str>,
    found: &mut Vec<Diagnostic>,
) {
    if !patterns.into_iter().any(meets) {
        return;
    }
    let Some(document) = value.as_object_mut() else { return };
    let stated = document.entry(RATINGS).or_insert_with(|| Value::Object(Map::new()));
    if stated.is_null() {
        *stated = Value::Object(Map::new());
    }
    let Some(stated) = stated.as_object_mut() else { return };
    for rating in language.registry().ratings() {
        let name = rating.entry.name;
        if stated.get(name).is_none_or(Value::is_null) {
            match language.default_rating(name) {
                Ok(value) => {
                    stated.insert(name.to_owned(), value);
                }
                Err(more) => found.extend(more),
            }
        }
    }
}
