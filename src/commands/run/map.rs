//! Losses and efficiency over a grid.

mod over_bound;
mod pictures;

use gearloss_framework::analysis::{GridResult, OilTemperature, PointResult, Points, SUMS, evidence, notes};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::study::MapEntry;
use gearloss_framework::thermal::Outcome;
use serde_json::{Value, json};

use self::over_bound::over_bound;
use self::pictures::pictures;
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
    // One map for each set and each combination of bound values.
    let mut maps = Vec::new();
    let combinations = grid.combinations().map_err(|bound| {
        let error = Diagnostic::error(
            format!("grids.{}.bind", entry.grid),
            format!("`{bound}` has no list of values"),
        )
        .mend("write `[60 ml, 90 ml]`, say");
        Failure::from(runner.study.findings(vec![error]))
    })?;
    for bound in combinations {
        for built in runner.built_with(gearbox, &entry.model_sets, &bound)? {
            let points = runner.points(&built.transmission, &grid.gear, torques.clone(), speeds.clone());
            let solved = runner.solve(&built, &points)?;
            maps.push(Map {
                built,
                bound: bound.clone(),
                points,
                solved,
            });
        }
    }
    // Sets may differ in their parts; each part has one column, empty where a set has it not.
    let mut parts: Vec<String> = Vec::new();
    for part in maps.iter().flat_map(|m| m.built.transmission.parts()) {
        if !parts.contains(&part.path) {
            parts.push(part.path.clone());
        }
    }
    let mut header: Vec<String> = ["model_set", "gear"].map(str::to_owned).to_vec();
    header.extend(grid.bind.ids().map(str::to_owned));
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
            "loss_torque_nm",
            "input_w",
            "output_w",
        ]
        .map(str::to_owned),
    );
    header.extend(SUMS.iter().map(|(sum, _)| format!("{sum}_w")));
    header.extend(parts.iter().map(|p| format!("{p}_w")));
    let mut rows = Vec::new();
    let mut results = Vec::new();
    let one_table = torques.len() == 1 && grid.bind.len() == 1;
    if one_table {
        over_bound(name, &maps, out)?;
    }
    for map in &maps {
        rows.extend(map.rows(&parts));
        if one_table {
            results.push(map.result());
            continue;
        }
        out.line(format!(
            "{name}: efficiency in %, gear {}, models {}{}",
            grid.gear,
            map.built.name,
            map.words()
        ))?;
        let percent = |p: &PointResult| p.efficiency.map(|e| 100.0 * e);
        out.text(&map.table(&percent))?;
        if map.points.oil == OilTemperature::Balance {
            out.line("oil temperature in degC")?;
            out.text(&map.table(&|p| p.oil))?;
        }
        out.text(&outside(&notes(&map.built.transmission, &map.solved.seen)))?;
        out.line("")?;
        results.push(map.result());
    }
    let mut value = head(runner, name, &maps.iter().map(|m| &m.built).collect::<Vec<_>>());
    value["maps"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)?;
    pictures(runner, name, &maps, &entry.write)
}

/// A map under one set with one combination of bound values.
struct Map<'a> {
    built: Built<'a>,
    bound: Vec<(String, Value)>,
    points: Points,
    solved: GridResult,
}

/// Names of the sets in the order of the maps.
fn set_names<'a>(maps: &'a [Map<'_>]) -> Vec<&'a str> {
    let mut sets: Vec<&str> = Vec::new();
    for map in maps {
        if !sets.contains(&map.built.name.as_str()) {
            sets.push(&map.built.name);
        }
    }
    sets
}

/// A bound value as it was written.
pub fn word(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

impl Map<'_> {
    /// The bound values, for a heading.
    fn words(&self) -> String {
        let words = self
            .bound
            .iter()
            .map(|(path, value)| format!(", {path} {}", word(value)));
        words.collect()
    }

    fn rows(&self, parts: &[String]) -> Vec<Vec<String>> {
        let own = self.built.transmission.parts();
        let columns: Vec<Option<usize>> = parts.iter().map(|p| own.iter().position(|o| o.path == *p)).collect();
        let row = |point: &PointResult| {
            let undefined = point.undefined.map(|(part, _)| part);
            let known = point.oil.is_some();
            let mut row = vec![self.built.name.clone(), self.points.gear.clone()];
            row.extend(self.bound.iter().map(|(_, value)| word(value)));
            row.extend([
                cell(Some(point.torque)),
                cell(Some(tidy(point.speed * RPM))),
                cell(point.oil),
                cell(point.surface),
                point.balance.map_or("", Outcome::name).to_owned(),
                point.status.name().to_owned(),
                cell(point.efficiency),
                cell(point.loss),
                cell(point.loss_torque),
                cell(point.input),
                cell(point.output),
            ]);
            row.extend(point.sums.iter().map(|s| cell(known.then_some(*s))));
            row.extend(columns.iter().map(|c| {
                let part = c.filter(|c| known && undefined != Some(*c));
                cell(part.map(|c| point.parts[c]))
            }));
            row
        };
        self.solved.points.iter().map(row).collect()
    }

    fn table(&self, quantity: &dyn Fn(&PointResult) -> Option<f64>) -> String {
        let (torques, speeds) = (&self.points.torques, &self.points.speeds);
        let shown = spread(speeds.len());
        let mut head = vec!["torque Nm".to_owned()];
        head.extend(shown.iter().map(|i| format!("{:.0} rpm", speeds[*i] * RPM)));
        let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for t in spread(torques.len()) {
            let mut row = vec![format!("{}", torques[t])];
            row.extend(
                shown
                    .iter()
                    .map(|i| number(quantity(&self.solved.points[t * speeds.len() + i]), 2)),
            );
            table.row(row);
        }
        table.render()
    }
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

impl Map<'_> {
    fn result(&self) -> Value {
        let (built, points, solved) = (&self.built, &self.points, &self.solved);
        let list: Vec<Value> = solved
            .points
            .iter()
            .map(|p| {
                json!({
                    "torque_nm": p.torque,
                    "speed_rpm": tidy(p.speed * RPM),
                    "oil_temperature_degc": p.oil,
                    "surface_temperature_degc": p.surface,
                    "balance": p.balance,
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
            "bound": self.bound.iter().map(|(path, value)| json!({ "path": path, "value": value })).collect::<Vec<_>>(),
            "oil_temperature_degc": points.oil.given(),
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
}
