//! Losses and efficiency over a grid, or at the points of a file.

mod axes;
mod best;
mod entry;
pub mod export;
mod exported;
mod map_of;
mod outcome;
mod plan;
mod points;
mod shown;

use std::ops::Range;
use std::sync::Arc;

use gearloss_fmu::Library;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loss::Extent;
use gearloss_framework::machine::Machine;
use serde_json::Value;

pub use axes::Axes;
pub use best::{BestGears, PointsInGear};
pub use entry::MapEntry;
pub use export::{ExportFile, ExportFormat, ExportMap, ExportName, MachineAtSpeeds, Refusal};
pub use map_of::MapOf;
pub use outcome::{MapOfSet, MapOutcome, Mark, NotesOfSet, PartModel, SumMeaning};
pub use points::MapPoints;
pub use shown::{LossAt, LossGrid, SHOWN, ShownGrid, ShownMap, ShownPoint, UnitAt};

use self::export::ExportData;
use self::plan::{Planned, on_grid};
use self::points::{RowsOf, Taken, Taker, UndefinedLoss};
use self::shown::Selection;
use super::common::duties::machine_of_map;
use super::common::outside_maps::MachineOutside;
use super::common::rows::RowsPlan;
use super::common::units::libraries;
use super::{Analysis, Built, Engine, Plan, Planner, Run, Stopped, Work};
use crate::codes;
use crate::correction::{ReadyCorrection, UsedCorrection};
use crate::distinct::distinct;
use crate::limits::at_points::LimitColumn;
use crate::measured::{Measured, Row};
use crate::points::{
    Note, Numbered, OilTemperature, Piece, PointResult, SUMS, TotalLoss, evidence, merge, notes_with_shares,
};
use crate::register_analysis;
use crate::study::{BEST, Data, Uses, Write};
use crate::table::Table;

register_analysis!(MapEntry);

/// The points of maps, and what is read beside them.
pub struct MapPlan<'a> {
    points: PointsOfMap<'a>,
    libraries: Vec<Library>,
    /// Losses of the motor, for the best gear.
    machine: Option<Machine>,
    /// Measured points for figures.
    measured: Measured,
    /// The corrections by gear.
    corrections: Option<Corrections>,
}

/// Corrections by gear.
type Corrections = Vec<Arc<ReadyCorrection>>;

/// The points of maps.
enum PointsOfMap<'a> {
    /// One map for each set, gear and combination of bound values of a grid.
    Grid(Vec<Planned<'a>>),
    /// Rows of a file.
    List(Box<ListedPoints<'a>>),
}

/// Rows of a file with the notes on it.
struct ListedPoints<'a> {
    rows: RowsPlan<'a>,
    about: Vec<String>,
}

impl Plan for MapPlan<'_> {
    fn work(&self) -> Vec<Work> {
        match &self.points {
            PointsOfMap::Grid(planned) => Work::of_runs(planned.iter().flat_map(|plan| {
                // The best gear is found from all gears.
                let own = plan.gears.is_empty().then_some(&plan.run);
                own.into_iter().chain(&plan.gears)
            })),
            PointsOfMap::List(listed) => listed.rows.work(),
        }
    }
}

impl Analysis for MapEntry {
    const TYPE: &'static str = "map";
    type Plan<'a> = MapPlan<'a>;
    type Outcome = MapOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            best_gear: true,
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .in_gears(&self.gear)
                .bind(&self.bind)
                .with("points", self.points.as_ref())
                .with("measured", self.measured.as_ref())
        }
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<MapPlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let points = match (&self.grid, &self.points) {
            (Some(_), None) if !self.bind.is_empty() || self.gear.is_some() => {
                return Err(cx.wrong(&path, "`bind` and `gear` belong to `points`", "state them in the grid"));
            }
            (Some(grid), None) => {
                let planned = on_grid(cx, self, grid, gearbox)?;
                exported::check(cx, (&self.export, self.of), &planned)?;
                PointsOfMap::Grid(planned)
            }
            (None, Some(points)) => PointsOfMap::List(Box::new(self.listed(cx, gearbox, points)?)),
            _ => {
                let help = "write `grid: NAME`, or `points: { file: ... }`";
                return Err(cx.wrong(&path, "a map needs either `grid` or `points`", help));
            }
        };
        let corrections = self.corrections(cx, &points)?;
        self.check_machines(cx, &points)?;
        // The libraries of FMUs, if one is exported.
        let is_needed = self.export.iter().any(|name| name.format().has_library());
        let has_best =
            matches!(&points, PointsOfMap::Grid(planned) if planned.iter().any(|plan| !plan.gears.is_empty()));
        let at = format!("{path}.motor_map");
        if self.motor_map.is_some() && !has_best {
            let help = "delete it, or write `gear: best` in the grid";
            return Err(cx.wrong(&at, "without a choice of gears a motor changes no result", help));
        }
        let machine = self.motor_map.as_ref().map(|map| machine_of_map(cx, &at, map));
        Ok(MapPlan {
            machine: machine.transpose().map_err(|list| cx.found(list))?,
            points,
            libraries: libraries(cx, &self.fmu_libraries, is_needed)?,
            corrections,
            measured: match &self.measured {
                Some(data) => cx.read_at_ports(&format!("{path}.measured"), data, &[])?,
                None => Measured::default(),
            },
        })
    }

    fn reduce<'a>(&'a self, plan: MapPlan<'a>, engine: &Engine<'a>) -> Result<MapOutcome, Stopped> {
        let corrections = plan.corrections.as_ref();
        let (rows, maps, about_points) = match &plan.points {
            PointsOfMap::Grid(planned) => {
                let (rows, maps) = self.over_grid(engine, planned, (corrections, plan.machine.as_ref()))?;
                (rows, maps, Vec::new())
            }
            PointsOfMap::List(listed) => self.over_list(engine, listed, corrections)?,
        };
        self.keep_corrections(engine, corrections, &maps)?;
        let measured = plan.measured;
        let built: Vec<Arc<Built<'_>>> = maps.iter().map(|map| Arc::clone(&map.run.built)).collect();
        let grid = self.grid.as_ref().map(|name| engine.study.grid(&engine.path(), name));
        let mark = |row: &Row| Mark {
            gear: row.gear.clone(),
            torque: measured.value(row, "torque").unwrap_or(0.0),
            speed: measured.value(row, "speed").unwrap_or(0.0),
        };
        Ok(MapOutcome {
            head: engine.head(&built),
            of: self.of,
            envelope: grid.transpose()?.and_then(|grid| grid.envelope.clone()),
            notes_of_sets: notes_of_sets(&maps),
            maps: maps.into_iter().map(|map| map.outcome(&rows)).collect(),
            about_points,
            about_measured: measured.notes.clone(),
            marks: measured.rows.iter().map(mark).collect(),
            exports: self.export.clone(),
            lossy_gear_limit: self.lossy_gear_limit,
            libraries: plan.libraries,
            table: rows.table,
        })
    }
}

impl MapEntry {
    /// Refuses a map of machines that a gearbox does not have.
    fn check_machines(&self, cx: &Planner<'_>, points: &PointsOfMap<'_>) -> Result<(), Stopped> {
        let all: Vec<&Run<'_>> = match points {
            PointsOfMap::Grid(planned) => planned.iter().map(|plan| &plan.run).collect(),
            PointsOfMap::List(listed) => listed.rows.runs(),
        };
        let without = |run: &&Run<'_>| !cx.has_machines(&run.built.transmission);
        match all.into_iter().find(without) {
            Some(run) if !self.of.is_gearbox() => {
                let message = format!("`{}` has no machine", run.built.name);
                let help = "describe it under `machines` of the gearbox, or delete `of`";
                Err(cx.wrong_as(codes::NO_MACHINE, &format!("{}.of", cx.path()), message, help))
            }
            _ => Ok(()),
        }
    }

    /// The maps over the grid.
    fn over_grid<'a>(
        &self,
        engine: &'a Engine<'a>,
        planned: &[Planned<'a>],
        (corrections, machine): (Option<&Corrections>, Option<&Machine>),
    ) -> Result<(Rows<'a>, Vec<Map<'a>>), Stopped> {
        let bound: Vec<String> = planned.first().map_or_else(Vec::new, |first| {
            first.bound.iter().map(|(path, _)| path.clone()).collect()
        });
        let all: Vec<&Built<'_>> = planned.iter().map(|plan| &*plan.run.built).collect();
        let mut rows = Rows::new(engine, self, &bound, &all, corrections);
        let whole = !self.export.is_empty();
        let mut maps = engine.parts(planned, |plan| {
            let mut map = Map::new(&plan.run, &plan.bound, plan.run.points.oil, &rows);
            map.shown = ShownMap::new(Some(&plan.axes), whole);
            let runs = if plan.gears.is_empty() {
                vec![plan.run.clone()]
            } else {
                let runs = best::chosen(engine, &plan.gears, machine)?;
                map.gears = Some(best::gears(
                    &runs,
                    machine.is_some() || engine.has_machines(&plan.run.built.transmission),
                ));
                runs
            };
            for run in &runs {
                let number = map.gears.as_ref().and_then(|_| {
                    let states = run.built.transmission.states();
                    states.iter().position(|state| state.name == run.points.gear)
                });
                let selection = Selection::new(self.of, Some(&plan.axes), whole).in_gear(number);
                let taker = rows.taker(run, &plan.bound, &selection);
                let take = |points: &mut Numbered<'_>| taker.take(points);
                map.first = map.rows.len();
                engine.solve_pieces(run, &take, &mut |piece| map.add(piece, &mut rows))?;
            }
            map.notes = notes_with_shares(&plan.run.built.transmission, &map.seen, map.lost);
            Ok(map)
        })?;
        for map in &mut maps {
            map.export = ExportData::solve(engine, &self.export, map)?;
        }
        if !self.export.is_empty() {
            ExportData::solve_between_oils(engine, &mut maps)?;
        }
        Ok((rows, maps))
    }

    /// The rows of a file.
    fn listed<'a>(
        &'a self,
        cx: &Planner<'a>,
        gearbox: &'a Gearbox,
        points: &Data,
    ) -> Result<ListedPoints<'a>, Stopped> {
        let path = cx.path();
        if !self.export.is_empty() {
            return Err(cx.wrong(
                &format!("{path}.export"),
                "a table for another program needs a grid",
                "give `grid` instead of `points`",
            ));
        }
        let bind: Vec<&str> = self.bind.ids().collect();
        let listed = cx.read(&format!("{path}.points"), points, &bind)?;
        let file = &cx.data(&path, points)?.file;
        let gear = self.gear.as_deref();
        Ok(ListedPoints {
            about: listed.notes.iter().map(|note| format!("{file}: {note}")).collect(),
            rows: RowsPlan::new(cx, gearbox, &self.model_sets, (listed, &self.bind), gear, false)?,
        })
    }

    /// One map for each set, gear and combination of bound values of the rows of a file.
    fn over_list<'a>(
        &self,
        engine: &'a Engine<'a>,
        listed: &ListedPoints<'a>,
        corrections: Option<&Corrections>,
    ) -> Result<(Rows<'a>, Vec<Map<'a>>, Vec<String>), Stopped> {
        let solved = listed.rows.solve(engine)?;
        let paths: Vec<String> = self.bind.iter().map(|(_, path)| path.clone()).collect();
        let all: Vec<&Built<'_>> = solved.iter().flat_map(|solved| &solved.built).map(|b| &**b).collect();
        let mut rows = Rows::new(engine, self, &paths, &all, corrections);
        let mut maps = Vec::new();
        for solved in &solved {
            for (place, run) in &solved.runs {
                let gear = &run.points.gear;
                let of_map = solved
                    .rows
                    .iter()
                    .zip(&listed.rows.measured.rows)
                    .filter(|(row, _)| row.0 == *place && row.1 == *gear);
                let bound: Vec<(String, Value)> = of_map.clone().next().map_or_else(Vec::new, |(_, row)| {
                    let values = row.bound.iter().map(|v| Value::from(v.as_str()));
                    paths.iter().cloned().zip(values).collect()
                });
                let points: Vec<PointResult> = of_map.map(|((_, _, point), _)| point.clone()).collect();
                let oil = common(&points).map_or(OilTemperature::Balance, OilTemperature::Fixed);
                let mut map = Map::new(run, &bound, oil, &rows);
                let selection = Selection::new(self.of, None, false);
                let taker = rows.taker(run, &bound, &selection);
                let piece = Piece::new(0, points, Vec::new()).made(0, &|points| taker.take(points));
                map.add(piece, &mut rows)?;
                map.notes.clone_from(&solved.notes);
                maps.push(map);
            }
        }
        Ok((rows, maps, listed.about.clone()))
    }
}

impl MapEntry {
    /// The corrections, which belong to one model set without bound values.
    fn corrections(&self, cx: &Planner<'_>, points: &PointsOfMap<'_>) -> Result<Option<Corrections>, Stopped> {
        let Some(of) = &self.correction else { return Ok(None) };
        let path = format!("{}.correction", cx.path());
        let bound = match points {
            PointsOfMap::Grid(planned) => planned.iter().any(|plan| !plan.bound.is_empty()),
            PointsOfMap::List(_) => !self.bind.is_empty(),
        };
        if bound || self.model_sets.len() > 1 {
            let message = "a correction belongs to the identified model set, and not to several sets or bound values";
            let help = "give it a map of its own: with one set, and without `bind`";
            return Err(cx.wrong_as(codes::CORRECTION, &path, message, help));
        }
        let all = cx.corrections(&path, of)?;
        Ok(Some(all.into_iter().map(Arc::new).collect()))
    }

    /// Finds that the gearbox is the one that was identified, and records how many points are corrected.
    fn keep_corrections(
        &self,
        engine: &Engine<'_>,
        corrections: Option<&Corrections>,
        maps: &[Map<'_>],
    ) -> Result<(), Stopped> {
        let (Some(of), Some(all)) = (&self.correction, corrections) else {
            return Ok(());
        };
        if all.is_empty() {
            let message = format!("`{}` has given no correction", of.name());
            let help = "correct that analysis, and place it before this one";
            return Err(engine.wrong_as(
                codes::NOT_FOUND_YET,
                &format!("{}.correction", engine.path()),
                message,
                help,
            ));
        }
        for map in maps {
            let gear = &map.run.points.gear;
            let Some(ready) = all.iter().find(|ready| ready.record.gear == *gear) else {
                continue;
            };
            ready.check(engine, &format!("{}.correction", engine.path()), &map.run)?;
            engine.keep_correction(UsedCorrection {
                inside: map.inside[0],
                outside: map.inside[1],
                ..UsedCorrection::new(of.name(), &map.run.built.name, ready)
            });
        }
        Ok(())
    }
}

/// The common temperature of all points; absent if they differ or are found by heat balance.
fn common(points: &[PointResult]) -> Option<f64> {
    let first = points.first().filter(|p| p.balance.is_none())?.oil?;
    points.iter().all(|p| p.oil == Some(first)).then_some(first)
}

/// The table of all maps while its rows are computed.
struct Rows<'c> {
    engine: &'c Engine<'c>,
    /// Paths of the components with a column; sets may have different components, and each component has one column.
    parts: Vec<String>,
    /// Limits of the study at points.
    limits: Vec<LimitColumn>,
    /// Corrections by gear.
    corrections: Option<Corrections>,
    /// Whether a transmission has machines.
    has_unit: bool,
    of: MapOf,
    /// Number of columns before those of points.
    constant: usize,
    table: Table,
    /// Whether the table stores its rows: without a receiver, or if JSON lists the points.
    holds: bool,
    /// Whether rows are requested, by a file or by the caller.
    wanted: bool,
}

impl<'c> Rows<'c> {
    fn new(
        engine: &'c Engine<'c>,
        entry: &MapEntry,
        bound: &[String],
        all: &[&Built<'_>],
        corrections: Option<&Corrections>,
    ) -> Self {
        let parts = all.iter().flat_map(|built| built.transmission.parts());
        let parts: Vec<String> = distinct(parts.map(|part| &part.path)).into_iter().cloned().collect();
        let limits = LimitColumn::all(engine.language, engine.study);
        let has_unit = all.iter().any(|built| engine.has_machines(&built.transmission));
        let formats = engine.formats();
        let mut none = RowsOf::none(bound, &parts, &limits, has_unit);
        none.corrected = corrections.is_some();
        Self {
            table: none.table(engine.name, []),
            corrections: corrections.cloned(),
            limits,
            has_unit,
            of: entry.of,
            holds: engine.sink.is_none() || formats.contains(&Write::Json),
            wanted: engine.sink.is_none() || formats.iter().any(|format| *format != Write::Svg),
            constant: 2 + bound.len(),
            parts,
            engine,
        }
    }

    /// Takes the rows of a run.
    fn taker<'r>(&self, run: &'r Run<'r>, bound: &[(String, Value)], selection: &'r Selection) -> Taker<'r> {
        let mut rows = RowsOf::new(run, bound, &self.parts, &self.limits, self.has_unit);
        let of_gear = |ready: &&Arc<ReadyCorrection>| ready.record.gear == run.points.gear;
        rows.corrected = self.corrections.is_some();
        rows.correction = self.corrections.iter().flatten().find(of_gear).cloned();
        Taker {
            rows,
            wanted: self.wanted,
            selection,
            run,
        }
    }
}

/// A map during computation.
struct Map<'a> {
    /// Its points; of a list without them.
    run: Run<'a>,
    bound: Vec<(String, Value)>,
    oil: OilTemperature,
    of: MapOf,
    shown: ShownMap,
    seen: Vec<Extent>,
    lost: TotalLoss,
    notes: Vec<Note>,
    passes: usize,
    undefined: Vec<UndefinedLoss>,
    /// Numbers of points with a loss inside and outside of the region of a correction.
    inside: [usize; 2],
    /// Machines outside their maps.
    outside_maps: Vec<MachineOutside>,
    /// Its rows in the table, if stored.
    rows: Range<usize>,
    /// Number of its rows before those of the present run.
    first: usize,
    /// Gears of a map in the best gear of each point.
    gears: Option<BestGears>,
    export: ExportData,
}

impl<'a> Map<'a> {
    /// A map without points; its rows are the next in the table.
    fn new(run: &Run<'a>, bound: &[(String, Value)], oil: OilTemperature, rows: &Rows<'_>) -> Self {
        Self {
            run: run.clone(),
            bound: bound.to_vec(),
            oil,
            of: rows.of,
            shown: ShownMap::new(None, false),
            seen: Vec::new(),
            lost: TotalLoss::default(),
            notes: Vec::new(),
            passes: 0,
            undefined: Vec::new(),
            inside: [0; 2],
            outside_maps: Vec::new(),
            rows: rows.table.len()..rows.table.len(),
            first: 0,
            gears: None,
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
            self.inside[0] += taken.inside[0];
            self.inside[1] += taken.inside[1];
            MachineOutside::merge(&mut self.outside_maps, taken.outside_maps);
            tables.push(taken.rows);
            picked.push(taken.picked);
            undefined.extend(taken.undefined.into_iter().map(|loss| UndefinedLoss {
                number: loss.number + self.first,
                ..loss
            }));
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
        } else if let Some(sink) = rows.engine.sink {
            let mut header = rows.table.header();
            header.extend(&tables, &order);
            sink.take(&header)?;
        }
        Ok(())
    }

    fn outcome(self, rows: &Rows<'_>) -> MapOfSet {
        let built = &self.run.built;
        let t = &built.transmission;
        let column = |path: &String| rows.parts.iter().position(|part| part == path).unwrap_or(0);
        let columns: Vec<usize> = t.parts().iter().map(|part| column(&part.path)).collect();
        MapOfSet {
            points: MapPoints::new(
                &rows.table,
                rows.constant,
                columns,
                self.rows,
                self.undefined,
                (&rows.limits, rows.has_unit),
            )
            .naming_gears(self.gears.is_some()),
            of: self.of,
            limits: rows.limits.clone(),
            model_set: built.name.clone(),
            gear: match &self.gears {
                Some(_) => BEST.to_owned(),
                None => self.run.points.gear.clone(),
            },
            best_gears: self.gears,
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
            outside_maps: self.outside_maps,
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
    let fits =
        |map: &Map<'_>| map.shown.is_line() && map.bound.len() == 1 && map.run.points.gear == first.run.points.gear;
    if !maps.iter().all(fits) {
        return None;
    }
    let names = distinct(maps.iter().map(|map| map.run.built.name.as_str()));
    let of_set = |name: &str| {
        let mut all = Vec::new();
        let of_set = || maps.iter().filter(|map| map.run.built.name == name);
        let mut lost = TotalLoss::default();
        for map in of_set() {
            merge(&mut all, &map.seen);
            lost.merge(map.lost);
        }
        NotesOfSet {
            model_set: name.to_owned(),
            notes: of_set().next().map_or_else(Vec::new, |map| {
                notes_with_shares(&map.run.built.transmission, &all, lost)
            }),
        }
    };
    Some(names.into_iter().map(of_set).collect())
}
