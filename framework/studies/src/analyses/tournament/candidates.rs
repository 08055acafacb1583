//! The candidate models, each evaluated once.

use std::time::Instant;

use gearloss_framework::transmission::Transmission;
use serde_json::Value;

use super::super::{Built, Engine, Stopped};
use super::entrants::{Entrants, first_message};
use super::law_loss::LossOfLaw;
use super::marks::{Mark, marks};
use super::model_error::Errors;
use super::slot::{Candidate, Slot};
use crate::numbers::RPM;
use crate::points::{Field, GridResult, PointResult, Points, notes, run_grid};

/// Relative difference of losses below which two models are equal: residual of the iterated power flow.
const ALIKE: f64 = 1e-9;

/// Data for the evaluation of models, and the results so far.
pub struct Gathering<'a> {
    engine: &'a Engine<'a>,
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
    errors: Option<&'a Errors>,
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
    laws: Vec<LossOfLaw>,
}

impl<'a> Gathering<'a> {
    /// All candidates of the mechanisms at the solved points of the base.
    pub fn new(
        engine: &'a Engine<'a>,
        entrants: &[Entrants],
        base: &'a Built<'a>,
        points: &'a Points,
        solved: &'a GridResult,
        errors: Option<&'a Errors>,
    ) -> Result<Self, Stopped> {
        let mut gathering = Self {
            time: timed(engine, &base.transmission, points).ok_or(Stopped::Interrupted)?,
            engine,
            base,
            points,
            solved,
            slots: Vec::new(),
            left_out: Vec::new(),
            unlisted: 0,
            errors,
        };
        for (number, of_slot) in entrants.iter().enumerate() {
            let slot = gathering.slot(number, of_slot)?;
            gathering.slots.push(slot);
        }
        Ok(gathering)
    }

    /// Evaluates the entrants of a mechanism.
    fn slot(&mut self, number: usize, entrants: &Entrants) -> Result<Slot, Stopped> {
        let mut slot = entrants.slot.clone();
        self.left_out.extend(entrants.left_out.iter().cloned());
        for (place, entrant) in entrants.list.iter().enumerate() {
            let built = entrant
                .built
                .as_ref()
                .map_err(|reason| Refused::Because(reason.clone()));
            match built.and_then(|transmission| self.evaluated(&slot, [number, place], transmission)) {
                Err(Refused::Interrupted) => return Err(Stopped::Interrupted),
                Err(Refused::Because(reason)) if entrants.named => {
                    return Err(entrants.unusable_model(self.engine, &entrant.name, &reason));
                }
                Err(Refused::Because(reason)) => {
                    self.left_out.push(format!("{} {}: {reason}", slot.name, entrant.name));
                }
                Ok(found) => slot.candidates.push(Candidate {
                    name: entrant.name.clone(),
                    model: entrant.model.clone(),
                    loss: found.loss,
                    time: if self.time > 0.0 {
                        found.seconds / self.time
                    } else {
                        1.0
                    },
                    marks: found.marks,
                    laws: found.laws,
                }),
            }
        }
        if slot.candidates.is_empty() {
            return Err(entrants.no_usable_model(self.engine));
        }
        // If all models are candidates, so is the model of the set.
        if !entrants.named {
            self.add_own(&mut slot);
            self.merge_alike(&mut slot);
        }
        Ok(slot)
    }

    /// Adds the models of the set as the first candidate, instead of an equal candidate.
    fn add_own(&self, slot: &mut Slot) {
        let (language, base) = (self.engine.language, self.base);
        let covered = slot.covered(base.transmission.parts());
        let loss_of_own = |p: &PointResult| covered.iter().map(|i| p.parts[*i]).sum();
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
        let present = Candidate {
            name: format!("as in {}", base.name),
            model: Value::Null,
            loss,
            time: 1.0,
            marks,
            laws: self.errors.map_or_else(Vec::new, |errors| {
                errors.of_base(&base.transmission, &self.solved.points, |part| covered.contains(&part))
            }),
        };
        slot.candidates.insert(0, present);
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

    /// Evaluates the gearbox with a model at all points.
    fn evaluated(&mut self, slot: &Slot, place: [usize; 2], transmission: &Transmission) -> Result<Evaluated, Refused> {
        let (engine, base) = (self.engine, self.base);
        let solved = run_grid(transmission, self.points, &|_| engine.should_continue());
        let solved = solved.map_err(|list| Refused::Because(first_message(&list)))?;
        let solved = solved.ok_or(Refused::Interrupted)?;
        self.unlisted += left(transmission, &solved);
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
        let replaced = slot.replaced(engine.language, &base.resolved);
        Ok(Evaluated {
            loss: loss.collect(),
            seconds: timed(engine, transmission, self.points).ok_or(Refused::Interrupted)?,
            marks: marks(transmission, &solved.seen, &replaced),
            laws: self.errors.map_or_else(Vec::new, |errors| {
                errors.of_entrant(place, transmission, &solved.points, slot)
            }),
        })
    }
}

/// Number of quantities outside their stated ranges at solved points.
pub fn left(transmission: &Transmission, solved: &GridResult) -> usize {
    let notes = notes(transmission, &solved.seen);
    notes.iter().filter(|note| note.outside > 0).count()
}

/// Time of one thread for the points, the minimum of a few tries; absent if interrupted. Only ratios of times are used. \[s\]
fn timed(engine: &Engine<'_>, transmission: &Transmission, points: &Points) -> Option<f64> {
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
        if !matches!(run_grid(transmission, &few, &|_| engine.should_continue()), Ok(Some(_))) {
            return None;
        }
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Some(least)
}
