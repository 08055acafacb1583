//! `network: auto` in the resolved document: nodes and links as if they were written.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{Came, lookup, paths};
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::language::Language;

/// Where the network stands.
const NETWORK: &str = "thermal.network";

/// True for a path pattern that may meet something inside the network.
pub(super) fn meets_inside(pattern: &str) -> bool {
    let mut keys = pattern.split('.');
    NETWORK
        .split('.')
        .all(|own| keys.next().is_some_and(|key| key == own || key == "*"))
        && keys.next().is_some()
}

/// Writes nodes and links in place of `auto`; false where they could not be found.
pub(super) fn expand(
    language: &Language,
    value: &mut Value,
    came: &mut BTreeMap<String, Came>,
    found: &mut Vec<Diagnostic>,
) -> bool {
    if lookup(value, NETWORK).and_then(Value::as_str) != Some("auto") {
        return true;
    }
    // What keeps the description from being read is said where it is built.
    let Ok(entry) = serde_json::from_value::<GearboxEntry>(value.clone()) else {
        return false;
    };
    let written = language
        .registry()
        .network_recipe()
        .and_then(|recipe| (recipe.lay_out)(&entry, value))
        .map_err(|error| vec![error])
        .and_then(|written| language.checked(&written, NETWORK));
    match written {
        Ok(written) => {
            came.insert(NETWORK.to_owned(), Came::Network);
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
    fn patterns_inside_the_network_are_told_from_others() {
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
