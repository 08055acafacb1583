//! Numbers and values in results.

use serde_json::Value;

use crate::study::joined;

/// Factor from rad/s to 1/min.
pub const RPM: f64 = 30.0 / std::f64::consts::PI;

/// A number in 1/min without rounding errors of its conversion: thirteen significant digits. Below 1e-9 it is the rounding error of a
/// difference and becomes zero.
pub fn tidy(x: f64) -> f64 {
    let size = x.abs();
    if size < 1e-9 {
        return 0.0;
    }
    // Numbers above this have no digits to round.
    if size >= 1e13 || size.is_nan() {
        return x;
    }
    // Powers of ten up to 1e22 are exact, so that one division gives the number nearest to the decimal.
    let digits = 10_f64.powi(12 - size.log10().floor() as i32);
    (x * digits).round() / digits
}

/// A bound value as written; values that belong together as `24/83`.
pub fn word(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(row) if row.iter().all(|value| value.is_number() || value.is_string()) => {
            joined(row.iter().map(word))
        }
        _ => value.to_string(),
    }
}

/// At most `shown` of `count` indices, evenly spread, with both ends.
pub fn spread_over(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|i| i * (count - 1) / (most - 1)).collect()
}

/// A number with the given decimals; in engineering notation from 1e9; a dash if it is not finite.
pub fn fixed(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return "-".to_owned();
    }
    if x.abs() < 1e9 {
        return format!("{x:.digits$}");
    }
    // Six significant digits with an exponent that is a multiple of three.
    let text = format!("{x:.5e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (mantissa, exponent): (f64, i32) = (mantissa.parse().unwrap_or(x), exponent.parse().unwrap_or(0));
    let shift = exponent.rem_euclid(3);
    format!(
        "{:.*}e{}",
        5 - shift as usize,
        mantissa * 10_f64.powi(shift),
        exponent - shift
    )
}

/// A number with six significant digits.
pub fn significant(x: f64) -> String {
    figures(x, 6)
}

/// A number with the given significant digits.
pub fn figures(x: f64, count: u32) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let magnitude = x.abs().log10().floor();
    if (-4.0..6.0).contains(&magnitude) {
        let digits = (f64::from(count) - 1.0 - magnitude).clamp(0.0, 9.0) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{x:.*e}", count.saturating_sub(1) as usize)
    }
}

/// Position of a value outside a range; one end of the range may be open.
pub fn beyond(least: f64, greatest: f64) -> String {
    match (least.is_finite(), greatest.is_finite()) {
        (true, false) => format!("below {}", significant(least)),
        (false, true) => format!("above {}", significant(greatest)),
        _ => format!("outside {} to {}", significant(least), significant(greatest)),
    }
}
