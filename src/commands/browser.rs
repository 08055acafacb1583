//! The browser of the desktop.

use std::ffi::OsStr;
use std::process::{Command, Stdio};

use crate::output::Failure;

/// Hands a report or an address to the program that the desktop has for HTML files.
pub fn open(what: impl AsRef<OsStr>) -> Result<(), Failure> {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let opened = Command::new(program)
        .args(before)
        .arg(what)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        // Some desktops wait until the browser is closed.
        .spawn();
    opened.map(drop).map_err(|error| {
        Failure::input(
            format!("the browser cannot be opened: `{program}`: {error}"),
            "open what is printed above in a browser",
        )
    })
}
