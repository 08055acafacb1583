//! The program, started again as a process of its own.

use std::ffi::OsString;
use std::process::Command;
use std::sync::OnceLock;

static STARTED_BY: OnceLock<Vec<OsString>> = OnceLock::new();

/// States the program and arguments before a command; the first statement holds.
pub fn set(words: Vec<OsString>) {
    let _ = STARTED_BY.set(words);
}

/// The program with these arguments; absent if nobody has stated it.
pub fn command() -> Option<Command> {
    let (program, arguments) = STARTED_BY.get()?.split_first()?;
    let mut command = Command::new(program);
    command.args(arguments);
    Some(command)
}
