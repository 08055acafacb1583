//! Recipes that lay out a thermal network where a description says `network: auto`.

use serde_json::Value;

use super::Origin;
use crate::description::GearboxEntry;
use crate::document::Diagnostic;

/// A recipe for thermal networks that a crate ships. It lies outside of the framework because it names models.
#[derive(Debug, Clone, Copy)]
pub struct NetworkRecipe {
    /// What it is.
    pub meaning: &'static str,
    /// The network as one writes it under `thermal.network`, numbers in documented units, from the typed sections of a
    /// resolved description and from all of it. What is missing is an error at `thermal.network`. Ids that meet nothing
    /// are left alone: building says so.
    pub lay_out: fn(&GearboxEntry, &Value) -> Result<Value, Diagnostic>,
    /// Where it is registered.
    pub origin: Origin,
}

inventory::collect!(NetworkRecipe);

/// The only recipe at hand.
///
/// # Errors
/// Where there is none, or more than one.
pub(super) fn only(recipes: &[NetworkRecipe]) -> Result<&NetworkRecipe, Diagnostic> {
    const PATH: &str = "thermal.network";
    match recipes {
        [only] => Ok(only),
        [] => Err(Diagnostic::error(PATH, "no crate of this program lays out networks")
            .help("link a crate that does, such as gearloss-plugins, or write `nodes` and `links` in place of `auto`")),
        [one, other, ..] => Err(Diagnostic::error(PATH, "two crates lay out networks")
            .note(format!("one at {}, the other at {}", one.origin, other.origin))
            .help("link one of them only, or write `nodes` and `links` in place of `auto`")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn one_recipe_is_taken_none_and_two_are_told() {
        let recipe = NetworkRecipe {
            meaning: "Nothing.",
            lay_out: |_, _| Ok(Value::Null),
            origin: crate::origin!(),
        };
        assert!(only(&[recipe]).is_ok());
        for (recipes, said) in [(vec![], "no crate"), (vec![recipe, recipe], "two crates")] {
            let error = only(&recipes).unwrap_err();
            assert!(
                error.message.contains(said) && error.path == "thermal.network",
                "{error}"
            );
        }
    }
}
