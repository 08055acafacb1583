//! The gear of a cycle: stated, or chosen.

use gearloss_framework::document::data::TableFile;
use schemars::JsonSchema;
use serde::Deserialize;

/// The gear of a cycle without one.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CycleGear {
    /// A gear, or `best`: in each interval that which draws least.
    Name(#[schemars(extend("x-refers-to" = "gear_states"))] String),
    /// How gears are chosen.
    Chosen(Box<ChosenGear>),
}

/// Gears chosen in each interval: `choose`, or `map`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct ChosenGear {
    /// Rule of the choice. The gear that draws least is that with the least power from the machines, each at its own rotating mass; where no
    /// machine is described, that with the least loss of the gearbox.
    pub choose: Option<Choose>,
    /// File with the gear over speed and torque of the wheels: CSV file, workbook or MDF file relative to the study, or an entry with `file`,
    /// `columns` and `units`; with `speed [rpm]`, `torque [Nm]` and `gear`. A row applies from its speed and torque up to the next ones.
    #[schemars(extend("x-refers-to" = "file"))]
    pub map: Option<TableFile>,
    /// Gears among which to choose; default: all that turn the wheels in the direction of the first one.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gears: Vec<String>,
    /// Power that a shift must save; default: 0 W. For `choose: best`. [W]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub saving: Option<f64>,
    /// Time that must have passed since the last shift; default: 0 s. For `choose: best`. [s]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub dwell: Option<f64>,
    /// Energy that a shift dissipates; default: from the moments of inertia of the vehicle, sum of J (w1 - w2)2/2 by friction, and none
    /// without them. [J]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub shift_energy: Option<f64>,
    /// Energy of the actuator for each shift. [J]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub actuation: f64,
    /// Maximum speed of the reference port; a gear beyond it is left at once. [rpm]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub most_speed: Option<f64>,
    /// Maximum torque of the reference port, driving and braking; a gear beyond it is left at once. [Nm]
    #[schemars(range(min = 0.0, max = 1e8))]
    pub most_torque: Option<f64>,
}

/// Rule of the choice of a gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Choose {
    /// The gear that draws least at the moment, if it saves more than `saving` and `dwell` has passed since the last shift.
    Best,
    /// The sequence of gears with the least energy over the whole cycle, shifts included, at the temperatures of `best`.
    Optimum,
}

/// The word for the choice by the rule.
pub const BEST: &str = "best";

impl CycleGear {
    /// Its names of gears that must exist.
    pub fn names(&self) -> &[String] {
        match self {
            Self::Name(name) if name == BEST => &[],
            Self::Name(name) => std::slice::from_ref(name),
            Self::Chosen(chosen) => &chosen.gears,
        }
    }
}
