//! Errors in the statement of a problem.

use std::fmt;

/// One error of a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Place: a parameter, a residual, an option.
    pub place: String,
    /// Message.
    pub message: String,
    /// Help.
    pub help: String,
}

/// All errors of a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
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
