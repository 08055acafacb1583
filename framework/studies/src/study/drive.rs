//! How duties are driven through a gearbox.

use schemars::JsonSchema;
use serde::Deserialize;

use gearloss_framework::thermal::network::Scheme;

/// Cycles and settings of the simulation.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct DriveEntry {
    /// Gearbox; default: the first.
    pub gearbox: Option<String>,
    /// Gear state where a duty names none; absent, the first.
    pub gear: Option<String>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// Duties, of those under `cycles` of the study.
    #[schemars(length(min = 1))]
    pub cycles: Vec<String>,
    /// Vehicle, of those under `vehicles` of the study, for duties that tell its speed alone; absent, the first.
    pub vehicle: Option<String>,
    /// Temperature of all nodes at the start that state none; absent, that of the surroundings. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub start: Option<f64>,
    /// Temperature of the surroundings where a duty tells none; absent, that of the gearbox. [degC]
    #[schemars(range(min = -60.0, max = 120.0))]
    pub ambient: Option<f64>,
    /// Whether the losses of a step in time are those of its end or of its beginning; absent, of its end.
    pub scheme: Option<Scheme>,
    /// Longest step in time; absent, the intervals of the duty. Not with `tolerance`. [s]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub step: Option<f64>,
    /// Steps adapt, so that one of them and two of half its length agree within this. [K]
    #[schemars(range(min = 1e-4, max = 10.0))]
    pub tolerance: Option<f64>,
}
