//! Where the header of a table is, the row of units below it, and names with units.

use super::form::{Separator, TableForm};
use super::{MeasuredFault, times};
use crate::Unit;

/// Lines in which a header is looked for.
pub(super) const MOST_LINES: usize = 1000;

/// `name [unit]`, `name (unit)`, `name / unit`, or a bare name.
pub fn name_and_unit(header: &str) -> (String, Option<String>) {
    let header = header.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = header.split_once(open) {
            return (
                name.trim().to_owned(),
                Some(rest.trim_end().trim_end_matches(close).trim().to_owned()),
            );
        }
    }
    match header.split_once(" / ") {
        Some((name, unit)) => (name.trim().to_owned(), Some(unit.trim().to_owned())),
        None => (header.to_owned(), None),
    }
}

/// Tells whether a name is one of those that are looked for.
pub type IsName<'a> = &'a dyn Fn(&str) -> bool;

/// The header among lines with their cells: its index. `is_name` knows the names that are looked for. The first line is the header, as in
/// a file that begins with it, unless another has more of these names.
///
/// # Errors
/// If several lines have as many names, each of them different.
pub(super) fn find(lines: &[(u64, Vec<String>)], is_name: IsName<'_>) -> Result<usize, MeasuredFault> {
    let names = |cells: &[String]| {
        let mut names: Vec<String> = cells.iter().map(|cell| name_and_unit(cell).0).collect();
        names.retain(|name| !name.is_empty() && is_name(name));
        names.sort();
        names.dedup();
        names.len()
    };
    let counts: Vec<usize> = lines.iter().map(|(_, cells)| names(cells)).collect();
    let most = counts.iter().copied().max().unwrap_or(0);
    if most == 0 {
        return Ok(wide(lines).unwrap_or(0));
    }
    let mut best = (0..lines.len()).filter(|i| counts[*i] == most);
    let first = best.next().unwrap_or(0);
    let others: Vec<usize> = best.filter(|i| lines[*i].1 != lines[first].1).collect();
    if first == 0 || others.is_empty() {
        return Ok(first);
    }
    let places: Vec<String> = [first]
        .iter()
        .chain(&others)
        .take(5)
        .map(|i| lines[*i].0.to_string())
        .collect();
    Err(MeasuredFault::new(
        "header_line",
        format!(
            "lines {} may be the header, each with {most} of the names",
            places.join(", ")
        ),
        format!("state one: `header_line: {}`", lines[first].0),
    ))
}

/// The first of several lines with several texts, after a title that has one cell. None of its names is known, so that it is only listed.
fn wide(lines: &[(u64, Vec<String>)]) -> Option<usize> {
    let filled = |cells: &[String]| cells.iter().filter(|cell| !cell.is_empty()).count();
    if lines.first().is_some_and(|(_, cells)| filled(cells) > 1) {
        return None;
    }
    let is_text = |cell: &String| !cell.is_empty() && cell.replace(',', ".").parse::<f64>().is_err();
    lines
        .iter()
        .position(|(_, cells)| cells.len() > 1 && cells.iter().all(is_text))
}

/// `sep=;` as the first line of a file.
pub(super) fn stated_separator(line: &str) -> Option<Separator> {
    let line = line.trim_matches(['\r', '\n', '"']);
    let sign = line
        .get(..4)
        .filter(|key| key.eq_ignore_ascii_case("sep="))
        .map(|_| &line[4..])?;
    match sign {
        "," => Some(Separator::Comma),
        ";" => Some(Separator::Semicolon),
        "\t" => Some(Separator::Tab),
        " " => Some(Separator::Blank),
        _ => None,
    }
}

/// A cell without white space and the brackets around all of it.
pub fn without_brackets(cell: &str) -> &str {
    let cell = cell.trim();
    let inside = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    inside('[', ']').or_else(|| inside('(', ')')).unwrap_or(cell).trim()
}

/// Takes a row of units: no cell is a number, and at least one is a unit. Other cells keep their spelling, so that the one that is not known
/// is named where it is used.
pub(super) fn take_units(
    rows: &mut Vec<(u64, Vec<String>)>,
    (units, unit_lines): (&mut [Option<String>], &mut [u64]),
    notes: &mut Vec<String>,
) {
    let is_number = |cell: &str| cell.replace(',', ".").parse::<f64>().is_ok();
    let is_unit = |cell: &str| cell == "-" || Unit::read(cell).is_some() || times::is_pattern(cell);
    let is_row = rows.first().is_some_and(|(_, cells)| {
        let cells = || {
            cells
                .iter()
                .map(|cell| without_brackets(cell))
                .filter(|cell| !cell.is_empty())
        };
        cells().all(|cell| cell == "1" || !is_number(cell)) && cells().any(|cell| cell != "1" && is_unit(cell))
    });
    if !is_row {
        return;
    }
    let (line, cells) = rows.remove(0);
    notes.push(format!("units in line {line}"));
    for ((unit, unit_line), cell) in units.iter_mut().zip(unit_lines).zip(&cells) {
        let symbol = without_brackets(cell);
        if !symbol.is_empty() {
            *unit = Some(symbol.to_owned());
            *unit_line = line;
        }
    }
}

/// True if a row is read: after the header and within the stated lines.
pub(super) fn keep_stated_lines(rows: &mut Vec<(u64, Vec<String>)>, form: &TableForm) {
    if form.first_line.is_some() || form.last_line.is_some() {
        rows.retain(|(line, _)| form.has_line(*line));
    }
}
