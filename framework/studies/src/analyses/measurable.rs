//! Deviations as shares of measured losses.

/// Whether a deviation can be stated as a share of a measured loss: no instrument sees a millionth of the loss that is computed,
/// and a share of nothing is no number.
pub fn is_measurable(seen: f64, loss: f64) -> bool {
    seen != 0.0 && seen.abs() >= 1e-6 * loss.abs()
}

/// What is printed where some points are omitted.
pub fn note(omitted: usize, what: &str) -> String {
    format!(
        "note: {omitted} points are omitted from {what} in %: their measured loss is below a millionth of the computed one"
    )
}
