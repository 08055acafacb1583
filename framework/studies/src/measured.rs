//! Measured data files of rigs: separators, decimal commas, encodings, unit rows, faulty rows.
//!
//! The format of a file is detected and reported, or stated; a missing unit is an error.

mod accuracies;
mod columns;
mod condition;
mod constants;
mod files;
mod listed;
mod read;
mod rig;
mod seen;
mod steady;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::points::PointResult;
use gearloss_framework::description::Ordered;

use columns::KNOWN;

pub use accuracies::{
    Accuracies, AccuraciesEntry, EfficiencyAccuracyEntry, LossAccuracyEntry, LossTorqueAccuracyEntry,
    TemperatureAccuracyEntry,
};
pub use columns::{ChangedColumnEntry, ColumnEntry};
pub use condition::Condition;
pub use files::{FileEntry, MeasuredFile, MeasuredFiles, OwnFileEntry};
pub use gearloss_document::data::{FaultPlace, MeasuredFault, TableForm};
pub(crate) use gearloss_document::data::{cells as text, fault};
pub use listed::ListedPoint;
pub use rig::{Instruments, PortSpeeds, Powers, Rig, RigEntry, StatedAs, SupportLossEntry, TorqueMeterEntry};
pub use seen::{Seen, counted};
pub use steady::{SteadyEntry, SteadyLimitsEntry, Stretch};

/// Files of measured points and their settings.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MeasuredEntry {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4) relative to the study, or a list of files with the same quantities.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: MeasuredFiles,
    /// Note for the report: origin of these data, or that they are synthetic.
    pub about: Option<String>,
    /// Column of each quantity, unless it has the name of the quantity: `torque: T_in`, or with a factor and a sign `torque: { column:
    /// T_in, scale: 0.001, sign: -1 }`. Quantities: `torque` and `speed` at the ports of the conditions, `torque_out`, `speed_out`,
    /// `efficiency`, `loss`, `loss_torque`, `oil_temperature`, `surface_temperature`, `weight`, `gear`, `name`, and accuracies such as
    /// `efficiency_accuracy`. Torque and speed may both be given at the other port alone, by `torque_out` and `speed_out`.
    #[serde(default)]
    pub columns: Ordered<ColumnEntry>,
    /// Unit of each quantity, unless the header or a row of units states it: `efficiency: "%"`.
    #[serde(default)]
    pub units: Ordered<String>,
    /// Quantities that are the same in every row and have no column: `torque: 0 Nm` for a bearing that carries none.
    #[serde(default)]
    pub constants: Ordered<Value>,
    /// `units` have precedence where a file states different ones; otherwise that is an error.
    #[serde(default)]
    pub units_override: bool,
    /// How the file is written.
    #[serde(flatten)]
    pub form: TableForm,
    /// Treatment of rows with blanks or text instead of a number.
    #[serde(default)]
    pub faulty_rows: FaultyRows,
    /// Condition on the rows that are used: `torque > 10 Nm and speed < 3000 rpm`. Quantities, bound columns and headers; `==`, `!=`, `<`,
    /// `<=`, `>`, `>=`, `and`, `or`, `not`, parentheses. For a time series it selects among the steady intervals.
    pub rows: Option<String>,
    /// Steady intervals of a time series: each becomes one point.
    pub steady: Option<SteadyEntry>,
    /// Meaning of accuracies in columns, of quantities and of the instruments.
    #[serde(default)]
    pub stated_as: StatedAs,
    /// Coverage factor of expanded accuracies. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 1.0, max = 10.0))]
    pub coverage_factor: f64,
    /// Accuracy of measured quantities in percent of the reading and of the full scale. A column such as `loss_accuracy` has priority.
    #[serde(default)]
    pub accuracies: AccuraciesEntry,
    /// The rig: offsets of its torque meters, drag of its bearings, and its accuracy if no column states it.
    #[serde(default)]
    pub rig: RigEntry,
}

fn two() -> f64 {
    2.0
}

/// Treatment of rows with blanks or text instead of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FaultyRows {
    /// The file is rejected.
    #[default]
    Refuse,
    /// The row is omitted with a note.
    Skip,
    /// A blank omits only its quantity; torque, speed and bound columns still need a number, and text is an error.
    Keep,
}

/// One measured point; SI, temperatures in degC.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// Index of its file in [`Measured::files`].
    pub file: usize,
    /// Line in the file; the first line of averaged rows.
    pub line: u64,
    /// Name, if the file has names.
    pub name: Option<String>,
    /// Gear, if the file has gears.
    pub gear: Option<String>,
    /// Values in the order of [`Measured::quantities`]; absent if the cell is blank.
    pub values: Vec<Option<f64>>,
    /// Bound values as written, with their units.
    pub bound: Vec<String>,
    /// All cells of the row in the order of [`Measured::columns`], numbers with a decimal point; means of averaged rows.
    pub cells: Vec<String>,
    /// The averaged samples, if the point is a steady interval of a time series.
    pub stretch: Option<Stretch>,
}

/// A column of a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FileColumn {
    /// Name in the header.
    pub header: String,
    /// Bound name, if bound.
    pub bound: Option<String>,
    /// Symbol of its unit, if the header, the row of units or `units` states one.
    pub unit: Option<String>,
    /// Its quantity, if it is read as one.
    pub quantity: Option<&'static str>,
}

/// The measured data.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// Names of the files in messages.
    pub files: Vec<String>,
    /// Names of the numeric quantities of the file.
    pub quantities: Vec<&'static str>,
    /// All columns of the (first) file.
    pub columns: Vec<FileColumn>,
    /// The points.
    pub rows: Vec<Row>,
    /// Notes on the detected format and on omitted rows.
    pub notes: Vec<String>,
    /// Divisor from stated accuracies to standard deviations.
    pub divisor: f64,
    /// Contribution of the rig to its readings.
    pub rig: Rig,
    /// Instruments, if both torque meters are stated.
    pub instruments: Option<Instruments>,
    /// Accuracies of quantities without an accuracy column.
    pub accuracies: Accuracies,
    /// Standard deviation of the oil temperature, if no column states it. \[K\]
    pub oil_temperature: Option<f64>,
    /// True if `torque` was read from `torque_out`: the torque at the port other than that of the conditions, positive if power leaves a
    /// driven transmission there.
    pub torque_at_other_port: bool,
    /// True if `speed` was read from `speed_out`: the speed at the port other than that of the conditions, positive if the port of the
    /// conditions turns forward.
    pub speed_at_other_port: bool,
}

impl Measured {
    /// A quantity of a row; absent if the file or the row does not have it.
    pub fn value(&self, row: &Row, quantity: &str) -> Option<f64> {
        row.values.get(self.place(quantity)?).copied().flatten()
    }

    /// Index of a column by its bound name or its header.
    pub fn column(&self, name: &str) -> Option<usize> {
        let bound = self.columns.iter().position(|c| c.bound.as_deref() == Some(name));
        bound.or_else(|| self.columns.iter().position(|c| c.header == name))
    }

    /// True if the file has a quantity.
    pub fn holds(&self, quantity: &str) -> bool {
        self.quantities.contains(&quantity)
    }

    /// The torque of a row applied to the transmission at the port of the measurement. A meter at the other port is positive if power
    /// leaves a driven transmission: the applied torque there has the opposite sign, or the same sign if the transmission reverses the
    /// direction of rotation. \[Nm\]
    pub fn applied_torque(&self, torque: f64, point: &PointResult) -> f64 {
        if self.torque_at_other_port {
            -torque * sense(point.reference_speed * point.output_speed.unwrap_or(1.0))
        } else {
            torque
        }
    }

    fn place(&self, quantity: &str) -> Option<usize> {
        self.quantities.iter().position(|q| *q == quantity)
    }

    /// Place of a row for messages: its line, with the file if there are several.
    pub fn origin(&self, row: &Row) -> String {
        match self.file(row) {
            Some(file) => format!("{file}, line {}", row.line),
            None => format!("line {}", row.line),
        }
    }

    /// The line of a row for tables, with the file before a colon if there are several.
    pub fn line(&self, row: &Row) -> String {
        match self.file(row) {
            Some(file) => format!("{file}:{}", row.line),
            None => row.line.to_string(),
        }
    }

    /// Name of the file of a row, if there are several.
    pub fn file(&self, row: &Row) -> Option<&str> {
        let file = self.files.get(row.file).filter(|_| self.files.len() > 1);
        file.map(String::as_str)
    }

    /// Stated accuracy of a quantity in a row, from its column or from `accuracies` at a reading.
    pub fn stated_accuracy(&self, row: &Row, quantity: &str, reading: Option<f64>) -> Option<f64> {
        self.value(row, &format!("{quantity}_accuracy"))
            .or_else(|| self.accuracies.stated(quantity, reading?))
    }

    /// Standard error of the mean of a quantity, if the row is an average over a steady interval.
    pub fn standard_error(&self, row: &Row, quantity: &str) -> Option<f64> {
        let stretch = row.stretch.as_ref()?;
        stretch.standard_errors.get(self.place(quantity)?).copied().flatten()
    }
}

/// 1, or -1 below zero.
pub(crate) fn sense(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::json;

    use super::*;

    pub(crate) fn entry(columns: &[(&str, &str)], units: &[(&str, &str)]) -> MeasuredEntry {
        let map = |pairs: &[(&str, &str)]| -> serde_json::Map<String, serde_json::Value> {
            pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).into())).collect()
        };
        let entry = json!({ "file": "rig.csv", "columns": map(columns), "units": map(units), "stated_as": "standard" });
        serde_json::from_value(entry).unwrap()
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12 * b.abs().max(1.0)
    }

    #[test]
    fn a_german_rig_file_is_recognised_and_noted() {
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
    fn a_constant_stands_for_a_column() {
        let of = |constants: serde_json::Value| -> MeasuredEntry {
            serde_json::from_value(json!({ "file": "rig.csv", "stated_as": "standard", "constants": constants }))
                .unwrap()
        };
        let bytes: &[u8] = b"speed [rpm],loss [W]\n1000,3\n2000,7\n";
        let read = of(json!({ "torque": "0 Nm", "oil_temperature": 60 }))
            .read(bytes, &[])
            .unwrap();
        let at = |quantity: &str| {
            read.rows
                .iter()
                .map(|row| read.value(row, quantity).unwrap())
                .collect::<Vec<_>>()
        };
        assert_eq!(
            (at("torque"), at("oil_temperature")),
            (vec![0.0, 0.0], vec![60.0, 60.0])
        );
        let refused = |constants: serde_json::Value| of(constants).read(bytes, &[]).unwrap_err().remove(0).message;
        assert!(refused(json!({ "torque": "0 Nm", "loss": "3 W" })).contains("the file has a column for `loss`"));
        assert!(refused(json!({ "torque": "0 W" })).contains('W'));
        assert!(refused(json!({ "torgue": 0 })).contains("`torgue` is not a measured quantity"));
        assert!(refused(json!({})).contains("there is no column for the torque"));
    }

    #[test]
    fn nothing_is_guessed() {
        let refused = |entry: &MeasuredEntry, text: &str| {
            let faults = entry.read(text.as_bytes(), &[]).unwrap_err();
            let told = faults.iter().map(|fault| format!("{}: {}", fault.message, fault.help));
            told.collect::<Vec<_>>().join("\n")
        };
        let plain = entry(&[], &[]);
        assert!(refused(&plain, "torque,speed [rpm]\n1,2\n").contains("column `torque` has no unit"));
        assert!(refused(&plain, "torque [Nm],speed [rpm],efficiency\n1,2,0.9\n").contains("percent"));
        assert!(refused(&plain, "torque [rpm],speed [rpm]\n1,2\n").contains("`rpm` is an angular speed, not a torque"));
        assert!(refused(&plain, "torque [Nm],n [rpm]\n1,2\n").contains("there is no column for the speed"));
        assert!(
            refused(&entry(&[("speed", "n")], &[]), "torque [Nm],m [rpm]\n1,2\n").contains("there is no column `n`")
        );
        assert!(
            refused(&entry(&[("spede", "n")], &[]), "torque [Nm],n [rpm]\n1,2\n")
                .contains("`spede` is not a measured quantity")
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
    fn faulty_rows_are_refused_or_left_out_and_reported() {
        let text = b"torque [Nm],speed [rpm],loss [W]\n1,2,3\n1,2,\n1,x,3\n";
        let mut rig = entry(&[], &[]);
        let refused = rig.read(text, &[]).unwrap_err().remove(0);
        assert!(refused.message.contains("line 3, column 3 `loss`: empty") && refused.help.contains("skip"));
        rig.faulty_rows = FaultyRows::Skip;
        let read = rig.read(text, &[]).unwrap();
        assert_eq!(read.rows.len(), 1);
        assert!(
            read.notes
                .iter()
                .any(|n| n.contains("2 rows omitted") && n.contains("line 4, column 2 `speed`: `x`"))
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
            .unwrap_err()
            .remove(0);
        assert!(fault.message.contains("`volume`, which is bound"));
        assert_eq!(fault.place, FaultPlace::Bind("volume".to_owned()));
    }

    fn changed(entry: serde_json::Value) -> MeasuredEntry {
        serde_json::from_value(entry).unwrap()
    }

    #[test]
    fn columns_are_scaled_and_turned_before_their_unit() {
        let rig = changed(json!({
            "file": "rig.csv",
            "columns": { "torque": { "column": "T_wheel", "scale": 0.5, "sign": -1.0 } },
        }));
        let read = rig.read(b"T_wheel [kNm],speed [rpm]\n-0.2,3000\n", &[]).unwrap();
        assert!(close(read.value(&read.rows[0], "torque").unwrap(), 100.0));
        assert!(
            read.notes
                .contains(&"column `T_wheel` is read multiplied by 0.5, with the opposite sign as torque".to_owned()),
            "{:?}",
            read.notes
        );
        for (scale, sign, told) in [(0.0, 1.0, "a scale of zero"), (1.0, 0.5, "a sign of 0.5")] {
            let rig = changed(json!({
                "file": "rig.csv",
                "columns": { "torque": { "column": "T", "scale": scale, "sign": sign } },
            }));
            let fault = rig.read(b"T [Nm],speed [rpm]\n1,2\n", &[]).unwrap_err().remove(0);
            assert!(fault.message.contains(told), "{}", fault.message);
            assert_eq!(fault.place, FaultPlace::Entry("columns.torque".to_owned()));
        }
    }

    #[test]
    fn temperatures_may_be_in_kelvins() {
        for (unit, cell) in [
            ("K", "353.15"),
            ("°C", "80"),
            ("C", "80"),
            ("degC", "80"),
            ("degF", "176"),
        ] {
            let text = format!("torque [Nm],speed [rpm],oil_temperature [{unit}]\n1,2,{cell}\n");
            let read = entry(&[], &[]).read(text.as_bytes(), &[]).unwrap();
            let oil = read.value(&read.rows[0], "oil_temperature").unwrap();
            assert!((oil - 80.0).abs() < 1e-9, "{unit} {oil}");
        }
        let text = "torque [Nm],speed [rpm],oil_temperature [K]\n1,2,-5\n";
        let fault = entry(&[], &[]).read(text.as_bytes(), &[]).unwrap_err().remove(0);
        assert!(fault.message.contains("below absolute zero"), "{}", fault.message);
    }

    #[test]
    fn everything_that_is_wrong_is_reported_at_once() {
        let mut rig = entry(&[("loss", "P_loss"), ("efficency", "eta")], &[]);
        rig.columns.0.push(("efficiency".to_owned(), "eta".into()));
        let faults = rig
            .read(b"torque,speed [rpm],P_los [W],eta\n1,2,3,0.9\n1,x,3,0.9\n", &[])
            .unwrap_err();
        let places: Vec<&FaultPlace> = faults.iter().map(|fault| &fault.place).collect();
        let keys = [
            "columns.efficency",
            "units.torque",
            "units.efficiency",
            "columns.loss",
            "",
        ];
        assert_eq!(
            places,
            keys.map(|key| FaultPlace::Entry(key.to_owned()))
                .iter()
                .collect::<Vec<_>>(),
            "{faults:?}"
        );
        assert!(faults[0].help.starts_with("write `efficiency`"), "{}", faults[0].help);
        assert_eq!(faults[3].help, "write `P_los`");
        assert!(
            faults[4]
                .message
                .contains("line 3, column 2 `speed`: `x` is not a number")
        );
    }

    #[test]
    fn several_files_are_read_one_after_the_other() {
        let rig = changed(json!({
            "file": ["a.csv", { "file": "b.csv", "name": "second", "columns": { "torque": "T" }, "units": { "torque": "Nm" } }],
            "faulty_rows": "skip",
        }));
        let contents: [&[u8]; 2] = [
            b"torque [Nm],speed [rpm],p [bar]\n1,10,5\n2,20,6\n",
            b"speed [rpm],T,p [bar]\n30,3,7\nx,4,8\n",
        ];
        let read = rig.read_files(&contents, &[], &[]).unwrap();
        let torques: Vec<f64> = read.rows.iter().map(|row| read.value(row, "torque").unwrap()).collect();
        assert_eq!(torques, [1.0, 2.0, 3.0]);
        assert_eq!(read.origin(&read.rows[2]), "second, line 2");
        // The column of the torque has another header here.
        assert_eq!(read.rows[2].cells, ["", "30", "7"].map(str::to_owned));
        assert!(
            read.notes[0].starts_with("second: 1 rows omitted: line 3"),
            "{:?}",
            read.notes
        );
        let other: [&[u8]; 2] = [contents[0], b"speed [rpm],T,loss [W]\n30,3,7\n"];
        let fault = rig.read_files(&other, &[], &[]).unwrap_err().remove(0);
        assert_eq!(fault.message, "second: unlike a.csv it also has `loss`");
        let twice = changed(json!({ "file": ["a.csv", "a.csv"] }));
        let fault = twice
            .read_files(&[contents[0], contents[0]], &[], &[])
            .unwrap_err()
            .remove(0);
        assert!(fault.message.contains("listed twice"), "{}", fault.message);
    }

    #[test]
    fn torque_and_speed_may_stand_at_the_other_port_alone() {
        let read = entry(&[], &[])
            .read(b"torque_out [Nm],speed_out [rpm],loss [W]\n100,300,50\n", &[])
            .unwrap();
        assert!(read.torque_at_other_port && read.speed_at_other_port);
        assert!(close(read.value(&read.rows[0], "torque").unwrap(), 100.0));
        let read = entry(&[], &[])
            .read(b"torque [Nm],speed_out [rpm],torque_out [Nm]\n10,300,99\n", &[])
            .unwrap();
        assert!(!read.torque_at_other_port && read.speed_at_other_port);
        let renamed = entry(&[("torque_out", "torque"), ("speed_out", "speed")], &[]);
        let read = renamed
            .read(b"torque [Nm],speed [rpm],loss [W]\n100,300,50\n", &[])
            .unwrap();
        assert!(read.torque_at_other_port && read.speed_at_other_port);
    }

    #[test]
    fn rows_are_filtered_and_counted() {
        let text = b"torque [Nm],speed [rpm],loss [W]\n5,1000,1\n20,1000,2\n20,5000,3\n";
        let rig = changed(json!({ "file": "rig.csv", "rows": "torque > 10 Nm and speed < 3000 rpm" }));
        let read = rig.read(text, &[]).unwrap();
        assert_eq!(read.rows.iter().map(|row| row.line).collect::<Vec<_>>(), [3]);
        assert!(
            read.notes.iter().any(|note| note.contains("2 of 3 rows are omitted")),
            "{:?}",
            read.notes
        );
        for (rows, told) in [
            ("torque > 10", "no unit"),
            ("torqe > 1 Nm", "torqe"),
            ("torque > 100 Nm", "no row satisfies"),
        ] {
            let rig = changed(json!({ "file": "rig.csv", "rows": rows }));
            let fault = rig.read(text, &[]).unwrap_err().remove(0);
            assert!(fault.message.contains(told), "{}", fault.message);
            assert_eq!(fault.place, FaultPlace::Entry("rows".to_owned()));
        }
    }

    #[test]
    fn a_time_series_becomes_one_point_for_each_steady_stretch() {
        let rig = changed(json!({
            "file": "rig.csv",
            "units": { "time": "s" },
            "steady": { "time": "t", "window": 10.0, "drift": { "torque": 0.5 } },
            "accuracies": { "loss": { "absolute": 3.0 } },
            "stated_as": "standard",
        }));
        let mut text = "t,torque [Nm],speed [rpm],loss [W]\n".to_owned();
        for k in 0..300 {
            let torque = if k < 150 { 10.0 } else { 20.0 };
            let loss = 100.0 + f64::from(k % 2);
            text.push_str(&format!("{},{torque},1000,{loss}\n", 0.1 * f64::from(k)));
        }
        let read = rig.read(text.as_bytes(), &[]).unwrap();
        let losses: Vec<f64> = read.rows.iter().map(|row| read.value(row, "loss").unwrap()).collect();
        assert!(
            losses.len() == 2 && losses.iter().all(|loss| (loss - 100.5).abs() < 0.02),
            "{losses:?}"
        );
        assert!(read.standard_error(&read.rows[0], "loss").unwrap() < 0.1);
        assert!(
            read.notes.iter().any(|note| note.starts_with("2 steady intervals")),
            "{:?}",
            read.notes
        );
        let mut loose = rig.clone();
        loose.steady.as_mut().unwrap().drift = SteadyLimitsEntry::default();
        let fault = loose.read(text.as_bytes(), &[]).unwrap_err().remove(0);
        assert_eq!(fault.place, FaultPlace::Entry("steady.drift".to_owned()));
    }
}
