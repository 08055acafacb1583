//! Losses of a list of operating points from a file, as stacked bars, with room for what was measured.

use gearloss_framework::analysis::{PointResult, merge, notes};
use gearloss_framework::document::{Diagnostic, Unit};
use gearloss_framework::loss::Extent;
use gearloss_framework::report::Figure;
use gearloss_framework::report::plot::Bar;
use gearloss_framework::study::{By, OperatingPointsEntry};
use gearloss_framework::thermal::Outcome;
use gearloss_framework::transmission::PartInfo;
use serde_json::{Value, json};

use super::super::solve::{RPM, outside};
use super::breakdown::{name_of, names, stack};
use super::map::tidy;
use super::write::{cell, head, picture, write};
use super::{Built, Runner, bound_value, gear_of};
use crate::output::{Failure, Out, Table, number};

/// One row of the file.
struct Row {
    name: String,
    torque: f64,
    speed: f64,
    /// Bound values with their units, in the order of the entry.
    bound: Vec<String>,
    /// Loss in W, its error, temperature of the oil in degC, its error, temperature of the surface in degC, its error.
    measured: [Option<f64>; 6],
}

/// Measured columns with their units.
const MEASURED: [(&str, &str); 6] = [
    ("measured_loss", "W"),
    ("measured_loss_error", "W"),
    ("measured_oil_temperature", "degC"),
    ("measured_oil_temperature_error", "K"),
    ("measured_surface_temperature", "degC"),
    ("measured_surface_temperature_error", "K"),
];

pub fn run(runner: &Runner<'_>, name: &str, entry: &OperatingPointsEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let rows = read(runner, &path, entry)?;
    // One transmission for each set and each combination of bound values that occurs.
    let mut combinations: Vec<&Vec<String>> = Vec::new();
    for row in &rows {
        if !combinations.contains(&&row.bound) {
            combinations.push(&row.bound);
        }
    }
    let mut built: Vec<Vec<Built<'_>>> = Vec::new();
    for bound in &combinations {
        let paths = entry.bind.iter().map(|(_, path)| path.clone());
        let overrides: Vec<(String, Value)> = paths.zip(bound.iter().map(|v| bound_value(v))).collect();
        built.push(runner.built_with(gearbox, &entry.model_sets, &overrides)?);
    }
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
    header.extend(MEASURED.map(|(column, unit)| format!("{column}_{}", unit.to_lowercase())));
    let mut shares: Vec<String> = Vec::new();
    for share in built.iter().flatten().flat_map(|b| names(b, entry.by)) {
        if !shares.contains(&share) {
            shares.push(share);
        }
    }
    // What is lost nowhere under any model needs no colour: `none` everywhere.
    let off = |share: &str| {
        let parts = built.iter().flatten().flat_map(|b| {
            let of = |p: &&PartInfo| name_of(p, entry.by) == share;
            b.transmission
                .parts()
                .iter()
                .filter(of)
                .map(|p| b.transmission.instances()[p.notes.instance].entry.name == "none")
        });
        entry.by != By::Sum && parts.into_iter().all(|off| off)
    };
    shares.retain(|share| !off(share));
    header.extend(shares.iter().map(|s| format!("{s}_w")));
    let (mut table, mut results) = (Vec::new(), Vec::new());
    for set in 0..built.first().map_or(0, Vec::len) {
        let mut solved: Vec<(&Row, PointResult, Option<Vec<f64>>)> = Vec::new();
        let (mut set_name, mut gear) = (String::new(), String::new());
        let mut seen: Vec<Extent> = Vec::new();
        for row in &rows {
            let place = combinations.iter().position(|c| **c == row.bound).unwrap_or(0);
            let b = &built[place][set];
            set_name.clone_from(&b.name);
            gear_of(entry.gear.as_deref(), &b.transmission).clone_into(&mut gear);
            let points = runner.points(&b.transmission, &gear, vec![row.torque], vec![row.speed]);
            let mut result = runner.solve(b, &points)?;
            merge(&mut seen, &result.seen);
            let Some(point) = result.points.pop() else {
                continue;
            };
            let stack = stack(b, &point, entry.by, &shares);
            solved.push((row, point, stack));
        }
        for (row, point, stack) in &solved {
            let mut cells = vec![set_name.clone(), gear.clone(), row.name.clone()];
            cells.extend(row.bound.iter().cloned());
            cells.extend([
                cell(Some(row.torque)),
                cell(Some(tidy(row.speed * RPM))),
                cell(point.oil),
                cell(point.surface),
                point.balance.map_or("", Outcome::name).to_owned(),
                point.status.name().to_owned(),
                cell(point.efficiency),
                cell(point.loss),
            ]);
            cells.extend(row.measured.map(cell));
            cells.extend((0..shares.len()).map(|i| cell(stack.as_ref().map(|s| s[i]))));
            table.push(cells);
        }
        show(name, &set_name, entry, &shares, &solved, out)?;
        // The transmissions of one set differ in bound values only, so their notes stand in the same order.
        let seen = notes(&built[0][set].transmission, &seen);
        out.line(outside(&seen))?;
        results.push(json!({
            "model_set": set_name,
            "gear": gear,
            "shares": shares,
            "notes": seen,
            "points": solved.iter().map(|(row, p, stack)| json!({
                "name": row.name,
                "bound": entry.bind.ids().zip(&row.bound).map(|(k, v)| (k.to_owned(), json!(v))).collect::<serde_json::Map<_, _>>(),
                "torque_nm": row.torque, "speed_rpm": tidy(row.speed * RPM), "oil_temperature_degc": p.oil,
                "surface_temperature_degc": p.surface, "balance": p.balance, "status": p.status,
                "efficiency": p.efficiency, "loss_w": p.loss, "losses_w": stack,
                "measured": MEASURED.iter().zip(row.measured).map(|((k, _), v)| ((*k).to_owned(), json!(v))).collect::<serde_json::Map<_, _>>(),
            })).collect::<Vec<_>>(),
        }));
        let bars: Vec<Bar> = solved
            .iter()
            .map(|(row, p, stack)| bar(row, p, stack.as_deref()))
            .collect();
        let title = format!("{name}: losses, models {set_name}, oil temperature above each bar");
        picture(
            runner,
            &format!("{name}-{set_name}"),
            Figure::Bars {
                title,
                height: "loss in W".to_owned(),
                names: shares.clone(),
                bars,
            },
            &entry.write,
        )?;
    }
    let all: Vec<&Built<'_>> = built.iter().flatten().collect();
    let mut value = head(runner, name, &all);
    value["operating_points"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &table, &value)?;
    Ok(())
}

fn bar(row: &Row, point: &PointResult, stack: Option<&[f64]>) -> Bar {
    let degrees = |t: Option<f64>| t.map_or_else(String::new, |t| format!("{t:.0} °C"));
    let [loss, error, oil, _, surface, _] = row.measured;
    let temperature = oil.or(surface);
    let mut label = format!("{}\n{:.0} rpm\n{} Nm", row.name, row.speed * RPM, row.torque);
    for value in &row.bound {
        label.push_str(&format!("\n{value}"));
    }
    Bar {
        label,
        shares: stack.map(<[f64]>::to_vec).unwrap_or_default(),
        above: degrees(point.oil),
        measured: loss.map(|loss| (loss, error.unwrap_or(0.0))),
        above_measured: degrees(temperature),
    }
}

fn show(
    name: &str,
    set: &str,
    entry: &OperatingPointsEntry,
    shares: &[String],
    solved: &[(&Row, PointResult, Option<Vec<f64>>)],
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!("{name}: losses in W, models {set}"))?;
    let mut head: Vec<String> = vec!["point".to_owned()];
    head.extend(entry.bind.ids().map(str::to_owned));
    head.extend(["torque Nm", "speed rpm", "oil degC"].map(str::to_owned));
    head.extend(shares.iter().cloned());
    head.extend(["loss W", "efficiency %"].map(str::to_owned));
    let measured = solved.iter().any(|(row, ..)| row.measured.iter().any(Option::is_some));
    if measured {
        head.extend(["measured W", "measured oil degC", "measured surface degC"].map(str::to_owned));
    }
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for (row, point, stack) in solved {
        let mut cells = vec![row.name.clone()];
        cells.extend(row.bound.iter().cloned());
        cells.push(format!("{}", row.torque));
        cells.push(format!("{:.0}", row.speed * RPM));
        cells.push(match (point.oil, point.balance) {
            (None, Some(outcome)) => outcome.name().to_owned(),
            (oil, _) => number(oil, 1),
        });
        cells.extend((0..shares.len()).map(|i| number(stack.as_ref().map(|s| s[i]), 2)));
        cells.push(number(point.loss, 2));
        cells.push(number(point.efficiency.map(|e| 100.0 * e), 2));
        if measured {
            cells.push(number(row.measured[0], 2));
            cells.push(number(row.measured[2], 1));
            cells.push(number(row.measured[4], 1));
        }
        table.row(cells);
    }
    out.text(&table.render())?;
    let gaps = |f: &dyn Fn(&Row, &PointResult) -> Option<f64>| -> Vec<f64> {
        solved.iter().filter_map(|(row, point, _)| f(row, point)).collect()
    };
    let loss = gaps(&|row, point| Some(100.0 * (point.loss? / row.measured[0]? - 1.0)));
    let oil = gaps(&|row, point| Some(point.oil? - row.measured[2]?));
    let surface = gaps(&|row, point| Some(point.surface? - row.measured[4]?));
    for (gaps, what) in [
        (loss, "loss minus measurement in %"),
        (oil, "oil temperature minus measurement in K"),
        (surface, "surface temperature minus measurement in K"),
    ] {
        if let Some(count) = Some(gaps.len()).filter(|n| *n > 0) {
            let mean = gaps.iter().sum::<f64>() / count as f64;
            let worst = gaps
                .iter()
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
            out.line(format!("{what}: mean {mean:.2}, worst {worst:.2}, {count} points"))?;
        }
    }
    Ok(())
}

fn read(runner: &Runner<'_>, path: &str, entry: &OperatingPointsEntry) -> Result<Vec<Row>, Failure> {
    let file = &entry.file;
    let fault = |reason: String, mend: &str| -> Failure {
        let error = Diagnostic::error(format!("{path}.file"), format!("{file}: {reason}")).mend(mend.to_owned());
        runner.study.findings(vec![error]).into()
    };
    let columns =
        "name the columns `name`, `torque [Nm]`, `speed [rpm]`, those of `bind` with their units, and measured ones";
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(runner.study.folder.join(file))
        .map_err(|e| fault(e.to_string(), "file names are relative to the study"))?;
    let header = reader.headers().map_err(|e| fault(e.to_string(), columns))?.clone();
    let parsed: Vec<(String, String)> = header
        .iter()
        .map(|h| {
            let (name, unit) = h.split_once('[').unwrap_or((h, "]"));
            (name.trim().to_owned(), unit.trim_end_matches(']').trim().to_owned())
        })
        .collect();
    let place = |wanted: &str| parsed.iter().position(|(name, _)| name == wanted);
    let fixed = [("torque", "Nm"), ("speed", "rpm")];
    for (column, (name, unit)) in parsed.iter().enumerate() {
        let due = fixed
            .iter()
            .chain(&MEASURED)
            .find(|(n, _)| n == name)
            .map(|(_, unit)| *unit);
        let known = due.is_some() || name == "name" || entry.bind.get(name).is_some();
        let at = format!("line 1, column {} `{}`", column + 1, &header[column]);
        if !known {
            return Err(fault(format!("{at}: nothing asks for this column"), columns));
        }
        if let Some(due) = due.filter(|due| due != unit) {
            return Err(fault(
                format!("{at}: the unit is not [{due}]"),
                "convert the column and name its unit",
            ));
        }
        if entry.bind.get(name).is_some() && !unit.is_empty() && Unit::of_symbol(unit).is_none() {
            return Err(fault(format!("{at}: `{unit}` is no unit"), "write a unit such as [ml]"));
        }
    }
    for wanted in fixed.iter().map(|(name, _)| *name).chain(entry.bind.ids()) {
        if place(wanted).is_none() {
            return Err(fault(format!("line 1: no column `{wanted}`"), columns));
        }
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(e.to_string(), "give every row as many cells"))?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: usize| {
            let x = record[column].parse::<f64>().ok().filter(|x| x.is_finite());
            x.ok_or_else(|| {
                let at = format!("line {line}, column {} `{}`", column + 1, &header[column]);
                fault(
                    format!("{at}: `{}` is not a number", &record[column]),
                    "correct the cell",
                )
            })
        };
        let needed = |name: &str| number(place(name).unwrap_or(0));
        let mut measured = [None; 6];
        for (value, (name, _)) in measured.iter_mut().zip(MEASURED) {
            if let Some(column) = place(name).filter(|c| !record[*c].is_empty()) {
                *value = Some(number(column)?);
            }
        }
        for (value, error) in [(0, 1), (2, 3), (4, 5)] {
            let wrong = match (measured[value], measured[error]) {
                (None, Some(_)) => Some(format!("`{}` without its value", MEASURED[error].0)),
                (_, Some(error)) if error < 0.0 => Some(format!("an error of {error}")),
                (Some(loss), _) if value == 0 && loss <= 0.0 => Some(format!("a loss of {loss} W")),
                _ => None,
            };
            if let Some(wrong) = wrong {
                return Err(fault(
                    format!("line {line}: {wrong}"),
                    "correct the cell, or leave it empty",
                ));
            }
        }
        let mut bound = Vec::new();
        for column in entry.bind.ids() {
            let at = place(column).unwrap_or(0);
            number(at)?;
            bound.push(format!("{} {}", &record[at], parsed[at].1).trim().to_owned());
        }
        rows.push(Row {
            name: place("name").map_or_else(|| format!("{}", rows.len() + 1), |c| record[c].to_owned()),
            torque: needed("torque")?,
            speed: needed("speed")? / RPM,
            bound,
            measured,
        });
    }
    if rows.is_empty() {
        return Err(fault("no point stands below the header".to_owned(), columns));
    }
    Ok(rows)
}
