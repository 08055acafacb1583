//! Assignment of columns to quantities, with units, scales and signs.

use schemars::JsonSchema;
use serde::Deserialize;

use super::files::MeasuredFile;
use super::{FaultPlace, MeasuredEntry, MeasuredFault, text};
use gearloss_document::data::cells::FoundColumn;
use gearloss_document::data::sheet::{is_name_of, overridden};
use gearloss_document::data::{StatedUnit, scale};
use gearloss_framework::document::{Unit, did_you_mean};

/// The column of a quantity.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ColumnEntry {
    /// Its header.
    Header(String),
    /// Its header, scale and sign.
    Changed(ChangedColumnEntry),
}

/// A column with a scale and a sign, which apply before its unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ChangedColumnEntry {
    /// Header of the column.
    pub column: String,
    /// Factor on the numbers of the column; not zero. [-]
    #[serde(default = "unit_factor")]
    #[schemars(range(min = -1e12, max = 1e12))]
    pub scale: f64,
    /// Sign of the numbers of the column: -1 for a rig with the opposite sign convention, otherwise 1. [-]
    #[serde(default = "unit_factor")]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub sign: f64,
}

fn unit_factor() -> f64 {
    1.0
}

impl From<&str> for ColumnEntry {
    fn from(header: &str) -> Self {
        Self::Header(header.to_owned())
    }
}

impl ColumnEntry {
    pub(super) fn header(&self) -> &str {
        match self {
            Self::Header(header) => header,
            Self::Changed(changed) => &changed.column,
        }
    }

    /// Scale and sign.
    fn change(&self) -> [f64; 2] {
        match self {
            Self::Header(_) => [1.0, 1.0],
            Self::Changed(changed) => [changed.scale, changed.sign],
        }
    }
}

/// A quantity of a file.
pub(super) struct Known {
    pub name: &'static str,
    /// Documented unit; empty for texts, a dash for fractions.
    pub unit: &'static str,
}

const fn known(name: &'static str, unit: &'static str) -> Known {
    Known { name, unit }
}

/// All quantities; SI after reading.
pub(super) const KNOWN: [Known; 17] = [
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

/// A column of a quantity.
pub(super) struct Column {
    pub name: &'static str,
    pub place: usize,
    pub header: String,
    /// Factor on the number as written: scale and sign.
    pub change: f64,
    /// Factor and offset to SI; absent for texts.
    pub unit: Option<(f64, f64)>,
}

/// A column that changes the gearbox.
pub(super) struct BoundColumn {
    /// Bound name.
    pub name: String,
    pub column: Column,
    /// Symbol of its unit; empty for a plain number.
    pub unit: String,
}

/// The columns of a file that are used.
#[derive(Default)]
pub(super) struct Columns {
    pub quantities: Vec<Column>,
    pub bound: Vec<BoundColumn>,
    /// Time, if steady intervals are requested.
    pub time: Option<Column>,
    /// Notes on changed columns.
    pub notes: Vec<String>,
}

/// Finds columns and collects all errors.
pub(super) struct Finder<'a> {
    pub entry: &'a MeasuredEntry,
    pub file: MeasuredFile<'a>,
    pub table: &'a text::Table,
    pub faults: Vec<MeasuredFault>,
}

impl<'a> Finder<'a> {
    /// The columns of quantities, bound columns, and the time.
    pub(super) fn columns(&mut self, bind: &[&str]) -> Columns {
        let mut columns = Columns::default();
        for known in &KNOWN {
            let Some((place, header)) = self.place(known.name) else {
                continue;
            };
            let change = self.change(known, &header, &mut columns.notes);
            let unit = if known.unit.is_empty() {
                None
            } else {
                match self.unit((known.name, known.unit), place, &header, &mut columns.notes) {
                    Some(unit) => Some(unit),
                    None => continue,
                }
            };
            columns.quantities.push(Column {
                name: known.name,
                place,
                header,
                change,
                unit,
            });
        }
        for due in ["torque", "speed"] {
            self.due(due);
        }
        for name in bind {
            columns.bound.extend(self.bound(name, &mut columns.notes));
        }
        if let Some(steady) = &self.entry.steady {
            columns.time = self.time(&steady.time, &mut columns.notes);
        }
        columns
    }

    fn fault(&mut self, place: FaultPlace, message: &str, help: impl Into<String>) {
        let message = format!("{}{message}", self.table.at_header());
        self.fault_at(place, &message, help);
    }

    /// An error whose message begins with its line.
    fn fault_at(&mut self, place: FaultPlace, message: &str, help: impl Into<String>) {
        let message = format!("{}: {message}", self.table.named(self.file.name));
        self.faults.push(MeasuredFault {
            place,
            message,
            help: help.into(),
        });
    }

    fn headers(&self) -> String {
        self.table.list()
    }

    /// Headers of columns that are not assigned to a quantity.
    fn free_headers(&self) -> impl Iterator<Item = &'a str> {
        let of_file = self.file.entry.into_iter().flat_map(|entry| entry.columns.iter());
        let stated = of_file
            .chain(self.entry.columns.iter())
            .map(|(_, column)| column.header());
        let stated: Vec<&str> = stated.collect();
        let names = self.table.names.iter().map(String::as_str);
        names.filter(move |name| !stated.contains(name))
    }

    fn written(&self, quantity: &str) -> Option<&'a ColumnEntry> {
        let of_file = self.file.entry.and_then(|entry| entry.columns.get(quantity));
        of_file.or_else(|| self.entry.columns.get(quantity))
    }

    /// The key of a quantity: in the file entry, or in the measurement.
    fn key(&self, section: &str, quantity: &str) -> FaultPlace {
        let stated_by_file = self.file.entry.is_some_and(|entry| match section {
            "columns" => entry.columns.get(quantity).is_some(),
            _ => entry.units.get(quantity).is_some(),
        });
        let files = self.entry.file.list();
        let number = files.iter().position(|file| file.file == self.file.file);
        FaultPlace::Entry(match number.filter(|_| stated_by_file) {
            Some(number) => format!("file.{number}.{section}.{quantity}"),
            None => format!("{section}.{quantity}"),
        })
    }

    /// Index and header of the column of a quantity: the assigned one, or the one with the same name.
    fn place(&mut self, quantity: &str) -> Option<(usize, String)> {
        let written = self.written(quantity).map(ColumnEntry::header);
        // A column that is assigned to another quantity is not used by its own name.
        let taken = written.is_none()
            && (KNOWN.iter().filter_map(|known| self.written(known.name)))
                .any(|column| is_name_of(quantity, column.header()));
        if taken {
            return None;
        }
        let header = written.unwrap_or(quantity);
        let due = KNOWN
            .iter()
            .find(|known| known.name == quantity && !known.unit.is_empty());
        let has_unit = self.stated_own_unit(quantity).is_some();
        let fits = |unit: Option<&str>| {
            let due = due.filter(|_| !has_unit && unit.is_some());
            let stated = StatedUnit {
                file: unit,
                ..StatedUnit::default()
            };
            due.is_some_and(|due| scale((due.name, due.unit), stated, header).is_ok())
        };
        match (self.table.column_with_unit(header, fits), written) {
            (FoundColumn::At(place), _) => Some((place, header.to_owned())),
            (FoundColumn::Several(places), _) => {
                let (message, help) = self.table.ambiguous(header, &places, quantity);
                self.fault(self.key("columns", quantity), &message, help);
                None
            }
            (FoundColumn::Absent, None) => None,
            (FoundColumn::Absent, Some(_)) => {
                let message = self.table.lacks(header);
                let help = match did_you_mean(header, self.free_headers()) {
                    Some(close) => format!("write `{close}`"),
                    None => "state one of them under `columns`".to_owned(),
                };
                self.fault(self.key("columns", quantity), &message, help);
                None
            }
        }
    }

    /// Rejects a file with neither a quantity nor its value at the other port.
    fn due(&mut self, due: &str) {
        let out = format!("{due}_out");
        // A missing assigned column is already reported.
        let stated = |quantity: &str| self.written(quantity).is_some();
        let held = |quantity: &str| self.table.names.iter().any(|name| name == quantity);
        let constant = |quantity: &str| self.entry.constants.get(quantity).is_some();
        if [due, &out]
            .into_iter()
            .any(|name| stated(name) || held(name) || constant(name))
        {
            return;
        }
        let message = format!("there is no column for the {due}; there are: {}", self.headers());
        let place = FaultPlace::Entry("columns".to_owned());
        self.fault(place, &message, format!("state one under `columns: {{ {due}: ... }}`"));
    }

    /// Scale and sign of a column as one factor.
    fn change(&mut self, known: &Known, header: &str, notes: &mut Vec<String>) -> f64 {
        let Some(entry) = self.written(known.name) else {
            return 1.0;
        };
        let [scale, sign] = entry.change();
        let wrong = if scale == 0.0 {
            Some(("a scale of zero".to_owned(), "write a factor such as 0.001"))
        } else if sign.abs() != 1.0 {
            Some((format!("a sign of {sign}"), "write 1 or -1"))
        } else if scale * sign != 1.0 && known.unit.is_empty() {
            Some((
                format!("the {} is text, which has no scale and no sign", known.name),
                "delete them",
            ))
        } else {
            None
        };
        if let Some((message, help)) = wrong {
            self.fault(self.key("columns", known.name), &message, help);
            return 1.0;
        }
        notes.extend(changed(header, known.name, scale, sign));
        scale * sign
    }

    /// Factor and offset of a column to SI.
    fn unit(
        &mut self,
        (name, due): (&str, &str),
        place: usize,
        header: &str,
        notes: &mut Vec<String>,
    ) -> Option<(f64, f64)> {
        let stated = self.stated_unit(name, place);
        match scale((name, due), stated, header) {
            Ok(unit) => {
                notes.extend(overridden(stated, header));
                Some(unit)
            }
            Err(fault) => {
                let message = format!("{}{}", self.table.at_unit(place), fault.message);
                self.fault_at(self.key("units", name), &message, fault.help);
                None
            }
        }
    }

    fn stated_own_unit(&self, quantity: &str) -> Option<&'a str> {
        let of_file = self.file.entry.and_then(|entry| entry.units.get(quantity));
        of_file.or_else(|| self.entry.units.get(quantity)).map(String::as_str)
    }

    fn stated_unit(&self, quantity: &str, place: usize) -> StatedUnit<'a> {
        StatedUnit {
            study: self.stated_own_unit(quantity),
            file: self.table.units[place].as_deref(),
            overrides: (self.file.entry.and_then(|entry| entry.units_override)).unwrap_or(self.entry.units_override),
        }
    }

    fn bound(&mut self, name: &str, notes: &mut Vec<String>) -> Option<BoundColumn> {
        let at_bind = || FaultPlace::Bind(name.to_owned());
        let Some((place, header)) = self.place(name) else {
            // A missing assigned column is already reported.
            if self.written(name).is_none() {
                let headers = self.headers();
                let message = format!("there is no column `{name}`, which is bound; there are: {headers}");
                let help = match did_you_mean(name, self.table.names.iter().map(String::as_str)) {
                    Some(close) => format!("bind `{close}`, or state it under `columns: {{ {name}: {close} }}`"),
                    None => "use a column of the file, or delete it from `bind`".to_owned(),
                };
                self.fault(at_bind(), &message, help);
            }
            return None;
        };
        let change = match self.written(name).map(ColumnEntry::change) {
            Some([scale, sign]) if scale == 0.0 || sign.abs() != 1.0 => {
                self.fault(
                    self.key("columns", name),
                    "a scale of zero, or a sign that is neither 1 nor -1",
                    "correct them",
                );
                return None;
            }
            Some([scale, sign]) => {
                notes.extend(changed(&header, name, scale, sign));
                scale * sign
            }
            None => 1.0,
        };
        let stated = self.stated_unit(name, place);
        let unit = match stated.chosen(name, &header) {
            // A dash is a plain number.
            Ok(unit) => unit
                .filter(|unit| !matches!(*unit, "-" | "1"))
                .unwrap_or_default()
                .to_owned(),
            Err(fault) => {
                self.fault(self.key("units", name), &fault.message, fault.help);
                return None;
            }
        };
        notes.extend(overridden(stated, &header));
        if !unit.is_empty() && Unit::read(&unit).is_none() {
            let message = format!("`{unit}` of column `{name}` is not a unit");
            let help = format!(
                "write a unit such as [ml]; if `{unit}` means one, state it under `units: {{ {name}: ... }}` with `units_override: true`"
            );
            self.fault(at_bind(), &message, help);
            return None;
        }
        let column = Column {
            name: "bound",
            place,
            header,
            change,
            unit: Some((1.0, 0.0)),
        };
        Some(BoundColumn {
            name: name.to_owned(),
            column,
            unit,
        })
    }

    fn time(&mut self, header: &str, notes: &mut Vec<String>) -> Option<Column> {
        let at = || FaultPlace::Entry("steady.time".to_owned());
        let place = match self.table.column(header) {
            FoundColumn::At(place) => Some(place),
            FoundColumn::Several(places) => {
                let (message, _) = self.table.ambiguous(header, &places, "time");
                self.fault(
                    at(),
                    &message,
                    format!("choose one by its order: `time: \"{header}#1\"`"),
                );
                return None;
            }
            FoundColumn::Absent => None,
        };
        let Some(place) = place else {
            let message = self.table.lacks(header);
            let help = match did_you_mean(header, self.table.names.iter().map(String::as_str)) {
                Some(close) => format!("write `time: {close}`"),
                None => "state the column of the time, `time: ...`".to_owned(),
            };
            self.fault(at(), &message, help);
            return None;
        };
        let unit = self.unit(("time", "s"), place, header, notes)?;
        Some(Column {
            name: "time",
            place,
            header: header.to_owned(),
            change: 1.0,
            unit: Some(unit),
        })
    }
}

fn changed(header: &str, quantity: &str, scale: f64, sign: f64) -> Option<String> {
    let scaled = (scale != 1.0).then(|| format!("multiplied by {scale}"));
    let turned = (sign < 0.0).then(|| "with the opposite sign".to_owned());
    let words: Vec<String> = scaled.into_iter().chain(turned).collect();
    (!words.is_empty()).then(|| format!("column `{header}` is read {} as {quantity}", words.join(", ")))
}
