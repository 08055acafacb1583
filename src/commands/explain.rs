//! `explain`: every step of the loss of one component, in the source's symbols and units.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::document::did_you_mean;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::{Step, Trace};
use gearloss_framework::resolve::{Resolved, ValueSource, lookup};
use gearloss_framework::transmission::{PartInfo, Transmission};
use serde_json::Value;

use super::card::figures;
use super::locking;
use super::point::prepare;
use super::solve::{RPM, heading, of_warmth};
use super::{set, warn};
use crate::args::ExplainArgs;
use crate::output::{End, Failure, Out, significant};

pub fn run(args: &ExplainArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let resolved = set::resolve(language, &gearbox, &args.choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    warn(&gearbox, &transmission)?;
    let ways = ways_of(&transmission, &args.component);
    let chosen = match parts_of(&transmission, &args.component) {
        Err(_) if !ways.is_empty() => Vec::new(),
        chosen => chosen?,
    };
    let prepared = prepare(&args.point, &gearbox, &transmission)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let point = prepared.point();
    let warm = prepared.oil.find(&transmission, &prepared.case, &point, &mut scratch);
    let solution = transmission.evaluate(&prepared.case, &point, warm.temperatures(), &mut scratch);
    out.text(&heading(
        &transmission,
        &solution,
        &prepared,
        &format!("oil {} degC", significant(warm.oil)),
    ))?;
    if let Some(locking) = locking::find(&transmission, &prepared, &solution, warm.temperatures()) {
        out.line(locking.words())?;
    }
    if warm.outcome().is_some() {
        out.text(&of_warmth(&transmission, &warm))?;
        out.line("")?;
    }
    let changed = changed_from_source(&transmission, &resolved);
    for way in ways {
        let surface = warm.balance.as_ref().and_then(|b| b.surface).unwrap_or(warm.oil);
        explain_way(&transmission, &gearbox, &resolved, way, (warm.oil, surface), out)?;
    }
    for part in chosen {
        let info = &transmission.parts()[part];
        let (loss, trace) = solution.explain(part);
        out.text(&source(&transmission, info))?;
        let factor = match info.loss_factor {
            1.0 => String::new(),
            factor => format!(", loss factor {}", significant(factor)),
        };
        out.line(format!(
            "relative speed {} rpm, {} copies{factor}",
            significant(loss.speed * RPM),
            significant(info.count)
        ))?;
        steps(&transmission, trace, out)?;
        match loss.result {
            Ok(_) => {
                for term in transmission.instances()[info.notes.instance()].entry.terms {
                    out.line(format!(
                        "  {}: {} W",
                        term.name,
                        significant(loss.term_watts(term.index))
                    ))?;
                }
                let moment = loss.moment().unwrap_or(0.0);
                out.line(format!(
                    "  together: {} W, {} Nm for one copy",
                    significant(loss.watts()),
                    significant(moment)
                ))?;
            }
            Err(undefined) => out.line(format!("  {undefined}"))?,
        }
        out.line("  sees:")?;
        for reading in solution.readings(part) {
            let unit = if reading.unit.symbol == "-" {
                ""
            } else {
                reading.unit.symbol
            };
            out.line(format!("    {} = {} {unit}", reading.name, significant(reading.value)).trim_end())?;
        }
        if let Some(stage) = transmission.stages().find(|stage| stage.mesh == info.path) {
            out.line("  geometry:")?;
            for figure in figures(&stage) {
                out.line(format!("    {figure}"))?;
            }
        }
        let base = base_path(info);
        for changed in changed.iter().filter_map(|changed| changed.below(base)) {
            out.line(format!("  note: {changed}"))?;
        }
        out.line("  inputs (SI, temperatures in degC):")?;
        if let Some(entry) = lookup(&resolved.value, base) {
            inputs(base, entry, &gearbox, &resolved, out)?;
        }
        out.line("")?;
    }
    Ok(End::Fine)
}

/// The steps of a model, with the place of each model that took them.
fn steps(transmission: &Transmission, trace: Trace, out: &mut Out) -> Result<(), Failure> {
    let mut last = usize::MAX;
    for step in trace.into_steps() {
        if step.instance() != last {
            last = step.instance();
            let instance = &transmission.instances()[last];
            out.line(format!("  {} ({})", instance.path, instance.entry.name))?;
        }
        match step {
            Step::Value {
                symbol, unit, value, ..
            } => {
                let unit = if unit == "-" { "" } else { unit };
                out.line(format!("    {symbol} = {} {unit}", significant(value)).trim_end())?;
            }
            Step::Branch { taken, .. } => out.line(format!("    branch: {taken}"))?,
        }
    }
    Ok(())
}

/// Ways of heat by path, by name, or all below `thermal`.
fn ways_of(transmission: &Transmission, name: &str) -> Vec<usize> {
    let fits =
        |path: &str| path == name || path.starts_with(&format!("{name}.")) || path.split('.').nth(2) == Some(name);
    let ways = transmission.housing().ways().iter().enumerate();
    ways.filter(|(_, way)| fits(&way.path)).map(|(i, _)| i).collect()
}

fn explain_way(
    transmission: &Transmission,
    gearbox: &Gearbox,
    resolved: &Resolved,
    way: usize,
    (oil, surface): (f64, f64),
    out: &mut Out,
) -> Result<(), Failure> {
    let path = &transmission.housing().ways()[way].path;
    if let Some(instance) = transmission.instances().iter().find(|i| i.path == *path) {
        let entry = &instance.entry;
        out.line(format!(
            "{path}: {} `{}`\n  {}\n  source: {}",
            entry.mechanism,
            entry.name,
            entry.meaning(),
            entry.source
        ))?;
    }
    out.line(format!(
        "oil {} degC, surface {} degC",
        significant(oil),
        significant(surface)
    ))?;
    let (heat, trace) = transmission.explain_way(way, oil, surface);
    steps(transmission, trace, out)?;
    match heat {
        Ok(heat) => out.line(format!("  heat: {} W", significant(heat)))?,
        Err(undefined) => out.line(format!("  {undefined}"))?,
    }
    out.line("  inputs (SI, temperatures in degC):")?;
    for place in [path.as_str(), "housing.outside"] {
        if let Some(entry) = lookup(&resolved.value, place) {
            inputs(place, entry, gearbox, resolved, out)?;
        }
    }
    out.line("")?;
    Ok(())
}

/// Path of the component that a part belongs to; a drag belongs to its slot.
fn base_path(info: &PartInfo) -> &str {
    &info.path
}

fn source(transmission: &Transmission, info: &PartInfo) -> String {
    let entry = &transmission.instances()[info.notes.instance()].entry;
    format!(
        "{}: {} `{}`\n  {}\n  source: {}\n",
        info.path,
        info.mechanism,
        entry.name,
        entry.meaning(),
        entry.source
    )
}

/// Every written, filled or default value below a path, with where it came from.
fn inputs(path: &str, value: &Value, gearbox: &Gearbox, resolved: &Resolved, out: &mut Out) -> Result<(), Failure> {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                inputs(&format!("{path}.{key}"), inner, gearbox, resolved, out)?;
            }
        }
        Value::Null => {}
        leaf => {
            let from = match resolved.source_of(path) {
                ValueSource::Override => "override".to_owned(),
                ValueSource::Catalogue {
                    designation,
                    confidence,
                } => format!("catalogue {designation}, confidence {confidence}"),
                ValueSource::Models => "models".to_owned(),
                ValueSource::Set(name) => format!("set {name}"),
                ValueSource::Surface => "surface".to_owned(),
                ValueSource::Network => "network: auto".to_owned(),
                ValueSource::Document => match gearbox.places.get(path).and_then(|p| gearbox.sources.locate(p.value)) {
                    Some((file, line, column)) => format!("{file}:{line}:{column}"),
                    None => "default".to_owned(),
                },
            };
            out.line(format!("    {path} = {leaf} ({from})"))?;
        }
    }
    Ok(())
}

/// Parts of a component: by path, by id, or everything below a path.
fn parts_of(transmission: &Transmission, name: &str) -> Result<Vec<usize>, Failure> {
    let fits =
        |path: &str| path == name || path.starts_with(&format!("{name}.")) || path.split('.').nth(1) == Some(name);
    let found: Vec<usize> = (0..transmission.parts().len())
        .filter(|i| fits(&transmission.parts()[*i].path))
        .collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let paths: Vec<&str> = transmission.parts().iter().map(|p| p.path.as_str()).collect();
    let ids: Vec<&str> = paths.iter().filter_map(|p| p.split('.').nth(1)).collect();
    let help = match did_you_mean(name, paths.iter().chain(&ids).copied()) {
        Some(close) => format!("write {close}"),
        None => format!("name one of {}", paths.join(", ")),
    };
    Err(Failure::input(format!("no part is called `{name}`"), help))
}
