//! Comparison with measured points: model minus measurement.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;

use super::{CompareEntry, unit};
use crate::analyses::common::gears::stated_gear;
use crate::analyses::common::measurable::is_measurable;
use crate::analyses::common::rows::{RowsPlan, Solved};
use crate::analyses::{Built, Engine, Planner, Stopped};
use crate::codes;
use crate::correction::{ReadyCorrection, UsedCorrection};
use crate::measured::{Measured, Row, Seen, counted};
use crate::numbers::{RPM, tidy};
use crate::points::{Note, PointResult, Statistics, bands};
use crate::study::{Data, Difference, Quantity};
use crate::table::Table;

/// The measurement of a comparison.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DataOfComparison {
    /// Name of the file, or of several.
    pub file: String,
    /// Number of points.
    pub points: usize,
    /// How the file was read, and which rows were omitted.
    pub notes: Vec<String>,
}

/// Differences of one model set from the measurement.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DataComparison {
    /// Name of the set.
    pub model_set: String,
    /// Compared quantity.
    pub quantity: Quantity,
    /// Unit of the differences.
    pub unit: &'static str,
    /// Statistics of the differences. [unit of the differences]
    pub difference: Option<Statistics>,
    /// Statistics of the differences of the loss, of the measured loss. [%]
    pub loss_difference_percent_of_loss: Option<Statistics>,
    /// Statistics of the differences that remain with a smooth correction, at the points inside of its measured region; absent without one. [unit of the differences]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corrected_difference: Option<Statistics>,
    /// Differences in bands of torque, then of speed.
    pub bands: Vec<Band>,
    /// What models of the set noted.
    pub notes: Vec<Note>,
    /// The measured points, in the order of the file.
    pub points: Vec<ComparedPoint>,
    /// Accuracy of the measurement: root mean square over the points, or the one that the study states. [unit of the differences]
    #[serde(skip)]
    pub accuracy: Option<f64>,
}

/// Differences within a band of torque or speed.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Band {
    /// Coordinate of the band: `torque` or `speed`.
    pub over: &'static str,
    /// Unit of the coordinate.
    pub unit: &'static str,
    /// Lower end. [unit of the coordinate]
    pub from: f64,
    /// Upper end. [unit of the coordinate]
    pub to: f64,
    /// Statistics of the differences. [unit of the differences]
    pub difference: Option<Statistics>,
}

/// One measured point and the model.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ComparedPoint {
    /// Line in the file. [-]
    pub line: u64,
    /// Name, if the file has names.
    pub name: Option<String>,
    /// Gear state.
    pub gear: String,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Measured quantity. [its unit; efficiency as a fraction]
    pub measured: Option<f64>,
    /// Quantity with the model set. [its unit; efficiency as a fraction]
    pub model: Option<f64>,
    /// Model minus measurement. [unit of the differences]
    pub difference: Option<f64>,
    /// The same difference as a loss, of the measured loss. [%]
    pub loss_difference_percent_of_loss: Option<f64>,
    /// Quantity and difference with a smooth correction; absent without one, and outside of its measured region.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corrected: Option<CorrectedPoint>,
    /// Accuracy of the measured quantity, if a column states it. [unit of the quantity]
    pub accuracy: Option<f64>,
    /// Name of the file, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Speed as it was solved. [rad/s]
    #[serde(skip)]
    pub speed: f64,
    /// True if the measured loss is too small for a difference in percent.
    #[serde(skip)]
    pub omitted: bool,
    /// Weight of the point; one if no column states it. [-]
    #[serde(skip)]
    pub weight: f64,
    /// True if there is no loss because nothing turns: no difference is stated.
    #[serde(skip)]
    pub still: bool,
}

/// A compared point with a correction.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct CorrectedPoint {
    /// Quantity of the model with the correction. [unit of the quantity]
    pub model: f64,
    /// Its 95 % band, of the correction alone. [unit of the quantity]
    pub band: [f64; 2],
    /// Corrected model minus measurement. [unit of the differences]
    pub difference: Option<f64>,
}

/// Model sets in order of agreement with the measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranking {
    /// Names, each with the root mean square of its differences; the best first. [unit of the differences]
    pub sets: Vec<(String, f64)>,
    /// Number of points at which every set has a value.
    pub points: usize,
    /// Number of points that are omitted because a set has no value there.
    pub omitted: usize,
}

pub(super) fn plan<'a>(cx: &Planner<'a>, entry: &'a CompareEntry, data: &Data) -> Result<RowsPlan<'a>, Stopped> {
    let bind: Vec<&str> = entry.bind.ids().collect();
    let measured = cx.read(&format!("{}.data", cx.path()), data, &bind)?;
    let gearbox = cx.gearbox(entry.gearbox.as_ref())?;
    let gear = stated_gear(cx, entry.gear.as_ref())?;
    RowsPlan::new(cx, gearbox, &entry.against, (measured, &entry.bind), gear, false)
}

/// The corrections of an entry, which belong to one identified set.
pub(super) fn corrections(cx: &Planner<'_>, entry: &CompareEntry) -> Result<Option<Vec<ReadyCorrection>>, Stopped> {
    let Some(from) = &entry.correction else { return Ok(None) };
    let path = format!("{}.correction", cx.path());
    let wrong = |message: &str, help: &str| Err(cx.wrong_as(codes::CORRECTION, &path, message, help));
    if !matches!(entry.quantity, Quantity::Loss | Quantity::LossTorque) {
        return wrong(
            "a correction is of the loss torque",
            "write `quantity: loss` or `quantity: loss_torque`",
        );
    }
    if entry.against.len() > 1 || !entry.bind.is_empty() {
        let help = "give it a comparison of its own: with one set, and without `bind`";
        return wrong(
            "a correction belongs to the identified model set, and not to several sets or bound values",
            help,
        );
    }
    cx.corrections(&path, from).map(Some)
}

/// Finds that the gearbox is the one that was identified, and records how many points are corrected.
fn keep_corrections(
    engine: &Engine<'_>,
    entry: &CompareEntry,
    all: &[ReadyCorrection],
    (solved, comparison): (&Solved<'_>, &DataComparison),
) -> Result<(), Stopped> {
    let Some(from) = &entry.correction else { return Ok(()) };
    let path = format!("{}.correction", engine.path());
    if all.is_empty() {
        let message = format!("`{}` has given no correction", from.name());
        let help = "correct that analysis, and place it before this one";
        return Err(engine.wrong_as(codes::NOT_FOUND_YET, &path, message, help));
    }
    for (_, run) in &solved.runs {
        let gear = &run.points.gear;
        let Some(ready) = all.iter().find(|ready| ready.record.gear == *gear) else {
            continue;
        };
        ready.check(engine, &path, run)?;
        let own = comparison
            .points
            .iter()
            .filter(|point| point.gear == *gear && point.model.is_some());
        let corrected = own.clone().filter(|point| point.corrected.is_some()).count();
        engine.keep_correction(UsedCorrection {
            inside: corrected,
            outside: own.count() - corrected,
            ..UsedCorrection::new(from.name(), &solved.name, ready)
        });
    }
    Ok(())
}

/// The sets, the measurement, and the comparisons.
type Compared<'a> = (Vec<Arc<Built<'a>>>, DataOfComparison, Vec<DataComparison>);

pub(super) fn compare<'a>(
    engine: &Engine<'_>,
    entry: &CompareEntry,
    data: &Data,
    plan: &RowsPlan<'a>,
    corrections: Option<&[ReadyCorrection]>,
) -> Result<Compared<'a>, Stopped> {
    let path = format!("{}.data", engine.path());
    let file = engine.data(&path, data)?.file.to_string();
    let solved = plan.solve(engine)?;
    let measured = &plan.measured;
    let corrections = corrections.unwrap_or_default();
    let all: Vec<DataComparison> = solved
        .iter()
        .map(|s| comparison(entry, measured, s, corrections))
        .collect();
    for of_set in solved.iter().zip(&all) {
        keep_corrections(engine, entry, corrections, of_set)?;
    }
    if all.iter().all(|c| c.points.iter().all(|p| p.measured.is_none())) {
        let message = format!("{file}: there is no measured {}", entry.quantity.name());
        let help = "add a column of it, or columns of torque and speed at both ports";
        return Err(engine.wrong(&path, message, help));
    }
    let built = solved.iter().flat_map(|s| &s.built).cloned().collect();
    let mut notes = measured.notes.clone();
    let still = all.first().map_or(0, |c| c.points.iter().filter(|p| p.still).count());
    if still > 0 {
        let points = if still == 1 { "point" } else { "points" };
        notes.push(format!(
            "{still} {points} at standstill, where measurement and model have no loss: not counted in the differences"
        ));
    }
    let data = DataOfComparison {
        file,
        points: measured.rows.len(),
        notes,
    };
    Ok((built, data, all))
}

fn comparison(
    entry: &CompareEntry,
    measured: &Measured,
    solved: &Solved<'_>,
    corrections: &[ReadyCorrection],
) -> DataComparison {
    let rows = measured.rows.iter().zip(&solved.rows);
    let points: Vec<ComparedPoint> = rows
        .map(|(row, (_, gear, point))| {
            let ready = corrections.iter().find(|ready| ready.record.gear == *gear);
            compared(entry, measured, (row, gear), point, ready)
        })
        .collect();
    let accuracies = points
        .iter()
        .filter_map(|p| counted(entry.quantity, entry.difference, p.accuracy?, p.measured));
    let differences = points.iter().filter_map(|p| Some((p.difference?, p.weight)));
    let losses = points
        .iter()
        .filter_map(|p| Some((p.loss_difference_percent_of_loss?, p.weight)));
    DataComparison {
        model_set: solved.name.clone(),
        quantity: entry.quantity,
        unit: entry.quantity.unit(entry.difference),
        difference: Statistics::weighted(differences),
        loss_difference_percent_of_loss: Statistics::weighted(losses),
        corrected_difference: Statistics::weighted(
            points.iter().filter_map(|p| Some((p.corrected?.difference?, p.weight))),
        ),
        bands: bands_of_points(&points),
        notes: solved.notes.clone(),
        accuracy: Statistics::from_values(accuracies).map(|s| s.rms).or(entry.accuracy),
        points,
    }
}

fn compared(
    entry: &CompareEntry,
    measured: &Measured,
    (row, gear): (&Row, &str),
    point: &PointResult,
    ready: Option<&ReadyCorrection>,
) -> ComparedPoint {
    let seen = Seen::without_rig(measured, row, point);
    let (saw, model) = (seen.quantity(entry.quantity), entry.quantity.value(point));
    let corrected = ready
        .and_then(|ready| ready.of(point))
        .zip(model)
        .map(|(correction, model)| {
            // A loss is the torque over the speed of the reference port.
            let factor = if entry.quantity == Quantity::Loss {
                point.reference_speed.abs()
            } else {
                1.0
            };
            let whole = model + correction.torque * factor;
            CorrectedPoint {
                model: whole,
                band: correction.band.map(|torque| model + torque * factor),
                difference: saw.and_then(|saw| entry.quantity.difference(entry.difference, saw, whole)),
            }
        });
    let losses = seen.loss.zip(point.loss);
    // A loss is zero at standstill whatever the model is.
    let still = entry.quantity == Quantity::Loss
        && point.reference_speed == 0.0
        && saw.zip(model).is_some_and(|(saw, model)| saw == 0.0 && model == 0.0);
    ComparedPoint {
        line: row.line,
        name: row.name.clone(),
        gear: gear.to_owned(),
        torque_nm: point.torque,
        speed_rpm: tidy(point.speed * RPM),
        oil_temperature_degc: point.oil,
        measured: saw,
        model,
        difference: saw
            .zip(model)
            .filter(|_| !still)
            .filter(|(saw, model)| entry.difference == Difference::Points || is_measurable(*saw, *model))
            .and_then(|(saw, model)| entry.quantity.difference(entry.difference, saw, model)),
        loss_difference_percent_of_loss: losses
            .filter(|(saw, model)| is_measurable(*saw, *model))
            .map(|(saw, model)| 100.0 * (model - saw) / saw),
        corrected,
        accuracy: seen.accuracy(entry.quantity),
        file: measured.file(row).map(str::to_owned),
        speed: point.speed,
        still,
        omitted: losses.is_some_and(|(saw, model)| !is_measurable(saw, model)),
        weight: measured.value(row, "weight").unwrap_or(1.0),
    }
}

/// Differences in bands of torque, then of speed.
fn bands_of_points(points: &[ComparedPoint]) -> Vec<Band> {
    type Coordinate = (&'static str, &'static str, fn(&ComparedPoint) -> f64);
    let coordinates: [Coordinate; 2] = [("torque", "nm", |p| p.torque_nm), ("speed", "rpm", |p| p.speed * RPM)];
    let mut list = Vec::new();
    for (over, unit, coordinate) in coordinates {
        let at: Vec<f64> = points.iter().map(coordinate).collect();
        for ([from, to], places) in bands(&at) {
            let compared = places.iter().map(|i| &points[*i]);
            list.push(Band {
                over,
                unit,
                from,
                to,
                difference: Statistics::weighted(compared.filter_map(|p| Some((p.difference?, p.weight)))),
            });
        }
    }
    list
}

/// Ranks sets over the points at which all sets have a value.
pub fn ranking(all: &[DataComparison]) -> Ranking {
    let count = all.first().map_or(0, |c| c.points.len());
    let common = |i: &usize| all.iter().all(|c| c.points[*i].difference.is_some());
    let places: Vec<usize> = (0..count).filter(common).collect();
    let rms = |c: &DataComparison| {
        let points = places.iter().map(|i| &c.points[*i]);
        Statistics::weighted(points.filter_map(|p| Some((p.difference?, p.weight)))).map(|s| s.rms)
    };
    let ranked = all.iter().filter_map(|c| Some((c.model_set.clone(), rms(c)?)));
    let mut sets: Vec<(String, f64)> = ranked.collect();
    sets.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ranking {
        sets,
        points: places.len(),
        omitted: count - places.len(),
    }
}

/// A number of a corrected point.
type ValueOfCorrected = fn(&CorrectedPoint) -> Option<f64>;

pub(super) fn table(name: &str, (quantity, difference): (Quantity, Difference), all: &[DataComparison]) -> Table {
    let what = quantity.name();
    let difference_name = format!("difference_{}", quantity.unit(difference));
    let mut points = all.iter().flat_map(|c| &c.points);
    let several = points.any(|p| p.file.is_some());
    let all_corrected = all
        .iter()
        .flat_map(|c| &c.points)
        .any(|point| point.corrected.is_some());
    let corrected: Vec<(String, &'static str, &'static str, ValueOfCorrected)> = if all_corrected {
        let (of, of_difference) = (unit(quantity), quantity.words(difference).1);
        vec![
            (
                format!("corrected_{what}"),
                of,
                "Quantity with the set and a smooth correction",
                |c| Some(c.model),
            ),
            (format!("corrected_{what}_low"), of, "Lower end of its 95 % band", |c| {
                Some(c.band[0])
            }),
            (
                format!("corrected_{what}_high"),
                of,
                "Upper end of its 95 % band",
                |c| Some(c.band[1]),
            ),
            (
                format!("corrected_{difference_name}"),
                of_difference,
                "Corrected model minus measurement",
                |c| c.difference,
            ),
        ]
    } else {
        Vec::new()
    };
    let table =
        Table::of_each(name, all, |comparison| &comparison.points)
            .text("model_set", "Model set", |(of_set, _)| &of_set.model_set);
    let table = if several {
        table.text("line", "File and line", |(_, point)| match &point.file {
            Some(file) => format!("{file}:{}", point.line),
            None => point.line.to_string(),
        })
    } else {
        table.number("line", "-", "Line in the file", |(_, point)| point.line as f64)
    };
    table
        .fields("name gear torque_nm speed_rpm oil_temperature_degc", |(_, point)| point)
        .number(
            format!("measured_{what}"),
            unit(quantity),
            "Measured quantity",
            |(_, point)| point.measured,
        )
        .number(what, unit(quantity), "Quantity with the set", |(_, point)| point.model)
        .number(
            difference_name,
            quantity.words(difference).1,
            "Model minus measurement",
            |(_, point)| point.difference,
        )
        .number(
            "loss_difference_percent_of_loss",
            "%",
            "Loss of the model minus measured loss",
            |(_, point)| point.loss_difference_percent_of_loss,
        )
        .each(corrected.iter(), |table, (name, unit, meaning, value)| {
            table.number(name.as_str(), *unit, *meaning, |(_, point)| {
                point.corrected.and_then(|corrected| value(&corrected))
            })
        })
        .number(
            format!("accuracy_{what}"),
            unit(quantity),
            "Accuracy of the measured quantity",
            |(_, point)| point.accuracy,
        )
        .finish()
}
