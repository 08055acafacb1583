//! A quantity of a gearbox and its range.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use crate::varied::Tie;

/// One quantity and its range: `plus_minus`, `percent`, or `from` and `to`; or several `paths` that move together along the rows of `values`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct RangeEntry {
    /// Resolved path; with `*` all matches change together.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: Option<String>,
    /// Several paths instead of one, which move together along `values`.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// Rows with a value for each of `paths`: `[[24, 83], [30, 77]]`. The first value of the rows increases or decreases; between two rows all
    /// values are linear in it, and with a whole number among the paths the nearest row is used.
    #[serde(default)]
    pub values: Vec<Vec<Value>>,
    /// How several quantities change together.
    #[serde(default)]
    pub tie: Tie,
    /// Half width of the range about the value of the gearbox, as a quantity of the path: `0.1 um`.
    pub plus_minus: Option<Value>,
    /// The same in percent of the value of the gearbox. [%]
    #[schemars(range(min = 1e-9, max = 1000.0))]
    pub percent: Option<f64>,
    /// Lower end of the range.
    pub from: Option<Value>,
    /// Upper end of the range.
    pub to: Option<Value>,
}

impl RangeEntry {
    /// The path as written, or several.
    pub fn words(&self) -> String {
        self.path.clone().unwrap_or_else(|| self.paths.join(", "))
    }
}
