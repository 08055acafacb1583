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
    /// Power out of the DC link into the machines.
    DcPower,
    /// Losses of gearbox, machines and inverters.
    UnitLoss,
    /// Power at the other ports over the power of the DC link, while generating the reciprocal.
    SystemEfficiency,
}

impl Quantity {
    /// Whether it is one of the drive unit, which needs a machine.
    pub fn is_of_unit(self) -> bool {
        matches!(self, Self::DcPower | Self::UnitLoss | Self::SystemEfficiency)
    }

    /// Name in results, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Efficiency => "efficiency",
            Self::Loss => "loss_w",
            Self::LossTorque => "loss_torque_nm",
            Self::Temperature => "oil_temperature_degc",
            Self::DcPower => "dc_power_w",
            Self::UnitLoss => "unit_loss_w",
            Self::SystemEfficiency => "system_efficiency",
        }
    }

    /// Unit of a difference.
    pub fn unit(self, difference: Difference) -> &'static str {
        match (difference, self) {
            (Difference::Percent, _) => "percent",
            (Difference::Points, Self::Efficiency | Self::SystemEfficiency) => "points",
            (Difference::Points, Self::Loss | Self::DcPower | Self::UnitLoss) => "w",
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
            Self::DcPower => "power of the DC link",
            Self::UnitLoss => "loss of the drive unit",
            Self::SystemEfficiency => "efficiency of the drive unit",
        };
        let unit = match (difference, self) {
            (Difference::Percent, _) => "%",
            (Difference::Points, Self::Efficiency | Self::SystemEfficiency) => "percentage points",
            (Difference::Points, Self::Loss | Self::DcPower | Self::UnitLoss) => "W",
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
            Self::DcPower => point.unit().map(|unit| unit.dc_power_w),
            Self::UnitLoss => point.unit().map(|unit| unit.unit_loss_w),
            Self::SystemEfficiency => point.unit().and_then(|unit| unit.system_efficiency),
        }
    }

    /// The other value minus the base, in that unit; absent for percent of a zero base.
    pub fn difference(self, difference: Difference, base: f64, other: f64) -> Option<f64> {
        match (difference, self) {
            (Difference::Percent, _) => (base != 0.0).then(|| 100.0 * (other - base) / base),
            (Difference::Points, Self::Efficiency | Self::SystemEfficiency) => Some(100.0 * (other - base)),
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
