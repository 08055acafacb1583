//! Values that follow others by a formula, such as the teeth of a gear whose sum with those of its mate is given.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{ValueSource, apply, lookup, matches, meets, paths};
use crate::document::Diagnostic;
use crate::formula::Formula;
use crate::language::Language;

/// Writes the values of formulas, one after the other: each may depend on those before it. `overridden` are the patterns of the overrides,
/// none of which may change a value that follows.
pub(super) fn follow<'f>(
    language: &Language,
    value: &mut Value,
    follows: impl Iterator<Item = &'f (String, String)>,
    overridden: &[&str],
    sources: &mut BTreeMap<String, ValueSource>,
    found: &mut Vec<Diagnostic>,
) {
    for (target, text) in follows {
        let hits = matches(value, target);
        if overridden
            .iter()
            .any(|pattern| hits.iter().any(|path| meets(pattern, path)))
        {
            let message = format!("`{target}` follows `{text}`, so it has no value of its own");
            let help = "change what it follows instead, or delete the formula";
            found.push(Diagnostic::error(target, message).help(help));
            continue;
        }
        match number(language, value, target, text) {
            Ok(number) => {
                let before = found.len();
                let written = (target.clone(), number.clone());
                apply(language, value, std::iter::once((0, &written)), sources, found);
                for fault in &mut found[before..] {
                    *fault = fault.clone().note(format!("it is {number} by the formula `{text}`"));
                }
            }
            Err(fault) => found.push(fault),
        }
    }
}

/// The value of a formula, a number in the unit of its target.
fn number(language: &Language, value: &Value, target: &str, text: &str) -> Result<Value, Diagnostic> {
    let wrong = |message: String| Diagnostic::error(target, message);
    let names = paths_in(text);
    let formula = Formula::compile(text, &names).map_err(|fault| {
        let error = wrong(format!("formula `{text}`: {fault}"));
        match fault.help {
            Some(help) => error.help(help),
            None => error.help("write for example `107 - gears.P1.z`: numbers, paths and their operations"),
        }
    })?;
    let numbers = names.iter().map(|path| {
        let written = lookup(value, path);
        if written.is_none() && !language.has_place(value, path) {
            let mut error = paths::no_match(value, path);
            error.message = format!("formula `{text}`: {}", error.message);
            target.clone_into(&mut error.path);
            return Err(error);
        }
        let si = written.and_then(Value::as_f64).ok_or_else(|| {
            wrong(format!("formula `{text}`: `{path}` is not a number, or has no value"))
                .help("state its value in the gearbox, or name another path")
        })?;
        Ok(language
            .number_at(value, path)
            .map_or(si, |(unit, ..)| unit.from_si(si)))
    });
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
    let number = formula.value(|input| numbers[input]).map_err(|_| {
        wrong(format!("formula `{text}`: the value is not a number")).help("correct the formula, or what it depends on")
    })?;
    // Numbers of teeth are whole.
    let is_whole = number.fract() == 0.0 && number.abs() < 1e15;
    Ok(if is_whole {
        Value::from(number as i64)
    } else {
        Value::from(number)
    })
}

/// The paths in a formula: names with dots.
fn paths_in(text: &str) -> Vec<&str> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let mut names: Vec<&str> = Vec::new();
    for word in text.split(|c| !is_name(c)) {
        if word.contains('.') && word.starts_with(|c: char| c.is_ascii_alphabetic()) && !names.contains(&word) {
            names.push(word);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_told_from_numbers_and_functions() {
        let text = "max(107.5 - gears.P2.z, 2e-3*gears.P2.z) + meshes.M1.normal_module/pi";
        assert_eq!(paths_in(text), ["gears.P2.z", "meshes.M1.normal_module"]);
    }
}
