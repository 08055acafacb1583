//! Why a problem cannot be fitted as it is stated.

use serde::{Deserialize, Serialize};
use std::fmt;

/// One thing that is wrong with a problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// Where: a parameter, a residual, an option.
    pub place: String,
    /// What.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

/// Everything that is wrong with a problem, found at once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    /// Each of it; never empty.
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
    /// One thing that is wrong: where, what, and how to fix it.
    pub fn of(place: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
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

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, finding) in self.findings.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            let Finding { place, message, help } = finding;
            write!(f, "{separator}{place}: {message}; {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Fault {}
