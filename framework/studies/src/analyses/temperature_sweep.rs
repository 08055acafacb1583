//! Loss breakdown over oil temperature.

use schemars::JsonSchema;
use serde::Deserialize;

use super::breakdown::{Along, As, BarsPlan, BreakdownOutcome, Common, RowOfBars};
use super::common::axes::{axis, speeds, torques};
use super::{Analysis, Chosen, Engine, Planner, Stopped};
use crate::numbers::{RPM, tidy};
use crate::points::Given;
use crate::register_analysis;
use crate::study::{By, SpeedAxis, TemperatureAxis, TorqueAxis, Uses};

/// Loss breakdown over oil temperature.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct TemperatureSweepEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the total loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// Oil temperatures, instead of that of the conditions.
    pub oil_temperature: TemperatureAxis,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
}

register_analysis!(TemperatureSweepEntry);

impl Analysis for TemperatureSweepEntry {
    const TYPE: &'static str = "temperature_sweep";
    type Plan<'a> = BarsPlan<'a>;
    type Outcome = BreakdownOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses()
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<BarsPlan<'a>, Stopped> {
        let path = cx.path();
        let built = self.chosen.built(cx)?;
        let given = self.oil_temperature.values();
        let temperatures = axis(cx, &format!("{path}.oil_temperature"), given)?;
        let mut plan = BarsPlan::new(self.by, self.unit, built.clone());
        for b in &built {
            let t = &b.transmission;
            let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, t)?;
            let torques = torques(cx, &format!("{path}.torque"), &self.torque, t)?;
            cx.holds(&path, torques.len().saturating_mul(speeds.len()), temperatures.len())?;
            let pairs = torques
                .iter()
                .flat_map(|torque| speeds.iter().map(move |speed| (*torque, *speed)));
            let rows = pairs.map(|(torque, speed)| row(torque, speed, &temperatures));
            plan.add(cx, b, self.chosen.gear(t), rows.collect())?;
        }
        Ok(plan)
    }

    fn reduce<'a>(&'a self, plan: BarsPlan<'a>, engine: &Engine<'a>) -> Result<BreakdownOutcome, Stopped> {
        plan.outcome(engine, &|_, _| None)
    }
}

/// The bars of one torque and speed, with their points.
fn row(torque: f64, speed: f64, temperatures: &[f64]) -> (RowOfBars, Vec<Given>) {
    let row = RowOfBars {
        common: Common::Point(tidy(torque), speed * RPM),
        along: Along::OilTemperature,
        values: temperatures.to_vec(),
    };
    let given = |oil: &f64| Given {
        torque,
        speed,
        oil: Some(*oil),
    };
    (row, temperatures.iter().map(given).collect())
}
