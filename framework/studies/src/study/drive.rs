//! Settings of a cycle simulation.

use schemars::JsonSchema;
use serde::Deserialize;

use super::CycleGear;
use crate::duty::SpectrumPoint;
use gearloss_framework::thermal::network::Scheme;

/// Gearbox, model sets, cycles and settings of the simulation.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct DriveEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear of cycles without a gear; default: the first. `best` chooses the gear that draws least, an entry states how gears are chosen.
    pub gear: Option<CycleGear>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Cycles and settings of the simulation.
    #[serde(flatten)]
    pub ride: RideEntry,
}

/// Cycles and settings of the simulation.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
pub struct RideEntry {
    /// Names under `cycles` of the study.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "cycles"))]
    pub cycles: Vec<String>,
    /// Loads at the port of `conditions.torque_at`, such as the rated one, instead of cycles or beside them; in results they are the cycle
    /// `points`.
    #[serde(default)]
    pub points: Vec<SpectrumPoint>,
    /// Name under `vehicles` of the study, for cycles with a vehicle speed only; default: the first.
    #[schemars(extend("x-refers-to" = "vehicles"))]
    pub vehicle: Option<String>,
    /// Start temperature of nodes without one; default: ambient temperature. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub start: Option<f64>,
    /// Ambient temperature of cycles without one; default: from the gearbox. [degC]
    #[schemars(range(min = -60.0, max = 120.0))]
    pub ambient: Option<f64>,
    /// Whether losses are evaluated at the end or at the start of a time step; default: at the end.
    pub scheme: Option<Scheme>,
    /// Maximum time step; default: the intervals of the cycle. Not with `tolerance`. [s]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub step: Option<f64>,
    /// Adaptive time steps: one step and two half steps must agree within this. [K]
    #[schemars(range(min = 1e-4, max = 10.0))]
    pub tolerance: Option<f64>,
}
