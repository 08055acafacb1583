//! Opens a report in the browser of the desktop.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::output::Failure;

/// Hands the report to the program that the desktop has for HTML files.
pub fn report(file: &Path) -> Result<(), Failure> {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let opened = Command::new(program)
        .args(before)
        .arg(file)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        // Some desktops wait until the browser is closed.
        .spawn();
    opened
        .map(drop)
        .map_err(|error| no_browser(&format!("`{program}`: {error}")))
}

fn no_browser(reason: &str) -> Failure {
    Failure::input(
        format!("the report cannot be opened: {reason}"),
        "open the file whose path is printed above in a browser",
    )
}
