//! Quantities written as text: a plain decimal number and a unit.

use super::unit::{Dimension, Unit, UnitFault};

/// An error in a quantity.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct QuantityFault {
    /// Message.
    pub message: String,
    /// How to fix it.
    pub help: Option<String>,
}

impl QuantityFault {
    fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: Some(help.into()),
        }
    }
}

/// Length of the plain decimal number at the start of a text; zero if there is none. Parser, pattern and formula share this grammar.
pub fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let start = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(start);
    let mut end = whole;
    if bytes.get(whole) == Some(&b'.') {
        let fraction = digits(whole + 1);
        if whole == start && fraction == whole + 1 {
            return 0;
        }
        end = fraction;
    } else if whole == start {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(sign);
        if exponent > sign {
            end = exponent;
        }
    }
    end
}

/// The SI value of a quantity written as text, for a key with the given documented unit.
///
/// # Errors
/// If the text has a decimal comma, no unit, an unknown unit or a wrong dimension, or if the value is not finite.
pub fn parse_quantity(text: &str, unit: &'static Unit) -> Result<f64, QuantityFault> {
    let number = number_length(text);
    if number == 0 {
        return Err(QuantityFault::new(
            format!("`{text}` is not a quantity"),
            format!("write {} such as {}", unit.dimension.with_article(), example(unit)),
        ));
    }
    let (digits, rest) = text.split_at(number);
    if let Some(behind) = rest.strip_prefix(',') {
        let point = text.replacen(',', ".", 1);
        // Three digits may also be thousands.
        let thousands = behind.bytes().take_while(u8::is_ascii_digit).count() == 3;
        return Err(QuantityFault::new(
            if thousands {
                "a comma in a number"
            } else {
                "a decimal comma"
            },
            if thousands {
                format!("write `{}` or `{point}`", text.replacen(',', "", 1))
            } else {
                format!("write `{point}`")
            },
        ));
    }
    let value: f64 = digits.parse().unwrap_or(f64::NAN);
    let symbol = rest.strip_prefix(' ').unwrap_or(rest);
    if symbol.is_empty() {
        return Err(if unit.dimension == Dimension::None {
            QuantityFault::new("a number written as text", format!("write {digits} without quotes"))
        } else {
            QuantityFault::new(
                "a number written as text",
                format!(
                    "write {digits} without quotes if it is in {}, or add its unit",
                    unit.symbol
                ),
            )
        });
    }
    if symbol.trim() != symbol {
        return Err(QuantityFault::new(
            format!("spaces in `{text}`"),
            format!("write `{digits} {}`", symbol.trim()),
        ));
    }
    let written = Unit::read_as(symbol, unit.dimension)
        .ok()
        // A dash is the unit of plain numbers in tables only; behind a number it may be a sign.
        .filter(|_| symbol != Unit::ONE.symbol);
    let Some(written) = written else {
        let fault = UnitFault::new(symbol, unit.dimension);
        return Err(QuantityFault::new(fault.message, fault.help));
    };
    let si = if unit.dimension == Dimension::None {
        // Correctly rounded: 95.5 % is 0.955 to the bit.
        value / (1.0 / written.factor)
    } else {
        written.to_si(value)
    };
    if si.is_finite() {
        Ok(si)
    } else {
        Err(QuantityFault {
            message: format!("`{text}` is too large"),
            help: None,
        })
    }
}

fn example(unit: &Unit) -> String {
    if unit.dimension == Dimension::None {
        "`20`".to_owned()
    } else {
        format!("`20 {}`", unit.symbol)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn mm() -> &'static Unit {
        Unit::of_symbol("mm").unwrap()
    }

    #[test]
    fn spellings_of_one_length() {
        for text in ["30 mm", "30mm", "3 cm", "0.03 m", "3e-2 m", "+30.0 mm", "30000 µm"] {
            assert!((parse_quantity(text, mm()).unwrap() - 0.03).abs() < 1e-15, "{text}");
        }
    }

    #[test]
    fn each_fault_says_what_and_how_to_help() {
        let fault = |text: &str| parse_quantity(text, mm()).unwrap_err();
        assert!(fault("30 Nm").message.contains("torque, not a length"));
        assert_eq!(fault("1,25 mm").help.unwrap(), "write `1.25 mm`");
        assert!(fault("47").message.contains("number written as text"));
        let help = fault("47 mmm").help.unwrap();
        assert!(
            help.starts_with("a length is written in mm, um,") && !help.contains("47"),
            "{help}"
        );
        assert!(fault("1e999 mm").message.contains("too large"));
        for text in ["", "mm", " 5 mm", "5  mm", "0x10 mm", "5 mm ", "--5 mm", ".", "."] {
            assert!(parse_quantity(text, mm()).is_err(), "{text:?}");
        }
    }
}
