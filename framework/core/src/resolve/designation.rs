//! Suggestions for an unknown designation.

use super::bearing_series::basic_designation;
use super::catalogue::CatalogueRow;
use crate::document::{Diagnostic, did_you_mean, distance};

/// Number of suggested designations.
const SUGGESTED: usize = 5;

/// A length in a row. \[mm\]
fn length(row: &CatalogueRow, key: &str) -> Option<f64> {
    let (_, value) = row.values.iter().find(|(name, _)| name == key)?;
    value.as_str().and_then(|text| text.strip_suffix(" mm"))?.parse().ok()
}

/// A text of a row.
fn text<'a>(row: &'a CatalogueRow, key: &str) -> Option<&'a str> {
    row.values.iter().find(|(name, _)| name == key)?.1.as_str()
}

/// The known designation at the start of a longer one, with what is behind it.
fn start_and_rest<'w, 'k>(designation: &'w str, known: impl Iterator<Item = &'k str>) -> Option<(&'k str, &'w str)> {
    let starts = |start_of_known: &&str| {
        let start = designation.get(..start_of_known.len());
        // A digit behind it would make it another designation.
        let goes_on = |c: char| c.is_ascii_digit() && start_of_known.ends_with(|c: char| c.is_ascii_digit());
        start.is_some_and(|start| start.eq_ignore_ascii_case(start_of_known))
            && !designation[start_of_known.len()..].starts_with(goes_on)
    };
    let longest = known.filter(starts).max_by_key(|start| start.len())?;
    let rest = designation[longest.len()..].trim_matches(|c: char| c.is_whitespace() || c == '-' || c == '/');
    (!rest.is_empty()).then_some((longest, rest))
}

/// The known designation at the start of a longer one, as a sentence with what is behind it.
pub fn known_start<'a>(designation: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let (longest, rest) = start_and_rest(designation, known)?;
    Some(format!("`{longest}` is known, but not what `{rest}` behind it means"))
}

/// Adds suggestions for the designation to an error; `here` lists what can be stated instead.
///
/// Another part is not a misspelling: only rows of the same kind and bore are suggested, and as the correct spelling only a name with
/// the same numbers for what is no usual designation.
pub(super) fn suggest(error: Diagnostic, designation: &str, rows: &[(&str, &CatalogueRow)], here: &str) -> Diagnostic {
    if let Some((longest, rest)) = start_and_rest(designation, rows.iter().map(|(name, _)| *name)) {
        return error
            .note(format!("`{longest}` is known, but not what `{rest}` behind it means"))
            .help(format!(
                "write `{longest}` if `{rest}` changes neither dimensions nor ratings, or {here}"
            ));
    }
    let Some(basic) = basic_designation(designation).filter(|_| has_bores(rows)) else {
        let names = || rows.iter().map(|(name, _)| *name);
        let longer = longer(designation, names());
        return match did_you_mean(designation, names()) {
            Some(close) => error.help(format!("write `{close}`, or {here}")),
            None if !longer.is_empty() => error
                .note(format!("longer: {}", longer.join(", ")))
                .help(format!("write the whole designation, or {here}")),
            None => error.help(format!("{here}, or add a CSV file under `catalogues`")),
        };
    };
    let is_same = |(_, row): &&(&str, &CatalogueRow)| {
        let kind = text(row, "kind").is_none_or(|kind| kind == basic.kind);
        let other = length(row, "bore");
        kind && basic
            .bore
            .zip(other)
            .is_some_and(|(bore, other)| (bore - other).abs() < 0.5)
    };
    let mut same: Vec<(&str, &CatalogueRow)> = rows.iter().filter(is_same).copied().collect();
    // A bearing of the same series is nearer than one with a similar name.
    let is_of_series = |row: &CatalogueRow| text(row, "series") == basic.series.as_deref();
    same.sort_by_key(|(name, row)| (!is_of_series(row), distance(designation, name), *name));
    same.truncate(SUGGESTED);
    if same.is_empty() {
        return error.help(format!("{here}, or add a CSV file under `catalogues`"));
    }
    error
        .note(format!("of this kind and bore: {}", listed(&same)))
        .help(format!(
            "{here}, add a CSV file under `catalogues`, or write another designation if that is the bearing"
        ))
}

/// Designations that contain an incomplete one, whatever its case and spaces: `VG150` is part of `ISO VG 150 mineral`.
fn longer<'a>(designation: &str, names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let bare = |text: &str| -> String {
        let kept = text.chars().filter(|c| c.is_alphanumeric());
        kept.flat_map(char::to_lowercase).collect()
    };
    let part = bare(designation);
    let is_part = |name: &&str| part.len() > 2 && bare(name).contains(&part);
    names.filter(is_part).take(SUGGESTED).collect()
}

fn has_bores(rows: &[(&str, &CatalogueRow)]) -> bool {
    rows.iter().any(|(_, row)| length(row, "bore").is_some())
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::Value;

    use super::*;

    fn row(kind: &str, bore: &str) -> CatalogueRow {
        CatalogueRow {
            values: vec![
                ("kind".to_owned(), Value::from(kind)),
                ("bore".to_owned(), Value::from(bore)),
            ],
            estimated: Vec::new(),
            confidence: String::new(),
            basis: String::new(),
        }
    }

    fn of_series(series: &str, mut row: CatalogueRow) -> CatalogueRow {
        row.values.push(("series".to_owned(), Value::from(series)));
        row
    }

    fn suggested(designation: &str) -> (Vec<String>, String) {
        let ball = "deep_groove_ball";
        let rows = [
            ("16012", row(ball, "60 mm")),
            ("6013", row(ball, "65 mm")),
            ("6205", row(ball, "25 mm")),
            ("6208", row(ball, "40 mm")),
            ("6213", row(ball, "65 mm")),
            ("30210", row("tapered_roller", "50 mm")),
            ("NJ408", row("cylindrical_roller", "40 mm")),
            ("NU208EC", of_series("2", row("cylindrical_roller", "40 mm"))),
        ];
        let rows: Vec<(&str, &CatalogueRow)> = rows.iter().map(|(name, row)| (*name, row)).collect();
        let found = suggest(Diagnostic::error("", "unknown"), designation, &rows, "state it here");
        (found.notes, found.help.unwrap())
    }

    #[test]
    fn only_the_same_kind_and_bore_is_suggested() {
        let nothing = "state it here, or add a CSV file under `catalogues`";
        for other in ["32313", "6250", "22213"] {
            let (notes, help) = suggested(other);
            assert!(notes.is_empty() && help == nothing, "{other}: {notes:?} {help}");
        }
        let (notes, help) = suggested("16013");
        assert_eq!(notes, ["of this kind and bore: 6013 (65 mm), 6213 (65 mm)"]);
        assert!(help.starts_with("state it here"), "{help}");
        // Another series of the kind is a note, never the designation to write.
        let (notes, help) = suggested("32310");
        assert_eq!(notes, ["of this kind and bore: 30210 (50 mm)"]);
        assert!(help.starts_with("state it here"), "{help}");
        let (notes, help) = suggested("N208");
        assert_eq!(notes, ["of this kind and bore: NU208EC (40 mm), NJ408 (40 mm)"]);
        assert!(help.starts_with("state it here"), "{help}");
    }

    #[test]
    fn an_incomplete_designation_is_completed() {
        let names = ["ISO VG 15 mineral", "ISO VG 150 mineral", "ISO VG 150 PAO"];
        assert_eq!(longer("VG150", names.into_iter()), names[1..]);
        assert!(longer("15", names.into_iter()).is_empty());
    }

    #[test]
    fn a_letter_for_a_digit_is_a_spelling_mistake() {
        assert_eq!(suggested("62O5").1, "write `6205`, or state it here");
        assert!(!suggested("62O6").1.contains("write"));
    }

    #[test]
    fn an_unknown_suffix_is_named() {
        let (notes, help) = suggested("6208-XYZ");
        assert_eq!(notes, ["`6208` is known, but not what `XYZ` behind it means"]);
        assert_eq!(
            help,
            "write `6208` if `XYZ` changes neither dimensions nor ratings, or state it here"
        );
    }
}
