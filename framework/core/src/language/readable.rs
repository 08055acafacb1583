//! A resolved description written as a document again: every number has a unit from which the same bits are read.

use serde_json::{Map, Value};

use super::Language;
use crate::document::Unit;

impl Language {
    /// A resolved description in written form: quantities with their units instead of SI numbers. Read and resolved again, it is
    /// the same description to the bit. File names remain relative to the folder of the gearbox.
    pub fn readable(&self, resolved: &Value) -> Value {
        self.readable_at(resolved, "", resolved)
    }

    fn readable_at(&self, document: &Value, path: &str, value: &Value) -> Value {
        let below = |key: &str| {
            if path.is_empty() {
                key.to_owned()
            } else {
                format!("{path}.{key}")
            }
        };
        match value {
            Value::Object(map) => {
                // A key without a value is an omitted key.
                let written = map.iter().filter(|(_, value)| !value.is_null());
                let written = written.map(|(key, value)| (key.clone(), self.readable_at(document, &below(key), value)));
                Value::Object(written.collect::<Map<String, Value>>())
            }
            Value::Array(list) => {
                let items = list.iter().enumerate();
                Value::Array(
                    items
                        .map(|(i, item)| self.readable_at(document, &below(&i.to_string()), item))
                        .collect(),
                )
            }
            Value::Number(number) => match (number.as_f64(), self.number_at(document, path)) {
                (Some(si), Some((unit, ..))) => quantity(si, unit).unwrap_or_else(|| value.clone()),
                _ => value.clone(),
            },
            other => other.clone(),
        }
    }
}

/// A quantity in its documented unit if the same bits are read from it, else in SI; `None` for plain numbers.
fn quantity(si: f64, documented: &'static Unit) -> Option<Value> {
    if documented.symbol == Unit::ONE.symbol {
        return None;
    }
    let number = documented.from_si(si);
    let exact = |number: &f64| documented.to_si(*number).to_bits() == si.to_bits();
    let written = |number: f64, unit: &Unit| format!("{number} {}", unit.symbol);
    if let Some(tidy) = documented.conversion().written(si) {
        return Some(Value::from(written(tidy, documented)));
    }
    // A number with many digits in its documented unit may have few in SI.
    let in_unit = Some(number).filter(exact).map(|number| written(number, documented));
    let candidates = in_unit
        .into_iter()
        .chain(Unit::si(documented.dimension).map(|unit| written(si, unit)));
    candidates.min_by_key(String::len).map(Value::from)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::document::parse_quantity;

    #[test]
    fn quantities_are_read_with_the_same_bits() {
        for symbol in Unit::all_symbols() {
            let unit = Unit::of_symbol(symbol).unwrap();
            for number in [0.1, 20.0, 133.4, 1.0 / 3.0, 8.9e-7, -40.0, 0.0] {
                let si = unit.to_si(number);
                let Some(Value::String(text)) = quantity(si, unit) else {
                    assert_eq!(symbol, "-");
                    continue;
                };
                assert_eq!(parse_quantity(&text, unit).unwrap().to_bits(), si.to_bits(), "{text}");
            }
        }
        let mm = Unit::of_symbol("mm").unwrap();
        assert_eq!(quantity(133.4 * 1e-3, mm).unwrap(), "133.4 mm");
        assert_eq!(quantity(0.1334, mm).unwrap(), "0.1334 m");
    }
}
