//! Load spectra: torques and speeds with their shares of the time.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Demand, Given, Interval};
use crate::measured::{MeasuredFault, TableForm, fault};
use gearloss_document::data::missing::CELL_HELP;
use gearloss_document::data::sheet::{Assigned, Sheet, Wanted, limited_faults};
use gearloss_framework::description::Ordered;

/// The load cases of a spectrum: a list, or a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Spectrum {
    /// The loads.
    Loads(#[schemars(length(min = 1))] Vec<SpectrumPoint>),
    /// A file with a row for each load case.
    File(Box<SpectrumFile>),
}

/// One load case of a spectrum.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
pub struct SpectrumPoint {
    /// Torque at the port. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed of the port. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Share of the time; all load cases have shares with the sum one, or all have times. In `points` of an analysis they may be omitted: equal shares. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: Option<f64>,
    /// Time. [s]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub time: Option<f64>,
    /// Oil temperature. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub oil_temperature: Option<f64>,
}

/// A file of loads.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SpectrumFile {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4), relative to the study.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Note for the report: origin of these data, or that they are synthetic.
    pub about: Option<String>,
    /// Column of each quantity, unless it has the name of the quantity. Quantities: `torque`, `speed`, `share` or `time`,
    /// `oil_temperature`.
    #[serde(default)]
    pub columns: Ordered<String>,
    /// Unit of each quantity, unless the header or a row of units states it.
    #[serde(default)]
    pub units: Ordered<String>,
    /// `units` have precedence where the file states different ones; otherwise that is an error.
    #[serde(default)]
    pub units_override: bool,
    /// How the file is written.
    #[serde(flatten)]
    pub form: TableForm,
}

const QUANTITIES: [Wanted; 5] = [
    ("torque", "Nm"),
    ("speed", "rpm"),
    ("share", "-"),
    ("time", "s"),
    ("oil_temperature", "degC"),
];

impl SpectrumFile {
    /// Reads the bytes of the file.
    pub(super) fn read(&self, bytes: &[u8]) -> Result<Vec<SpectrumPoint>, Vec<MeasuredFault>> {
        let sheet = Sheet::open(
            bytes,
            &self.form,
            &QUANTITIES,
            Assigned {
                columns: Some(&self.columns),
                units: Some(&self.units),
                units_override: self.units_override,
            },
        )?;
        if let Some(place) = sheet.omitted.first() {
            return Err(sheet.table.placed(vec![fault(
                format!("{place}: a load case with a missing value"),
                "complete the value, or delete the row and correct the shares",
            )]));
        }
        let due = [("the torque", "torque"), ("the speed", "speed")];
        let lacks: Vec<_> = due
            .iter()
            .enumerate()
            .filter(|(place, _)| !sheet.holds(*place))
            .map(|(_, (what, name))| sheet.lacks(what, name))
            .collect();
        if !lacks.is_empty() {
            return Err(sheet.table.placed(lacks));
        }
        let load = |row: usize| -> Result<SpectrumPoint, String> {
            Ok(SpectrumPoint {
                torque: sheet.number(row, 0)?.unwrap_or(0.0),
                speed: sheet.number(row, 1)?.unwrap_or(0.0),
                share: sheet.not_negative(row, 2)?,
                time: sheet.not_negative(row, 3)?,
                oil_temperature: sheet.temperature(row, 4)?,
            })
        };
        let mut faulty = Vec::new();
        let mut loads = Vec::new();
        for row in 0..sheet.table.rows.len() {
            match load(row) {
                Ok(load) => loads.push(load),
                Err(reason) => faulty.push(reason),
            }
        }
        if faulty.is_empty() {
            Ok(loads)
        } else {
            Err(sheet.table.placed(limited_faults(faulty, CELL_HELP)))
        }
    }
}

/// Loads of an analysis, over one hour if they have no times. Without times and shares they have equal shares; in a spectrum, whose column of
/// shares may have another name, that is an error.
pub(crate) fn points(loads: &[SpectrumPoint]) -> Result<Vec<Interval>, Vec<MeasuredFault>> {
    let mut loads = loads.to_vec();
    if loads.iter().all(|l| l.share.is_none() && l.time.is_none()) {
        let share = 1.0 / loads.len() as f64;
        for load in &mut loads {
            load.share = Some(share);
        }
    }
    intervals(&loads, super::cycle::hour())
}

/// The load cases in sequence, with their times or shares of a duration.
pub(super) fn intervals(loads: &[SpectrumPoint], duration: f64) -> Result<Vec<Interval>, Vec<MeasuredFault>> {
    let help = "state `share` for all loads, or `time` for all loads";
    let times: Vec<f64> = if loads.iter().all(|l| l.share.is_some() && l.time.is_none()) {
        let shares: Vec<f64> = loads.iter().filter_map(|l| l.share).collect();
        let sum: f64 = shares.iter().sum();
        // The sum of rounded shares may differ slightly from one.
        if (sum - 1.0).abs() > 0.01 {
            return Err(vec![fault(
                format!("the sum of the shares is {}, not one", (sum * 1e4).round() / 1e4),
                "correct the shares, or state times",
            )]);
        }
        shares.iter().map(|share| share / sum * duration).collect()
    } else if loads.iter().all(|l| l.time.is_some() && l.share.is_none()) {
        loads.iter().filter_map(|l| l.time).collect()
    } else {
        return Err(vec![fault(
            "loads have inconsistent keys: each needs either `share` or `time`, the same for all",
            help,
        )]);
    };
    if times.iter().all(|time| *time <= 0.0) {
        return Err(vec![fault("all loads have zero time", help)]);
    }
    let mut start = 0.0;
    let mut intervals = Vec::new();
    for (load, time) in loads.iter().zip(times).filter(|(_, time)| *time > 0.0) {
        let demand = if load.torque == 0.0 && load.speed == 0.0 {
            Demand::Rest
        } else {
            Demand::Port {
                torque: load.torque,
                speed: load.speed,
            }
        };
        intervals.push(Interval {
            inclination: 0.0,
            start,
            duration: time,
            demand,
            given: Given {
                oil_temperature: load.oil_temperature,
                ..Given::default()
            },
        });
        start += time;
    }
    Ok(intervals)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn load(torque: f64, share: Option<f64>, time: Option<f64>) -> SpectrumPoint {
        SpectrumPoint {
            torque,
            speed: 100.0,
            share,
            time,
            oil_temperature: Some(80.0),
        }
    }

    fn file() -> SpectrumFile {
        SpectrumFile {
            file: "spectrum.csv".to_owned(),
            about: None,
            columns: Ordered::default(),
            units: Ordered::default(),
            units_override: false,
            form: TableForm::default(),
        }
    }

    #[test]
    fn shares_are_of_the_duration_and_times_of_themselves() {
        let shares = intervals(&[load(10.0, Some(0.25), None), load(20.0, Some(0.75), None)], 3600.0).unwrap();
        assert_eq!(
            (shares[0].duration, shares[1].start, shares[1].duration),
            (900.0, 900.0, 2700.0)
        );
        assert_eq!(shares[1].given.oil_temperature, Some(80.0));
        let bare = [load(10.0, None, None), load(20.0, None, None)];
        let equal = points(&bare).unwrap();
        assert_eq!((equal[0].duration, equal[1].duration), (1800.0, 1800.0));
        assert!(intervals(&bare, 3600.0).is_err());
        let times = intervals(&[load(10.0, None, Some(5.0)), load(20.0, None, Some(0.0))], 3600.0).unwrap();
        assert_eq!(times.len(), 1);
        let demand = Demand::Port {
            torque: 10.0,
            speed: 100.0,
        };
        assert_eq!((times[0].duration, times[0].demand), (5.0, demand));
    }

    #[test]
    fn a_spectrum_that_does_not_add_up_is_refused() {
        let message = |loads: &[SpectrumPoint]| intervals(loads, 3600.0).unwrap_err()[0].message.clone();
        let shares = [load(10.0, Some(0.25), None), load(20.0, Some(0.7), None)];
        assert_eq!(message(&shares), "the sum of the shares is 0.95, not one");
        let mixed = [load(10.0, Some(0.25), None), load(20.0, None, Some(7.0))];
        assert_eq!(
            message(&mixed),
            "loads have inconsistent keys: each needs either `share` or `time`, the same for all"
        );
        assert_eq!(message(&[load(10.0, None, Some(0.0))]), "all loads have zero time");
    }

    #[test]
    fn a_file_of_loads_is_read_in_its_units() {
        let loads = file()
            .read(b"torque [Nm],speed [rpm],share [%]\n10,3000,40\n-5,0,60\n")
            .unwrap();
        assert_eq!(loads[0].share, Some(0.4));
        assert!((loads[0].speed - 100.0 * std::f64::consts::PI).abs() < 1e-9);
        let faults = file().read(b"T [Nm],speed [rpm],share\n10,3000,0.4\n").unwrap_err();
        assert_eq!(
            faults[0].message,
            "line 1: there is no column for the torque; there are: T, speed, share"
        );
        let faults = file()
            .read(b"torque [Nm],speed [rpm],share\n10,3000,0.4\n1,x,0.6\n2,2,-1\n")
            .unwrap_err();
        assert_eq!(faults[0].message, "line 3, column 2 `speed`: `x` is not a number");
        assert_eq!(faults[1].message, "line 4, column 3 `share`: `-1` is negative");
    }
}
