//! What cannot be answered.

use gearloss_editor::Finding;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Findings;
use gearloss_studies::analyses::Stopped;
use serde::Serialize;

/// Why a request has no answer: one sentence, and the findings behind it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fault {
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: Option<String>,
    /// Findings in documents.
    pub findings: Vec<Finding>,
}

impl Fault {
    /// A fault without findings.
    pub fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: Some(help.into()),
            findings: Vec::new(),
        }
    }

    /// A newer request has made the answer needless.
    pub fn interrupted() -> Self {
        Self::new("interrupted", "ask again")
    }

    fn of(findings: Vec<Finding>) -> Self {
        let first = findings.first();
        Self {
            message: first.map_or_else(|| "no result".to_owned(), |finding| finding.message.clone()),
            help: first.and_then(|finding| finding.help.clone()),
            findings,
        }
    }
}

impl From<Findings> for Fault {
    fn from(findings: Findings) -> Self {
        Self::of(Finding::placed(&findings))
    }
}

impl From<Diagnostic> for Fault {
    fn from(finding: Diagnostic) -> Self {
        Findings::from(finding).into()
    }
}

impl From<Stopped> for Fault {
    fn from(stopped: Stopped) -> Self {
        match &stopped {
            Stopped::Found(_) | Stopped::Several(_) => {
                Self::of(stopped.findings().iter().flat_map(Finding::placed).collect())
            }
            Stopped::Interrupted => Self::interrupted(),
            Stopped::Elsewhere | Stopped::Unwritten(_) => {
                Self::new(stopped.to_string(), "run the study with `gearloss run`")
            }
        }
    }
}
