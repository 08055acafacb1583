//! A mechanism with varied models, and their paths in a description.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::language::{DRAGS, HELD, Language};
use gearloss_framework::resolve::{Resolved, ValueSource};
use gearloss_framework::transmission::PartInfo;
use serde_json::{Map, Value};

use super::super::{Planner, Stopped};
use super::entry::CandidatesEntry;
use super::law_loss::LossOfLaw;
use super::marks::Mark;

/// A mechanism with varied models.
#[derive(Clone)]
pub struct Slot {
    /// Mechanism, with the slot of a drag.
    pub name: String,
    mechanism: String,
    /// Name among the drags of a gear.
    drag: Option<String>,
    /// The models.
    pub candidates: Vec<Candidate>,
}

/// A model and its loss at every point.
#[derive(Clone)]
pub struct Candidate {
    /// Name in the tournament.
    pub name: String,
    /// The model as in a gearbox.
    pub model: Value,
    /// \[W\]
    pub loss: Vec<f64>,
    /// Time of all points relative to that of the base set.
    pub time: f64,
    /// Quantities outside their stated ranges at the points.
    pub marks: Vec<Mark>,
    /// Losses by laws with a known error, if it is asked for.
    pub laws: Vec<LossOfLaw>,
}

impl Slot {
    /// From an entry at a path, without candidates.
    pub fn new(cx: &Planner<'_>, path: &str, entry: &CandidatesEntry) -> Result<Self, Stopped> {
        let drag = entry.mechanism == DRAGS;
        if !drag && section(cx.language, &entry.mechanism).is_none() {
            let keys = cx.language.registry().mechanisms();
            let fits = |key: &&str| *key == DRAGS || section(cx.language, key).is_some();
            let keys: Vec<&str> = keys.iter().map(|m| m.key).filter(fits).collect();
            let message = format!("`{}` is not a mechanism with exchangeable models", entry.mechanism);
            let help = format!("write one of {}", keys.join(", "));
            return Err(cx.wrong(&format!("{path}.mechanism"), message, &help));
        }
        let slot = match (&entry.slot, drag) {
            (slot, true) => Some(slot.clone().unwrap_or_else(|| "churning".to_owned())),
            (None, false) => None,
            (Some(_), false) => {
                let message = format!("`{}` has no slots", entry.mechanism);
                return Err(cx.wrong(&format!("{path}.slot"), message, "delete `slot`"));
            }
        };
        Ok(Self {
            name: match &slot {
                Some(slot) => format!("{}.{slot}", entry.mechanism),
                None => entry.mechanism.clone(),
            },
            mechanism: entry.mechanism.clone(),
            drag: slot,
            candidates: Vec::new(),
        })
    }

    /// True for the drags of gears.
    pub fn is_drag(&self) -> bool {
        self.drag.is_some()
    }

    /// True for laws of its mechanism.
    pub fn is_of(&self, mechanism: &str) -> bool {
        self.mechanism == mechanism
    }

    /// True for the parts of this mechanism, and slot.
    pub fn covers(&self, part: &PartInfo) -> bool {
        let slot = self.drag.as_ref().map(|slot| format!(".drag.{slot}"));
        part.mechanism == self.mechanism && slot.is_none_or(|slot| part.path.ends_with(&slot))
    }

    /// Indices of the components that it covers.
    pub fn covered(&self, parts: &[PartInfo]) -> Vec<usize> {
        (0..parts.len()).filter(|i| self.covers(&parts[*i])).collect()
    }

    /// Paths at which the models of the set are replaced.
    pub fn replaced(&self, language: &Language, resolved: &Resolved) -> Vec<String> {
        let all = |section: &str, end: &str| -> Vec<String> {
            let ids = resolved.value.get(section).and_then(Value::as_object);
            let paths = ids.into_iter().flatten().map(|(id, _)| format!("{section}.{id}.{end}"));
            paths.filter(|path| taken_over(resolved, path)).collect()
        };
        match &self.drag {
            Some(slot) => ["gears", "meshes"]
                .iter()
                .flat_map(|section| all(section, &format!("drag.{slot}")))
                .collect(),
            None => section(language, &self.mechanism).map_or_else(Vec::new, |section| all(section, "model")),
        }
    }

    /// The description with another model (null for the model of the set) in every slot of the mechanism without its own model.
    pub fn with(&self, language: &Language, resolved: &Resolved, model: &Value) -> Result<Resolved, String> {
        let mut changed = resolved.clone();
        if model.is_null() {
            return Ok(changed);
        }
        let Some(slot) = &self.drag else {
            let section = section(language, &self.mechanism).ok_or("its models are not in a section of the gearbox")?;
            for (id, record) in records(&mut changed.value, section) {
                let path = format!("{section}.{id}.model");
                if taken_over(resolved, &path) {
                    record.insert("model".to_owned(), checked(language, model, &path)?);
                }
            }
            return Ok(changed);
        };
        for section in ["gears", "meshes"] {
            for (id, record) in records(&mut changed.value, section) {
                let path = format!("{section}.{id}.drag.{slot}");
                let Some(drags) = record.get_mut("drag").and_then(Value::as_object_mut) else {
                    continue;
                };
                let is_drag = drags.contains_key(slot) && !taken_over(resolved, &path);
                if is_drag {
                    continue;
                }
                drags.shift_remove(slot);
                if language.fits_scope(section, model) {
                    drags.insert(slot.clone(), checked(language, model, &path)?);
                }
            }
        }
        Ok(changed)
    }
}

/// True if a model is from a set or from the defaults by mechanism.
fn taken_over(resolved: &Resolved, path: &str) -> bool {
    matches!(resolved.source_of(path), ValueSource::Models | ValueSource::Set(_))
}

fn checked(language: &Language, model: &Value, path: &str) -> Result<Value, String> {
    let first = |list: Vec<Diagnostic>| {
        let first = list.into_iter().next();
        first.map_or_else(String::new, |d| match d.help {
            Some(help) => format!("{}; {help}", d.message),
            None => d.message,
        })
    };
    language.checked(model, path).map_err(first)
}

/// Section of the models of a mechanism.
fn section<'l>(language: &'l Language, mechanism: &str) -> Option<&'l str> {
    let held = HELD
        .iter()
        .find(|(_, key)| *key == mechanism)
        .map(|(section, _)| *section);
    held.or_else(|| {
        language
            .registry()
            .mechanism(mechanism)?
            .section
            .as_ref()
            .map(|s| s.name)
    })
}

fn records<'a>(
    value: &'a mut Value,
    section: &str,
) -> impl Iterator<Item = (&'a String, &'a mut Map<String, Value>)> + use<'a> {
    let section = value.get_mut(section).and_then(Value::as_object_mut);
    section
        .into_iter()
        .flatten()
        .filter_map(|(id, record)| record.as_object_mut().map(|record| (id, record)))
}
