//! The limit of the width of registers.

use gearloss_framework::real::{LIMIT, WIDTHS};

use crate::output::Failure;

/// Refuses a limit that is none of the widths: a misspelt one would limit nothing.
pub fn check() -> Result<(), Failure> {
    match std::env::var(LIMIT) {
        Ok(width) if !WIDTHS.contains(&width.as_str()) => Err(Failure::input(
            format!("{LIMIT}={width} is no width of registers"),
            format!("write {}, or delete the variable", WIDTHS.join(", ")),
        )),
        _ => Ok(()),
    }
}
