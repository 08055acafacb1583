//! The points of a map: rows of the table, and records of the JSON.

use std::ops::Range;
use std::sync::Arc;

use gearloss_framework::description::Ordered;
use gearloss_framework::flow::Status;
use gearloss_framework::thermal;
use schemars::JsonSchema;
use serde::ser::SerializeSeq as _;
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::super::Run;
use super::shown::{Picked, Selection};
use crate::analyses::common::outside_maps::MachineOutside;
use crate::correction::{Corrected, ReadyCorrection};
use crate::limits::at_points::LimitColumn;
use crate::numbers::{RPM, tidy, word};
use crate::points::{Numbered, PointResult, SUMS, Sums, TotalLoss, UnitPoint};
use crate::table::{Column, Table, Values};

/// Column of the gear.
const GEAR: usize = 1;

/// Columns of a point from its torque to the first sum.
const FIXED: usize = 11;

/// Common data of all rows of one map.
pub struct RowsOf {
    model_set: String,
    gear: String,
    /// Bound paths and their values.
    bound: Vec<(String, String)>,
    /// The components with a column, and the index of each in this map; absent if it has none.
    parts: Vec<(String, Option<usize>)>,
    /// Limits of the study at points.
    limits: Vec<LimitColumn>,
    /// Whether points have columns of a correction.
    pub corrected: bool,
    /// The correction of this gear.
    pub correction: Option<Arc<ReadyCorrection>>,
    /// Whether there are columns of the drive unit.
    has_unit: bool,
}

/// A point with its correction, if it has one.
type PointWith<'p> = (&'p PointResult, Option<Corrected>);

/// Columns of a correction.
pub const CORRECTED: [(&str, &str, &str); 6] = [
    (
        "correction_nm",
        "Nm",
        "Smooth correction of the loss torque; empty outside of the measured region",
    ),
    ("correction_low_nm", "Nm", "Lower end of its 95 % band"),
    ("correction_high_nm", "Nm", "Upper end of its 95 % band"),
    ("corrected_loss_torque_nm", "Nm", "Loss torque with the correction"),
    ("corrected_loss_w", "W", "Loss with the correction"),
    (
        "corrected_loss_half_band_w",
        "W",
        "Half-width of its 95 % band, of the correction alone",
    ),
];

/// Values of the columns of a correction.
fn corrected((point, correction): &PointWith<'_>) -> Option<[f64; 6]> {
    let (correction, torque) = ((*correction)?, point.loss_torque?);
    let [low, high] = correction.band;
    let speed = point.reference_speed.abs();
    let whole = torque + correction.torque;
    Some([
        correction.torque,
        low,
        high,
        whole,
        whole * speed,
        0.5 * (high - low) * speed,
    ])
}

impl RowsOf {
    /// Of no map: for the columns of a table without rows.
    pub fn none(bound: &[String], parts: &[String], limits: &[LimitColumn], has_unit: bool) -> Self {
        Self {
            model_set: String::new(),
            gear: String::new(),
            bound: bound.iter().map(|path| (path.clone(), String::new())).collect(),
            parts: parts.iter().map(|part| (part.clone(), None)).collect(),
            limits: limits.to_vec(),
            corrected: false,
            correction: None,
            has_unit,
        }
    }

    pub fn new(
        run: &Run<'_>,
        bound: &[(String, Value)],
        parts: &[String],
        limits: &[LimitColumn],
        has_unit: bool,
    ) -> Self {
        let all = run.built.transmission.parts();
        let place = |part: &String| all.iter().position(|o| o.path == *part);
        Self {
            model_set: run.built.name.clone(),
            gear: run.points.gear.clone(),
            bound: bound.iter().map(|(path, value)| (path.clone(), word(value))).collect(),
            parts: parts.iter().map(|part| (part.clone(), place(part))).collect(),
            limits: limits.to_vec(),
            corrected: false,
            correction: None,
            has_unit,
        }
    }

    /// The correction of a point.
    pub fn correction_of(&self, point: &PointResult) -> Option<Corrected> {
        self.correction.as_ref()?.of(point)
    }

    /// The rows of some points.
    pub fn table<'p>(&self, name: &str, points: impl IntoIterator<Item = &'p PointResult>) -> Table {
        let columns: &[_] = if self.corrected { &CORRECTED } else { &[] };
        Table::of(name, points.into_iter().map(|point| (point, self.correction_of(point))))
            .text("model_set", "Model set", |_| &self.model_set)
            .text("gear", "Gear", |_| &self.gear)
            .each(&self.bound, |table, (path, value)| {
                table.text(path, "Bound value", |_| value)
            })
            .number("torque_nm", "Nm", "Torque", |(p, _)| p.torque)
            .number("speed_rpm", "rpm", "Speed", |(p, _)| tidy(p.speed * RPM))
            .number("oil_temperature_degc", "degC", "Oil temperature", |(p, _)| p.oil)
            .number("surface_temperature_degc", "degC", "Surface temperature", |(p, _)| {
                p.surface
            })
            .text("balance", "Status of the heat balance", |(p, _)| {
                p.balance.map_or("", thermal::Outcome::name)
            })
            .text("status", "State of the transmission", |(p, _)| p.status.name())
            .number("efficiency", "-", "Output power over input power", |(p, _)| {
                p.efficiency
            })
            .number("loss_w", "W", "Sum of all losses", |(p, _)| p.loss)
            .number(
                "loss_torque_nm",
                "Nm",
                "Loss over the speed of the reference port",
                |(p, _)| p.loss_torque,
            )
            .number("input_w", "W", "Input power", |(p, _)| p.input)
            .number("output_w", "W", "Output power", |(p, _)| p.output)
            .each(SUMS.iter().enumerate(), |table, (i, (sum, meaning))| {
                table.number(format!("{sum}_w"), "W", *meaning, |(p, _)| sums(p).map(|sums| sums[i]))
            })
            .each(&self.parts, |table, (part, place)| {
                table.number(format!("{part}_w"), "W", "Loss of the component", |(p, _)| {
                    place.and_then(|place| loss_of(p, place))
                })
            })
            .each(columns.iter().enumerate(), |table, (i, (name, unit, meaning))| {
                table.number(*name, *unit, *meaning, |row: &PointWith<'_>| {
                    corrected(row).map(|values| values[i])
                })
            })
            .each(UnitPoint::columns(self.has_unit), |table, column| {
                table.number(column.name, column.unit, column.meaning, |(p, _)| {
                    p.unit().as_ref().and_then(column.read)
                })
            })
            .each(self.limits.iter().enumerate(), |table, (i, limit)| {
                table.number(limit.key(), limit.unit, limit.words.clone(), |(p, _)| {
                    p.limits.get(i).copied()
                })
            })
            .finish()
    }
}

/// The usual sums of a point; absent without a temperature or a power flow. \[W\]
fn sums(point: &PointResult) -> Option<[f64; 6]> {
    point.oil.filter(|_| point.status.has_flow()).map(|_| point.sums)
}

/// Loss of a component at a point; absent without a temperature or a power flow, or if its model has no value. \[W\]
fn loss_of(point: &PointResult, part: usize) -> Option<f64> {
    let known = point.oil.is_some()
        && point.status.has_flow()
        && point.undefined.is_none_or(|(undefined, _)| undefined != part);
    known.then(|| point.parts[part])
}

/// Extraction of data from solved points, on all threads.
pub struct Taker<'a> {
    pub run: &'a Run<'a>,
    pub rows: RowsOf,
    pub selection: &'a Selection,
    /// Whether rows are requested.
    pub wanted: bool,
}

/// Data of the points of a task.
pub struct Taken {
    /// Rows; none unless they are requested.
    pub rows: Table,
    pub picked: Picked,
    pub passes: usize,
    pub lost: TotalLoss,
    pub undefined: Vec<UndefinedLoss>,
    /// Numbers of points with a loss inside and outside of the region of a correction.
    pub inside: [usize; 2],
    /// Machines outside their maps.
    pub outside_maps: Vec<MachineOutside>,
}

impl Taker<'_> {
    pub fn take(&self, points: &mut Numbered<'_>) -> Taken {
        let parts = self.run.built.transmission.parts();
        let rows = points.iter().filter(|_| self.wanted).map(|(_, point)| &**point);
        let undefined = |(number, point): &(usize, &mut PointResult)| {
            let (part, reason) = point.undefined?;
            Some(UndefinedLoss {
                number: *number,
                part: parts[part].path.clone(),
                reason: reason.to_string(),
            })
        };
        Taken {
            rows: self.rows.table("", rows),
            picked: self.selection.pick(&self.run.points.field, points),
            passes: points.iter().map(|(_, point)| point.passes).sum(),
            lost: TotalLoss::of(points.iter().map(|(_, point)| &**point)),
            undefined: points.iter().filter_map(undefined).collect(),
            inside: self.inside(points),
            outside_maps: MachineOutside::of(&self.run.built.transmission, points.iter().map(|(_, point)| &**point)),
        }
    }

    /// Numbers of points with a loss inside and outside of the region of a correction.
    fn inside(&self, points: &Numbered<'_>) -> [usize; 2] {
        if !self.rows.corrected {
            return [0; 2];
        }
        let with_loss = points.iter().filter(|(_, point)| point.loss_torque.is_some());
        let has = with_loss.map(|(_, point)| self.rows.correction_of(point).is_some());
        let has: Vec<bool> = has.collect();
        let inside = has.iter().filter(|inside| **inside).count();
        [inside, has.len() - inside]
    }
}

/// A loss without a value.
#[derive(Debug, Clone)]
pub struct UndefinedLoss {
    /// Index of the point in its map.
    pub number: usize,
    pub(super) part: String,
    pub(super) reason: String,
}

/// The points of one map: rows of the table of all maps.
#[derive(Debug, Clone)]
pub struct MapPoints {
    table: Table,
    /// Index of the column of the torque.
    first: usize,
    /// For each component of the map the index of its column.
    parts: Vec<usize>,
    rows: Range<usize>,
    undefined: Vec<UndefinedLoss>,
    limits: Vec<LimitColumn>,
    /// Whether the gears of the points differ.
    names_gears: bool,
    has_unit: bool,
}

/// A point.
#[derive(Debug, Serialize, JsonSchema)]
pub struct MapPoint<'a> {
    /// Gear of the point; absent if all points of the map have the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    best_gear: Option<&'a str>,
    /// Torque. [Nm]
    torque_nm: Option<f64>,
    /// Speed. [rpm]
    speed_rpm: Option<f64>,
    /// Oil temperature; absent if no balance was found, like everything that depends on it. [degC]
    oil_temperature_degc: Option<f64>,
    /// Surface temperature if found by heat balance. [degC]
    surface_temperature_degc: Option<f64>,
    /// Status of the heat balance if the temperature is not given.
    #[schemars(with = "Option<thermal::Outcome>")]
    balance: Option<&'a str>,
    /// State of the transmission.
    #[schemars(with = "Status")]
    status: Option<&'a str>,
    /// Output power over input power. [-]
    efficiency: Option<f64>,
    /// Sum of all losses. [W]
    loss_w: Option<f64>,
    /// Loss over the speed of the reference port. [Nm]
    loss_torque_nm: Option<f64>,
    /// Input power. [W]
    input_w: Option<f64>,
    /// Output power. [W]
    output_w: Option<f64>,
    /// The usual sums. [W]
    sums_w: Option<Sums>,
    /// Losses of the components, in order. [W]
    parts_w: Vec<Option<f64>>,
    /// Correction of the loss torque and the corrected loss; absent without a correction, and outside of the measured region.
    #[serde(skip_serializing_if = "Option::is_none")]
    correction: Option<CorrectionOfPoint>,
    /// The drive unit; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<UnitPoint>,
    /// Limited quantities, by the names of the limits; absent if the study has none at points.
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    limit_values: Ordered<Option<f64>>,
    /// Why a loss has no value.
    undefined: Option<Missing<'a>>,
}

/// The correction at a point.
#[derive(Debug, Serialize, JsonSchema)]
struct CorrectionOfPoint {
    /// Smooth correction of the loss torque. [Nm]
    torque_nm: f64,
    /// Its 95 % band. [Nm]
    band_nm: [f64; 2],
    /// Loss torque with the correction. [Nm]
    corrected_loss_torque_nm: f64,
    /// Loss with the correction. [W]
    corrected_loss_w: f64,
}

/// A loss without a value.
#[derive(Debug, Serialize, JsonSchema)]
struct Missing<'a> {
    /// Path of the component.
    part: &'a str,
    /// Why.
    reason: &'a str,
}

impl MapPoints {
    pub(super) fn new(
        table: &Table,
        first: usize,
        parts: Vec<usize>,
        rows: Range<usize>,
        undefined: Vec<UndefinedLoss>,
        (limits, has_unit): (&[LimitColumn], bool),
    ) -> Self {
        Self {
            limits: limits.to_vec(),
            has_unit,
            table: table.clone(),
            first,
            parts,
            rows,
            undefined,
            names_gears: false,
        }
    }

    /// The same, with the gear of each point if they differ.
    pub(super) fn naming_gears(self, names_gears: bool) -> Self {
        Self { names_gears, ..self }
    }

    fn number(&self, column: usize, row: usize) -> Option<f64> {
        let numbers = self.table.columns[self.first + column].numbers()?;
        Some(numbers[row]).filter(|x| !x.is_nan())
    }

    fn text(&self, column: usize, row: usize) -> Option<&str> {
        self.text_of_column(self.first + column, row)
    }

    fn text_of_column(&self, column: usize, row: usize) -> Option<&str> {
        match &self.table.columns[column].values {
            Values::Texts(texts) => texts.get(row),
            Values::Numbers(_) => None,
        }
    }

    /// The columns of a correction, which are before those of limits.
    fn correction(&self, row: usize) -> Option<CorrectionOfPoint> {
        let end = self.table.columns.len() - self.limits.len();
        let columns = &self.table.columns[end.checked_sub(CORRECTED.len())?..end];
        if columns[0].name != CORRECTED[0].0 {
            return None;
        }
        let value = |i: usize| {
            let numbers = columns[i].numbers()?;
            Some(numbers[row]).filter(|x| !x.is_nan())
        };
        Some(CorrectionOfPoint {
            torque_nm: value(0)?,
            band_nm: [value(1)?, value(2)?],
            corrected_loss_torque_nm: value(3)?,
            corrected_loss_w: value(4)?,
        })
    }

    /// The limited quantities, which have the last columns.
    fn limits_at(&self, row: usize) -> Vec<f64> {
        let limited = &self.table.columns[self.table.columns.len() - self.limits.len()..];
        let value = |column: &Column| column.numbers().map_or(f64::NAN, |numbers| numbers[row]);
        limited.iter().map(value).collect()
    }

    /// The quantities of the drive unit, whose columns precede those of the limits.
    fn unit(&self, row: usize) -> Option<UnitPoint> {
        if !self.has_unit {
            return None;
        }
        let first = self.table.columns.len() - self.limits.len() - UnitPoint::COLUMNS.len();
        let value = |i: usize| {
            let numbers = self.table.columns[first + i].numbers()?;
            Some(numbers[row]).filter(|x| !x.is_nan())
        };
        UnitPoint::of_columns([value(0), value(1), value(2), value(3), value(4)])
    }

    fn sums(&self, row: usize) -> Option<Sums> {
        let sum = |i: usize| self.number(FIXED + i, row);
        Some([sum(0)?, sum(1)?, sum(2)?, sum(3)?, sum(4)?, sum(5)?].into())
    }

    /// A point by its row of the table; its index in the map is used for undefined losses.
    fn point(&self, row: usize) -> MapPoint<'_> {
        let number = |column: usize| self.number(column, row);
        let row_of_chunk = row - self.rows.start;
        let undefined = self
            .undefined
            .binary_search_by_key(&row_of_chunk, |loss| loss.number)
            .ok();
        MapPoint {
            best_gear: self.text_of_column(GEAR, row).filter(|_| self.names_gears),
            torque_nm: number(0),
            speed_rpm: number(1),
            oil_temperature_degc: number(2),
            surface_temperature_degc: number(3),
            balance: self.text(4, row),
            status: self.text(5, row),
            efficiency: number(6),
            loss_w: number(7),
            loss_torque_nm: number(8),
            input_w: number(9),
            output_w: number(10),
            sums_w: self.sums(row),
            parts_w: self
                .parts
                .iter()
                .map(|part| number(FIXED + SUMS.len() + part))
                .collect(),
            correction: self.correction(row),
            unit: self.unit(row),
            limit_values: LimitColumn::by_name(&self.limits, &self.limits_at(row)),
            undefined: undefined.map(|i| Missing {
                part: &self.undefined[i].part,
                reason: &self.undefined[i].reason,
            }),
        }
    }
}

impl Serialize for MapPoints {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut list = to.serialize_seq(Some(self.rows.len()))?;
        for row in self.rows.clone() {
            list.serialize_element(&self.point(row))?;
        }
        list.end()
    }
}
