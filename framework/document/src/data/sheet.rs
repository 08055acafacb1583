//! The columns of a file with requested quantities.

use super::cells::{FoundColumn, Table, number, table};
use super::form::TableForm;
use super::{MeasuredFault, StatedUnit, fault, greatest, scale};
use crate::{Ordered, did_you_mean};

/// A quantity of a file: name and documented unit, which is empty for texts.
pub type Wanted<'a> = (&'a str, &'a str);

/// Maximum number of reported errors of one kind.
pub const TOLD: usize = 5;

struct Column {
    place: usize,
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
    /// Rows that are omitted because of stated marks of missing values, each by one of its cells.
    pub omitted: Vec<String>,
    columns: Vec<Option<Column>>,
}

impl Sheet {
    /// Reads the bytes and finds a column for each requested quantity: the one given in `columns`, or the one with the same name.
    pub fn open(
        bytes: &[u8],
        form: &TableForm,
        wanted: &[Wanted],
        assigned: Assigned<'_>,
    ) -> Result<Self, Vec<MeasuredFault>> {
        Self::open_with_axis(bytes, form, wanted, assigned, None)
    }

    /// As [`Sheet::open`], of a series over the time in a requested column, which may have dates or clock times.
    pub fn open_series(
        bytes: &[u8],
        form: &TableForm,
        wanted: &[Wanted],
        assigned: Assigned<'_>,
        time: &str,
    ) -> Result<Self, Vec<MeasuredFault>> {
        Self::open_with_axis(bytes, form, wanted, assigned, Some(time))
    }

    fn open_with_axis(
        bytes: &[u8],
        form: &TableForm,
        wanted: &[Wanted],
        assigned: Assigned<'_>,
        time: Option<&str>,
    ) -> Result<Self, Vec<MeasuredFault>> {
        let none = Ordered::default();
        let (columns, units) = (assigned.columns.unwrap_or(&none), assigned.units.unwrap_or(&none));
        let mut notes = Vec::new();
        let is_name = |header: &str| is_wanted(header, wanted, columns);
        let mut table = table(bytes, form, &is_name, &mut notes).map_err(|f| vec![f])?;
        let mut found = unknown_keys(wanted, columns, units);
        let mut places = Vec::new();
        for (name, due) in wanted {
            places.push(match find(&table, (name, due), columns, units) {
                Ok(place) => place,
                Err(fault) => {
                    found.push(fault);
                    None
                }
            });
        }
        let axis = time.and_then(|time| wanted.iter().position(|(name, _)| *name == time));
        if let Some((axis, place)) = axis.and_then(|axis| Some((axis, places[axis]?))) {
            let name = wanted[axis].0;
            match table.take_times(place, form.date_order, &mut notes) {
                Err(fault) => {
                    found.push(fault);
                    places[axis] = None;
                }
                Ok(true) if units.get(name).is_some_and(|unit| unit != "s") => {
                    let message = format!(
                        "column `{}` has dates or clock times, which have no unit",
                        table.names[place]
                    );
                    found.push(fault(message, format!("delete `{name}` from `units`")));
                }
                Ok(_) => {}
            }
        }
        let mut used: Vec<Option<Column>> = Vec::new();
        for ((name, due), place) in wanted.iter().zip(&places) {
            let Some(place) = *place else {
                used.push(None);
                continue;
            };
            let header = &table.names[place];
            let stated = StatedUnit {
                study: units.get(name).map(String::as_str),
                file: table.units[place].as_deref(),
                overrides: assigned.units_override,
            };
            let unit = if due.is_empty() {
                Ok(None)
            } else {
                scale((name, due), stated, header).map(Some)
            };
            match unit {
                Ok(unit) => {
                    notes.extend(unit.and_then(|_| overridden(stated, header)));
                    used.push(Some(Column {
                        place,
                        unit,
                        greatest: greatest(due),
                    }));
                }
                Err(f) => {
                    used.push(None);
                    found.push(fault(format!("{}{}", table.at_unit(place), f.message), f.help));
                }
            }
        }
        let numeric: Vec<usize> = used
            .iter()
            .flatten()
            .filter(|c| c.unit.is_some())
            .map(|c| c.place)
            .collect();
        let omitted = if let Some(marks) = &form.missing {
            table.omit_marked(&numeric, marks)
        } else {
            found.extend(numeric.iter().filter_map(|place| table.unstated_mark(*place)));
            Vec::new()
        };
        found.extend(table.segments());
        if !found.is_empty() {
            return Err(table.placed(found));
        }
        if let Some(first) = omitted.first() {
            notes.push(format!(
                "{} rows with missing values omitted: {first}{}",
                omitted.len(),
                match omitted.len() {
                    1 => "",
                    _ => "; ...",
                }
            ));
        }
        Ok(Self {
            table,
            notes,
            omitted,
            columns: used,
        })
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
        let number = number(&self.table, (*line, cells), column.place)?;
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
        self.columns[wanted]
            .as_ref()
            .map_or_else(|| format!("line {line}"), |c| self.table.describe(line, c.place))
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
                self.table.list()
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

/// True if a header is that of a requested quantity.
pub fn is_wanted(header: &str, wanted: &[Wanted], columns: &Ordered<String>) -> bool {
    wanted.iter().any(|(name, _)| match columns.get(name) {
        Some(written) => is_name_of(header, written),
        None => *name == header,
    })
}

/// True if a header has a stated name, with or without the number of `NAME#2`.
pub fn is_name_of(header: &str, stated: &str) -> bool {
    let number = stated.strip_prefix(header).and_then(|rest| rest.strip_prefix('#'));
    stated == header || number.is_some_and(|number| number.parse::<usize>().is_ok())
}

/// Errors for stated keys that are no requested quantities.
fn unknown_keys(wanted: &[Wanted], columns: &Ordered<String>, units: &Ordered<String>) -> Vec<MeasuredFault> {
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
    found
}

/// The column of a requested quantity, if the file has one.
fn find(
    table: &Table,
    (name, due): Wanted<'_>,
    columns: &Ordered<String>,
    units: &Ordered<String>,
) -> Result<Option<usize>, MeasuredFault> {
    let written = columns.get(name);
    // A column that is assigned to another quantity is not used by its own name.
    if written.is_none() && columns.iter().any(|(_, column)| is_name_of(name, column)) {
        return Ok(None);
    }
    let header = written.map_or(name, String::as_str);
    let fits = |unit: Option<&str>| {
        let stated = StatedUnit {
            file: unit,
            ..StatedUnit::default()
        };
        !due.is_empty() && units.get(name).is_none() && unit.is_some() && scale((name, due), stated, header).is_ok()
    };
    let at_header = table.at_header();
    match table.column_with_unit(header, fits) {
        FoundColumn::At(place) => Ok(Some(place)),
        FoundColumn::Several(places) => {
            let (message, help) = table.ambiguous(header, &places, name);
            Err(fault(format!("{at_header}{message}"), help))
        }
        FoundColumn::Absent if written.is_none() => Ok(None),
        FoundColumn::Absent => Err(fault(
            format!("{at_header}{}", table.lacks(header)),
            match did_you_mean(header, table.names.iter().map(String::as_str)) {
                Some(close) => format!("write `{close}`"),
                None => "choose one of them".to_owned(),
            },
        )),
    }
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
