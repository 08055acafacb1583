//! Catalogues: CSV tables that fill omitted keys of components by designation.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Map, Value};

use super::bearing_designation::{self, Designation};
use super::designation::suggest;
use super::linked_catalogue::LinkedCatalogue;
use super::{ValueSource, absent, entries_mut};
use crate::attach::dangling;
use crate::codes;
use crate::document::data::TableForm;
use crate::document::data::cells::{self, FoundColumn};
use crate::document::{Diagnostic, Dimension, Unit};
use crate::language::{LUBRICANTS, Language, MATERIALS};
use crate::maker;
use crate::mechanism::Component as _;
use crate::mechanism::bearing::Bearing;
use crate::registry::Files;

/// One row of a catalogue.
#[derive(Debug, Clone)]
pub struct CatalogueRow {
    /// Keys of the section and their values, in written form.
    pub values: Vec<(String, Value)>,
    /// Keys whose values are estimates by a rule.
    pub estimated: Vec<String>,
    /// Confidence of the row.
    pub confidence: String,
    /// Origin of the data; may be empty.
    pub basis: String,
}

/// Confidence of a value that is estimated by a rule.
pub const ESTIMATED: &str = "estimated";

impl CatalogueRow {
    /// Confidence of the value of a key.
    fn confidence_of(&self, key: &str) -> &str {
        if self.estimated.iter().any(|estimated| estimated == key) {
            ESTIMATED
        } else {
            &self.confidence
        }
    }
}

/// The columns of a catalogue: key, and the unit if it is a number; an empty unit is that of a plain number.
pub(super) type Columns<'a> = [(&'a str, Option<&'a str>)];

/// The unit of a column as it is written behind a number: a dash marks a plain number.
pub(super) fn unit_of_column(symbol: &str) -> Option<&str> {
    let read = Unit::read(symbol)?;
    let is_plain = read.dimension == Dimension::None && read.factor == 1.0;
    Some(if is_plain { "" } else { symbol })
}

/// A row of its cells; `number` reads a cell, and gives its text with a decimal point.
///
/// # Errors
/// A cell that is not a number, with its column.
pub(super) fn row<'c>(
    columns: &Columns<'_>,
    cells: impl Iterator<Item = &'c str>,
    number: impl Fn(&'c str) -> Option<(f64, Cow<'c, str>)>,
) -> Result<CatalogueRow, String> {
    let mut row = CatalogueRow {
        values: Vec::new(),
        estimated: Vec::new(),
        confidence: "not stated".to_owned(),
        basis: String::new(),
    };
    for ((key, unit), cell) in columns.iter().zip(cells) {
        let value = match (*key, unit) {
            ("designation", _) => continue,
            ("basis", _) => {
                cell.clone_into(&mut row.basis);
                continue;
            }
            ("confidence", _) => {
                cell.clone_into(&mut row.confidence);
                continue;
            }
            ("estimated", _) => {
                row.estimated = cell.split_whitespace().map(str::to_owned).collect();
                continue;
            }
            _ if cell.is_empty() => continue,
            (_, Some(unit)) => {
                let (number, plain) =
                    number(cell).ok_or_else(|| format!("column `{key}`: `{cell}` is not a number"))?;
                if unit.is_empty() {
                    Value::from(number)
                } else {
                    Value::from(format!("{plain} {unit}"))
                }
            }
            (_, None) => Value::from(cell),
        };
        row.values.push(((*key).to_owned(), value));
    }
    Ok(row)
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
        // `SKF 6207-2RS`: the maker is no part of a designation.
        if hits.rows.is_empty()
            && with_suffixes
            && let Some((_, rest)) = maker::before(text)
        {
            return self.search(rest, with_suffixes);
        }
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
        // Nor is one that is not known.
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

    /// Reads the catalogue that a document names: a file, or all tables of a folder (`.csv`, `.xlsx`) if the name ends with `/`.
    ///
    /// # Errors
    /// Why a file or the folder cannot be read, with the name of the file; a designation that two files of the folder have.
    pub fn named(files: &Files, name: &str) -> Result<Self, String> {
        let read = |file: &str| {
            let bytes = files.bytes(file)?;
            Self::from_file(&bytes).map_err(|wrong| format!("{file}: {wrong}"))
        };
        if !name.ends_with('/') {
            return read(name);
        }
        let is_table = |file: &String| {
            let extension = Path::new(file).extension();
            extension.is_some_and(|kind| kind.eq_ignore_ascii_case("csv") || kind.eq_ignore_ascii_case("xlsx"))
        };
        let tables: Vec<String> = files.list(name)?.into_iter().filter(is_table).collect();
        if tables.is_empty() {
            return Err(format!("{name} has no table (.csv, .xlsx)"));
        }
        let mut whole = BTreeMap::new();
        let mut file_of: BTreeMap<String, String> = BTreeMap::new();
        for table in tables {
            let file = format!("{name}{table}");
            for (designation, row) in read(&file)?.0 {
                if let Some(first) = file_of.insert(designation.clone(), file.clone()) {
                    return Err(format!("{file}: {first} has `{designation}`, too"));
                }
                whole.insert(designation, row);
            }
        }
        Ok(Self(whole))
    }

    /// Reads a catalogue from the bytes of a CSV file, a workbook or an MDF file: `designation`, then keys with their unit in brackets, and
    /// optionally `estimated` (keys whose values are from a rule, separated by spaces), `confidence` and `basis`. A column without a unit is text. An empty cell states nothing.
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
            let unit = match symbol {
                Some(symbol) => Some(unit_of_column(symbol).ok_or_else(|| {
                    let line = table.unit_lines[place];
                    format!("line {line}: column `{key} [{symbol}]`: unknown unit")
                })?),
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
            let number = |cell| {
                let number = table.numbers.number(cell)?;
                Some((
                    number,
                    table.numbers.plain(cell).map_or(Cow::Borrowed(cell), Cow::Owned),
                ))
            };
            let row = row(&columns, record.iter().map(String::as_str), number);
            let row = row.map_err(|wrong| format!("line {line}: {wrong}"))?;
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
    let (linked, written) = (language.linked_catalogue(MATERIALS), of_gearbox.get(MATERIALS));
    materials_by_designation(value, Known { written, linked }, sources);
    let components = language.registry().sections().map(|(_, s)| (s.name, "bore"));
    // A designation may be just a name, if the required keys are written.
    let sections: Vec<(&str, &str)> = components
        .chain([(LUBRICANTS, "viscosity"), (MATERIALS, "elastic_modulus")])
        .collect();
    for (section, needed) in sections {
        let (linked, written) = (language.linked_catalogue(section), of_gearbox.get(section));
        for (id, entry) in entries_mut(value, section) {
            let Some(designation) = entry.get("designation").and_then(Value::as_str).map(str::to_owned) else {
                continue;
            };
            let path = format!("{section}.{id}");
            let known = Known { written, linked };
            let (suffixes, row) = match known.row(&designation) {
                Some(row) => (None, Some(row)),
                None => match with_suffixes(section, &designation, known) {
                    Some((read, row)) => (Some(read), Some(row)),
                    None => (None, None),
                },
            };
            match row {
                Some(Ok(row)) => {
                    if let Some(read) = suffixes {
                        notes.push(format!("{path}.designation `{designation}`: {}", read.words()));
                    }
                    fill_entry(language, &path, entry, &designation, &row, sources, found);
                }
                Some(Err(reason)) => {
                    let message = format!("linked catalogue of {section}: {reason}");
                    found.push(Diagnostic::error(format!("{path}.designation"), message));
                }
                None if absent(entry, needed) => {
                    let rows = linked.into_iter().map(LinkedCatalogue::table).chain(written);
                    let rows = rows.flat_map(|table| &table.0);
                    let rows: Vec<(&str, &CatalogueRow)> = rows.map(|(name, row)| (name.as_str(), row)).collect();
                    found.push(unknown_designation(section, id, &designation, &rows));
                }
                None => {}
            }
        }
    }
}

/// Adds the materials that gears name by their designation in a catalogue instead of an entry of their own.
fn materials_by_designation(value: &mut Value, known: Known<'_>, sources: &mut BTreeMap<String, ValueSource>) {
    let written = |name: &String| value.get(MATERIALS).is_none_or(|own| own.get(name).is_none());
    let mut added: BTreeMap<String, String> = BTreeMap::new();
    for (_, gear) in value.get("gears").and_then(Value::as_object).into_iter().flatten() {
        let name = gear.get("material").and_then(Value::as_str).map(str::to_owned);
        if let Some(name) = name
            .filter(written)
            .filter(|name| known.designations().any(|row| row == name))
        {
            let id = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
            added.insert(name, id);
        }
    }
    if added.is_empty() {
        return;
    }
    for (_, gear) in entries_mut(value, "gears") {
        let id = gear
            .get("material")
            .and_then(Value::as_str)
            .and_then(|name| added.get(name));
        if let Some(id) = id.cloned() {
            gear.insert("material".to_owned(), Value::from(id));
        }
    }
    let Some(document) = value.as_object_mut() else { return };
    let materials = document.entry(MATERIALS).or_insert_with(|| Value::Object(Map::new()));
    let Some(materials) = materials.as_object_mut() else {
        return;
    };
    for (designation, id) in added {
        let entry = Map::from_iter([("designation".to_owned(), Value::from(designation))]);
        sources.insert(format!("{MATERIALS}.{id}"), ValueSource::Document);
        materials.entry(id).or_insert_with(|| Value::Object(entry));
    }
}

/// The catalogues of a section: the document's own one has precedence.
#[derive(Clone, Copy)]
struct Known<'t> {
    written: Option<&'t CatalogueTable>,
    linked: Option<&'t LinkedCatalogue>,
}

impl<'t> Known<'t> {
    fn row(self, designation: &str) -> Option<Result<CatalogueRow, String>> {
        let written = self.written.and_then(|table| table.0.get(designation));
        written
            .map(|row| Ok(row.clone()))
            .or_else(|| self.linked?.row(designation))
    }

    fn designations(self) -> impl Iterator<Item = &'t str> + Clone {
        let written = self.written.into_iter().flat_map(|table| table.0.keys());
        let linked = self.linked.into_iter().flat_map(LinkedCatalogue::designations);
        written
            .map(String::as_str)
            .chain(linked.map(|name| -> &'t str { name }))
    }
}

/// The row of a designation without its suffixes, changed by what they state; bearings only.
fn with_suffixes<'t>(
    section: &str,
    written: &str,
    known: Known<'t>,
) -> Option<(Designation<'t>, Result<CatalogueRow, String>)> {
    if section != Bearing::SECTION {
        return None;
    }
    let read = bearing_designation::read(written, known.designations())?;
    let row = known.row(read.base)?.map(|mut row| {
        let (keys, invalid) = read.changes();
        row.values.retain(|(key, _)| !invalid.contains(&key.as_str()));
        row.values
            .extend(keys.into_iter().map(|(key, value)| (key.to_owned(), value)));
        row
    });
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
        match CatalogueTable::named(files, file.as_str().unwrap_or_default()) {
            Ok(table)
                if [LUBRICANTS, MATERIALS].contains(&section.as_str())
                    || language.registry().sections().any(|(_, s)| s.name == section) =>
            {
                tables.insert(section.clone(), table);
            }
            Ok(_) => {
                let sections = language.registry().sections().map(|(_, s)| s.name);
                let known: Vec<&str> = sections.chain([LUBRICANTS, MATERIALS]).collect();
                found.push(dangling(&path, "section of components", section, &known));
            }
            Err(reason) => {
                found.push(Diagnostic::error(path, reason).help(
                    "file names are relative to the gearbox document; a name that ends with `/` is a folder of tables",
                ));
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
    let here = match section {
        LUBRICANTS => "state viscosity, kind and density here",
        MATERIALS => "state elastic_modulus and poisson here",
        _ => "state bore, outside, kind and ratings here",
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
            confidence: row.confidence_of(key).to_owned(),
        };
        sources.insert(path, from);
    }
}
