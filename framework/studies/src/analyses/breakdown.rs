//! Loss breakdown over speed or torque.

mod bars;

use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::axes::{axis, speeds, torques};
use super::{Analysis, Built, Chosen, Engine, Planner, Stopped};
use crate::measured::{Measured, Seen};
use crate::numbers::{RPM, tidy};
use crate::points::{Given, PointResult};
use crate::register_analysis;
use crate::study::{By, Data, PowerAxis, Quantity, SpeedAxis, TorqueAxis, Uses};

pub use self::bars::{
    Along, As, BarsPlan, BreakdownOfSet, BreakdownOutcome, Common, Losses, PointOfBreakdown, RowOfBars,
};

/// Loss breakdown over speed or torque.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BreakdownEntry {
    /// Gearbox, gear and model sets.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the total loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// Horizontal axis of the bars; there is one figure for each value of the other axis.
    #[serde(default)]
    pub over: Over,
    /// Torques; not with `power`.
    pub torque: Option<TorqueAxis>,
    /// Powers at the port with given torque, instead of torques.
    pub power: Option<PowerAxis>,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Measured points. The mean of those within 2 % of torque and speed and 5 K of oil temperature of a bar is drawn next to it.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub measured: Option<Data>,
}

/// Horizontal axis of bars.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// Speed.
    #[default]
    Speed,
    /// Torque, or power.
    Torque,
}

register_analysis!(BreakdownEntry);

impl Analysis for BreakdownEntry {
    const TYPE: &'static str = "breakdown";
    type Plan<'a> = (BarsPlan<'a>, Measured);
    type Outcome = BreakdownOutcome;

    fn uses(&self) -> Uses<'_> {
        self.chosen.uses().with("measured", self.measured.as_ref())
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<(BarsPlan<'a>, Measured), Stopped> {
        let path = cx.path();
        let built = self.chosen.built(cx)?;
        let measured = match &self.measured {
            Some(data) => cx.read_at_ports(&format!("{path}.measured"), data, &[])?,
            None => Measured::default(),
        };
        let mut bars = BarsPlan::new(self.by, self.unit, built.clone());
        for b in &built {
            let speeds = speeds(cx, &format!("{path}.speed"), &self.speed, &b.transmission)?;
            let loads = self.loads(cx, &b.transmission, &speeds)?;
            cx.holds(&path, speeds.len(), loads.len())?;
            let gear = self.chosen.gear(&b.transmission);
            let ratio = ratio(cx, b, gear)?;
            let rows = self.rows(&speeds, &loads, |load, speed| Given {
                torque: load.torque(ratio * speed),
                speed,
                oil: None,
            });
            bars.add(cx, b, gear, rows)?;
        }
        Ok((bars, measured))
    }

    fn reduce<'a>(
        &'a self,
        (bars, measured): (BarsPlan<'a>, Measured),
        engine: &Engine<'a>,
    ) -> Result<BreakdownOutcome, Stopped> {
        Ok(BreakdownOutcome {
            measured_notes: measured.notes.clone(),
            ..bars.outcome(engine, &|point, gear| beside(&measured, point, gear))?
        })
    }
}

impl BreakdownEntry {
    /// Torques, or powers.
    fn loads(&self, cx: &Planner<'_>, t: &Transmission, turning: &[f64]) -> Result<Vec<Load>, Stopped> {
        let path = cx.path();
        match (&self.torque, &self.power) {
            (Some(torque), None) => {
                let values = torques(cx, &format!("{path}.torque"), torque, t)?;
                Ok(values.into_iter().map(Load::Torque).collect())
            }
            (None, Some(power)) => {
                let values = axis(cx, &format!("{path}.power"), power.values())?;
                if turning.contains(&0.0) {
                    let speed = format!("{path}.speed");
                    return Err(cx.wrong(&speed, "a power at standstill is not possible", "omit 0 rpm"));
                }
                Ok(values.into_iter().map(Load::Power).collect())
            }
            _ => Err(cx.wrong(
                &path,
                "a breakdown needs either `torque` or `power`",
                "write `torque: 10 Nm`, or `power: 5 kW` for one power at every speed",
            )),
        }
    }

    /// Rows of bars over speed or load, with their points.
    fn rows(
        &self,
        speeds: &[f64],
        loads: &[Load],
        given: impl Fn(&Load, f64) -> Given,
    ) -> Vec<(RowOfBars, Vec<Given>)> {
        let over_speed = |load: &Load| {
            let row = RowOfBars {
                common: load.common(),
                along: Along::Speed,
                values: speeds.iter().map(|speed| speed * RPM).collect(),
            };
            (row, speeds.iter().map(|speed| given(load, *speed)).collect())
        };
        let over_load = |speed: &f64| {
            let row = RowOfBars {
                common: Common::Speed(speed * RPM),
                along: if self.power.is_some() {
                    Along::Power
                } else {
                    Along::Torque
                },
                values: loads.iter().map(Load::value).collect(),
            };
            (row, loads.iter().map(|load| given(load, *speed)).collect())
        };
        match self.over {
            Over::Speed => loads.iter().map(over_speed).collect(),
            Over::Torque => speeds.iter().map(over_load).collect(),
        }
    }
}

/// Speed of the port with given torque over that of the port with given speed.
fn ratio(cx: &Planner<'_>, b: &Built<'_>, gear: &str) -> Result<f64, Stopped> {
    let t = &b.transmission;
    let case = cx.case(b.gearbox, t, &cx.points(t, gear, Vec::new(), Vec::new()))?;
    let port = |ports: &[usize]| ports.first().map(|p| t.ports()[*p].member);
    let speeds = t.speeds(&case, &vec![1.0; case.speed_ports.len()]);
    Ok(port(&case.torque_ports).map_or(1.0, |member| speeds[member]))
}

/// Constant quantity while the speed changes.
enum Load {
    Torque(f64),
    Power(f64),
}

impl Load {
    fn torque(&self, speed: f64) -> f64 {
        match self {
            Self::Torque(torque) => *torque,
            Self::Power(power) => power / speed,
        }
    }

    fn value(&self) -> f64 {
        match self {
            Self::Torque(x) | Self::Power(x) => tidy(*x),
        }
    }

    fn common(&self) -> Common {
        match self {
            Self::Torque(_) => Common::Torque(self.value()),
            Self::Power(_) => Common::Power(self.value()),
        }
    }
}

/// Mean measured loss of the points within 2 % of torque and speed and 5 K of oil temperature, and the maximum of their accuracies. \[W\]
fn beside(measured: &Measured, point: &PointResult, gear: &str) -> Option<(f64, f64)> {
    let near = |a: Option<f64>, b: f64| a.is_some_and(|a| (a - b).abs() <= 0.02 * b.abs().max(1e-9));
    let (mut sum, mut accuracy, mut count) = (0.0, 0.0_f64, 0.0);
    for row in &measured.rows {
        let value = |quantity: &str| measured.value(row, quantity);
        let same = row.gear.as_deref().is_none_or(|g| g == gear);
        let warm = value("oil_temperature")
            .zip(point.oil)
            .is_none_or(|(a, b)| (a - b).abs() <= 5.0);
        if !(same && warm && near(value("torque"), point.torque) && near(value("speed"), point.speed)) {
            continue;
        }
        let seen = Seen::without_rig(measured, row, point);
        let Some(loss) = seen.quantity(Quantity::Loss) else {
            continue;
        };
        sum += loss;
        count += 1.0;
        accuracy = accuracy.max(seen.accuracy(Quantity::Loss).unwrap_or(0.0));
    }
    (count > 0.0).then(|| (sum / count, accuracy))
}
