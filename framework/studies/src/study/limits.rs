//! Limits of quantities, as a study states them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A bound of a quantity, at each point or over all cycles.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct LimitEntry {
    /// Limited quantity.
    pub quantity: LimitedQuantity,
    /// What it belongs to: a node of the thermal network, a cycle, a gear, a component or several (`bearings.*`). Default: the oil, every
    /// cycle, the first gear, every component. A loss and an efficiency are those of the gearbox.
    #[schemars(extend("x-refers-to" = ["component", "thermal.network.nodes", "cycles", "gear_states"]))]
    pub of: Option<String>,
    /// Rating and symbol, for the quantity `rating`: `iso_281.L10h`; `gearloss models rating` lists them.
    pub rating: Option<String>,
    /// Least allowed value, with its unit: `20 degC`.
    pub least: Option<Value>,
    /// Greatest allowed value, with its unit: `110 degC`.
    pub most: Option<Value>,
    /// What follows if it is not kept: a warning, or an error with which `gearloss run` ends after it has written all results.
    #[serde(default)]
    pub severity: Severity,
}

impl LimitEntry {
    /// Whether it limits the temperature of the oil, whatever it is calculated from.
    pub fn is_of_oil(&self) -> bool {
        self.quantity == LimitedQuantity::Temperature && matches!(self.of.as_deref(), None | Some("oil"))
    }
}

/// What follows if a limit is not kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// A warning.
    #[default]
    Warning,
    /// `gearloss run` ends with the exit code of a finding.
    Error,
}

/// A quantity that can be limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LimitedQuantity {
    /// The temperature of the oil or a node: at a point, or the highest in any cycle (the lowest for a least value).
    Temperature,
    /// The loss at a point, or at the worst moment of any cycle.
    Loss,
    /// The efficiency at a point, or the energy delivered over the energy received in a cycle.
    Efficiency,
    /// The mean loss of a cycle.
    MeanLoss,
    /// The consumption over a cycle in kWh/100 km; the vehicle needs a battery.
    Consumption,
    /// The range of the vehicle over a cycle in km; it needs a battery.
    Range,
    /// The ratio of a gear: speed of the reference port over that of the first other port.
    Ratio,
    /// The power out of the DC link into all machines, at a point or in any interval of a cycle.
    DcPower,
    /// The losses of machines and inverters, at a point or in any interval of a cycle.
    MachineLoss,
    /// The losses of gearbox, machines and inverters, at a point or in any interval of a cycle.
    UnitLoss,
    /// Power at the other ports over the power of the DC link at a point; over a cycle the energy at the wheels over that of the machines while they
    /// drive.
    SystemEfficiency,
    /// A quantity of a rating: at a point, or over each cycle a life after Palmgren and Miner, the minimum or the maximum of the others.
    Rating,
}

impl LimitedQuantity {
    /// Whether it is that of a whole cycle, which no point has.
    pub fn is_of_cycles(self) -> bool {
        matches!(self, Self::MeanLoss | Self::Consumption | Self::Range)
    }

    /// Symbol of its unit; that of a rating is its own.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Temperature => "degC",
            Self::MeanLoss | Self::Loss | Self::DcPower | Self::MachineLoss | Self::UnitLoss => "W",
            Self::Consumption => "kWh/100 km",
            Self::Range => "km",
            Self::Ratio | Self::Rating | Self::Efficiency | Self::SystemEfficiency => "-",
        }
    }
}
