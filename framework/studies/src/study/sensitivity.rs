//! What losses depend on.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameters::NameOr;
use super::{RangeEntry, Write};

/// What the losses over a grid depend on: the mean loss, that of every mechanism and term, the mean efficiency, and the relative change of
/// the loss at the points (`relative_loss`: root of its mean square from the values of the gearbox, not for `local`).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SensitivityEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid, of one gear state.
    pub grid: String,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// The quantities that are varied. `local` starts from the value of the gearbox: of the first where a path meets several
    /// that differ. A name takes over a parameter of the study.
    #[schemars(length(min = 1, max = 32), with = "Vec<NameOr<RangeEntry>>")]
    pub parameters: Vec<RangeEntry>,
    /// What is done; absent, all.
    #[serde(default = "Method::all")]
    #[schemars(length(min = 1))]
    pub methods: Vec<Method>,
    /// Number of trajectories of `morris`; each costs one run more than there are parameters. [-]
    #[serde(default = "trajectories")]
    #[schemars(range(min = 2, max = 10000))]
    pub trajectories: u32,
    /// Number of samples of `sobol`, a power of two; each costs two runs more than there are parameters. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: u32,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

fn trajectories() -> u32 {
    20
}

fn samples() -> u32 {
    1024
}

/// How a dependence is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Slopes at the values of the gearbox.
    Local,
    /// Changes along trajectories through the ranges: which parameters matter at all, from few runs.
    Morris,
    /// Shares of the variance over the ranges, of each parameter alone and with all others.
    Sobol,
}

impl Method {
    fn all() -> Vec<Self> {
        vec![Self::Local, Self::Morris, Self::Sobol]
    }
}
