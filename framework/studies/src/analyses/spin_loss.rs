//! No-load losses in every gear.

use gearloss_framework::attach::dangling;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Deserialize;

use super::axes::speeds;
use super::breakdown::{Along, As, BreakdownOfSet, BreakdownOutcome, Common, RowOfBars, Stacks};
use super::numbers::RPM;
use super::{Analysis, Built, Context, Stopped};
use crate::register_analysis;
use crate::study::{By, SpeedAxis, Uses, Write};

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
    /// Formats to write; default: CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

register_analysis!(SpinLossEntry);

impl Analysis for SpinLossEntry {
    const TYPE: &'static str = "spin_loss";
    type Outcome = BreakdownOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).in_gears(&self.gears)
    }

    fn run(&self, cx: &Context<'_>) -> Result<BreakdownOutcome, Stopped> {
        let path = cx.path();
        let built = cx.built(cx.gearbox(self.gearbox.as_ref())?, &self.model_sets)?;
        let stacks = Stacks::new(self.by, As::Watts, &built);
        let (mut breakdowns, mut number) = (Vec::new(), 0);
        for b in &built {
            let t = &b.transmission;
            let turned = self.turned(cx, t)?;
            let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, t)?;
            let gears: Vec<&str> = if self.gears.is_empty() {
                t.states().iter().map(|s| s.name.as_str()).collect()
            } else {
                self.gears.iter().map(String::as_str).collect()
            };
            for gear in gears {
                number += 1;
                let unloaded = cx.part(number, || unloaded(cx, b, &stacks, gear, turned, &speeds))?;
                breakdowns.extend(unloaded.flatten());
            }
        }
        cx.complete()?;
        stacks.outcome(cx, &built, breakdowns)
    }

    fn formats(&self) -> &[Write] {
        &self.write
    }
}

impl SpinLossEntry {
    /// Index of the driven port.
    fn turned(&self, cx: &Context<'_>, t: &Transmission) -> Result<usize, Stopped> {
        let turned = self.turned_at.as_ref().unwrap_or(&cx.study.entry.conditions.speed_at);
        t.ports().iter().position(|port| port.name == *turned).ok_or_else(|| {
            let known: Vec<&str> = t.ports().iter().map(|port| port.name.as_str()).collect();
            let path = format!("{}.turned_at", cx.path());
            cx.found(vec![dangling(&path, "port", turned, &known)])
        })
    }
}

/// The losses in one gear; absent if the analysis is only checked.
fn unloaded(
    cx: &Context<'_>,
    b: &Built<'_>,
    stacks: &Stacks,
    gear: &str,
    turned_port: usize,
    speeds: &[f64],
) -> Result<Option<BreakdownOfSet>, Stopped> {
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
    let mut points = cx.points(t, gear, vec![0.0], speeds.to_vec());
    points.speed_at = std::iter::once(&turned).chain(&stationary).cloned().collect();
    let names = (0..t.ports().len()).map(name);
    points.torque_at = names.filter(|port| *port != turned).collect();
    points.terms = stacks.needs_terms();
    if cx.checked(b, &points)? {
        return Ok(None);
    }
    let solved = cx.solve(b, &points)?;
    let row = RowOfBars {
        common: Common::NoLoad {
            turned: turned.clone(),
            stationary,
        },
        along: Along::Speed,
        values: solved.points.iter().map(|point| point.speed * RPM).collect(),
    };
    Ok(Some(BreakdownOfSet {
        turned_at: Some(turned),
        ..stacks.breakdown(b, &points, &solved, vec![row], &|_| None)
    }))
}
