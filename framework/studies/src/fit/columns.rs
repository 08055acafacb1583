//! Columns of a CSV file by name, in SI: `name [unit]` in the header, comments after `#`.

use crate::codes;
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
    /// Line of the header.
    head: u64,
    /// Name and unit of each column.
    names: Vec<(String, String)>,
    rows: Vec<(u64, Vec<String>)>,
}

fn wrong_input(message: String, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error("", message).help(help).code(codes::DATA)
}

fn cells(record: &csv::StringRecord) -> Vec<String> {
    record.iter().map(str::to_owned).collect()
}

impl Columns {
    /// Reads the text of a file; errors name the file.
    ///
    /// # Errors
    /// A row that has another number of cells than the header, or no row at all.
    pub fn of_text(file: &str, text: &str) -> Result<Self, Diagnostic> {
        let file = file.to_owned();
        let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
        // Line by line: a reader of the whole text would count comments to the next record.
        for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            if text.trim().is_empty() || text.starts_with('#') {
                continue;
            }
            let mut reader = csv::ReaderBuilder::new()
                .trim(csv::Trim::All)
                .has_headers(false)
                .from_reader(text.as_bytes());
            let cells: Vec<String> = reader.records().flatten().flat_map(|r| cells(&r)).collect();
            if let Some((_, header)) = rows.first().filter(|(_, header)| header.len() != cells.len()) {
                return Err(wrong_input(
                    format!(
                        "{file}: line {line}: {} cells, but the header has {}",
                        cells.len(),
                        header.len()
                    ),
                    "separate cells by commas and use a decimal point",
                ));
            }
            rows.push((line, cells));
        }
        if rows.len() < 2 {
            return Err(wrong_input(
                format!("{file}: no row of numbers"),
                "write a header and a row for each point",
            ));
        }
        let (head, header) = rows.remove(0);
        let names = header
            .iter()
            .map(|cell| match cell.split_once('[') {
                Some((name, unit)) => (name.trim().to_owned(), unit.trim_end_matches(']').trim().to_owned()),
                None => (cell.clone(), String::new()),
            })
            .collect();
        Ok(Self {
            file,
            head,
            names,
            rows,
        })
    }

    /// Whether there is a column of this name.
    pub fn has(&self, quantity: &Quantity) -> bool {
        self.names.iter().any(|(name, _)| name == quantity.name)
    }

    /// An input error in a row of the file (index from zero); without a row, in the header.
    pub fn wrong(&self, row: Option<usize>, message: &str, help: impl Into<String>) -> Diagnostic {
        let line = row.map_or(self.head, |row| self.rows[row].0);
        wrong_input(format!("{}: line {line}: {message}", self.file), help)
    }

    /// A quantity in SI, one number for each point; only temperatures may be zero or negative.
    ///
    /// # Errors
    /// If there is no such column, its unit is none of the quantity, or a cell is no such number.
    pub fn numbers(&self, quantity: &Quantity) -> Result<Vec<f64>, Diagnostic> {
        let Some(column) = self.names.iter().position(|(name, _)| name == quantity.name) else {
            let there: Vec<&str> = self.names.iter().map(|(name, _)| name.as_str()).collect();
            let near = did_you_mean(quantity.name, there.iter().copied());
            let help = match near {
                Some(near) => format!("rename `{near}`, or add {}", quantity.header()),
                None => format!("add the column {}", quantity.header()),
            };
            let message = format!("no column `{}`; there are: {}", quantity.name, there.join(", "));
            return Err(self.wrong(None, &message, help));
        };
        let unit = self.names[column].1.as_str();
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
            let cell = &self.rows[row].1[column];
            let place = format!("column {} `{}`", column + 1, quantity.name);
            let number = cell.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
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
        (0..self.rows.len()).map(cell).collect()
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
        let names = self.names.iter().map(|(name, _)| name.as_str());
        names.filter(|name| !known(name)).collect()
    }
}
