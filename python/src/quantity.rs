//! Quantities with units.

use gearloss::document::{Unit, parse_quantity};
use gearloss::studies::numbers::tidy;
use pyo3::prelude::*;

use crate::errors::wrong;

/// The unit with a symbol that the package uses.
pub fn unit(symbol: &'static str) -> &'static Unit {
    Unit::of_symbol(symbol).unwrap_or(Unit::ONE)
}

/// A text with a number and a unit, such as `10 Nm`, as a number in a unit: `Nm`, `rpm` or `degC`. A bare number is in that unit.
#[pyfunction]
pub fn quantity(py: Python<'_>, name: &str, text: &str, symbol: &str) -> PyResult<f64> {
    let unit = Unit::of_symbol(symbol).unwrap_or(Unit::ONE);
    if let Ok(bare) = text.trim().parse::<f64>() {
        return Ok(bare);
    }
    parse_quantity(text.trim(), unit)
        // Without the rounding errors of the conversion.
        .map(|si| tidy(unit.from_si(si)))
        .map_err(|fault| {
            let help = fault.help.unwrap_or_else(|| format!("write for example `10 {symbol}`"));
            wrong(
                py,
                gearloss::document::codes::WRONG_UNIT,
                format!("{name} \"{text}\": {}", fault.message),
                &help,
            )
        })
}
