//! Suggestions for an unknown designation.

use super::catalogue::CatalogueRow;
use crate::document::{Diagnostic, did_you_mean, distance};

/// Number of suggested designations.
const SUGGESTED: usize = 5;

/// Bore encoded in the designation of a rolling bearing. \[mm\]
///
/// Source: DIN 623-1. The last two of four or five digits are a fifth of the bore, from 04 on; 00 to 03 are 10, 12, 15 and 17 mm.
fn stated_bore(designation: &str) -> Option<f64> {
    let start = designation.find(|c: char| c.is_ascii_digit())?;
    let digits = designation[start..].split(|c: char| !c.is_ascii_digit()).next()?;
    if !(4..=5).contains(&digits.len()) {
        return None;
    }
    match digits[digits.len() - 2..].parse::<u32>().ok()? {
        0 => Some(10.0),
        1 => Some(12.0),
        2 => Some(15.0),
        3 => Some(17.0),
        code if code <= 96 => Some(5.0 * f64::from(code)),
        _ => None,
    }
}

/// A length in a row. \[mm\]
fn length(row: &CatalogueRow, key: &str) -> Option<f64> {
    let (_, value) = row.values.iter().find(|(own, _)| own == key)?;
    value.as_str().and_then(|text| text.strip_suffix(" mm"))?.parse().ok()
}

/// The known designation at the start of a longer one, as a sentence with what is behind it.
pub fn known_start<'a>(designation: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let starts = |own: &&str| {
        let start = designation.get(..own.len());
        // A digit behind it would make it another designation.
        let goes_on = |c: char| c.is_ascii_digit() && own.ends_with(|c: char| c.is_ascii_digit());
        start.is_some_and(|start| start.eq_ignore_ascii_case(own)) && !designation[own.len()..].starts_with(goes_on)
    };
    let own = known.filter(starts).max_by_key(|own| own.len())?;
    let rest = designation[own.len()..].trim();
    (!rest.is_empty()).then(|| format!("`{own}` is known, but not what `{rest}` behind it means"))
}

/// Adds suggestions for the designation to an error; `here` lists what can be stated instead.
///
/// Another size is not a misspelling: if other rows have the encoded bore, they are suggested in addition to those with the most
/// similar names.
pub(super) fn suggest(error: Diagnostic, designation: &str, rows: &[(&str, &CatalogueRow)], here: &str) -> Diagnostic {
    let error = match known_start(designation, rows.iter().map(|(name, _)| *name)) {
        Some(known) => error.note(known),
        None => error,
    };
    let close = nearest(designation, rows);
    let has_bores = rows.iter().any(|(_, row)| length(row, "bore").is_some());
    let Some(bore) = stated_bore(designation).filter(|_| has_bores) else {
        return spelling(error, close.first().map(|(name, _)| *name), here);
    };
    let has_bore =
        |(_, row): &&(&str, &CatalogueRow)| length(row, "bore").is_some_and(|other| (other - bore).abs() < 0.5);
    let mut same: Vec<(&str, &CatalogueRow)> = rows.iter().filter(has_bore).copied().collect();
    same.sort_by_key(|(name, _)| (distance(designation, name), *name));
    same.truncate(SUGGESTED);
    let first = close.first();
    if same.is_empty() || first.is_some_and(|row| has_bore(&row)) {
        let error = match close.len() {
            0 | 1 => error,
            _ => error.note(format!("similar names: {}", listed(&close))),
        };
        return spelling(error, first.map(|(name, _)| *name), here);
    }
    let error = error.note(format!("with the encoded bore of {bore} mm: {}", listed(&same)));
    let error = if close.is_empty() {
        error
    } else {
        error.note(format!("similar names: {}", listed(&close)))
    };
    error.help(format!(
        "{here}, add a CSV file under `catalogues`, or write another designation if that is the bearing"
    ))
}

/// Rows with the fewest edits from a designation, if these are few; swapped digits first.
fn nearest<'a>(designation: &str, rows: &[(&'a str, &'a CatalogueRow)]) -> Vec<(&'a str, &'a CatalogueRow)> {
    let Some(closest) = did_you_mean(designation, rows.iter().map(|(name, _)| *name)) else {
        return Vec::new();
    };
    let fewest = distance(designation, closest);
    let mut near: Vec<_> = rows
        .iter()
        .filter(|(name, _)| distance(designation, name) == fewest)
        .copied()
        .collect();
    let sorted = |name: &str| {
        let mut letters: Vec<char> = name.chars().collect();
        letters.sort_unstable();
        letters
    };
    let own = sorted(designation);
    near.sort_by_key(|(name, _)| (sorted(name) != own, name.len().abs_diff(designation.len()), *name));
    near.truncate(SUGGESTED);
    near
}

/// Designations with their dimensions.
fn listed(rows: &[(&str, &CatalogueRow)]) -> String {
    let with_sizes = |(name, row): &(&str, &CatalogueRow)| {
        let sizes = ["bore", "outside", "width"].map(|key| length(row, key));
        let sizes: Vec<String> = sizes.iter().flatten().map(f64::to_string).collect();
        format!("{name} ({} mm)", sizes.join(" x "))
    };
    rows.iter().map(with_sizes).collect::<Vec<_>>().join(", ")
}

fn spelling(error: Diagnostic, close: Option<&str>, here: &str) -> Diagnostic {
    match close {
        Some(close) => error.help(format!("write `{close}`, or {here}")),
        None => error.help(format!("{here}, or add a CSV file under `catalogues`")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::Value;

    use super::*;

    #[test]
    fn the_last_two_digits_state_the_bore() {
        for (designation, bore) in [
            ("6205", Some(25.0)),
            ("6200-2RS", Some(10.0)),
            ("16013", Some(65.0)),
            ("NU 1003", Some(17.0)),
            ("30206 A", Some(30.0)),
            ("608", None),
            ("HK", None),
            ("6299", None),
        ] {
            assert_eq!(stated_bore(designation), bore, "{designation}");
        }
    }

    #[test]
    fn another_size_is_no_spelling_mistake() {
        let row = |bore: &str| CatalogueRow {
            values: vec![("bore".to_owned(), Value::from(bore))],
            confidence: String::new(),
            basis: String::new(),
        };
        let rows = [("16012", row("60 mm")), ("6013", row("65 mm")), ("6205", row("25 mm"))];
        let rows: Vec<(&str, &CatalogueRow)> = rows.iter().map(|(name, row)| (*name, row)).collect();
        let found = suggest(Diagnostic::error("", "unknown"), "16013", &rows, "state it here");
        assert_eq!(
            found.notes,
            [
                "with the encoded bore of 65 mm: 6013 (65 mm)",
                "similar names: 16012 (60 mm), 6013 (65 mm)"
            ]
        );
        assert!(found.help.unwrap().starts_with("state it here"));
        // No row has a bore of 250 mm, and two digits are swapped.
        let found = suggest(Diagnostic::error("", "unknown"), "6250", &rows, "state it here");
        assert!(found.help.unwrap().starts_with("write `6205`"));
        let found = suggest(Diagnostic::error("", "unknown"), "62O5", &rows, "state it here");
        assert!(found.help.unwrap().starts_with("write `6205`"));
    }
}
