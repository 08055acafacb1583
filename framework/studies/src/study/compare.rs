//! Compared quantities and units of their differences.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::points::PointResult;

/// Compared quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Efficiency.
    #[default]
    Efficiency,
    /// Sum of all losses.
    Loss,
    /// Loss over the speed of the reference port.
    LossTorque,
    /// Oil temperature if found by heat balance.
    Temperature,
}

impl Quantity {
    /// Name in results, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss_w",
            Self::LossTorque => "loss_torque_nm",
            Self::Temperature => "oil_temperature_degc",
        }
    }

    /// Unit of a difference.
    pub fn unit(self, difference: Difference) -> &'static str {
        match (difference, self) {
            (Difference::Percent, _) => "percent",
            (Difference::Points, Self::Efficiency) => "points",
            (Difference::Points, Self::Loss) => "w",
            (Difference::Points, Self::LossTorque) => "nm",
            (Difference::Points, Self::Temperature) => "k",
        }
    }

    /// The quantity and the unit of a difference as text.
    pub fn words(self, difference: Difference) -> (&'static str, &'static str) {
        let what = match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss",
            Self::LossTorque => "loss torque",
            Self::Temperature => "oil temperature",
        };
        let unit = match (difference, self) {
            (Difference::Percent, _) => "%",
            (Difference::Points, Self::Efficiency) => "percentage points",
            (Difference::Points, Self::Loss) => "W",
            (Difference::Points, Self::LossTorque) => "Nm",
            (Difference::Points, Self::Temperature) => "K",
        };
        (what, unit)
    }

    /// The quantity of a solved point; efficiency as a fraction, temperature in degC.
    pub fn value(self, point: &PointResult) -> Option<f64> {
        match self {
            Self::Efficiency => point.efficiency,
            Self::Loss => point.loss,
            Self::LossTorque => point.loss_torque,
            Self::Temperature => point.oil,
        }
    }

    /// The other value minus the base, in that unit; absent for percent of a zero base.
    pub fn difference(self, difference: Difference, base: f64, other: f64) -> Option<f64> {
        match (difference, self) {
            (Difference::Percent, _) => (base != 0.0).then(|| 100.0 * (other - base) / base),
            (Difference::Points, Self::Efficiency) => Some(100.0 * (other - base)),
            (Difference::Points, _) => Some(other - base),
        }
    }
}

/// Unit of a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    /// Percentage points of an efficiency (0.01), watts for a loss, kelvins for a temperature.
    #[default]
    Points,
    /// Percent of the base.
    Percent,
}
