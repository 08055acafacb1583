//! Numbers and values as results have them.

use serde_json::Value;

/// rad/s in 1/min.
pub const RPM: f64 = 30.0 / std::f64::consts::PI;

/// A number of 1/min without the noise of its conversion: thirteen significant digits, at most 5e-13 of it away. Below 1e-9, a
/// turn in two thousand years, what is left is the noise of a difference, and zero.
pub fn tidy(x: f64) -> f64 {
    let size = x.abs();
    if size < 1e-9 {
        return 0.0;
    }
    // From here on numbers have no digits to round.
    if size >= 1e13 || size.is_nan() {
        return x;
    }
    // Powers of ten up to 1e22 are exact, so that one division gives the number nearest to the decimal.
    let digits = 10_f64.powi(12 - size.log10().floor() as i32);
    (x * digits).round() / digits
}

/// A bound value as it was written.
pub fn word(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A number with some digits behind the point; in engineering notation from a thousand million on, where all its digits would say
/// nothing, and a dash where it is none.
pub fn fixed(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return "-".to_owned();
    }
    if x.abs() < 1e9 {
        return format!("{x:.digits$}");
    }
    // Six significant digits, the exponent a multiple of three.
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

/// A number in six significant digits.
pub fn significant(x: f64) -> String {
    figures(x, 6)
}

/// A number in some significant digits.
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
