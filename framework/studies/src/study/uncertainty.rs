//! What uncertain inputs do to losses and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameters::NameOr;
use super::{RangeEntry, Write};

/// What uncertain inputs do to efficiency, loss and temperature over a grid: every input is drawn from its distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct UncertaintyEntry {
    /// Gearbox; absent, the first.
    pub gearbox: Option<String>,
    /// Grid, of one gear state.
    pub grid: String,
    /// Sets of models; absent, the models of the gearbox. `PRODUCT/SET` takes another gearbox, `PRODUCT/own` its own models.
    #[serde(default)]
    pub model_sets: Vec<String>,
    /// The uncertain inputs. A name takes over a parameter of the study, evenly distributed.
    #[schemars(length(min = 1), with = "Vec<NameOr<ToleranceEntry>>")]
    pub inputs: Vec<ToleranceEntry>,
    /// Number of samples; powers of two fill the ranges most evenly. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: u32,
    /// Formats to write; absent, CSV, JSON and SVG.
    #[serde(default = "Write::all")]
    pub write: Vec<Write>,
}

fn samples() -> u32 {
    256
}

/// One uncertain input: `plus_minus`, `percent`, or `from` and `to`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ToleranceEntry {
    /// The quantity and its range.
    #[serde(flatten)]
    pub range: RangeEntry,
    /// How values lie in the range.
    #[serde(default)]
    pub distribution: Shape,
}

/// How values lie in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// All are as likely.
    #[default]
    Uniform,
    /// Normal: the range holds 95 % of the values; those beyond the range of the schema are moved onto it.
    Normal,
    /// The value of the gearbox is the likeliest, the ends are not reached.
    Triangular,
}
