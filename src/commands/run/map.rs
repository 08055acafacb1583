//! Losses and efficiency over a grid.

mod export;
mod files;
mod kept;
mod over_bound;
mod pictures;
mod plan;
mod results;
mod rows;
mod taken;

pub use gearloss_report::text::{SHOWN, spread, spread_over};
pub use gearloss_studies::analyses::numbers::{tidy, word};
use std::rc::Rc;

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Extent;
use gearloss_studies::analysis::{Field, Note, Numbered, OilTemperature, Piece, PointResult, merge, notes};
use gearloss_studies::measured::{Measured, Row};
use gearloss_studies::study::MapEntry;
use serde_json::Value;

use self::files::Files;
use self::kept::{Brief, Kept, Shown, Wanted};
use self::over_bound::over_bound;
use self::pictures::pictures;
pub(super) use self::plan::Planned;
use self::rows::RowsOf;
use self::taken::{Taken, Taker};
use super::super::solve::RPM;
use super::{Built, Runner};
use crate::output::{Failure, Out, Table, fixed, number};

pub fn run(runner: &Runner<'_>, name: &str, entry: &MapEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let maps = match &entry.points {
        Some(points) if entry.grid.is_none() => {
            if !entry.export.is_empty() {
                let export = format!("{path}.export");
                return Err(runner.wrong(
                    &export,
                    "a table for another program needs a grid",
                    "give `grid` in place of `points`",
                ));
            }
            let bind: Vec<&str> = entry.bind.ids().collect();
            let listed = runner.read(&format!("{path}.points"), points, &bind)?;
            for note in &listed.notes {
                out.line(format!("{name}: {}: {note}", runner.data(&path, points)?.file))?;
            }
            on_list(runner, name, entry, &listed, gearbox)?
        }
        _ => {
            let planned = planned(runner, name, entry)?;
            for plan in &planned {
                runner.checked(&plan.built, &plan.points)?;
            }
            export::check(runner, name, entry, &planned)?;
            on_grid(runner, name, entry, &planned)?
        }
    };
    if runner.only_checks {
        if let Some(data) = &entry.measured {
            runner.read_at_ports(&format!("{path}.measured"), data, &[])?;
        }
        return Ok(());
    }
    let one_table = over_bound::fits(&maps);
    if one_table {
        over_bound(runner, name, &maps, out)?;
    } else {
        maps.iter().try_for_each(|map| map.show(runner, name, out))?;
    }
    for line in export::write(runner, name, entry, &maps)? {
        out.line(format!("{name}: {line}"))?;
    }
    let measured = match &entry.measured {
        Some(data) => runner.read_at_ports(&format!("{path}.measured"), data, &[])?,
        None => Measured::default(),
    };
    for note in &measured.notes {
        out.line(format!("{name}: measured: {note}"))?;
    }
    if let Some(thinned) = maps.iter().find_map(|map| map.kept.thinned()) {
        out.line(format!("{name}: {thinned}"))?;
    }
    let marks: Vec<Mark> = measured.rows.iter().map(|row| Mark::of(&measured, row)).collect();
    pictures(runner, name, &maps, &marks, &entry.write)
}

/// The points of the maps over the grid that an entry names.
pub(super) fn planned<'s>(
    runner: &'s Runner<'_>,
    name: &str,
    entry: &'s MapEntry,
) -> Result<Vec<Planned<'s>>, Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    match (&entry.grid, &entry.points) {
        (Some(_), None) if !entry.bind.is_empty() || entry.gear.is_some() => {
            Err(runner.wrong(&path, "`bind` and `gear` belong to `points`", "state them in the grid"))
        }
        (Some(grid), None) => plan::on_grid(runner, name, entry, grid, gearbox),
        _ => {
            let mend = "write `grid: NAME`, or `points: { file: ... }`";
            Err(runner.wrong(&path, "a map needs either `grid` or `points`", mend))
        }
    }
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

/// Solves the maps over a grid and writes their points as they come.
fn on_grid<'s>(
    runner: &'s Runner<'_>,
    name: &str,
    entry: &MapEntry,
    planned: &[Planned<'s>],
) -> Result<Vec<Map<'s>>, Failure> {
    if runner.only_checks {
        return Ok(Vec::new());
    }
    let bound: Vec<String> = planned.first().map_or_else(Vec::new, |first| {
        first.bound.iter().map(|(path, _)| path.clone()).collect()
    });
    let all: Vec<&Built<'_>> = planned.iter().map(|p| &*p.built).collect();
    let mut files = Files::new(runner, name, entry, &bound, &all)?;
    let mut maps = Vec::new();
    for (number, plan) in planned.iter().enumerate() {
        let whole = !entry.export.is_empty();
        let wanted = Wanted::new(Some(&plan.axes), whole);
        let taker = Taker {
            field: &plan.points.field,
            rows: RowsOf::new(&plan.built, &plan.points.gear, &plan.bound, &files.parts),
            shape: files.table.shape(),
            wanted: &wanted,
            waits: files.waited.is_some(),
        };
        let kept = Kept::new(Some(&plan.axes), whole);
        let mut map = Map::new(&plan.built, &plan.bound, &plan.points.gear, plan.points.oil, kept);
        let take = |points: &mut Numbered<'_>| taker.take(points);
        runner.solve_pieces(&plan.built, &plan.points, Some((name, number)), &take, &mut |piece| {
            map.add(piece, &mut files)
        })?;
        map.notes = notes(&plan.built.transmission, &map.seen);
        maps.push(map);
    }
    files.finish(runner, name, entry, &maps)?;
    Ok(maps)
}

/// One map for each set, each gear state and each combination of bound values that the rows have.
fn on_list<'s>(
    runner: &'s Runner<'_>,
    name: &str,
    entry: &'s MapEntry,
    listed: &Measured,
    gearbox: &'s Gearbox,
) -> Result<Vec<Map<'s>>, Failure> {
    let solved = runner.at_rows(
        gearbox,
        &entry.model_sets,
        &entry.bind,
        entry.gear.as_deref(),
        listed,
        false,
    )?;
    if runner.only_checks {
        return Ok(Vec::new());
    }
    let paths: Vec<String> = entry.bind.iter().map(|(_, path)| path.clone()).collect();
    let all: Vec<&Built<'_>> = solved.iter().flat_map(|s| &s.built).collect();
    let mut files = Files::new(runner, name, entry, &paths, &all)?;
    let mut maps = Vec::new();
    for solved in solved {
        let mut keys: Vec<(usize, String)> = Vec::new();
        for (place, gear, _) in &solved.rows {
            if !keys.iter().any(|key| (key.0, &key.1) == (*place, gear)) {
                keys.push((*place, gear.clone()));
            }
        }
        let built: Vec<Rc<Built<'_>>> = solved.built.into_iter().map(Rc::new).collect();
        for (place, gear) in keys {
            let of_map = solved
                .rows
                .iter()
                .zip(&listed.rows)
                .filter(|(row, _)| row.0 == place && row.1 == gear);
            let bound = of_map.clone().next().map_or_else(Vec::new, |(_, row)| {
                let values = row.bound.iter().map(|v| Value::from(v.as_str()));
                paths.iter().cloned().zip(values).collect()
            });
            let points: Vec<PointResult> = of_map.map(|((_, _, point), _)| point.clone()).collect();
            let oil = common(&points).map_or(OilTemperature::Balance, OilTemperature::Fixed);
            let wanted = Wanted::new(None, false);
            let taker = Taker {
                field: &Field::List(Vec::new()),
                rows: RowsOf::new(&built[place], &gear, &bound, &files.parts),
                shape: files.table.shape(),
                wanted: &wanted,
                waits: files.waited.is_some(),
            };
            let mut map = Map::new(&built[place], &bound, &gear, oil, Kept::new(None, false));
            let piece = Piece::new(0, points, Vec::new()).made(0, &|points| taker.take(points));
            map.add(piece, &mut files)?;
            map.notes.clone_from(&solved.notes);
            maps.push(map);
        }
    }
    files.finish(runner, name, entry, &maps)?;
    Ok(maps)
}

/// The temperature that all points share; absent where they differ, or where it is found by balance.
fn common(points: &[PointResult]) -> Option<f64> {
    let first = points.first().filter(|p| p.balance.is_none())?.oil?;
    points.iter().all(|p| p.oil == Some(first)).then_some(first)
}

/// Axes of a grid for one gearbox.
#[derive(Clone)]
pub struct Axes {
    /// \[Nm\]
    torques: Vec<f64>,
    /// \[rad/s\]
    speeds: Vec<f64>,
    /// Ratings of speed and torque where the axes count in shares of them.
    shares: [Option<f64>; 2],
}

/// A map under one set in one gear state with one combination of bound values.
struct Map<'a> {
    built: Rc<Built<'a>>,
    bound: Vec<(String, Value)>,
    gear: String,
    oil: OilTemperature,
    kept: Kept,
    seen: Vec<Extent>,
    notes: Vec<Note>,
    passes: usize,
    /// Where the pieces of the map wait for its JSON.
    waiting: Vec<u64>,
}

impl<'a> Map<'a> {
    /// A map without points yet.
    fn new(built: &Rc<Built<'a>>, bound: &[(String, Value)], gear: &str, oil: OilTemperature, kept: Kept) -> Self {
        Self {
            built: Rc::clone(built),
            bound: bound.to_vec(),
            gear: gear.to_owned(),
            oil,
            kept,
            seen: Vec::new(),
            notes: Vec::new(),
            passes: 0,
            waiting: Vec::new(),
        }
    }

    /// Adds what was taken from a piece that follows: writes its rows, and keeps what is still needed.
    fn add(&mut self, piece: Piece<Taken>, files: &mut Files) -> Result<(), Failure> {
        merge(&mut self.seen, &piece.seen);
        let order: Vec<_> = piece.runs().collect();
        let (mut rows, mut picked) = (Vec::new(), Vec::new());
        let waiting = piece.map(|taken| {
            self.passes += taken.passes;
            rows.push(taken.rows);
            picked.push(taken.picked);
            taken.waiting
        });
        files.table.push_rows(rows, order)?;
        if let Some(waited) = &mut files.waited {
            self.waiting.push(waited.append(&waiting)?);
        }
        self.kept.add(picked);
        Ok(())
    }
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

impl Map<'_> {
    /// The bound values, for a heading.
    fn words(&self) -> String {
        let words = self
            .bound
            .iter()
            .map(|(path, value)| format!(", {path} {}", word(value)));
        words.collect()
    }

    /// Prints the map.
    fn show(&self, runner: &Runner<'_>, name: &str, out: &mut Out) -> Result<(), Failure> {
        let words = self.words();
        out.line(format!(
            "{name}: efficiency in %, gear {}, models {}{words}",
            self.gear, self.built.name
        ))?;
        let percent = |p: &Brief| p.efficiency.map(|e| 100.0 * e);
        if let Some(grid) = &self.kept.grid {
            out.text(&self.table(grid, &percent))?;
            if self.oil == OilTemperature::Balance {
                out.line("oil temperature in degC")?;
                out.text(&self.table(grid, &|p| p.oil))?;
            }
        } else {
            let mut table = Table::new(&["torque Nm", "speed rpm", "oil degC", "efficiency %", "loss W"]);
            for i in spread(self.kept.points.len()) {
                let p = &self.kept.points[i];
                table.row(vec![
                    format!("{}", tidy(p.torque)),
                    fixed(p.speed * RPM, 0),
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
        runner.outside(&self.notes, out);
        out.line("")?;
        Ok(())
    }

    /// Says where the table shows fewer points than there are.
    fn thinned(&self) -> Option<String> {
        let (torques, speeds) = self.kept.size();
        let shown = |count: usize| spread(count).len();
        (shown(torques) * shown(speeds) < torques * speeds).then(|| {
            format!(
                "shown: {} of {} points, both ends among them; the files hold all",
                shown(torques) * shown(speeds),
                torques * speeds
            )
        })
    }

    fn table(&self, Shown { axes, places }: &Shown, quantity: &dyn Fn(&Brief) -> Option<f64>) -> String {
        let shown = spread(axes.speeds.len());
        let mut head = vec!["torque Nm".to_owned()];
        head.extend(shown.iter().map(|i| format!("{} rpm", fixed(axes.speeds[*i] * RPM, 0))));
        let mut table = Table::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
        for t in spread(axes.torques.len()) {
            let mut row = vec![format!("{}", tidy(axes.torques[t]))];
            let cell = |i: &usize| quantity(&self.kept.points[places[t * axes.speeds.len() + i]?]);
            row.extend(shown.iter().map(|i| number(cell(i), 2)));
            table.row(row);
        }
        table.render()
    }
}

/// The usual sums of a point; absent without a temperature or a flow. \[W\]
fn sums(point: &PointResult) -> Option<[f64; 6]> {
    point.oil.filter(|_| point.status.has_flow()).map(|_| point.sums)
}

/// Loss of a part at a point; absent without a temperature or a flow, and where its model has no value. \[W\]
fn loss_of(point: &PointResult, part: usize) -> Option<f64> {
    let known = point.oil.is_some()
        && point.status.has_flow()
        && point.undefined.is_none_or(|(undefined, _)| undefined != part);
    known.then(|| point.parts[part])
}

#[cfg(test)]
mod tests {
    use super::{RPM, tidy};

    #[test]
    fn speeds_keep_their_significant_digits() {
        // Back from rad/s they are those that were written.
        for written in [8000.0, 18000.0, 0.01, 1.0 / 1024.0, 1234.5678, -3000.0, 1e-6, 22000.0] {
            assert!(
                tidy(written / RPM * RPM).to_bits() == tidy(written).to_bits(),
                "{written}"
            );
        }
        assert!(format!("{}", tidy(8000.0 / RPM * RPM)) == "8000");
        assert!(format!("{}", tidy(0.1 + 0.2)) == "0.3");
        // Behind a ratio of 256, where 1e-6 rpm were 2.6 % of it.
        for exact in [
            0.01 / 256.0,
            1e4 / 3.0,
            -2.0 / 3.0,
            9.999_999_999_999_9,
            1e-8 / 3.0,
            1e12 / 3.0,
        ] {
            assert!((tidy(exact) / exact - 1.0).abs() <= 5e-13, "{exact} {}", tidy(exact));
        }
        assert!(tidy(0.0).to_bits() == 0 && tidy(-3e-12).to_bits() == 0);
        assert!(
            tidy(1e300).to_bits() == 1e300_f64.to_bits()
                && tidy(f64::INFINITY).is_infinite()
                && tidy(f64::NAN).is_nan()
        );
    }
}
