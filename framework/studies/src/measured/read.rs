//! Reads the files of a measurement and collects all errors.

use super::columns::{Column, Columns, Finder, KNOWN};
use super::files::MeasuredFile;
use super::text::{self, Table};
use super::{
    Accuracies, Condition, FaultPlace, FaultyRows, FileColumn, Instruments, Measured, MeasuredEntry, MeasuredFault,
    Rig, Row, TableForm, fault, steady,
};
use gearloss_document::data::cells::FoundColumn;
use gearloss_document::data::greatest;
use gearloss_document::data::sheet::is_name_of;
use gearloss_framework::document::expression::ExpressionFault;
use gearloss_framework::document::{Dimension, Unit, did_you_mean};

/// Maximum number of listed faulty cells of a file.
const LISTED: usize = 10;

/// Maximum number of listed omitted rows.
const LISTED_LEFT_OUT: usize = 5;

impl MeasuredEntry {
    /// Divisor from stated accuracies to standard deviations.
    fn divisor(&self) -> f64 {
        self.stated_as.divisor(self.coverage_factor)
    }

    fn form(&self, file: MeasuredFile<'_>) -> TableForm {
        file.entry
            .map_or_else(|| self.form.clone(), |entry| entry.form.or(&self.form))
    }

    /// Whether a header is that of a quantity, of a bound column or of the time.
    fn is_name(&self, file: MeasuredFile<'_>, bind: &[&str], header: &str) -> bool {
        let of_file = |quantity: &str| file.entry.and_then(|entry| entry.columns.get(quantity));
        let written = |quantity: &str| of_file(quantity).or_else(|| self.columns.get(quantity));
        let is_of = |quantity: &str| match written(quantity) {
            Some(column) => is_name_of(header, column.header()),
            None => header == quantity,
        };
        KNOWN.iter().any(|known| is_of(known.name))
            || bind.iter().any(|name| is_of(name))
            || self
                .steady
                .as_ref()
                .is_some_and(|steady| is_name_of(header, &steady.time))
    }

    /// Reads the bytes of its single file. `bind` lists columns that change the gearbox.
    ///
    /// # Errors
    /// All errors, with line and column.
    pub fn read(&self, bytes: &[u8], bind: &[&str]) -> Result<Measured, Vec<MeasuredFault>> {
        self.read_files(&[bytes], bind, &[])
    }

    /// Reads the bytes of its files in order. `bind` lists columns that change the gearbox; `elsewhere` lists columns that other analyses
    /// bind, which may also be stated here.
    ///
    /// # Errors
    /// All errors, with file, line and column.
    pub fn read_files(
        &self,
        contents: &[impl AsRef<[u8]>],
        bind: &[&str],
        elsewhere: &[&str],
    ) -> Result<Measured, Vec<MeasuredFault>> {
        let mut faults = self.unknown_quantities(bind, elsewhere);
        let accuracies = Accuracies::new(&self.accuracies).unwrap_or_else(|list| {
            faults.extend(list);
            Accuracies::default()
        });
        if self.rig.oil_temperature.is_some() && self.accuracies.oil_temperature.is_some() {
            faults.push(MeasuredFault::new(
                "accuracies.oil_temperature",
                "the accuracy of the oil temperature is stated twice, here and under `rig`",
                "delete one of them",
            ));
        }
        if let Some(steady) = &self.steady {
            faults.extend(steady.faults());
        }
        let constants = self.constants_in_si(&mut faults);
        let condition = match self.rows.as_deref().map(Condition::parse) {
            Some(Err(wrong)) => {
                faults.push(wrong_rows(wrong));
                None
            }
            condition => condition.and_then(Result::ok),
        };
        let files = self.file.list();
        for (i, file) in files.iter().enumerate() {
            if files[..i].iter().any(|other| other.name == file.name) {
                faults.push(MeasuredFault::new(
                    format!("file.{i}"),
                    format!("`{}` is listed twice", file.name),
                    "list every file once; `{ file: ..., name: ... }` distinguishes files of the same name",
                ));
            }
        }
        let mut measured = Measured {
            files: files.iter().map(|file| file.name.to_owned()).collect(),
            divisor: self.divisor(),
            rig: Rig::from_entry(&self.rig),
            instruments: Instruments::from_entry(&self.rig, self.divisor()),
            accuracies,
            oil_temperature: self.rig.oil_temperature.map(|a| a / self.divisor()),
            ..Measured::default()
        };
        let several = files.len() > 1;
        for (i, (file, bytes)) in files.iter().zip(contents).enumerate() {
            let mut notes = Vec::new();
            let read = self.read_file(*file, bytes.as_ref(), bind, &mut notes, &mut faults);
            let read = read.map(|mut read| {
                if i == 0 {
                    measured.columns.clone_from(&read.columns);
                } else {
                    notes.extend(read.align(&measured.columns));
                }
                read
            });
            measured.notes.extend(notes.into_iter().map(|note| {
                if several {
                    format!("{}: {note}", file.name)
                } else {
                    note
                }
            }));
            let Some(ReadFile { quantities, rows, .. }) = read else {
                continue;
            };
            if i == 0 {
                measured.quantities = quantities;
            } else if quantities != measured.quantities && faults.is_empty() {
                faults.push(other_quantities(*file, i, &quantities, &measured));
            }
            measured.rows.extend(rows.into_iter().map(|row| Row { file: i, ..row }));
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        for quantity in measured.accuracies.quantities() {
            if measured.holds(&format!("{quantity}_accuracy")) {
                measured.notes.push(format!(
                    "the accuracy column is used for the {}; `accuracies` only for blank cells",
                    quantity.replace('_', " ")
                ));
            }
        }
        if measured.rows.is_empty() {
            let message = match &self.steady {
                Some(_) => format!("{}: no steady interval found", self.file),
                None => format!("{}: no points below the header", self.file),
            };
            let help = match &self.steady {
                Some(_) => "allow more drift, or use a shorter window",
                None => "check the file, its header and its separator",
            };
            return Err(vec![fault(message, help)]);
        }
        measured.add_constants(&constants)?;
        if let Some(condition) = &condition {
            measured.keep(condition).map_err(|wrong| vec![wrong])?;
        }
        measured.take_other_port();
        Ok(measured)
    }

    fn unknown_quantities(&self, bind: &[&str], elsewhere: &[&str]) -> Vec<MeasuredFault> {
        let all: Vec<&str> = KNOWN.iter().map(|k| k.name).collect();
        let timed = self.steady.is_some();
        let unknown = |key: &str, quantity: &str| {
            let known = all.contains(&quantity) || bind.contains(&quantity) || elsewhere.contains(&quantity);
            if known || (timed && quantity == "time" && key.ends_with("units")) {
                return None;
            }
            let help = match did_you_mean(quantity, all.iter().copied()) {
                Some(close) => format!("write `{close}`; the quantities are {}", all.join(", ")),
                None => format!("the quantities are {}", all.join(", ")),
            };
            let message = format!("`{quantity}` is not a measured quantity");
            Some(MeasuredFault::new(format!("{key}.{quantity}"), message, help))
        };
        let mut faults: Vec<MeasuredFault> = Vec::new();
        faults.extend(self.columns.ids().filter_map(|id| unknown("columns", id)));
        faults.extend(self.units.ids().filter_map(|id| unknown("units", id)));
        for (i, file) in self.file.list().iter().enumerate() {
            let Some(entry) = file.entry else { continue };
            let [columns, units] = ["columns", "units"].map(|section| format!("file.{i}.{section}"));
            faults.extend(entry.columns.ids().filter_map(|id| unknown(&columns, id)));
            faults.extend(entry.units.ids().filter_map(|id| unknown(&units, id)));
        }
        faults
    }

    /// The quantities and rows of one file; errors are added to the others.
    fn read_file(
        &self,
        file: MeasuredFile<'_>,
        bytes: &[u8],
        bind: &[&str],
        notes: &mut Vec<String>,
        faults: &mut Vec<MeasuredFault>,
    ) -> Option<ReadFile> {
        let form = self.form(file);
        let table = self.table(file, bytes, (&form, bind), notes);
        let table = match table {
            Ok(table) => table,
            Err(wrong) => {
                let message = format!("{}: {}", file.name, wrong.message);
                faults.push(MeasuredFault { message, ..wrong });
                return None;
            }
        };
        let mut finder = Finder {
            entry: self,
            file,
            table: &table,
            faults: Vec::new(),
        };
        let columns = finder.columns(bind);
        if form.missing.is_none() {
            let used = columns
                .quantities
                .iter()
                .chain(columns.bound.iter().map(|bound| &bound.column));
            let marks = used
                .filter(|column| column.unit.is_some())
                .filter_map(|column| table.unstated_mark(column.place));
            let placed = marks.map(|wrong| MeasuredFault {
                message: format!("{}: {}", table.named(file.name), wrong.message),
                ..wrong
            });
            finder.faults.extend(placed);
        }
        let wrong_columns = !finder.faults.is_empty();
        faults.append(&mut finder.faults);
        notes.extend(columns.notes.iter().cloned());
        let rows = self.rows(&table, &columns, file, notes, faults)?;
        if wrong_columns {
            return None;
        }
        let quantities = columns.quantities.iter().filter(|c| c.unit.is_some()).map(|c| c.name);
        let quantities: Vec<&'static str> = quantities.collect();
        let rows = match (&self.steady, columns.time.is_some()) {
            (Some(steady), true) => match steady::stretches(steady, &quantities, rows) {
                Ok((rows, note)) => {
                    notes.push(note);
                    rows
                }
                Err(wrong) => {
                    let message = format!("{}: {}", table.named(file.name), wrong.message);
                    faults.push(MeasuredFault { message, ..wrong });
                    return None;
                }
            },
            _ => rows.into_iter().map(|(_, row)| row).collect(),
        };
        Some(ReadFile {
            quantities,
            columns: Self::file_columns(&table, &columns),
            rows,
        })
    }

    /// The cells of a file, with its times in seconds and without marks of missing values.
    fn table(
        &self,
        file: MeasuredFile<'_>,
        bytes: &[u8],
        (form, bind): (&TableForm, &[&str]),
        notes: &mut Vec<String>,
    ) -> Result<Table, MeasuredFault> {
        let mut table = text::table(bytes, form, &|header| self.is_name(file, bind, header), notes)?;
        // Of points without a time, the repeated header is a row to be skipped.
        if (self.steady.is_some() || self.faulty_rows != FaultyRows::Skip)
            && let Some(wrong) = table.segments()
        {
            return Err(wrong);
        }
        table.empty_marks(form.missing.as_deref().unwrap_or_default());
        if let Some(steady) = &self.steady
            && let FoundColumn::At(place) = table.column(&steady.time)
            && table.take_times(place, form.date_order, notes)?
        {
            let of_file = file.entry.and_then(|entry| entry.units.get("time"));
            if of_file
                .or_else(|| self.units.get("time"))
                .is_some_and(|unit| unit != "s")
            {
                return Err(MeasuredFault {
                    place: FaultPlace::Entry("units.time".to_owned()),
                    message: format!("column `{}` has dates or clock times, which have no unit", steady.time),
                    help: "delete `time` from `units`".to_owned(),
                });
            }
        }
        Ok(table)
    }

    /// All columns from the header.
    fn file_columns(table: &Table, columns: &Columns) -> Vec<FileColumn> {
        let column = |(place, header): (usize, String)| {
            let bound_column = columns.bound.iter().find(|bound| bound.column.place == place);
            let name = bound_column.map(|bound| bound.name.clone());
            let unit = match bound_column {
                Some(bound) => Some(bound.unit.clone()),
                None => table.units[place].clone(),
            };
            // Text in brackets is not always a unit.
            let has_dimension =
                |unit: &String| unit == "%" || Unit::read(unit).is_some_and(|u| u.dimension != Dimension::None);
            FileColumn {
                header,
                unit: unit.filter(has_dimension),
                bound: name,
                quantity: columns.quantities.iter().find(|c| c.place == place).map(|c| c.name),
            }
        };
        table.distinct_names().into_iter().enumerate().map(column).collect()
    }

    /// The rows of a file, each with its time; faulty rows are rejected together, or omitted with a note.
    fn rows(
        &self,
        table: &Table,
        columns: &Columns,
        file: MeasuredFile<'_>,
        notes: &mut Vec<String>,
        faults: &mut Vec<MeasuredFault>,
    ) -> Option<Vec<(f64, Row)>> {
        let (mut rows, mut faulty) = (Vec::new(), Vec::new());
        let (mut cells_at_fault, mut rows_at_fault) = (0, 0);
        let listed = if self.faulty_rows == FaultyRows::Skip {
            LISTED_LEFT_OUT
        } else {
            LISTED
        };
        for (line, cells) in &table.rows {
            match timed_row(*line, cells, columns, table, self.faulty_rows) {
                Ok(row) => rows.push(row),
                Err(reasons) => {
                    rows_at_fault += 1;
                    cells_at_fault += reasons.len();
                    // One reason is sufficient for an omitted row.
                    let told = if self.faulty_rows == FaultyRows::Skip {
                        1
                    } else {
                        listed
                    };
                    let room = listed.saturating_sub(faulty.len());
                    faulty.extend(reasons.into_iter().take(told.min(room)));
                }
            }
        }
        if rows_at_fault == 0 {
            return Some(rows);
        }
        let shown = faulty.join("; ");
        if self.faulty_rows == FaultyRows::Skip {
            let more = if rows_at_fault > faulty.len() { "; ..." } else { "" };
            notes.push(format!("{rows_at_fault} rows omitted: {shown}{more}"));
            return Some(rows);
        }
        let more = match cells_at_fault - faulty.len() {
            0 => String::new(),
            more => format!("; and {more} more cells"),
        };
        faults.push(fault(
            format!("{}: {shown}{more}", table.named(file.name)),
            "correct the cell, or write `faulty_rows: skip` to omit such rows; marks of missing values are stated: `missing: [-9999, \"n/a\"]`",
        ));
        None
    }
}

/// One file as read.
struct ReadFile {
    quantities: Vec<&'static str>,
    columns: Vec<FileColumn>,
    rows: Vec<Row>,
}

impl ReadFile {
    /// Aligns the cells with the columns of the first file; returns a note on columns with another unit, which remain blank.
    fn align(&mut self, first: &[FileColumn]) -> Option<String> {
        let place = |column: &FileColumn| self.columns.iter().position(|known| known.header == column.header);
        let places: Vec<Option<usize>> = first.iter().map(place).collect();
        let fits = |(column, place): (&FileColumn, &Option<usize>)| {
            place.filter(|place| match (&self.columns[*place].unit, &column.unit) {
                (Some(unit), Some(first)) => Unit::is_same(unit, first),
                (unit, first) => unit == first,
            })
        };
        let same: Vec<Option<usize>> = first.iter().zip(&places).map(fits).collect();
        for row in self.rows.iter_mut().filter(|row| !row.cells.is_empty()) {
            let cell = |place: &Option<usize>| {
                place
                    .and_then(|place| row.cells.get(place).cloned())
                    .unwrap_or_default()
            };
            row.cells = same.iter().map(cell).collect();
        }
        let other = first.iter().zip(&places).zip(&same);
        let other: Vec<String> = other
            .filter(|((_, place), same)| place.is_some() && same.is_none())
            .map(|((column, _), _)| format!("`{}`", column.header))
            .collect();
        (!other.is_empty()).then(|| {
            let names = other.join(", ");
            format!("{names}: the unit differs from the first file, so conditions on these headers ignore these rows")
        })
    }
}

fn wrong_rows(wrong: ExpressionFault) -> MeasuredFault {
    MeasuredFault::new("rows", wrong.to_string(), wrong.help.unwrap_or_default())
}

/// A file without the quantities of the first one.
fn other_quantities(file: MeasuredFile<'_>, number: usize, quantities: &[&str], first: &Measured) -> MeasuredFault {
    let beyond = |a: &[&str], b: &[&str]| -> Vec<String> {
        let beyond = a.iter().filter(|quantity| !b.contains(quantity));
        beyond.map(|quantity| format!("`{quantity}`")).collect()
    };
    let (missing, more) = (
        beyond(&first.quantities, quantities),
        beyond(quantities, &first.quantities),
    );
    let mut words = Vec::new();
    if !missing.is_empty() {
        words.push(format!("lacks {}", missing.join(", ")));
    }
    if !more.is_empty() {
        words.push(format!("also has {}", more.join(", ")));
    }
    MeasuredFault::new(
        format!("file.{number}"),
        format!("{}: unlike {} it {}", file.name, first.files[0], words.join(" and ")),
        "the files of a measurement need the same quantities: state its columns, or make it a separate measurement",
    )
}

impl Measured {
    /// Omits the rows that do not satisfy a condition, with a note.
    fn keep(&mut self, condition: &Condition) -> Result<(), MeasuredFault> {
        condition.check(self).map_err(wrong_rows)?;
        let before = self.rows.len();
        let meets: Vec<Option<bool>> = self.rows.iter().map(|row| condition.holds(self, row)).collect();
        let unknown = meets.iter().filter(|meets| meets.is_none()).count();
        let mut meets = meets.into_iter();
        self.rows.retain(|_| meets.next().flatten() == Some(true));
        if self.rows.is_empty() {
            let message = format!("no row satisfies `{}`", condition.text());
            return Err(MeasuredFault::new(
                "rows",
                message,
                "write a wider condition, or delete it",
            ));
        }
        let left_out = before - self.rows.len();
        let blank = match unknown {
            0 => String::new(),
            _ => format!("; {unknown} of them have no value for it"),
        };
        self.notes.push(format!(
            "{left_out} of {before} rows are omitted by `rows: {}`{blank}",
            condition.text()
        ));
        Ok(())
    }

    /// Uses the columns of the other port for torque and speed if only these exist.
    fn take_other_port(&mut self) {
        for (quantity, out) in [("torque", "torque_out"), ("speed", "speed_out")] {
            let (false, Some(place)) = (self.holds(quantity), self.place(out)) else {
                continue;
            };
            self.quantities.push(quantity);
            for row in &mut self.rows {
                let value = row.values[place];
                row.values.push(value);
                if let Some(stretch) = &mut row.stretch {
                    let error = stretch.standard_errors[place];
                    stretch.standard_errors.push(error);
                }
            }
            self.notes.push(format!(
                "there is no column for `{quantity}`: `{out}` gives it at the other port"
            ));
            match quantity {
                "torque" => self.torque_at_other_port = true,
                _ => self.speed_at_other_port = true,
            }
        }
    }
}

/// A row with its time, zero if not requested; or all errors of its cells.
fn timed_row(
    line: u64,
    cells: &[String],
    columns: &Columns,
    table: &Table,
    faulty: FaultyRows,
) -> Result<(f64, Row), Vec<String>> {
    let number = |column: &Column| {
        let number = text::number(table, (line, cells), column.place)?;
        Ok::<f64, String>(number * column.change)
    };
    let mut row = Row { line, ..Row::default() };
    let mut faults = Vec::new();
    for column in &columns.quantities {
        let text = || cells.get(column.place).filter(|c| !c.is_empty()).cloned();
        match (column.unit, column.name) {
            (Some(_), name) if faulty == FaultyRows::Keep && text().is_none() && !is_given(name, columns) => {
                row.values.push(None);
            }
            (Some(unit), _) => match number(column).and_then(|number| in_si(number, unit, line, column)) {
                Ok(value) => row.values.push(Some(value)),
                Err(fault) => faults.push(fault),
            },
            (None, "gear") => row.gear = text(),
            (None, _) => row.name = text(),
        }
    }
    let plain = |cell: &String| table.numbers.plain(cell).unwrap_or_else(|| cell.clone());
    row.cells = cells.iter().map(plain).collect();
    for bound in &columns.bound {
        match number(&bound.column) {
            Ok(number) => row.bound.push(format!("{number} {}", bound.unit).trim().to_owned()),
            Err(fault) => faults.push(fault),
        }
    }
    let time = columns.time.as_ref().map_or(Ok(0.0), |column| {
        let (factor, offset) = column.unit.unwrap_or((1.0, 0.0));
        number(column).map(|number| number * factor + offset)
    });
    match time {
        Ok(time) if faults.is_empty() => Ok((time, row)),
        Ok(_) => Err(faults),
        Err(fault) => {
            faults.push(fault);
            Err(faults)
        }
    }
}

/// Whether a quantity defines the torque or the speed of its point: such a cell cannot be blank.
fn is_given(name: &str, columns: &Columns) -> bool {
    let held = |name: &str| columns.quantities.iter().any(|column| column.name == name);
    match name {
        "torque" | "speed" => true,
        "torque_out" => !held("torque"),
        "speed_out" => !held("speed"),
        _ => false,
    }
}

fn in_si(number: f64, (factor, offset): (f64, f64), line: u64, column: &Column) -> Result<f64, String> {
    let value = number * factor + offset;
    let at = || format!("line {line}, column {} `{}`", column.place + 1, column.header);
    let known = KNOWN.iter().find(|known| known.name == column.name);
    if value.abs() > greatest(known.map_or("", |known| known.unit)) * (1.0 + 1e-12) {
        return Err(format!("{}: {number:e} is unrealistically large", at()));
    }
    if value < 0.0 && (column.name.ends_with("_accuracy") || column.name == "weight") {
        return Err(format!("{}: {value} is negative", at()));
    }
    if column.name == "efficiency" && !(-0.2..=1.2).contains(&value) {
        return Err(format!(
            "{}: an efficiency of {value}; state its unit, `%` or `-`",
            at()
        ));
    }
    if column.name.ends_with("_temperature") && value < -273.15 {
        return Err(format!("{}: {value} degC is below absolute zero", at()));
    }
    Ok(value)
}
