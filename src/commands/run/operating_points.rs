//! Losses of a list of operating points from a file, as stacked bars, with room for what was measured.

use gearloss_framework::thermal::Outcome;
use gearloss_report::Figure;
use gearloss_report::plot::Bar;
use gearloss_studies::analysis::PointResult;
use gearloss_studies::measured::{Measured, Row};
use gearloss_studies::study::{By, OperatingPointsEntry};
use serde_json::{Map, Value, json};

use super::super::solve::RPM;
use super::Runner;
use super::write::{cell, head, picture, write};
use crate::output::{Failure, Out, Table, fixed, number};
use gearloss_studies::analyses::measurable::{is_measurable, note};
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::analyses::rows::Solved;
use gearloss_studies::analyses::shares::{Shares, together};

/// What may have been measured: quantity and unit.
const MEASURED: [(&str, &str); 6] = [
    ("loss", "w"),
    ("loss_accuracy", "w"),
    ("oil_temperature", "degc"),
    ("oil_temperature_accuracy", "k"),
    ("surface_temperature", "degc"),
    ("surface_temperature_accuracy", "k"),
];

/// One point beside what was measured there.
struct At<'a> {
    name: String,
    row: &'a Row,
    point: &'a PointResult,
    stack: Option<Vec<f64>>,
    /// In the order of [`MEASURED`].
    measured: [Option<f64>; 6],
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &OperatingPointsEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let bind: Vec<&str> = entry.bind.ids().collect();
    let listed = runner.read(&format!("{path}.data"), &entry.data, &bind)?;
    for note in &listed.notes {
        out.line(format!("{name}: {}: {note}", runner.data(&path, &entry.data)?.file))?;
    }
    let gear = entry.gear.as_deref();
    let terms = entry.by == By::Term;
    let all = runner.at_rows(gearbox, &entry.model_sets, &entry.bind, gear, &listed, terms)?;
    if runner.only_checks {
        return Ok(());
    }
    let built = || all.iter().flat_map(|s| &s.built);
    let names = together(built().map(|b| &b.transmission), entry.by);
    let header = header(entry, &names);
    let (mut table, mut results) = (Vec::new(), Vec::new());
    for solved in &all {
        let points = beside(entry, &listed, solved, &names);
        table.extend(
            points
                .iter()
                .zip(&solved.rows)
                .map(|(at, (_, gear, _))| cells(&solved.name, gear, names.len(), at)),
        );
        show(name, &solved.name, entry, &names, &points, out)?;
        runner.outside(&solved.notes, out);
        out.line("")?;
        results.push(result(entry, solved, &names, &points));
        let title = format!("{name}: losses, models {}, oil temperature above each bar", solved.name);
        let figure = Figure::Bars {
            title,
            over: String::new(),
            height: "loss in W".to_owned(),
            names: names.clone(),
            bars: points.iter().map(bar).collect(),
        };
        picture(runner, &format!("{name}-{}", solved.name), figure, &entry.write)?;
    }
    let mut value = head(runner, &built().collect::<Vec<_>>());
    value["operating_points"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &table, &value)
}

fn header(entry: &OperatingPointsEntry, names: &[String]) -> Vec<String> {
    let mut header: Vec<String> = ["model_set", "gear", "name"].map(str::to_owned).to_vec();
    header.extend(entry.bind.ids().map(str::to_owned));
    header.extend(
        [
            "torque_nm",
            "speed_rpm",
            "oil_temperature_degc",
            "surface_temperature_degc",
            "balance",
            "status",
            "efficiency",
            "loss_w",
        ]
        .map(str::to_owned),
    );
    header.extend(MEASURED.map(|(quantity, unit)| format!("measured_{quantity}_{unit}")));
    header.extend(names.iter().map(|s| format!("{s}_w")));
    header
}

fn beside<'a>(
    entry: &OperatingPointsEntry,
    listed: &'a Measured,
    solved: &'a Solved<'_>,
    names: &[String],
) -> Vec<At<'a>> {
    let shares: Vec<Shares> = solved
        .built
        .iter()
        .map(|b| Shares::of(&b.transmission, entry.by).under(names))
        .collect();
    listed
        .rows
        .iter()
        .zip(&solved.rows)
        .enumerate()
        .map(|(i, (row, (place, _, point)))| At {
            name: row.name.clone().unwrap_or_else(|| format!("{}", i + 1)),
            row,
            point,
            stack: shares[*place].stack(point),
            measured: MEASURED.map(|(quantity, _)| measured(listed, row, point, quantity)),
        })
        .collect()
}

/// What was measured: a quantity, or its accuracy as it is stated.
fn measured(listed: &Measured, row: &Row, point: &PointResult, quantity: &str) -> Option<f64> {
    let Some(of) = quantity.strip_suffix("_accuracy") else {
        return listed.value(row, quantity);
    };
    let reading = listed.value(row, of);
    let calculated = point.loss.filter(|_| of == "loss");
    listed.stated_accuracy(row, of, reading.and(calculated.or(reading)))
}

fn cells(set: &str, gear: &str, shares: usize, at: &At<'_>) -> Vec<String> {
    let p = at.point;
    let mut cells = vec![set.to_owned(), gear.to_owned(), at.name.clone()];
    cells.extend(at.row.bound.iter().cloned());
    cells.extend([
        cell(Some(p.torque)),
        cell(Some(tidy(p.speed * RPM))),
        cell(p.oil),
        cell(p.surface),
        p.balance.map_or("", Outcome::name).to_owned(),
        p.status.name().to_owned(),
        cell(p.efficiency),
        cell(p.loss),
    ]);
    cells.extend(at.measured.map(cell));
    cells.extend((0..shares).map(|i| cell(at.stack.as_ref().map(|s| s[i]))));
    cells
}

fn result(entry: &OperatingPointsEntry, solved: &Solved<'_>, names: &[String], points: &[At<'_>]) -> Value {
    let list = points.iter().zip(&solved.rows).map(|(at, (_, gear, _))| {
        let p = at.point;
        let bound: Map<String, Value> = entry
            .bind
            .ids()
            .zip(&at.row.bound)
            .map(|(k, v)| (k.to_owned(), json!(v)))
            .collect();
        let measured: Map<String, Value> = MEASURED
            .iter()
            .zip(at.measured)
            .map(|((quantity, unit), v)| (format!("{quantity}_{unit}"), json!(v)))
            .collect();
        json!({
            "name": at.name, "gear": gear, "bound": bound,
            "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "oil_temperature_degc": p.oil,
            "surface_temperature_degc": p.surface, "balance": p.balance, "status": p.status,
            "efficiency": p.efficiency, "loss_w": p.loss, "losses_w": at.stack, "measured": measured,
        })
    });
    json!({
        "model_set": solved.name,
        "shares": names,
        "notes": solved.notes,
        "points": list.collect::<Vec<_>>(),
    })
}

fn bar(at: &At<'_>) -> Bar {
    let degrees = |t: Option<f64>| t.map_or_else(String::new, |t| format!("{t:.0} °C"));
    let [loss, accuracy, oil, _, surface, _] = at.measured;
    let mut label = format!(
        "{}\n{} rpm\n{} Nm",
        at.name,
        fixed(at.point.speed * RPM, 0),
        at.point.torque
    );
    for value in &at.row.bound {
        label.push_str(&format!("\n{value}"));
    }
    Bar {
        label,
        shares: at.stack.clone().unwrap_or_default(),
        above: degrees(at.point.oil),
        measured: loss.map(|loss| (loss, accuracy.unwrap_or(0.0))),
        above_measured: degrees(oil.or(surface)),
    }
}

fn show(
    name: &str,
    set: &str,
    entry: &OperatingPointsEntry,
    shares: &[String],
    points: &[At<'_>],
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!("{name}: losses in W, models {set}"))?;
    let mut head: Vec<String> = vec!["point".to_owned()];
    head.extend(entry.bind.ids().map(str::to_owned));
    head.extend(["torque Nm", "speed rpm", "oil degC"].map(str::to_owned));
    head.extend(shares.iter().cloned());
    head.extend(["loss W", "efficiency %"].map(str::to_owned));
    let measured = points.iter().any(|at| at.measured.iter().any(Option::is_some));
    if measured {
        head.extend(["measured W", "measured oil degC", "measured surface degC"].map(str::to_owned));
    }
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for at in points {
        let p = at.point;
        let mut cells = vec![at.name.clone()];
        cells.extend(at.row.bound.iter().cloned());
        cells.push(format!("{}", p.torque));
        cells.push(fixed(p.speed * RPM, 0));
        cells.push(match (p.oil, p.balance) {
            (None, Some(outcome)) => outcome.name().to_owned(),
            (oil, _) => number(oil, 1),
        });
        cells.extend((0..shares.len()).map(|i| number(at.stack.as_ref().map(|s| s[i]), 2)));
        cells.push(number(p.loss, 2));
        cells.push(number(p.efficiency.map(|e| 100.0 * e), 2));
        if measured {
            cells.push(number(at.measured[0], 2));
            cells.push(number(at.measured[2], 1));
            cells.push(number(at.measured[4], 1));
        }
        table.row(cells);
    }
    out.text(&table.render())?;
    let gaps = |f: &dyn Fn(&At<'_>) -> Option<f64>| -> Vec<f64> { points.iter().filter_map(f).collect() };
    let of_loss = |at: &At<'_>| {
        let (loss, seen) = (at.point.loss?, at.measured[0]?);
        is_measurable(seen, loss).then(|| 100.0 * (loss / seen - 1.0))
    };
    let nothing = |at: &&At<'_>| {
        let both = at.point.loss.zip(at.measured[0]);
        both.is_some_and(|(loss, seen)| !is_measurable(seen, loss))
    };
    let omitted = points.iter().filter(nothing).count();
    let of_oil = |at: &At<'_>| Some(at.point.oil? - at.measured[2]?);
    let of_surface = |at: &At<'_>| Some(at.point.surface? - at.measured[4]?);
    for (gaps, what) in [
        (gaps(&of_loss), "loss minus measurement in %"),
        (gaps(&of_oil), "oil temperature minus measurement in K"),
        (gaps(&of_surface), "surface temperature minus measurement in K"),
    ] {
        if gaps.is_empty() {
            continue;
        }
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        let worst = gaps
            .iter()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
        out.line(format!(
            "{what}: mean {mean:.2}, worst {worst:.2}, {} points",
            gaps.len()
        ))?;
    }
    if omitted > 0 {
        out.line(note(omitted, "the loss minus measurement"))?;
    }
    Ok(())
}
