//! Uncertain parameters, found from measured points, with what the points say about each.

mod checks;
mod lines;
mod next;
mod outcome;
mod pictures;
mod results;
mod show;
mod tables;

use gearloss_framework::identify::{Faults, Identification, Settings};
use gearloss_framework::inference::{Comparison, FittedModel, akaike, ranking};
use gearloss_framework::least_squares::{Fault, Loss};
use gearloss_framework::study::{IdentifyEntry, RobustLoss};
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
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let mut outcomes: Vec<Outcome<'_>> = Vec::new();
    let mut moved: Vec<String> = Vec::new();
    for b in &built {
        let rows = runner.rows(&measured, &entry.bind, entry.gear.as_deref(), false);
        let choice = runner.study.choice(b.set());
        let made = Identification::new(
            runner.language,
            b.gearbox,
            choice,
            rows,
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
            let line = format!("{name}: `{}` moves {}", parameter.name, parameter.paths().join(", "));
            // Sets that move the same need not say so again.
            if parameter.paths().len() > 1 && !moved.contains(&line) {
                out.line(&line)?;
                moved.push(line);
            }
        }
        for note in identification.notes() {
            out.line(format!("{name}: {note}"))?;
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
        let outcome = Outcome::new(runner, (name, entry), &settings, gear, (b, identification, fitted))?;
        show::show(runner, name, entry, &outcome, out)?;
        outcomes.push(outcome);
    }
    compare(runner, name, &outcomes, out)?;
    tables::write(runner, name, entry, &outcomes)?;
    let mut value = head(runner, name, &built.iter().collect::<Vec<&Built<'_>>>());
    value["data"] = serde_json::json!({ "file": file, "points": measured.rows.len(), "notes": measured.notes });
    value["identifications"] = Value::Array(outcomes.iter().map(results::of).collect());
    write_json(runner, name, &entry.write, &value)?;
    for outcome in &outcomes {
        pictures::write(runner, name, entry, outcome)?;
    }
    Ok(())
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
    let finding = |f: &gearloss_framework::least_squares::Finding| {
        let message = format!("{}: {}", f.place, f.message);
        gearloss_framework::document::Diagnostic::error(path, message).mend(f.mend.clone())
    };
    runner
        .study
        .findings(fault.findings.iter().map(finding).collect())
        .into()
}

/// Which set describes the points best, and whether they can tell.
fn compare(runner: &Runner<'_>, name: &str, outcomes: &[Outcome<'_>], out: &mut Out) -> Result<(), Failure> {
    let model = |o: &Outcome<'_>| {
        let inference = &o.fitted.inference;
        let (points, parameters) = (inference.residuals().len(), inference.parameters().len());
        Some(FittedModel {
            name: o.name.clone(),
            parameters,
            criterion: akaike(inference.chi_square(), points, parameters, inference.accuracy())?,
            validation: o.folds.as_ref().and_then(|folds| Some(folds.as_ref().ok()?.1.clone())),
        })
    };
    // Sets are compared over the same numbers with the same weights only.
    let same = outcomes.windows(2).all(|w| {
        let key = |o: &Outcome<'_>| {
            let of = |o: &gearloss_framework::identify::Observation| (o.row, o.quantity);
            o.identification.observations().iter().map(of).collect::<Vec<_>>()
        };
        key(&w[0]) == key(&w[1])
    });
    let Some(models) = outcomes
        .iter()
        .map(model)
        .collect::<Option<Vec<_>>>()
        .filter(|m| same && m.len() > 1)
    else {
        return Ok(());
    };
    let order = ranking(&models);
    let first = &models[order[0]];
    for place in &order[1..] {
        let other = &models[*place];
        let words = Comparison::of(first, other).words(&format!("`{}`", first.name), &format!("`{}`", other.name));
        let gap = other.criterion - first.criterion;
        runner.verdict(format!("{name}: {words} (corrected Akaike criterion {gap:+.1})"), out)?;
    }
    out.line("")?;
    Ok(())
}
