//! Every step of the loss of one component, in the symbols and units of the source.

use gearloss_framework::coefficients::Changed;
use gearloss_framework::evaluate::Solution;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::{Step, Trace};
use gearloss_framework::registry::{Entry, Instance, kind_of};
use gearloss_framework::resolve::{Resolved, ValueSource, lookup};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::numbers::RPM;
use serde_json::Value;

use super::pair::explain_pair;
use crate::card::stage_lines;
use crate::text::{Lines, significant};

/// The steps of the loss of a part, by its number, with what it depends on and its inputs.
pub fn explain_part(
    transmission: &Transmission,
    gearbox: &Gearbox,
    resolved: &Resolved,
    solution: &Solution<'_>,
    part: usize,
    changed: &[Changed],
) -> String {
    let mut lines = Lines::default();
    let out = &mut lines;
    let info = &transmission.parts()[part];
    let (loss, trace) = solution.explain(part);
    let entry = &transmission.instances()[info.notes.instance()].entry;
    out.text(&source(&info.path, entry));
    let kind = kind_of(&resolved.value, &info.path);
    if let Some(words) = entry.compared_in_words(kind.as_deref()) {
        out.line(format!("  measurements: {words}"));
    }
    let factor = match info.loss_factor {
        1.0 => String::new(),
        factor => format!(", loss factor {}", significant(factor)),
    };
    out.line(format!(
        "relative speed {} rpm{}{factor}",
        significant(loss.speed * RPM),
        match info.count {
            1.0 => String::new(),
            count => format!(", {} of them", significant(count)),
        }
    ));
    steps(transmission.instances(), trace, out);
    match loss.result {
        Ok(_) => {
            for term in entry.terms {
                out.line(format!(
                    "  {}: {} W",
                    term.name,
                    significant(loss.term_watts(term.index))
                ));
            }
            let moment = loss.moment().unwrap_or(0.0);
            out.line(format!(
                "  sum: {} W, {} Nm for one copy",
                significant(loss.watts()),
                significant(moment)
            ));
        }
        Err(undefined) => out.line(format!("  {undefined}")),
    }
    out.line("  operating state:");
    for reading in solution.readings(part) {
        let unit = if reading.unit.symbol == "-" {
            ""
        } else {
            reading.unit.symbol
        };
        out.line(format!("    {} = {} {unit}", reading.name, significant(reading.value)).trim_end());
    }
    explain_pair(transmission, resolved, solution, &info.path, out);
    if let Some(stage) = transmission.stages().find(|stage| stage.mesh == info.path) {
        out.line("  geometry:");
        for figure in stage_lines(&stage) {
            out.line(format!("    {figure}"));
        }
    }
    if let Some(stage) = transmission.crossed_stages().find(|stage| stage.mesh == info.path) {
        out.line("  geometry:");
        for figure in stage_lines(&stage) {
            out.line(format!("    {figure}"));
        }
    }
    let base = info.path.as_str();
    for changed in changed.iter().filter_map(|changed| changed.below(base)) {
        out.line(format!("  note: {changed}"));
    }
    out.line("  inputs (SI, temperatures in °C):");
    if let Some(entry) = lookup(&resolved.value, base) {
        inputs(base, entry, gearbox, resolved, out);
    }
    out.line("");
    lines.into_text()
}

/// The steps of a model, with the path of each nested model.
pub(super) fn steps(instances: &[Instance], trace: Trace, out: &mut Lines) {
    let mut last = usize::MAX;
    for step in trace.into_steps() {
        if step.instance() != last {
            last = step.instance();
            let instance = &instances[last];
            out.line(format!("  {} ({})", instance.path, instance.entry.name));
        }
        match step {
            Step::Value {
                symbol, unit, value, ..
            } => {
                let unit = if unit == "-" { "" } else { unit };
                out.line(format!("    {symbol} = {} {unit}", significant(value)).trim_end());
            }
            Step::Branch { taken, .. } => out.line(format!("    branch: {taken}")),
        }
    }
}

/// The steps of the heat of a heat path, by its number, at temperatures of oil and surface (degC).
pub fn explain_heat_path(
    transmission: &Transmission,
    gearbox: &Gearbox,
    resolved: &Resolved,
    way: usize,
    (oil, surface): (f64, f64),
) -> String {
    let mut lines = Lines::default();
    let out = &mut lines;
    let path = &transmission.housing().ways()[way].path;
    if let Some(instance) = transmission.instances().iter().find(|i| i.path == *path) {
        out.text(&source(path, &instance.entry));
    }
    out.line(format!(
        "oil {} °C, surface {} °C",
        significant(oil),
        significant(surface)
    ));
    let (heat, trace) = transmission.explain_way(way, oil, surface);
    steps(transmission.instances(), trace, out);
    match heat {
        Ok(heat) => out.line(format!("  heat: {} W", significant(heat))),
        Err(undefined) => out.line(format!("  {undefined}")),
    }
    out.line("  inputs (SI, temperatures in °C):");
    for place in [path.as_str(), "housing.outside"] {
        if let Some(entry) = lookup(&resolved.value, place) {
            inputs(place, entry, gearbox, resolved, out);
        }
    }
    out.line("");
    lines.into_text()
}

/// A component with its model and the source of the model.
fn source(path: &str, entry: &Entry) -> String {
    format!(
        "{path}: {} `{}`\n  {}\n  source: {}\n",
        entry.mechanism,
        entry.name,
        entry.meaning(),
        entry.source
    )
}

/// All values below a path with their origin.
fn inputs(path: &str, value: &Value, gearbox: &Gearbox, resolved: &Resolved, out: &mut Lines) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                inputs(&format!("{path}.{key}"), inner, gearbox, resolved, out);
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
            out.line(format!("    {path} = {leaf} ({from})"));
        }
    }
}
