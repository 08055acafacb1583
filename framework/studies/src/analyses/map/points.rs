//! The points of a map: rows of the table, and records of the JSON.

use std::ops::Range;

use gearloss_framework::flow::Status;
use gearloss_framework::thermal;
use schemars::JsonSchema;
use serde::ser::SerializeSeq as _;
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::super::Built;
use super::super::numbers::{RPM, tidy, word};
use super::shown::{Picked, Selection};
use crate::analysis::{Field, Numbered, PointResult, SUMS};
use crate::table::{Column, Table, Texts, Values};

/// Columns of a point from its torque to the first sum.
const FIXED: usize = 11;

/// The columns of the table.
pub fn columns(bound: &[String], parts: &[String]) -> Vec<Column> {
    let mut columns = vec![Column::text("model_set", "Model set"), Column::text("gear", "Gear")];
    columns.extend(bound.iter().map(|path| Column::text(path, "Bound value")));
    columns.extend([
        Column::number("torque_nm", "Nm", "Torque"),
        Column::number("speed_rpm", "rpm", "Speed"),
        Column::number("oil_temperature_degc", "degC", "Oil temperature"),
        Column::number("surface_temperature_degc", "degC", "Surface temperature"),
        Column::text("balance", "Status of the heat balance"),
        Column::text("status", "State of the transmission"),
        Column::number("efficiency", "-", "Output power over input power"),
        Column::number("loss_w", "W", "Sum of all losses"),
        Column::number("loss_torque_nm", "Nm", "Loss over the speed of the reference port"),
        Column::number("input_w", "W", "Input power"),
        Column::number("output_w", "W", "Output power"),
    ]);
    columns.extend(
        SUMS.iter()
            .map(|(sum, meaning)| Column::number(format!("{sum}_w"), "W", *meaning)),
    );
    columns.extend(
        parts
            .iter()
            .map(|part| Column::number(format!("{part}_w"), "W", "Loss of the component")),
    );
    columns
}

/// Common data of all rows of one map.
pub struct RowsOf<'a> {
    constants: Vec<String>,
    /// For each column of components the index of the component in this map; absent if it has none.
    columns: Vec<Option<usize>>,
    built: &'a Built<'a>,
}

impl<'a> RowsOf<'a> {
    pub fn new(built: &'a Built<'_>, gear: &str, bound: &[(String, Value)], parts: &[String]) -> Self {
        let own = built.transmission.parts();
        let constants = [built.name.clone(), gear.to_owned()];
        Self {
            constants: constants
                .into_iter()
                .chain(bound.iter().map(|(_, value)| word(value)))
                .collect(),
            columns: parts.iter().map(|p| own.iter().position(|o| o.path == *p)).collect(),
            built,
        }
    }

    /// The values of all columns, from the points.
    pub fn with_constants(&self, values: Vec<Values>) -> Vec<Values> {
        let count = values.first().map_or(0, Values::len);
        let constant = |text: &String| Values::Texts(Texts::repeated(text, count).into());
        self.constants.iter().map(constant).chain(values).collect()
    }

    /// The values of some points.
    fn values(&self, points: &Numbered<'_>) -> Vec<Values> {
        let numbers = |f: &dyn Fn(&PointResult) -> Option<f64>| Values::from_numbers(points.iter().map(|(_, p)| f(p)));
        let texts = |f: fn(&PointResult) -> &'static str| Values::from_texts(points.iter().map(|(_, p)| f(p)));
        let mut all = vec![
            numbers(&|p| Some(p.torque)),
            numbers(&|p| Some(tidy(p.speed * RPM))),
            numbers(&|p| p.oil),
            numbers(&|p| p.surface),
            texts(|p| p.balance.map_or("", thermal::Outcome::name)),
            texts(|p| p.status.name()),
            numbers(&|p| p.efficiency),
            numbers(&|p| p.loss),
            numbers(&|p| p.loss_torque),
            numbers(&|p| p.input),
            numbers(&|p| p.output),
        ];
        all.extend((0..SUMS.len()).map(|sum| numbers(&|p| sums(p).map(|sums| sums[sum]))));
        let part = |part: &Option<usize>| match part {
            Some(part) => numbers(&|p| loss_of(p, *part)),
            None => numbers(&|_| None),
        };
        all.extend(self.columns.iter().map(part));
        all
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
    pub field: &'a Field,
    pub rows: RowsOf<'a>,
    pub selection: &'a Selection,
    /// Whether rows are requested.
    pub wanted: bool,
}

/// Data of the points of a task.
pub struct Taken {
    pub values: Vec<Values>,
    pub picked: Picked,
    pub passes: usize,
    pub undefined: Vec<UndefinedLoss>,
}

impl Taker<'_> {
    pub fn take(&self, points: &mut Numbered<'_>) -> Taken {
        let parts = self.rows.built.transmission.parts();
        let undefined = |(number, point): &(usize, &mut PointResult)| {
            let (part, reason) = point.undefined?;
            Some(UndefinedLoss {
                number: *number,
                part: parts[part].path.clone(),
                reason: reason.to_string(),
            })
        };
        Taken {
            values: if self.wanted {
                self.rows.values(points)
            } else {
                Vec::new()
            },
            picked: self.selection.pick(self.field, points),
            passes: points.iter().map(|(_, point)| point.passes).sum(),
            undefined: points.iter().filter_map(undefined).collect(),
        }
    }
}

/// A loss without a value.
#[derive(Debug, Clone)]
pub struct UndefinedLoss {
    /// Index of the point in its map.
    pub number: usize,
    part: String,
    reason: String,
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
}

/// A point.
#[derive(Debug, Serialize, JsonSchema)]
pub struct MapPoint<'a> {
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
    /// Why a loss has no value.
    undefined: Option<Missing<'a>>,
}

/// The usual sums of losses.
#[derive(Debug, Serialize, JsonSchema)]
struct Sums {
    /// Gears, load-dependent. [W]
    #[serde(rename = "P_VZP")]
    gears_loaded: f64,
    /// Gears, load-independent. [W]
    #[serde(rename = "P_VZ0")]
    gears_unloaded: f64,
    /// Bearings, load-dependent. [W]
    #[serde(rename = "P_VLP")]
    bearings_loaded: f64,
    /// Bearings, load-independent. [W]
    #[serde(rename = "P_VL0")]
    bearings_unloaded: f64,
    /// Seals. [W]
    #[serde(rename = "P_VD")]
    seals: f64,
    /// Others. [W]
    #[serde(rename = "P_VX")]
    others: f64,
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
    ) -> Self {
        Self {
            table: table.clone(),
            first,
            parts,
            rows,
            undefined,
        }
    }

    fn number(&self, column: usize, row: usize) -> Option<f64> {
        let numbers = self.table.columns[self.first + column].numbers()?;
        Some(numbers[row]).filter(|x| !x.is_nan())
    }

    fn text(&self, column: usize, row: usize) -> Option<&str> {
        match &self.table.columns[self.first + column].values {
            Values::Texts(texts) => texts.get(row),
            Values::Numbers(_) => None,
        }
    }

    fn sums(&self, row: usize) -> Option<Sums> {
        let sum = |i: usize| self.number(FIXED + i, row);
        Some(Sums {
            gears_loaded: sum(0)?,
            gears_unloaded: sum(1)?,
            bearings_loaded: sum(2)?,
            bearings_unloaded: sum(3)?,
            seals: sum(4)?,
            others: sum(5)?,
        })
    }

    /// A point by its row of the table; its index in the map is used for undefined losses.
    fn point(&self, row: usize) -> MapPoint<'_> {
        let number = |column: usize| self.number(column, row);
        let own = row - self.rows.start;
        let undefined = self.undefined.binary_search_by_key(&own, |loss| loss.number).ok();
        MapPoint {
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
