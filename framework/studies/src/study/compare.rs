//! Differences between sets of models, products and measurements.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Data, Write};
use crate::analysis::PointResult;
use gearloss_framework::description::Ordered;

/// Difference between sets of models, and products, over a grid; or between them and what was measured.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CompareEntry {
    /// Gearbox of every set that names none; absent, the first.
    pub gearbox: Option<String>,
    /// Grid; not with `data`.
    pub grid: Option<String>,
    /// Set that the others are compared with; not with `data`. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    pub base: Option<String>,
    /// Measured points that the sets are compared with.
    pub data: Option<Data>,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    pub bind: Ordered<String>,
    /// Gear state of the data where no column says it; absent, the first.
    pub gear: Option<String>,
    /// Sets to compare; `PRODUCT/SET` takes another gearbox.
    #[schemars(length(min = 1))]
    pub against: Vec<String>,
    /// What is compared.
    #[serde(default)]
    pub quantity: Quantity,
    /// Accuracy of a measurement, in the unit of the difference: maps of differences show where they are smaller. [-]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub accuracy: Option<f64>,
    /// How the difference counts: the other set minus the base, or the model minus the measurement.
    #[serde(default)]
    pub difference: Difference,
    /// Formats to write; absent, CSV and JSON. Pictures show the differences and, with data, parity.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// What is compared.
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
    /// Temperature of the oil, where it is found by balance.
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

    /// The quantity and the unit of a difference in words.
    pub fn words(self, difference: Difference) -> (&'static str, &'static str) {
        let what = match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss",
            Self::LossTorque => "loss torque",
            Self::Temperature => "oil temperature",
        };
        let unit = match (difference, self) {
            (Difference::Percent, _) => "%",
            (Difference::Points, Self::Efficiency) => "efficiency points",
            (Difference::Points, Self::Loss) => "W",
            (Difference::Points, Self::LossTorque) => "Nm",
            (Difference::Points, Self::Temperature) => "K",
        };
        (what, unit)
    }

    /// The quantity of a solved point; efficiency as a share, temperature in degC.
    pub fn of(self, point: &PointResult) -> Option<f64> {
        match self {
            Self::Efficiency => point.efficiency,
            Self::Loss => point.loss,
            Self::LossTorque => point.loss_torque,
            Self::Temperature => point.oil,
        }
    }

    /// The other value minus the base, in that unit; absent where the base is zero and a percentage is asked for.
    pub fn difference(self, difference: Difference, base: f64, other: f64) -> Option<f64> {
        match (difference, self) {
            (Difference::Percent, _) => (base != 0.0).then(|| 100.0 * (other - base) / base),
            (Difference::Points, Self::Efficiency) => Some(100.0 * (other - base)),
            (Difference::Points, _) => Some(other - base),
        }
    }
}

/// How a difference counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Difference {
    /// Efficiency points (0.01), watts for a loss, kelvins for a temperature.
    #[default]
    Points,
    /// Percent of the base.
    Percent,
}
