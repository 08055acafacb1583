//! The columns of a file with requested quantities.

use super::cells::{Form, Table, number, table};
use super::{MeasuredFault, StatedUnit, fault, greatest, scale};
use crate::{Ordered, did_you_mean};

/// A quantity of a file: name and documented unit, which is empty for texts.
pub type Wanted<'a> = (&'a str, &'a str);

/// Maximum number of reported errors of one kind.
pub const TOLD: usize = 5;

struct Column {
    place: usize,
    header: String,
    /// Factor and offset to SI; absent for texts.
    unit: Option<(f64, f64)>,
    /// Largest amount, SI.
    greatest: f64,
}

/// Where a study says which columns are which quantities, and in which units.
#[derive(Clone, Copy, Default)]
pub struct Assigned<'a> {
    /// Column of each quantity.
    pub columns: Option<&'a Ordered<String>>,
    /// Unit of each quantity.
    pub units: Option<&'a Ordered<String>>,
    /// Whether these units have precedence over different ones of the file.
    pub units_override: bool,
}

/// A table with the columns of the requested quantities.
pub struct Sheet {
    /// All cells.
    pub table: Table,
    /// Notes on the detected format.
    pub notes: Vec<String>,
    columns: Vec<Option<Column>>,
}

impl Sheet {
    /// Reads the bytes and finds a column for each requested quantity: the one given in `columns`, or the one with the same name.
    pub fn open(
        bytes: &[u8],
        form: Form<'_>,
        wanted: &[Wanted],
        assigned: Assigned<'_>,
    ) -> Result<Self, Vec<MeasuredFault>> {
        let mut notes = Vec::new();
        let table = table(bytes, form, &mut notes).map_err(|f| vec![f])?;
        let none = Ordered::default();
        let (columns, units) = (assigned.columns.unwrap_or(&none), assigned.units.unwrap_or(&none));
        let mut found = Vec::new();
        for key in columns.ids().chain(units.ids()) {
            if wanted.iter().all(|(name, _)| *name != key) {
                let all: Vec<&str> = wanted.iter().map(|(name, _)| *name).collect();
                let list = format!("the quantities are {}", all.join(", "));
                let help = match did_you_mean(key, all.iter().copied()) {
                    Some(close) => format!("write `{close}`; {list}"),
                    None => list,
                };
                found.push(fault(format!("`{key}` is not a quantity of this file"), help));
            }
        }
        let mut places = Vec::new();
        for (name, due) in wanted {
            let written = columns.get(name);
            let header = written.map_or(*name, String::as_str);
            // A column that is assigned to another quantity is not used by its own name.
            let taken = written.is_none() && columns.iter().any(|(_, column)| column == name);
            let place = table.names.iter().position(|n| n == header).filter(|_| !taken);
            let column = place.and_then(|place| {
                let stated = StatedUnit {
                    study: units.get(name).map(String::as_str),
                    file: table.units[place].as_deref(),
                    overrides: assigned.units_override,
                };
                let unit = if due.is_empty() {
                    None
                } else {
                    match scale((name, due), stated, header) {
                        Ok(unit) => {
                            notes.extend(overridden(stated, header));
                            Some(unit)
                        }
                        Err(f) => {
                            let message = format!("{}{}", table.at_header().replace(": ", ", "), f.message);
                            found.push(fault(message, f.help));
                            return None;
                        }
                    }
                };
                Some(Column {
                    place,
                    header: header.to_owned(),
                    unit,
                    greatest: greatest(due),
                })
            });
            if let (Some(header), true) = (written, !table.names.contains(&header.to_owned())) {
                found.push(fault(
                    format!("{}{}", table.at_header(), table.lacks(header)),
                    match did_you_mean(header, table.names.iter().map(String::as_str)) {
                        Some(close) => format!("write `{close}`"),
                        None => "choose one of them".to_owned(),
                    },
                ));
            }
            places.push(column);
        }
        if found.is_empty() {
            Ok(Self {
                table,
                notes,
                columns: places,
            })
        } else {
            Err(table.placed(found))
        }
    }

    /// True if the file contains the requested quantity of this index.
    pub fn holds(&self, wanted: usize) -> bool {
        self.columns[wanted].is_some()
    }

    /// A number of a row; absent if the file has no such column.
    pub fn number(&self, row: usize, wanted: usize) -> Result<Option<f64>, String> {
        let Some(column) = &self.columns[wanted] else {
            return Ok(None);
        };
        let (line, cells) = &self.table.rows[row];
        let number = number(self.table.decimal, (*line, cells), (column.place, &column.header))?;
        let (factor, offset) = column.unit.unwrap_or((1.0, 0.0));
        let number = number * factor + offset;
        if number.abs() > column.greatest * (1.0 + 1e-12) {
            return Err(format!(
                "{}: `{}` is unrealistically large",
                self.describe_cell(row, wanted),
                self.text(row, wanted).unwrap_or_default()
            ));
        }
        Ok(Some(number))
    }

    /// As [`Sheet::number`]; a negative number is an error.
    pub fn not_negative(&self, row: usize, wanted: usize) -> Result<Option<f64>, String> {
        let number = self.number(row, wanted)?;
        if number.is_some_and(|x| x < 0.0) {
            return Err(format!(
                "{}: `{}` is negative",
                self.describe_cell(row, wanted),
                self.text(row, wanted).unwrap_or_default()
            ));
        }
        Ok(number)
    }

    /// As [`Sheet::number`]; a temperature outside -60 to 250 degC is an error. \[degC\]
    pub fn temperature(&self, row: usize, wanted: usize) -> Result<Option<f64>, String> {
        let number = self.number(row, wanted)?;
        if number.is_some_and(|t| !(-60.0..=250.0).contains(&t)) {
            return Err(format!(
                "{}: `{}` is outside -60 to 250 degC",
                self.describe_cell(row, wanted),
                self.text(row, wanted).unwrap_or_default()
            ));
        }
        Ok(number)
    }

    /// A text of a row; absent if the file has no such column or the cell is empty.
    pub fn text(&self, row: usize, wanted: usize) -> Option<&str> {
        let column = self.columns[wanted].as_ref()?;
        let cell = self.table.rows[row].1.get(column.place)?;
        (!cell.is_empty()).then_some(cell.as_str())
    }

    /// Line and column as text.
    pub fn describe_cell(&self, row: usize, wanted: usize) -> String {
        let line = self.line(row);
        self.columns[wanted].as_ref().map_or_else(
            || format!("line {line}"),
            |c| format!("line {line}, column {} `{}`", c.place + 1, c.header),
        )
    }

    /// Line of a row.
    pub fn line(&self, row: usize) -> u64 {
        self.table.rows[row].0
    }

    /// The error that no column contains a required quantity.
    pub fn lacks(&self, what: &str, name: &str) -> MeasuredFault {
        fault(
            format!(
                "{}there is no column for {what}; there are: {}",
                self.table.at_header(),
                self.table.names.join(", ")
            ),
            format!("state one under `columns: {{ {name}: ... }}`"),
        )
    }
}

/// The note that the study replaces the unit of a column.
pub fn overridden(unit: StatedUnit<'_>, header: &str) -> Option<String> {
    let (study, file) = (unit.study?, unit.file?);
    let is_overridden = unit.is_overridden();
    is_overridden.then(|| format!("column `{header}` is read in {study}, not in {file} as the file states"))
}

/// One error for each of the first messages, and the number of further ones.
pub fn limited_faults(messages: Vec<String>, help: &str) -> Vec<MeasuredFault> {
    let beyond = messages.len().saturating_sub(TOLD);
    let mut faults: Vec<_> = messages.into_iter().take(TOLD).map(|m| fault(m, help)).collect();
    if let (Some(last), 1..) = (faults.last_mut(), beyond) {
        last.message = format!("{}; {beyond} more errors of this kind", last.message);
    }
    faults
}
