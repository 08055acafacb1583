//! The derivatives of a point as text.

use gearloss_studies::points::{Derivative, Derivatives};

use crate::text::{TextTable, significant};

/// A table of the derivatives over one variable, and how they were found.
pub fn derivatives_text(found: &Derivatives) -> String {
    let mut table = TextTable::new(&["derivative of", "unit", "value", "method", "error"]);
    for derivative in &found.derivatives {
        let (value, error) = match (derivative.value, derivative.kink) {
            (Some(value), _) => (scientific(value), derivative.error.map_or("-".to_owned(), scientific)),
            (None, Some([below, above])) => (
                format!(
                    "kink or jump: {} below, {} above",
                    significant(below),
                    significant(above)
                ),
                "-".to_owned(),
            ),
            (None, None) => ("-".to_owned(), "-".to_owned()),
        };
        table.row(vec![
            derivative.of.clone(),
            derivative.unit.clone(),
            value,
            method(found, derivative),
            error,
        ]);
    }
    let mut text = format!("\nover {}\n{}", found.variable, table.render());
    if !found.models.is_empty() {
        text.push_str(&format!("by differences of {}\n", found.models.join(", ")));
    }
    text
}

/// Digits that show the size of a derivative and its error.
fn scientific(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.6e}")
    }
}

fn method(found: &Derivatives, derivative: &Derivative) -> String {
    match derivative.value {
        Some(_) => found.method.name().to_owned(),
        None => "-".to_owned(),
    }
}
