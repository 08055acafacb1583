//! Many points, on all cores, as columns.

use std::sync::atomic::Ordering;

use gearloss::api::{self, Field, OilTemperature, Points};
use gearloss::framework::flow::Status;
use gearloss::framework::thermal::Outcome;
use gearloss::studies::numbers::{RPM, tidy};
use gearloss::studies::points::{Numbered, Piece, SUMS, UnitColumn, UnitPoint, solve_pieces};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::errors::{raised, wrong};
use crate::function;
use crate::gearbox::Transmission;
use crate::point::{flow, gear_of, oil_of};
use crate::quantity::unit;
use crate::table::{Column, Table};
use crate::work;

/// Gear state and ports of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    gear: Option<String>,
    torque_at: Option<String>,
    speed_at: Option<String>,
    ideal: bool,
    parts: bool,
}

/// Columns of numbers before the components: name, unit, meaning.
const NUMBERS: [(&str, &str, &str); 8] = [
    ("torque_nm", "Nm", "Given torque"),
    ("speed_rpm", "rpm", "Given speed"),
    ("oil_temperature_degc", "degC", "Oil temperature"),
    ("efficiency", "-", "Output power over input power"),
    ("loss_w", "W", "Sum of all losses"),
    ("loss_torque_nm", "Nm", "Loss over the speed of the reference port"),
    ("input_w", "W", "Input power"),
    ("output_w", "W", "Output power"),
];

fn finite(py: Python<'_>, name: &str, values: &[f64]) -> PyResult<()> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(i) => Err(wrong(
            py,
            gearloss::document::codes::OUT_OF_BOUNDS,
            format!("{name}[{i}] is {}, not a finite number", values[i]),
            "give numbers",
        )),
    }
}

/// Every torque at every speed.
pub fn grid(py: Python<'_>, torque: PyReadonlyArray1<'_, f64>, speed: PyReadonlyArray1<'_, f64>) -> PyResult<Field> {
    let (torques, speeds) = (torque.as_slice()?.to_vec(), speed.as_slice()?.to_vec());
    finite(py, "torque", &torques)?;
    finite(py, "speed", &speeds)?;
    let unit = unit("rpm");
    Ok(Field::Grid {
        torques,
        speeds: speeds.iter().map(|rpm| unit.to_si(*rpm)).collect(),
    })
}

/// A list of points of equal lengths.
pub fn list(
    py: Python<'_>,
    torque: PyReadonlyArray1<'_, f64>,
    speed: PyReadonlyArray1<'_, f64>,
    oil: Option<PyReadonlyArray1<'_, f64>>,
) -> PyResult<Field> {
    let (torques, speeds) = (torque.as_slice()?, speed.as_slice()?);
    finite(py, "torque", torques)?;
    finite(py, "speed", speeds)?;
    let oils = oil.as_ref().map(PyReadonlyArray1::as_slice).transpose()?;
    if let Some(oils) = oils {
        finite(py, "oil_temperature", oils)?;
        if let Some(i) = oils.iter().position(|x| !(-60.0..=250.0).contains(x)) {
            let message = format!("oil_temperature[{i}] is {} degC, not from -60 to 250 degC", oils[i]);
            return Err(wrong(
                py,
                gearloss::document::codes::OUT_OF_BOUNDS,
                message,
                "give temperatures from -60 to 250 degC",
            ));
        }
    }
    if torques.len() != speeds.len() || oils.is_some_and(|oils| oils.len() != speeds.len()) {
        let message = "torque, speed and oil_temperature have different lengths";
        return Err(wrong(
            py,
            gearloss::framework::codes::GIVEN,
            message,
            "give arrays of one length",
        ));
    }
    let unit = unit("rpm");
    let points = torques.iter().zip(speeds).enumerate();
    Ok(Field::List(
        points
            .map(|(i, (torque, rpm))| api::Given {
                torque: *torque,
                speed: unit.to_si(*rpm),
                oil: oils.map(|oils| oils[i]),
            })
            .collect(),
    ))
}

/// Numbers of the points of a task, by column, and their states.
#[derive(Default)]
struct Numbers {
    columns: Vec<Vec<f64>>,
    states: Vec<(Status, Option<Outcome>)>,
}

/// Solves a field; the temperature is that of its points, the given one, or that of the gearbox.
pub fn solve(py: Python<'_>, t: &Transmission, field: Field, oil: Option<f64>, given: Given) -> PyResult<Table> {
    if let Some(name) = function::one_by_one(&t.resolved.value) {
        let message =
            format!("the function `{name}` takes one point at a time, which is too slow for points in parallel");
        let help = "write it for arrays and leave out `vectorised=False`, or solve the points one by one";
        return Err(wrong(py, gearloss::framework::codes::MODEL, message, help));
    }
    let mut points = Points::at_reference(&t.built, &gear_of(py, t, given.gear)?, field);
    points.oil = oil_of(py, t, oil)?;
    points.flow = flow(given.ideal);
    if let Some(port) = given.torque_at {
        points.torque_at = vec![port];
    }
    if let Some(port) = given.speed_at {
        points.speed_at = vec![port];
    }
    let parts = if given.parts { t.built.parts() } else { &[] };
    let has_machines = t
        .built
        .active_machines(points.oil == OilTemperature::Network)
        .next()
        .is_some();
    let unit_columns = UnitPoint::columns(has_machines);
    let count = NUMBERS.len() + SUMS.len() + parts.len() + unit_columns.len();
    let transmission = &t.built;
    let solved = work::run(py, |stop| {
        let make = |piece: &mut Numbered<'_>| numbers(piece, (count, unit_columns), parts.len());
        let pieces: Vec<usize> = (0..points.field.pieces()).collect();
        let mut all = Numbers {
            columns: vec![Vec::with_capacity(points.field.len()); count],
            states: Vec::with_capacity(points.field.len()),
        };
        let go_on = |_| !stop.load(Ordering::Relaxed);
        solve_pieces(transmission, &points, &pieces, &make, &go_on, &mut |piece| {
            all.add(piece);
            true
        })
        .map(|_| all)
    })?;
    let all = solved.map_err(|list| raised(py, &t.gearbox.findings(list)))?;
    let mut columns = Vec::with_capacity(count + 1);
    let sums = SUMS
        .iter()
        .map(|(name, meaning)| (format!("{name}_w"), "W", format!("Losses: {meaning}")));
    let parts = parts
        .iter()
        .map(|part| (format!("{}_w", part.path), "W", format!("Loss of {}", part.path)));
    let of_points = NUMBERS
        .iter()
        .map(|(name, unit, meaning)| ((*name).to_owned(), *unit, (*meaning).to_owned()));
    let of_unit = unit_columns
        .iter()
        .map(|column| (column.name.to_owned(), column.unit, column.meaning.to_owned()));
    let names = of_points.chain(sums).chain(parts).chain(of_unit);
    for ((name, unit, meaning), values) in names.zip(all.columns) {
        columns.push(Column::numbers(py, name, unit, meaning, values)?);
    }
    let states = all.states.iter().map(|(status, _)| Some(status.name()));
    let balances = all.states.iter().map(|(_, balance)| balance.map(Outcome::name));
    columns.insert(3, Column::texts(py, "status", "State of the transmission", states)?);
    let meaning = "Outcome of the heat balance; none if the temperature is given";
    columns.insert(3, Column::texts(py, "balance", meaning, balances)?);
    Ok(Table::new("points", columns))
}

/// The numbers of some points.
fn numbers(points: &mut Numbered<'_>, (count, unit_columns): (usize, &[UnitColumn]), parts: usize) -> Numbers {
    let mut all = Numbers {
        columns: vec![Vec::with_capacity(points.len()); count],
        states: Vec::with_capacity(points.len()),
    };
    let value = |x: Option<f64>| x.unwrap_or(f64::NAN);
    for (_, point) in points.iter() {
        let solved = point.loss.is_some();
        let numbers_of_point = [
            point.torque,
            tidy(point.speed * RPM),
            value(point.oil),
            value(point.efficiency),
            value(point.loss),
            value(point.loss_torque),
            value(point.input),
            value(point.output),
        ];
        let watts = point.sums.iter().chain(&point.parts[..parts]);
        let watts = watts.map(|watts| if solved { *watts } else { f64::NAN });
        let unit = point.unit();
        let of_unit = unit_columns
            .iter()
            .map(|column| value(unit.as_ref().and_then(column.read)));
        let all_numbers = numbers_of_point.into_iter().chain(watts).chain(of_unit);
        for (column, x) in all.columns.iter_mut().zip(all_numbers) {
            column.push(x);
        }
        all.states.push((point.status, point.balance));
    }
    all
}

impl Numbers {
    /// Appends a piece in the order of the field.
    fn add(&mut self, piece: Piece<Self>) {
        let mut tasks = Vec::new();
        let order = piece.map(|task| tasks.push(task));
        for (task, cells) in order.runs() {
            for (column, cells_of_task) in self.columns.iter_mut().zip(&tasks[task].columns) {
                column.extend_from_slice(&cells_of_task[cells.clone()]);
            }
            self.states.extend_from_slice(&tasks[task].states[cells]);
        }
    }
}
