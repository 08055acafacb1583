//! The cells of a file with their lines, and its columns.

use super::MeasuredFault;
use super::numbers::NumberStyle;
use super::workbook::DATE;

/// Most columns that a message lists, and most letters of each.
const MOST_LISTED: usize = 60;
const LONGEST_NAME: usize = 100;

/// Cells with their lines.
pub struct Table {
    /// Sheet or channel group of the file, if it has such.
    pub part: Option<String>,
    /// Headers.
    pub names: Vec<String>,
    /// Unit of each column if the header or a row of units states it.
    pub units: Vec<Option<String>>,
    /// Line in which the unit of each column is.
    pub unit_lines: Vec<u64>,
    /// Columns that the file has and that cannot be read, with the reason.
    pub unread: Vec<(String, String)>,
    /// Line of the header; zero in a file whose header is in no line.
    pub header_line: u64,
    /// Cells of each row with its line, row of the sheet, or number of the sample.
    pub rows: Vec<(u64, Vec<String>)>,
    /// How its numbers are written.
    pub numbers: NumberStyle,
    /// The first line that repeats the header, and the last line of numbers before it.
    pub repeated: Option<(u64, u64)>,
}

/// The columns of a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FoundColumn {
    /// There is none.
    Absent,
    /// The only one, or the one that `NAME#2` chooses.
    At(usize),
    /// Several, between which the name does not decide.
    Several(Vec<usize>),
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

    /// The column of a header. `NAME#2` is the second of several with the same name.
    pub fn column(&self, header: &str) -> FoundColumn {
        let of_name = |name: &str| -> Vec<usize> {
            let names = self.names.iter().enumerate();
            names
                .filter(|(_, known)| *known == name)
                .map(|(place, _)| place)
                .collect()
        };
        match of_name(header).as_slice() {
            [place] => FoundColumn::At(*place),
            [] => {
                let numbered = header.rsplit_once('#').and_then(|(name, number)| {
                    let number = number.parse::<usize>().ok()?.checked_sub(1)?;
                    of_name(name).get(number).copied()
                });
                numbered.map_or(FoundColumn::Absent, FoundColumn::At)
            }
            several => FoundColumn::Several(several.to_vec()),
        }
    }

    /// As [`Table::column`]; of several columns with the same name the only one whose unit satisfies a condition.
    pub fn column_with_unit(&self, header: &str, fits: impl Fn(Option<&str>) -> bool) -> FoundColumn {
        match self.column(header) {
            FoundColumn::Several(places) => {
                let mut fitting = places.iter().filter(|place| fits(self.units[**place].as_deref()));
                match (fitting.next(), fitting.next()) {
                    (Some(place), None) => FoundColumn::At(*place),
                    _ => FoundColumn::Several(places),
                }
            }
            found => found,
        }
    }

    /// That a name does not decide between columns, and how to choose.
    pub fn ambiguous(&self, header: &str, places: &[usize], quantity: &str) -> (String, String) {
        let what = if self.header_line == 0 { "channels" } else { "columns" };
        let numbers: Vec<String> = places.iter().map(|place| (place + 1).to_string()).collect();
        let choices: Vec<String> = (1..=places.len().min(4)).map(|i| format!("\"{header}#{i}\"")).collect();
        (
            format!("`{header}` is the name of several {what}: {}", numbers.join(", ")),
            format!(
                "choose one by its order: `columns: {{ {quantity}: {} }}`",
                choices.join("` or `")
            ),
        )
    }

    /// Names of the columns; the order is added to one that occurs several times.
    pub fn distinct_names(&self) -> Vec<String> {
        let mut counts = std::collections::BTreeMap::<&str, (usize, usize)>::new();
        for name in &self.names {
            counts.entry(name).or_default().0 += 1;
        }
        let distinct = |name: &String| match counts.get_mut(name.as_str()) {
            Some((2.., seen)) if !name.is_empty() => {
                *seen += 1;
                format!("{name}#{seen}")
            }
            _ => name.clone(),
        };
        self.names.iter().map(distinct).collect()
    }

    /// The names of the columns for messages, cut off if they are many or long.
    pub fn list(&self) -> String {
        let short = |name: &String| match name.char_indices().nth(LONGEST_NAME) {
            Some((end, _)) => format!("{}...", &name[..end]),
            None => name.clone(),
        };
        let names: Vec<String> = self.names.iter().take(MOST_LISTED).map(short).collect();
        match self.names.len().saturating_sub(MOST_LISTED) {
            0 => names.join(", "),
            more => format!("{} and {more} more", names.join(", ")),
        }
    }

    /// That there is no column of this name, and why if the file has it; with all columns.
    pub fn lacks(&self, header: &str) -> String {
        let names = self.list();
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

    /// The place of the unit of a column before an error.
    pub fn at_unit(&self, place: usize) -> String {
        match self.unit_lines[place] {
            0 => String::new(),
            line => format!("line {line}, "),
        }
    }

    /// Line and column as text.
    pub fn describe(&self, line: u64, place: usize) -> String {
        format!("line {line}, column {} `{}`", place + 1, self.names[place])
    }

    /// The error for a file whose header is repeated: it has several segments.
    pub fn segments(&self) -> Option<MeasuredFault> {
        let (line, last) = self.repeated?;
        Some(MeasuredFault::new(
            "last_line",
            format!(
                "line {line} repeats the header of line {}: the file has several segments",
                self.header_line
            ),
            format!("read the first by `last_line: {last}`, or the one below by `header_line: {line}`"),
        ))
    }
}

/// The number in a cell, or an error with its content.
pub fn number(table: &Table, (line, cells): (u64, &[String]), place: usize) -> Result<f64, String> {
    let cell = cells.get(place).map_or("", String::as_str);
    table.numbers.number(cell).ok_or_else(|| {
        let at = table.describe(line, place);
        if cell.is_empty() {
            format!("{at}: empty")
        } else if let Some(date) = cell.strip_prefix(DATE) {
            format!("{at}: a date or time, stored as `{date}`: give the cell the format of a number")
        } else {
            format!("{at}: `{cell}` is not a number")
        }
    })
}
