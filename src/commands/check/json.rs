//! `check --format json`: findings by file, for editors and scripts.

use std::path::Path;

use gearloss_framework::codes;
use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::document::{Diagnostic, PlacedDiagnostic, Severity, Sources};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_framework::transmission::{GearState, Transmission};
use gearloss_studies::analysis::evidence;
use serde_json::{Value, json};

use crate::args::{CheckArgs, ChoiceArgs};
use crate::commands::run::Looked;
use crate::commands::set;
use crate::output::{End, Failure, Out, significant};

/// Prints one document for all files. Errors appear in the document and in the exit code, not on standard error.
pub fn run(language: &Language, args: &CheckArgs, deny: Option<Evidence>, out: &mut Out) -> Result<End, Failure> {
    let mut end = End::Fine;
    let mut wrong = false;
    let mut files = Vec::new();
    for file in &args.files {
        let is_study = super::is_study(file);
        let checked = if is_study {
            super::belongs_to_gearboxes(args, file)?;
            study(crate::commands::run::look_over(language, file))?
        } else {
            gearbox(language, file, &args.choice, args.resolved).unwrap_or_else(|findings| Checked {
                findings: found(&findings.list, &findings.sources),
                wrong: findings.list.iter().any(|d| d.severity == Severity::Error),
                ..Checked::default()
            })
        };
        let denied = deny.is_some_and(|deny| checked.weakest.is_some_and(|weakest| weakest >= deny));
        if denied {
            end = End::Finding;
        }
        wrong |= checked.wrong;
        let mut value = json!({
            "file": file.display().to_string(),
            "kind": if is_study { "study" } else { "gearbox" },
            "fine": !checked.wrong,
            "findings": checked.findings,
        });
        if is_study && let Some(value) = value.as_object_mut() {
            value.insert("notes".to_owned(), json!(checked.notes));
        }
        if let (Some(value), Some(built)) = (value.as_object_mut(), checked.built) {
            value.extend(built);
            value.insert("denied".to_owned(), denied.into());
        }
        files.push(value);
    }
    let value = json!({
        "format": "gearloss-check/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": language.registry().packages(),
        "files": files,
    });
    out.line(serde_json::to_string_pretty(&value).unwrap_or_default())?;
    if wrong {
        Err(Failure::Input(String::new()))
    } else {
        Ok(end)
    }
}

/// The result for a file.
#[derive(Default)]
struct Checked {
    findings: Vec<PlacedDiagnostic>,
    /// Components of a study's gearboxes without a model.
    notes: Vec<String>,
    /// The file cannot be used.
    wrong: bool,
    /// The result for a valid gearbox.
    built: Option<serde_json::Map<String, Value>>,
    weakest: Option<Evidence>,
}

/// Errors and warnings that `run` would report for a study.
fn study(looked: Looked) -> Result<Checked, Failure> {
    let mut checked = Checked {
        wrong: !looked.refused.is_empty(),
        ..Checked::default()
    };
    for failure in looked.refused {
        match failure {
            Failure::Found(findings) => checked.findings.extend(found(&findings.list, &findings.sources)),
            Failure::Input(text) => {
                let finding = Diagnostic::error("", text.trim().trim_start_matches("error: "));
                let finding = finding.code(gearloss_studies::codes::STUDY);
                checked.findings.extend(found(&[finding], &Sources::default()));
            }
            Failure::Interrupted => return Err(Failure::Interrupted),
        }
    }
    for warnings in &looked.warnings {
        checked.findings.extend(found(&warnings.list, &warnings.sources));
    }
    checked.notes = looked.notes;
    Ok(checked)
}

fn gearbox(language: &Language, file: &Path, choice: &ChoiceArgs, print: bool) -> Result<Checked, Findings> {
    let gearbox = Gearbox::read(language, file)?;
    gearbox.check_sets(language)?;
    let resolved = set::resolve(language, &gearbox, choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    let known = evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path));
    let states: Vec<&str> = transmission.states().iter().map(|s| s.name.as_str()).collect();
    let notes: Vec<&String> = resolved.unreached.iter().chain(&resolved.without).collect();
    let weakest = known.first();
    let mut built = serde_json::Map::new();
    built.insert("parts".to_owned(), transmission.parts().len().into());
    built.insert("gear_states".to_owned(), json!(states));
    built.insert("stages".to_owned(), json!(transmission.stages().collect::<Vec<_>>()));
    built.insert("ratios".to_owned(), ratios(&transmission));
    built.insert("notes".to_owned(), json!(notes));
    let changed = changed_from_source(&transmission, &resolved);
    built.insert("changed_from_source".to_owned(), json!(changed));
    built.insert(
        "weakest_evidence".to_owned(),
        weakest.map_or(
            Value::Null,
            |weak| json!({ "grade": weak.grade.name(), "what": weak.what, "because": weak.because }),
        ),
    );
    if print {
        built.insert("resolved".to_owned(), resolved.value.clone());
    }
    let overloaded = super::overloaded(&transmission).into_iter().map(|note| {
        let message = format!(
            "{} {} at the rated torque is below 1",
            note.name,
            significant(note.least)
        );
        gearbox.places.place(
            Diagnostic::warning(note.path, message)
                .help("use a larger bearing, or check the rating")
                .code(codes::OVERLOADED),
        )
    });
    let warnings: Vec<Diagnostic> = transmission.warnings.iter().cloned().chain(overloaded).collect();
    Ok(Checked {
        findings: found(&warnings, &gearbox.sources),
        wrong: false,
        weakest: weakest.map(|weak| weak.grade),
        built: Some(built),
        ..Checked::default()
    })
}

/// The ratio from the reference port to each other port for each gear.
fn ratios(t: &Transmission) -> Value {
    let from = &t.ports()[t.reference_port()].name;
    let of_gear = |(i, gear): (usize, &GearState)| {
        let ratios = t.ratios(i).into_iter();
        ratios
            .map(|(to, ratio)| json!({ "gear": gear.name, "from": from, "to": t.ports()[to].name, "ratio": ratio }))
            .collect::<Vec<_>>()
    };
    t.states().iter().enumerate().flat_map(of_gear).collect()
}

/// Findings with file, line and column instead of spans.
fn found(list: &[Diagnostic], sources: &Sources) -> Vec<PlacedDiagnostic> {
    list.iter().map(|finding| sources.placed(finding)).collect()
}
