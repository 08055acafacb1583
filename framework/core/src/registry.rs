//! The registry: collects every linked mechanism, model and catalogue automatically.
//!
//! Entries are not generic, because another crate could not collect a generic entry for its own mechanism. Each holds a type-erased
//! build function, which is downcast once per resolve.

mod build;
mod cells;
mod check;
mod compared;
mod evaluated;
mod memory;
mod placed;
mod rating;
mod recipe;

use std::any::Any;

use schemars::{Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

pub use build::{Build, Files, Instance};
pub use cells::{JudgedCell, ShippedCells};
pub use check::Check;
pub use compared::{Compared, ComparedSet, kind_of};
pub use evaluated::Evaluated;
pub(crate) use memory::Memory;
pub(crate) use placed::BuiltRating;
pub(crate) use placed::place_between;
pub(crate) use placed::sealed::Sealed;
pub use placed::{Placed, Section};
pub use rating::{RatedAlone, RatingPlugin};
pub use recipe::NetworkRecipe;

use crate::codes;
use crate::document::{Diagnostic, did_you_mean};
use crate::loss::{Limit, Observed, Term};
use crate::mechanism::QuantityDoc;
use crate::mechanism::gear_drag::Scope;
pub use crate::mechanism::{ModelRef, NamedSlots, Slot};

pub use inventory;

// Unit tests register nothing, so that they compile only what they use.
#[cfg(test)]
pub(crate) use crate::unregistered as submit;
/// Adds an entry to the registry of its type.
#[cfg(not(test))]
#[doc(hidden)]
pub use inventory::submit;

/// A crate that registers something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, schemars::JsonSchema)]
pub struct Package {
    /// Name as in its Cargo.toml.
    pub name: &'static str,
    /// Version as in its Cargo.toml.
    pub version: &'static str,
}

impl std::fmt::Display for Package {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.name, self.version)
    }
}

/// Crate, file and line of a registration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Origin {
    /// The crate.
    pub package: Package,
    /// Its file, as reported by the compiler.
    pub file: &'static str,
    /// Line in the file.
    pub line: u32,
}

impl std::fmt::Display for Origin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {}:{}", self.package, self.file, self.line)
    }
}

/// The source location of the invocation.
#[macro_export]
macro_rules! origin {
    () => {
        $crate::registry::Origin {
            package: $crate::registry::Package {
                name: env!("CARGO_PKG_NAME"),
                version: env!("CARGO_PKG_VERSION"),
            },
            file: file!(),
            line: line!(),
        }
    };
}

/// Evidence grade of a formula, a default value or an option; the lowest comes last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Evidence {
    /// Several independent sources agree.
    SeveralSources,
    /// Derived and checked numerically.
    Derived,
    /// One source.
    OneSource,
    /// Stated by the user.
    User,
    /// Quoted from memory, not checked against the source.
    Recalled,
    /// Reconstructed from parts of sources.
    Reconstructed,
    /// Sources disagree.
    Disputed,
    /// An assumption.
    Assumed,
}

impl Evidence {
    /// Name in documents and options.
    pub fn name(self) -> &'static str {
        match self {
            Self::SeveralSources => "several_sources",
            Self::Derived => "derived",
            Self::OneSource => "one_source",
            Self::User => "user",
            Self::Recalled => "recalled",
            Self::Reconstructed => "reconstructed",
            Self::Disputed => "disputed",
            Self::Assumed => "assumed",
        }
    }

    /// Grades from highest to lowest.
    pub const ALL: [Self; 8] = [
        Self::SeveralSources,
        Self::Derived,
        Self::OneSource,
        Self::User,
        Self::Recalled,
        Self::Reconstructed,
        Self::Disputed,
        Self::Assumed,
    ];

    /// The grade of a name.
    ///
    /// # Errors
    /// If there is no such grade.
    pub fn of_name(name: &str) -> Result<Self, Diagnostic> {
        Self::ALL.into_iter().find(|grade| grade.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let grades = names.join(", ");
            let help = match did_you_mean(name, names) {
                Some(close) => format!("write {close}; the grades are {grades}"),
                None => format!("write one of {grades}"),
            };
            Diagnostic::error("", format!("`{name}` is not an evidence grade")).help(help)
        })
    }
}

/// The grade of one thing in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Graded {
    /// Key of the parameter whose default is graded; empty for the formula itself. A parameter set by the user is graded `user`.
    pub key: &'static str,
    /// The grade.
    pub grade: Evidence,
    /// The basis of the grade.
    pub because: &'static str,
}

/// Grade of a model's formula.
pub const fn formula(grade: Evidence, because: &'static str) -> Graded {
    Graded {
        key: "",
        grade,
        because,
    }
}

/// Grade of the default of one parameter.
pub const fn default_of(key: &'static str, grade: Evidence, because: &'static str) -> Graded {
    Graded { key, grade, because }
}

/// Source of a model whose law the user states, such as `formula` and `table`.
pub const USER_DEFINED: &str = "user-defined";

/// A type-erased `Arc<M::Model>`.
pub type Built = Box<dyn Any + Send + Sync>;

/// One model.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Key of the mechanism.
    pub mechanism: &'static str,
    /// Name in documents.
    pub name: &'static str,
    /// Primary source.
    pub source: &'static str,
    /// A valid `model:` record, in YAML flow style.
    pub example: &'static str,
    /// A part that the example is intended for, in YAML; default: that of the mechanism.
    pub part: Option<&'static str>,
    /// Files that the example names, with their text.
    pub files: &'static [(&'static str, &'static str)],
    /// Ranges in which the source states the formula to hold.
    pub limits: &'static [Limit],
    /// Named parts of the result.
    pub terms: &'static [Term],
    /// Quantities reported to the reader.
    pub observed: &'static [Observed],
    /// Evidence grades of formula and defaults.
    pub evidence: &'static [Graded],
    /// Cases with known results.
    pub checks: &'static [Check],
    /// Whether a drag model is evaluated once for each gear or once for each mesh; unused for other mechanisms.
    pub scope: Scope,
    /// False for a mesh model that applies to any pair of gears and does not use the tooth geometry; unused for other mechanisms.
    pub geometry: bool,
    /// True for a law of friction that holds for plastic flanks, too; unused for other mechanisms.
    pub plastics: bool,
    /// Where it is registered.
    pub origin: Origin,
    /// Schema of the parameters.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Builds the model from the resolved parameters.
    pub build: fn(&Value, &mut Build<'_>) -> Result<Built, Diagnostic>,
}

inventory::collect!(Entry);

impl Entry {
    /// Keys of the models that this one requires, each with its mechanism: `tooth_friction` of a mesh model. Read from the schema
    /// of the parameters, where the slot of a model is a reference to the models of its mechanism.
    pub fn required_slots(&self) -> Vec<(String, String)> {
        let schema = (self.schema)(&mut SchemaGenerator::default()).to_value();
        let is_required = |key: &String| {
            let required = schema.get("required").and_then(Value::as_array);
            required.is_some_and(|list| list.iter().any(|name| name.as_str() == Some(key)))
        };
        let mechanism = |record: &Value| {
            let reference = record
                .get("$ref")
                .or_else(|| record.pointer("/allOf/0/$ref"))?
                .as_str()?;
            let name = reference.strip_prefix("#/definitions/")?.strip_suffix("_model")?;
            Some(name.to_owned())
        };
        let keys = schema.get("properties").and_then(Value::as_object);
        let slots = keys.into_iter().flatten().filter(|(key, _)| is_required(key));
        slots
            .filter_map(|(key, record)| Some((key.clone(), mechanism(record)?)))
            .collect()
    }

    /// True if the user states the law of the model: it has no published source.
    pub fn is_user_defined(&self) -> bool {
        self.source == USER_DEFINED
    }

    /// Description, as a sentence: the first paragraph of the doc comment of its parameters.
    pub fn meaning(&self) -> String {
        let schema = (self.schema)(&mut SchemaGenerator::default());
        let doc = schema.get("description").and_then(Value::as_str).unwrap_or_default();
        doc.split("\n\n").next().unwrap_or_default().replace('\n', " ")
    }
}

/// One mechanism, without its types.
#[derive(Clone, Copy)]
pub struct MechanismEntry {
    /// Name in documents.
    pub key: &'static str,
    /// Description.
    pub meaning: &'static str,
    /// Result of its models, with unit.
    pub answer: &'static str,
    /// A part in YAML.
    pub example: &'static str,
    /// Where it is registered.
    pub origin: Origin,
    /// Section of its parts, if it has one.
    pub section: Option<Section>,
    /// The quantities of its context.
    pub quantities: fn() -> Vec<QuantityDoc>,
    /// The laws between them, in their written form.
    pub laws: fn() -> Vec<&'static str>,
    /// `none`, `constant`, `formula` and `table` for this mechanism.
    pub generics: fn() -> Vec<Entry>,
    /// Schema of a part.
    pub part: fn(&mut SchemaGenerator) -> Schema,
    /// Evaluates a model alone: resolved model, part and quantities in their documented units.
    pub eval: fn(&Registry, &Files, &Value, &Value, &Map<String, Value>) -> Result<Evaluated, Diagnostic>,
    /// Faults of a model on a part, from the conformance suite.
    pub conform: fn(&Registry, &Files, &Entry, &Value, &Value) -> Vec<String>,
    /// Whether the law of a model on a part is generic; see [`Language::is_generic`](crate::language::Language::is_generic).
    pub is_generic: fn(&Registry, &Files, &Value, &Value) -> Option<bool>,
}

inventory::collect!(MechanismEntry);

/// A catalogue: values that fill the omitted keys of a component by its designation.
#[derive(Debug, Clone, Copy)]
pub struct Catalogue {
    /// Section whose components it fills.
    pub section: &'static str,
    /// CSV text: `designation`, then keys of the section with their unit in the header, then `estimated`, `confidence` and `basis`; with
    /// commas, decimal points and no quotes. A row is read when a document names it.
    pub csv: &'static str,
    /// Its source and licence.
    pub source: &'static str,
    /// Where it is registered.
    pub origin: Origin,
}

inventory::collect!(Catalogue);

/// A model set that a crate ships by name.
#[derive(Debug, Clone, Copy)]
pub struct ShippedSet {
    /// Name in `--models` and in studies.
    pub name: &'static str,
    /// Description.
    pub meaning: &'static str,
    /// The set in YAML, as under `model_sets`.
    pub yaml: &'static str,
    /// Where it is registered.
    pub origin: Origin,
}

inventory::collect!(ShippedSet);

/// A driving cycle that a crate ships by name.
#[derive(Debug, Clone, Copy)]
pub struct ShippedCycle {
    /// Name in studies.
    pub name: &'static str,
    /// CSV text: `time [s],speed [km/h]`, the vehicle's speed.
    pub csv: &'static str,
    /// Names of its phases with the time at which each ends; empty if it has none. \[s\]
    pub phases: &'static [(&'static str, f64)],
    /// Its source.
    pub source: &'static str,
    /// Where it is registered.
    pub origin: Origin,
}

inventory::collect!(ShippedCycle);

/// A kind of document that another crate reads with its own schema, such as a study.
#[derive(Debug, Clone, Copy)]
pub struct DocumentKind {
    /// Name of its schema.
    pub name: &'static str,
    /// The schema, without the model sets that such a document may hold.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
}

inventory::collect!(DocumentKind);

/// All available mechanisms and models, sorted by name.
#[derive(Clone)]
pub struct Registry {
    mechanisms: Vec<MechanismEntry>,
    models: Vec<Entry>,
    catalogues: Vec<Catalogue>,
    sets: Vec<ShippedSet>,
    cycles: Vec<ShippedCycle>,
    recipes: Vec<NetworkRecipe>,
    ratings: Vec<RatingPlugin>,
}

impl Registry {
    /// All linked mechanisms and models.
    ///
    /// # Errors
    /// If nothing is linked, or two entries have the same name; each error names modules and lines.
    pub fn linked() -> Result<Self, Vec<Diagnostic>> {
        Self::from_entries(
            inventory::iter::<MechanismEntry>().copied(),
            inventory::iter::<Entry>().copied(),
            inventory::iter::<Catalogue>().copied(),
            inventory::iter::<ShippedSet>().copied(),
        )?
        .with_recipes(inventory::iter::<NetworkRecipe>().copied())
        .with_cycles(inventory::iter::<ShippedCycle>().copied())?
        .with_ratings(inventory::iter::<RatingPlugin>().copied())
    }

    /// The same with recipes for thermal networks.
    pub fn with_recipes(mut self, recipes: impl IntoIterator<Item = NetworkRecipe>) -> Self {
        self.recipes.extend(recipes);
        self.recipes
            .sort_by_key(|r| (r.origin.package, r.origin.file, r.origin.line));
        self
    }

    /// The same with driving cycles.
    ///
    /// # Errors
    /// If two cycles have the same name; each error names modules and lines.
    pub fn with_cycles(mut self, cycles: impl IntoIterator<Item = ShippedCycle>) -> Result<Self, Vec<Diagnostic>> {
        self.cycles.extend(cycles);
        self.cycles
            .sort_by_key(|c| (c.name, c.origin.package, c.origin.file, c.origin.line));
        let found: Vec<_> = self
            .cycles
            .windows(2)
            .filter(|pair| pair[0].name == pair[1].name)
            .map(|pair| twice("cycle", pair[0].name, pair[0].origin, pair[1].origin))
            .collect();
        if found.is_empty() { Ok(self) } else { Err(found) }
    }

    /// A registry of the given entries, for tests and for programs that choose.
    ///
    /// # Errors
    /// As [`Registry::linked`].
    pub fn from_entries(
        mechanisms: impl IntoIterator<Item = MechanismEntry>,
        models: impl IntoIterator<Item = Entry>,
        catalogues: impl IntoIterator<Item = Catalogue>,
        sets: impl IntoIterator<Item = ShippedSet>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut mechanisms: Vec<_> = mechanisms.into_iter().collect();
        mechanisms.sort_by_key(|m| (m.key, m.origin.package, m.origin.file, m.origin.line));
        let mut models: Vec<Entry> = models.into_iter().collect();
        let mut found = Vec::new();
        if models.is_empty() {
            found.push(Diagnostic::error("", "no loss model is linked into this program").help(
                "add a crate with models to the program, such as gearloss-plugins, and write `use gearloss_plugins as _;` once",
            ));
        }
        for mechanism in &mechanisms {
            models.extend((mechanism.generics)());
        }
        models.sort_by_key(|m| (m.mechanism, m.name, m.origin.package, m.origin.file, m.origin.line));
        for pair in mechanisms.windows(2) {
            if pair[0].key == pair[1].key {
                found.push(twice("mechanism", pair[0].key, pair[0].origin, pair[1].origin));
            }
        }
        for pair in models.windows(2) {
            // Two mechanisms with one key register their generic models twice, which needs no separate error.
            let clear = mechanisms.iter().filter(|m| m.key == pair[0].mechanism).count() < 2;
            if clear && (pair[0].mechanism, pair[0].name) == (pair[1].mechanism, pair[1].name) {
                let what = format!("{} model", pair[0].mechanism);
                found.push(twice(&what, pair[0].name, pair[0].origin, pair[1].origin));
            }
        }
        for model in &models {
            if !mechanisms.iter().any(|m| m.key == model.mechanism) {
                found.push(
                    Diagnostic::error(
                        "",
                        format!(
                            "model `{}` refers to the unknown mechanism `{}`",
                            model.name, model.mechanism
                        ),
                    )
                    .note(format!("registered at {}", model.origin))
                    .help("register the mechanism with `register_mechanism!` or `register_component!`"),
                );
            }
        }
        let mut sets: Vec<_> = sets.into_iter().collect();
        sets.sort_by_key(|s| (s.name, s.origin.package, s.origin.file, s.origin.line));
        for pair in sets.windows(2) {
            if pair[0].name == pair[1].name {
                found.push(twice("model set", pair[0].name, pair[0].origin, pair[1].origin));
            }
        }
        let mut catalogues: Vec<_> = catalogues.into_iter().collect();
        catalogues.sort_by_key(|c| (c.section, c.origin.package, c.origin.file, c.origin.line));
        if found.is_empty() {
            Ok(Self {
                mechanisms,
                models,
                catalogues,
                sets,
                cycles: Vec::new(),
                recipes: Vec::new(),
                ratings: Vec::new(),
            })
        } else {
            Err(found)
        }
    }

    /// The mechanisms.
    pub fn mechanisms(&self) -> &[MechanismEntry] {
        &self.mechanisms
    }

    /// One mechanism by its key.
    pub fn mechanism(&self, key: &str) -> Option<&MechanismEntry> {
        self.mechanisms.iter().find(|m| m.key == key)
    }

    /// The models of a mechanism.
    pub fn models<'a>(&'a self, mechanism: &'a str) -> impl Iterator<Item = &'a Entry> {
        self.models.iter().filter(move |m| m.mechanism == mechanism)
    }

    /// One model.
    pub fn model(&self, mechanism: &str, name: &str) -> Option<&Entry> {
        self.models.iter().find(|m| m.mechanism == mechanism && m.name == name)
    }

    /// One mechanism by a key from user input.
    ///
    /// # Errors
    /// If there is none; lists the available ones, or a close match.
    pub fn mechanism_named(&self, key: &str) -> Result<&MechanismEntry, Diagnostic> {
        self.mechanism(key).ok_or_else(|| {
            let names: Vec<&str> = self.mechanisms.iter().map(|m| m.key).collect();
            missing(format!("no mechanism is called `{key}`"), key, &names)
        })
    }

    /// One model of a mechanism by a name from user input.
    ///
    /// # Errors
    /// As [`Registry::mechanism_named`].
    pub fn model_named(&self, mechanism: &str, name: &str) -> Result<&Entry, Diagnostic> {
        self.model(mechanism, name).ok_or_else(|| {
            let names: Vec<&str> = self.models(mechanism).map(|m| m.name).collect();
            missing(format!("no {mechanism} model is called `{name}`"), name, &names)
        })
    }

    /// The mechanisms that have their own section.
    pub fn sections(&self) -> impl Iterator<Item = (&MechanismEntry, &Section)> {
        self.mechanisms
            .iter()
            .filter_map(|m| m.section.as_ref().map(|s| (m, s)))
    }

    /// The catalogues of a section.
    pub fn catalogues<'a>(&'a self, section: &'a str) -> impl Iterator<Item = &'a Catalogue> {
        self.catalogues.iter().filter(move |c| c.section == section)
    }

    /// The model sets that linked crates ship.
    pub fn shipped_sets(&self) -> &[ShippedSet] {
        &self.sets
    }

    /// The driving cycles that linked crates ship, sorted by name.
    pub fn cycles(&self) -> &[ShippedCycle] {
        &self.cycles
    }

    /// One driving cycle by its name.
    pub fn cycle(&self, name: &str) -> Option<&ShippedCycle> {
        self.cycles.iter().find(|c| c.name == name)
    }

    /// The recipe that generates thermal networks.
    ///
    /// # Errors
    /// If no crate ships one, or two do.
    pub(crate) fn network_recipe(&self) -> Result<&NetworkRecipe, Diagnostic> {
        recipe::only(&self.recipes)
    }

    /// Crates that registered something, sorted by name.
    pub fn packages(&self) -> Vec<Package> {
        let models = self.models.iter().map(|m| m.origin);
        let mut packages: Vec<Package> = models
            .chain(self.mechanisms.iter().map(|m| m.origin))
            .chain(self.catalogues.iter().map(|c| c.origin))
            .chain(self.sets.iter().map(|s| s.origin))
            .chain(self.cycles.iter().map(|c| c.origin))
            .chain(self.recipes.iter().map(|r| r.origin))
            .chain(self.ratings.iter().map(|r| r.entry.origin))
            .map(|origin| origin.package)
            .collect();
        packages.sort_unstable();
        packages.dedup();
        packages
    }
}

fn missing(message: String, name: &str, names: &[&str]) -> Diagnostic {
    Diagnostic::error("", message)
        .code(codes::UNKNOWN_NAME)
        .help(match did_you_mean(name, names.iter().copied()) {
            Some(close) => format!("write {close}"),
            None => format!("use one of {}", names.join(", ")),
        })
}

fn twice(what: &str, name: &str, one: Origin, other: Origin) -> Diagnostic {
    Diagnostic::error("", format!("two registrations of the {what} `{name}`"))
        .note(format!("one at {one}, the other at {other}"))
        .help("rename one of them")
        .code(codes::REGISTRATION)
}

/// Reads a struct from a resolved value; a failure is a bug. `type` is the framework's key, not the model's.
pub fn from_resolved<T: DeserializeOwned>(value: &Value) -> Result<T, serde_json::Error> {
    let fields = value
        .as_object()
        .into_iter()
        .flatten()
        .filter(|(key, _)| *key != "type")
        .map(|(key, value)| (key.as_str(), value));
    T::deserialize(serde::de::value::MapDeserializer::new(fields))
}

/// Replaces the registration of an entry in the unit tests of the crates of the framework: its type is checked only, so that they
/// compile only what they use.
#[doc(hidden)]
#[macro_export]
macro_rules! unregistered {
    ($entry:expr) => {
        const _: () = {
            let _ = || $entry;
        };
    };
}

/// Registers a mechanism without its own section.
#[macro_export]
macro_rules! register_mechanism {
    ($M:ty) => {
        $crate::registry::submit! { $crate::registry::MechanismEntry::new::<$M>($crate::origin!()) }
    };
}

/// Registers a mechanism with its section.
#[macro_export]
macro_rules! register_component {
    ($C:ty) => {
        $crate::registry::submit! { $crate::registry::MechanismEntry::component::<$C>($crate::origin!()) }
    };
}

/// Registers a model: mechanism, name in documents, parameters, then its metadata. The doc comment of its parameters describes the
/// model. Without `prepare` the parameters are the model; with it, `prepare(parameters, &mut Build)` builds the model.
#[macro_export]
macro_rules! register {
    ($M:ty, $name:literal, $Params:ty,
        source: $source:expr, example: $example:expr, $(part: $part:expr,)? $(files: [$($file:expr),* $(,)?],)?
        evidence: [$($graded:expr),* $(,)?] $(, checks: [$($check:expr),* $(,)?])?
        $(, limits: [$($limit:expr),* $(,)?])? $(, terms: [$($term:expr),* $(,)?])? $(, observed: [$($observed:expr),* $(,)?])?
        $(, scope: $scope:expr)? $(, geometry: $geometry:expr)? $(, plastics: $plastics:expr)? $(, prepare: $prepare:expr)? $(,)?) => {
        $crate::registry::submit! {
            $crate::registry::Entry {
                mechanism: <$M as $crate::mechanism::Mechanism>::KEY, name: $name, source: $source, example: $example, part: $crate::register!(@part $($part)?), files: &[$($($file),*)?], evidence: &[$($graded),*],
                limits: &[$($($limit),*)?], terms: &[$($($term),*)?], observed: &[$($($observed),*)?],
                checks: &[$($($check),*)?],
                scope: $crate::register!(@scope $($scope)?),
                geometry: $crate::register!(@geometry $($geometry)?),
                plastics: $crate::register!(@plastics $($plastics)?),
                origin: $crate::origin!(),
                schema: |generator| <$Params as $crate::schemars::JsonSchema>::json_schema(generator),
                build: |value, cx| {
                    let params: $Params = cx.params(value)?;
                    let model = $crate::register!(@model params, cx $(, $prepare)?);
                    let model: ::std::sync::Arc<<$M as $crate::mechanism::Mechanism>::Model> = ::std::sync::Arc::new(model);
                    Ok(Box::new(model))
                },
            }
        }
    };
    (@part) => { None };
    (@part $part:expr) => { Some($part) };
    (@scope) => { $crate::mechanism::gear_drag::Scope::Gear };
    (@scope $scope:expr) => { $scope };
    (@plastics) => { false };
    (@plastics $plastics:expr) => { $plastics };
    (@geometry) => { true };
    (@geometry $geometry:expr) => { $geometry };
    (@model $params:ident, $cx:ident) => { $params };
    (@model $params:ident, $cx:ident, $prepare:expr) => { $prepare($params, $cx)? };
}
