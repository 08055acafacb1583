//! What is compared: the base, model sets, and variants of the base.

use std::sync::Arc;

use gearloss_framework::gearbox::Gearbox;

use super::CompareEntry;
use crate::analyses::{Built, Planner, Stopped};

/// The base and the sets, by name.
pub fn names(entry: &CompareEntry, base: &str) -> Vec<String> {
    let base = std::iter::once(base.to_owned());
    base.chain(entry.against.iter().cloned()).collect()
}

/// The base, the sets and the variants, each with its name.
pub fn cases<'a>(
    cx: &Planner<'a>,
    entry: &CompareEntry,
    gearbox: &'a Gearbox,
    sets: &[String],
) -> Result<Vec<Arc<Built<'a>>>, Stopped> {
    let mut built = cx.built(gearbox, sets)?;
    for (name, values) in entry.variants.iter() {
        let place = format!("{}.variants.{name}", cx.path());
        if sets.iter().any(|set| set == name) {
            let message = format!("the variant `{name}` has the name of a compared set");
            return Err(cx.wrong(&place, message, "rename it"));
        }
        let changes: Vec<_> = values
            .iter()
            .map(|(path, value)| (path.to_owned(), value.clone(), place.clone()))
            .collect();
        let base = sets.first().map(String::as_str);
        built.push(Arc::new(cx.built_as(gearbox, base, Some(name), &changes)?));
    }
    Ok(built)
}
