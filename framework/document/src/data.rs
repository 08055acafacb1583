//! Files of data: from bytes to cells, and the columns that hold quantities.

pub mod cells;
pub mod sheet;

use crate::{Unit, did_you_mean};

pub use cells::{Decimal, Encoding, Separator};

/// What a fault belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FaultPlace {
    /// The key of the measurement at this path inside its entry.
    Entry(String),
    /// A bound column: a key of `bind` of the analysis.
    Bind(String),
}

/// What is wrong with a file, and how to fix it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredFault {
    /// What it belongs to.
    pub place: FaultPlace,
    /// What is wrong, with line and column.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

impl MeasuredFault {
    /// A fault at a key of the measurement.
    pub fn new(key: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            place: FaultPlace::Entry(key.into()),
            message: message.into(),
            help: help.into(),
        }
    }
}

/// A fault that belongs to no key of its own.
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
                format!("column `{header}`: `{other}` is no unit of {name}"),
                help("\"%\""),
            ),
            None => fault(
                format!("column `{header}`: no unit says whether it is in percent"),
                help("\"%\""),
            ),
        };
    }
    let Some(symbol) = unit else {
        return fault(format!("column `{header}` has no unit"), help(due));
    };
    // A temperature in kelvins; elsewhere K is a difference of temperatures.
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
                    "column `{header}`: `{symbol}` is no unit of {}",
                    wanted.dimension.name()
                ),
                help(close.unwrap_or(due)),
            )
        }
    }
}
