//! What a build of a transmission leaves for the next one, of the same description with other numbers.

use std::any::Any;
use std::collections::{BTreeMap, HashMap};

/// Results of steps of the last build by a key that starts with a path, and what has changed in the document since. A step whose input is
/// equal is not repeated.
#[derive(Default)]
pub(crate) struct Memory {
    kept: HashMap<String, Box<dyn Any + Send + Sync>>,
    /// Entries (`bearings.B1`) in which a value has changed, each with the keys of these values; empty for an entry that is a value.
    changed: BTreeMap<String, Vec<String>>,
    /// Paths of the models that this build did not find here.
    built: Vec<String>,
}

impl Memory {
    /// States that the value at a path has changed.
    pub fn change(&mut self, path: &str) {
        let (entry, key) = split(path);
        match self.changed.get_mut(entry) {
            Some(keys) => keys.push(key.to_owned()),
            None => {
                self.changed.insert(entry.to_owned(), vec![key.to_owned()]);
            }
        }
    }

    /// Begins another build.
    pub fn begin(&mut self) {
        self.built.clear();
    }

    /// Keeps a model that was built at a path.
    pub fn keep_model<T: Any + Send + Sync>(&mut self, path: &str, model: T) {
        self.built.push(path.to_owned());
        self.keep(path, model);
    }

    /// Paths of the models that were built in the last build, because they were not those of the build before.
    pub fn built(&self) -> &[String] {
        &self.built
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
    pub(crate) fn is_same_but_model(&self, entry: &str) -> bool {
        let keys = self.changed.get(entry);
        keys.is_none_or(|keys| keys.iter().all(|key| is_within(key, "model")))
    }

    /// True if the value at a path in an entry is as it was.
    pub(crate) fn is_same_value(&self, path: &str) -> bool {
        let (entry, place) = split(path);
        let keys = self.changed.get(entry);
        keys.is_none_or(|keys| keys.iter().all(|key| !is_within(key, place) && !is_within(place, key)))
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

/// The entry of a path, section and id, and the key in it; empty for the entry itself.
fn split(path: &str) -> (&str, &str) {
    let mut dots = path.match_indices('.').map(|(place, _)| place);
    match dots.nth(1) {
        Some(dot) => (&path[..dot], &path[dot + 1..]),
        None => (path, ""),
    }
}

/// True for a key that is another one or below it; all are below the empty one.
fn is_within(key: &str, other: &str) -> bool {
    let rest = key.strip_prefix(other);
    other.is_empty() || rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_changes_with_any_of_its_values() {
        let mut memory = Memory::default();
        memory.change("bearings.B1.model.mu_bl");
        assert!(!memory.is_same("bearings.B1") && memory.is_same_but_model("bearings.B1"));
        let is_same = |path: &str| memory.is_same_value(path);
        assert!(!is_same("bearings.B1") && !is_same("bearings.B1.model") && !is_same("bearings.B1.model.mu_bl.x"));
        assert!(is_same("bearings.B1.mod") && is_same("bearings.B1.model.mu") && is_same("bearings.B10.model"));
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
