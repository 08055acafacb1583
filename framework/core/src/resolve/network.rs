//! `network: auto` in the resolved document: nodes and links in their written form.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{ValueSource, lookup, paths};
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::language::Language;

/// Path of the network.
const NETWORK: &str = "thermal.network";

/// True for a path pattern that may match a path inside the network.
pub(super) fn meets_inside(pattern: &str) -> bool {
    let mut keys = pattern.split('.');
    NETWORK
        .split('.')
        .all(|part| keys.next().is_some_and(|key| key == part || key == "*"))
        && keys.next().is_some()
}

/// Writes nodes and links instead of `auto`; false if they could not be generated.
pub(super) fn expand(
    language: &Language,
    value: &mut Value,
    sources: &mut BTreeMap<String, ValueSource>,
    found: &mut Vec<Diagnostic>,
) -> bool {
    if lookup(value, NETWORK).and_then(Value::as_str) != Some("auto") {
        return true;
    }
    // Errors of the description are reported where it is built.
    let Ok(entry) = serde_json::from_value::<GearboxEntry>(value.clone()) else {
        return false;
    };
    let written = language
        .registry()
        .network_recipe()
        .and_then(|recipe| (recipe.generate)(&entry, value))
        .map_err(|error| vec![error])
        .and_then(|written| language.checked(&written, NETWORK));
    match written {
        Ok(written) => {
            sources.insert(NETWORK.to_owned(), ValueSource::Network);
            paths::write(value, NETWORK, written)
        }
        Err(errors) => {
            found.extend(errors);
            false
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_inside_the_network_are_distinguished_from_others() {
        for inside in ["thermal.network.links.a.conductance", "thermal.*.nodes", "*.*.x"] {
            assert!(meets_inside(inside), "{inside}");
        }
        for outside in [
            "thermal.network",
            "thermal.ambient",
            "thermal.*",
            "bearings.network.bore",
        ] {
            assert!(!meets_inside(outside), "{outside}");
        }
    }
}
