//! A time series: checked rows of a file, and the intervals between them.

mod distance;

use super::{Demand, FileCycleEntry, Given, Interval, STANDARD_GRAVITY, Vehicle};
use crate::measured::{MeasuredFault, fault};
use gearloss_document::data::missing::CELL_HELP;
use gearloss_document::data::sheet::{Assigned, Sheet, Wanted, limited_faults};
use gearloss_framework::sump::apparent_grade;

/// One row of a series; SI.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sample {
    /// Line in the file.
    pub line: u64,
    /// \[s\]
    pub time: f64,
    /// Torque and speed at the port, if recorded. \[Nm, rad/s\]
    pub port: Option<(f64, f64)>,
    /// Rise over run of the road. \[-\]
    pub grade: f64,
    /// Boundary conditions of the row.
    pub given: Given,
    /// Measured temperatures in the order of [`Trace::nodes`]. \[degC\]
    pub temperatures: Vec<f64>,
}

/// A series over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// The rows in ascending time; at least two.
    pub samples: Vec<Sample>,
    /// Nodes of the thermal network whose temperatures were measured.
    pub nodes: Vec<String>,
    /// Number of repetitions.
    pub repeat: u32,
    /// Notes on the detected format of the file.
    pub notes: Vec<String>,
}

/// Maximum number of intervals of a repeated series: one gigabyte.
const MOST_INTERVALS: usize = 5_000_000;

/// Steps longer than this many median steps are gaps.
const GAP: f64 = 5.0;

const TIME: usize = 0;
const VEHICLE_SPEED: usize = 1;
const GRADE: usize = 2;
const TORQUE: usize = 3;
const SPEED: usize = 4;
const OIL_FLOW: usize = 5;
const OIL_TEMPERATURE: usize = 6;
const COOLANT_FLOW: usize = 7;
const COOLANT_TEMPERATURE: usize = 8;
const AMBIENT: usize = 9;
const GEAR: usize = 10;

/// Quantities of a file in the order of the indices above, followed by nodes.
const QUANTITIES: [Wanted; 11] = [
    ("time", "s"),
    ("vehicle_speed", "m/s"),
    ("grade", "-"),
    ("torque", "Nm"),
    ("speed", "rpm"),
    ("oil_flow", "kg/s"),
    ("oil_temperature", "degC"),
    ("coolant_flow", "kg/s"),
    ("coolant_temperature", "degC"),
    ("ambient", "degC"),
    ("gear", ""),
];

/// Quantities of a cycle over distance instead of time. They are the last ones of a file, after the nodes.
const OF_DISTANCE: [Wanted; 2] = [(DISTANCE, "m"), ("stop", "s")];
const DISTANCE: &str = "distance";

impl Trace {
    /// Reads the bytes of the file of an entry.
    ///
    /// # Errors
    /// Errors with line and column: columns first, then cells, then times and speeds.
    pub fn read(entry: &FileCycleEntry, bytes: &[u8]) -> Result<Self, Vec<MeasuredFault>> {
        let sheet = open(entry, bytes)?;
        Self::from_sheet(entry, &sheet).map_err(|faults| sheet.table.placed(faults))
    }

    fn from_sheet(entry: &FileCycleEntry, sheet: &Sheet) -> Result<Self, Vec<MeasuredFault>> {
        let mut samples = Vec::new();
        let mut faulty = Vec::new();
        for row in 0..sheet.table.rows.len() {
            match sample(sheet, row, entry.temperatures.len()) {
                Ok(sample) => samples.push(sample),
                Err(reason) => faulty.push(reason),
            }
        }
        if !faulty.is_empty() {
            return Err(limited_faults(faulty, CELL_HELP));
        }
        let found = sheet.table.rows.len();
        let mut notes = sheet.notes.clone();
        if is_over_distance(entry) {
            samples = over_time(entry, sheet, samples)?;
            notes.push(format!(
                "distances were converted to times with an acceleration of {} and a deceleration of {} m/s2",
                entry.acceleration, entry.deceleration
            ));
        }
        let inside = |s: &Sample| entry.start.is_none_or(|t| s.time >= t) && entry.end.is_none_or(|t| s.time <= t);
        let ordered = not_rising(&samples);
        if !ordered.is_empty() {
            return Err(limited_faults(
                ordered,
                "sort the rows by time and remove duplicates; of a recording that restarts, read a part by `first_line` and `last_line`",
            ));
        }
        samples.retain(inside);
        if samples.len() < 2 {
            let help = if found < 2 {
                "check the file, its header and its separator"
            } else {
                "widen `start` and `end`"
            };
            let count = samples.len();
            let rows = if count == 1 { "row" } else { "rows" };
            return Err(vec![fault(
                format!("{count} {rows} of {found} can be used; a time series needs at least two"),
                help,
            )]);
        }
        // Steps of a route follow from its speeds.
        if !is_over_distance(entry) {
            let mut wrong = gaps(&samples, entry.gap);
            wrong.extend(jumps(&samples, entry));
            if !wrong.is_empty() {
                return Err(wrong);
            }
        }
        Ok(Self {
            samples,
            nodes: entry.temperatures.ids().map(str::to_owned).collect(),
            repeat: entry.repeat,
            notes,
        })
    }

    /// Time from the first row to the last, without repetitions. \[s\]
    pub fn duration(&self) -> f64 {
        match (self.samples.first(), self.samples.last()) {
            (Some(first), Some(last)) => last.time - first.time,
            _ => 0.0,
        }
    }

    /// The intervals between rows, with the mean of each value over its two rows and the gear of the first, including repetitions.
    ///
    /// # Errors
    /// If the rows have only the vehicle speed and no vehicle is stated.
    pub fn intervals(&self, vehicle: Option<&Vehicle>) -> Result<Vec<Interval>, MeasuredFault> {
        let count = self.samples.len().saturating_mul(self.repeat as usize);
        if count > MOST_INTERVALS {
            return Err(fault(
                format!(
                    "{} rows repeated {} times exceed {MOST_INTERVALS} intervals",
                    self.samples.len(),
                    self.repeat
                ),
                "use fewer repetitions or fewer rows",
            ));
        }
        let mut once = Vec::with_capacity(self.samples.len());
        for pair in self.samples.windows(2) {
            let [from, to] = pair else { continue };
            let duration = to.time - from.time;
            let given = mean_given(&from.given, &to.given);
            let grade = f64::midpoint(from.grade, to.grade);
            let speeds = [from, to].map(|sample| sample.given.vehicle_speed);
            let acceleration = match speeds {
                [Some(before), Some(after)] => (after - before) / duration,
                _ => 0.0,
            };
            let gravity = vehicle.map_or(STANDARD_GRAVITY, |vehicle| vehicle.gravity);
            let demand = match (from.port.zip(to.port), given.vehicle_speed, vehicle) {
                (Some((a, b)), ..) => match (f64::midpoint(a.0, b.0), f64::midpoint(a.1, b.1)) {
                    (0.0, 0.0) => Demand::Rest,
                    (torque, speed) => Demand::Port { torque, speed },
                },
                (None, Some(speed), Some(vehicle)) => vehicle.demand(speed, acceleration, grade),
                _ => {
                    return Err(fault(
                        "the cycle has a vehicle speed but no torque",
                        "state the `vehicle`, or columns of torque and speed at a port",
                    ));
                }
            };
            once.push(Interval {
                start: from.time,
                duration,
                demand,
                inclination: apparent_grade(grade, acceleration, gravity),
                given,
            });
        }
        let mut all = Vec::with_capacity(once.len() * self.repeat as usize);
        for time in 0..self.repeat {
            let later = f64::from(time) * self.duration();
            all.extend(once.iter().map(|interval| Interval {
                start: interval.start + later,
                ..interval.clone()
            }));
        }
        Ok(all)
    }
}

fn mean_given(a: &Given, b: &Given) -> Given {
    let mean = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| f64::midpoint(a, b));
    Given {
        vehicle_speed: mean(a.vehicle_speed, b.vehicle_speed),
        oil_flow: mean(a.oil_flow, b.oil_flow),
        oil_temperature: mean(a.oil_temperature, b.oil_temperature),
        coolant_flow: mean(a.coolant_flow, b.coolant_flow),
        coolant_temperature: mean(a.coolant_temperature, b.coolant_temperature),
        ambient: mean(a.ambient, b.ambient),
        gear: a.gear.clone(),
    }
}

fn open(entry: &FileCycleEntry, bytes: &[u8]) -> Result<Sheet, Vec<MeasuredFault>> {
    let mut wanted: Vec<Wanted> = QUANTITIES.to_vec();
    wanted.extend(entry.temperatures.ids().map(|node| (node, "degC")));
    let mut columns = entry.columns.clone();
    for (name, column) in entry.temperatures.iter() {
        if QUANTITIES.iter().any(|(quantity, _)| *quantity == name) {
            return Err(vec![fault(
                format!("the node `{name}` has the name of a quantity"),
                "rename the node",
            )]);
        }
        columns.0.push((name.to_owned(), column.clone()));
    }
    let over_distance = is_over_distance(entry);
    if !over_distance && entry.columns.get("stop").is_some() {
        return Err(vec![fault(
            "`stop` belongs to a cycle over distance",
            "state the column of `distance`, too, or delete `stop` from `columns` and `units`",
        )]);
    }
    if over_distance {
        if entry.columns.get("time").is_some() {
            return Err(vec![fault(
                "a cycle is over distance or over time",
                "delete `time` or `distance` from `columns`",
            )]);
        }
        wanted.extend(OF_DISTANCE);
    }
    let assigned = Assigned {
        columns: Some(&columns),
        units: Some(&entry.units),
        units_override: entry.units_override,
    };
    let sheet = Sheet::open_series(bytes, &entry.form, &wanted, assigned, "time")?;
    let mut lacks = Vec::new();
    if over_distance && (sheet.holds(TORQUE) || sheet.holds(SPEED)) {
        lacks.push(fault(
            "a cycle over distance has no torque and no speed at a port: its times follow from `vehicle_speed`",
            "delete `distance` from `columns`, or the columns of torque and speed from the file",
        ));
    }
    if over_distance && !sheet.holds(wanted.len() - OF_DISTANCE.len()) {
        lacks.push(sheet.lacks("the distance", DISTANCE));
    }
    if !over_distance && !sheet.holds(TIME) {
        let mut lack = sheet.lacks("the time", "time");
        lack.help
            .push_str("; a cycle over distance states `distance` under `columns`");
        lacks.push(lack);
    }
    match (sheet.holds(VEHICLE_SPEED), sheet.holds(TORQUE), sheet.holds(SPEED)) {
        (_, true, false) => lacks.push(sheet.lacks("the speed in addition to the torque", "speed")),
        (_, false, true) => lacks.push(sheet.lacks("the torque in addition to the speed", "torque")),
        (false, false, false) => lacks.push(sheet.lacks("the vehicle speed, or torque and speed", "vehicle_speed")),
        _ => {}
    }
    if lacks.is_empty() {
        Ok(sheet)
    } else {
        Err(sheet.table.placed(lacks))
    }
}

/// True if a column is stated as the distance.
fn is_over_distance(entry: &FileCycleEntry) -> bool {
    entry.columns.get(DISTANCE).is_some()
}

/// The rows of a cycle over distance as a series over time.
fn over_time(entry: &FileCycleEntry, sheet: &Sheet, samples: Vec<Sample>) -> Result<Vec<Sample>, Vec<MeasuredFault>> {
    let at = QUANTITIES.len() + entry.temperatures.ids().count();
    if !sheet.holds(at + 1) {
        untimed_stops(sheet, &samples)?;
    }
    let mut rows = Vec::new();
    let mut faulty = Vec::new();
    for (row, sample) in samples.into_iter().enumerate() {
        match (sheet.number(row, at), sheet.not_negative(row, at + 1)) {
            (Ok(distance), Ok(stop)) => rows.push(distance::Row {
                distance: distance.unwrap_or(0.0),
                stop: stop.unwrap_or(0.0),
                sample,
            }),
            (distance, stop) => faulty.extend(distance.err().into_iter().chain(stop.err())),
        }
    }
    if !faulty.is_empty() {
        return Err(limited_faults(faulty, "correct the cell, or delete the row"));
    }
    let driver = distance::Driver {
        acceleration: entry.acceleration,
        deceleration: entry.deceleration,
    };
    distance::over_time(&rows, driver)
}

/// Stops of a route in a file whose column of their times is not stated. The first and the last row stand without being a stop.
fn untimed_stops(sheet: &Sheet, samples: &[Sample]) -> Result<(), Vec<MeasuredFault>> {
    let column = sheet
        .table
        .names
        .iter()
        .find(|name| name.to_lowercase().contains("stop"));
    let stands = |sample: &&Sample| sample.given.vehicle_speed == Some(0.0);
    let between = samples.len().checked_sub(1).and_then(|last| samples.get(1..last));
    let first = match column {
        Some(_) => samples.iter().find(stands),
        None => between.unwrap_or_default().iter().find(stands),
    };
    let Some(first) = first else { return Ok(()) };
    let message = format!(
        "line {}: the vehicle stands here, and no column says for how long",
        first.line
    );
    let help = match column {
        Some(column) => format!("state its column: `columns: {{ stop: \"{column}\" }}`"),
        None => "add a column of the times at standstill, and state it: `columns: { stop: NAME }`".to_owned(),
    };
    Err(vec![fault(message, help)])
}

fn sample(sheet: &Sheet, row: usize, nodes: usize) -> Result<Sample, String> {
    let port = sheet.number(row, TORQUE)?.zip(sheet.number(row, SPEED)?);
    Ok(Sample {
        line: sheet.line(row),
        time: sheet.number(row, TIME)?.unwrap_or(0.0),
        port,
        grade: sheet.number(row, GRADE)?.unwrap_or(0.0),
        given: Given {
            vehicle_speed: sheet.not_negative(row, VEHICLE_SPEED)?,
            oil_flow: sheet.not_negative(row, OIL_FLOW)?,
            oil_temperature: sheet.temperature(row, OIL_TEMPERATURE)?,
            coolant_flow: sheet.not_negative(row, COOLANT_FLOW)?,
            coolant_temperature: sheet.temperature(row, COOLANT_TEMPERATURE)?,
            ambient: sheet.temperature(row, AMBIENT)?,
            gear: sheet.text(row, GEAR).map(str::to_owned),
        },
        temperatures: (QUANTITIES.len()..QUANTITIES.len() + nodes)
            .map(|place| Ok(sheet.number(row, place)?.unwrap_or(0.0)))
            .collect::<Result<_, String>>()?,
    })
}

/// Repeated or decreasing times.
fn not_rising(samples: &[Sample]) -> Vec<String> {
    let pairs = samples.windows(2).filter(|pair| pair[1].time <= pair[0].time);
    pairs
        .map(|pair| {
            let (a, b) = (&pair[0], &pair[1]);
            if a.time < b.time || b.time < a.time {
                format!(
                    "line {}: time {} s is before the {} s of line {}",
                    b.line, b.time, a.time, a.line
                )
            } else {
                format!("line {}: time {} s is already in line {}", b.line, b.time, a.line)
            }
        })
        .collect()
}

/// Steps that are much longer than the median.
fn gaps(samples: &[Sample], stated: Option<f64>) -> Vec<MeasuredFault> {
    let mut steps: Vec<f64> = samples.windows(2).map(|pair| pair[1].time - pair[0].time).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps[steps.len() / 2];
    // Differences of decimal times have rounding errors.
    let most = stated.unwrap_or(GAP * median) * (1.0 + 1e-9);
    let mut longest = 0.0_f64;
    let mut messages = Vec::new();
    for pair in samples.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let step = b.time - a.time;
        if step > most {
            longest = longest.max(step);
            messages.push(format!(
                "line {}: a gap of {} s, from {} s to {} s; the median step is {} s",
                b.line,
                tidy(step),
                a.time,
                b.time,
                tidy(median)
            ));
        }
    }
    limited_faults(
        messages,
        &format!("fill it, or accept it by `gap: {} s`", tidy(longest)),
    )
}

/// Implausible accelerations of vehicle or shaft.
fn jumps(samples: &[Sample], entry: &FileCycleEntry) -> Vec<MeasuredFault> {
    let rates = |value: fn(&Sample) -> Option<f64>| {
        samples.windows(2).filter_map(move |pair| {
            let change = value(&pair[1])? - value(&pair[0])?;
            Some((pair[1].line, change / (pair[1].time - pair[0].time)))
        })
    };
    let most = entry.most_acceleration;
    let vehicle = rates(|s| s.given.vehicle_speed).filter(|(_, a)| a.abs() > most);
    let vehicle = vehicle
        .map(|(line, a)| {
            format!(
                "line {line}: an acceleration of {} m/s2 from the previous line; the maximum is {} m/s2",
                tidy(a),
                tidy(most)
            )
        })
        .collect();
    let mut found = limited_faults(
        vehicle,
        "correct the speeds and their unit, or state `most_acceleration`",
    );
    if let Some(most) = entry.most_speed_change {
        let rpm = 30.0 / std::f64::consts::PI;
        let shaft = rates(|s| s.port.map(|(_, speed)| speed)).filter(|(_, a)| a.abs() > most);
        let shaft = shaft
            .map(|(line, a)| {
                format!(
                    "line {line}: the speed changes by {} rpm/s from the previous line; the maximum is {} rpm/s",
                    tidy(a * rpm),
                    tidy(most * rpm)
                )
            })
            .collect();
        found.extend(limited_faults(
            shaft,
            "correct the speeds and their unit, or state another `most_speed_change`",
        ));
    }
    found
}

/// A number without rounding errors in its last digits.
fn tidy(x: f64) -> f64 {
    let digits = 10_f64.powi(5 - x.abs().max(1e-30).log10().floor().clamp(-20.0, 20.0) as i32);
    (x * digits).round() / digits
}

#[cfg(test)]
mod tests;
