//! The document of `check --format json`: findings by file, for editors and scripts.

use gearloss_framework::document::{PlacedDiagnostic, Severity};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Evidence;
use gearloss_studies::analyses::Work;
use gearloss_studies::checked::CheckedGearbox;
use gearloss_studies::checked_study::CheckedStudy;
use serde_json::{Map, Value, json};

use super::{checked_json, placed, warnings};

/// What was found in a file.
pub struct FileRecord {
    kind: &'static str,
    findings: Vec<PlacedDiagnostic>,
    /// Of a study: what its analyses compute, and components of its gearboxes without a model.
    of_study: Option<(Value, Vec<String>)>,
    /// Whether the file cannot be used.
    pub wrong: bool,
    /// The result for a valid gearbox.
    built: Option<Map<String, Value>>,
    lowest: Option<Evidence>,
}

impl FileRecord {
    /// Errors and warnings that `run` would report for a study.
    pub fn of_study(study: &CheckedStudy) -> Self {
        let refused = study.refused.iter().flat_map(|stopped| stopped.findings().iter());
        let found = refused.chain(&study.warnings);
        Self {
            kind: "study",
            findings: found.flat_map(|found| placed(&found.list, &found.sources)).collect(),
            of_study: Some((plan(study), study.notes.clone())),
            wrong: !study.refused.is_empty(),
            built: None,
            lowest: None,
        }
    }

    /// A built gearbox, with the resolved description if `with_resolved`, or why it cannot be built.
    pub fn of_gearbox(checked: &Result<CheckedGearbox, Findings>, with_resolved: bool) -> Self {
        let (findings, wrong) = match checked {
            Ok(checked) => (warnings(checked), false),
            Err(found) => (
                placed(&found.list, &found.sources),
                found.list.iter().any(|finding| finding.severity == Severity::Error),
            ),
        };
        let built = checked.as_ref().ok();
        Self {
            kind: "gearbox",
            findings,
            of_study: None,
            wrong,
            built: built.map(|checked| checked_json(checked, with_resolved)),
            lowest: built.and_then(CheckedGearbox::lowest_evidence),
        }
    }

    /// Whether a result depends on evidence of this grade or lower.
    pub fn is_denied(&self, grade: Option<Evidence>) -> bool {
        grade.is_some_and(|grade| self.lowest.is_some_and(|lowest| lowest >= grade))
    }

    /// The record of the file with this name.
    pub fn json(self, file: &str, denied_grade: Option<Evidence>) -> Value {
        let denied = self.is_denied(denied_grade);
        let mut record = Map::new();
        record.insert("file".to_owned(), file.into());
        record.insert("kind".to_owned(), self.kind.into());
        record.insert("fine".to_owned(), (!self.wrong).into());
        record.insert("findings".to_owned(), json!(self.findings));
        if let Some((plan, notes)) = self.of_study {
            record.insert("plan".to_owned(), plan);
            record.insert("notes".to_owned(), json!(notes));
        }
        if let Some(built) = self.built {
            record.extend(built);
            record.insert("denied".to_owned(), denied.into());
        }
        record.into()
    }
}

/// What each analysis of a study computes.
fn plan(study: &CheckedStudy) -> Value {
    let plans = study.plans.iter();
    let all = plans.flat_map(|(analysis, work)| work.iter().map(move |part| (analysis, part)));
    let part = |(analysis, part): (&String, &Work)| {
        json!({
            "analysis": analysis, "of": part.of, "count": part.count, "what": part.what, "at_most": part.at_most,
        })
    };
    all.map(part).collect()
}

/// One document for the records of all files.
pub fn document(language: &Language, files: Vec<Value>) -> Value {
    json!({
        "format": "gearloss-check/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": language.registry().packages(),
        "files": files,
    })
}
