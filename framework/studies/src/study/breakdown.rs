//! Where losses arise.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Data, PowerAxis, SpeedAxis, TemperatureAxis, TorqueAxis, Write};

/// Where losses arise, over speed or torque.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BreakdownEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the whole loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// What the bars stand over; the other axis makes a picture of each of its values.
    #[serde(default)]
    pub over: Over,
    /// Torques; not with `power`.
    pub torque: Option<TorqueAxis>,
    /// Powers at the port with given torque, in place of torques: the torque falls as the speed rises.
    pub power: Option<PowerAxis>,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Measured points. Those within 2 % of torque and speed and 5 K of the oil of a bar are drawn
    /// beside it, their mean where there are several.
    pub measured: Option<Data>,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// Losses without load: every free port turns at no torque.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SpinLossEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear states, neutral among them; absent, all.
    #[serde(default)]
    pub gears: Vec<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Port that is turned; absent, that of the conditions. `output` is towing.
    pub turned_at: Option<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Speeds of that port.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// Where losses arise, over the temperature of the oil.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct TemperatureSweepEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Watts, or percent of the whole loss.
    #[serde(default, rename = "as")]
    pub unit: As,
    /// Temperatures of the oil, in place of that of the conditions.
    pub oil_temperature: TemperatureAxis,
    /// Torques.
    pub torque: TorqueAxis,
    /// Speeds.
    pub speed: SpeedAxis,
    /// Formats to write; absent, CSV and JSON.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
}

/// What bars stand over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// Speed.
    #[default]
    Speed,
    /// Torque, or power.
    Torque,
}

/// What losses are summed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum By {
    /// By mechanism.
    #[default]
    Mechanism,
    /// By component.
    Component,
    /// By stage: a mesh with the drags of its gears, a planetary set, and for everything else its shaft.
    Stage,
    /// By mechanism and term, such as the rolling and sliding terms of a bearing.
    Term,
    /// By the usual sums: gears, bearings, seals, others; load-dependent and not.
    Sum,
}

/// Unit of a breakdown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum As {
    /// Watts.
    #[default]
    Watts,
    /// Percent of the whole loss.
    Percent,
}
