//! Losses of a list of operating points, written in the study or read from a file and compared with measured values.

use std::sync::Arc;

use gearloss_framework::description::Ordered;
use gearloss_framework::flow::Status;
use gearloss_framework::thermal;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::rows::{RowsPlan, Solved};
use super::common::shares::{Shares, together};
use super::{Analysis, Built, Chosen, Engine, Head, Outcome, Planner, Stopped};
use crate::limits::at_points::LimitColumn;
use crate::measured::{ListedPoint, Measured, Row};
use crate::numbers::{RPM, tidy};
use crate::points::{Note, PointResult, UnitPoint};
use crate::register_analysis;
use crate::study::{By, Data, Uses, Write};
use crate::table::Table;

/// Losses of a list of operating points, written here or in a file, as stacked bars with measured values.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OperatingPointsEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// The points, instead of `data`.
    #[serde(default)]
    pub points: Vec<ListedPoint>,
    /// File of the points, one row each: torque, speed and a name, the columns of `bind`, and measured loss, oil and surface temperature, each with
    /// its accuracy. With `faulty_rows: keep` cells of measured columns may be empty.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Option<Data>,
    /// Columns of `data` that change a value of the gearbox: column to resolved path, such as `volume: housing.oil.volume`. The unit is in the
    /// header: `volume [ml]`.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
}

register_analysis!(OperatingPointsEntry);

/// Losses of a list of operating points with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OperatingPointsOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub operating_points: Vec<PointsOfSet>,
    /// How the file of the points was read, and which rows were omitted.
    #[serde(skip)]
    pub file_notes: Vec<String>,
    /// Limits of the study at points.
    #[serde(skip)]
    pub limits: Vec<LimitColumn>,
    /// Columns that change a value of the gearbox.
    #[serde(skip)]
    pub bound: Vec<String>,
}

/// The points under one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointsOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Names of the shares of the loss.
    pub shares: Vec<String>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// The points, in the order of the file.
    pub points: Vec<OperatingPoint>,
}

/// One operating point with its measured values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OperatingPoint {
    /// Name, or its number in the file.
    pub name: String,
    /// Gear state.
    pub gear: String,
    /// Values that change the gearbox, by column.
    pub bound: Ordered<String>,
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature; absent if no balance was found. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Surface temperature if found by heat balance. [degC]
    pub surface_temperature_degc: Option<f64>,
    /// Status of the heat balance if the temperature is not given.
    pub balance: Option<thermal::Outcome>,
    /// State of the transmission.
    pub status: Status,
    /// Output power over input power. [-]
    pub efficiency: Option<f64>,
    /// Sum of all losses. [W]
    pub loss_w: Option<f64>,
    /// The loss by share, in the order of `shares`. [W]
    pub losses_w: Option<Vec<f64>>,
    /// The drive unit; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitPoint>,
    /// Limited quantities, by the names of the limits; absent if the study has none at points.
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    pub limit_values: Ordered<Option<f64>>,
    /// True if one of them is beyond its limit.
    #[serde(skip)]
    pub beyond: bool,
    /// Measured values.
    pub measured: MeasuredAtPoint,
    /// Speed as it was solved. [rad/s]
    #[serde(skip)]
    pub speed: f64,
}

/// Measured values at a point with stated accuracies.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, JsonSchema)]
pub struct MeasuredAtPoint {
    /// Loss. [W]
    pub loss_w: Option<f64>,
    /// Accuracy of the loss. [W]
    pub loss_accuracy_w: Option<f64>,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Accuracy of the oil temperature. [K]
    pub oil_temperature_accuracy_k: Option<f64>,
    /// Surface temperature. [degC]
    pub surface_temperature_degc: Option<f64>,
    /// Accuracy of the surface temperature. [K]
    pub surface_temperature_accuracy_k: Option<f64>,
}

impl MeasuredAtPoint {
    fn new(listed: &Measured, row: &Row, point: &PointResult) -> Self {
        let value = |quantity: &str| listed.value(row, quantity);
        let accuracy = |quantity: &str, calculated: Option<f64>| {
            let reading = value(quantity);
            listed.stated_accuracy(row, quantity, reading.and(calculated.or(reading)))
        };
        Self {
            loss_w: value("loss"),
            loss_accuracy_w: accuracy("loss", point.loss),
            oil_temperature_degc: value("oil_temperature"),
            oil_temperature_accuracy_k: accuracy("oil_temperature", None),
            surface_temperature_degc: value("surface_temperature"),
            surface_temperature_accuracy_k: accuracy("surface_temperature", None),
        }
    }

    /// True without measured values.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Analysis for OperatingPointsEntry {
    const TYPE: &'static str = "operating_points";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = RowsPlan<'a>;
    type Outcome = OperatingPointsOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses().bind(&self.bind).with("data", self.data.as_ref())
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<RowsPlan<'a>, Stopped> {
        let gearbox = cx.gearbox(self.chosen.gearbox.as_ref())?;
        let listed = self.listed(cx)?;
        let (gear, terms) = (self.chosen.gear.as_deref(), self.by == By::Term);
        RowsPlan::new(cx, gearbox, &self.chosen.model_sets, (listed, &self.bind), gear, terms)
    }

    fn reduce<'a>(&'a self, plan: RowsPlan<'a>, engine: &Engine<'a>) -> Result<OperatingPointsOutcome, Stopped> {
        let all = plan.solve(engine)?;
        let built: Vec<Arc<Built<'_>>> = all.iter().flat_map(|s| &s.built).cloned().collect();
        let shares = together(built.iter().map(|b| &b.transmission), self.by);
        let limits = LimitColumn::all(engine.language, engine.study);
        let listed = plan.measured;
        Ok(OperatingPointsOutcome {
            head: engine.head(&built),
            operating_points: all.iter().map(|s| self.of_set(&listed, s, &shares, &limits)).collect(),
            limits,
            file_notes: listed.notes,
            bound: self.bind.ids().map(str::to_owned).collect(),
        })
    }
}

impl OperatingPointsEntry {
    fn listed(&self, cx: &Planner<'_>) -> Result<Measured, Stopped> {
        let path = cx.path();
        match &self.data {
            Some(data) if self.points.is_empty() => {
                let bind: Vec<&str> = self.bind.ids().collect();
                let data_path = format!("{path}.data");
                let mut listed = cx.read(&data_path, data, &bind)?;
                let file = &cx.data(&data_path, data)?.file;
                for note in &mut listed.notes {
                    *note = format!("{file}: {note}");
                }
                Ok(listed)
            }
            Some(_) => Err(cx.wrong(
                &format!("{path}.points"),
                "the points are stated twice, by `points` and by `data`",
                "delete one of them",
            )),
            None if self.points.is_empty() => Err(cx.wrong(
                &path,
                "no operating point is stated",
                "add `points: [{ torque: 10 Nm, speed: 3000 rpm }]`, or `data: { file: points.csv }`",
            )),
            None if self.bind.iter().next().is_some() => Err(cx.wrong(
                &format!("{path}.bind"),
                "`bind` names columns, and `points` has none",
                "write the points into a file and name it in `data`",
            )),
            None => Ok(Measured::listed(&self.points)),
        }
    }

    /// The points of a file solved with one set.
    fn of_set(&self, listed: &Measured, solved: &Solved<'_>, names: &[String], limits: &[LimitColumn]) -> PointsOfSet {
        let built = solved.built.iter();
        let shares: Vec<Shares> = built
            .map(|b| Shares::new(&b.transmission, self.by).under(names))
            .collect();
        let rows = listed.rows.iter().zip(&solved.rows).enumerate();
        let points = rows.map(|(i, (row, (place, gear, point)))| OperatingPoint {
            name: row.name.clone().unwrap_or_else(|| format!("{}", i + 1)),
            gear: gear.clone(),
            bound: Ordered(self.bind.ids().map(str::to_owned).zip(row.bound.clone()).collect()),
            torque_nm: point.torque,
            speed_rpm: tidy(point.speed * RPM),
            oil_temperature_degc: point.oil,
            surface_temperature_degc: point.surface,
            balance: point.balance,
            status: point.status,
            efficiency: point.efficiency,
            loss_w: point.loss,
            losses_w: shares[*place].stack(point),
            unit: point.unit(),
            limit_values: LimitColumn::by_name(limits, &point.limits),
            beyond: point.beyond,
            measured: match self.data {
                Some(_) => MeasuredAtPoint::new(listed, row, point),
                None => MeasuredAtPoint::default(),
            },
            speed: point.speed,
        });
        PointsOfSet {
            model_set: solved.name.clone(),
            shares: names.to_vec(),
            notes: solved.notes.clone(),
            points: points.collect(),
        }
    }
}

impl Outcome for OperatingPointsOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let shares = self.operating_points.first().map_or(&[][..], |of_set| &of_set.shares);
        let table = Table::of_each(&self.head.analysis, &self.operating_points, |of_set| &of_set.points)
            .text("model_set", "Model set", |(of_set, _)| &of_set.model_set)
            .fields("gear name", |(_, point)| point)
            .each(self.bound.iter().enumerate(), |table, (i, column)| {
                table.text(column, "Value that changes the gearbox", |(_, point)| {
                    point.bound.iter().nth(i).map_or("", |(_, value)| value.as_str())
                })
            })
            .fields(
                "torque_nm speed_rpm oil_temperature_degc surface_temperature_degc balance status efficiency loss_w",
                |(_, point)| point,
            )
            .number("measured_loss_w", "W", "Measured loss", |(_, point)| {
                point.measured.loss_w
            })
            .number(
                "measured_loss_accuracy_w",
                "W",
                "Accuracy of the measured loss",
                |(_, point)| point.measured.loss_accuracy_w,
            )
            .number(
                "measured_oil_temperature_degc",
                "degC",
                "Measured oil temperature",
                |(_, point)| point.measured.oil_temperature_degc,
            )
            .number(
                "measured_oil_temperature_accuracy_k",
                "K",
                "Accuracy of that temperature",
                |(_, point)| point.measured.oil_temperature_accuracy_k,
            )
            .number(
                "measured_surface_temperature_degc",
                "degC",
                "Measured surface temperature",
                |(_, point)| point.measured.surface_temperature_degc,
            )
            .number(
                "measured_surface_temperature_accuracy_k",
                "K",
                "Accuracy of that temperature",
                |(_, point)| point.measured.surface_temperature_accuracy_k,
            )
            // The shares are the same for every set.
            .each(shares.iter().enumerate(), |table, (i, share)| {
                table.number(format!("{share}_w"), "W", format!("Loss: {share}"), |(_, point)| {
                    point.losses_w.as_ref().map(|watts| watts[i])
                })
            });
        let table = UnitPoint::add_to(table, |(_, point)| point.unit.as_ref()).each(&self.limits, |table, limit| {
            table.number(limit.key(), limit.unit, limit.words.clone(), |(_, point)| {
                point.limit_values.get(&limit.name).copied().flatten()
            })
        });
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.operating_points.iter().flat_map(|of_set| &of_set.notes).collect()
    }
}
