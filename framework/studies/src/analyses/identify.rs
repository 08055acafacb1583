//! Identification of uncertain parameters from measured points and means over cycles.

pub mod checks;
pub mod compare;
mod correction;
mod entry;
mod folds;
pub mod found;
pub mod hold_out;
pub mod lines;
pub mod means;
pub mod next;
pub mod outcome;
pub mod parameter;
pub mod posterior;
mod published;
mod record;
pub mod search;
mod tables;
mod values;

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::variants::Variants;
use gearloss_numerics::inference::{Accuracy, Fold};
use gearloss_numerics::least_squares::{self, Fault, Loss, OneSearch};

pub use entry::{IdentifyEntry, NextEntry, PosteriorEntry, RobustEntry, RobustLoss, RuleEntry};
pub use folds::{FoldOfSet, FoldsOfSet};
pub use outcome::{IdentificationOfSet, IdentifyOutcome};

use super::{Analysis, Built, Engine, Plan, Planner, Stopped, Work, gear_of};
use crate::codes;
use crate::engine::JobsWithin;
use crate::identify::{Faults, HoldOut, Identification, Settings, group_words};
use crate::measured::Measured;
use crate::points::Rows;
use crate::register_analysis;
use crate::study::{FoldsEntry, IdentifiedEntry, ParameterKey, Then, Uses, Write};
use found::{Found, Prepared};
use outcome::{DataOfFit, HeldOutRows, Requested};

register_analysis!(IdentifyEntry);

/// The gearbox with each set, and the measured rows.
pub struct IdentifyPlan<'a> {
    built: Vec<Arc<Built<'a>>>,
    points: Points,
    starts: usize,
}

impl Plan for IdentifyPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |b: &Arc<Built<'_>>| Work::new(&b.name, "search", self.starts);
        self.built.iter().map(work).collect()
    }
}

impl Analysis for IdentifyEntry {
    const TYPE: &'static str = "identify";
    const PARAMETERS: Option<ParameterKey> = Some(ParameterKey::Whole("parameters"));
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = IdentifyPlan<'a>;
    type Outcome = IdentifyOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.next.as_ref().map(|next| &next.grid),
            grid_key: "next.grid",
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .in_gears(&self.gear)
                .bind(&self.bind)
                .with("data", self.data.as_ref())
        }
    }

    fn then(&self) -> Option<Then<'_>> {
        let set = self.then.as_deref()?;
        Some(Then {
            set,
            model_sets: &self.model_sets,
        })
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<IdentifyPlan<'a>, Stopped> {
        refuse(cx, self)?;
        let points = match &self.data {
            None => Points::default(),
            Some(data) => {
                let at = format!("{}.data", cx.path());
                let bind: Vec<&str> = self.bind.ids().collect();
                let measured = cx.read(&at, data, &bind)?;
                Points {
                    file: cx.data(&at, data)?.file.to_string(),
                    held_out: held_out(cx, self, &measured)?,
                    measured,
                }
            }
        };
        let built = cx.built(cx.gearbox(self.gearbox.as_ref())?, &self.model_sets)?;
        for b in &built {
            // It solves the rows once, for the speeds of the rig.
            prepare(cx, self, b, &points)?;
        }
        Ok(IdentifyPlan {
            built,
            points,
            starts: self.starts as usize,
        })
    }

    fn reduce<'a>(&'a self, plan: IdentifyPlan<'a>, engine: &Engine<'a>) -> Result<IdentifyOutcome, Stopped> {
        let IdentifyPlan { built, points, .. } = plan;
        let identifications = engine.parts(&built, |b| identify(engine, self, b, &points))?;
        let (comparison_of_sets, not_compared) = match compare::compare(&identifications) {
            None => (None, None),
            Some(Ok(compared)) => (Some(compared), None),
            Some(Err(reason)) => (None, Some(reason)),
        };
        Ok(IdentifyOutcome {
            head: engine.head(&built),
            data: self.data.as_ref().map(|_| DataOfFit {
                points: points.measured.rows.len(),
                notes: points.measured.notes,
                file: points.file,
            }),
            identifications,
            comparison_of_sets,
            not_compared,
            held_out: points.held_out.map(|choice| HeldOutRows {
                rows: choice.held_out.rows.len(),
                words: choice.words,
                undecided: choice.undecided,
            }),
            requested: Requested {
                stack_at: self.stack_at,
                groups: group_words(&self.folds),
                posterior: self.posterior.is_some(),
                next: self.next.is_some(),
            },
        })
    }
}

/// Rejects contradictory keys.
fn refuse(cx: &Planner<'_>, entry: &IdentifyEntry) -> Result<(), Stopped> {
    let path = cx.path();
    if entry.data.is_none() {
        if entry.means.is_empty() {
            let help = "add `data` with measured points, `means` over cycles, or both";
            return Err(cx.wrong_as(codes::IDENTIFICATION, &path, "nothing is measured", help));
        }
        let needs_points = |key: &str, what: &str| {
            let (place, message) = (format!("{path}.{key}"), format!("`{what}` needs measured points"));
            cx.wrong_as(codes::IDENTIFICATION, &place, message, "add `data`, or delete it")
        };
        if let Some(key) = entry.key_of_points() {
            return Err(needs_points(key, key));
        }
        let mut paths = (entry.parameters.iter()).filter_map(|(name, p)| Some((name, p.path.as_deref()?)));
        if let Some((name, of_rig)) = paths.find(|(_, path)| path.starts_with("rig.")) {
            return Err(needs_points(&format!("parameters.{name}.path"), of_rig));
        }
    }
    if entry.folds == FoldsEntry::Torques(1) {
        let message = "cross-validation needs at least two groups";
        return Err(cx.wrong(&format!("{path}.folds"), message, "write at least 2, or 0 for none"));
    }
    if entry.correction.is_some() && !entry.bind.is_empty() {
        let message = "a correction varies over torque, speed and oil temperature, and not over what `bind` changes";
        let help = "delete `correction`, or identify rows in which nothing is bound";
        return Err(cx.wrong_as(codes::CORRECTION, &format!("{path}.correction"), message, help));
    }
    if entry.accuracy_factors && loss(entry) != Loss::Linear {
        let message = "a robust loss and factors of the accuracies are contradictory: one treats distant points as outliers, the other as scatter";
        return Err(cx.wrong(&format!("{path}.accuracy_factors"), message, "delete one of them"));
    }
    Ok(())
}

/// The measured rows.
#[derive(Default)]
struct Points {
    measured: Measured,
    held_out: Option<HoldOut>,
    file: String,
}

impl Points {
    /// The rows that are fitted.
    fn to_fit(&self) -> &Measured {
        self.held_out.as_ref().map_or(&self.measured, |choice| &choice.fitted)
    }
}

/// The identification with one set as it was described, and what is chosen beside it.
fn prepare<'s>(
    cx: &'s Planner<'_>,
    entry: &'s IdentifyEntry,
    b: &'s Built<'s>,
    points: &'s Points,
) -> Result<(Identification<'s>, Prepared<'s>), Stopped> {
    let identification = stated(cx, entry, b, points)?;
    if entry.accuracy_factors && identification.accuracy() == Accuracy::Estimated {
        let message = "`accuracy_factors` needs stated accuracies";
        let help = "state the accuracies, or delete it";
        return Err(cx.wrong(&format!("{}.accuracy_factors", cx.path()), message, help));
    }
    posterior::check(cx, entry, &identification)?;
    let groups = groups(cx, entry, &identification)?;
    let candidates = entry.next.as_ref().map(|next| next::candidates(cx, next, b));
    let prepared = Prepared {
        candidates: candidates.transpose()?,
        groups,
        held_out: points.held_out.as_ref(),
    };
    Ok((identification, prepared))
}

/// Fits the parameters with one set.
fn identify(
    engine: &Engine<'_>,
    entry: &IdentifyEntry,
    b: &Built<'_>,
    points: &Points,
) -> Result<IdentificationOfSet, Stopped> {
    let (mut identification, prepared) = prepare(engine, entry, b, points)?;
    let jobs = JobsWithin::new(engine);
    let pressed = || !jobs.should_continue();
    let searches = |count: usize, search: &OneSearch<'_>| {
        let fits = jobs.compute(&format!("{} starts", b.name), count, search);
        fits.unwrap_or_else(|| vec![Err(Fault::single("the search", "it was aborted", "run it again"))])
    };
    let settings = Settings {
        loss: loss(entry),
        loss_scale: entry.robust.map_or(2.0, |robust| robust.scale),
        starts: entry.starts as usize,
        accuracy_factors: entry.accuracy_factors,
        interrupt: Some(&pressed),
        searches: Some(&searches),
    };
    let fitted = jobs.result(identification.fit(&settings))?;
    let fitted = fitted.map_err(|fault| fault_of_search(engine, &fault))?;
    let gear = gear_of(entry.gear.as_deref(), &b.transmission);
    let (found, beside) = Found::new(&jobs, entry, &settings, gear, (identification, fitted), prepared)?;
    Ok(IdentificationOfSet::new(&b.name, entry, found, beside))
}

/// The identification with one set, before the fit.
fn stated<'s>(
    cx: &'s Planner<'_>,
    entry: &'s IdentifyEntry,
    b: &'s Built<'s>,
    points: &'s Points,
) -> Result<Identification<'s>, Stopped> {
    let rows = |measured| -> Rows<'s> { cx.study.rows(measured, &entry.bind, entry.gear.as_deref(), false) };
    let choice = cx.study.choice(b.set());
    let gearbox: &'s Gearbox = b.gearbox;
    let variants = Variants::new(cx.language, gearbox, choice.clone());
    cx.rows_fit(&rows(&points.measured), gearbox, &variants)?;
    let made = Identification::with_means(
        cx.language,
        gearbox,
        choice,
        rows(points.to_fit()),
        entry.parameters.iter(),
        &entry.residuals,
        means::means(cx, entry, b)?,
    );
    let made = made.map_err(|faults| match faults {
        Faults::Gearbox(findings) => Stopped::from(findings),
        Faults::Study(list) => {
            let path = cx.path();
            let below = list.into_iter().map(|mut error| {
                if error.path == "data" {
                    error.message = format!("{}: {}", points.file, error.message);
                }
                error.path = format!("{path}.{}", error.path);
                error
            });
            cx.found(below.collect())
        }
    })?;
    means::refuse_changed(cx, entry, b, made.parameters())?;
    Ok(made)
}

/// A finding of the study below the analysis.
fn below(cx: &Planner<'_>, found: Diagnostic) -> Stopped {
    let path = format!("{}.{}", cx.path(), found.path);
    cx.found(vec![Diagnostic { path, ..found }])
}

/// The held-out rows, if there are any.
fn held_out(cx: &Planner<'_>, entry: &IdentifyEntry, measured: &Measured) -> Result<Option<HoldOut>, Stopped> {
    let Some(chosen) = &entry.hold_out else {
        return Ok(None);
    };
    let choice = HoldOut::choose(chosen, measured).map_err(|found| below(cx, found))?;
    // Parameters with equal bounds are fixed.
    let entries = entry.parameters.iter().map(|(_, parameter)| parameter);
    let free: Vec<_> = entries.filter(|p| p.from.is_none() || p.from != p.to).collect();
    let of_entry = |p: &&IdentifiedEntry| p.over.as_ref().map_or(1, |over| over.torques.len());
    let count = free.iter().map(of_entry).sum();
    let priors = free.iter().filter(|p| p.prior.is_some()).count();
    let others = priors + entry.means.len();
    choice.leaves_enough(count, others).map_err(|found| below(cx, found))?;
    Ok(Some(choice))
}

/// Groups for cross-validation; the reason if there are none, absent if not requested.
fn groups(
    cx: &Planner<'_>,
    entry: &IdentifyEntry,
    identification: &Identification<'_>,
) -> Result<Option<Result<Vec<Fold>, String>>, Stopped> {
    match (&entry.folds, identification.groups(&entry.folds)) {
        (FoldsEntry::Torques(0), _) => Ok(None),
        (FoldsEntry::Torques(_), _) if entry.data.is_none() => Ok(None),
        // Files with one torque are also fitted.
        (FoldsEntry::Torques(_), found) => Ok(Some(found.map_err(|found| found.message))),
        (FoldsEntry::By(_), found) => found.map(|folds| Some(Ok(folds))).map_err(|found| below(cx, found)),
    }
}

/// The loss of an entry.
fn loss(entry: &IdentifyEntry) -> Loss {
    match entry.robust.map_or(RobustLoss::Linear, |robust| robust.loss) {
        RobustLoss::Linear => Loss::Linear,
        RobustLoss::SoftL1 => Loss::SoftL1,
        RobustLoss::Huber => Loss::Huber,
        RobustLoss::Cauchy => Loss::Cauchy,
        RobustLoss::Arctan => Loss::Arctan,
    }
}

/// Errors of the search at the analysis.
fn fault_of_search(cx: &Planner<'_>, fault: &Fault) -> Stopped {
    let path = cx.path();
    let finding = |f: &least_squares::Finding| {
        let message = format!("{}: {}", f.place, f.message);
        Diagnostic::error(&path, message)
            .help(f.help.clone())
            .code(codes::NO_CONVERGENCE)
    };
    cx.found(fault.findings.iter().map(finding).collect())
}
