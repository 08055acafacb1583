//! Cycles over distance, as those of VECTO: target speeds, grades and stops along a route become a series over time.
//!
//! Source: VECTO, driving cycles over distance (`.vdri`): a target speed holds from its row to the next one, and a row with a target of
//! zero is a stop, behind which the target of the next row holds. VECTO's driver follows acceleration curves of the vehicle class; here
//! acceleration and braking are constant. The vehicle accelerates as soon and brakes as late as it can without exceeding a target.

use super::{MOST_INTERVALS, Sample, tidy};
use crate::measured::{MeasuredFault, fault};

/// A row of the file; SI.
#[derive(Debug, Clone)]
pub(super) struct Row {
    /// \[m\]
    pub distance: f64,
    /// Time at standstill. \[s\]
    pub stop: f64,
    /// Its target speed is the speed of the vehicle.
    pub sample: Sample,
}

impl Row {
    fn target(&self) -> f64 {
        self.sample.given.vehicle_speed.unwrap_or(0.0)
    }
}

/// How the vehicle follows the targets. \[m/s2\]
#[derive(Debug, Clone, Copy)]
pub(super) struct Driver {
    pub acceleration: f64,
    pub deceleration: f64,
}

/// Longest step in which the speed changes or is held. \[s\]
const STEP: f64 = 1.0;
/// Shorter pieces of the route are rounding errors. \[m\]
const SHORTEST: f64 = 1e-9;

/// The route over time, from zero on.
///
/// # Errors
/// Distances that do not increase, stops at a speed, rows at zero speed one after the other, and too many steps.
pub(super) fn over_time(rows: &[Row], driver: Driver) -> Result<Vec<Sample>, Vec<MeasuredFault>> {
    let found = wrong_rows(rows);
    if !found.is_empty() {
        return Err(found);
    }
    let targets: Vec<f64> = rows
        .windows(2)
        .map(|pair| {
            if pair[0].target() > 0.0 {
                pair[0].target()
            } else {
                pair[1].target()
            }
        })
        .collect();
    let speeds = speeds_at_rows(rows, &targets, driver);
    let mut route = Route {
        samples: Vec::new(),
        time: 0.0,
    };
    for (i, row) in rows.iter().enumerate() {
        route.stop(row, if i == 0 { Some(speeds[0]) } else { None });
        let Some(next) = rows.get(i + 1) else { break };
        let length = next.distance - row.distance;
        let (from, to) = (speeds[i], speeds[i + 1]);
        let Driver {
            acceleration: up,
            deceleration: down,
        } = driver;
        // Where both would meet without a target.
        let meet = ((2.0 * up * down * length + down * from * from + up * to * to) / (up + down)).sqrt();
        let peak = targets[i].min(meet).max(from).max(to);
        let rising = ((peak * peak - from * from) / (2.0 * up)).min(length);
        let falling = ((peak * peak - to * to) / (2.0 * down)).min(length - rising);
        let mut at = 0.0;
        for (piece, from, to) in [
            (rising, from, peak),
            (length - rising - falling, peak, peak),
            (falling, peak, to),
        ] {
            if piece > SHORTEST {
                route.drive([row, next], at, piece, [from, to])?;
                at += piece;
            }
        }
    }
    Ok(route.samples)
}

fn wrong_rows(rows: &[Row]) -> Vec<MeasuredFault> {
    let mut found = Vec::new();
    for row in rows.iter().filter(|row| row.stop > 0.0 && row.target() > 0.0) {
        found.push(fault(
            format!(
                "line {}: a stop of {} s at a speed above zero",
                row.sample.line,
                tidy(row.stop)
            ),
            "write the speed 0 in the row of a stop",
        ));
    }
    for pair in rows.windows(2) {
        let [a, b] = pair else { continue };
        if b.distance <= a.distance {
            found.push(fault(
                format!(
                    "line {}: the distance {} m does not increase; line {} has {} m",
                    b.sample.line, b.distance, a.sample.line, a.distance
                ),
                "sort the rows by distance and remove duplicates",
            ));
        } else if a.target() <= 0.0 && b.target() <= 0.0 {
            found.push(fault(
                format!(
                    "line {}: the speed is 0 here and in line {}: the {} m between them are never driven",
                    b.sample.line,
                    a.sample.line,
                    tidy(b.distance - a.distance)
                ),
                "write a stop into one row, with its time, and target speeds between stops",
            ));
        }
    }
    found.truncate(20);
    found
}

/// The speeds at the rows: below the targets on both sides, and within what the vehicle can accelerate and brake.
fn speeds_at_rows(rows: &[Row], targets: &[f64], driver: Driver) -> Vec<f64> {
    let mut speeds: Vec<f64> = (0..rows.len())
        .map(|i| {
            let sides = [i.checked_sub(1).and_then(|i| targets.get(i)), targets.get(i)];
            sides.into_iter().flatten().fold(rows[i].target(), |a, b| a.min(*b))
        })
        .collect();
    for i in 1..rows.len() {
        let length = rows[i].distance - rows[i - 1].distance;
        let reached = (speeds[i - 1].powi(2) + 2.0 * driver.acceleration * length).sqrt();
        speeds[i] = speeds[i].min(reached);
    }
    for i in (1..rows.len()).rev() {
        let length = rows[i].distance - rows[i - 1].distance;
        let braked = (speeds[i].powi(2) + 2.0 * driver.deceleration * length).sqrt();
        speeds[i - 1] = speeds[i - 1].min(braked);
    }
    speeds
}

/// The samples so far.
struct Route {
    samples: Vec<Sample>,
    time: f64,
}

impl Route {
    /// The start of the route with its speed, and the time of a stop.
    fn stop(&mut self, row: &Row, start: Option<f64>) {
        if let Some(speed) = start {
            self.put(row, speed, row.sample.grade);
        }
        if row.stop > 0.0 {
            self.time += row.stop;
            self.put(row, 0.0, row.sample.grade);
        }
    }

    /// A piece of the way between two rows with a constant acceleration, in equal steps of time. The grade changes linearly from row to row.
    fn drive(
        &mut self,
        [row, next]: [&Row; 2],
        at: f64,
        piece: f64,
        [from, to]: [f64; 2],
    ) -> Result<(), Vec<MeasuredFault>> {
        let duration = 2.0 * piece / (from + to);
        let steps = (duration / STEP - 1e-9).ceil().max(1.0);
        let is_short = self.samples.len() as f64 + steps < MOST_INTERVALS as f64;
        if !is_short {
            return Err(vec![fault(
                format!(
                    "line {}: the way to this row takes {} s",
                    next.sample.line,
                    tidy(duration)
                ),
                "check the speeds, the distances and their units",
            )]);
        }
        let start = self.time;
        let length = next.distance - row.distance;
        for step in 1..=steps as u64 {
            let share = step as f64 / steps;
            let speed = from + (to - from) * share;
            let gone = at + 0.5 * (from + speed) * duration * share;
            let place = (gone / length).clamp(0.0, 1.0);
            self.time = start + duration * share;
            self.put(
                row,
                speed,
                row.sample.grade + (next.sample.grade - row.sample.grade) * place,
            );
        }
        Ok(())
    }

    fn put(&mut self, row: &Row, speed: f64, grade: f64) {
        let mut sample = row.sample.clone();
        sample.time = self.time;
        sample.grade = grade;
        sample.given.vehicle_speed = Some(speed);
        self.samples.push(sample);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::duty::Given;

    fn row(distance: f64, speed: f64, stop: f64) -> Row {
        Row {
            distance,
            stop,
            sample: Sample {
                line: 2,
                grade: distance / 1000.0,
                given: Given {
                    vehicle_speed: Some(speed),
                    ..Given::default()
                },
                ..Sample::default()
            },
        }
    }

    const DRIVER: Driver = Driver {
        acceleration: 1.0,
        deceleration: 1.0,
    };

    fn speed(sample: &Sample) -> f64 {
        sample.given.vehicle_speed.unwrap()
    }

    /// 2 s, 50 m up to 10 m/s and as much down, 1 m between, 3 s.
    #[test]
    fn stops_and_targets_give_the_time_of_a_route() {
        let samples = over_time(&[row(0.0, 0.0, 2.0), row(1.0, 10.0, 0.0), row(101.0, 0.0, 3.0)], DRIVER).unwrap();
        let last = samples.last().unwrap();
        assert!((last.time - 25.1).abs() < 1e-9, "{}", last.time);
        let way: f64 = samples
            .windows(2)
            .map(|pair| 0.5 * (speed(&pair[0]) + speed(&pair[1])) * (pair[1].time - pair[0].time))
            .sum();
        assert!((way - 101.0).abs() < 1e-9, "{way}");
        assert!(samples.windows(2).all(|pair| {
            let step = pair[1].time - pair[0].time;
            let change = (speed(&pair[1]) - speed(&pair[0])).abs();
            step > 0.0 && change <= step + 1e-9
        }));
        let fastest = samples.iter().map(speed).fold(0.0, f64::max);
        assert!((fastest - 10.0).abs() < 1e-9);
        assert_eq!(
            (speed(&samples[0]), speed(&samples[1]), samples[1].time),
            (0.0, 0.0, 2.0)
        );
    }

    /// A lower target is reached where it begins, a higher one behind its beginning.
    #[test]
    fn targets_are_never_exceeded() {
        let rows = [
            row(0.0, 20.0, 0.0),
            row(500.0, 5.0, 0.0),
            row(600.0, 15.0, 0.0),
            row(1000.0, 15.0, 0.0),
        ];
        let samples = over_time(&rows, DRIVER).unwrap();
        let mut way = 0.0;
        for pair in samples.windows(2) {
            way += 0.5 * (speed(&pair[0]) + speed(&pair[1])) * (pair[1].time - pair[0].time);
            let target = if way < 500.0 - 1e-6 {
                20.0
            } else if way < 600.0 + 1e-6 {
                5.0
            } else {
                15.0
            };
            let place = if (way - 500.0).abs() < 1e-6 { 5.0 } else { target };
            assert!(speed(&pair[1]) <= place + 1e-9, "{way} {}", speed(&pair[1]));
            // The grade follows the way.
            assert!((pair[1].grade - way / 1000.0).abs() < 1e-9);
        }
        assert!((way - 1000.0).abs() < 1e-6);
    }

    #[test]
    fn impossible_rows_are_named() {
        let told = |rows: &[Row]| over_time(rows, DRIVER).unwrap_err()[0].message.clone();
        assert!(told(&[row(0.0, 0.0, 0.0), row(5.0, 0.0, 1.0)]).contains("are never driven"));
        assert!(told(&[row(0.0, 5.0, 3.0), row(5.0, 1.0, 0.0)]).contains("a stop of 3 s at a speed above zero"));
        assert!(told(&[row(5.0, 5.0, 0.0), row(5.0, 1.0, 0.0)]).contains("does not increase"));
        assert!(told(&[row(0.0, 1e-9, 0.0), row(1e9, 1e-9, 0.0)]).contains("the way to this row takes"));
    }
}
