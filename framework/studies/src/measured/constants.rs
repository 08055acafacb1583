//! Quantities that a file does not have because they are the same in every row.

use gearloss_framework::document::{Unit, parse_quantity};
use serde_json::Value;

use super::columns::KNOWN;
use super::{Measured, MeasuredEntry, MeasuredFault};

impl MeasuredEntry {
    /// The constants in SI, with their names; wrong ones are added to the faults.
    pub(super) fn constants_in_si(&self, faults: &mut Vec<MeasuredFault>) -> Vec<(&'static str, f64)> {
        let mut found = Vec::new();
        for (name, written) in self.constants.iter() {
            match constant(name, written) {
                Ok(constant) => found.push(constant),
                Err((message, help)) => faults.push(MeasuredFault::new(format!("constants.{name}"), message, help)),
            }
        }
        found
    }
}

/// A constant in SI, or what is wrong with it and how to correct it.
fn constant(name: &str, written: &Value) -> Result<(&'static str, f64), (String, String)> {
    let numbers = || KNOWN.iter().filter(|known| !known.unit.is_empty());
    let Some(known) = numbers().find(|known| known.name == name) else {
        let names: Vec<&str> = numbers().map(|known| known.name).collect();
        let message = format!("`{name}` is not a measured quantity");
        return Err((message, format!("the quantities are {}", names.join(", "))));
    };
    let unit = Unit::of_symbol(known.unit).unwrap_or(Unit::ONE);
    let value = match written {
        Value::Number(number) => number.as_f64().map(|number| unit.to_si(number)),
        Value::String(text) => {
            let read = parse_quantity(text, unit);
            Some(read.map_err(|fault| {
                (
                    fault.message,
                    fault
                        .help
                        .unwrap_or_else(|| format!("write a number in {}", known.unit)),
                )
            })?)
        }
        _ => None,
    };
    let wrong = || {
        (
            format!("{written} is not a quantity"),
            format!("write a number in {}", known.unit),
        )
    };
    Ok((known.name, value.filter(|value| value.is_finite()).ok_or_else(wrong)?))
}

impl Measured {
    /// Adds quantities that are the same in every row.
    ///
    /// # Errors
    /// Quantities that the file has as a column.
    pub(super) fn add_constants(&mut self, constants: &[(&'static str, f64)]) -> Result<(), Vec<MeasuredFault>> {
        let twice = constants.iter().filter(|(name, _)| self.holds(name));
        let twice: Vec<MeasuredFault> = twice
            .map(|(name, _)| {
                let message = format!("the file has a column for `{name}`, so it is not a constant");
                MeasuredFault::new(format!("constants.{name}"), message, "delete one of the two")
            })
            .collect();
        if !twice.is_empty() {
            return Err(twice);
        }
        for (name, value) in constants {
            self.quantities.push(name);
            for row in &mut self.rows {
                row.values.push(Some(*value));
                if let Some(stretch) = &mut row.stretch {
                    stretch.standard_errors.push(None);
                }
            }
        }
        Ok(())
    }
}
