//! A map of a gearbox: the analysis `map` of a study that is not a file.

use std::path::Path;

use gearloss_framework::files::SharedSource;
use gearloss_framework::language::Language;
use gearloss_report::html::Report;
use gearloss_studies::analyses::Stopped;
use gearloss_studies::engine::progress::Progress;
use gearloss_studies::run::StudyRun;
use gearloss_studies::study::Study;
use serde_json::{Value, json};

use crate::answer::Fault;
use crate::chosen::Chosen;
use crate::request::{MapOf, Span};
use crate::section::section_json;

/// Model set of another volume of oil.
const FILLED: &str = "given_volume";

/// Maximum number of torques and of speeds.
const MOST: usize = 60;

/// Computes a map.
pub fn map(language: &Language, files: &SharedSource, of: &MapOf, progress: &dyn Progress) -> Result<Value, Fault> {
    let study = study(language, files, of, progress)?;
    let outcome = StudyRun::new(language, &study).analysis_with("map", progress)?;
    let mut report = Report::default();
    if let Some(analysis) = study.entry.analyses.get("map") {
        report.begin(&study.entry.analyses, "map", analysis);
    }
    let page = report.page("map", outcome.as_ref());
    let section = report.sections.last_mut();
    let section = section.ok_or_else(|| Fault::from(Stopped::Interrupted))?;
    section.add(page);
    Ok(section_json(section))
}

/// The study of a map.
fn study(language: &Language, files: &SharedSource, of: &MapOf, progress: &dyn Progress) -> Result<Study, Fault> {
    let (ports, fill) = ports(language, files, of, progress)?;
    let file = Path::new(&of.gearbox);
    let [torque_at, speed_at] = ports;
    let own = Some(of.model_set.as_str()).filter(|set| !set.is_empty());
    // Another volume is a model set of its own.
    let filled = of.oil_volume.map(|_| FILLED);
    let sets: Vec<&str> = filled.or(own).into_iter().collect();
    let mut conditions = json!({ "torque_at": torque_at, "speed_at": speed_at });
    if let Some(oil) = of.oil_temperature {
        conditions["oil_temperature"] = json!(format!("{oil} degC"));
    }
    let mut study = json!({
        "gearloss": "study/1",
        "gearboxes": { "gearbox": file.file_name().map(|name| name.to_string_lossy()) },
        "conditions": conditions,
        "grids": { "map": {
            "gear": of.gear,
            "torque": axis(of.torque, of.count, "Nm")?,
            "speed": axis(of.speed, of.count, "rpm")?,
        } },
        "analyses": { "map": { "type": "map", "grid": "map", "model_sets": sets } },
    });
    if let Some(name) = filled {
        let set: serde_json::Map<String, Value> = fill.into_iter().collect();
        study["model_sets"][name] = match own {
            Some(own) => json!({ "extends": own, "set": set }),
            None => json!({ "set": set }),
        };
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let study = Study::from_text(language, files, study.to_string(), "map of the workbench", folder)?;
    study.check(language)?;
    Ok(study)
}

/// Ports of torque and speed, as in the controls, and overrides for another volume of oil.
#[allow(clippy::type_complexity)]
fn ports(
    language: &Language,
    files: &SharedSource,
    of: &MapOf,
    progress: &dyn Progress,
) -> Result<([String; 2], Vec<(String, Value)>), Fault> {
    let chosen = Chosen::read(language, files, &of.gearbox, &of.model_set, progress)?;
    let fill = of
        .oil_volume
        .map_or_else(|| Ok(Vec::new()), |volume| chosen.fill(volume))?;
    let transmission = &chosen.transmission;
    let state = transmission
        .state(&of.gear)
        .map_err(|e| chosen.gearbox.findings(vec![e]))?;
    let ports = transmission.ports();
    let speeds = &transmission.states()[state].speed_ports;
    let reference = transmission.reference_port();
    match (speeds.as_slice(), transmission.torques_needed(state)) {
        ([speed], 1) => {
            let names = [ports[reference].name.clone(), ports[*speed].name.clone()];
            Ok((names, fill))
        }
        _ => Err(Fault::new(
            format!(
                "a map needs one torque and one speed, which `{}` does not have",
                of.gear
            ),
            "choose another gear, or use the analysis `operating_points` in a study",
        )),
    }
}

/// Even values; zero at an end has no efficiency and is omitted.
fn axis(span: Span, count: usize, unit: &str) -> Result<Vec<String>, Fault> {
    let Span { from, to } = span;
    let count = count.clamp(2, MOST);
    if !(from.is_finite() && to.is_finite() && from < to) {
        let message = format!("the range from {from} to {to} {unit} is empty");
        return Err(Fault::new(message, "let it end at a larger value than it starts"));
    }
    let step = |parts: usize| (to - from) / parts as f64;
    let values: Vec<f64> = if from == 0.0 {
        (1..=count).map(|i| step(count) * i as f64).collect()
    } else if to == 0.0 {
        (0..count).map(|i| from + step(count) * i as f64).collect()
    } else {
        (0..count).map(|i| from + step(count - 1) * i as f64).collect()
    };
    // Rounded so that axes and tables show short numbers.
    let digits = (3.0 - (to - from).log10().floor()).clamp(0.0, 9.0) as usize;
    Ok(values.iter().map(|value| format!("{value:.digits$} {unit}")).collect())
}
