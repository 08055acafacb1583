//! Templates of the user.
//!
//! Steps and the length of the page are limited here. The memory of values and the depth of nesting cannot be, so that a process of its own
//! fills such a template (`gearloss fill-template`).

use std::io::{self, Write};

use gearloss_framework::document::{Diagnostic, visible};
use minijinja::{Error, ErrorKind};
use serde_json::Value;

use super::{MOST_STEPS, environment, filled};
use crate::codes;

/// Maximum length of a template. \[byte\]
pub const LONGEST_TEMPLATE: u64 = 256 << 10;

/// Maximum length of a page. \[byte\]
pub const LONGEST_PAGE: u64 = 256 << 20;

/// Writes a page by a template of the user; `content` is a serialised [`Content`](super::Content).
///
/// # Errors
/// What is wrong with the template and where.
pub fn fill_template(name: &str, template: &str, content: Value, to: &mut impl Write) -> Result<(), Diagnostic> {
    let mut page = Page { to, left: LONGEST_PAGE };
    let mut environment = environment();
    environment.set_fuel(Some(MOST_STEPS));
    let template = environment.template_from_named_str(name, template);
    let done = template.and_then(|template| template.render_captured_to(filled(content), &mut page).map(drop));
    match done {
        Ok(()) => Ok(()),
        Err(_) if page.left == 0 => {
            let most = LONGEST_PAGE >> 20;
            Err(about(
                name,
                format!("the page has more than {most} MB; does a loop repeat it?"),
            ))
        }
        Err(error) => Err(fault(name, &error)),
    }
}

/// A page with a limited length, in which hidden characters are shown as escapes.
struct Page<'a, W> {
    to: &'a mut W,
    left: u64,
}

impl<W: Write> Write for Page<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = std::str::from_utf8(bytes).map_err(io::Error::other)?;
        let shown = visible(text);
        self.left = self.left.saturating_sub(shown.len() as u64);
        if self.left == 0 {
            return Err(io::Error::from(io::ErrorKind::FileTooLarge));
        }
        self.to.write_all(shown.as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// The finding about an error of a template.
pub(super) fn fault(name: &str, error: &Error) -> Diagnostic {
    let words = match error.kind() {
        ErrorKind::OutOfFuel => format!(
            "it takes more than {} million steps; does it contain nested loops?",
            MOST_STEPS / 1_000_000
        ),
        _ => format!("{error:#}"),
    };
    about(name, words)
}

fn about(name: &str, words: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::error("", format!("the template {name}: {words}"))
        .help("correct it, or omit --template")
        .code(codes::TEMPLATE)
}
