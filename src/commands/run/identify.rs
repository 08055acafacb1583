//! Uncertain parameters, found from measured points, with what the points say about each.

mod checks;
mod compare;
mod hold_out;
mod lines;
mod next;
mod outcome;
mod pictures;
mod posterior;
mod results;
mod show;
mod tables;

use gearloss_framework::document::Diagnostic;
use gearloss_numerics::inference::{Accuracy, Fold};
use gearloss_numerics::least_squares::{Fault, Loss};
use gearloss_studies::identify::{Faults, HoldOut, Identification, Identified, Settings};
use gearloss_studies::measured::Measured;
use gearloss_studies::study::{FoldsEntry, IdentifiedEntry, IdentifyEntry, RobustLoss};
use serde_json::Value;

use self::outcome::Outcome;
use super::write::{head, write_json};
use super::{Built, Runner, gear_of};
use crate::interrupt;
use crate::output::{Failure, Out};

pub fn run(runner: &Runner<'_>, name: &str, entry: &IdentifyEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let bind: Vec<&str> = entry.bind.ids().collect();
    let measured = runner.read(&format!("{path}.data"), &entry.data, &bind)?;
    let file = &runner.data(&format!("{path}.data"), &entry.data)?.file;
    for note in &measured.notes {
        out.line(format!("{name}: {file}: {note}"))?;
    }
    if entry.folds == FoldsEntry::Torques(1) {
        let message = "one group of torques cannot be predicted from others";
        return Err(runner.wrong(&format!("{path}.folds"), message, "write 2 or more, or 0 for none"));
    }
    if entry.accuracy_factors && loss(entry) != Loss::Linear {
        let message = "a robust loss takes far points as such, a factor of the accuracy takes them as scatter";
        return Err(runner.wrong(&format!("{path}.accuracy_factors"), message, "leave one of them out"));
    }
    let held_out = held_out(runner, name, entry, &measured, out)?;
    let to_fit = held_out.as_ref().map_or(&measured, |choice| &choice.fitted);
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let mut outcomes: Vec<Outcome<'_>> = Vec::new();
    let mut moved: Vec<String> = Vec::new();
    for b in &built {
        let rows_of = |measured| runner.study.rows(measured, &entry.bind, entry.gear.as_deref(), false);
        let choice = runner.study.choice(b.set());
        runner.rows_fit(&rows_of(&measured), b.gearbox, &choice)?;
        let made = Identification::new(
            runner.language,
            b.gearbox,
            choice,
            rows_of(to_fit),
            entry.parameters.iter(),
            &entry.residuals,
        );
        let mut identification = made.map_err(|faults| match faults {
            Faults::Gearbox(findings) => Failure::from(findings),
            Faults::Study(list) => {
                let below = list.into_iter().map(|mut error| {
                    if error.path == "data" {
                        error.message = format!("{file}: {}", error.message);
                    }
                    error.path = format!("{path}.{}", error.path);
                    error
                });
                runner.study.findings(below.collect()).into()
            }
        })?;
        for parameter in identification.parameters() {
            let line = format!(
                "{name}: `{}` moves {}",
                parameter.base_name(),
                parameter.paths().join(", ")
            );
            // Sets that move the same need not say so again.
            if parameter.paths().len() > 1 && !moved.contains(&line) {
                out.line(&line)?;
                moved.push(line);
            }
        }
        for note in identification.notes() {
            out.line(format!("{name}: {note}"))?;
        }
        if entry.accuracy_factors && identification.accuracy() == Accuracy::Estimated {
            let message = "no accuracy is stated that could be wrong by a factor";
            let mend = "state the accuracies, or leave it out";
            return Err(runner.wrong(&format!("{path}.accuracy_factors"), message, mend));
        }
        posterior::check(runner, &path, entry, &identification)?;
        let groups = groups(runner, &path, entry, &identification)?;
        let candidates = entry.next.as_ref().map(|next| next::candidates(runner, name, next, b));
        let candidates = candidates.transpose()?;
        if runner.only_checks {
            continue;
        }
        let pressed = interrupt::pressed;
        let settings = Settings {
            loss: loss(entry),
            loss_scale: entry.robust.map_or(2.0, |robust| robust.scale),
            starts: entry.starts as usize,
            accuracy_factors: entry.accuracy_factors,
            interrupt: Some(&pressed),
        };
        let fitted = identification.fit(&settings);
        let fitted = match fitted {
            Ok(fitted) => fitted,
            Err(fault) if interrupt::pressed() => {
                out.line(format!("{name}: {}: {fault}", b.name))?;
                return Err(Failure::Interrupted);
            }
            Err(fault) => return Err(of_search(runner, &path, &fault)),
        };
        let gear = gear_of(entry.gear.as_deref(), &b.transmission);
        let mut outcome = Outcome::new(
            runner,
            (name, entry),
            &settings,
            gear,
            (b, identification, fitted),
            (candidates, groups),
        )?;
        let predicted = held_out
            .as_ref()
            .map(|choice| hold_out::predict(choice, &entry.residuals, &outcome));
        let predicted = predicted.transpose().map_err(|reason| {
            let mend = "hold out rows in which what is fitted was measured and the gearbox has a value";
            runner.wrong(&format!("{path}.hold_out"), reason, mend)
        })?;
        if let Some(predicted) = predicted {
            outcome.add_held_out(runner, predicted);
        }
        show::show(runner, name, entry, &outcome, out)?;
        outcomes.push(outcome);
    }
    if runner.only_checks {
        return Ok(());
    }
    let compared = compare::compare(runner, name, &outcomes, out)?;
    compare::write(runner, name, entry, compared.as_ref())?;
    tables::write(runner, name, entry, &outcomes)?;
    let mut value = head(runner, &built.iter().collect::<Vec<&Built<'_>>>());
    value["data"] = serde_json::json!({ "file": file, "points": measured.rows.len(), "notes": measured.notes });
    value["identifications"] = Value::Array(outcomes.iter().map(|o| results::of(o, entry)).collect());
    value["comparison_of_sets"] = compare::json_of(compared.as_ref());
    write_json(runner, name, &entry.write, &value)?;
    for outcome in &outcomes {
        pictures::write(runner, name, entry, outcome)?;
    }
    if let (Some(set), [outcome]) = (&entry.then, &outcomes[..]) {
        let parameters = outcome.identification.parameters();
        runner
            .study
            .keep_found(set, Identified::overrides(parameters, outcome.fitted.theta()));
    }
    Ok(())
}

/// A finding of the study below an analysis.
fn below(runner: &Runner<'_>, path: &str, found: Diagnostic) -> Failure {
    let path = format!("{path}.{}", found.path);
    runner.study.findings(vec![Diagnostic { path, ..found }]).into()
}

/// The rows that are held out, where there are any.
fn held_out(
    runner: &Runner<'_>,
    name: &str,
    entry: &IdentifyEntry,
    measured: &Measured,
    out: &mut Out,
) -> Result<Option<HoldOut>, Failure> {
    let Some(asked) = &entry.hold_out else {
        return Ok(None);
    };
    let wrong = |found| below(runner, &format!("analyses.{name}"), found);
    let choice = HoldOut::choose(asked, measured).map_err(wrong)?;
    // Parameters between equal bounds are held.
    let entries = entry.parameters.iter().map(|(_, parameter)| parameter);
    let free: Vec<_> = entries.filter(|p| p.from.is_none() || p.from != p.to).collect();
    let of_entry = |p: &&IdentifiedEntry| p.over.as_ref().map_or(1, |over| over.torques.len());
    let count = free.iter().map(of_entry).sum();
    let priors = free.iter().filter(|p| p.prior.is_some()).count();
    choice.leaves_enough(count, priors).map_err(wrong)?;
    out.line(format!(
        "{name}: {} of {} rows are held out ({})",
        choice.held_out.rows.len(),
        measured.rows.len(),
        choice.words
    ))?;
    if choice.undecided > 0 {
        out.line(format!(
            "{name}: {} rows lack what the condition asks for, and are fitted",
            choice.undecided
        ))?;
    }
    Ok(Some(choice))
}

/// Groups of which each is predicted from the others; the reason where torques make none, and nothing where none are asked for.
fn groups(
    runner: &Runner<'_>,
    path: &str,
    entry: &IdentifyEntry,
    identification: &Identification<'_>,
) -> Result<Option<Result<Vec<Fold>, String>>, Failure> {
    match (&entry.folds, identification.groups(&entry.folds)) {
        (FoldsEntry::Torques(0), _) => Ok(None),
        // Files of one torque are fitted all the same.
        (FoldsEntry::Torques(_), found) => Ok(Some(found.map_err(|found| found.message))),
        (FoldsEntry::By(_), found) => found
            .map(|folds| Some(Ok(folds)))
            .map_err(|found| below(runner, path, found)),
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

/// Faults of the search, at the analysis.
fn of_search(runner: &Runner<'_>, path: &str, fault: &Fault) -> Failure {
    let finding = |f: &gearloss_numerics::least_squares::Finding| {
        let message = format!("{}: {}", f.place, f.message);
        gearloss_framework::document::Diagnostic::error(path, message).mend(f.mend.clone())
    };
    runner
        .study
        .findings(fault.findings.iter().map(finding).collect())
        .into()
}
