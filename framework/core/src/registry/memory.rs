//! What a build of a transmission leaves for the next one, of the same description with other numbers.

use std::any::Any;
use std::collections::{BTreeMap, HashMap};

/// Results of steps of the last build by a key that starts with a path, and what has changed in the document since. A step whose input is
/// equal is not repeated.
#[derive(Default)]
pub(crate) struct Memory {
    kept: HashMap<String, Box<dyn Any + Send + Sync>>,
    /// Entries (`bearings.B1`) in which a value has changed: whether all of these values belong to its model.
    changed: BTreeMap<String, bool>,
}

impl Memory {
    /// States that the value at a path has changed.
    pub fn change(&mut self, path: &str) {
        let (entry, key) = split(path);
        let in_model = key.is_some_and(|key| key == "model" || key.starts_with("model."));
        match self.changed.get_mut(entry) {
            Some(only_model) => *only_model &= in_model,
            None => {
                self.changed.insert(entry.to_owned(), in_model);
            }
        }
    }

    /// Everything is built as the document is now.
    pub fn settle(&mut self) {
        self.changed.clear();
    }

    /// Entries in which a value has changed, such as `bearings.B1` or `housing.oil`.
    pub fn changed(&self) -> impl Iterator<Item = &str> {
        self.changed.keys().map(String::as_str)
    }

    /// True if an entry is as it was, except perhaps for the parameters of its model.
    pub fn is_same_but_model(&self, entry: &str) -> bool {
        self.changed.get(entry).is_none_or(|only_model| *only_model)
    }

    /// True if an entry is as it was.
    pub fn is_same(&self, entry: &str) -> bool {
        !self.changed.contains_key(entry)
    }

    /// What was kept under a key.
    pub fn get<T: Any>(&self, key: &str) -> Option<&T> {
        self.kept.get(key)?.downcast_ref()
    }

    /// Removes what was kept under a key.
    pub fn take<T: Any>(&mut self, key: &str) -> Option<T> {
        self.kept.remove(key)?.downcast().ok().map(|kept| *kept)
    }

    /// Keeps a value under a key.
    pub fn keep<T: Any + Send + Sync>(&mut self, key: &str, value: T) {
        self.kept.insert(key.to_owned(), Box::new(value));
    }

    /// The result of a step from its whole input: the one of the last build if the input is equal.
    pub fn repeat<I, O>(&mut self, key: &str, input: I, step: impl FnOnce(&I) -> O) -> O
    where
        I: PartialEq + Any + Send + Sync,
        O: Clone + Any + Send + Sync,
    {
        if let Some((known, result)) = self.get::<(I, O)>(key)
            && *known == input
        {
            return result.clone();
        }
        let result = step(&input);
        self.keep(key, (input, result.clone()));
        result
    }
}

/// The entry of a path, section and id, and the key in it.
fn split(path: &str) -> (&str, Option<&str>) {
    let mut dots = path.match_indices('.').map(|(place, _)| place);
    match dots.nth(1) {
        Some(dot) => (&path[..dot], Some(&path[dot + 1..])),
        None => (path, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_changes_with_any_of_its_values() {
        let mut memory = Memory::default();
        memory.change("bearings.B1.model.mu_bl");
        assert!(!memory.is_same("bearings.B1") && memory.is_same_but_model("bearings.B1"));
        memory.change("bearings.B1.radial_factor");
        assert!(!memory.is_same_but_model("bearings.B1") && memory.is_same("bearings.B10"));
        memory.change("locked_below");
        assert_eq!(memory.changed().collect::<Vec<_>>(), ["bearings.B1", "locked_below"]);
        memory.settle();
        assert!(memory.is_same("bearings.B1"));
    }

    #[test]
    fn a_step_is_repeated_only_for_another_input() {
        let mut memory = Memory::default();
        let mut steps = 0;
        for input in [1.0, 1.0, 2.0, f64::NAN, f64::NAN] {
            memory.repeat("a", input, |x| {
                steps += 1;
                2.0 * x
            });
        }
        assert_eq!(steps, 4);
    }
}
