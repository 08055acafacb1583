//! The table of a set against the columns that its source states.

use std::ops::Range;

use gearloss_framework::document::{Diagnostic, Places, Span, Unit, did_you_mean};

use super::source::{SourceEntry, StatedColumn};
use crate::codes;

/// A cell with its bytes in the text.
struct Cell<'t> {
    text: &'t str,
    at: Range<usize>,
}

/// What is wrong in a table, and its number of rows. `source` is the number of its text.
pub(super) fn check(text: &str, source: u16, entry: &SourceEntry, places: &Places) -> Result<usize, Vec<Diagnostic>> {
    let lines: Vec<Vec<Cell<'_>>> = lines(text);
    let at = |cell: &Cell<'_>, message: String, help: String| {
        let span = Span {
            source,
            start: cell.at.start as u32,
            end: cell.at.end as u32,
        };
        Diagnostic::error("data.csv", message)
            .at_span(span)
            .help(help)
            .code(codes::CORPUS)
    };
    let [head, units, rows @ ..] = &lines[..] else {
        return Err(vec![
            Diagnostic::error("data.csv", "the table has no line of units")
                .help("write names in line 1, units in line 2, then the numbers")
                .code(codes::CORPUS),
        ]);
    };
    let stated: Vec<(&str, &StatedColumn)> = entry.columns.iter().collect();
    let mut found: Vec<Diagnostic> = names(head, &stated)
        .into_iter()
        .map(|(cell, message, help)| at(cell, message, help))
        .collect();
    for (name, _) in &stated {
        if head.iter().all(|cell| cell.text != *name) {
            let missing = Diagnostic::error(format!("columns.{name}"), format!("data.csv has no column `{name}`"));
            found.push(places.place(missing.help("add it, or delete it here").code(codes::CORPUS)));
        }
    }
    for cells in [units].into_iter().chain(rows) {
        if cells.len() != head.len() {
            let first = cells.first().map_or(Cell { text: "", at: 0..0 }, |cell| Cell {
                text: cell.text,
                at: cell.at.start..cells.last().map_or(cell.at.end, |last| last.at.end),
            });
            let message = format!("{} cells instead of {}", cells.len(), head.len());
            found.push(at(
                &first,
                message,
                "cells are separated by commas and have no quotes".to_owned(),
            ));
        }
    }
    if !found.is_empty() {
        return Err(found);
    }
    for (i, (name, column)) in stated.iter().enumerate() {
        let values: Vec<&Cell<'_>> = rows
            .iter()
            .map(|cells| &cells[i])
            .filter(|cell| !cell.text.is_empty())
            .collect();
        let wrong = match column_of(column) {
            Ok(None) => Ok(()),
            Ok(Some((unit, from, to))) => {
                if Unit::is_same(units[i].text, unit) {
                    numbers(name, unit, [from, to], &values)
                } else {
                    let message = format!(
                        "`{name}` is in `{}` here, but the source states `{unit}`",
                        units[i].text
                    );
                    Err((&units[i], message, "correct the unit here or in source.md".to_owned()))
                }
            }
            Err(message) => {
                let help = "state `unit`, `from` and `to` of numbers, and none of them of texts";
                let incomplete = Diagnostic::error(format!("columns.{name}"), message).help(help);
                found.push(places.place(incomplete.code(codes::CORPUS)));
                continue;
            }
        };
        if let Err((cell, message, help)) = wrong {
            found.push(at(cell, message, help));
        }
    }
    if found.is_empty() { Ok(rows.len()) } else { Err(found) }
}

/// A cell with what is wrong and how to correct it.
type Wrong<'c, 't> = (&'c Cell<'t>, String, String);

/// Names in the table that the source does not state, or states in another order.
fn names<'c, 't>(head: &'c [Cell<'t>], stated: &[(&str, &StatedColumn)]) -> Vec<Wrong<'c, 't>> {
    let wrong = |(i, cell): (usize, &'c Cell<'t>)| {
        let is_there = stated.iter().any(|(name, _)| *name == cell.text);
        match stated.get(i) {
            Some((name, _)) if *name == cell.text => None,
            Some((name, _)) if is_there => {
                let message = format!(
                    "column {} is `{}`, but the source states `{name}` there",
                    i + 1,
                    cell.text
                );
                let help = "are columns swapped? write them in the order of `columns` of source.md, or correct it";
                Some((cell, message, help.to_owned()))
            }
            _ if is_there => None,
            _ => {
                let help = match did_you_mean(cell.text, stated.iter().map(|(name, _)| *name)) {
                    Some(close) => format!("write `{close}`, or add the column under `columns` of source.md"),
                    None => format!("add `{}` under `columns` of source.md", cell.text),
                };
                Some((
                    cell,
                    format!("the source does not state the column `{}`", cell.text),
                    help,
                ))
            }
        }
    };
    head.iter().enumerate().filter_map(wrong).collect()
}

/// Unit, least and greatest number of a column; none of a column of text.
fn column_of(column: &StatedColumn) -> Result<Option<(&str, f64, f64)>, &'static str> {
    match (&column.unit, column.from, column.to) {
        (Some(unit), Some(from), Some(to)) => Ok(Some((unit, from, to))),
        (None, None, None) => Ok(None),
        _ => Err("a column of numbers needs `unit`, `from` and `to`"),
    }
}

/// Finds the first cell that is no number or beyond the stated ends, and ends that no number reaches.
fn numbers<'c, 't>(name: &str, unit: &str, [from, to]: [f64; 2], cells: &[&'c Cell<'t>]) -> Result<(), Wrong<'c, 't>> {
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for cell in cells {
        let Some(number) = cell.text.parse::<f64>().ok().filter(|x| x.is_finite()) else {
            let message = format!("`{}` in the column `{name}` is not a number", cell.text);
            return Err((
                cell,
                message,
                "write a decimal point and no unit; leave the cell empty if it is unknown".to_owned(),
            ));
        };
        if number < from || number > to {
            let message =
                format!("{number} {unit} of `{name}` is outside {from} to {to} {unit}, which the source states");
            let help = "is the unit of the column right, and is it not swapped with another? correct the number, or `from` and `to` in source.md";
            return Err((cell, message, help.to_owned()));
        }
        (least, greatest) = (least.min(number), greatest.max(number));
    }
    match cells.first() {
        Some(first) if least != from || greatest != to => {
            let message = format!(
                "`{name}` reaches from {least} to {greatest} {unit}, but the source states {from} to {to} {unit}"
            );
            let help = "is a row missing, or the column swapped with another? correct the table, or `from` and `to` in source.md";
            Err((first, message, help.to_owned()))
        }
        _ => Ok(()),
    }
}

/// The cells of all lines that are not empty.
fn lines(text: &str) -> Vec<Vec<Cell<'_>>> {
    let mut all = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end_matches(['\n', '\r']);
        if !content.trim().is_empty() {
            let mut place = start;
            let cells = content.split(',').map(|cell| {
                let at = place..place + cell.len();
                place += cell.len() + 1;
                Cell { text: cell.trim(), at }
            });
            all.push(cells.collect());
        }
        start += line.len();
    }
    all
}
