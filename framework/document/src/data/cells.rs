//! From bytes to cells: encoding, separator, decimal sign, header, units.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FaultPlace, MeasuredFault, fault, mdf, workbook};
use crate::Unit;

/// Cell separator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Separator {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab character.
    Tab,
}

impl Separator {
    fn byte(self) -> u8 {
        match self {
            Self::Comma => b',',
            Self::Semicolon => b';',
            Self::Tab => b'\t',
        }
    }
}

/// Decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Decimal {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

impl Decimal {
    /// A finite number.
    pub fn number(self, cell: &str) -> Option<f64> {
        let number = match self {
            Self::Point => cell.parse::<f64>(),
            Self::Comma if cell.contains('.') => return None,
            Self::Comma => cell.replace(',', ".").parse::<f64>(),
        };
        number.ok().filter(|x| x.is_finite())
    }
}

/// Encoding of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// UTF-8, with or without a byte order mark.
    Utf8,
    /// ISO 8859-1.
    Latin1,
}

/// The stated format of a file; unstated properties are detected.
#[derive(Debug, Clone, Copy, Default)]
pub struct Form<'a> {
    /// Sheet of a workbook; otherwise the first one.
    pub sheet: Option<&'a str>,
    /// Channel group of an MDF file; needed if it has several with samples.
    pub group: Option<&'a str>,
    /// Cell separator.
    pub separator: Option<Separator>,
    /// The decimal sign.
    pub decimal: Option<Decimal>,
    /// The encoding.
    pub encoding: Option<Encoding>,
}

/// Cells with their lines.
pub struct Table {
    /// Sheet or channel group of the file, if it has such.
    pub part: Option<String>,
    /// Headers.
    pub names: Vec<String>,
    /// Unit of each column if the header or a row of units states it.
    pub units: Vec<Option<String>>,
    /// Columns that the file has and that cannot be read, with the reason.
    pub unread: Vec<(String, String)>,
    /// Line of the header; zero in a file whose header is in no line.
    pub header_line: u64,
    /// Cells of each row with its line, row of the sheet, or number of the sample.
    pub rows: Vec<(u64, Vec<String>)>,
    /// The decimal sign.
    pub decimal: Decimal,
}

impl Table {
    /// A name of the file with the sheet or channel group.
    pub fn named(&self, file: &str) -> String {
        match &self.part {
            Some(part) => format!("{file}: {part}"),
            None => file.to_owned(),
        }
    }

    /// Adds sheet or channel group to errors.
    pub fn placed(&self, faults: Vec<MeasuredFault>) -> Vec<MeasuredFault> {
        let Some(part) = &self.part else {
            return faults;
        };
        let placed = |wrong: MeasuredFault| MeasuredFault {
            message: format!("{part}: {}", wrong.message),
            ..wrong
        };
        faults.into_iter().map(placed).collect()
    }

    /// That there is no column of this name, and why if the file has it; with all columns.
    pub fn lacks(&self, header: &str) -> String {
        let names = self.names.join(", ");
        match self.unread.iter().find(|(name, _)| name == header) {
            Some((_, why)) => format!("`{header}` cannot be read: {why}; there are: {names}"),
            None => format!("there is no column `{header}`; there are: {names}"),
        }
    }

    /// The line of the header before an error; empty if it is in no line.
    pub fn at_header(&self) -> String {
        match self.header_line {
            0 => String::new(),
            line => format!("line {line}: "),
        }
    }
}

/// The number in a cell, or an error with its content.
pub fn number(
    decimal: Decimal,
    (line, cells): (u64, &[String]),
    (place, header): (usize, &str),
) -> Result<f64, String> {
    let cell = cells.get(place).map_or("", String::as_str);
    decimal.number(cell).ok_or_else(|| {
        let at = format!("line {line}, column {} `{header}`", place + 1);
        if cell.is_empty() {
            format!("{at}: empty")
        } else if let Some(date) = cell.strip_prefix(workbook::DATE) {
            format!("{at}: a date or time, stored as `{date}`: give the cell the format of a number")
        } else {
            format!("{at}: `{cell}` is not a number")
        }
    })
}

/// A number as in a file with decimal points; reading it gives the same number.
pub(super) fn written(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < 9e15 {
        return (number as i64).to_string();
    }
    // Small and large numbers have an exponent.
    format!("{number:?}")
}

fn decoded(bytes: &[u8], encoding: Option<Encoding>, notes: &mut Vec<String>) -> Result<String, MeasuredFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let latin = || bytes.iter().map(|b| char::from(*b)).collect::<String>();
    match (encoding, std::str::from_utf8(bytes)) {
        (Some(Encoding::Latin1), _) => Ok(latin()),
        (_, Ok(text)) => Ok(text.to_owned()),
        (None, Err(_)) => {
            notes.push("read as Latin-1, because it is not UTF-8".to_owned());
            Ok(latin())
        }
        (Some(Encoding::Utf8), Err(e)) => Err(fault(
            format!("byte {} is not UTF-8", e.valid_up_to() + 1),
            "write `encoding: latin1`, or convert the file",
        )),
    }
}

/// The most frequent separator of the header; a semicolon or tabulator has priority over commas, which may be decimal.
fn separator(header: &str) -> Separator {
    let count = |c: char| header.chars().filter(|x| *x == c).count();
    if count(';') > 0 {
        Separator::Semicolon
    } else if count('\t') > 0 {
        Separator::Tab
    } else {
        Separator::Comma
    }
}

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

fn is_unit(cell: &str) -> bool {
    let bare = cell.trim_start_matches(['[', '(']).trim_end_matches([']', ')']);
    matches!(bare, "" | "-" | "1") || Unit::read(bare).is_some()
}

/// Line of a record; its position includes the comments and empty lines before it.
fn line_of(text: &str, at: &csv::Position) -> u64 {
    let rest = usize::try_from(at.byte()).ok().and_then(|byte| text.get(byte..));
    let skipped = rest.unwrap_or_default().lines();
    at.line()
        + skipped
            .take_while(|line| line.is_empty() || line.starts_with('#'))
            .count() as u64
}

/// Reads the cells of a file and notes the detected format. The content decides what it is: a workbook, an MDF file, or else a text.
///
/// # Errors
/// The first error with its line.
pub fn table(bytes: &[u8], form: Form<'_>, notes: &mut Vec<String>) -> Result<Table, MeasuredFault> {
    let (is_workbook, is_mdf) = (workbook::is_workbook(bytes), mdf::is_mdf(bytes));
    let (unused, what) = if is_workbook || is_mdf {
        let stated = [
            ("separator", form.separator.is_some()),
            ("encoding", form.encoding.is_some()),
            ("decimal", is_mdf && form.decimal.is_some()),
            ("sheet", is_mdf && form.sheet.is_some()),
            ("group", is_workbook && form.group.is_some()),
        ];
        (stated.to_vec(), if is_mdf { "an MDF file" } else { "a workbook" })
    } else {
        let stated = [("sheet", form.sheet.is_some()), ("group", form.group.is_some())];
        (stated.to_vec(), "a text file (CSV)")
    };
    if let Some((key, _)) = unused.into_iter().find(|(_, stated)| *stated) {
        return Err(MeasuredFault {
            place: FaultPlace::Entry(key.to_owned()),
            message: format!("{what} has no `{key}`"),
            help: format!("delete `{key}`"),
        });
    }
    if is_workbook {
        of_workbook(bytes, form, notes)
    } else if is_mdf {
        mdf::table(bytes, form.group, notes)
    } else {
        of_text(bytes, form, notes)
    }
}

/// The cells of a sheet. Rows that begin with `#` are comments, as in texts.
fn of_workbook(bytes: &[u8], form: Form<'_>, notes: &mut Vec<String>) -> Result<Table, MeasuredFault> {
    let sheet = workbook::sheet(bytes, form.sheet, notes)?;
    let part = format!("sheet `{}`", sheet.name);
    let mut rows = sheet.rows;
    rows.retain(|(_, cells)| {
        !cells
            .iter()
            .find(|cell| !cell.is_empty())
            .is_some_and(|cell| cell.starts_with('#'))
    });
    if form.decimal == Some(Decimal::Comma) {
        // Numbers that are stored as texts; others have a point in any language of the spreadsheet.
        let texts = rows
            .iter_mut()
            .flat_map(|(_, cells)| cells)
            .filter(|cell| cell.contains(','));
        texts.for_each(|cell| {
            if Decimal::Comma.number(cell).is_some() {
                *cell = cell.replace(',', ".");
            }
        });
    }
    let in_part = |wrong: MeasuredFault| MeasuredFault {
        message: format!("{part}: {}", wrong.message),
        ..wrong
    };
    let headed = headed(rows, notes, "delete it, or give its column a header").map_err(in_part)?;
    Ok(Table {
        part: Some(part),
        ..headed
    })
}

fn of_text(bytes: &[u8], form: Form<'_>, notes: &mut Vec<String>) -> Result<Table, MeasuredFault> {
    let text = decoded(bytes, form.encoding, notes)?;
    let Some(first) = text
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))
    else {
        return Err(fault("the file is empty", "choose another file"));
    };
    let separator = form.separator.unwrap_or_else(|| {
        let found = separator(first);
        if found != Separator::Comma {
            notes.push(format!(
                "cells separated by `{}`",
                char::from(found.byte()).escape_default()
            ));
        }
        found
    });
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator.byte())
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(e.to_string(), "check quotes and separators"))?;
        let line = record.position().map_or(0, |at| line_of(&text, at));
        if record.iter().all(str::is_empty) {
            continue;
        }
        rows.push((line, record.iter().map(str::to_owned).collect()));
    }
    let help = "if a decimal comma splits numbers, state `separator` or quote such cells";
    let headed = headed(rows, notes, help)?;
    Ok(Table {
        decimal: decimal(&headed.rows, form, notes)?,
        ..headed
    })
}

/// Takes the header and a row of units from the rows. `too_long` is the help for a row with more cells than the header.
fn headed(mut rows: Vec<(u64, Vec<String>)>, notes: &mut Vec<String>, too_long: &str) -> Result<Table, MeasuredFault> {
    if rows.is_empty() {
        return Err(fault("the file is empty", "choose another file"));
    }
    let (header_line, header) = rows.remove(0);
    let (names, mut units): (Vec<String>, Vec<Option<String>>) = header.iter().map(|h| name_and_unit(h)).unzip();
    // A row of units: every cell is a unit, and at least one is not a number.
    let numeric = |cell: &String| cell.replace(',', ".").parse::<f64>().is_ok();
    let unit_row = rows.first().is_some_and(|(_, cells)| {
        cells.iter().all(|c| is_unit(c)) && cells.iter().any(|c| !c.is_empty() && !numeric(c))
    });
    if unit_row {
        let (line, cells) = rows.remove(0);
        notes.push(format!("units in line {line}"));
        for (unit, cell) in units.iter_mut().zip(&cells) {
            let bare = cell.trim_start_matches(['[', '(']).trim_end_matches([']', ')']);
            if !bare.is_empty() {
                *unit = Some(bare.to_owned());
            }
        }
    }
    for (line, cells) in &rows {
        if cells.len() > names.len() {
            return Err(fault(
                format!("line {line}: {} cells, but the header has {}", cells.len(), names.len()),
                too_long,
            ));
        }
    }
    Ok(Table {
        part: None,
        unread: Vec::new(),
        decimal: Decimal::Point,
        names,
        units,
        header_line,
        rows,
    })
}

/// The decimal sign: a comma if numbers contain commas and none contains a point.
fn decimal(rows: &[(u64, Vec<String>)], form: Form<'_>, notes: &mut Vec<String>) -> Result<Decimal, MeasuredFault> {
    if let Some(stated) = form.decimal {
        return Ok(stated);
    }
    let digits = |cell: &str, sign: char| {
        cell.contains(sign)
            && cell
                .chars()
                .all(|c| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+' | 'e' | 'E'))
    };
    let with = |sign: char| {
        let cells = rows
            .iter()
            .flat_map(|(line, cells)| cells.iter().map(move |c| (*line, c)));
        cells
            .into_iter()
            .find(|(_, cell)| digits(cell, sign))
            .map(|(line, _)| line)
    };
    match (with(','), with('.')) {
        (Some(comma), Some(point)) => Err(fault(
            format!("line {comma} has a decimal comma and line {point} a decimal point"),
            "state `decimal: comma` or `decimal: point`, and write numbers without thousands separators",
        )),
        (Some(_), None) => {
            notes.push("decimal comma".to_owned());
            Ok(Decimal::Comma)
        }
        _ => Ok(Decimal::Point),
    }
}
