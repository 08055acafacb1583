//! The work of an analysis in tasks, so that results are kept from run to run and computed on several machines.
//!
//! An analysis solves its points in stages, each of many tasks that do not depend on each other ([`Context::solve_pieces`]). Other
//! work is not split ([`Context::undivided`]). Without kept results all tasks run on the threads of this process. With them a run computes the tasks that are its own, keeps
//! their results, and goes on to the next stage only if all results of a stage are there.
//!
//! [`Context::solve_pieces`]: crate::analyses::Context::solve_pieces
//! [`Context::undivided`]: crate::analyses::Context::undivided

use crate::analyses::Stopped;

/// A task of an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Task<'a> {
    /// Name of the analysis.
    pub analysis: &'a str,
    /// Number of the stage, in the order in which the analysis comes to them.
    pub stage: usize,
    /// Number of the task in its stage.
    pub number: usize,
}

/// Results of tasks as bytes.
pub trait TaskResults: Sync {
    /// Whether this run computes a task.
    fn is_own(&self, task: Task<'_>) -> bool;

    /// Whether the result of a task is there.
    fn is_kept(&self, task: Task<'_>) -> bool;

    /// Whether this run computes stages to the end whose results are not all there, and keeps none.
    fn completes(&self) -> bool;

    /// The result of a task.
    ///
    /// # Errors
    /// [`Stopped::Unwritten`] where it cannot be read.
    fn read(&self, task: Task<'_>) -> Result<Vec<u8>, Stopped>;

    /// Keeps the result of a task.
    ///
    /// # Errors
    /// [`Stopped::Unwritten`] where it cannot be written.
    fn keep(&self, task: Task<'_>, result: &[u8]) -> Result<(), Stopped>;
}
