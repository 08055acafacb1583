//! Duties driven through a gearbox: losses, energies, temperatures.

mod bands;
mod outcome;
mod pictures;
mod show;

use gearloss_studies::study::{By, CycleAnalysisEntry};
use serde_json::Value;

use self::outcome::Outcome;
use super::write::{head, write};
use super::{Built, Runner};
use crate::interrupt;
use crate::output::{Failure, Out};
use gearloss_studies::analyses::duties::Duties;
use gearloss_studies::analyses::inputs::Input;
use gearloss_studies::analyses::shares::together;

pub fn run(runner: &Runner<'_>, name: &str, entry: &CycleAnalysisEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.drive.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.drive.model_sets)?;
    whole(runner, &path, entry.by)?;
    let duties = Duties::new(runner, &path, &entry.drive)?;
    let named = |cycle: &str| duties.list.iter().any(|read| read.name == cycle);
    if let Some(unknown) = entry.reference.ids().find(|id| !named(id)) {
        let names: Vec<&str> = duties.list.iter().map(|read| read.name.as_str()).collect();
        let error = gearloss_framework::attach::dangling(
            &format!("{path}.reference"),
            "duty of this analysis",
            unknown,
            &names,
        );
        return Err(runner.study.findings(vec![error]).into());
    }
    let names = together(built.iter().map(|b| &b.transmission), entry.by);
    let mut outcomes = Vec::new();
    for b in &built {
        duties.check(runner, &path, b)?;
        if runner.only_checks {
            Input::all(runner, &path, &entry.inputs, b)?;
            continue;
        }
        let bar = runner.bar(duties.intervals() as u64, &b.name);
        for read in &duties.list {
            let going = |n: usize| {
                bar.inc(n as u64);
                !interrupt::pressed()
            };
            let driven = duties.drive(&b.transmission, read, &going);
            let driven = driven.map_err(|list| Failure::from(b.gearbox.findings(list)))?;
            let driven = driven.ok_or(Failure::Interrupted)?;
            runner.seen(&b.transmission, &driven.seen);
            outcomes.push(Outcome::new(b, read, driven, entry, &names));
        }
        bar.finish_and_clear();
    }
    if runner.only_checks {
        return Ok(());
    }
    if !entry.inputs.is_empty() {
        for b in &built {
            bands::sample(runner, &path, entry, b, &duties, &mut outcomes, out)?;
        }
    }
    for outcome in &outcomes {
        show::show(runner, name, outcome, out)?;
        pictures::pictures(runner, name, entry, outcome)?;
    }
    let nodes = outcome::all_nodes(&outcomes);
    let rows: Vec<Vec<String>> = outcomes.iter().flat_map(|o| o.rows(&nodes)).collect();
    let mut value = head(runner, &built.iter().collect::<Vec<&Built<'_>>>());
    value["cycles"] = outcomes.iter().map(Outcome::json).collect::<Vec<Value>>().into();
    write(
        runner,
        name,
        &entry.write,
        &outcome::header(&names, &nodes),
        &rows,
        &value,
    )?;
    let broken = outcomes.iter().find_map(|o| Some((o, o.driven.broken.as_ref()?)));
    if let Some((o, (time, why))) = broken {
        let reason = gearloss_studies::analyses::balance::reason(&o.built.transmission, why);
        let message = format!("`{}` could not be driven beyond {time} s: {reason}", o.read.name);
        return Err(runner.wrong(
            &path,
            message,
            "the results up to there are kept; look at the point with `explain`",
        ));
    }
    Ok(())
}

/// Energies are kept for parts, not for the terms of their models.
pub(super) fn whole(runner: &Runner<'_>, path: &str, by: By) -> Result<(), Failure> {
    if matches!(by, By::Term | By::Sum) {
        let message = "the energies of a duty are summed by mechanism, component or stage";
        return Err(runner.wrong(
            &format!("{path}.by"),
            message,
            "write `by: mechanism`, `component` or `stage`",
        ));
    }
    Ok(())
}
