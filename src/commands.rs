//! The commands, one file each.

mod browser;
pub mod catalogue;
pub mod check;
pub mod completions;
pub mod eval;
pub mod explain;
pub mod fill_template;
pub mod fit;
pub mod import;
pub mod lsp;
pub mod man;
pub mod merge;
pub mod models;
pub mod new;
pub mod open;
mod point;
pub mod report;
pub mod run;
pub mod schema;
mod set;
pub mod shards;
pub mod solve;
pub mod validate;

use std::path::Path;
use std::sync::OnceLock;

use gearloss_framework::files::{LONGEST_DATA, read_bytes, read_text};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::transmission::Transmission;

use crate::output::{Failure, Out};

/// The language of all linked crates, assembled once per process.
fn language() -> Result<&'static Language, Failure> {
    static LINKED: OnceLock<Language> = OnceLock::new();
    if LINKED.get().is_none() {
        // If two threads arrive simultaneously, the result of the first is kept.
        let _ = LINKED.set(Language::linked()?);
    }
    let bug = || Failure::input("bug: the language was assembled but is missing", "report this");
    LINKED.get().ok_or_else(bug)
}

/// The text of a file that an argument names; `help` says what to do if it cannot be read.
fn read_file(file: &Path, longest: u64, help: &str) -> Result<String, Failure> {
    read_text(file, longest).map_err(|e| Failure::input(format!("cannot read {}: {e}", file.display()), help))
}

/// The bytes of a table.
fn read_table(file: &Path) -> Result<Vec<u8>, Failure> {
    read_bytes(file, LONGEST_DATA)
        .map_err(|e| Failure::input(format!("cannot read {}: {e}", file.display()), "check the file name"))
}

/// Prints warnings and notes of building to standard error.
fn warn(gearbox: &Gearbox, transmission: &Transmission) -> Result<(), Failure> {
    for warning in &transmission.warnings {
        Out::error().line(format!("{}\n", gearbox.sources.render(warning)))?;
    }
    Ok(())
}
