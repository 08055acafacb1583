//! Evaluates the check values of registered models and ratings.

use std::path::Path;

use crate::document::Unit;
use crate::eval::{Evaluated, evaluate_check, rate_input};
use crate::language::Language;
use crate::loss::Step;
use crate::registry::{Check, Entry, RatedAlone, RatingPlugin};

/// Greatest tolerance of a check value; a wider one would accept a wrong law.
const WIDEST: f64 = 0.2;

/// A quantity of a check beside its expected value.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Expected value with unit, as registered.
    pub stated: &'static str,
    /// The number in it.
    pub expected: f64,
    /// The computed value in the same unit.
    pub computed: f64,
    /// Unit of both.
    pub unit: &'static str,
    tolerance: f64,
}

impl Compared {
    /// Deviation relative to the expected value; zero if both are zero.
    pub fn deviation(&self) -> f64 {
        let off = self.computed - self.expected;
        if off == 0.0 { 0.0 } else { off / self.expected }
    }

    /// Whether the deviation is within the tolerance; not if the computed value is not a number.
    pub fn agrees(&self) -> bool {
        self.deviation().abs() <= self.tolerance
    }
}

/// Evaluates a check of a model and compares all of its quantities.
///
/// # Errors
/// Findings of the input; a reason if a value or a unit cannot be read, or the model has no such quantity.
pub fn compare(language: &Language, entry: &Entry, check: &Check) -> Result<Vec<Compared>, String> {
    let evaluated = evaluate_check(language, entry, check.input).map_err(|found| found.to_string())?;
    let answer = language.registry().mechanism(entry.mechanism).map_or("", |m| m.answer);
    compare_all(check, |name| of_model(&evaluated, answer, name))
}

/// The same for a check of a rating.
///
/// # Errors
/// As [`compare`].
pub fn compare_rating(language: &Language, rating: &RatingPlugin, check: &Check) -> Result<Vec<Compared>, String> {
    let rated = rate_input(language, rating, "check", check.input, Path::new("")).map_err(|found| found.to_string())?;
    compare_all(check, |name| of_rating(&rated, name))
}

fn compare_all<'a>(check: &Check, find: impl Fn(&str) -> Option<(f64, &'a str)>) -> Result<Vec<Compared>, String> {
    let compared = check.values.iter().map(|&(quantity, stated)| {
        let (number, unit) = stated.split_once(' ').unwrap_or((stated, "-"));
        let number = number.parse().ok().filter(|number: &f64| number.is_finite());
        let expected = number.ok_or_else(|| format!("{quantity}: `{stated}` does not begin with a number"))?;
        let (value, known_unit) =
            find(quantity).ok_or_else(|| format!("`{quantity}` is no result, term, step or observed quantity"))?;
        let computed = convert(value, known_unit, unit)
            .ok_or_else(|| format!("{quantity} is in [{known_unit}], not in [{unit}]"))?;
        Ok(Compared {
            quantity,
            stated,
            expected,
            computed,
            unit,
            tolerance: check.tolerance,
        })
    });
    compared.collect()
}

/// A quantity of an evaluated model and its unit.
fn of_model<'a>(evaluated: &'a Evaluated, answer: &'a str, name: &str) -> Option<(f64, &'a str)> {
    let term = evaluated.values.iter().find(|(term_name, _)| *term_name == name);
    match (name, evaluated.moment, term) {
        ("total", Some(_), _) => Some((evaluated.total, "W")),
        ("total", None, _) => Some((evaluated.total, Unit::of_doc(answer)?.symbol)),
        ("moment", Some(moment), _) => Some((moment, "Nm")),
        (_, Some(_), Some((_, watts))) => Some((*watts, "W")),
        _ => step(&evaluated.steps, name),
    }
}

/// A quantity of an evaluated rating and its unit.
fn of_rating<'a>(rated: &'a RatedAlone, name: &str) -> Option<(f64, &'a str)> {
    let found = rated.rated.figures().iter().find(|figure| figure.figure.symbol == name);
    match found {
        Some(figure) => Some((figure.value, figure.figure.unit)),
        None => step(&rated.steps, name),
    }
}

/// The last step of a formula with a symbol.
fn step<'a>(steps: &'a [(String, Step)], name: &str) -> Option<(f64, &'a str)> {
    steps.iter().rev().find_map(|(_, step)| match step {
        Step::Value {
            symbol, unit, value, ..
        } if *symbol == name => Some((*value, *unit)),
        _ => None,
    })
}

/// A value in another unit of its dimension.
fn convert(value: f64, from: &str, to: &str) -> Option<f64> {
    if Unit::is_same(from, to) {
        return Some(value);
    }
    let (from, to) = (Unit::read(from)?, Unit::read(to)?);
    (from.dimension == to.dimension).then(|| (from.to_si(value) - to.offset) / to.factor)
}

/// Faults of the checks of a model: values that differ, and checks that could not fail or do not state their origin.
pub fn faults(language: &Language, entry: &Entry) -> Vec<String> {
    let faults = entry
        .checks
        .iter()
        .map(|check| faults_of(check, compare(language, entry, check)));
    faults.flatten().collect()
}

/// The same for a rating.
pub fn faults_of_rating(language: &Language, rating: &RatingPlugin) -> Vec<String> {
    let checks = rating.entry.checks.iter();
    let faults = checks.map(|check| faults_of(check, compare_rating(language, rating, check)));
    faults.flatten().collect()
}

fn faults_of(check: &Check, compared: Result<Vec<Compared>, String>) -> Vec<String> {
    let mut faults = Vec::new();
    if check.values.is_empty() {
        faults.push("has no value, so that it cannot fail".to_owned());
    }
    if !(0.0..=WIDEST).contains(&check.tolerance) {
        faults.push(format!("its tolerance {} is not from 0 to {WIDEST}", check.tolerance));
    }
    if check.source.trim().is_empty() {
        faults.push("has no source".to_owned());
    }
    if check.because.trim().is_empty() {
        faults.push("states no reason for its tolerance".to_owned());
    }
    match compared {
        Ok(all) => faults.extend(all.iter().filter(|compared| !compared.agrees()).map(|compared| {
            format!(
                "{} is {} {}, not {} within {:e} of it: off by {:.2e}",
                compared.quantity,
                compared.computed,
                compared.unit,
                compared.stated,
                check.tolerance,
                compared.deviation()
            )
        })),
        Err(fault) => faults.push(fault),
    }
    let named = faults
        .into_iter()
        .map(|fault| format!("check `{}`: {fault}", check.input));
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(expected: f64, computed: f64) -> Compared {
        Compared {
            quantity: "moment",
            stated: "",
            expected,
            computed,
            unit: "Nm",
            tolerance: 1e-3,
        }
    }

    #[test]
    fn a_value_agrees_within_its_tolerance_only() {
        for (expected, computed) in [(2.0, 2.001), (-2.0, -2.001), (0.0, 0.0)] {
            assert!(compared(expected, computed).agrees(), "{expected} {computed}");
        }
        for (expected, computed) in [
            (2.0, 2.003),
            (2.0, -2.0),
            (2.0, f64::NAN),
            (0.0, 1e-12),
            (2.0, f64::INFINITY),
        ] {
            assert!(!compared(expected, computed).agrees(), "{expected} {computed}");
        }
    }

    #[test]
    fn values_are_compared_in_the_unit_of_the_check() {
        assert_eq!(convert(1.5, "N mm", "Nmm"), Some(1.5));
        assert!((convert(0.075, "Nm", "N mm").unwrap_or_default() - 75.0).abs() < 1e-12);
        assert_eq!(convert(1.5, "N mm", "W"), None);
        assert_eq!(convert(1.5, "-", "bananas"), None);
    }
}
