//! Where losses arise: stacks of bars over speed, torque or temperature.

mod bars;

use gearloss_studies::analysis::{Given, PointResult, notes};
use gearloss_studies::measured::{Measured, Seen};
use gearloss_studies::study::{As, BreakdownEntry, Over, Quantity, SpinLossEntry, TemperatureSweepEntry};
use serde_json::Value;

use self::bars::{Bars, Kind, Row};
use super::super::solve::RPM;
use super::write::{head, write};
use super::{Built, Runner, axis, gear_of, speeds, torques};
use crate::output::{Failure, Out, fixed};
use gearloss_studies::analyses::numbers::tidy;

pub fn run(runner: &Runner<'_>, name: &str, entry: &BreakdownEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let measured = match &entry.measured {
        Some(data) => runner.read_at_ports(&format!("{path}.measured"), data, &[])?,
        None => Measured::default(),
    };
    for note in &measured.notes {
        out.line(format!("{name}: measured: {note}"))?;
    }
    let mut bars = Bars::new(Kind::new(name, entry.by, entry.unit, &entry.write), &built);
    for b in &built {
        let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, &b.transmission)?;
        let loads = loads(runner, &path, entry, b)?;
        runner.holds(&path, speeds.len(), loads.len())?;
        let gear = gear_of(entry.gear.as_deref(), &b.transmission);
        let ratio = ratio(runner, b, gear)?;
        let at = |load: &Load, speed: f64| Given {
            torque: load.torque(ratio * speed),
            speed,
            oil: None,
        };
        let rows: Vec<(String, Vec<(String, Given)>)> = match entry.over {
            Over::Speed => loads
                .iter()
                .map(|load| {
                    let bars = speeds.iter().map(|w| (fixed(w * RPM, 0), at(load, *w)));
                    (load.words(), bars.collect())
                })
                .collect(),
            Over::Torque => speeds
                .iter()
                .map(|w| {
                    let bars = loads.iter().map(|load| (load.number(), at(load, *w)));
                    (format!("{} rpm", fixed(w * RPM, 0)), bars.collect())
                })
                .collect(),
        };
        let over = match (entry.over, &entry.power) {
            (Over::Speed, _) => "speed in rpm",
            (Over::Torque, None) => "torque in Nm",
            (Over::Torque, Some(_)) => "power in W",
        };
        let seen = |point: &PointResult| beside(&measured, point, gear);
        solve(runner, b, gear, (over, rows), &seen, &mut bars, out)?;
    }
    finish(runner, name, &built, &bars)
}

/// Speed of the port with given torque over that of the port with given speed.
fn ratio(runner: &Runner<'_>, b: &Built<'_>, gear: &str) -> Result<f64, Failure> {
    let t = &b.transmission;
    let case = runner.case(b.gearbox, t, &runner.points(t, gear, Vec::new(), Vec::new()))?;
    let port = |ports: &[usize]| ports.first().map(|p| t.ports()[*p].member);
    let speeds = t.speeds(&case, &vec![1.0; case.speed_ports.len()]);
    Ok(port(&case.torque_ports).map_or(1.0, |member| speeds[member]))
}

/// What stays the same while the speed changes.
enum Load {
    Torque(f64),
    Power(f64),
}

impl Load {
    fn torque(&self, speed: f64) -> f64 {
        match self {
            Self::Torque(torque) => *torque,
            Self::Power(power) => power / speed,
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Torque(torque) => format!("{} Nm", tidy(*torque)),
            Self::Power(power) => format!("{} W", tidy(*power)),
        }
    }

    fn number(&self) -> String {
        match self {
            Self::Torque(x) | Self::Power(x) => format!("{}", tidy(*x)),
        }
    }
}

fn loads(runner: &Runner<'_>, path: &str, entry: &BreakdownEntry, b: &Built<'_>) -> Result<Vec<Load>, Failure> {
    match (&entry.torque, &entry.power) {
        (Some(own), None) => {
            let values = torques(runner, &format!("{path}.torque"), own, &b.transmission)?;
            Ok(values.into_iter().map(Load::Torque).collect())
        }
        (None, Some(own)) => {
            let values = axis(runner, &format!("{path}.power"), own.values())?;
            let turning = speeds(runner, &format!("{path}.speed"), &entry.speed, &b.transmission)?;
            if turning.contains(&0.0) {
                let speed = format!("{path}.speed");
                return Err(runner.wrong(&speed, "no torque gives a power at standstill", "leave 0 rpm out"));
            }
            Ok(values.into_iter().map(Load::Power).collect())
        }
        _ => Err(runner.wrong(
            path,
            "a breakdown needs either `torque` or `power`",
            "write `torque: 10 Nm`, or `power: 5 kW` for one power at every speed",
        )),
    }
}

/// Mean measured loss of the points within 2 % of torque and speed and 5 K of the oil, and the greatest of their accuracies. \[W\]
fn beside(measured: &Measured, point: &PointResult, gear: &str) -> Option<(f64, f64)> {
    let near = |a: Option<f64>, b: f64| a.is_some_and(|a| (a - b).abs() <= 0.02 * b.abs().max(1e-9));
    let (mut sum, mut accuracy, mut count) = (0.0, 0.0_f64, 0.0);
    for row in &measured.rows {
        let value = |quantity: &str| measured.value(row, quantity);
        let same = row.gear.as_deref().is_none_or(|g| g == gear);
        let warm = value("oil_temperature")
            .zip(point.oil)
            .is_none_or(|(a, b)| (a - b).abs() <= 5.0);
        if !(same && warm && near(value("torque"), point.torque) && near(value("speed"), point.speed)) {
            continue;
        }
        let seen = Seen::of(measured, row, point);
        let Some(loss) = seen.quantity(Quantity::Loss) else {
            continue;
        };
        sum += loss;
        count += 1.0;
        accuracy = accuracy.max(seen.accuracy(Quantity::Loss).unwrap_or(0.0));
    }
    (count > 0.0).then(|| (sum / count, accuracy))
}

/// Solves rows of bars and shows them.
fn solve(
    runner: &Runner<'_>,
    b: &Built<'_>,
    gear: &str,
    (over, rows): (&str, Vec<(String, Vec<(String, Given)>)>),
    measured: &dyn Fn(&PointResult) -> Option<(f64, f64)>,
    bars: &mut Bars<'_>,
    out: &mut Out,
) -> Result<(), Failure> {
    let list = rows.iter().flat_map(|(_, bars)| bars.iter().map(|(_, given)| *given));
    let mut points = runner.listed(&b.transmission, gear, list.collect());
    points.terms = bars.needs_terms();
    if runner.checked(b, &points)? {
        return Ok(());
    }
    let solved = runner.solve(b, &points)?;
    let mut all = solved.points.into_iter();
    for (title, labels) in rows {
        let points = labels.into_iter().zip(all.by_ref());
        let row = Row {
            over,
            title,
            bars: points
                .map(|((label, _), point)| (label, measured(&point), point))
                .collect(),
        };
        bars.show(runner, b, gear, &row, out)?;
    }
    let seen = notes(&b.transmission, &solved.seen);
    runner.outside(&seen, out);
    out.line("")?;
    bars.close(b, gear, &seen);
    Ok(())
}

fn finish(runner: &Runner<'_>, name: &str, built: &[Built<'_>], bars: &Bars<'_>) -> Result<(), Failure> {
    if runner.only_checks {
        return Ok(());
    }
    let mut value = head(runner, &built.iter().collect::<Vec<_>>());
    value["breakdowns"] = Value::Array(bars.results.clone());
    write(runner, name, bars.formats(), &bars.header(), &bars.rows, &value)
}

/// Losses without load, in every gear state.
pub fn spin_loss(runner: &Runner<'_>, name: &str, entry: &SpinLossEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let turned = entry
        .turned_at
        .as_ref()
        .unwrap_or(&runner.study.entry.conditions.speed_at);
    let mut bars = Bars::new(Kind::new(name, entry.by, As::Watts, &entry.write), &built);
    for b in &built {
        let t = &b.transmission;
        let names: Vec<String> = t.ports().iter().map(|p| p.name.clone()).collect();
        let Some(turned_port) = names.iter().position(|n| n == turned) else {
            let known: Vec<&str> = names.iter().map(String::as_str).collect();
            let error = gearloss_framework::attach::dangling(&format!("{path}.turned_at"), "port", turned, &known);
            return Err(runner.study.findings(vec![error]).into());
        };
        let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, t)?;
        let states: Vec<&str> = if entry.gears.is_empty() {
            t.states().iter().map(|s| s.name.as_str()).collect()
        } else {
            entry.gears.iter().map(String::as_str).collect()
        };
        for gear in states {
            let state = t
                .state(gear)
                .map_err(|error| Failure::from(b.gearbox.findings(vec![error])))?;
            let state = &t.states()[state];
            // The other free ports stand still; the torque is zero at every port that is not turned.
            let mut speed_at = vec![turned.clone()];
            let others = state.speed_ports.iter().filter(|p| **p != turned_port);
            speed_at.extend(others.take(state.speed_ports.len() - 1).map(|p| names[*p].clone()));
            let resting = speed_at[1..].join(", ");
            let mut points = runner.points(t, gear, vec![0.0], speeds.clone());
            points.speed_at = speed_at;
            points.torque_at = names.iter().filter(|n| *n != turned).cloned().collect();
            points.terms = bars.needs_terms();
            if runner.checked(b, &points)? {
                continue;
            }
            let solved = runner.solve(b, &points)?;
            let mut title = format!("no load, `{turned}` turned");
            if !resting.is_empty() {
                title.push_str(&format!(", {resting} at rest"));
            }
            let bars_of = solved.points.into_iter();
            let row = Row {
                over: "speed in rpm",
                title,
                bars: bars_of.map(|p| (fixed(p.speed * RPM, 0), None, p)).collect(),
            };
            bars.show(runner, b, gear, &row, out)?;
            let seen = notes(t, &solved.seen);
            runner.outside(&seen, out);
            out.line("")?;
            bars.close(b, gear, &seen);
            // Not the port of the conditions, at which the other analyses give their speeds.
            if let Some(result) = bars.results.last_mut() {
                result["turned_at"] = turned.clone().into();
            }
        }
    }
    finish(runner, name, &built, &bars)
}

/// Where losses arise, over the temperature of the oil.
pub fn temperature_sweep(
    runner: &Runner<'_>,
    name: &str,
    entry: &TemperatureSweepEntry,
    out: &mut Out,
) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let temperatures = axis(
        runner,
        &format!("{path}.oil_temperature"),
        entry.oil_temperature.values(),
    )?;
    let mut bars = Bars::new(Kind::new(name, entry.by, entry.unit, &entry.write), &built);
    for b in &built {
        let t = &b.transmission;
        let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, t)?;
        let torques = torques(runner, &format!("{path}.torque"), &entry.torque, t)?;
        runner.holds(&path, torques.len().saturating_mul(speeds.len()), temperatures.len())?;
        let gear = gear_of(entry.gear.as_deref(), t);
        let mut rows = Vec::new();
        for torque in &torques {
            for speed in &speeds {
                let bars = temperatures.iter().map(|oil| {
                    let given = Given {
                        torque: *torque,
                        speed: *speed,
                        oil: Some(*oil),
                    };
                    (format!("{oil}"), given)
                });
                rows.push((
                    format!("{} Nm, {} rpm", tidy(*torque), fixed(speed * RPM, 0)),
                    bars.collect(),
                ));
            }
        }
        solve(
            runner,
            b,
            gear,
            ("oil temperature in degC", rows),
            &|_| None,
            &mut bars,
            out,
        )?;
    }
    finish(runner, name, &built, &bars)
}
