//! Heat balance of one point: losses and heat over temperature, and every step of the search.

use std::sync::Arc;

use gearloss_framework::description::{Ordered, ThermalMode};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::Point;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::thermal::{self, Equilibrium, Unbalanced};
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Analysis, Built, Chosen, Engine, Head, Outcome, Planner, Run, Runs, Stopped};
use crate::points::{Given, Note, UnitPoint, notes, unit_of};
use crate::register_analysis;
use crate::study::{Uses, Write};
use crate::table::Table;

/// Heat balance of one point: losses and heat over temperature, and every step of the search.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BalanceEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub torque: f64,
    /// Speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub speed: f64,
    /// Overrides for this analysis: resolved path to value.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub set: Ordered<Value>,
}

register_analysis!(BalanceEntry);

/// The balance of one point under each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BalanceOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub balances: Vec<BalanceOfSet>,
}

/// The balance under one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BalanceOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// The balance.
    pub balance: BalanceOfPoint,
    /// The drive unit at the temperature found; absent without one, and without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitPoint>,
    /// Notes of models at the temperature found.
    pub notes: Vec<Note>,
}

/// A balance with its history.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BalanceOfPoint {
    /// Result.
    // Only a network does not converge.
    #[schemars(extend("enum" = ["converged", "at_discontinuity", "several", "none_below_maximum", "undefined"]))]
    pub outcome: thermal::Outcome,
    /// Oil temperature that is used; null if none was found. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Temperature of the surface; null if none was found. [degC]
    pub surface_temperature_degc: Option<f64>,
    /// Ambient temperature. [degC]
    pub ambient_degc: f64,
    /// All stable temperatures, the lowest first.
    pub stable: Vec<StableTemperature>,
    /// Heat flow of each heat path; empty if no temperature was found.
    pub ways: Vec<HeatOfPath>,
    /// Heat input in addition to the losses.
    pub sources_w: HeatSources,
    /// The first temperature at which a law had no value; null if all had one.
    pub undefined: Option<UndefinedBalance>,
    /// Number of steps of the scan, which are first in the history.
    pub scan: usize,
    /// Step of the scan: two balances closer than this may both be missed. [K]
    pub scan_spacing_k: f64,
    /// All steps in the order of evaluation: the scan, then those of each bracket.
    pub history: Vec<BalanceStep>,
    /// Number of temperatures at which losses and heat were computed.
    #[serde(skip)]
    pub evaluations: usize,
    /// Maximum temperature of the scan. [degC]
    #[serde(skip)]
    pub maximum_degc: f64,
}

/// A stable temperature: the transferred heat exceeds the losses above it and is lower below it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StableTemperature {
    /// Oil temperature. [degC]
    pub oil_temperature_degc: f64,
    /// Loss minus heat there. [W]
    pub residual_w: f64,
    /// Loss minus heat above a discontinuity of a law; null without a discontinuity. [W]
    pub residual_beyond_jump_w: Option<f64>,
}

/// Heat of one heat path.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HeatOfPath {
    /// Path of the heat path in the gearbox.
    pub path: String,
    /// Heat flow of the path. [W]
    pub heat_w: f64,
}

/// Heat input in addition to the losses.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct HeatSources {
    /// Into the oil. [W]
    pub oil: f64,
    /// Into the surface. [W]
    pub surface: f64,
}

/// Point at which losses or heat had no value.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct UndefinedBalance {
    /// Oil temperature. [degC]
    pub oil_temperature_degc: f64,
    /// Path and reason.
    pub reason: String,
}

/// Losses and heat at one temperature.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct BalanceStep {
    /// Oil temperature. [degC]
    pub oil_temperature_degc: f64,
    /// Sum of all losses. [W]
    pub loss_w: f64,
    /// Dissipated heat minus the heat input of sources. [W]
    pub heat_w: f64,
    /// Loss minus heat. [W]
    pub residual_w: f64,
}

impl BalanceOfPoint {
    /// From an equilibrium of a transmission.
    pub fn new(transmission: &Transmission, balance: &Equilibrium) -> Self {
        let housing = transmission.housing();
        let paths = housing.ways().iter().zip(&balance.ways);
        Self {
            outcome: balance.outcome,
            oil_temperature_degc: balance.oil(),
            surface_temperature_degc: balance.surface,
            ambient_degc: housing.ambient,
            stable: balance
                .stable
                .iter()
                .map(|root| StableTemperature {
                    oil_temperature_degc: root.temperature,
                    residual_w: root.step.residual(),
                    residual_beyond_jump_w: root.beyond.map(|step| step.residual()),
                })
                .collect(),
            ways: paths
                .map(|(path, watts)| HeatOfPath {
                    path: path.path.clone(),
                    heat_w: *watts,
                })
                .collect(),
            sources_w: HeatSources {
                oil: housing.into_oil,
                surface: housing.into_surface,
            },
            undefined: balance.undefined.as_ref().map(|(temperature, why)| UndefinedBalance {
                oil_temperature_degc: *temperature,
                reason: reason(transmission, why),
            }),
            scan: balance.scanned,
            scan_spacing_k: balance.spacing,
            history: balance
                .history
                .iter()
                .map(|step| BalanceStep {
                    oil_temperature_degc: step.temperature,
                    loss_w: step.loss,
                    heat_w: step.heat,
                    residual_w: step.residual(),
                })
                .collect(),
            evaluations: balance.evaluations(),
            maximum_degc: housing.maximum,
        }
    }
}

/// Why there is no balance.
pub fn reason(transmission: &Transmission, why: &Unbalanced) -> String {
    match why {
        Unbalanced::Part(part, reason) => format!("{}: {reason}", transmission.parts()[*part].path),
        Unbalanced::Way(way, reason) => format!("{}: {reason}", transmission.housing().ways()[*way].path),
        Unbalanced::Link(link, reason) => {
            let path = transmission.network().and_then(|n| n.links().nth(*link));
            format!("{}: {reason}", path.map_or("a link", |(path, _)| path))
        }
        Unbalanced::Flow => "the transmission is self-locking, or loads and losses do not converge".to_owned(),
        Unbalanced::Network => {
            "the temperatures of the network do not converge, or a node has no heat path at standstill".to_owned()
        }
    }
}

impl Analysis for BalanceEntry {
    const TYPE: &'static str = "balance";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = Runs<'a>;
    type Outcome = BalanceOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses()
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<Runs<'a>, Stopped> {
        let path = cx.path();
        let change = |(set_path, value): (&str, &Value)| (set_path.to_owned(), value.clone(), format!("{path}.set"));
        let set: Vec<(String, Value, String)> = self.set.iter().map(change).collect();
        let built = cx.built_with(cx.gearbox(self.chosen.gearbox.as_ref())?, &self.chosen.model_sets, &set)?;
        let run = |b: &Arc<Built<'a>>| {
            needs_balance(cx, b)?;
            let t = &b.transmission;
            let point = vec![Given::new(self.torque, self.speed)];
            Run::new(cx, b, cx.listed(t, self.chosen.gear(t), point))
        };
        Runs::of_sets(&built, run)
    }

    fn reduce<'a>(&'a self, plan: Runs<'a>, engine: &Engine<'a>) -> Result<BalanceOutcome, Stopped> {
        let mut balances = Vec::new();
        for run in &plan.0 {
            let t = &run.built.transmission;
            let case = engine.case(run.built.gearbox, t, &run.points)?;
            let torques = [self.torque];
            let point = Point {
                speeds: &[self.speed],
                torques: &torques[..case.torque_ports.len()],
                flow: run.points.flow,
                tolerance: Tolerance::default(),
                inclination: 0.0,
            };
            let mut scratch = t.scratch(&case);
            let found = t.equilibrium(&case, &point, &mut scratch);
            let mut unit = None;
            if let Some(oil) = found.oil() {
                // Notes belong to the temperature found.
                unit = unit_of(t, &t.evaluate(&case, &point, &[oil], &mut scratch), &[oil]);
                let given = Given {
                    oil: Some(oil),
                    ..Given::new(self.torque, self.speed)
                };
                engine.read_limits(run, vec![given])?;
            }
            balances.push(BalanceOfSet {
                model_set: run.built.name.clone(),
                gear: run.points.gear.clone(),
                balance: BalanceOfPoint::new(t, &found),
                unit,
                notes: notes(t, &scratch.totals),
            });
        }
        Ok(BalanceOutcome {
            head: engine.head(&plan.built()),
            balances,
        })
    }
}

/// Rejects a gearbox without a heat balance.
pub fn needs_balance(cx: &Planner<'_>, built: &Built<'_>) -> Result<(), Stopped> {
    let path = cx.path();
    if cx.study.entry.conditions.oil_temperature.is_some() {
        let error = Diagnostic::error(
            "conditions.oil_temperature",
            "the study fixes the temperature, so there is no heat balance",
        )
        .note(format!("`{path}` requests one"))
        .help("delete it, or move this analysis to another study");
        return Err(cx.found(vec![error]));
    }
    if built.transmission.thermal_mode == ThermalMode::Balance {
        return Ok(());
    }
    let error = Diagnostic::error(path, "the gearbox has a fixed temperature and no heat balance")
        .help("write `thermal: { mode: balance, heat_dissipation: { ... } }` in the gearbox");
    Err(cx.found(vec![error]))
}

impl Outcome for BalanceOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let table = Table::of_each(&self.head.analysis, &self.balances, |of_set| {
            of_set.balance.history.iter().enumerate()
        })
        .text("model_set", "Model set", |(of_set, _)| &of_set.model_set)
        .number("step", "-", "Number of the step", |(_, (i, _))| (i + 1) as f64)
        .text("of", "Part of the search: scan or solution", |(of_set, (i, _))| {
            if *i < of_set.balance.scan { "scan" } else { "solution" }
        })
        .fields("oil_temperature_degc loss_w heat_w residual_w", |(_, (_, step))| step);
        let units = self.balances.iter();
        let units = units.filter_map(|of_set| Some((of_set, of_set.unit.as_ref()?)));
        let units = Table::of(format!("{}-unit", self.head.analysis), units)
            .text("model_set", "Model set", |(of_set, _)| &of_set.model_set)
            .fields("oil_temperature_degc", |(of_set, _)| &of_set.balance);
        let mut tables = vec![table.finish()];
        if !units.rows().is_empty() {
            tables.push(UnitPoint::add_to(units, |(_, unit)| Some(unit)).finish());
        }
        tables
    }

    fn notes(&self) -> Vec<&Note> {
        self.balances.iter().flat_map(|of_set| &of_set.notes).collect()
    }
}
