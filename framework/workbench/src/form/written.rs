//! A template with typed values.

use std::collections::BTreeMap;
use std::ops::Range;

use gearloss_editor::outline::{self, Content, Node};
use gearloss_framework::document::{Diagnostic, Unit, parse_quantity};
use serde::Serialize;

use super::bearings::{self, Typed};
use super::fields::{Field, FieldKind, MODE, at, groups};
use super::followed::followed;
use super::layouts::Layout;
use super::materials;
use crate::answer::Fault;

/// A gearbox from a form.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Written {
    /// Its text.
    pub text: String,
    /// Values that follow from what was typed, by path of the field.
    pub followed: BTreeMap<String, String>,
}

/// The template of a layout with typed values, by path of the field. What was not typed follows from it or keeps the value of the template.
///
/// # Errors
/// An unknown path; a value that is no text of one line, or a centre distance that is no length.
pub fn written(layout: &Layout, values: &BTreeMap<String, String>) -> Result<Written, Fault> {
    let document = outline::read(layout.text, None);
    let followed = followed(layout, &document, values);
    let mut all = followed.clone();
    all.extend(values.clone());
    let fields: Vec<_> = groups(layout).into_iter().flat_map(|group| group.fields).collect();
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    let mut details = Typed::new();
    for (path, typed) in &all {
        let typed = typed.trim();
        let wrong = |message: &str, help: &str| Err(Fault::from(Diagnostic::error(path.as_str(), message).help(help)));
        let Some(field) = fields.iter().find(|field| field.path == *path) else {
            return wrong("the form has no such field", "choose a field of the form");
        };
        if typed.is_empty() && field.example.is_some() {
            continue;
        }
        if typed.is_empty() {
            return wrong(
                "the value is missing",
                &format!("write a value such as {}", field.value),
            );
        }
        if typed.contains(['\n', '\r']) {
            return wrong("the value has several lines", "write one line");
        }
        if layout.distances.iter().any(|axis| axis.path() == *path) {
            continue;
        }
        for path in twins(layout, path) {
            if path.starts_with("gears.") && field.example.is_some() {
                changes.extend(materials::change(
                    layout.text,
                    &document,
                    &path,
                    &scalar(typed, field.kind),
                ));
            } else if field.example.is_some() {
                bearings::note(&mut details, &path, scalar(typed, field.kind));
            } else if let Some(node) = at(&document, &path) {
                changes.push((node.span.clone(), scalar(typed, field.kind)));
            }
        }
    }
    changes.extend(bearings::changes(layout.text, &document, &details));
    axes(layout, &document, &all, &mut changes)?;
    if all.get(MODE).is_some_and(|mode| mode == "balance") {
        changes.extend(heat_dissipation(layout.text));
    }
    let typed = |path: &str| {
        values
            .keys()
            .any(|shown| twins(layout, shown).iter().any(|twin| twin == path))
    };
    changes.extend(assumed(layout, &document, &fields, &typed));
    Ok(Written {
        text: replaced(layout.text, changes),
        followed,
    })
}

/// The heat dissipation of the template becomes part of the text: without it no heat balance is found.
fn heat_dissipation(text: &str) -> Option<(Range<usize>, String)> {
    let place = text.find("#heat_dissipation: ")?;
    Some((place..place + 1, String::new()))
}

/// A path, and that of its twin.
fn twins(layout: &Layout, path: &str) -> Vec<String> {
    let mut paths = vec![path.to_owned()];
    let Some([first, second]) = layout.twins else {
        return paths;
    };
    if path.contains(first) {
        paths.push(path.replace(first, second));
    }
    // Bearings of twins: `L1` and `R1`.
    let letters = [first, second].map(|word| word.chars().next().unwrap_or_default().to_ascii_uppercase());
    let first_bearing = format!("bearings.{}", letters[0]);
    if let Some(rest) = path.strip_prefix(&first_bearing) {
        paths.push(format!("bearings.{}{rest}", letters[1]));
    }
    paths
}

/// What is assumed no longer: entries of `assumed` without what was typed. A component of which a part was typed is replaced by its
/// other fields.
fn assumed(
    layout: &Layout,
    document: &Node,
    fields: &[Field],
    typed: &dyn Fn(&str) -> bool,
) -> Vec<(Range<usize>, String)> {
    let Some(Content::List(entries)) = at(document, "assumed").map(|node| &node.content) else {
        return Vec::new();
    };
    let mut changes = Vec::new();
    for entry in entries {
        let Some(list) = entry.get("paths") else { continue };
        let Content::List(paths) = &list.content else { continue };
        let paths: Vec<&str> = paths.iter().filter_map(Node::text).collect();
        let left: Vec<String> = paths
            .iter()
            .flat_map(|path| not_typed(layout, document, fields, path, typed))
            .collect();
        if left.is_empty() {
            changes.push((line(layout.text, entry.span.start), String::new()));
        } else if left != paths {
            changes.push((list.span.clone(), format!("[{}]", left.join(", "))));
        }
    }
    changes
}

/// What remains of a path of `assumed`.
fn not_typed(
    layout: &Layout,
    document: &Node,
    fields: &[Field],
    path: &str,
    typed: &dyn Fn(&str) -> bool,
) -> Vec<String> {
    // Axes follow from centre distances alone.
    let distances = layout.distances.iter();
    let moves_axes = distances
        .clone()
        .any(|axis| axis.cells.iter().any(|(cell, ..)| cell.starts_with("shafts.")));
    if path == "shafts" && moves_axes && distances.clone().all(|axis| typed(&axis.path())) {
        return Vec::new();
    }
    let below = |owner: &str| -> Vec<String> {
        let prefix = format!("{owner}.");
        let known = fields.iter().flat_map(|field| twins(layout, &field.path));
        // A centre distance that is only in the form says nothing about its mesh.
        known
            .filter(|path| path.starts_with(&prefix) && at(document, path).is_some())
            .collect()
    };
    let whole = || vec![path.to_owned()];
    if !below(path).iter().any(|field| typed(field)) {
        return whole();
    }
    let Some(node) = at(document, path) else { return whole() };
    let mut left = Vec::new();
    for entry in node.entries() {
        let place = format!("{path}.{}", entry.key);
        let fields = below(&place);
        if typed(&place) {
            continue;
        }
        if fields.iter().any(|field| typed(field)) {
            left.extend(fields.into_iter().filter(|field| !typed(field)));
        } else if !matches!(entry.value.content, Content::Scalar { .. }) {
            left.push(place);
        }
    }
    left
}

/// The line of a place, with its end.
fn line(text: &str, place: usize) -> Range<usize> {
    let start = text[..place].rfind('\n').map_or(0, |end| end + 1);
    let end = text[place..].find('\n').map_or(text.len(), |end| place + end + 1);
    start..end
}

/// Writes the coordinates that follow from centre distances.
fn axes(
    layout: &Layout,
    document: &Node,
    values: &BTreeMap<String, String>,
    changes: &mut Vec<(Range<usize>, String)>,
) -> Result<(), Fault> {
    let mut sums: Vec<(&str, Option<usize>, f64)> = Vec::new();
    let mut is_typed = false;
    for axis in layout.distances {
        let path = axis.path();
        let value = match values.get(&path) {
            None => axis.value,
            Some(typed) => {
                is_typed = true;
                millimetres(&path, typed.trim())?
            }
        };
        for (path, number, share) in axis.cells {
            match sums.iter_mut().find(|(p, n, _)| p == path && n == number) {
                Some((_, _, sum)) => *sum += share * value,
                None => sums.push((path, *number, share * value)),
            }
        }
    }
    if !is_typed {
        return Ok(());
    }
    for (path, number, sum) in sums {
        let node = at(document, path);
        let cell = node.and_then(|node| match (&node.content, number) {
            (Content::List(cells), Some(number)) => cells.get(number),
            (_, None) => Some(node),
            _ => None,
        });
        if let Some(cell) = cell {
            // Sums of decimal fractions have rounding errors in their last digits.
            changes.push((cell.span.clone(), format!("{} mm", (sum * 1e6).round() / 1e6)));
        }
    }
    Ok(())
}

/// A length. \[mm\]
fn millimetres(path: &str, typed: &str) -> Result<f64, Fault> {
    // A bare number is in the documented unit, as everywhere.
    if let Some(bare) = typed.parse::<f64>().ok().filter(|bare| *bare > 0.0 && bare.is_finite()) {
        return Ok(bare);
    }
    let unit = Unit::of_symbol("mm").unwrap_or(Unit::ONE);
    let wrong = |message: String, help: String| Fault::from(Diagnostic::error(path, message).help(help));
    let length = parse_quantity(typed, unit).map_err(|fault| {
        let help = fault.help.unwrap_or_else(|| "write a length such as 100 mm".to_owned());
        wrong(fault.message, help)
    })?;
    if length > 0.0 && length.is_finite() {
        Ok(length * 1e3)
    } else {
        Err(wrong(
            format!("{typed} is not a distance"),
            "write a length above zero such as 100 mm".to_owned(),
        ))
    }
}

/// A value as YAML: plain if nothing in it has a meaning there.
fn scalar(typed: &str, kind: FieldKind) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || " .,+-/%°²³()_".contains(c);
    let begins = typed
        .chars()
        .next()
        .is_some_and(|c| c.is_alphanumeric() || "+-.".contains(c));
    // A comma separates entries in braces; a designation of digits alone would be a number.
    let plain = begins && typed.chars().all(is_plain) && !typed.contains(", ") && !typed.contains(',');
    // What reads as a number would not be a text.
    let is_text = !typed.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    match kind {
        FieldKind::Integer | FieldKind::Quantity | FieldKind::Number if plain => typed.to_owned(),
        FieldKind::Text | FieldKind::Oil | FieldKind::Material | FieldKind::Choice if plain && is_text => {
            typed.to_owned()
        }
        _ => quoted(typed),
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn replaced(text: &str, mut changes: Vec<(Range<usize>, String)>) -> String {
    changes.sort_by_key(|(range, _)| range.start);
    let mut new = String::with_capacity(text.len());
    let mut end = 0;
    for (range, value) in changes {
        if range.start >= end {
            new.push_str(&text[end..range.start]);
            new.push_str(&value);
            end = range.end;
        }
    }
    new + &text[end..]
}
