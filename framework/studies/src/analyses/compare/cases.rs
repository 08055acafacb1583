//! What is compared: the base, model sets, and variants of the base.

use gearloss_framework::gearbox::Gearbox;

use super::CompareEntry;
use crate::analyses::{Built, Context, Stopped};

/// The base and the sets, by name.
pub fn names(entry: &CompareEntry, base: &str) -> Vec<String> {
    let base = std::iter::once(base.to_owned());
    base.chain(entry.against.iter().cloned()).collect()
}

/// The base, the sets and the variants, each with its name.
pub fn cases<'s>(
    cx: &'s Context<'_>,
    entry: &'s CompareEntry,
    gearbox: &'s Gearbox,
    sets: &'s [String],
) -> Result<Vec<Built<'s>>, Stopped> {
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
        for variant in cx.built_with(gearbox, &sets[..1], &changes)? {
            built.push(Built {
                name: name.to_owned(),
                ..variant
            });
        }
    }
    Ok(built)
}
