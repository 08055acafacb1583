//! Laws between the quantities of a context.

use crate::document::Diagnostic;
use crate::mechanism::{Mechanism, Quantity};

/// A law between quantities of a context. In a gearbox the framework fills in all of them consistently. If a user states some of
/// them, as for `eval`, [`settle`] computes the others and rejects contradictions.
pub struct Law<M: Mechanism> {
    /// The law in its written form.
    pub text: &'static str,
    /// Its quantities by name, the least often stated first, and the value of each from the others.
    pub quantities: &'static [(&'static str, Follows<M>)],
    /// False if the law usually holds, but need not: a stated value may differ from it.
    pub always: bool,
}

/// The value of one quantity from the others, SI; not finite if it is not determined.
pub type Follows<M> = for<'a, 'b> fn(&'b <M as Mechanism>::At<'a, f64>) -> f64;

/// Tolerance of a stated value to the value computed from others, relative to the larger of both: written values are rounded, data
/// sheet values to three digits, products of two of them to fewer.
pub const ROUNDED: f64 = 0.01;

/// Computes the quantities that are not stated from the stated ones, by the laws of the mechanism, and returns them with their
/// laws. If more than one quantity of a law is not stated, all but the first keep their usual values.
///
/// # Errors
/// If stated quantities contradict each other by more than rounding; the error names them.
pub fn settle<M: Mechanism>(
    at: &mut M::At<'_, f64>,
    stated: &[&'static str],
) -> Result<Vec<(&'static str, &'static str)>, Diagnostic> {
    let mut known = stated.to_vec();
    // Stated quantities, and those computed from them rather than from usual values only.
    let mut bound = stated.to_vec();
    let mut followed = Vec::new();
    let mut open: Vec<&Law<M>> = M::LAWS.iter().collect();
    while !open.is_empty() {
        let unknown = |law: &Law<M>| law.quantities.iter().filter(|(name, _)| !known.contains(name)).count();
        // Settled quantities first, then results of a single law, then those based on usual values.
        let ready = |law: &&Law<M>| law.always && unknown(law) <= 1;
        let touched = |law: &&Law<M>| unknown(law) < law.quantities.len();
        let next = open
            .iter()
            .position(ready)
            .or_else(|| open.iter().position(|law| unknown(law) <= 1))
            .or_else(|| open.iter().position(touched))
            .unwrap_or(0);
        let law = open.remove(next);
        let Some((name, follows)) = law.quantities.iter().find(|(name, _)| !known.contains(name)) else {
            if law.always {
                agree::<M>(law, at, stated)?;
            }
            continue;
        };
        let value = follows(at);
        if let Some(quantity) = named::<M>(name).filter(|_| value.is_finite()) {
            if law.always
                && law
                    .quantities
                    .iter()
                    .all(|(other, _)| other == name || bound.contains(other))
            {
                within(law, quantity, value)?;
            }
            (quantity.set)(at, value);
            if law.quantities.iter().any(|(name, _)| bound.contains(name)) {
                bound.push(name);
                followed.push((*name, law.text));
            }
        }
        known.extend(law.quantities.iter().map(|(name, _)| *name));
    }
    Ok(followed)
}

fn named<M: Mechanism>(name: &str) -> Option<&'static Quantity<M>> {
    M::QUANTITIES.iter().find(|q| q.name == name)
}

/// Rejects a value, computed only from stated values, that the quantity cannot have.
fn within<M: Mechanism>(law: &Law<M>, quantity: &Quantity<M>, value: f64) -> Result<(), Diagnostic> {
    let unit = quantity.unit;
    let shown = unit.from_si(value);
    let rounding = ROUNDED * shown.abs();
    if shown >= quantity.least - rounding && shown <= quantity.greatest + rounding {
        return Ok(());
    }
    let from: Vec<String> = law
        .quantities
        .iter()
        .filter(|(other, _)| *other != quantity.name)
        .map(|(other, _)| format!("`{other}`"))
        .collect();
    Err(Diagnostic::error(
        format!(
            "at.{}",
            law.quantities
                .iter()
                .map(|(other, _)| *other)
                .find(|other| *other != quantity.name)
                .unwrap_or(quantity.name)
        ),
        format!(
            "from {} follows `{}` of {} {} ({}), which is outside {} to {}",
            from.join(" and "),
            quantity.name,
            significant(shown),
            unit.symbol,
            law.text,
            quantity.least,
            quantity.greatest
        ),
    )
    .help(format!("change {}", from.join(" or "))))
}

/// Rejects a law whose quantities contradict each other.
fn agree<M: Mechanism>(law: &Law<M>, at: &M::At<'_, f64>, stated: &[&'static str]) -> Result<(), Diagnostic> {
    // Of two contradicting quantities, the stated one is named.
    let named_law = law
        .quantities
        .iter()
        .find(|(name, _)| stated.contains(name))
        .unwrap_or(&law.quantities[0]);
    let (name, follows) = named_law;
    let Some(quantity) = named::<M>(name) else {
        return Ok(());
    };
    let (is, follows) = ((quantity.get)(at), follows(at));
    if !follows.is_finite() || (is - follows).abs() <= ROUNDED * is.abs().max(follows.abs()) {
        return Ok(());
    }
    let written = |quantity: &Quantity<M>, si: f64| {
        let unit = quantity.unit;
        format!("{} {}", significant(unit.from_si(si)), unit.symbol)
    };
    let others: Vec<String> = law
        .quantities
        .iter()
        .filter(|(other, _)| other != name)
        .filter_map(|(other, _)| named::<M>(other))
        .map(|other| format!("`{}` of {}", other.name, written(other, (other.get)(at))))
        .collect();
    Err(Diagnostic::error(
        format!("at.{name}"),
        format!(
            "{} contradicts {}, which gives {}, more than 1 % different",
            written(quantity, is),
            others.join(" and "),
            written(quantity, follows)
        ),
    )
    .help(format!(
        "omit one of them, so that it is computed from the others: {}",
        law.text
    )))
}

/// Six significant digits.
fn significant(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    format!("{rounded}")
}
