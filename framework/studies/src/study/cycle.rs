//! Duties driven through a gearbox.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::{By, Write};
use gearloss_framework::thermal::network::Scheme;

/// What is driven, and how.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct DriveEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Gear state where a duty names none; absent, the first.
    pub gear: Option<String>,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
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

/// Mean losses of duties over one property of an oil.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct FluidSweepEntry {
    /// What is driven, and how.
    #[serde(flatten)]
    pub drive: DriveEntry,
    /// Oil; absent, that of the housing.
    pub lubricant: Option<String>,
    /// Viscosities at 100 degC of hypothetical oils of one viscosity index; those below 2 mm2/s, where the index is not defined, are
    /// marked. [mm2/s]
    #[serde(default)]
    #[schemars(inner(range(min = 0.5, max = 1000.0)))]
    pub kv100: Vec<f64>,
    /// Their viscosity index; absent, that of the oil. [-]
    #[schemars(range(min = 0.0, max = 400.0))]
    pub vi: Option<f64>,
    /// Another property of the oil in place of the viscosity, such as `rheology.tau0`.
    pub property: Option<String>,
    /// Its values, each as in a gearbox: `[4 MPa, 6 MPa]`.
    #[serde(default)]
    pub values: Vec<Value>,
    /// Further values are driven between those that are listed until the least loss is found.
    #[serde(default = "yes")]
    pub refine: bool,
    /// What the losses are summed by.
    #[serde(default)]
    pub by: By,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

fn yes() -> bool {
    true
}
