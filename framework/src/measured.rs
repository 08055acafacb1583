//! Measured data as rigs write it: separators, decimal commas, encodings, unit rows, faulty rows.
//!
//! What a file looks like is recognised and told, or stated; a unit that stands nowhere is an error, not a guess.

mod condition;
mod rig;
mod seen;
pub(crate) mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::Ordered;
use crate::document::{Dimension, Unit};

pub use condition::{Condition, ConditionFault};
pub use rig::{Instruments, PortSpeeds, Powers, Rig, RigEntry, StatedAs, SupportLossEntry, TorqueMeterEntry};
pub use seen::{Seen, counted};
pub use text::{Decimal, Encoding, Separator};

/// A file of measured points, and how to read it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MeasuredEntry {
    /// CSV file beside the study.
    pub file: String,
    /// What a reader of the report has to know of these data: where they come from, or that they are synthetic.
    pub about: Option<String>,
    /// Column of each quantity, where it is not named as the quantity: `torque: T_in`. Quantities: `torque` and `speed` at the
    /// ports of the conditions, `torque_out`, `speed_out`, `efficiency`, `loss`, `loss_torque`, `oil_temperature`,
    /// `surface_temperature`, `weight`, `gear`, `name`, and accuracies such as `efficiency_accuracy`.
    #[serde(default)]
    pub columns: Ordered<String>,
    /// Unit of each quantity, where neither the header nor a row of units states it: `efficiency: "%"`.
    #[serde(default)]
    pub units: Ordered<String>,
    /// What separates cells; absent, it is recognised.
    pub separator: Option<Separator>,
    /// Decimal sign; absent, it is recognised.
    pub decimal: Option<Decimal>,
    /// Encoding; absent, UTF-8, and Latin-1 where that fails.
    pub encoding: Option<Encoding>,
    /// What happens to a row with blanks or text where a number is due.
    #[serde(default)]
    pub faulty_rows: FaultyRows,
    /// What accuracies in columns and of the instruments mean.
    #[serde(default)]
    pub stated_as: StatedAs,
    /// Coverage factor of expanded accuracies. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 1.0, max = 10.0))]
    pub coverage_factor: f64,
    /// The rig: what its meters and bearings add, and how accurate it is where no column says it.
    #[serde(default)]
    pub rig: RigEntry,
}

fn two() -> f64 {
    2.0
}

/// What happens to a row with blanks or text where a number is due.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FaultyRows {
    /// The file is refused.
    #[default]
    Refuse,
    /// The row is left out, and told.
    Skip,
    /// A blank leaves out its quantity and no more; torque, speed and bound columns need a number all the same, and text is
    /// refused.
    Keep,
}

/// A quantity that a file may hold.
struct Known {
    name: &'static str,
    /// Documented unit; empty for texts, a dash for shares.
    unit: &'static str,
}

const fn known(name: &'static str, unit: &'static str) -> Known {
    Known { name, unit }
}

/// All quantities; SI after reading, shares as numbers of one.
const KNOWN: [Known; 17] = [
    known("torque", "Nm"),
    known("speed", "rpm"),
    known("torque_out", "Nm"),
    known("speed_out", "rpm"),
    known("efficiency", "-"),
    known("loss", "W"),
    known("loss_torque", "Nm"),
    known("oil_temperature", "degC"),
    known("weight", "-"),
    known("efficiency_accuracy", "-"),
    known("loss_accuracy", "W"),
    known("loss_torque_accuracy", "Nm"),
    known("oil_temperature_accuracy", "K"),
    known("surface_temperature", "degC"),
    known("surface_temperature_accuracy", "K"),
    known("gear", ""),
    known("name", ""),
];

/// One measured point; SI, temperatures in degC.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// Line in the file.
    pub line: u64,
    /// Name, where the file has names.
    pub name: Option<String>,
    /// Gear state, where the file has them.
    pub gear: Option<String>,
    /// Values by the places of [`Measured::quantities`]; a gap where the cell is blank.
    pub values: Vec<Option<f64>>,
    /// Bound values as written, with their units.
    pub bound: Vec<String>,
    /// All cells of the row by the places of [`Measured::columns`], numbers with a decimal point.
    pub cells: Vec<String>,
}

/// A column of a file as its header states it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FileColumn {
    /// Name in the header.
    pub header: String,
    /// Name under which it is bound, where it is.
    pub bound: Option<String>,
    /// Symbol of its unit, where header, row of units or `units` state one.
    pub unit: Option<String>,
}

/// What was read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// Names of the numeric quantities that the file holds.
    pub quantities: Vec<&'static str>,
    /// All columns of the file.
    pub columns: Vec<FileColumn>,
    /// The points.
    pub rows: Vec<Row>,
    /// How the file was understood, and which rows were left out, in sentences.
    pub notes: Vec<String>,
    /// What stated accuracies are divided by to give standard deviations.
    pub divisor: f64,
    /// What the rig adds to what its meters show.
    pub rig: Rig,
    /// Instruments, where both torque meters are stated.
    pub instruments: Option<Instruments>,
    /// Standard deviation of the oil's temperature, where no column says it. \[K\]
    pub oil_temperature: Option<f64>,
}

impl Measured {
    /// A quantity of a row; absent where the file or the row does not hold it.
    pub fn value(&self, row: &Row, quantity: &str) -> Option<f64> {
        let place = self.quantities.iter().position(|q| *q == quantity)?;
        row.values.get(place).copied().flatten()
    }

    /// Place of a column by the name under which it is bound, or by its header.
    pub fn column(&self, name: &str) -> Option<usize> {
        let bound = self.columns.iter().position(|c| c.bound.as_deref() == Some(name));
        bound.or_else(|| self.columns.iter().position(|c| c.header == name))
    }

    /// True where the file holds a quantity.
    pub fn holds(&self, quantity: &str) -> bool {
        self.quantities.contains(&quantity)
    }
}

/// What is wrong with a file, and how to mend it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredFault {
    /// What is wrong, with line and column.
    pub message: String,
    /// How to mend it.
    pub mend: String,
}

pub(crate) fn fault(message: impl Into<String>, mend: impl Into<String>) -> MeasuredFault {
    MeasuredFault {
        message: message.into(),
        mend: mend.into(),
    }
}

/// One column that somebody asks for.
struct Column {
    place: usize,
    header: String,
    /// Factor and offset to SI; absent for texts.
    unit: Option<(f64, f64)>,
    known: usize,
}

impl MeasuredEntry {
    /// What stated accuracies are divided by to give standard deviations.
    fn divisor(&self) -> f64 {
        self.stated_as.divisor(self.coverage_factor)
    }

    fn form(&self) -> text::Form {
        text::Form {
            separator: self.separator,
            decimal: self.decimal,
            encoding: self.encoding,
        }
    }

    /// Reads the bytes of the file. `bind` names columns that change the gearbox.
    ///
    /// # Errors
    /// What is wrong, with line and column.
    pub fn read(&self, bytes: &[u8], bind: &[&str]) -> Result<Measured, MeasuredFault> {
        let mut notes = Vec::new();
        let table = text::table(bytes, self.form(), &mut notes)?;
        let (columns, bound) = self.columns(&table, bind)?;
        let mut measured = Measured {
            quantities: columns
                .iter()
                .filter(|c| c.unit.is_some())
                .map(|c| KNOWN[c.known].name)
                .collect(),
            columns: self.file_columns(&table, &bound, bind),
            rows: Vec::new(),
            notes,
            divisor: self.divisor(),
            rig: Rig::of(&self.rig),
            instruments: Instruments::of(&self.rig, self.divisor()),
            oil_temperature: self.rig.oil_temperature.map(|a| a / self.divisor()),
        };
        let mut left_out = Vec::new();
        for (line, cells) in &table.rows {
            match row(*line, cells, (&columns, &bound), table.decimal, self.faulty_rows) {
                Ok(row) => measured.rows.push(row),
                Err(reason) if self.faulty_rows == FaultyRows::Skip => left_out.push(reason),
                Err(reason) => {
                    return Err(fault(
                        reason,
                        "correct the cell, or write `faulty_rows: skip` to leave such rows out",
                    ));
                }
            }
        }
        if !left_out.is_empty() {
            let count = left_out.len();
            let shown = left_out.iter().take(5).cloned().collect::<Vec<_>>().join("; ");
            let more = if count > 5 { "; ..." } else { "" };
            measured.notes.push(format!("{count} rows left out: {shown}{more}"));
        }
        if measured.rows.is_empty() {
            return Err(fault(
                "no point stands below the header",
                "check the file, its header and its separator",
            ));
        }
        Ok(measured)
    }

    /// All columns as the header states them.
    fn file_columns(&self, table: &text::Table, bound: &[(Column, String)], bind: &[&str]) -> Vec<FileColumn> {
        let column = |(place, header): (usize, &String)| {
            let own = bound.iter().position(|(column, _)| column.place == place);
            let name = own.and_then(|i| bind.get(i)).map(|name| (*name).to_owned());
            let stated = name.as_ref().and_then(|name| self.units.get(name)).cloned();
            let unit = stated.or_else(|| table.units[place].clone());
            // What stands in brackets need not be a unit.
            let has_dimension =
                |unit: &String| unit == "%" || Unit::of_symbol(unit).is_some_and(|u| u.dimension != Dimension::None);
            FileColumn {
                header: header.clone(),
                unit: unit.filter(has_dimension),
                bound: name,
            }
        };
        table.names.iter().enumerate().map(column).collect()
    }

    /// The columns that hold quantities, and those that are bound, with their units.
    fn columns(
        &self,
        table: &text::Table,
        bind: &[&str],
    ) -> Result<(Vec<Column>, Vec<(Column, String)>), MeasuredFault> {
        let names = || table.names.join(", ");
        for (quantity, _) in self.columns.iter().chain(self.units.iter()) {
            if !KNOWN.iter().any(|k| k.name == quantity) && !bind.contains(&quantity) {
                let all: Vec<&str> = KNOWN.iter().map(|k| k.name).collect();
                return Err(fault(
                    format!("`{quantity}` is no measured quantity"),
                    format!("the quantities are {}", all.join(", ")),
                ));
            }
        }
        let find = |quantity: &str| -> Result<Option<usize>, MeasuredFault> {
            let written = self.columns.get(quantity);
            let header = written.map_or(quantity, String::as_str);
            let place = table.names.iter().position(|n| n == header);
            match (place, written) {
                (None, Some(header)) => Err(fault(
                    format!(
                        "line {}: no column is called `{header}`; there are: {}",
                        table.header_line,
                        names()
                    ),
                    "name one of them under `columns`",
                )),
                (place, _) => Ok(place),
            }
        };
        let stated = |quantity: &str, place: usize| -> Option<String> {
            let own = self.units.get(quantity).cloned();
            own.or_else(|| table.units[place].clone())
        };
        let mut columns = Vec::new();
        for (i, known) in KNOWN.iter().enumerate() {
            let Some(place) = find(known.name)? else { continue };
            let header = table.names[place].clone();
            let unit = if known.unit.is_empty() {
                None
            } else {
                Some(scale(
                    (known.name, known.unit),
                    stated(known.name, place).as_deref(),
                    &header,
                )?)
            };
            columns.push(Column {
                place,
                header,
                unit,
                known: i,
            });
        }
        for due in ["torque", "speed"] {
            if !columns.iter().any(|c| KNOWN[c.known].name == due) {
                return Err(fault(
                    format!(
                        "line {}: no column holds the {due}; there are: {}",
                        table.header_line,
                        names()
                    ),
                    format!("name one under `columns: {{ {due}: ... }}`"),
                ));
            }
        }
        let mut bound = Vec::new();
        for name in bind {
            let Some(place) = find(name)? else {
                return Err(fault(
                    format!(
                        "line {}: no column is called `{name}`, which is bound; there are: {}",
                        table.header_line,
                        names()
                    ),
                    "name a column of the file, or take it out of `bind`",
                ));
            };
            let unit = stated(name, place).unwrap_or_default();
            if !unit.is_empty() && Unit::of_symbol(&unit).is_none() {
                return Err(fault(
                    format!("line {}: `{unit}` of column `{name}` is no unit", table.header_line),
                    "write a unit such as [ml]",
                ));
            }
            let column = Column {
                place,
                header: table.names[place].clone(),
                unit: Some((1.0, 0.0)),
                known: 0,
            };
            bound.push((column, unit));
        }
        Ok((columns, bound))
    }
}

/// Factor and offset of a unit to SI.
pub(crate) fn scale((name, due): (&str, &str), unit: Option<&str>, header: &str) -> Result<(f64, f64), MeasuredFault> {
    let mend = |example: &str| format!("state it: `units: {{ {name}: {example} }}`");
    if due == "-" {
        return match unit {
            Some("%") => Ok((0.01, 0.0)),
            Some("-" | "1") => Ok((1.0, 0.0)),
            None if ["weight", "share"].contains(&name) => Ok((1.0, 0.0)),
            Some(other) => Err(fault(
                format!("column `{header}`: `{other}` is no unit of {name}"),
                mend("\"%\""),
            )),
            None => Err(fault(
                format!("column `{header}`: no unit says whether it is in percent"),
                mend("\"%\""),
            )),
        };
    }
    let Some(symbol) = unit else {
        return Err(fault(format!("column `{header}` has no unit"), mend(due)));
    };
    let wanted = Unit::of_symbol(due).unwrap_or(Unit::ONE);
    match Unit::of_symbol(symbol) {
        Some(unit) if unit.dimension == wanted.dimension => Ok((unit.factor, unit.offset)),
        _ => Err(fault(
            format!(
                "column `{header}`: `{symbol}` is no unit of {}",
                wanted.dimension.name()
            ),
            mend(due),
        )),
    }
}

fn row(
    line: u64,
    cells: &[String],
    (columns, bound): (&[Column], &[(Column, String)]),
    decimal: Decimal,
    faulty: FaultyRows,
) -> Result<Row, String> {
    let number = |column: &Column| text::number(decimal, (line, cells), (column.place, &column.header));
    let mut row = Row { line, ..Row::default() };
    for column in columns {
        let text = || cells.get(column.place).filter(|c| !c.is_empty()).cloned();
        match (column.unit, KNOWN[column.known].name) {
            (Some(_), name)
                if faulty == FaultyRows::Keep && text().is_none() && !["torque", "speed"].contains(&name) =>
            {
                row.values.push(None);
            }
            (Some((factor, offset)), name) => {
                let value = number(column)? * factor + offset;
                if value < 0.0 && (name.ends_with("_accuracy") || name == "weight") {
                    let at = format!("line {line}, column {} `{}`", column.place + 1, column.header);
                    return Err(format!("{at}: {value} is below zero"));
                }
                if name == "efficiency" && !(-0.2..=1.2).contains(&value) {
                    let at = format!("line {line}, column {} `{}`", column.place + 1, column.header);
                    return Err(format!("{at}: an efficiency of {value}; state its unit, `%` or `-`"));
                }
                row.values.push(Some(value));
            }
            (None, "gear") => row.gear = text(),
            (None, _) => row.name = text(),
        }
    }
    let plain = |cell: &String| match decimal {
        Decimal::Comma if decimal.number(cell).is_some() => cell.replace(',', "."),
        _ => cell.clone(),
    };
    row.cells = cells.iter().map(plain).collect();
    for (column, unit) in bound {
        row.bound.push(format!("{} {unit}", number(column)?).trim().to_owned());
    }
    Ok(row)
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    pub(crate) fn entry(columns: &[(&str, &str)], units: &[(&str, &str)]) -> MeasuredEntry {
        let list =
            |pairs: &[(&str, &str)]| Ordered(pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect());
        MeasuredEntry {
            about: None,
            file: "rig.csv".to_owned(),
            columns: list(columns),
            units: list(units),
            separator: None,
            decimal: None,
            encoding: None,
            faulty_rows: FaultyRows::Refuse,
            stated_as: StatedAs::Standard,
            coverage_factor: 2.0,
            rig: RigEntry::default(),
        }
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12 * b.abs().max(1.0)
    }

    #[test]
    fn a_german_rig_file_is_recognised_and_told() {
        // BOM, semicolons, decimal commas, a row of units.
        let text = "\u{feff}M_an;n_an;eta;T_Öl\nNm;1/min;%;°C\n10,5;3000;97,25;80,1\n-4;1000;90;60\n";
        let rig = entry(
            &[
                ("torque", "M_an"),
                ("speed", "n_an"),
                ("efficiency", "eta"),
                ("oil_temperature", "T_Öl"),
            ],
            &[],
        );
        for bytes in [text.as_bytes().to_vec(), latin1(&text.replace('\u{feff}', ""))] {
            let read = rig.read(&bytes, &[]).unwrap();
            let first = &read.rows[0];
            let at = |quantity: &str| read.value(first, quantity).unwrap();
            assert!(close(at("torque"), 10.5) && close(at("speed"), 100.0 * std::f64::consts::PI));
            assert!(close(at("efficiency"), 0.9725) && close(at("oil_temperature"), 80.1));
            assert_eq!((read.rows.len(), read.rows[1].line), (2, 4));
            let notes = read.notes.join(" ");
            assert!(
                notes.contains("`;`") && notes.contains("decimal comma") && notes.contains("units in line 2"),
                "{notes}"
            );
        }
    }

    fn latin1(text: &str) -> Vec<u8> {
        text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect()
    }

    #[test]
    fn an_english_file_with_units_in_the_header_needs_no_word() {
        let read = entry(&[], &[])
            .read(b"torque [Nm],speed (rpm),loss / kW\n10,3000,0.25\n", &[])
            .unwrap();
        assert!(close(read.value(&read.rows[0], "loss").unwrap(), 250.0));
        assert!(!read.holds("efficiency"));
    }

    #[test]
    fn nothing_is_guessed() {
        let refused = |entry: &MeasuredEntry, text: &str| {
            let fault = entry.read(text.as_bytes(), &[]).unwrap_err();
            format!("{}: {}", fault.message, fault.mend)
        };
        let plain = entry(&[], &[]);
        assert!(refused(&plain, "torque,speed [rpm]\n1,2\n").contains("column `torque` has no unit"));
        assert!(refused(&plain, "torque [Nm],speed [rpm],efficiency\n1,2,0.9\n").contains("percent"));
        assert!(refused(&plain, "torque [rpm],speed [rpm]\n1,2\n").contains("`rpm` is no unit of torque"));
        assert!(refused(&plain, "torque [Nm],n [rpm]\n1,2\n").contains("no column holds the speed"));
        assert!(
            refused(&entry(&[("speed", "n")], &[]), "torque [Nm],m [rpm]\n1,2\n").contains("no column is called `n`")
        );
        assert!(
            refused(&entry(&[("spede", "n")], &[]), "torque [Nm],n [rpm]\n1,2\n")
                .contains("`spede` is no measured quantity")
        );
        assert!(refused(&plain, "torque [Nm],speed [rpm]\n").contains("no point"));
        assert!(refused(&plain, "").contains("empty"));
        // A comma that may separate cells or decimals.
        assert!(refused(&plain, "torque [Nm];speed [rpm]\n1.234;2,5\n1,5;2\n").contains("decimal"));
        assert!(
            entry(&[], &[("efficiency", "%")])
                .read(b"torque [Nm],speed [rpm],efficiency\n1,2,90\n", &[])
                .is_ok()
        );
    }

    #[test]
    fn faulty_rows_are_refused_or_left_out_and_told() {
        let text = b"torque [Nm],speed [rpm],loss [W]\n1,2,3\n1,2,\n1,x,3\n";
        let mut rig = entry(&[], &[]);
        let refused = rig.read(text, &[]).unwrap_err();
        assert!(refused.message.contains("line 3, column 3 `loss`: empty") && refused.mend.contains("skip"));
        rig.faulty_rows = FaultyRows::Skip;
        let read = rig.read(text, &[]).unwrap();
        assert_eq!(read.rows.len(), 1);
        assert!(
            read.notes
                .iter()
                .any(|n| n.contains("2 rows left out") && n.contains("line 4, column 2 `speed`: `x`"))
        );
    }

    #[test]
    fn bound_columns_keep_their_unit() {
        let read = entry(&[], &[])
            .read(b"torque [Nm];speed [rpm];volume [ml]\n1;2;60,5\n", &["volume"])
            .unwrap();
        assert_eq!(read.rows[0].bound, ["60.5 ml"]);
        let fault = entry(&[], &[])
            .read(b"torque [Nm];speed [rpm]\n1;2\n", &["volume"])
            .unwrap_err();
        assert!(fault.message.contains("`volume`, which is bound"));
    }
}
