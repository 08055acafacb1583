//! The cells of a sheet of an Excel workbook (`.xlsx`, `.xlsm`; ECMA-376 part 1, SpreadsheetML).
//!
//! Formulas have the values that the program stored with them. Numbers with a format of dates or times are no numbers here: they
//! count days, which a column of seconds would silently take for its own.

mod formats;

use std::collections::BTreeMap;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::numbers::{GROUP_SIGNS, NumberStyle};
use super::{MeasuredFault, fault};
use crate::archive::{Archive, ArchiveFault};
use crate::did_you_mean;

/// Longest part of a workbook that is unpacked. \[byte\]
const LONGEST_PART: u64 = 256 << 20;
/// Most files in a workbook.
const MOST_ENTRIES: usize = 10_000;
/// Most cells of a sheet, with the empty ones before the last of a row.
const MOST_CELLS: usize = 10_000_000;
/// Longest text of all cells of a sheet: one text may be in every cell. \[byte\]
const LONGEST_TEXTS: usize = 256 << 20;
/// Rows and columns of a sheet.
const SHEET_SIZE: (u64, usize) = (1_048_576, 16_384);

/// Begins the text of a cell that is a date or a time of day.
pub const DATE: &str = "date or time ";

/// Help for a workbook that is damaged or unusual.
const SAVE: &str = "open it in a spreadsheet and save it as .xlsx, or export the sheet as CSV";

/// The cells of a sheet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SheetCells {
    /// Name of the sheet.
    pub name: String,
    /// Cells of each row that is not empty, with the number of the row.
    pub rows: Vec<(u64, Vec<String>)>,
}

/// True if these bytes are a file of a spreadsheet: a workbook, or a format that is refused with a reason.
pub fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || is_old(bytes)
}

/// Container of `.xls` files and of encrypted workbooks.
fn is_old(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")
}

/// Reads the cells of the sheet of this name, or of the first visible one, and notes which if there are several. `texts` states how numbers
/// are written that are stored as texts.
///
/// # Errors
/// If it is no workbook, is damaged or beyond limits, or has no such sheet.
pub fn sheet(
    bytes: &[u8],
    wanted: Option<&str>,
    texts: Option<NumberStyle>,
    notes: &mut Vec<String>,
) -> Result<SheetCells, MeasuredFault> {
    if is_old(bytes) {
        return Err(fault(
            "an Excel file of the old format (.xls), or with a password",
            SAVE,
        ));
    }
    let archive = Archive::open(bytes, MOST_ENTRIES).map_err(|wrong| damaged("the workbook", &wrong))?;
    let part = |name: &str| -> Result<Option<String>, MeasuredFault> {
        let Some(entry) = archive.find(name) else {
            return Ok(None);
        };
        let content = archive
            .unpack(entry, LONGEST_PART)
            .map_err(|wrong| damaged(name, &wrong))?;
        let text = String::from_utf8(content).map_err(|_| fault(format!("`{name}` is not UTF-8 text"), SAVE))?;
        Ok(Some(text))
    };
    let links =
        |name: &str| -> Result<Vec<Link>, MeasuredFault> { part(name)?.map_or(Ok(Vec::new()), |t| targets(&t)) };
    let book = links("_rels/.rels")?;
    let book = book.iter().find(|link| link.kind == "officeDocument");
    let book = book.map_or("xl/workbook.xml".to_owned(), |link| inside("", &link.target));
    let Some(text) = part(&book)? else {
        return Err(no_workbook(&archive));
    };
    let (folder, file) = book.rsplit_once('/').unwrap_or(("", &book));
    let links = links(&inside(folder, &format!("_rels/{file}.rels")))?;
    let sheets = sheets(&text, &links)?;
    let sheet = chosen(&sheets, wanted, notes)?;
    let of_kind = |kind: &str| -> Result<Option<String>, MeasuredFault> {
        let link = links.iter().find(|link| link.kind == kind);
        link.map_or(Ok(None), |link| part(&inside(folder, &link.target)))
    };
    let shared = of_kind("sharedStrings")?.map_or(Ok(Vec::new()), |text| shared_texts(&text))?;
    let dates = of_kind("styles")?.map_or(Ok(Vec::new()), |text| formats::dates(&text))?;
    let place = inside(folder, &sheet.target);
    let Some(text) = part(&place)? else {
        return Err(fault(format!("the workbook lacks `{place}`"), SAVE));
    };
    let reader = SheetReader {
        shared: &shared,
        dates: &dates,
        texts,
        rows: Vec::new(),
        filled: 0,
        bytes: 0,
    };
    Ok(SheetCells {
        name: sheet.name.clone(),
        rows: reader.read(&text, &sheet.name)?,
    })
}

fn damaged(what: &str, wrong: &ArchiveFault) -> MeasuredFault {
    fault(format!("{what} cannot be unpacked: {wrong}"), SAVE)
}

fn no_workbook(archive: &Archive<'_>) -> MeasuredFault {
    let has = |end: &str| archive.entries.iter().any(|(name, _)| name.ends_with(end));
    let what = if has("workbook.bin") {
        "a binary workbook (.xlsb)"
    } else if archive.find("mimetype").is_some() && has("content.xml") {
        "an OpenDocument file (.ods)"
    } else {
        return fault(
            "a zip archive without a workbook",
            "unpack it, and name the file with the data",
        );
    };
    fault(what, SAVE)
}

/// A reference of a part to another.
struct Link {
    id: String,
    /// Last word of its type.
    kind: String,
    target: String,
}

struct SheetLink {
    name: String,
    visible: bool,
    target: String,
}

/// Path of a target in the archive.
fn inside(folder: &str, target: &str) -> String {
    let absolute = target.strip_prefix('/');
    let mut parts: Vec<&str> = match absolute {
        Some(_) => Vec::new(),
        None => folder.split('/').filter(|part| !part.is_empty()).collect(),
    };
    for part in absolute.unwrap_or(target).split('/') {
        match part {
            "." | "" => {}
            ".." => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Passes each start, end and text of a part to a function.
fn walk<'a>(text: &'a str, mut each: impl FnMut(Event<'a>) -> Result<(), MeasuredFault>) -> Result<(), MeasuredFault> {
    let mut reader = Reader::from_str(text.strip_prefix('\u{feff}').unwrap_or(text));
    reader.config_mut().expand_empty_elements = true;
    loop {
        match reader.read_event() {
            Ok(Event::Eof) => return Ok(()),
            Ok(Event::DocType(_)) => return Err(fault("the workbook has a document type declaration", SAVE)),
            Ok(event) => each(event)?,
            Err(wrong) => {
                return Err(fault(format!("the workbook is damaged: {wrong}"), SAVE));
            }
        }
    }
}

/// An attribute by its name without prefix.
fn attribute(element: &BytesStart<'_>, name: &str) -> Option<String> {
    let found = element
        .attributes()
        .flatten()
        .find(|attribute| attribute.key.local_name().into_inner() == name);
    Some(found?.normalized_value(XmlVersion::Implicit1_0).ok()?.into_owned())
}

/// Appends the characters of a text event.
pub(super) fn append(event: &Event<'_>, text: &mut String) {
    match event {
        Event::Text(piece) => text.push_str(&piece.xml10_content()),
        Event::CData(piece) => text.push_str(&piece.xml10_content()),
        Event::GeneralRef(reference) => match reference.resolve_char_ref() {
            Ok(Some(letter)) => text.push(letter),
            _ => text.push_str(match &*reference.xml10_content() {
                "amp" => "&",
                "lt" => "<",
                "gt" => ">",
                "quot" => "\"",
                "apos" => "'",
                _ => "",
            }),
        },
        _ => {}
    }
}

fn targets(text: &str) -> Result<Vec<Link>, MeasuredFault> {
    let mut links = Vec::new();
    walk(text, |event| {
        if let Event::Start(element) = &event
            && element.local_name().into_inner() == "Relationship"
        {
            let [id, kind, target] = ["Id", "Type", "Target"].map(|name| attribute(element, name).unwrap_or_default());
            let kind = kind.rsplit('/').next().unwrap_or_default().to_owned();
            links.push(Link { id, kind, target });
        }
        Ok(())
    })?;
    Ok(links)
}

/// The worksheets in the order of their tabs; sheets of charts have no cells.
fn sheets(text: &str, links: &[Link]) -> Result<Vec<SheetLink>, MeasuredFault> {
    let worksheets = links.iter().filter(|link| link.kind == "worksheet");
    let worksheets: BTreeMap<&str, &str> = worksheets
        .map(|link| (link.id.as_str(), link.target.as_str()))
        .collect();
    let mut sheets = Vec::new();
    walk(text, |event| {
        if let Event::Start(element) = &event
            && element.local_name().into_inner() == "sheet"
            && sheets.len() < MOST_ENTRIES
        {
            let id = attribute(element, "id").unwrap_or_default();
            let target = worksheets.get(id.as_str());
            sheets.extend(target.map(|target| SheetLink {
                name: attribute(element, "name").unwrap_or_default(),
                visible: attribute(element, "state").is_none_or(|state| state == "visible"),
                target: (*target).to_owned(),
            }));
        }
        Ok(())
    })?;
    Ok(sheets)
}

fn chosen<'a>(
    sheets: &'a [SheetLink],
    wanted: Option<&str>,
    notes: &mut Vec<String>,
) -> Result<&'a SheetLink, MeasuredFault> {
    let names = || {
        sheets
            .iter()
            .map(|sheet| format!("`{}`", sheet.name))
            .collect::<Vec<_>>()
    };
    if let Some(wanted) = wanted {
        return sheets.iter().find(|sheet| sheet.name == wanted).ok_or_else(|| {
            let close = did_you_mean(wanted, sheets.iter().map(|sheet| sheet.name.as_str()));
            MeasuredFault::new(
                "sheet",
                format!("there is no sheet `{wanted}`; there are: {}", names().join(", ")),
                close.map_or("choose one of them".to_owned(), |close| {
                    format!("write `sheet: {close}`")
                }),
            )
        });
    }
    let first = sheets.iter().find(|sheet| sheet.visible).or(sheets.first());
    let first = first.ok_or_else(|| fault("the workbook has no sheet with cells", SAVE))?;
    if sheets.len() > 1 {
        let others: Vec<String> = names()
            .into_iter()
            .filter(|name| *name != format!("`{}`", first.name))
            .collect();
        notes.push(format!(
            "sheet `{}` is read; `sheet` chooses another: {}",
            first.name,
            others.join(", ")
        ));
    }
    Ok(first)
}

/// The texts that cells refer to by number. Phonetic hints are no part of them.
fn shared_texts(text: &str) -> Result<Vec<String>, MeasuredFault> {
    let mut texts = Vec::new();
    let (mut current, mut in_text, mut hint) = (String::new(), false, false);
    walk(text, |event| {
        match &event {
            Event::Start(element) => match element.local_name().into_inner() {
                "si" => current.clear(),
                "rPh" => hint = true,
                "t" => in_text = !hint,
                _ => {}
            },
            Event::End(element) => match element.local_name().into_inner() {
                "si" => {
                    if texts.len() == MOST_CELLS {
                        return Err(too_many("texts"));
                    }
                    texts.push(std::mem::take(&mut current));
                }
                "rPh" => hint = false,
                "t" => in_text = false,
                _ => {}
            },
            other if in_text => append(other, &mut current),
            _ => {}
        }
        Ok(())
    })?;
    Ok(texts)
}

fn too_many(what: &str) -> MeasuredFault {
    fault(
        format!("the sheet has more than {MOST_CELLS} {what}"),
        "export the columns that are used as CSV",
    )
}

/// Reads the rows of a sheet.
struct SheetReader<'a> {
    shared: &'a [String],
    /// Whether each format of cells is that of a date.
    dates: &'a [bool],
    /// How numbers are written that are stored as texts, if that is stated.
    texts: Option<NumberStyle>,
    rows: Vec<(u64, Vec<String>)>,
    /// Number of cells so far.
    filled: usize,
    /// Length of all texts so far.
    bytes: usize,
}

/// A cell while it is read.
#[derive(Default)]
struct Cell {
    column: usize,
    kind: String,
    is_date: bool,
    text: String,
}

impl SheetReader<'_> {
    fn read(mut self, text: &str, name: &str) -> Result<Vec<(u64, Vec<String>)>, MeasuredFault> {
        let (mut row, mut column) = (0, 0);
        let mut cell: Option<Cell> = None;
        let (mut in_value, mut hint) = (false, false);
        let at_fault = |place: &str| fault(format!("sheet `{name}`: `{place}` is no place of a sheet"), SAVE);
        walk(text, |event| {
            match &event {
                Event::Start(element) => match element.local_name().into_inner() {
                    "row" => {
                        let stated = attribute(element, "r");
                        row = match stated {
                            Some(text) => text.parse().map_err(|_| at_fault(&text))?,
                            None => row + 1,
                        };
                        if row == 0 || row > SHEET_SIZE.0 {
                            return Err(at_fault(&row.to_string()));
                        }
                        column = 0;
                        self.rows.push((row, Vec::new()));
                    }
                    "c" => {
                        if let Some(place) = attribute(element, "r") {
                            column = column_of(&place).ok_or_else(|| at_fault(&place))?;
                        }
                        if column >= SHEET_SIZE.1 {
                            return Err(at_fault(&format!("column {}", column + 1)));
                        }
                        let style = attribute(element, "s")
                            .and_then(|s| s.parse::<usize>().ok())
                            .unwrap_or(0);
                        cell = Some(Cell {
                            column,
                            kind: attribute(element, "t").unwrap_or_default(),
                            is_date: self.dates.get(style).copied().unwrap_or(false),
                            text: String::new(),
                        });
                    }
                    "v" => in_value = true,
                    "rPh" => hint = true,
                    "t" => in_value = !hint,
                    _ => {}
                },
                Event::End(element) => match element.local_name().into_inner() {
                    "c" => {
                        column += 1;
                        if let Some(cell) = cell.take() {
                            self.place(cell)?;
                        }
                    }
                    "v" | "t" => in_value = false,
                    "rPh" => hint = false,
                    _ => {}
                },
                other if in_value => {
                    if let Some(cell) = &mut cell {
                        append(other, &mut cell.text);
                    }
                }
                _ => {}
            }
            Ok(())
        })?;
        self.rows.retain(|(_, cells)| !cells.iter().all(String::is_empty));
        Ok(self.rows)
    }

    fn place(&mut self, cell: Cell) -> Result<(), MeasuredFault> {
        let text = self.text(&cell);
        let Some((_, cells)) = self.rows.last_mut() else {
            return Ok(());
        };
        // A formatted empty cell is no cell.
        if text.is_empty() && cell.column >= cells.len() {
            return Ok(());
        }
        if cell.column >= cells.len() {
            self.filled += cell.column + 1 - cells.len();
            if self.filled > MOST_CELLS {
                return Err(too_many("cells"));
            }
            cells.resize(cell.column + 1, String::new());
        }
        self.bytes += text.len();
        if self.bytes > LONGEST_TEXTS {
            return Err(fault(
                format!("the texts of the sheet have more than {} MB", LONGEST_TEXTS >> 20),
                "export the columns that are used as CSV",
            ));
        }
        cells[cell.column] = text;
        Ok(())
    }

    /// The text of a cell as it would be in a CSV file with decimal points.
    fn text(&self, cell: &Cell) -> String {
        let text = cell.text.trim();
        match cell.kind.as_str() {
            "s" => {
                let shared = text.parse::<usize>().ok().and_then(|number| self.shared.get(number));
                shared.map_or_else(String::new, |text| self.number_in(text.trim()))
            }
            "b" => if text == "1" { "TRUE" } else { "FALSE" }.to_owned(),
            "d" => format!("{DATE}{text}"),
            "str" | "inlineStr" => self.number_in(text),
            // `#N/A` alone would begin a comment.
            "e" => format!("error {text}"),
            _ if text.is_empty() => String::new(),
            _ if cell.is_date => format!("{DATE}{text}"),
            _ => match text.parse::<f64>() {
                Ok(number) if number.is_finite() => super::numbers::written(number),
                _ => text.to_owned(),
            },
        }
    }
}

impl SheetReader<'_> {
    /// A text, with a decimal point if it is a number that is written otherwise.
    fn number_in(&self, text: &str) -> String {
        let is_signed = text.contains([',', '.']) || text.contains(GROUP_SIGNS);
        let plain = self.texts.filter(|_| is_signed).and_then(|style| style.plain(text));
        plain.unwrap_or_else(|| text.to_owned())
    }
}

/// Index of the column of a place such as `B3`.
fn column_of(place: &str) -> Option<usize> {
    let letters = place.trim_end_matches(|c: char| c.is_ascii_digit());
    if letters.is_empty() || letters.len() > 3 {
        return None;
    }
    let number = letters.chars().try_fold(0, |sum, letter| {
        let letter = letter.to_ascii_uppercase();
        letter
            .is_ascii_uppercase()
            .then(|| sum * 26 + (letter as usize - 'A' as usize + 1))
    });
    Some(number? - 1)
}

#[cfg(test)]
mod tests;
