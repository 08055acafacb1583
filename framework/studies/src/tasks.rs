//! Tasks of an analysis, so that results can be stored and computed on several machines.
//!
//! An analysis computes in stages of many tasks that do not depend on each other: pieces of points ([`Engine::solve`]), and samples, pairs
//! of values or starts ([`Engine::jobs`]). Parts of an analysis such as model sets do not wait for each other ([`Engine::parts`]). Other
//! work is not split ([`Engine::undivided`]).
//!
//! Without stored results all tasks run on the threads of this process. With them a run computes its own tasks, stores their
//! results, and continues with the next stage only if all results of a stage are there.
//!
//! [`Engine::solve`]: crate::analyses::Engine::solve
//! [`Engine::jobs`]: crate::analyses::Engine::jobs
//! [`Engine::parts`]: crate::analyses::Engine::parts
//! [`Engine::undivided`]: crate::analyses::Engine::undivided

use std::io;
use std::path::PathBuf;

use crate::engine::stopped::Stopped;

/// Why results cannot be written, or stored results of tasks not be read.
#[derive(Debug, thiserror::Error)]
pub enum StorageError {
    /// A file cannot be written.
    #[error("cannot write {}: {error}", .file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// Two results would be written to one file.
    #[error("two results would have the name {0}")]
    SameName(String),
    /// A result has no form as bytes: a bug of its analysis.
    #[error("a result cannot be encoded: {0}")]
    Encode(postcard::Error),
    /// The result of a task cannot be read.
    #[error("cannot read a result of `{analysis}`: {error}")]
    Read {
        /// Name of the analysis.
        analysis: String,
        /// The reason.
        error: io::Error,
    },
    /// A stored result belongs to another task.
    #[error("result {number} of stage {stage} in part {part} of `{analysis}` is not that of its task")]
    OtherTask {
        /// Name of the analysis.
        analysis: String,
        /// Number of the part, see [`Task::part`].
        part: usize,
        /// Number of the stage.
        stage: usize,
        /// Index of the task.
        number: usize,
    },
}

/// A task of an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Task<'a> {
    /// Name of the analysis.
    pub analysis: &'a str,
    /// Number of the part of the analysis; 0 outside all parts.
    pub part: usize,
    /// Number of the stage in its part, in the order in which the analysis comes to them.
    pub stage: usize,
    /// Index of the task in its stage.
    pub number: usize,
}

/// Results of tasks as bytes.
pub trait TaskResults: Sync {
    /// Whether this run computes a task.
    fn is_own(&self, task: Task<'_>) -> bool;

    /// Whether the result of a task exists.
    fn is_kept(&self, task: Task<'_>) -> bool;

    /// Whether this run completes stages with missing results, without storing any.
    fn completes(&self) -> bool;

    /// The result of a task.
    ///
    /// # Errors
    /// [`Stopped::Unwritten`] if it cannot be read.
    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped>;

    /// Stores the result of a task.
    ///
    /// # Errors
    /// [`Stopped::Unwritten`] if it cannot be written.
    fn keep(&self, task: Task<'_>, result: &[u8]) -> Result<(), Stopped>;
}
