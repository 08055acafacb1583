//! Losses and efficiency over a grid.

mod export;
mod over_bound;
mod pictures;
mod results;

use std::rc::Rc;

use gearloss_framework::analysis::{Given, Note, OilTemperature, PointResult, SUMS, notes};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Extent;
use gearloss_framework::measured::{Measured, Row};
use gearloss_framework::study::{Envelope, Grid, MapEntry};
use gearloss_framework::thermal::Outcome;
use serde_json::Value;

use self::over_bound::over_bound;
use self::pictures::pictures;
use self::results::Results;
use super::super::solve::{RPM, outside};
use super::write::{TableFile, cell, head, write_json};
use super::{Built, Runner, grid_axes};
use crate::output::{Failure, Out, Table, number};

/// The most rows and columns of a table on the terminal.
const SHOWN: usize = 8;

pub fn run(runner: &Runner<'_>, name: &str, entry: &MapEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let (maps, bound): (_, Vec<String>) = match (&entry.grid, &entry.points) {
        (Some(_), None) if !entry.bind.is_empty() || entry.gear.is_some() => {
            return Err(runner.wrong(&path, "`bind` and `gear` belong to `points`", "state them in the grid"));
        }
        (Some(name), None) => {
            let grid = runner.study.grid(&path, name)?;
            let bound = grid.bind.ids().map(str::to_owned).collect();
            (on_grid(runner, name, grid, gearbox, &entry.model_sets)?, bound)
        }
        (None, Some(_)) if !entry.export.is_empty() => {
            let export = format!("{path}.export");
            return Err(runner.wrong(
                &export,
                "a table for another program needs a grid",
                "give `grid` in place of `points`",
            ));
        }
        (None, Some(points)) => {
            let bind: Vec<&str> = entry.bind.ids().collect();
            let listed = runner.read(&format!("{path}.points"), points, &bind)?;
            for note in &listed.notes {
                out.line(format!("{name}: {}: {note}", runner.data(&path, points)?.file))?;
            }
            let bound = entry.bind.iter().map(|(_, path)| path.clone()).collect();
            (on_list(runner, entry, &listed, gearbox)?, bound)
        }
        _ => {
            let mend = "write `grid: NAME`, or `points: { file: ... }`";
            return Err(runner.wrong(&path, "a map needs either `grid` or `points`", mend));
        }
    };
    // Sets may differ in their parts; each part has one column, empty where a set has it not.
    let mut parts: Vec<String> = Vec::new();
    for part in maps.iter().flat_map(|m| m.built.transmission.parts()) {
        if !parts.contains(&part.path) {
            parts.push(part.path.clone());
        }
    }
    let header = header(&bound, &parts);
    let mut table = TableFile::new(runner, name, &entry.write, &header)?;
    let one_table = over_bound::fits(&maps);
    if one_table {
        over_bound(name, &maps, out)?;
    }
    for map in &maps {
        map.rows(&parts).try_for_each(|row| table.push(&row))?;
        if !one_table {
            map.show(name, out)?;
        }
    }
    table.finish()?;
    let results = Results {
        head: head(runner, name, &maps.iter().map(|m| &*m.built).collect::<Vec<_>>()),
        maps: maps.iter().map(Map::result).collect(),
    };
    write_json(runner, name, &entry.write, &results)?;
    for export in &entry.export {
        for line in export::write(runner, name, *export, &maps)? {
            out.line(format!("{name}: {line}"))?;
        }
    }
    let measured = match &entry.measured {
        Some(data) => runner.read(&format!("{path}.measured"), data, &[])?,
        None => Measured::default(),
    };
    for note in &measured.notes {
        out.line(format!("{name}: measured: {note}"))?;
    }
    let marks: Vec<Mark> = measured.rows.iter().map(|row| Mark::of(&measured, row)).collect();
    pictures(runner, name, &maps, &marks, &entry.write)
}

/// A measured point, to be drawn.
pub struct Mark {
    gear: Option<String>,
    torque: f64,
    speed: f64,
}

impl Mark {
    fn of(measured: &Measured, row: &Row) -> Self {
        Self {
            gear: row.gear.clone(),
            torque: measured.value(row, "torque").unwrap_or(0.0),
            speed: measured.value(row, "speed").unwrap_or(0.0),
        }
    }
}

/// One map for each gear state, each set and each combination of bound values.
fn on_grid<'s>(
    runner: &'s Runner<'_>,
    name: &str,
    grid: &Grid,
    gearbox: &'s Gearbox,
    sets: &'s [String],
) -> Result<Vec<Map<'s>>, Failure> {
    let path = format!("grids.{name}");
    let combinations = grid.combinations().map_err(|bound| {
        let message = format!("`{bound}` has no list of values");
        runner.wrong(&format!("{path}.bind"), message, "write `[60 ml, 90 ml]`, say")
    })?;
    if let Some(Err(reason)) = grid.envelope.as_ref().map(Envelope::check) {
        let mend = "give as many torques as speeds, and speeds that rise";
        return Err(runner.wrong(&format!("{path}.envelope"), reason, mend));
    }
    let mut maps = Vec::new();
    for bound in combinations {
        for built in runner.built_with(gearbox, sets, &bound)? {
            let built = Rc::new(built);
            let t = &built.transmission;
            let (torques, speeds) = grid_axes(runner, name, grid, t)?;
            let axes = Axes {
                torques,
                speeds,
                shares: [
                    t.rating.filter(|_| grid.speed.is_rated()).map(|r| r.speed),
                    t.rating.filter(|_| grid.torque.is_rated()).map(|r| r.torque),
                ],
            };
            let whole = runner.points(t, "", axes.torques.clone(), axes.speeds.clone()).field;
            let held = |given: &Given| {
                grid.envelope
                    .as_ref()
                    .is_none_or(|e| e.holds(given.torque, given.speed))
            };
            let mut inside = Vec::new();
            let mut places = Vec::new();
            for i in 0..whole.len() {
                let given = whole.at(i);
                places.push(held(&given).then_some(inside.len()));
                if held(&given) {
                    inside.push(given);
                }
            }
            if inside.is_empty() {
                let path = format!("{path}.envelope");
                return Err(runner.wrong(
                    &path,
                    "no point of the grid lies below the envelope",
                    "correct one of them",
                ));
            }
            for gear in grid.gear.of(t) {
                let points = if inside.len() == whole.len() {
                    runner.field(t, &gear, whole.clone())
                } else {
                    runner.listed(t, &gear, inside.clone())
                };
                let solved = runner.solve(&built, &points)?;
                maps.push(Map {
                    built: Rc::clone(&built),
                    bound: bound.clone(),
                    gear: gear.clone(),
                    oil: points.oil,
                    notes: notes(t, &solved.seen),
                    seen: solved.seen,
                    passes: solved.passes,
                    points: solved.points,
                    grid: Some((axes.clone(), places.clone())),
                });
            }
        }
    }
    Ok(maps)
}

/// One map for each set, each gear state and each combination of bound values that the rows have.
fn on_list<'s>(
    runner: &'s Runner<'_>,
    entry: &'s MapEntry,
    listed: &Measured,
    gearbox: &'s Gearbox,
) -> Result<Vec<Map<'s>>, Failure> {
    let mut maps = Vec::new();
    for solved in runner.at_rows(
        gearbox,
        &entry.model_sets,
        &entry.bind,
        entry.gear.as_deref(),
        listed,
        false,
    )? {
        let mut keys: Vec<(usize, &String)> = Vec::new();
        for (place, gear, _) in &solved.rows {
            if !keys.contains(&(*place, gear)) {
                keys.push((*place, gear));
            }
        }
        let keys: Vec<(usize, String)> = keys.into_iter().map(|(place, gear)| (place, gear.clone())).collect();
        let built: Vec<Rc<Built<'_>>> = solved.built.into_iter().map(Rc::new).collect();
        for (place, gear) in keys {
            let of_map = solved
                .rows
                .iter()
                .zip(&listed.rows)
                .filter(|(row, _)| row.0 == place && row.1 == gear);
            let bound = of_map.clone().next().map(|(_, row)| {
                let values = row.bound.iter().map(|v| Value::from(v.as_str()));
                entry.bind.iter().map(|(_, path)| path.clone()).zip(values).collect()
            });
            let points: Vec<PointResult> = of_map.map(|((_, _, point), _)| point.clone()).collect();
            maps.push(Map {
                bound: bound.unwrap_or_default(),
                gear,
                oil: common(&points).map_or(OilTemperature::Balance, OilTemperature::Fixed),
                notes: solved.notes.clone(),
                seen: Vec::new(),
                passes: points.iter().map(|p| p.passes).sum(),
                points,
                grid: None,
                built: Rc::clone(&built[place]),
            });
        }
    }
    Ok(maps)
}

/// The temperature that all points share; absent where they differ, or where it is found by balance.
fn common(points: &[PointResult]) -> Option<f64> {
    let first = points.first().filter(|p| p.balance.is_none())?.oil?;
    points.iter().all(|p| p.oil == Some(first)).then_some(first)
}

fn header(bound: &[String], parts: &[String]) -> Vec<String> {
    let mut header: Vec<String> = ["model_set", "gear"].map(str::to_owned).to_vec();
    header.extend_from_slice(bound);
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
    header
}

/// Axes of a grid for one gearbox.
#[derive(Clone)]
struct Axes {
    /// \[Nm\]
    torques: Vec<f64>,
    /// \[rad/s\]
    speeds: Vec<f64>,
    /// Ratings of speed and torque where the axes count in shares of them.
    shares: [Option<f64>; 2],
}

/// A map under one set in one gear state with one combination of bound values.
struct Map<'a> {
    /// Maps that differ in their points only share a transmission.
    built: Rc<Built<'a>>,
    bound: Vec<(String, Value)>,
    gear: String,
    oil: OilTemperature,
    points: Vec<PointResult>,
    seen: Vec<Extent>,
    notes: Vec<Note>,
    passes: usize,
    /// The grid, and for each of its places the number of the point; absent beyond the envelope.
    grid: Option<(Axes, Vec<Option<usize>>)>,
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

    /// Rows of the table, one at a time.
    fn rows(&self, parts: &[String]) -> impl Iterator<Item = Vec<String>> + '_ {
        let own = self.built.transmission.parts();
        let columns: Vec<Option<usize>> = parts.iter().map(|p| own.iter().position(|o| o.path == *p)).collect();
        let row = move |point: &PointResult| {
            let (sums, parts) = (sums(point), parts_of(point));
            let mut row = vec![self.built.name.clone(), self.gear.clone()];
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
            row.extend((0..SUMS.len()).map(|i| cell(sums.map(|s| s[i]))));
            row.extend(columns.iter().map(|c| cell(c.and_then(|c| parts[c]))));
            row
        };
        self.points.iter().map(row)
    }

    /// Prints the map.
    fn show(&self, name: &str, out: &mut Out) -> Result<(), Failure> {
        let words = self.words();
        out.line(format!(
            "{name}: efficiency in %, gear {}, models {}{words}",
            self.gear, self.built.name
        ))?;
        let percent = |p: &PointResult| p.efficiency.map(|e| 100.0 * e);
        if let Some(grid) = &self.grid {
            out.text(&self.table(grid, &percent))?;
            if self.oil == OilTemperature::Balance {
                out.line("oil temperature in degC")?;
                out.text(&self.table(grid, &|p| p.oil))?;
            }
        } else {
            let mut table = Table::new(&["torque Nm", "speed rpm", "oil degC", "efficiency %", "loss W"]);
            for i in spread(self.points.len()) {
                let p = &self.points[i];
                table.row(vec![
                    format!("{}", tidy(p.torque)),
                    format!("{:.0}", p.speed * RPM),
                    number(p.oil, 1),
                    number(percent(p), 2),
                    number(p.loss, 2),
                ]);
            }
            out.text(&table.render())?;
        }
        if let Some(thinned) = self.thinned() {
            out.line(thinned)?;
        }
        out.text(&outside(&self.notes))?;
        out.line("")?;
        Ok(())
    }

    /// Says where the table shows fewer points than there are.
    fn thinned(&self) -> Option<String> {
        let (torques, speeds) = match &self.grid {
            Some((axes, _)) => (axes.torques.len(), axes.speeds.len()),
            None => (self.points.len(), 1),
        };
        let shown = |count: usize| spread(count).len();
        (shown(torques) * shown(speeds) < torques * speeds).then(|| {
            format!(
                "shown: {} of {} points, both ends among them; the files hold all",
                shown(torques) * shown(speeds),
                torques * speeds
            )
        })
    }

    fn table(
        &self,
        (axes, places): &(Axes, Vec<Option<usize>>),
        quantity: &dyn Fn(&PointResult) -> Option<f64>,
    ) -> String {
        let shown = spread(axes.speeds.len());
        let mut head = vec!["torque Nm".to_owned()];
        head.extend(shown.iter().map(|i| format!("{:.0} rpm", axes.speeds[*i] * RPM)));
        let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for t in spread(axes.torques.len()) {
            let mut row = vec![format!("{}", tidy(axes.torques[t]))];
            let cell = |i: &usize| quantity(&self.points[places[t * axes.speeds.len() + i]?]);
            row.extend(shown.iter().map(|i| number(cell(i), 2)));
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

/// The usual sums of a point; absent without a temperature. \[W\]
fn sums(point: &PointResult) -> Option<[f64; 6]> {
    point.oil.map(|_| point.sums)
}

/// Losses of the parts of a point; absent without a temperature, and where a model has no value. \[W\]
fn parts_of(point: &PointResult) -> Vec<Option<f64>> {
    let undefined = point.undefined.map(|(part, _)| part);
    let known = |i: usize| point.oil.is_some() && undefined != Some(i);
    let parts = point.parts.iter().enumerate();
    parts.map(|(i, watts)| known(i).then_some(*watts)).collect()
}
