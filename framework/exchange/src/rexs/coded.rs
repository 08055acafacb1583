//! Encoded arrays: numbers as Base64 of their bytes, lowest byte first.
//!
//! Source: file definition of REXS, `code` with int32, float32 and float64, from version 1.4 on. It does not state the order of the bytes;
//! that of the usual processors is assumed, and values that no gearbox has are refused where they are used.

use super::model::{LONGEST_LIST, Value};

/// The array of a code and a text; [`Value::Other`] if it has more than [`LONGEST_LIST`] values, or cannot be decoded.
pub fn array(code: &str, text: &str) -> Value {
    values(code, text, LONGEST_LIST)
}

/// The matrix of a code, a text and a number of columns; [`Value::Other`] if it has more than [`LONGEST_LIST`] rows or columns, or cannot be
/// decoded.
pub fn matrix(code: &str, text: &str, columns: usize) -> Value {
    if columns > LONGEST_LIST {
        return Value::Other;
    }
    values(code, text, LONGEST_LIST.saturating_mul(columns)).rows(columns)
}

/// At most this many values.
fn values(code: &str, text: &str, most: usize) -> Value {
    let width = match code {
        "int32" | "float32" => 4,
        "float64" => 8,
        _ => return Value::Other,
    };
    // A value takes four thirds of its bytes, besides line breaks; a longer text is not decoded.
    if text.len() > most.saturating_mul(2 * width) {
        return Value::Other;
    }
    let Some(bytes) = base64(text) else {
        return Value::Other;
    };
    if bytes.len() % width != 0 || bytes.len() / width > most {
        return Value::Other;
    }
    let number = |bytes: &[u8]| match (code, bytes) {
        ("int32", &[a, b, c, d]) => Some(i32::from_le_bytes([a, b, c, d]).to_string()),
        ("float32", &[a, b, c, d]) => finite(f64::from(f32::from_le_bytes([a, b, c, d]))),
        (_, &[a, b, c, d, e, f, g, h]) => finite(f64::from_le_bytes([a, b, c, d, e, f, g, h])),
        _ => None,
    };
    let cells: Option<Vec<String>> = bytes.chunks_exact(width).map(number).collect();
    cells.map_or(Value::Other, Value::List)
}

fn finite(number: f64) -> Option<String> {
    number.is_finite().then(|| number.to_string())
}

/// The bytes of a text in Base64 (RFC 4648), with or without padding and line breaks.
fn base64(text: &str) -> Option<Vec<u8>> {
    let written: Vec<u8> = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let end = written
        .iter()
        .rposition(|byte| *byte != b'=')
        .map_or(0, |last| last + 1);
    if written.len() - end > 2 {
        return None;
    }
    let mut bytes = Vec::with_capacity(end * 3 / 4);
    for four in written[..end].chunks(4) {
        let mut bits = 0_u32;
        for byte in four {
            let six = match byte {
                b'A'..=b'Z' => byte - b'A',
                b'a'..=b'z' => byte - b'a' + 26,
                b'0'..=b'9' => byte - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(six);
        }
        let [_, a, b, c] = (bits << (6 * (4 - four.len()))).to_be_bytes();
        match four.len() {
            4 => bytes.extend([a, b, c]),
            3 => bytes.extend([a, b]),
            2 => bytes.push(a),
            _ => return None,
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(cells: &[&str]) -> Value {
        Value::List(cells.iter().map(|cell| (*cell).to_owned()).collect())
    }

    #[test]
    fn numbers_are_decoded() {
        // Written by Python: base64.b64encode(struct.pack("<3d", 1.5, -2.0, 350.25)), and "<2i", "<2f".
        assert_eq!(
            array("float64", "AAAAAAAA+D8AAAAAAAAAwAAAAAAA5HVA"),
            list(&["1.5", "-2", "350.25"])
        );
        assert_eq!(array("int32", "AQAAAP7///8="), list(&["1", "-2"]));
        assert_eq!(array("float32", "AADAPwAA\nAMA"), list(&["1.5", "-2"]));
        assert_eq!(array("float64", ""), list(&[]));
    }

    /// Four letters are three bytes: 21,000 numbers are too many for an array, and 20,001 rows too many for a matrix.
    #[test]
    fn matrices_have_as_many_rows_as_arrays_have_values() {
        let zeros = |count: usize| "A".repeat(count * 4 * 4 / 3);
        assert_eq!(array("int32", &zeros(21_000)), Value::Other);
        let rows = vec![vec!["0".to_owned(); 3]; 7000];
        assert_eq!(matrix("int32", &zeros(21_000), 3), Value::Rows(rows));
        assert_eq!(matrix("int32", &zeros(20_001), 1), Value::Other);
        assert_eq!(matrix("int32", &zeros(21_000), 0), Value::Other);
        assert_eq!(matrix("int32", &zeros(21_000), usize::MAX), Value::Other);
    }

    #[test]
    fn other_texts_are_no_arrays() {
        for (code, text) in [
            ("float64", "AAAAAAAA+D8A"),
            ("float64", "!!!"),
            ("float64", "AAAAAAAA8H8="),
            ("float16", "AAAA"),
            ("int32", "A"),
            ("int32", "AA======"),
        ] {
            assert_eq!(array(code, text), Value::Other, "{code} {text}");
        }
    }
}
