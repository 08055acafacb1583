//! A gearbox with one choice of models, built again and again with other numbers: samples, fits, sweeps.
//!
//! The result is the same to the bit as that of resolving and building with all overrides, and so is every error. Two things are not
//! repeated. If the same paths are overridden as before, and all values are numbers, they are written into the document that was resolved
//! before. And a step of building whose input is the same gives the result of the last build (`Memory`).

use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use crate::document::Unit;
use crate::evaluate::Ratings;
use crate::gearbox::{Findings, Gearbox};
use crate::language::Language;
use crate::registry::Memory;
use crate::resolve::{Choice, Draft, Resolved, ValueSource, Written, lookup_mut, precedes_catalogues};
use crate::transmission::Transmission;

/// A gearbox with one choice of models, to which further overrides are added.
pub struct Variants<'a> {
    language: &'a Language,
    gearbox: &'a Gearbox,
    choice: Choice,
    draft: Draft,
    /// One for each concurrent task, with what it built last.
    benches: Mutex<Vec<Bench>>,
}

/// The document that was built last, and what is needed to build it with other numbers.
struct Bench {
    /// Patterns of its overrides.
    patterns: Vec<String>,
    /// Where their values are written.
    places: Vec<Place>,
    resolved: Resolved,
    memory: Memory,
}

/// Where the value of an override is written: a number within a range, in a unit.
struct Place {
    /// Number of the override.
    from: usize,
    path: String,
    unit: &'static Unit,
    least: f64,
    greatest: f64,
}

impl<'a> Variants<'a> {
    /// For a gearbox with a choice of models.
    pub fn new(language: &'a Language, gearbox: &'a Gearbox, choice: Choice) -> Self {
        Self {
            draft: Draft::new(language, &gearbox.files, &gearbox.value, &choice),
            language,
            gearbox,
            choice,
            benches: Mutex::default(),
        }
    }

    /// The transmission with further overrides: that of [`Gearbox::transmission`] with these at the end of the choice.
    ///
    /// # Errors
    /// All findings of resolving and building.
    pub fn build(&self, overrides: &[(String, Value)]) -> Result<Transmission, Findings> {
        Ok(self.built(overrides, |_, _| Ok(()))?.0)
    }

    /// The same with the ratings of its components.
    ///
    /// # Errors
    /// All findings of resolving and building.
    pub fn build_rated(&self, overrides: &[(String, Value)]) -> Result<(Transmission, Ratings), Findings> {
        self.built(overrides, |resolved, built| {
            self.gearbox.ratings(self.language, resolved, built)
        })
    }

    /// Paths of the models that are built again for other values of overrides; the values of the others are set in what was built. `None` if
    /// the description is resolved again.
    ///
    /// # Errors
    /// All findings of resolving and building.
    pub fn built_again(&self, values: [&[(String, Value)]; 2]) -> Result<Option<Vec<String>>, Findings> {
        let [before, after] = values;
        let mut bench = self.bench(before)?;
        let (_, memory) = self
            .gearbox
            .build_again(self.language, &bench.resolved, Memory::default())?;
        bench.memory = memory;
        if bench.places.is_empty() || !bench.write(after) {
            return Ok(None);
        }
        let memory = std::mem::take(&mut bench.memory);
        let (_, memory) = self.gearbox.build_again(self.language, &bench.resolved, memory)?;
        Ok(Some(memory.built().to_vec()))
    }

    /// The transmission with further overrides, and what is made of it and its resolved description.
    fn built<T>(
        &self,
        overrides: &[(String, Value)],
        make: impl FnOnce(&Resolved, &Transmission) -> Result<T, Findings>,
    ) -> Result<(Transmission, T), Findings> {
        let spare = self.benches.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let again = spare.and_then(|mut bench| bench.write(overrides).then_some(bench));
        let mut bench = match again {
            Some(bench) => bench,
            None => self.bench(overrides)?,
        };
        let memory = std::mem::take(&mut bench.memory);
        let (built, memory) = self.gearbox.build_again(self.language, &bench.resolved, memory)?;
        bench.memory = memory;
        let made = make(&bench.resolved, &built)?;
        if !bench.places.is_empty() {
            self.benches.lock().unwrap_or_else(PoisonError::into_inner).push(bench);
        }
        Ok((built, made))
    }

    /// The description resolved with further overrides.
    ///
    /// # Errors
    /// All findings of resolving.
    pub fn resolve(&self, overrides: &[(String, Value)]) -> Result<Resolved, Findings> {
        self.bench(overrides).map(|bench| bench.resolved)
    }

    /// The resolved document with further overrides, and where their numbers are, if other numbers may be written there.
    fn bench(&self, overrides: &[(String, Value)]) -> Result<Bench, Findings> {
        let (resolved, written) = if overrides.iter().any(|(pattern, _)| precedes_catalogues(pattern)) {
            let mut choice = self.choice.clone();
            choice.overrides.extend_from_slice(overrides);
            (self.gearbox.resolve(self.language, &choice)?, Vec::new())
        } else {
            let (resolved, written) = self.draft.clone().finish(self.language, overrides);
            let faults = |list| self.gearbox.faults_of_choice(self.language, &self.choice, list);
            (resolved.map_err(faults)?, written)
        };
        Ok(Bench {
            patterns: overrides.iter().map(|(pattern, _)| pattern.clone()).collect(),
            places: self.places(&resolved, overrides, written).unwrap_or_default(),
            resolved,
            memory: Memory::default(),
        })
    }

    /// Where the numbers of overrides are; `None` if one of them is not a number, or if something else depends on them.
    fn places(&self, resolved: &Resolved, overrides: &[(String, Value)], written: Vec<Written>) -> Option<Vec<Place>> {
        let generated = *resolved.source_of("thermal.network") == ValueSource::Network;
        if generated || !self.choice.follows.is_empty() || !overrides.iter().all(|(_, value)| value.is_number()) {
            return None;
        }
        let place = |(from, path): Written| {
            let (unit, least, greatest) = self.language.number_at(&resolved.value, &path)?;
            Some(Place {
                from,
                path,
                unit,
                least,
                greatest,
            })
        };
        written.into_iter().map(place).collect()
    }
}

impl Bench {
    /// Writes other numbers at the same paths. False if that is not possible, or one of them is out of its range: then the description
    /// is resolved, which also finds the words for the error.
    fn write(&mut self, overrides: &[(String, Value)]) -> bool {
        if !self.patterns.iter().eq(overrides.iter().map(|(pattern, _)| pattern)) {
            return false;
        }
        for place in &self.places {
            let number = overrides[place.from].1.as_f64();
            let Some(number) = number.filter(|x| x.is_finite() && (place.least..=place.greatest).contains(x)) else {
                return false;
            };
            let Some(target) = lookup_mut(&mut self.resolved.value, &place.path) else {
                return false;
            };
            let new = Value::from(place.unit.to_si(number));
            if !is_same_number(target, &new) {
                *target = new;
                self.memory.change(&place.path);
            }
        }
        true
    }
}

/// True for two numbers with the same bits.
fn is_same_number(a: &Value, b: &Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a.to_bits() == b.to_bits(),
        _ => false,
    }
}
