//! Deviations relative to measured losses.

use crate::analyses::{Planner, Stopped};
use crate::study::{Difference, Quantity};

/// Whether a deviation relative to a measured loss is meaningful: the measured loss must not be zero or below a millionth of the computed
/// loss.
pub fn is_measurable(seen: f64, loss: f64) -> bool {
    seen != 0.0 && seen.abs() >= 1e-6 * loss.abs()
}

/// A note on omitted points.
pub fn note(omitted: usize, what: &str) -> String {
    format!(
        "note: {omitted} points are omitted from {what} in %: their measured loss is below a millionth of the computed one"
    )
}

/// Rejects a kind of difference that does not apply to a quantity.
pub fn countable(cx: &Planner<'_>, path: &str, quantity: Quantity, difference: Difference) -> Result<(), Stopped> {
    if (quantity, difference) == (Quantity::Temperature, Difference::Percent) {
        let message = "a temperature difference cannot be in percent";
        let help = "write `difference: points`, which is in kelvins";
        return Err(cx.wrong(&format!("{path}.difference"), message, help));
    }
    Ok(())
}

/// Rejects quantities of the drive unit where measured values or losses of components judge.
pub fn measured(cx: &Planner<'_>, path: &str, quantity: Quantity) -> Result<(), Stopped> {
    if !quantity.is_of_unit() {
        return Ok(());
    }
    let what = quantity.words(Difference::Points).0;
    let message = format!("the {what} has no measured values");
    let help = "use efficiency, loss, loss torque or temperature";
    Err(cx.wrong(&format!("{path}.quantity"), message, help))
}
