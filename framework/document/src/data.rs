//! Data files: from bytes to cells, and the columns of quantities.

pub mod cells;
mod mdf;
pub mod sheet;
mod workbook;

use crate::{Unit, did_you_mean};

pub use cells::{Decimal, Encoding, Separator};

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

/// Factor and offset of a unit to SI.
pub fn scale((name, due): (&str, &str), unit: Option<&str>, header: &str) -> Result<(f64, f64), MeasuredFault> {
    let help = |example: &str| format!("state it: `units: {{ {name}: {example} }}`");
    let fault = |message: String, help: String| Err(MeasuredFault::new("", message, help));
    if due == "-" {
        return match unit {
            Some("%") => Ok((0.01, 0.0)),
            Some("-" | "1") => Ok((1.0, 0.0)),
            None if ["weight", "share"].contains(&name) => Ok((1.0, 0.0)),
            Some(other) => fault(
                format!("column `{header}`: `{other}` is not a unit of {name}"),
                help("\"%\""),
            ),
            None => fault(
                format!("column `{header}` has no unit: fraction or percent?"),
                help("\"%\""),
            ),
        };
    }
    let Some(symbol) = unit else {
        return fault(format!("column `{header}` has no unit"), help(due));
    };
    // A temperature in kelvins; elsewhere K is a temperature difference.
    if due == "degC" && symbol == "K" {
        return Ok((1.0, -273.15));
    }
    let wanted = Unit::of_symbol(due).unwrap_or(Unit::ONE);
    match Unit::of_symbol(symbol) {
        Some(unit) if unit.dimension == wanted.dimension => Ok((unit.factor, unit.offset)),
        _ => {
            let close = did_you_mean(symbol, Unit::symbols(wanted.dimension));
            fault(
                format!(
                    "column `{header}`: `{symbol}` is not a unit of {}",
                    wanted.dimension.name()
                ),
                help(close.unwrap_or(due)),
            )
        }
    }
}
