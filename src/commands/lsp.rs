//! `lsp`: the language server on the standard streams.

use std::io::{BufReader, stdin, stdout};

use gearloss_framework::files::Disk;

use crate::output::{End, Failure};

/// Serves until the editor ends the session.
pub fn run() -> Result<End, Failure> {
    let language = super::language()?;
    let in_order = gearloss_editor::lsp::serve(language, Disk::shared(), BufReader::new(stdin()), stdout());
    Ok(if in_order { End::Fine } else { End::Finding })
}
