//! Errors in the statement of a problem.

use serde::{Deserialize, Serialize};

/// One error of a problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{place}: {message}; {help}")]
pub struct Finding {
    /// Place: a parameter, a residual, an option.
    pub place: String,
    /// Message.
    pub message: String,
    /// Help.
    pub help: String,
}

/// All errors of a problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{}", self.lines())]
pub struct Fault {
    /// The errors; never empty.
    pub findings: Vec<Finding>,
}

impl Finding {
    pub(super) fn new(place: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            message: message.into(),
            help: help.into(),
        }
    }
}

impl Fault {
    /// The errors, each on its line.
    fn lines(&self) -> String {
        let lines: Vec<String> = self.findings.iter().map(ToString::to_string).collect();
        lines.join("\n")
    }

    /// One error: place, message and help.
    pub fn single(place: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Finding::new(place, message, help).into()
    }
}

impl From<Finding> for Fault {
    fn from(finding: Finding) -> Self {
        Self {
            findings: vec![finding],
        }
    }
}
