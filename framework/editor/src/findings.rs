//! The findings of `gearloss check` for one file, with ranges.

use std::collections::BTreeMap;
use std::path::Path;

use gearloss_document::{Diagnostic, Severity, Span};
use gearloss_framework::gearbox::{DocumentKind, Findings};
use gearloss_framework::resolve::Choice;
use gearloss_studies::analyses::Stopped;
use gearloss_studies::checked::CheckedGearbox;
use gearloss_studies::checked_study::CheckedStudy;
use gearloss_studies::engine::progress::Progress;
use serde::Serialize;

use crate::text::{Lines, TextRange};
use crate::workspace::Workspace;

/// A finding with its ranges.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// Code, as in docs/errors.md.
    pub code: String,
    /// Path in the document; empty if there is none.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: Option<String>,
    /// More about it.
    pub notes: Vec<String>,
    /// Where; `None` if it has no place, such as a file that cannot be read.
    pub place: Option<FileRange>,
    /// Other places that explain it.
    pub related: Vec<Related>,
}

/// A range of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FileRange {
    /// File.
    pub file: String,
    /// Range.
    pub range: TextRange,
}

/// A place that explains a finding.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Related {
    /// Where.
    #[serde(flatten)]
    pub place: FileRange,
    /// What it has to do with the finding.
    pub message: String,
}

impl Finding {
    /// Findings with their ranges.
    pub fn placed(findings: &Findings) -> Vec<Self> {
        let mut found = Found::default();
        found.add(findings);
        found.list
    }
}

impl Workspace<'_> {
    /// The findings of `gearloss check` for a file, in its order; `None` if the caller interrupted it.
    pub fn findings(&self, path: &Path, progress: &dyn Progress) -> Option<Vec<Finding>> {
        let files = self.files();
        let is_study = self
            .document(path)
            .is_some_and(|document| document.kind == DocumentKind::Study);
        let mut found = Found::default();
        if is_study {
            let checked = CheckedStudy::read(self.language, &files, path, progress);
            for stopped in &checked.refused {
                if matches!(stopped, Stopped::Interrupted) {
                    return None;
                }
                stopped.findings().iter().for_each(|findings| found.add(findings));
            }
            checked.warnings.iter().for_each(|findings| found.add(findings));
        } else {
            match CheckedGearbox::read(self.language, &files, path, &Choice::default()) {
                Ok(checked) => found.add(&Findings {
                    list: checked.warnings(),
                    sources: checked.gearbox.sources,
                }),
                Err(findings) => found.add(&findings),
            }
        }
        progress.should_continue().then_some(found.list)
    }
}

#[derive(Default)]
struct Found {
    list: Vec<Finding>,
}

impl Found {
    fn add(&mut self, findings: &Findings) {
        let mut lines: BTreeMap<u16, Lines> = BTreeMap::new();
        let mut place = |span: Span| {
            let (file, text) = findings.sources.get(span.source)?;
            let lines = lines.entry(span.source).or_insert_with(|| Lines::new(text));
            Some(FileRange {
                file: file.to_owned(),
                range: lines.range(text, &(span.start as usize..span.end as usize)),
            })
        };
        for finding in &findings.list {
            self.list.push(placed(finding, &mut place));
        }
    }
}

fn placed(finding: &Diagnostic, place: &mut dyn FnMut(Span) -> Option<FileRange>) -> Finding {
    let mut related = Vec::new();
    for (span, label) in finding.spans.iter().skip(1) {
        related.extend(place(*span).map(|place| Related {
            place,
            message: label.clone(),
        }));
    }
    Finding {
        severity: finding.severity,
        code: finding.code_or_other().id().to_owned(),
        path: finding.path.clone(),
        message: finding.message.clone(),
        help: finding.help.clone(),
        notes: finding.notes.clone(),
        place: finding.spans.first().and_then(|(span, _)| place(*span)),
        related,
    }
}
