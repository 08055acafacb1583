//! `check --format json`: findings by file, for editors and scripts.

use std::path::Path;

use gearloss_framework::document::{PlacedDiagnostic, Severity};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_report::check::{checked_json, placed, warnings};
use gearloss_studies::analyses::Stopped;
use gearloss_studies::checked_study::CheckedStudy;
use serde_json::{Value, json};

use crate::args::{CheckArgs, ChoiceArgs};
use crate::output::{End, Failure, Out};

/// Prints one document for all files. Errors appear in the document and in the exit code, not on standard error.
pub fn run(language: &Language, args: &CheckArgs, deny: Option<Evidence>, out: &mut Out) -> Result<End, Failure> {
    let mut end = End::Fine;
    let mut wrong = false;
    let mut files = Vec::new();
    for file in &args.files {
        let is_study = super::is_study(file);
        let checked = if is_study {
            super::belongs_to_gearboxes(args, file)?;
            study(super::study(language, file))?
        } else {
            gearbox(language, file, &args.choice, args.resolved).unwrap_or_else(|findings| Checked {
                findings: placed(&findings.list, &findings.sources),
                wrong: findings.list.iter().any(|d| d.severity == Severity::Error),
                ..Checked::default()
            })
        };
        let denied = deny.is_some_and(|deny| checked.lowest.is_some_and(|lowest| lowest >= deny));
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
    lowest: Option<Evidence>,
}

/// Errors and warnings that `run` would report for a study.
fn study(checked: CheckedStudy) -> Result<Checked, Failure> {
    let mut findings = Vec::new();
    for stopped in &checked.refused {
        if matches!(stopped, Stopped::Interrupted) {
            return Err(Failure::Interrupted);
        }
        let found = stopped.findings().iter();
        findings.extend(found.flat_map(|findings| placed(&findings.list, &findings.sources)));
    }
    for found in &checked.warnings {
        findings.extend(placed(&found.list, &found.sources));
    }
    Ok(Checked {
        findings,
        notes: checked.notes,
        wrong: !checked.refused.is_empty(),
        ..Checked::default()
    })
}

fn gearbox(language: &Language, file: &Path, choice: &ChoiceArgs, print: bool) -> Result<Checked, Findings> {
    let checked = super::checked(language, file, choice)?;
    Ok(Checked {
        findings: warnings(&checked),
        lowest: checked.lowest_evidence(),
        built: Some(checked_json(&checked, print)),
        ..Checked::default()
    })
}
