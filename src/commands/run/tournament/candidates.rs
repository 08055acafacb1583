//! The models that take part, each evaluated once.

use gearloss_framework::language::{DRAGS, HELD, Language};
use gearloss_framework::registry::{Entry, Registry};
use gearloss_framework::resolve::{Came, Resolved};
use gearloss_framework::transmission::{PartInfo, Transmission};
use gearloss_studies::analysis::{Field, GridResult, PointResult, Points, run_grid};
use gearloss_studies::study::{CandidatesEntry, TournamentEntry};
use serde_json::{Map, Value};

use super::super::{Built, Runner};
use super::marks::{Mark, marks};
use crate::interrupt;
use crate::output::Failure;

/// Relative difference of losses up to which two models lose the same: what the iterated flow of power leaves.
const ALIKE: f64 = 1e-9;

/// A mechanism whose models change.
pub struct Slot {
    /// Mechanism, with the slot of a drag.
    pub name: String,
    mechanism: String,
    /// Name among the drags of a gear.
    drag: Option<String>,
    /// The models.
    pub candidates: Vec<Candidate>,
}

/// A model, and what it loses at every point.
pub struct Candidate {
    /// Name in the tournament.
    pub name: String,
    /// The model as in a gearbox.
    pub model: Value,
    /// \[W\]
    pub loss: Vec<f64>,
    /// Time of all points over that of the set which the tournament starts from.
    pub time: f64,
    /// Stated ranges that it leaves at the points.
    pub marks: Vec<Mark>,
}

impl Slot {
    /// True for the parts of this mechanism, and slot.
    pub fn covers(&self, part: &PartInfo) -> bool {
        let slot = self.drag.as_ref().map(|slot| format!(".drag.{slot}"));
        part.mechanism == self.mechanism && slot.is_none_or(|slot| part.path.ends_with(&slot))
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

    /// The description with another model, nothing for that of the set, in every place of the mechanism that has no model of its own.
    pub fn with(&self, language: &Language, resolved: &Resolved, model: &Value) -> Result<Resolved, String> {
        let mut changed = resolved.clone();
        if model.is_null() {
            return Ok(changed);
        }
        let Some(slot) = &self.drag else {
            let section = section(language, &self.mechanism).ok_or("its models sit in no section of the gearbox")?;
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
                let own = drags.contains_key(slot) && !taken_over(resolved, &path);
                if own {
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

/// True where a model came from a set or the defaults by mechanism.
fn taken_over(resolved: &Resolved, path: &str) -> bool {
    matches!(resolved.came(path), Came::Models | Came::Set(_))
}

fn checked(language: &Language, model: &Value, path: &str) -> Result<Value, String> {
    let first = |list: Vec<gearloss_framework::document::Diagnostic>| {
        let first = list.into_iter().next();
        first.map_or_else(String::new, |d| match d.mend {
            Some(mend) => format!("{}; {mend}", d.message),
            None => d.message,
        })
    };
    language.checked(model, path).map_err(first)
}

/// Section that holds the models of a mechanism.
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

/// The slots with their candidates, and why others cannot take part.
pub fn slots(
    runner: &Runner<'_>,
    path: &str,
    entry: &TournamentEntry,
    base: &Built<'_>,
    (points, solved): (&Points, &GridResult),
) -> Result<(Vec<Slot>, Vec<String>), Failure> {
    let time = if runner.only_checks {
        0.0
    } else {
        timed(&base.transmission, points)?
    };
    let (mut slots, mut left_out): (Vec<Slot>, Vec<String>) = (Vec::new(), Vec::new());
    for (i, candidates) in entry.mechanisms.iter().enumerate() {
        let path = format!("{path}.mechanisms.{i}");
        let slot = slot(runner, &path, candidates)?;
        if slots.iter().any(|s| s.name == slot.name) {
            return Err(runner.wrong(&path, format!("`{}` stands twice", slot.name), "name it once"));
        }
        let mut slot = filled(runner, &path, candidates, slot, base, points, time, &mut left_out)?;
        // Where all take part, so does what the set has.
        if candidates.models.is_empty() {
            let own: Vec<usize> = (0..base.transmission.parts().len())
                .filter(|i| slot.covers(&base.transmission.parts()[*i]))
                .collect();
            let of_own = |p: &PointResult| own.iter().map(|i| p.parts[*i]).sum();
            let loss: Vec<f64> = solved.points.iter().map(of_own).collect();
            let same = |model: &Value| slot.with(runner.language, &base.resolved, model).map(|r| r.value);
            let twin = |candidate: &Candidate| same(&candidate.model).as_ref() == Ok(&base.resolved.value);
            let twins: Vec<bool> = slot.candidates.iter().map(twin).collect();
            let mut twins = twins.into_iter();
            slot.candidates.retain(|_| twins.next() != Some(true));
            slot.candidates.insert(
                0,
                Candidate {
                    name: format!("as in {}", base.name),
                    model: Value::Null,
                    loss,
                    time: 1.0,
                    marks: if solved.seen.is_empty() {
                        Vec::new()
                    } else {
                        let replaced = slot.replaced(runner.language, &base.resolved);
                        marks(&base.transmission, &solved.seen, &replaced)
                    },
                },
            );
        }
        if candidates.models.is_empty() {
            merge_alike(&mut slot, &mut left_out);
        }
        slots.push(slot);
    }
    Ok((slots, left_out))
}

/// Models that lose the same at every point are one candidate: as several they would share its weight, and add nothing to the spread.
fn merge_alike(slot: &mut Slot, left_out: &mut Vec<String>) {
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in std::mem::take(&mut slot.candidates) {
        let alike = |other: &&Candidate| {
            let pairs = candidate.loss.iter().zip(&other.loss);
            !candidate.loss.is_empty()
                && pairs
                    .into_iter()
                    .all(|(a, b)| (a - b).abs() <= ALIKE * a.abs().max(b.abs()))
        };
        match kept.iter().find(alike) {
            Some(other) => left_out.push(format!(
                "{} {}: loses the same as `{}` at every point",
                slot.name, candidate.name, other.name
            )),
            None => kept.push(candidate),
        }
    }
    slot.candidates = kept;
}

fn slot(runner: &Runner<'_>, path: &str, entry: &CandidatesEntry) -> Result<Slot, Failure> {
    let registry = runner.language.registry();
    let drag = entry.mechanism == DRAGS;
    if !drag && section(runner.language, &entry.mechanism).is_none() {
        let keys: Vec<&str> = registry.mechanisms().iter().map(|m| m.key).collect();
        let fits = |key: &&str| *key == DRAGS || section(runner.language, key).is_some();
        let keys: Vec<&str> = keys.into_iter().filter(fits).collect();
        let message = format!("`{}` is no mechanism whose models change", entry.mechanism);
        let mend = format!("name one of {}", keys.join(", "));
        return Err(runner.wrong(&format!("{path}.mechanism"), message, &mend));
    }
    let slot = match (&entry.slot, drag) {
        (slot, true) => Some(slot.clone().unwrap_or_else(|| "churning".to_owned())),
        (None, false) => None,
        (Some(_), false) => {
            let message = format!("`{}` has no slots", entry.mechanism);
            return Err(runner.wrong(&format!("{path}.slot"), message, "leave `slot` out"));
        }
    };
    Ok(Slot {
        name: match &slot {
            Some(slot) => format!("{}.{slot}", entry.mechanism),
            None => entry.mechanism.clone(),
        },
        mechanism: entry.mechanism.clone(),
        drag: slot,
        candidates: Vec::new(),
    })
}

#[allow(clippy::too_many_arguments)]
fn filled(
    runner: &Runner<'_>,
    path: &str,
    entry: &CandidatesEntry,
    mut slot: Slot,
    base: &Built<'_>,
    points: &Points,
    time: f64,
    left_out: &mut Vec<String>,
) -> Result<Slot, Failure> {
    let named = !entry.models.is_empty();
    if slot.drag.is_some() && !named {
        let message = format!(
            "laws for churning, injection and windage stand side by side in `{}`",
            entry.mechanism
        );
        return Err(runner.wrong(
            path,
            message,
            "name those that take part: `models: { a: { type: diab } }`",
        ));
    }
    let models: Vec<(String, Value)> = if named {
        entry
            .models
            .iter()
            .map(|(name, model)| (name.to_owned(), model.clone()))
            .collect()
    } else {
        let registry = runner.language.registry();
        let all = takes_part(registry, &entry.mechanism);
        all.flat_map(|model| with_nested(registry, model, &slot.name, left_out))
            .collect()
    };
    for (name, model) in models {
        match evaluated(runner, &slot, base, points, &model) {
            Err(Refused::Interrupted) => return Err(Failure::Interrupted),
            Err(Refused::Because(reason)) if named => {
                let mend = "`gearloss models --needs GEARBOX` tells what a model needs";
                return Err(runner.wrong(&format!("{path}.models.{name}"), reason, mend));
            }
            Err(Refused::Because(reason)) => left_out.push(format!("{} {name}: {reason}", slot.name)),
            Ok((loss, seconds, marks)) => slot.candidates.push(Candidate {
                name,
                model,
                loss,
                time: if time > 0.0 { seconds / time } else { 1.0 },
                marks,
            }),
        }
    }
    if slot.candidates.is_empty() {
        let message = format!("no model of `{}` can take part", slot.name);
        return Err(runner.wrong(
            path,
            message,
            "`gearloss models --needs GEARBOX` tells what models need",
        ));
    }
    Ok(slot)
}

/// The models of a mechanism that take part where none are named.
fn takes_part<'a>(registry: &'a Registry, mechanism: &'a str) -> impl Iterator<Item = &'a Entry> {
    let models = registry.models(mechanism);
    models.filter(|model| model.source != "the user's own" && model.name != "none")
}

/// A model with its defaults: where it cannot do without models of its own, as `path_integral` without a `tooth_friction`, once with each of
/// them. One level deep: a model that takes another one of its own mechanism computes what that one computes, and a law that takes a
/// further one is for the user to name.
fn with_nested(registry: &Registry, model: &Entry, slot: &str, left_out: &mut Vec<String>) -> Vec<(String, Value)> {
    let mut all = vec![(Vec::<String>::new(), serde_json::json!({ "type": model.name }))];
    for (key, mechanism) in model.required_slots() {
        if mechanism == model.mechanism {
            left_out.push(format!(
                "{slot} {}: it takes another {mechanism}; name it under `models`",
                model.name
            ));
            return Vec::new();
        }
        let (deep, plain): (Vec<&Entry>, Vec<&Entry>) =
            takes_part(registry, &mechanism).partition(|nested| !nested.required_slots().is_empty());
        for nested in deep {
            left_out.push(format!(
                "{slot} {}/{}: its {mechanism} takes a further model; name it under `models`",
                model.name, nested.name
            ));
        }
        let with = |(names, value): &(Vec<String>, Value)| {
            let one = |nested: &&Entry| {
                let (mut names, mut value) = (names.clone(), value.clone());
                names.push(nested.name.to_owned());
                value[key.as_str()] = serde_json::json!({ "type": nested.name });
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

/// Why a model cannot take part.
enum Refused {
    Because(String),
    Interrupted,
}

/// Losses of the slot's parts under one model, how long all points took, and the stated ranges that it left.
fn evaluated(
    runner: &Runner<'_>,
    slot: &Slot,
    base: &Built<'_>,
    points: &Points,
    model: &Value,
) -> Result<(Vec<f64>, f64, Vec<Mark>), Refused> {
    let because = |list: &[gearloss_framework::document::Diagnostic]| {
        let first = list.first();
        Refused::Because(first.map_or_else(String::new, |d| format!("{}: {}", d.path, d.message)))
    };
    let changed = slot
        .with(runner.language, &base.resolved, model)
        .map_err(Refused::Because)?;
    let transmission = base
        .gearbox
        .build(runner.language, &changed)
        .map_err(|findings| because(&findings.list))?;
    if runner.only_checks {
        return Ok((Vec::new(), 0.0, Vec::new()));
    }
    let solved = run_grid(&transmission, points, &|_| !interrupt::pressed()).map_err(|list| because(&list))?;
    let solved = solved.ok_or(Refused::Interrupted)?;
    runner.seen(&transmission, &solved.seen);
    if let Some(p) = solved.points.iter().find(|p| p.loss.is_none()) {
        let why = p.undefined.map_or_else(
            || p.status.name().to_owned(),
            |(part, reason)| format!("{}: {reason}", transmission.parts()[part].path),
        );
        return Err(Refused::Because(format!(
            "no loss at {} Nm, {:.0} rpm ({why})",
            p.torque,
            p.speed * super::super::super::solve::RPM
        )));
    }
    let covered: Vec<usize> = (0..transmission.parts().len())
        .filter(|i| slot.covers(&transmission.parts()[*i]))
        .collect();
    let loss = solved.points.iter().map(|p| covered.iter().map(|i| p.parts[*i]).sum());
    let loss = loss.collect();
    let seconds = timed(&transmission, points).map_err(|_| Refused::Interrupted)?;
    let replaced = slot.replaced(runner.language, &base.resolved);
    Ok((loss, seconds, marks(&transmission, &solved.seen, &replaced)))
}

/// Time that one thread takes for the points at hand, the least of a few tries. Only its ratio to others counts. \[s\]
fn timed(transmission: &Transmission, points: &Points) -> Result<f64, Failure> {
    let few = Points {
        field: Field::List((0..points.field.len().min(32)).map(|i| points.field.at(i)).collect()),
        ..points.clone()
    };
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let begun = std::time::Instant::now();
        if !matches!(run_grid(transmission, &few, &|_| !interrupt::pressed()), Ok(Some(_))) {
            return Err(Failure::Interrupted);
        }
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok(least)
}
