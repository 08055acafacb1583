//! Losses and efficiency over a grid, or at the points of a file.

mod axes;
mod entry;
pub mod export;
mod exported;
mod outcome;
mod plan;
mod points;
mod shown;

use std::ops::Range;
use std::sync::Arc;

use gearloss_fmu::Library;
use gearloss_framework::loss::Extent;
use serde_json::Value;

pub use axes::Axes;
pub use entry::MapEntry;
pub use export::{ExportFile, ExportFormat, ExportMap, ExportName, Refusal};
pub use outcome::{MapOfSet, MapOutcome, Mark, NotesOfSet, PartModel, SumMeaning};
pub use points::MapPoints;
pub use shown::{LossAt, LossGrid, SHOWN, ShownGrid, ShownMap, ShownPoint};

use self::export::ExportData;
use self::plan::{Planned, on_grid};
use self::points::{RowsOf, Taken, Taker, UndefinedLoss};
use self::shown::Selection;
use super::limits::at_points::LimitColumn;
use super::units::libraries;
use super::{Analysis, Built, Context, Stopped};
use crate::distinct::distinct;
use crate::measured::Measured;
use crate::points::{
    Field, Note, Numbered, OilTemperature, Piece, PointResult, SUMS, TotalLoss, evidence, merge, notes_with_shares,
};
use crate::register_analysis;
use crate::study::{Data, Uses, Write};
use crate::table::Table;

register_analysis!(MapEntry);

impl Analysis for MapEntry {
    const TYPE: &'static str = "map";
    type Outcome = MapOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .in_gears(&self.gear)
                .bind(&self.bind)
                .with("points", self.points.as_ref())
                .with("measured", self.measured.as_ref())
        }
    }

    fn run(&self, cx: &Context<'_>) -> Result<MapOutcome, Stopped> {
        match &self.points {
            Some(points) if self.grid.is_none() => self.over_list(cx, points),
            _ => self.over_grid(cx),
        }
    }

    fn formats(&self) -> &[Write] {
        &self.write
    }
}

impl MapEntry {
    /// The maps over the grid.
    fn over_grid(&self, cx: &Context<'_>) -> Result<MapOutcome, Stopped> {
        let planned = self.planned(cx)?;
        for plan in &planned {
            cx.checked(&plan.built, &plan.points)?;
        }
        exported::check(cx, &self.export, &planned)?;
        let libraries = self.libraries(cx)?;
        if cx.only_checks {
            self.measured(cx)?;
            return Err(Stopped::Checked);
        }
        let bound: Vec<String> = planned.first().map_or_else(Vec::new, |first| {
            first.bound.iter().map(|(path, _)| path.clone()).collect()
        });
        let all: Vec<&Built<'_>> = planned.iter().map(|plan| &*plan.built).collect();
        let mut rows = Rows::new(cx, self, &bound, &all);
        let whole = !self.export.is_empty();
        let mut maps = Vec::new();
        for (number, plan) in planned.iter().enumerate() {
            let mut map = Map::new(&plan.built, &plan.bound, &plan.points.gear, plan.points.oil, &rows);
            map.shown = ShownMap::new(Some(&plan.axes), whole);
            let taker = Taker {
                built: &plan.built,
                field: &plan.points.field,
                rows: RowsOf::new(&plan.built, &plan.points.gear, &plan.bound, &rows.parts, &rows.limits),
                selection: &Selection::new(Some(&plan.axes), whole),
                wanted: rows.wanted,
            };
            let take = |points: &mut Numbered<'_>| taker.take(points);
            let solve = || cx.solve_pieces(&plan.built, &plan.points, &take, &mut |piece| map.add(piece, &mut rows));
            if cx.part(number, solve)?.is_none() {
                continue;
            }
            map.notes = notes_with_shares(&plan.built.transmission, &map.seen, map.lost);
            maps.push(map);
        }
        cx.complete()?;
        for map in &mut maps {
            map.export = ExportData::solve(cx, &self.export, map)?;
        }
        if !self.export.is_empty() {
            ExportData::solve_between_oils(cx, &mut maps)?;
        }
        Ok(MapOutcome {
            libraries,
            ..self.outcome(cx, rows, maps, Vec::new())?
        })
    }

    /// The libraries of FMUs, if one is exported.
    fn libraries(&self, cx: &Context<'_>) -> Result<Vec<Library>, Stopped> {
        let is_needed = self.export.iter().any(|name| name.format().has_library());
        libraries(cx, &self.fmu_libraries, is_needed)
    }

    /// The points of the maps over the grid of the entry.
    fn planned<'s>(&'s self, cx: &'s Context<'_>) -> Result<Vec<Planned<'s>>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        match (&self.grid, &self.points) {
            (Some(_), None) if !self.bind.is_empty() || self.gear.is_some() => {
                Err(cx.wrong(&path, "`bind` and `gear` belong to `points`", "state them in the grid"))
            }
            (Some(grid), None) => on_grid(cx, self, grid, gearbox),
            _ => {
                let help = "write `grid: NAME`, or `points: { file: ... }`";
                Err(cx.wrong(&path, "a map needs either `grid` or `points`", help))
            }
        }
    }

    /// One map for each set, gear and combination of bound values of the rows of a file.
    fn over_list(&self, cx: &Context<'_>, points: &Data) -> Result<MapOutcome, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        if !self.export.is_empty() {
            return Err(cx.wrong(
                &format!("{path}.export"),
                "a table for another program needs a grid",
                "give `grid` instead of `points`",
            ));
        }
        self.libraries(cx)?;
        let bind: Vec<&str> = self.bind.ids().collect();
        let listed = cx.read(&format!("{path}.points"), points, &bind)?;
        let file = &cx.data(&path, points)?.file;
        let about = listed.notes.iter().map(|note| format!("{file}: {note}")).collect();
        let solved = cx.at_rows(
            gearbox,
            &self.model_sets,
            &self.bind,
            self.gear.as_deref(),
            &listed,
            false,
        )?;
        if cx.only_checks {
            self.measured(cx)?;
            return Err(Stopped::Checked);
        }
        let paths: Vec<String> = self.bind.iter().map(|(_, path)| path.clone()).collect();
        let all: Vec<&Built<'_>> = solved.iter().flat_map(|solved| &solved.built).collect();
        let mut rows = Rows::new(cx, self, &paths, &all);
        let mut maps = Vec::new();
        for solved in solved {
            let keys = distinct(solved.rows.iter().map(|(place, gear, _)| (*place, gear)));
            let built: Vec<Arc<Built<'_>>> = solved.built.into_iter().map(Arc::new).collect();
            for (place, gear) in keys {
                let own = solved
                    .rows
                    .iter()
                    .zip(&listed.rows)
                    .filter(|(row, _)| row.0 == place && row.1 == *gear);
                let bound: Vec<(String, Value)> = own.clone().next().map_or_else(Vec::new, |(_, row)| {
                    let values = row.bound.iter().map(|v| Value::from(v.as_str()));
                    paths.iter().cloned().zip(values).collect()
                });
                let points: Vec<PointResult> = own.map(|((_, _, point), _)| point.clone()).collect();
                let oil = common(&points).map_or(OilTemperature::Balance, OilTemperature::Fixed);
                let mut map = Map::new(&built[place], &bound, gear, oil, &rows);
                let taker = Taker {
                    built: &built[place],
                    field: &Field::List(Vec::new()),
                    rows: RowsOf::new(&built[place], gear, &bound, &rows.parts, &rows.limits),
                    selection: &Selection::new(None, false),
                    wanted: rows.wanted,
                };
                let piece = Piece::new(0, points, Vec::new()).made(0, &|points| taker.take(points));
                map.add(piece, &mut rows)?;
                map.notes.clone_from(&solved.notes);
                maps.push(map);
            }
        }
        self.outcome(cx, rows, maps, about)
    }

    /// Measured points for figures.
    fn measured(&self, cx: &Context<'_>) -> Result<Measured, Stopped> {
        match &self.measured {
            Some(data) => cx.read_at_ports(&format!("{}.measured", cx.path()), data, &[]),
            None => Ok(Measured::default()),
        }
    }

    fn outcome(
        &self,
        cx: &Context<'_>,
        rows: Rows<'_>,
        maps: Vec<Map<'_>>,
        about_points: Vec<String>,
    ) -> Result<MapOutcome, Stopped> {
        let head = cx.head(&maps.iter().map(|map| &*map.built).collect::<Vec<_>>());
        let measured = self.measured(cx)?;
        let grid = self.grid.as_ref().map(|name| cx.study.grid(&cx.path(), name));
        let envelope = grid.transpose()?.and_then(|grid| grid.envelope.clone());
        let mark = |row| Mark {
            gear: crate::measured::Row::clone(row).gear,
            torque: measured.value(row, "torque").unwrap_or(0.0),
            speed: measured.value(row, "speed").unwrap_or(0.0),
        };
        Ok(MapOutcome {
            head,
            envelope,
            notes_of_sets: notes_of_sets(&maps),
            maps: maps.into_iter().map(|map| map.outcome(&rows)).collect(),
            about_points,
            about_measured: measured.notes.clone(),
            marks: measured.rows.iter().map(mark).collect(),
            exports: self.export.clone(),
            lossy_gear_limit: self.lossy_gear_limit,
            libraries: Vec::new(),
            table: rows.table,
        })
    }
}

/// The common temperature of all points; absent if they differ or are found by heat balance.
fn common(points: &[PointResult]) -> Option<f64> {
    let first = points.first().filter(|p| p.balance.is_none())?.oil?;
    points.iter().all(|p| p.oil == Some(first)).then_some(first)
}

/// The table of all maps while its rows are computed.
struct Rows<'c> {
    cx: &'c Context<'c>,
    /// Paths of the components with a column; sets may have different components, and each component has one column.
    parts: Vec<String>,
    /// Limits of the study at points.
    limits: Vec<LimitColumn>,
    /// Number of columns before those of points.
    constant: usize,
    table: Table,
    /// Whether the table stores its rows: without a receiver, or if JSON lists the points.
    holds: bool,
    /// Whether rows are requested, by a file or by the caller.
    wanted: bool,
}

impl<'c> Rows<'c> {
    fn new(cx: &'c Context<'c>, entry: &MapEntry, bound: &[String], all: &[&Built<'_>]) -> Self {
        let parts = all.iter().flat_map(|built| built.transmission.parts());
        let parts: Vec<String> = distinct(parts.map(|part| &part.path)).into_iter().cloned().collect();
        let limits = LimitColumn::all(cx.language, cx.study);
        Self {
            table: RowsOf::none(bound, &parts, &limits).table(cx.name, []),
            limits,
            holds: cx.sink.is_none() || entry.write.contains(&Write::Json),
            wanted: cx.sink.is_none() || entry.write.iter().any(|format| *format != Write::Svg),
            constant: 2 + bound.len(),
            parts,
            cx,
        }
    }
}

/// A map during computation.
struct Map<'a> {
    built: Arc<Built<'a>>,
    bound: Vec<(String, Value)>,
    gear: String,
    oil: OilTemperature,
    shown: ShownMap,
    seen: Vec<Extent>,
    lost: TotalLoss,
    notes: Vec<Note>,
    passes: usize,
    undefined: Vec<UndefinedLoss>,
    /// Its rows in the table, if stored.
    rows: Range<usize>,
    export: ExportData,
}

impl<'a> Map<'a> {
    /// A map without points; its rows are the next in the table.
    fn new(
        built: &Arc<Built<'a>>,
        bound: &[(String, Value)],
        gear: &str,
        oil: OilTemperature,
        rows: &Rows<'_>,
    ) -> Self {
        Self {
            built: Arc::clone(built),
            bound: bound.to_vec(),
            gear: gear.to_owned(),
            oil,
            shown: ShownMap::new(None, false),
            seen: Vec::new(),
            lost: TotalLoss::default(),
            notes: Vec::new(),
            passes: 0,
            undefined: Vec::new(),
            rows: rows.table.len()..rows.table.len(),
            export: ExportData::default(),
        }
    }

    /// Adds the data of the next piece.
    fn add(&mut self, piece: Piece<Taken>, rows: &mut Rows<'_>) -> Result<(), Stopped> {
        merge(&mut self.seen, &piece.seen);
        let order: Vec<(usize, Range<usize>)> = piece.runs().collect();
        let (mut tables, mut picked, mut undefined) = (Vec::new(), Vec::new(), Vec::new());
        drop(piece.map(|taken| {
            self.passes += taken.passes;
            self.lost.merge(taken.lost);
            tables.push(taken.rows);
            picked.push(taken.picked);
            undefined.extend(taken.undefined);
        }));
        self.shown.add(picked);
        if !rows.wanted {
            return Ok(());
        }
        if rows.holds {
            undefined.sort_by_key(|loss: &UndefinedLoss| loss.number);
            self.undefined.extend(undefined);
            rows.table.extend(&tables, &order);
            self.rows.end = rows.table.len();
        } else if let Some(sink) = rows.cx.sink {
            let mut own = rows.table.header();
            own.extend(&tables, &order);
            sink.take(&own)?;
        }
        Ok(())
    }

    fn outcome(self, rows: &Rows<'_>) -> MapOfSet {
        let (built, t) = (&self.built, &self.built.transmission);
        let column = |path: &String| rows.parts.iter().position(|part| part == path).unwrap_or(0);
        let columns: Vec<usize> = t.parts().iter().map(|part| column(&part.path)).collect();
        MapOfSet {
            points: MapPoints::new(
                &rows.table,
                rows.constant,
                columns,
                self.rows,
                self.undefined,
                &rows.limits,
            ),
            limits: rows.limits.clone(),
            model_set: built.name.clone(),
            gear: self.gear,
            bound: self.bound.into_iter().collect(),
            oil_temperature_degc: self.oil.given(),
            sums: SUMS.iter().map(|(sum, meaning)| SumMeaning { sum, meaning }).collect(),
            parts: t
                .parts()
                .iter()
                .map(|part| PartModel {
                    part: part.path.clone(),
                    mechanism: part.mechanism,
                    model: t.instances()[part.notes.instance()].entry.name,
                })
                .collect(),
            passes: self.passes,
            notes: self.notes,
            evidence: evidence(t, &built.resolved, &|path| built.gearbox.places.is_written(path)),
            oil: self.oil,
            shown: self.shown,
            export: self.export,
        }
    }
}

/// Notes of all maps of each set, if the maps form one table over a bound value: their transmissions differ only in it.
fn notes_of_sets(maps: &[Map<'_>]) -> Option<Vec<NotesOfSet>> {
    let first = maps.first()?;
    let fits = |map: &Map<'_>| map.shown.is_line() && map.bound.len() == 1 && map.gear == first.gear;
    if !maps.iter().all(fits) {
        return None;
    }
    let names = distinct(maps.iter().map(|map| map.built.name.as_str()));
    let of_set = |name: &str| {
        let mut all = Vec::new();
        let own = || maps.iter().filter(|map| map.built.name == name);
        let mut lost = TotalLoss::default();
        for map in own() {
            merge(&mut all, &map.seen);
            lost.merge(map.lost);
        }
        NotesOfSet {
            model_set: name.to_owned(),
            notes: own()
                .next()
                .map_or_else(Vec::new, |map| notes_with_shares(&map.built.transmission, &all, lost)),
        }
    };
    Some(names.into_iter().map(of_set).collect())
}
