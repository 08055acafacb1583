//! Deviations as shares of measured losses.

use super::{Context, Stopped};
use crate::study::{Difference, Quantity};

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

/// Refuses a difference that a quantity does not have.
pub fn countable(cx: &Context<'_>, path: &str, quantity: Quantity, difference: Difference) -> Result<(), Stopped> {
    if (quantity, difference) == (Quantity::Temperature, Difference::Percent) {
        let message = "a temperature has no percentage";
        let help = "write `difference: points`, which counts kelvins";
        return Err(cx.wrong(&format!("{path}.difference"), message, help));
    }
    Ok(())
}
