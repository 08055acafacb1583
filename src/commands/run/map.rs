//! Losses and efficiency over a grid.

use gearloss_framework::analysis::{GridResult, Points, SUMS, evidence, notes};
use gearloss_framework::study::MapEntry;
use serde_json::{Value, json};

use super::super::solve::{RPM, outside};
use super::write::{cell, head, write};
use super::{Built, Runner, axis};
use crate::output::{Failure, Out, Table, number};

/// The most rows and columns of a table on the terminal.
const SHOWN: usize = 8;

pub fn run(runner: &Runner<'_>, name: &str, entry: &MapEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let grid = runner.study.grid(&path, &entry.grid)?;
    let torques = axis(runner, &format!("grids.{}.torque", entry.grid), grid.torque.values())?;
    let speeds = axis(runner, &format!("grids.{}.speed", entry.grid), grid.speed.values())?;
    let built = runner.built(gearbox, &entry.model_sets)?;
    let mut header: Vec<String> = [
        "model_set",
        "gear",
        "torque_nm",
        "speed_rpm",
        "oil_temperature_degc",
        "status",
        "efficiency",
        "loss_w",
        "loss_torque_nm",
        "input_w",
        "output_w",
    ]
    .map(str::to_owned)
    .to_vec();
    header.extend(SUMS.iter().map(|(sum, _)| format!("{sum}_w")));
    // Sets may differ in their parts; each part has one column, empty where a set has it not.
    let mut parts: Vec<String> = Vec::new();
    for b in &built {
        for part in b.transmission.parts() {
            if !parts.contains(&part.path) {
                parts.push(part.path.clone());
            }
        }
    }
    header.extend(parts.iter().map(|p| format!("{p}_w")));
    let mut rows = Vec::new();
    let mut results = Vec::new();
    for b in &built {
        let points = runner.points(&b.transmission, &grid.gear, torques.clone(), speeds.clone());
        let solved = runner.solve(b, &points)?;
        let columns: Vec<Option<usize>> = parts
            .iter()
            .map(|p| b.transmission.parts().iter().position(|own| own.path == *p))
            .collect();
        for point in &solved.points {
            let undefined = point.undefined.map(|(part, _)| part);
            let mut row = vec![
                b.name.clone(),
                grid.gear.clone(),
                cell(Some(point.torque)),
                cell(Some(tidy(point.speed * RPM))),
                cell(Some(points.temperature)),
                point.status.name().to_owned(),
                cell(point.efficiency),
                cell(point.loss),
                cell(point.loss_torque),
                cell(point.input),
                cell(point.output),
            ];
            row.extend(point.sums.iter().map(|s| cell(Some(*s))));
            row.extend(
                columns
                    .iter()
                    .map(|c| cell(c.filter(|c| undefined != Some(*c)).map(|c| point.parts[c]))),
            );
            rows.push(row);
        }
        out.line(format!(
            "{name}: efficiency in %, gear {}, models {}",
            grid.gear, b.name
        ))?;
        out.text(&table(&solved, &points))?;
        out.text(&outside(&notes(&b.transmission, &solved.seen)))?;
        out.line("")?;
        results.push(result(b, &points, &solved));
    }
    let mut value = head(runner, name, &built.iter().collect::<Vec<_>>());
    value["maps"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    Ok(())
}

/// A number of 1/min without the noise of its conversion.
pub fn tidy(x: f64) -> f64 {
    (x * 1e6).round() / 1e6
}

/// At most a handful of rows and columns, spread evenly, both ends among them.
pub fn spread(count: usize) -> Vec<usize> {
    if count <= SHOWN {
        return (0..count).collect();
    }
    let mut places: Vec<usize> = (0..SHOWN).map(|i| i * (count - 1) / (SHOWN - 1)).collect();
    places.dedup();
    places
}

fn table(solved: &GridResult, points: &Points) -> String {
    let shown = spread(points.speeds.len());
    let mut head = vec!["torque Nm".to_owned()];
    head.extend(shown.iter().map(|i| format!("{:.0} rpm", points.speeds[*i] * RPM)));
    let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for t in spread(points.torques.len()) {
        let mut row = vec![format!("{}", points.torques[t])];
        row.extend(shown.iter().map(|i| {
            number(
                solved.points[t * points.speeds.len() + i].efficiency.map(|e| 100.0 * e),
                2,
            )
        }));
        table.row(row);
    }
    table.render()
}

fn result(built: &Built<'_>, points: &Points, solved: &GridResult) -> Value {
    let list: Vec<Value> = solved
        .points
        .iter()
        .map(|p| {
            json!({
                "torque_nm": p.torque,
                "speed_rpm": tidy(p.speed * RPM),
                "status": p.status,
                "efficiency": p.efficiency,
                "loss_w": p.loss,
                "loss_torque_nm": p.loss_torque,
                "input_w": p.input,
                "output_w": p.output,
                "sums_w": p.sums,
                "parts_w": p.parts,
                "undefined": p.undefined.map(|(part, reason)| json!({ "part": built.transmission.parts()[part].path, "reason": reason.to_string() })),
            })
        })
        .collect();
    json!({
        "model_set": built.name,
        "gear": points.gear,
        "oil_temperature_degc": points.temperature,
        "power_flow": points.flow,
        "torque_at": points.torque_at,
        "speed_at": points.speed_at,
        "sums": SUMS.map(|(name, meaning)| json!({ "sum": name, "meaning": meaning })),
        "parts": built.transmission.parts().iter().map(|p| json!({
            "part": p.path,
            "mechanism": p.mechanism,
            "model": built.transmission.instances()[p.notes.instance].entry.name,
        })).collect::<Vec<_>>(),
        "passes": solved.passes,
        "notes": notes(&built.transmission, &solved.seen),
        "evidence": evidence(&built.transmission, &built.resolved, &|path| built.gearbox.places.is_written(path)),
        "points": list,
    })
}
