//! The program as a process.

use std::path::Path;
use std::process::{Command, Output};

/// What it does in a folder.
pub fn gearloss_in(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

/// What it does in the folder of the repository.
pub fn gearloss(arguments: &[&str]) -> Output {
    gearloss_in(Path::new(env!("CARGO_MANIFEST_DIR")), arguments)
}

/// What it prints there; it succeeds.
pub fn out(arguments: &[&str]) -> String {
    let output = gearloss(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}
