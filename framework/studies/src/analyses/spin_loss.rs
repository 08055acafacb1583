//! No-load losses in every gear.

use gearloss_framework::attach::dangling;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Deserialize;

use super::breakdown::{Along, As, BarsPlan, BreakdownOutcome, Common, RowOfBars};
use super::common::axes::speeds;
use super::{Analysis, Built, Engine, Planner, Stopped};
use crate::numbers::RPM;
use crate::points::Points;
use crate::register_analysis;
use crate::study::{By, SpeedAxis, Uses};

/// No-load losses in every gear, including neutral and towing.
///
/// Every free port turns without torque.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SpinLossEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gears, including neutral; default: all.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gears: Vec<String>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Driven port; default: that of the conditions. `output` is towing.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub turned_at: Option<String>,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Speeds of that port.
    pub speed: SpeedAxis,
}

register_analysis!(SpinLossEntry);

impl Analysis for SpinLossEntry {
    const TYPE: &'static str = "spin_loss";
    type Plan<'a> = BarsPlan<'a>;
    type Outcome = BreakdownOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).in_gears(&self.gears)
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<BarsPlan<'a>, Stopped> {
        let built = cx.built(cx.gearbox(self.gearbox.as_ref())?, &self.model_sets)?;
        let turned = self.turned_at.as_ref().unwrap_or(&cx.study.entry.conditions.speed_at);
        let mut plan = BarsPlan::new(self.by, As::Watts, built.clone()).turned_at(turned.clone());
        for b in &built {
            let t = &b.transmission;
            let turned = turned_port(cx, t, turned)?;
            let speeds = speeds(cx, &format!("{}.speed", cx.path()), &self.speed, t)?;
            let gears: Vec<&str> = if self.gears.is_empty() {
                t.states().iter().map(|s| s.name.as_str()).collect()
            } else {
                self.gears.iter().map(String::as_str).collect()
            };
            for gear in gears {
                let (points, row) = unloaded(cx, b, gear, turned, &speeds)?;
                plan.add_points(cx, b, points, vec![row])?;
            }
        }
        Ok(plan)
    }

    fn reduce<'a>(&'a self, plan: BarsPlan<'a>, engine: &Engine<'a>) -> Result<BreakdownOutcome, Stopped> {
        plan.outcome(engine, &|_, _| None)
    }
}

/// Index of the driven port.
fn turned_port(cx: &Planner<'_>, t: &Transmission, turned: &str) -> Result<usize, Stopped> {
    t.ports().iter().position(|port| port.name == turned).ok_or_else(|| {
        let known: Vec<&str> = t.ports().iter().map(|port| port.name.as_str()).collect();
        let path = format!("{}.turned_at", cx.path());
        cx.found(vec![dangling(&path, "port", turned, &known)])
    })
}

/// The points of one gear, and their row of bars.
fn unloaded(
    cx: &Planner<'_>,
    b: &Built<'_>,
    gear: &str,
    turned_port: usize,
    speeds: &[f64],
) -> Result<(Points, RowOfBars), Stopped> {
    let t = &b.transmission;
    let name = |port: usize| t.ports()[port].name.clone();
    let turned = name(turned_port);
    let state = t.state(gear).map_err(|error| b.gearbox.findings(vec![error]))?;
    let state = &t.states()[state];
    // The other free ports are stationary; the torque is zero at every port that is not driven.
    let others = state.speed_ports.iter().filter(|port| **port != turned_port);
    let stationary: Vec<String> = others
        .take(state.speed_ports.len() - 1)
        .map(|port| name(*port))
        .collect();
    let names = (0..t.ports().len()).map(name);
    let points = Points {
        speed_at: std::iter::once(&turned).chain(&stationary).cloned().collect(),
        torque_at: names.filter(|port| *port != turned).collect(),
        ..cx.points(t, gear, vec![0.0], speeds.to_vec())
    };
    let row = RowOfBars {
        common: Common::NoLoad { turned, stationary },
        along: Along::Speed,
        values: speeds.iter().map(|speed| speed * RPM).collect(),
    };
    Ok((points, row))
}
