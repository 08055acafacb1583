//! What several analyses print or write.

use gearloss_studies::analyses::ranges::published;
use gearloss_studies::measured::{Measured, Row};
use gearloss_studies::varied::Varied;
use serde_json::Value;

use crate::output::{Failure, Out};

/// A row in results, with its file where there are several.
pub fn in_file(mut value: Value, measured: &Measured, row: &Row) -> Value {
    if let (Some(file), Some(value)) = (measured.file(row), value.as_object_mut()) {
        value.insert("file".to_owned(), file.into());
    }
    value
}

/// Prints which of the varied quantities are coefficients of formulas, with the value of the source.
pub fn show_published<'a>(all: impl Iterator<Item = &'a Varied>, out: &mut Out) -> Result<(), Failure> {
    for coefficient in published(all) {
        out.line(format!(
            "`{}`: a coefficient of a formula, published {}; other values are changed from the source",
            coefficient.pattern, coefficient.published
        ))?;
    }
    Ok(())
}
