//! Data files: from bytes to cells, and the columns of quantities.

pub mod cells;
mod encoding;
mod file;
mod foreign;
mod form;
mod header;
mod mdf;
pub mod missing;
pub mod numbers;
pub mod sheet;
mod table;
mod times;
mod workbook;

use crate::{Dimension, Unit};

pub use file::{StatedTable, TableFile};
pub use form::{DateOrder, Decimal, Encoding, MissingMark, Separator, TableForm, Thousands};
pub use header::without_brackets;

/// The key that a fault refers to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FaultPlace {
    /// The key of the measurement at this path inside its entry.
    Entry(String),
    /// A bound column: a key of `bind` of the analysis.
    Bind(String),
}

/// An error in a file and its help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredFault {
    /// The key that it refers to.
    pub place: FaultPlace,
    /// Message with line and column.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

impl MeasuredFault {
    /// An error at a key of the measurement.
    pub fn new(key: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            place: FaultPlace::Entry(key.into()),
            message: message.into(),
            help: help.into(),
        }
    }
}

/// An error without a key.
pub fn fault(message: impl Into<String>, help: impl Into<String>) -> MeasuredFault {
    MeasuredFault::new("", message, help)
}

/// Largest amount of a measured quantity with its documented unit, as in documents; SI. Products of numbers below it remain finite.
pub fn greatest(due: &str) -> f64 {
    match due {
        "Nm" | "W" => 1e9,
        "rpm" => 1e6 * std::f64::consts::PI / 30.0,
        _ => 1e12,
    }
}

/// The unit of a column as the study and the file state it.
#[derive(Debug, Clone, Copy, Default)]
pub struct StatedUnit<'a> {
    /// Under `units` of the study.
    pub study: Option<&'a str>,
    /// In the file.
    pub file: Option<&'a str>,
    /// Whether the study has precedence where they differ, `units_override: true`.
    pub overrides: bool,
}

impl<'a> StatedUnit<'a> {
    /// The unit that applies.
    ///
    /// # Errors
    /// If study and file state different units.
    pub fn chosen(&self, name: &str, header: &str) -> Result<Option<&'a str>, MeasuredFault> {
        let (Some(study), Some(file)) = (self.study, self.file) else {
            return Ok(self.study.or(self.file));
        };
        let unit = Unit::read(study);
        // A dash in a file is no unit, except of a plain number.
        let is_blank = matches!(file, "" | "-" | "1") && unit.is_none_or(|unit| unit.dimension != Dimension::None);
        if self.overrides || is_blank || Unit::is_same(study, file) {
            return Ok(Some(study));
        }
        Err(fault(
            format!("column `{header}` is in `{file}` according to the file, in `{study}` according to the study"),
            format!(
                "delete `{name}` under `units`, so that the file's unit applies; if the file is wrong, add `units_override: true`"
            ),
        ))
    }

    /// Whether the study changes the unit of the file, for a note.
    pub fn is_overridden(&self) -> bool {
        let is_other = Self {
            overrides: false,
            ..*self
        };
        is_other.chosen("", "").is_err()
    }
}

/// Factor and offset of a unit to SI, for a quantity with its documented unit.
///
/// # Errors
/// If there is no unit, none of the quantity, or two different ones.
pub fn scale((name, due): (&str, &str), unit: StatedUnit<'_>, header: &str) -> Result<(f64, f64), MeasuredFault> {
    let wanted = Unit::of_symbol(due).unwrap_or(Unit::ONE);
    let Some(symbol) = unit.chosen(name, header)? else {
        return match due {
            "-" if ["weight", "share"].contains(&name) => Ok((1.0, 0.0)),
            "-" => Err(fault(
                format!("column `{header}` has no unit: fraction or percent?"),
                format!("state it: `units: {{ {name}: \"%\" }}` or `units: {{ {name}: \"-\" }}`"),
            )),
            _ => Err(fault(
                format!("column `{header}` has no unit"),
                format!("state the unit that it has, such as `units: {{ {name}: {due} }}`"),
            )),
        };
    };
    if due == "-" && symbol == "1" {
        return Ok((1.0, 0.0));
    }
    match Unit::read_as(symbol, wanted.dimension) {
        Ok(unit) => Ok((unit.factor, unit.offset)),
        Err(wrong) => Err(fault(
            format!("column `{header}`: {}", wrong.message),
            match unit.study {
                Some(_) => format!("{}: state one of them under `units`", wrong.help),
                None => format!(
                    "{}; if `{symbol}` means one of them, state it under `units: {{ {name}: ... }}` with `units_override: true`",
                    wrong.help
                ),
            },
        )),
    }
}
