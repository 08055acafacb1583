//! The torque, or the speed, at which the balance reaches a given temperature.

use gearloss_framework::description::ThermalMode;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::Point;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::thermal::Limit;
use gearloss_report::Figure;
use gearloss_report::plot::{Line, Stroke};
use gearloss_studies::analysis::{Note, notes};
use gearloss_studies::study::{Find, ThermalLimitEntry};
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::write::{cell, head, picture, write};
use super::{Built, Runner, gear_of, speeds, torques};
use crate::output::{Failure, Out, Table, number};
use gearloss_studies::analyses::numbers::tidy;

/// The limit at one speed, or at one torque.
struct Found {
    temperature: f64,
    torque: Option<f64>,
    speed: Option<f64>,
    limit: Limit,
    loss: Option<f64>,
    input: Option<f64>,
    output: Option<f64>,
    efficiency: Option<f64>,
    /// Lowest temperature that keeps itself there: another one than the limit where several do. \[degC\]
    lowest: Option<f64>,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &ThermalLimitEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let header = [
        "model_set",
        "gear",
        "limit_degc",
        "torque_nm",
        "speed_rpm",
        "outcome",
        "loss_w",
        "input_w",
        "output_w",
        "efficiency",
        "lowest_balance_degc",
    ]
    .map(str::to_owned);
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    let (mut limits, mut powers) = (Vec::new(), Vec::new());
    for b in &built {
        needs_balance(runner, &path, b)?;
        let gear = gear_of(entry.gear.as_deref(), &b.transmission);
        let torques = torques(runner, &format!("{path}.torque"), &entry.torque, &b.transmission)?;
        let speeds = speeds(runner, &format!("{path}.speed"), &entry.speed, &b.transmission)?;
        match entry.find {
            Find::Torque => is_range(runner, &format!("{path}.torque"), &torques)?,
            Find::Speed => is_range(runner, &format!("{path}.speed"), &speeds)?,
        }
        let (found, seen) = search(runner, entry, b, gear, &torques, &speeds)?;
        for f in &found {
            let mut row = vec![b.name.clone(), gear.to_owned(), cell(Some(f.temperature))];
            row.push(cell(f.torque));
            row.push(cell(f.speed.map(|w| tidy(w * RPM))));
            row.push(f.limit.name().to_owned());
            row.extend([f.loss, f.input, f.output, f.efficiency, f.lowest].map(cell));
            rows.push(row);
        }
        show(name, entry, b, &found, out)?;
        runner.outside(&seen, out);
        out.line("")?;
        for temperature in &entry.temperature {
            let own = found.iter().filter(|f| f.temperature == *temperature);
            let name = if built.len() > 1 {
                format!("{} {temperature} degC", b.name)
            } else {
                format!("{temperature} degC")
            };
            let line = |y: &dyn Fn(&Found) -> Option<f64>| Line {
                name: name.clone(),
                points: own
                    .clone()
                    .map(|f| {
                        f.limit.value()?;
                        let x = match entry.find {
                            Find::Torque => f.speed? * RPM,
                            Find::Speed => f.torque?,
                        };
                        Some((x, y(f)?))
                    })
                    .collect(),
                stroke: Stroke::Marked,
            };
            limits.push(line(&|f| match entry.find {
                Find::Torque => f.torque,
                Find::Speed => f.speed.map(|w| w * RPM),
            }));
            powers.push(line(&|f| f.output.or(f.input)));
        }
        results.push(json!({
            "model_set": b.name,
            "gear": gear,
            "find": entry.find,
            "limits": found.iter().map(json_of).collect::<Vec<_>>(),
            "notes": seen,
        }));
    }
    if runner.only_checks {
        return Ok(());
    }
    let mut value = head(runner, &built.iter().collect::<Vec<_>>());
    value["thermal_limits"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    let conditions = &runner.study.entry.conditions;
    let torque = format!("torque at {} in Nm", conditions.torque_at);
    let speed = format!("speed at {} in rpm", conditions.speed_at);
    let (x, y, title) = match entry.find {
        Find::Torque => (&speed, &torque, "torque at which the oil reaches a temperature"),
        Find::Speed => (&torque, &speed, "speed at which the oil reaches a temperature"),
    };
    let write = &entry.write;
    let figure = |title: String, y: &str, lines: Vec<Line>| Figure::Lines {
        title,
        x: x.clone(),
        y: y.to_owned(),
        lines,
    };
    picture(runner, name, figure(format!("{name}: {title}"), y, limits), write)?;
    let title = format!("{name}: power out at which the oil reaches a temperature");
    picture(
        runner,
        &format!("{name}-power"),
        figure(title, "power in W", powers),
        write,
    )?;
    Ok(())
}

/// A limit needs ways on which heat leaves; a fixed temperature has none.
pub fn needs_balance(runner: &Runner<'_>, path: &str, built: &Built<'_>) -> Result<(), Failure> {
    if runner.study.entry.conditions.oil_temperature.is_some() {
        let error = Diagnostic::error(
            "conditions.oil_temperature",
            "the study fixes the temperature, so there is no balance",
        )
        .note(format!("`{path}` asks for one"))
        .mend("leave it out, or give this analysis a study of its own");
        return Err(runner.study.findings(vec![error]).into());
    }
    if built.transmission.thermal_mode == ThermalMode::Balance {
        return Ok(());
    }
    let error = Diagnostic::error(path, "the gearbox has a fixed temperature, and no balance")
        .mend("write `thermal: { mode: balance, heat_dissipation: { ... } }` in the gearbox");
    Err(runner.study.findings(vec![error]).into())
}

fn search(
    runner: &Runner<'_>,
    entry: &ThermalLimitEntry,
    built: &Built<'_>,
    gear: &str,
    torques: &[f64],
    speeds: &[f64],
) -> Result<(Vec<Found>, Vec<Note>), Failure> {
    let t = &built.transmission;
    let points = runner.points(t, gear, Vec::new(), Vec::new());
    let case = runner.case(built.gearbox, t, &points)?;
    if case.torque_ports.is_empty() && entry.find == Find::Torque {
        return Err(Failure::input(
            format!("`{gear}` takes no torque, so none can be its limit"),
            "name another gear, or look for the speed",
        ));
    }
    if runner.only_checks {
        return Ok((Vec::new(), Vec::new()));
    }
    let mut scratch = t.scratch(&case);
    let (range, fixed) = match entry.find {
        Find::Torque => (torques, speeds),
        Find::Speed => (speeds, torques),
    };
    // From the value nearest to zero outwards, whichever way the axis runs.
    let nearest = range
        .iter()
        .copied()
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(0.0);
    let farthest = range
        .iter()
        .copied()
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(0.0);
    let range = [nearest, farthest];
    let mut all = Vec::new();
    for temperature in &entry.temperature {
        for value in fixed {
            let given = |x: f64| match entry.find {
                Find::Torque => ([*value], [x]),
                Find::Speed => ([x], [*value]),
            };
            let count = case.torque_ports.len();
            let (speed, torque) = given(range[0]);
            let start = Point {
                speeds: &speed,
                torques: &torque[..count],
                flow: points.flow,
                tolerance: Tolerance::default(),
            };
            let set = |x: f64, speeds: &mut [f64], torques: &mut [f64]| {
                let (speed, torque) = given(x);
                speeds.copy_from_slice(&speed);
                torques.copy_from_slice(&torque[..torques.len()]);
            };
            let limit = t.thermal_limit(&case, &start, *temperature, range, set, &mut scratch);
            let mut found = Found {
                temperature: *temperature,
                torque: (entry.find == Find::Speed).then_some(*value),
                speed: (entry.find == Find::Torque).then_some(*value),
                limit,
                loss: None,
                input: None,
                output: None,
                efficiency: None,
                lowest: None,
            };
            if let Some(x) = limit.value() {
                let (speed, torque) = given(x);
                let point = Point {
                    speeds: &speed,
                    torques: &torque[..count],
                    ..start
                };
                found.lowest = t.equilibrium(&case, &point, &mut scratch).oil();
                let solution = t.evaluate(&case, &point, &[*temperature], &mut scratch);
                (found.torque, found.speed) = (Some(torque[0]), Some(speed[0]));
                (found.loss, found.efficiency) = (solution.loss(), solution.efficiency());
                (found.input, found.output) = (solution.input_power(), solution.output_power());
            }
            all.push(found);
        }
    }
    runner.seen(t, &scratch.totals);
    Ok((all, notes(t, &scratch.totals)))
}

fn json_of(f: &Found) -> Value {
    json!({
        "limit_degc": f.temperature, "torque_nm": f.torque, "speed_rpm": f.speed.map(|w| tidy(w * RPM)),
        "outcome": f.limit.name(), "loss_w": f.loss, "input_w": f.input, "output_w": f.output,
        "efficiency": f.efficiency, "lowest_balance_degc": f.lowest,
    })
}

fn show(
    name: &str,
    entry: &ThermalLimitEntry,
    built: &Built<'_>,
    found: &[Found],
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!("{name}: models {}", built.name))?;
    let mut table = Table::new(&["oil degC", "speed rpm", "torque Nm", "outcome", "loss W", "out W"]);
    for f in found {
        table.row(vec![
            number(Some(f.temperature), 1),
            number(f.speed.map(|w| w * RPM), 1),
            number(f.torque, 3),
            f.limit.name().to_owned(),
            number(f.loss, 2),
            number(f.output, 1),
        ]);
    }
    out.text(&table.render())?;
    // Where losses rise with temperature the point may also keep itself at a lower one.
    let lower = found
        .iter()
        .filter(|f| f.lowest.is_some_and(|t| t < f.temperature - 0.01))
        .count();
    if lower > 0 {
        out.line(format!(
            "{lower} of these points also keep themselves at a lower temperature"
        ))?;
    }
    if entry.find == Find::Torque && found.iter().any(|f| f.limit == Limit::ExceededFromTheStart) {
        out.line(
            "where it is exceeded from the start, the losses of the first torque of the range are too much already",
        )?;
    }
    out.line("")?;
    Ok(())
}

/// A limit is looked for between two values on one side of zero.
fn is_range(runner: &Runner<'_>, path: &str, range: &[f64]) -> Result<(), Failure> {
    let (Some(first), Some(last), true) = (range.first(), range.last(), range.len() > 1) else {
        let message = "one value is no range to look for a limit in";
        return Err(runner.wrong(path, message, "write `{ from: ..., to: ..., step: ... }`"));
    };
    if range.iter().any(|x| x * first < 0.0 || x * last < 0.0) {
        return Err(runner.wrong(
            path,
            "the range goes through zero",
            "look on one side of zero at a time",
        ));
    }
    Ok(())
}
