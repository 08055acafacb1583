//! Rows of stacked bars: the common outcome of breakdowns, spin losses and temperature sweeps.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analyses::common::shares::{Shares, together};
use crate::analyses::{Built, Engine, Head, Outcome, Plan, Planner, Run, Runs, Stopped, Work};
use crate::codes;
use crate::numbers::{RPM, tidy};
use crate::points::{Given, GridResult, Note, PointResult, Points, TotalLoss, UnitPoint, notes_with_shares};
use crate::study::By;
use crate::table::Table;

/// Unit of a breakdown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum As {
    /// Watts.
    #[default]
    Watts,
    /// Percent of the total loss.
    Percent,
}

impl As {
    /// Name in keys and columns.
    pub fn name(self) -> &'static str {
        match self {
            Self::Watts => "w",
            Self::Percent => "percent",
        }
    }

    /// Symbol of the unit.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Watts => "W",
            Self::Percent => "%",
        }
    }

    /// Factor from watts to the unit at a point; absent for a share of zero loss.
    fn scale(self, by: By, point: &PointResult) -> Option<f64> {
        let loss = match by {
            By::Unit => point.unit().map(|unit| unit.unit_loss_w),
            _ => point.loss,
        };
        match self {
            Self::Watts => Some(1.0),
            Self::Percent => loss.filter(|loss| *loss != 0.0).map(|loss| 100.0 / loss),
        }
    }
}

/// Loss breakdown with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BreakdownOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set and gear state.
    pub breakdowns: Vec<BreakdownOfSet>,
    /// Unit of all losses.
    #[serde(skip)]
    pub unit: As,
    /// Notes on the file of measured points.
    #[serde(skip)]
    pub measured_notes: Vec<String>,
}

/// Loss breakdown with one model set in one gear.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BreakdownOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Unit of the losses: `w`, or `percent` of the total loss.
    pub unit: &'static str,
    /// Names of the shares.
    pub shares: Vec<String>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// One for each bar.
    pub points: Vec<PointOfBreakdown>,
    /// Driven port, which may differ from that of the conditions; absent for losses under load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turned_at: Option<String>,
    /// The rows of bars in order.
    #[serde(skip)]
    pub rows: Vec<RowOfBars>,
}

/// One bar: the losses of a point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointOfBreakdown {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature; absent if no balance was found. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Losses in the unit of the breakdown.
    #[serde(flatten)]
    pub losses: Losses,
    /// The drive unit; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitPoint>,
    /// Accuracy of the measured loss, in its unit. [W or %]
    #[serde(skip)]
    pub accuracy: Option<f64>,
}

/// Losses of a point, computed and measured.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Losses {
    /// In watts.
    Watts {
        /// Losses in the order of the shares; absent if there is no loss. [W]
        losses_w: Option<Vec<f64>>,
        /// Measured loss. [W]
        measured_loss_w: Option<f64>,
    },
    /// In percent of the total loss.
    Percent {
        /// Losses in the order of the shares, in percent of the total loss; absent if there is none. [%]
        losses_percent: Option<Vec<f64>>,
        /// Measured loss, in percent of the computed one. [%]
        measured_loss_percent: Option<f64>,
    },
}

impl Losses {
    fn new(unit: As, losses: Option<Vec<f64>>, measured: Option<f64>) -> Self {
        match unit {
            As::Watts => Self::Watts {
                losses_w: losses,
                measured_loss_w: measured,
            },
            As::Percent => Self::Percent {
                losses_percent: losses,
                measured_loss_percent: measured,
            },
        }
    }

    /// The losses in the order of the shares.
    pub fn shares(&self) -> Option<&[f64]> {
        match self {
            Self::Watts { losses_w: losses, .. }
            | Self::Percent {
                losses_percent: losses, ..
            } => losses.as_deref(),
        }
    }

    /// The measured loss.
    pub fn measured(&self) -> Option<f64> {
        match self {
            Self::Watts {
                measured_loss_w: loss, ..
            }
            | Self::Percent {
                measured_loss_percent: loss,
                ..
            } => *loss,
        }
    }
}

/// Bars side by side.
#[derive(Debug, Clone)]
pub struct RowOfBars {
    /// Common conditions.
    pub common: Common,
    /// Quantity along the bars.
    pub along: Along,
    /// Its value at each bar, in its unit.
    pub values: Vec<f64>,
}

/// Common conditions of all bars of a row.
#[derive(Debug, Clone)]
pub enum Common {
    /// A torque. [Nm]
    Torque(f64),
    /// A power. [W]
    Power(f64),
    /// A speed. [rpm]
    Speed(f64),
    /// A point: torque in Nm and speed in rpm.
    Point(f64, f64),
    /// No torque.
    NoLoad {
        /// Driven port.
        turned: String,
        /// Free ports that are stationary.
        stationary: Vec<String>,
    },
}

/// Quantity along a row of bars.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// The speed, in rpm.
    Speed,
    /// The torque, in Nm.
    Torque,
    /// The power, in W.
    Power,
    /// The oil temperature, in degC.
    OilTemperature,
}

/// Measured loss at a point in a gear, and its accuracy. \[W\]
pub type MeasuredAt<'m> = &'m dyn Fn(&PointResult, &str) -> Option<(f64, f64)>;

/// The plan of breakdowns: runs, each with its rows of bars.
pub struct BarsPlan<'a> {
    by: By,
    unit: As,
    /// The sets.
    pub built: Vec<Arc<Built<'a>>>,
    runs: Runs<'a>,
    rows: Vec<Vec<RowOfBars>>,
    /// Driven port of free ones.
    turned_at: Option<String>,
}

impl Plan for BarsPlan<'_> {
    fn work(&self) -> Vec<Work> {
        self.runs.work()
    }
}

impl<'a> BarsPlan<'a> {
    /// Without runs.
    pub fn new(by: By, unit: As, built: Vec<Arc<Built<'a>>>) -> Self {
        Self {
            by,
            unit,
            built,
            runs: Runs(Vec::new()),
            rows: Vec::new(),
            turned_at: None,
        }
    }

    /// With a driven port.
    pub fn turned_at(self, port: String) -> Self {
        Self {
            turned_at: Some(port),
            ..self
        }
    }

    /// Adds rows of bars with their points.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn add(
        &mut self,
        cx: &Planner<'a>,
        b: &Arc<Built<'a>>,
        gear: &str,
        rows: Vec<(RowOfBars, Vec<Given>)>,
    ) -> Result<(), Stopped> {
        let (rows, given): (Vec<RowOfBars>, Vec<Vec<Given>>) = rows.into_iter().unzip();
        self.add_points(cx, b, cx.listed(&b.transmission, gear, given.concat()), rows)
    }

    /// Adds rows of bars of points.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn add_points(
        &mut self,
        cx: &Planner<'a>,
        b: &Arc<Built<'a>>,
        points: Points,
        rows: Vec<RowOfBars>,
    ) -> Result<(), Stopped> {
        let terms = self.by == By::Term;
        has_unit(cx, self.by, b)?;
        self.runs.0.push(Run::new(cx, b, Points { terms, ..points })?);
        self.rows.push(rows);
        Ok(())
    }

    /// The outcome, with measured losses beside the bars.
    ///
    /// # Errors
    /// As [`Engine::solve`].
    pub fn outcome(self, engine: &Engine<'_>, measured: MeasuredAt<'_>) -> Result<BreakdownOutcome, Stopped> {
        let solved = engine.solve_all(&self.runs)?;
        let names = together(self.built.iter().map(|b| &b.transmission), self.by);
        let runs = self.runs.0.iter().zip(self.rows).zip(&solved);
        let breakdowns = runs.map(|((run, rows), solved)| BreakdownOfSet {
            turned_at: self.turned_at.clone(),
            ..of_run(self.by, self.unit, &names, run, rows, solved, measured)
        });
        Ok(BreakdownOutcome {
            breakdowns: breakdowns.collect(),
            head: engine.head(&self.built),
            unit: self.unit,
            measured_notes: Vec::new(),
        })
    }
}

/// Rejects the shares of a drive unit that a gearbox does not have.
///
/// # Errors
/// There.
pub fn has_unit(cx: &Planner<'_>, by: By, b: &Built<'_>) -> Result<(), Stopped> {
    if by != By::Unit || cx.has_machines(&b.transmission) {
        return Ok(());
    }
    let message = format!("`{}` has no machine", b.name);
    let help = "describe it under `machines` of the gearbox, or choose other shares";
    Err(cx.wrong_as(codes::NO_MACHINE, &format!("{}.by", cx.path()), message, help))
}

/// The breakdown of a solved run.
fn of_run(
    by: By,
    unit: As,
    names: &[String],
    run: &Run<'_>,
    rows: Vec<RowOfBars>,
    solved: &GridResult,
    measured: MeasuredAt<'_>,
) -> BreakdownOfSet {
    let (t, gear) = (&run.built.transmission, &run.points.gear);
    let shares = Shares::new(t, by).under(names);
    let point = |p: &PointResult| {
        let scale = unit.scale(by, p);
        let scaled = |stack: Vec<f64>, scale: f64| stack.into_iter().map(|w| w * scale).collect();
        let losses = scale.and_then(|scale| Some(scaled(shares.stack(p)?, scale)));
        let seen = scale.and_then(|scale| measured(p, gear).map(|(loss, accuracy)| (loss * scale, accuracy * scale)));
        PointOfBreakdown {
            torque_nm: p.torque,
            speed_rpm: tidy(p.speed * RPM),
            oil_temperature_degc: p.oil,
            losses: Losses::new(unit, losses, seen.map(|(loss, _)| loss)),
            unit: p.unit(),
            accuracy: seen.map(|(_, accuracy)| accuracy),
        }
    };
    BreakdownOfSet {
        model_set: run.built.name.clone(),
        gear: gear.clone(),
        unit: unit.name(),
        shares: names.to_vec(),
        notes: notes_with_shares(t, &solved.seen, TotalLoss::of(&solved.points)),
        points: solved.points.iter().map(point).collect(),
        turned_at: None,
        rows,
    }
}

impl Outcome for BreakdownOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let loss = match self.unit {
            As::Watts => "Loss of the share",
            As::Percent => "Loss of the share in percent of the total loss",
        };
        let mut rows = Vec::new();
        for of_set in &self.breakdowns {
            for point in &of_set.points {
                let losses = point.losses.shares();
                let of_share = |(i, share)| (of_set, point, share, losses.map(|losses| losses[i]));
                rows.extend(of_set.shares.iter().map(String::as_str).enumerate().map(of_share));
                rows.extend(
                    point
                        .losses
                        .measured()
                        .map(|loss| (of_set, point, "measured", Some(loss))),
                );
            }
        }
        let table = Table::of(&self.head.analysis, rows)
            .text("model_set", "Model set", |(of_set, ..)| &of_set.model_set)
            .text("gear", "Gear", |(of_set, ..)| &of_set.gear)
            .fields("torque_nm speed_rpm oil_temperature_degc", |(_, point, ..)| point)
            .text(
                "share",
                "Share of the loss; `measured` is the measured loss",
                |(_, _, share, _)| *share,
            )
            .number(
                format!("loss_{}", self.unit.name()),
                self.unit.symbol(),
                loss,
                |(_, _, _, loss)| *loss,
            );
        vec![UnitPoint::add_to(table, |(_, point, ..)| point.unit.as_ref()).finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.breakdowns.iter().flat_map(|of_set| &of_set.notes).collect()
    }
}
