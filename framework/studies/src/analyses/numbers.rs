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

/// At most some of as many, spread evenly, both ends among them.
pub fn spread_over(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|i| i * (count - 1) / (most - 1)).collect()
}
