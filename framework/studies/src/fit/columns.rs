//! Columns of a table by name, in SI: `name [unit]` in the header, comments after `#`.

use crate::codes;
use gearloss_document::data::TableForm;
use gearloss_document::data::cells::{self, FoundColumn, Table};
use gearloss_framework::document::{Diagnostic, Dimension, Unit, did_you_mean};

/// Largest amount of a quantity, SI: above pressures and shear rates of any test, so that squares remain finite.
const GREATEST: f64 = 1e15;

/// Dimension of a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// As in gearbox files.
    Of(Dimension),
    /// Shear rate, 1/s.
    ShearRate,
}

/// A quantity of a column.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Name in the header.
    pub name: &'static str,
    /// Its dimension.
    pub measure: Measure,
    /// The recommended unit.
    pub unit: &'static str,
}

impl Quantity {
    /// A quantity with its name, what its unit measures, and the unit to recommend.
    pub const fn new(name: &'static str, measure: Measure, unit: &'static str) -> Self {
        Self { name, measure, unit }
    }

    /// A plain number, without a unit or in percent.
    pub const fn plain(name: &'static str) -> Self {
        Self::new(name, Measure::Of(Dimension::None), "-")
    }

    /// Factor and offset of a unit to SI.
    fn conversion(&self, symbol: &str) -> Option<(f64, f64)> {
        match (self.measure, symbol) {
            (Measure::ShearRate, "1/s" | "s-1" | "s^-1") | (Measure::Of(Dimension::None), "") => Some((1.0, 0.0)),
            (Measure::Of(dimension), _) => Unit::read_as(symbol, dimension)
                .ok()
                .map(|unit| (unit.factor, unit.offset)),
            (Measure::ShearRate, _) => None,
        }
    }

    /// The column name with its unit.
    pub fn header(&self) -> String {
        match self.unit {
            "-" => format!("`{}`", self.name),
            unit => format!("`{} [{unit}]`", self.name),
        }
    }
}

/// The cells of a file.
pub struct Columns {
    file: String,
    table: Table,
}

fn wrong_input(message: String, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error("", message).help(help).code(codes::DATA)
}

impl Columns {
    /// Reads the bytes of a file; errors name the file. Its header is the first line, unless another has more texts.
    ///
    /// # Errors
    /// A row that has another number of cells than the header, or no row at all.
    pub fn of_file(file: &str, bytes: &[u8]) -> Result<Self, Diagnostic> {
        let is_text = |name: &str| name.parse::<f64>().is_err();
        let table = cells::table(bytes, &TableForm::default(), &is_text, &mut Vec::new())
            .map_err(|wrong| wrong_input(format!("{file}: {}", wrong.message), wrong.help))?;
        let width = table.names.len();
        if let Some((line, cells)) = table.rows.iter().find(|(_, cells)| cells.len() != width) {
            return Err(wrong_input(
                format!("{file}: line {line}: {} cells, but the header has {width}", cells.len()),
                "complete the row",
            ));
        }
        if table.rows.is_empty() {
            return Err(wrong_input(
                format!("{file}: no row of numbers"),
                "write a header and a row for each point",
            ));
        }
        Ok(Self {
            file: file.to_owned(),
            table,
        })
    }

    /// Whether there is a column of this name.
    pub fn has(&self, quantity: &Quantity) -> bool {
        self.table.names.iter().any(|name| name == quantity.name)
    }

    /// An input error in a row of the file (index from zero); without a row, in the header.
    pub fn wrong(&self, row: Option<usize>, message: &str, help: impl Into<String>) -> Diagnostic {
        let line = row.map_or(self.table.header_line, |row| self.table.rows[row].0);
        wrong_input(format!("{}: line {line}: {message}", self.file), help)
    }

    /// A quantity in SI, one number for each point; only temperatures may be zero or negative.
    ///
    /// # Errors
    /// If there is no such column, its unit is none of the quantity, or a cell is no such number.
    pub fn numbers(&self, quantity: &Quantity) -> Result<Vec<f64>, Diagnostic> {
        let column = match self.table.column(quantity.name) {
            FoundColumn::At(column) => Some(column),
            FoundColumn::Several(places) => {
                let (message, _) = self.table.ambiguous(quantity.name, &places, quantity.name);
                return Err(self.wrong(None, &message, "delete or rename all but one of them"));
            }
            FoundColumn::Absent => None,
        };
        let Some(column) = column else {
            let there: Vec<&str> = self.table.names.iter().map(String::as_str).collect();
            let near = did_you_mean(quantity.name, there.iter().copied());
            let help = match near {
                Some(near) => format!("rename `{near}`, or add {}", quantity.header()),
                None => format!("add the column {}", quantity.header()),
            };
            let message = format!("no column `{}`; there are: {}", quantity.name, there.join(", "));
            return Err(self.wrong(None, &message, help));
        };
        let unit = self.table.units[column].as_deref().unwrap_or_default();
        let Some((factor, zero)) = quantity.conversion(unit) else {
            let message = match unit {
                "" => format!("`{}` has no unit", quantity.name),
                _ => format!(
                    "`{}` is in `{unit}`, which is not a unit of this quantity",
                    quantity.name
                ),
            };
            return Err(self.wrong(None, &message, format!("convert it and write {}", quantity.header())));
        };
        let any = quantity.measure == Measure::Of(Dimension::Temperature);
        let cell = |row: usize| {
            let cell = &self.table.rows[row].1[column];
            let place = format!("column {} `{}`", column + 1, quantity.name);
            let number = self.table.numbers.number(cell).ok_or_else(|| {
                let message = format!("{place}: `{cell}` is not a number");
                self.wrong(Some(row), &message, "write a number, or delete the row")
            })?;
            let value = number * factor + zero;
            if value.abs() > GREATEST {
                let message = format!("{place}: {cell} is unrealistically large");
                Err(self.wrong(Some(row), &message, "correct the number, or delete the row"))
            } else if any || number > 0.0 {
                Ok(value)
            } else {
                let message = format!("{place}: {cell} is not positive");
                Err(self.wrong(Some(row), &message, "write magnitudes, and delete points at standstill"))
            }
        };
        (0..self.table.rows.len()).map(cell).collect()
    }

    /// The cells of a column of texts.
    ///
    /// # Errors
    /// If there is no such column, or several.
    pub fn texts(&self, name: &str) -> Result<Vec<&str>, Diagnostic> {
        let FoundColumn::At(column) = self.table.column(name) else {
            let message = format!("no single column `{name}`; there are: {}", self.table.names.join(", "));
            return Err(self.wrong(None, &message, format!("name one column `{name}`")));
        };
        Ok(self
            .table
            .rows
            .iter()
            .map(|(_, cells)| cells[column].as_str())
            .collect())
    }

    /// The number of the line of a row (index from zero).
    pub fn line(&self, row: usize) -> u64 {
        self.table.rows[row].0
    }

    /// Checks that there is either one quantity or others in its place.
    ///
    /// # Errors
    /// If both are there, or neither.
    pub fn either(&self, one: &Quantity, others: &[Quantity]) -> Result<(), Diagnostic> {
        let words: Vec<String> = others.iter().map(Quantity::header).collect();
        let (one_word, words) = (one.header(), words.join(" and "));
        match (self.has(one), others.iter().any(|q| self.has(q))) {
            (true, true) => Err(self.wrong(None, &format!("both {one_word} and {words}"), "delete one of them")),
            (false, false) => Err(self.wrong(None, &format!("neither {one_word} nor {words}"), "add one of them")),
            _ => Ok(()),
        }
    }

    /// Names of columns other than these quantities: those that are not used.
    pub fn unused(&self, quantities: &[Quantity]) -> Vec<&str> {
        let known = |name: &str| quantities.iter().any(|q| q.name == name);
        let names = self.table.names.iter().map(String::as_str);
        names.filter(|name| !known(name)).collect()
    }
}
