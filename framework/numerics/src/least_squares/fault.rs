//! Why a problem cannot be fitted as it is stated.

use std::fmt;

/// One thing that is wrong with a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Where: a parameter, a residual, an option.
    pub place: String,
    /// What.
    pub message: String,
    /// How to mend it.
    pub mend: String,
}

/// Everything that is wrong with a problem, found at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Each of it; never empty.
    pub findings: Vec<Finding>,
}

impl Finding {
    pub(super) fn new(place: impl Into<String>, message: impl Into<String>, mend: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            message: message.into(),
            mend: mend.into(),
        }
    }
}

impl Fault {
    /// One thing that is wrong: where, what, and how to mend it.
    pub fn of(place: impl Into<String>, message: impl Into<String>, mend: impl Into<String>) -> Self {
        Finding::new(place, message, mend).into()
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
            let Finding { place, message, mend } = finding;
            write!(f, "{separator}{place}: {message}; {mend}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Fault {}
