//! Catalogues: CSV tables that fill omitted keys of components by designation.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::bearing_designation::{self, Designation};
use super::designation::suggest;
use super::{ValueSource, absent, entries_mut};
use crate::attach::dangling;
use crate::codes;
use crate::document::data::TableForm;
use crate::document::data::cells::{self, FoundColumn};
use crate::document::{Diagnostic, Dimension, Unit};
use crate::language::{LUBRICANTS, Language};
use crate::mechanism::Component as _;
use crate::mechanism::bearing::Bearing;
use crate::registry::Files;

/// One row of a catalogue.
#[derive(Debug, Clone)]
pub struct CatalogueRow {
    /// Keys of the section and their values, in written form.
    pub values: Vec<(String, Value)>,
    /// Confidence of the row.
    pub confidence: String,
    /// Origin of the data; may be empty.
    pub basis: String,
}

/// A catalogue: rows by designation.
#[derive(Debug, Clone, Default)]
pub struct CatalogueTable(pub BTreeMap<String, CatalogueRow>);

/// Rows whose designations contain a text.
#[derive(Debug, Clone, Default)]
pub struct CatalogueHits {
    /// Rows by designation.
    pub rows: Vec<(String, CatalogueRow)>,
    /// What the suffixes of the text mean, if it is a designation with suffixes of a row.
    pub about: Option<String>,
}

impl CatalogueTable {
    /// The rows whose designations contain a text. If there is none and suffixes are read, the row of the designation without its
    /// suffixes, without what they make invalid.
    pub fn search(&self, text: &str, with_suffixes: bool) -> CatalogueHits {
        // `VG220` finds `ISO VG 220 mineral`, `nu-206` finds `NU206EC`.
        let folded = |text: &str| text.to_lowercase().replace([' ', '-'], "");
        let wanted = folded(text);
        let rows = self.0.iter();
        let rows = rows.filter(|(designation, _)| folded(designation).contains(&wanted));
        let mut hits = CatalogueHits {
            rows: rows
                .map(|(designation, row)| (designation.clone(), row.clone()))
                .collect(),
            about: None,
        };
        if hits.rows.is_empty()
            && with_suffixes
            && let Some(read) = bearing_designation::read(text, self.0.keys().map(String::as_str))
            && let Some(row) = self.0.get(read.base)
        {
            let (_, invalid) = read.changes();
            let mut row = row.clone();
            row.values.retain(|(key, _)| !invalid.contains(&key.as_str()));
            hits.rows.push((text.to_owned(), row));
            hits.about = Some(read.words());
        }
        // `SKF 6207`: the maker is no part of a designation.
        if hits.rows.is_empty()
            && let Some((maker, rest)) = text.trim().split_once(' ')
            && maker.chars().all(char::is_alphabetic)
            && !rest.trim().is_empty()
        {
            return self.search(rest.trim(), with_suffixes);
        }
        hits
    }

    /// Adds the rows of another; existing rows take precedence.
    pub fn extend(&mut self, other: Self) {
        for (designation, row) in other.0 {
            self.0.entry(designation).or_insert(row);
        }
    }

    /// Reads a catalogue from the bytes of a CSV file, a workbook or an MDF file: `designation`, then keys with their unit in brackets, and
    /// optionally `confidence` and `basis`. A column without a unit is text. An empty cell states nothing.
    ///
    /// # Errors
    /// With the line of the file.
    pub fn from_file(bytes: impl AsRef<[u8]>) -> Result<Self, String> {
        let is_name = |name: &str| name == "designation";
        let form = TableForm::default();
        let table = cells::table(bytes.as_ref(), &form, &is_name, &mut Vec::new())
            .map_err(|wrong| format!("{} ({})", wrong.message, wrong.help))?;
        let mut columns = Vec::new();
        for (place, (key, symbol)) in table.names.iter().zip(&table.units).enumerate() {
            let unknown = |symbol: &String| {
                format!(
                    "line {}: column `{key} [{symbol}]`: unknown unit",
                    table.unit_lines[place]
                )
            };
            let unit = match symbol {
                Some(symbol) => {
                    let read = Unit::read(symbol).ok_or_else(|| unknown(symbol))?;
                    // A dash marks a plain number.
                    let is_plain = read.dimension == Dimension::None && read.factor == 1.0;
                    Some(if is_plain { "" } else { symbol.as_str() })
                }
                None => None,
            };
            columns.push((key.as_str(), unit));
        }
        let at_header = table.at_header();
        let at = match table.column("designation") {
            FoundColumn::At(place) => place,
            FoundColumn::Absent => return Err(format!("{at_header}no column `designation`")),
            FoundColumn::Several(_) => return Err(format!("{at_header}several columns `designation`")),
        };
        let mut rows = BTreeMap::new();
        for (line, record) in &table.rows {
            let mut row = CatalogueRow {
                values: Vec::new(),
                confidence: "not stated".to_owned(),
                basis: String::new(),
            };
            for ((key, unit), cell) in columns.iter().zip(record) {
                match (*key, unit) {
                    ("designation", _) => {}
                    ("basis", _) => cell.clone_into(&mut row.basis),
                    ("confidence", _) => cell.clone_into(&mut row.confidence),
                    _ if cell.is_empty() => {}
                    (_, Some(unit)) => {
                        let number = table.numbers.number(cell);
                        let number =
                            number.ok_or_else(|| format!("line {line}: column `{key}`: `{cell}` is not a number"))?;
                        let value = match *unit {
                            "" => Value::from(number),
                            unit => {
                                let plain = table.numbers.plain(cell);
                                Value::from(format!("{} {unit}", plain.as_ref().unwrap_or(cell)))
                            }
                        };
                        row.values.push(((*key).to_owned(), value));
                    }
                    (_, None) => row.values.push(((*key).to_owned(), Value::from(cell.as_str()))),
                }
            }
            let Some(designation) = record.get(at).filter(|cell| !cell.is_empty()).cloned() else {
                return Err(format!("line {line}: no designation"));
            };
            if rows.insert(designation.clone(), row).is_some() {
                return Err(format!("line {line}: `{designation}` occurs twice"));
            }
        }
        Ok(Self(rows))
    }
}

/// Fills the omitted keys of every component that has a designation.
pub(super) fn fill(
    language: &Language,
    files: &Files,
    value: &mut Value,
    sources: &mut BTreeMap<String, ValueSource>,
    notes: &mut Vec<String>,
    found: &mut Vec<Diagnostic>,
) {
    let of_gearbox = written_catalogues(language, files, value, found);
    let components = language.registry().sections().map(|(_, s)| (s.name, "bore"));
    // A designation may be just a name, if the required keys are written.
    let sections: Vec<(&str, &str)> = components.chain([(LUBRICANTS, "viscosity")]).collect();
    for (section, needed) in sections {
        let (shipped, written) = (language.catalogue(section), of_gearbox.get(section));
        for (id, entry) in entries_mut(value, section) {
            let Some(designation) = entry.get("designation").and_then(Value::as_str).map(str::to_owned) else {
                continue;
            };
            let tables = || written.into_iter().chain(shipped);
            let path = format!("{section}.{id}");
            let mut fill = |designation: &str, row: &CatalogueRow| {
                fill_entry(language, &path, entry, designation, row, sources, found);
            };
            if let Some(row) = tables().find_map(|t| t.0.get(&designation)) {
                fill(&designation, row);
            } else if let Some((read, row)) = with_suffixes(section, &designation, tables()) {
                notes.push(format!("{path}.designation `{designation}`: {}", read.words()));
                fill(&designation, &row);
            } else if absent(entry, needed) {
                let rows = shipped.into_iter().chain(written).flat_map(|t| &t.0);
                let rows: Vec<(&str, &CatalogueRow)> = rows.map(|(name, row)| (name.as_str(), row)).collect();
                found.push(unknown_designation(section, id, &designation, &rows));
            }
        }
    }
}

/// The row of a designation without its suffixes, changed by what they state; bearings only.
fn with_suffixes<'t>(
    section: &str,
    written: &str,
    tables: impl Iterator<Item = &'t CatalogueTable> + Clone,
) -> Option<(Designation<'t>, CatalogueRow)> {
    if section != Bearing::SECTION {
        return None;
    }
    let known = tables.clone().flat_map(|table| table.0.keys().map(String::as_str));
    let read = bearing_designation::read(written, known)?;
    let mut row = tables.clone().find_map(|table| table.0.get(read.base))?.clone();
    let (keys, invalid) = read.changes();
    row.values.retain(|(key, _)| !invalid.contains(&key.as_str()));
    row.values
        .extend(keys.into_iter().map(|(key, value)| (key.to_owned(), value)));
    Some((read, row))
}

/// The catalogues that the document names, by section.
fn written_catalogues(
    language: &Language,
    files: &Files,
    value: &Value,
    found: &mut Vec<Diagnostic>,
) -> BTreeMap<String, CatalogueTable> {
    let mut tables = BTreeMap::new();
    for (section, file) in value.get("catalogues").and_then(Value::as_object).into_iter().flatten() {
        let path = format!("catalogues.{section}");
        let file = file.as_str().unwrap_or_default();
        match files
            .bytes(file)
            .and_then(|bytes| CatalogueTable::from_file(&bytes).map_err(|e| format!("{file}: {e}")))
        {
            Ok(table) if section == LUBRICANTS || language.registry().sections().any(|(_, s)| s.name == section) => {
                tables.insert(section.clone(), table);
            }
            Ok(_) => {
                let sections = language.registry().sections().map(|(_, s)| s.name);
                let known: Vec<&str> = sections.chain([LUBRICANTS]).collect();
                found.push(dangling(&path, "section of components", section, &known));
            }
            Err(reason) => {
                found.push(Diagnostic::error(path, reason).help("file names are relative to the gearbox document"));
            }
        }
    }
    tables
}

/// The error for a designation without a row, among all rows of its section.
fn unknown_designation(section: &str, id: &str, designation: &str, rows: &[(&str, &CatalogueRow)]) -> Diagnostic {
    let path = format!("{section}.{id}.designation");
    let error = Diagnostic::error(path, format!("no catalogue has `{designation}`"))
        .code(codes::UNKNOWN_DESIGNATION)
        .note(format!(
            "{} designations are known: `gearloss catalogue {}` lists them",
            rows.len(),
            if section == LUBRICANTS { "oils" } else { section }
        ));
    let here = if section == LUBRICANTS {
        "state viscosity, kind and density here"
    } else {
        "state bore, outside, kind and ratings here"
    };
    suggest(error, designation, rows, here)
}

/// Fills the omitted keys of one component from its row.
fn fill_entry(
    language: &Language,
    path: &str,
    entry: &mut Map<String, Value>,
    designation: &str,
    row: &CatalogueRow,
    sources: &mut BTreeMap<String, ValueSource>,
    found: &mut Vec<Diagnostic>,
) {
    // A nested entry that is written, such as a viscosity, is not completed: a law with two parameters takes no third value.
    let written: Vec<String> = entry.keys().filter(|key| !absent(entry, key)).cloned().collect();
    for (key, filled) in &row.values {
        let (head, rest) = key.split_once('.').unwrap_or((key, ""));
        if written.iter().any(|w| w == head) {
            continue;
        }
        let path = format!("{path}.{key}");
        match language.checked(filled, &path) {
            Ok(value) if rest.is_empty() => {
                entry.insert(key.clone(), value);
            }
            Ok(value) => {
                let nested = entry.entry(head).or_insert_with(|| Value::Object(Map::new()));
                if !nested.is_object() {
                    *nested = Value::Object(Map::new());
                }
                nested[rest] = value;
            }
            Err(list) => {
                let row = format!("in the catalogue row `{designation}`");
                found.extend(list.into_iter().map(|d| d.note(row.clone())));
                continue;
            }
        }
        let from = ValueSource::Catalogue {
            designation: designation.to_owned(),
            confidence: row.confidence.clone(),
        };
        sources.insert(path, from);
    }
}
