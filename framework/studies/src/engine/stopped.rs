//! Why an analysis has no outcome.

use gearloss_framework::gearbox::Findings;

use crate::tasks::StorageError;

/// Why an analysis has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum Stopped {
    /// Errors of its input.
    #[error("{0}")]
    Found(#[from] Findings),
    /// Independent errors of several inputs.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<String>())]
    Several(Vec<Findings>),
    /// Interrupted by the caller.
    #[error("interrupted")]
    Interrupted,
    /// It needs results of tasks of other runs.
    #[error("it needs results that other runs compute")]
    Elsewhere,
    /// Results cannot be written or read.
    #[error("{0}")]
    Unwritten(#[from] StorageError),
}

impl Stopped {
    /// What was found: none where the input is right.
    pub fn findings(&self) -> &[Findings] {
        match self {
            Self::Found(findings) => std::slice::from_ref(findings),
            Self::Several(list) => list,
            Self::Interrupted | Self::Elsewhere | Self::Unwritten(_) => &[],
        }
    }
}
