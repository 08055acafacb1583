//! The program of this crate, run in the crate's folder.
#![allow(clippy::unwrap_used, dead_code, reason = "each test file takes what it needs")]

use std::io::Write as _;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// What a run left.
pub struct Run {
    args: String,
    output: std::process::Output,
}

/// Runs the program.
pub fn program(args: &[&str]) -> Run {
    let output = Command::cargo_bin("in-house-plugin")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .unwrap();
    Run {
        args: args.join(" "),
        output,
    }
}

impl Run {
    /// What it printed; it must have ended well.
    pub fn fine(self) -> String {
        let told = String::from_utf8_lossy(&self.output.stderr);
        assert!(self.output.status.success(), "{}: {told}", self.args);
        String::from_utf8(self.output.stdout).unwrap()
    }

    /// What it said against its input.
    pub fn refused(self) -> String {
        assert_eq!(self.output.status.code(), Some(2), "{}", self.args);
        String::from_utf8(self.output.stderr).unwrap()
    }
}

/// A folder for results in the target folder.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Says past the capture of the test runner, so that everybody sees it, what was not tested.
pub fn skipped(what: &str) {
    std::io::stderr()
        .write_all(format!("SKIPPED: {what}\n").as_bytes())
        .unwrap();
}
