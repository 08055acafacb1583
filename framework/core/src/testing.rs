//! Test support for crates of models: check values, and the conformance suite over all linked models.
//!
//! ```no_run
//! use gearloss_framework::testing::{assert_close, eval};
//!
//! let loss = eval("bearing/constant", "{ model: { type: constant, value: 0.05 Nm }, at: { speed: 1000 rpm } }");
//! assert_close(loss.total, 5.236, 1e-4);
//! ```

use std::path::Path;
use std::sync::OnceLock;

use crate::conformance::check_all;
use crate::document::read_yaml;
use crate::eval::{Evaluated, evaluate_input, rate_input};
use crate::language::Language;
use crate::registry::RatedAlone;

/// The language of everything linked into this test, composed once.
///
/// # Panics
/// If the linked crates are inconsistent.
pub fn language() -> &'static Language {
    static LANGUAGE: OnceLock<Language> = OnceLock::new();
    LANGUAGE.get_or_init(|| match Language::linked() {
        Ok(language) => language,
        Err(found) => panic!("{found}"),
    })
}

/// Evaluates one model, `MECHANISM/MODEL`, at an input as for `gearloss eval --input`: `part`, `at` and `model` in YAML, each
/// optional. Files that a model names are relative to Cargo.toml of the crate under test.
///
/// # Panics
/// With the errors of the input, or with the reason why the model is undefined there.
#[track_caller]
pub fn eval(model: &str, input: &str) -> Evaluated {
    match evaluate_input(language(), model, "input", input, Path::new("")) {
        Ok(evaluated) => evaluated,
        Err(findings) => panic!("{model}: {findings}"),
    }
}

/// Evaluates one rating by its name at an input as for `gearloss eval --input`: `part`, `at` and `rating` in YAML, each optional.
///
/// # Panics
/// With the errors of the input, or with the reason why the rating is undefined there.
#[track_caller]
pub fn rate(rating: &str, input: &str) -> RatedAlone {
    let language = language();
    let rated = match language.registry().rating_named(rating) {
        Ok(plugin) => rate_input(language, plugin, "input", input, Path::new("")),
        Err(error) => Err(error.into()),
    };
    match rated {
        Ok(rated) => rated,
        Err(findings) => panic!("{rating}: {findings}"),
    }
}

/// A part of a mechanism from YAML, resolved: its quantities in SI, its defaults filled in.
///
/// # Panics
/// With the errors of the input.
#[track_caller]
pub fn part(mechanism: &str, yaml: &str) -> serde_json::Value {
    let read = read_yaml(0, &format!("part: {yaml}\n"));
    assert!(read.findings.is_empty(), "{:?}", read.findings);
    match language().walk_eval(mechanism, &read.node) {
        Ok(walked) if walked.findings.is_empty() => walked.value["part"].clone(),
        Ok(walked) => panic!("{yaml}: {:?}", walked.findings),
        Err(found) => panic!("{mechanism}: {found:?}"),
    }
}

/// Runs the conformance suite on every linked model and rating, and reads all rows of linked catalogues.
///
/// # Panics
/// With a line for each fault.
#[track_caller]
pub fn conformance() {
    let mut faults = check_all(language());
    faults.extend(language().faults_of_catalogues());
    assert!(faults.is_empty(), "{}", lines(&faults));
}

/// Compares a number with the expected one.
///
/// # Panics
/// If it differs by more than `relative` times the expected one.
#[track_caller]
pub fn assert_close(got: f64, expected: f64, relative: f64) {
    assert!(
        (got - expected).abs() <= relative * expected.abs(),
        "{got} is not {expected} within {relative:e} of it: off by {:.3e}",
        got / expected - 1.0
    );
}

fn lines<T: std::fmt::Display>(list: &[T]) -> String {
    list.iter()
        .fold(String::new(), |text, line| text + &format!("\n  {line}"))
}

#[cfg(test)]
mod tests {
    use super::assert_close;

    #[test]
    fn a_close_number_passes() {
        assert_close(1.0005, 1.0, 1e-3);
    }

    #[test]
    #[should_panic(expected = "2 is not 1 within 1e-3 of it")]
    fn another_does_not() {
        assert_close(2.0, 1.0, 1e-3);
    }
}
