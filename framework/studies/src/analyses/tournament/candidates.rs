//! The candidate models, each evaluated once.

use std::time::Instant;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::{Entry, Registry};
use gearloss_framework::transmission::Transmission;
use serde_json::{Value, json};

use super::super::numbers::RPM;
use super::super::{Built, Context, Stopped};
use super::CandidatesEntry;
use super::marks::{Mark, marks};
use super::slot::{Candidate, Slot};
use crate::points::{Field, GridResult, PointResult, Points, notes, run_grid};

/// Relative difference of losses below which two models are equal: residual of the iterated power flow.
const ALIKE: f64 = 1e-9;

/// Data for the evaluation of models, and the results so far.
pub struct Gathering<'a> {
    cx: &'a Context<'a>,
    base: &'a Built<'a>,
    points: &'a Points,
    solved: &'a GridResult,
    /// Time of the base set. \[s\]
    time: f64,
    /// The mechanisms with their candidates.
    pub slots: Vec<Slot>,
    /// Why other models are omitted.
    pub left_out: Vec<String>,
    /// Number of quantities outside their stated ranges.
    pub unlisted: usize,
}

/// Why a model is omitted.
enum Refused {
    Because(String),
    Interrupted,
}

/// Results of a candidate at the points.
struct Evaluated {
    /// \[W\]
    loss: Vec<f64>,
    /// \[s\]
    seconds: f64,
    marks: Vec<Mark>,
}

impl<'a> Gathering<'a> {
    /// All candidates of the mechanisms at the solved points of the base. If an analysis is only checked, models are only built.
    pub fn new(
        cx: &'a Context<'a>,
        entries: &[CandidatesEntry],
        base: &'a Built<'a>,
        points: &'a Points,
        solved: &'a GridResult,
    ) -> Result<Self, Stopped> {
        let time = if cx.only_checks {
            0.0
        } else {
            timed(cx, &base.transmission, points).ok_or(Stopped::Interrupted)?
        };
        let mut gathering = Self {
            cx,
            base,
            points,
            solved,
            time,
            slots: Vec::new(),
            left_out: Vec::new(),
            unlisted: 0,
        };
        for (i, entry) in entries.iter().enumerate() {
            gathering.add(&format!("{}.mechanisms.{i}", cx.path()), entry)?;
        }
        Ok(gathering)
    }

    /// Adds a mechanism with its candidates.
    fn add(&mut self, path: &str, entry: &CandidatesEntry) -> Result<(), Stopped> {
        let mut slot = Slot::new(self.cx, path, entry)?;
        if self.slots.iter().any(|s| s.name == slot.name) {
            let message = format!("`{}` is listed twice", slot.name);
            return Err(self.cx.wrong(path, message, "list it once"));
        }
        self.fill(path, entry, &mut slot)?;
        // If all models are candidates, so is the model of the set.
        if entry.models.is_empty() {
            self.add_own(&mut slot);
            self.merge_alike(&mut slot);
        }
        self.slots.push(slot);
        Ok(())
    }

    /// Evaluates the listed models, or all models of the mechanism.
    fn fill(&mut self, path: &str, entry: &CandidatesEntry, slot: &mut Slot) -> Result<(), Stopped> {
        let named = !entry.models.is_empty();
        if slot.is_drag() && !named {
            let message = format!(
                "`{}` includes laws for churning, injection and windage",
                entry.mechanism
            );
            let help = "list the candidates: `models: { a: { type: diab } }`";
            return Err(self.cx.wrong(path, message, help));
        }
        let models: Vec<(String, Value)> = if named {
            let models = entry.models.iter();
            models.map(|(name, model)| (name.to_owned(), model.clone())).collect()
        } else {
            let registry = self.cx.language.registry();
            let all = takes_part(registry, &entry.mechanism);
            all.flat_map(|model| with_nested(registry, model, &slot.name, &mut self.left_out))
                .collect()
        };
        for (name, model) in models {
            match self.evaluated(slot, &model) {
                Err(Refused::Interrupted) => return Err(Stopped::Interrupted),
                Err(Refused::Because(reason)) if named => {
                    let help = "`gearloss models --needs GEARBOX` lists the inputs of a model";
                    return Err(self.cx.wrong(&format!("{path}.models.{name}"), reason, help));
                }
                Err(Refused::Because(reason)) => self.left_out.push(format!("{} {name}: {reason}", slot.name)),
                Ok(found) => slot.candidates.push(Candidate {
                    name,
                    model,
                    loss: found.loss,
                    time: if self.time > 0.0 {
                        found.seconds / self.time
                    } else {
                        1.0
                    },
                    marks: found.marks,
                }),
            }
        }
        if slot.candidates.is_empty() {
            let message = format!("no model of `{}` can be evaluated", slot.name);
            let help = "`gearloss models --needs GEARBOX` lists the inputs of models";
            return Err(self.cx.wrong(path, message, help));
        }
        Ok(())
    }

    /// Adds the models of the set as the first candidate, instead of an equal candidate.
    fn add_own(&self, slot: &mut Slot) {
        let (language, base) = (self.cx.language, self.base);
        let own = slot.covered(base.transmission.parts());
        let loss_of_own = |p: &PointResult| own.iter().map(|i| p.parts[*i]).sum();
        let loss: Vec<f64> = self.solved.points.iter().map(loss_of_own).collect();
        let same = |model: &Value| slot.with(language, &base.resolved, model).map(|r| r.value);
        let twin = |candidate: &Candidate| same(&candidate.model).as_ref() == Ok(&base.resolved.value);
        let twins: Vec<bool> = slot.candidates.iter().map(twin).collect();
        let mut twins = twins.into_iter();
        slot.candidates.retain(|_| twins.next() != Some(true));
        let marks = if self.solved.seen.is_empty() {
            Vec::new()
        } else {
            let replaced = slot.replaced(language, &base.resolved);
            marks(&base.transmission, &self.solved.seen, &replaced)
        };
        let own = Candidate {
            name: format!("as in {}", base.name),
            model: Value::Null,
            loss,
            time: 1.0,
            marks,
        };
        slot.candidates.insert(0, own);
    }

    /// Models with equal losses at every point are one candidate, because duplicates would split its weight.
    fn merge_alike(&mut self, slot: &mut Slot) {
        let mut kept: Vec<Candidate> = Vec::new();
        for candidate in std::mem::take(&mut slot.candidates) {
            let alike = |other: &&Candidate| {
                let mut pairs = candidate.loss.iter().zip(&other.loss);
                !candidate.loss.is_empty() && pairs.all(|(a, b)| (a - b).abs() <= ALIKE * a.abs().max(b.abs()))
            };
            match kept.iter().find(alike) {
                Some(other) => self.left_out.push(format!(
                    "{} {}: same loss as `{}` at every point",
                    slot.name, candidate.name, other.name
                )),
                None => kept.push(candidate),
            }
        }
        slot.candidates = kept;
    }

    /// Losses of the slot's components with one model, the time of all points, and quantities outside their stated ranges.
    fn evaluated(&mut self, slot: &Slot, model: &Value) -> Result<Evaluated, Refused> {
        let because = |list: &[Diagnostic]| {
            let first = list.first();
            Refused::Because(first.map_or_else(String::new, |d| format!("{}: {}", d.path, d.message)))
        };
        let (cx, base) = (self.cx, self.base);
        let changed = slot
            .with(cx.language, &base.resolved, model)
            .map_err(Refused::Because)?;
        let transmission = base
            .gearbox
            .build(cx.language, &changed)
            .map_err(|findings| because(&findings.list))?;
        if cx.only_checks {
            return Ok(Evaluated {
                loss: Vec::new(),
                seconds: 0.0,
                marks: Vec::new(),
            });
        }
        let solved = run_grid(&transmission, self.points, &|_| cx.should_continue()).map_err(|list| because(&list))?;
        let solved = solved.ok_or(Refused::Interrupted)?;
        self.unlisted += left(&transmission, &solved);
        if let Some(p) = solved.points.iter().find(|p| p.loss.is_none()) {
            let why = p.undefined.map_or_else(
                || p.status.name().to_owned(),
                |(part, reason)| format!("{}: {reason}", transmission.parts()[part].path),
            );
            return Err(Refused::Because(format!(
                "no loss at {} Nm, {:.0} rpm ({why})",
                p.torque,
                p.speed * RPM
            )));
        }
        let covered = slot.covered(transmission.parts());
        let loss = solved.points.iter().map(|p| covered.iter().map(|i| p.parts[*i]).sum());
        let loss = loss.collect();
        let seconds = timed(cx, &transmission, self.points).ok_or(Refused::Interrupted)?;
        let replaced = slot.replaced(cx.language, &base.resolved);
        Ok(Evaluated {
            loss,
            seconds,
            marks: marks(&transmission, &solved.seen, &replaced),
        })
    }
}

/// Number of quantities outside their stated ranges at solved points.
pub fn left(transmission: &Transmission, solved: &GridResult) -> usize {
    let notes = notes(transmission, &solved.seen);
    notes.iter().filter(|note| note.outside > 0).count()
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

/// Time of one thread for the points, the minimum of a few tries; absent if interrupted. Only ratios of times are used. \[s\]
fn timed(cx: &Context<'_>, transmission: &Transmission, points: &Points) -> Option<f64> {
    let few = Points {
        field: Field::List(
            (0..points.field.len().min(32))
                .map(|i| points.field.given_point(i))
                .collect(),
        ),
        ..points.clone()
    };
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let begun = Instant::now();
        if !matches!(run_grid(transmission, &few, &|_| cx.should_continue()), Ok(Some(_))) {
            return None;
        }
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Some(least)
}
