//! Recipes that generate a thermal network for `network: auto`.

use serde_json::Value;

use super::Origin;
use crate::description::GearboxEntry;
use crate::document::Diagnostic;

/// A recipe for thermal networks that a crate ships. It is outside the framework because it names models.
#[derive(Debug, Clone, Copy)]
pub struct NetworkRecipe {
    /// Description.
    pub meaning: &'static str,
    /// The network in its written form under `thermal.network`, with numbers in documented units, from the typed sections of a
    /// resolved description and from all of it. Missing data is an error at `thermal.network`. Unknown ids are left unchanged:
    /// building reports them.
    pub generate: fn(&GearboxEntry, &Value) -> Result<Value, Diagnostic>,
    /// Where it is registered.
    pub origin: Origin,
}

inventory::collect!(NetworkRecipe);

/// The only available recipe.
///
/// # Errors
/// If there is none, or more than one.
pub(super) fn only(recipes: &[NetworkRecipe]) -> Result<&NetworkRecipe, Diagnostic> {
    const PATH: &str = "thermal.network";
    match recipes {
        [only] => Ok(only),
        [] => Err(Diagnostic::error(PATH, "no crate of this program generates networks")
            .help("link a crate that does, such as gearloss-plugins, or write `nodes` and `links` instead of `auto`")),
        [one, other, ..] => Err(Diagnostic::error(PATH, "two crates generate networks")
            .note(format!("one at {}, the other at {}", one.origin, other.origin))
            .help("link only one of them, or write `nodes` and `links` instead of `auto`")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn one_recipe_is_used_none_and_two_are_reported() {
        let recipe = NetworkRecipe {
            meaning: "Nothing.",
            generate: |_, _| Ok(Value::Null),
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
