//! The models that take part: of each mechanism those that the entry lists, or all that can be built.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::{Entry, Registry};
use gearloss_framework::transmission::Transmission;
use serde_json::{Value, json};

use super::super::{Built, Planner, Stopped};
use super::entry::CandidatesEntry;
use super::slot::Slot;

/// The entrants of one mechanism.
pub struct Entrants {
    /// Place of its entry in the study.
    pub path: String,
    /// The mechanism, without candidates.
    pub slot: Slot,
    /// True if the entry lists its models: then each must have a loss.
    pub named: bool,
    /// The models.
    pub list: Vec<Entrant>,
    /// Why models that need further models are omitted.
    pub left_out: Vec<String>,
}

/// A model, and the gearbox with it.
pub struct Entrant {
    /// Its name.
    pub name: String,
    /// As in a gearbox.
    pub model: Value,
    /// The gearbox, or why it cannot be built.
    pub built: Result<Transmission, String>,
}

impl Entrants {
    /// The entrants of all mechanisms, built into the gearbox of the base.
    ///
    /// # Errors
    /// A mechanism that is listed twice or has no models; a listed model that cannot be built.
    pub fn all(cx: &Planner<'_>, entries: &[CandidatesEntry], base: &Built<'_>) -> Result<Vec<Self>, Stopped> {
        let mut all: Vec<Self> = Vec::new();
        for (i, entry) in entries.iter().enumerate() {
            let path = format!("{}.mechanisms.{i}", cx.path());
            let slot = Slot::new(cx, &path, entry)?;
            if all.iter().any(|other| other.slot.name == slot.name) {
                let message = format!("`{}` is listed twice", slot.name);
                return Err(cx.wrong(&path, message, "list it once"));
            }
            all.push(Self::new(cx, path, entry, slot, base)?);
        }
        Ok(all)
    }

    /// The entrants of one mechanism, whose entry is at a path of the study.
    ///
    /// # Errors
    /// As [`Entrants::all`].
    pub fn new(
        cx: &Planner<'_>,
        path: String,
        entry: &CandidatesEntry,
        slot: Slot,
        base: &Built<'_>,
    ) -> Result<Self, Stopped> {
        let named = !entry.models.is_empty();
        if slot.is_drag() && !named {
            let message = format!(
                "`{}` includes laws for churning, injection and windage",
                entry.mechanism
            );
            let help = "list the candidates: `models: { a: { type: diab } }`";
            return Err(cx.wrong(&path, message, help));
        }
        let mut left_out = Vec::new();
        let models: Vec<(String, Value)> = if named {
            let models = entry.models.iter();
            models.map(|(name, model)| (name.to_owned(), model.clone())).collect()
        } else {
            let registry = cx.language.registry();
            let all = takes_part(registry, &entry.mechanism);
            all.flat_map(|model| with_nested(registry, model, &slot.name, &mut left_out))
                .collect()
        };
        let entrant = |(name, model): (String, Value)| Entrant {
            built: built(cx, &slot, base, &model),
            name,
            model,
        };
        let list: Vec<Entrant> = models.into_iter().map(entrant).collect();
        let entrants = Self {
            path,
            slot,
            named,
            list,
            left_out,
        };
        for entrant in &entrants.list {
            if let (true, Err(reason)) = (named, &entrant.built) {
                return Err(entrants.unusable_model(cx, &entrant.name, reason));
            }
        }
        if entrants.list.iter().all(|entrant| entrant.built.is_err()) {
            return Err(entrants.no_usable_model(cx));
        }
        Ok(entrants)
    }

    /// A listed model cannot be built, or has no loss.
    pub fn unusable_model(&self, cx: &Planner<'_>, name: &str, reason: &str) -> Stopped {
        let help = "`gearloss models --needs GEARBOX` lists the inputs of a model";
        cx.wrong(&format!("{}.models.{name}", self.path), reason, help)
    }

    /// No model can be built and has a loss.
    pub fn no_usable_model(&self, cx: &Planner<'_>) -> Stopped {
        let message = format!("no model of `{}` can be evaluated", self.slot.name);
        let help = "`gearloss models --needs GEARBOX` lists the inputs of models";
        cx.wrong(&self.path, message, help)
    }
}

/// The gearbox of the base with a model.
fn built(cx: &Planner<'_>, slot: &Slot, base: &Built<'_>, model: &Value) -> Result<Transmission, String> {
    let changed = slot.with(cx.language, &base.resolved, model)?;
    let built = base.gearbox.build(cx.language, &changed);
    built.map_err(|findings| first_message(&findings.list))
}

/// The first error of a list.
pub fn first_message(list: &[Diagnostic]) -> String {
    let first = list.first();
    first.map_or_else(String::new, |d| format!("{}: {}", d.path, d.message))
}

/// The default candidates of a mechanism.
fn takes_part<'a>(registry: &'a Registry, mechanism: &'a str) -> impl Iterator<Item = &'a Entry> {
    let models = registry.models(mechanism);
    models.filter(|model| !model.is_user_defined() && model.name != "none")
}

/// A model with its defaults; if it needs a nested model, such as a law of friction for an integral over the path of contact, once with
/// each of them. Only one level: models with a nested model of the same mechanism are omitted, and laws with a further nested model must be
/// listed by the user.
fn with_nested(registry: &Registry, model: &Entry, slot: &str, left_out: &mut Vec<String>) -> Vec<(String, Value)> {
    let mut all = vec![(Vec::<String>::new(), json!({ "type": model.name }))];
    for (key, mechanism) in model.required_slots() {
        if mechanism == model.mechanism {
            left_out.push(format!(
                "{slot} {}: it needs another {mechanism}; list it under `models`",
                model.name
            ));
            return Vec::new();
        }
        let (deep, plain): (Vec<&Entry>, Vec<&Entry>) =
            takes_part(registry, &mechanism).partition(|nested| !nested.required_slots().is_empty());
        for nested in deep {
            left_out.push(format!(
                "{slot} {}/{}: its {mechanism} needs a further model; list it under `models`",
                model.name, nested.name
            ));
        }
        let with = |(names, value): &(Vec<String>, Value)| {
            let one = |nested: &&Entry| {
                let (mut names, mut value) = (names.clone(), value.clone());
                names.push(nested.name.to_owned());
                value[key.as_str()] = json!({ "type": nested.name });
                (names, value)
            };
            plain.iter().map(one).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(with).collect();
    }
    let named = |(nested, value): (Vec<String>, Value)| {
        let name = if nested.is_empty() {
            model.name.to_owned()
        } else {
            format!("{}/{}", model.name, nested.join("+"))
        };
        (name, value)
    };
    all.into_iter().map(named).collect()
}
