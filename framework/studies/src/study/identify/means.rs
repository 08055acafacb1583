//! Input of an identification from means over cycles.

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use crate::study::RideEntry;

/// A published or measured mean over cycles, as a value or as a range that may be open on one side: the loss, or with `relative_to` a ratio of losses.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MeanEntry {
    /// Cycles and settings of the simulation. The mean is over the time of all of them.
    pub drive: RideEntry,
    /// Values of the gearbox with which it was found, such as those of another oil: resolved path to value. No parameter changes them.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub set: Ordered<Value>,
    /// Mechanism whose loss it is, such as `gear_mesh`; default: `all`.
    #[schemars(extend("x-refers-to" = "mechanism"))]
    pub mechanism: Option<String>,
    /// The loss over which it is stated; what is not written there is as here.
    pub relative_to: Option<RelativeTo>,
    /// The value, in W or as a ratio: equivalent to a range without width.
    pub value: Option<Value>,
    /// Lower end of the range, in W or as a ratio; default: none.
    pub from: Option<Value>,
    /// Upper end of the range, in W or as a ratio; default: none.
    pub to: Option<Value>,
    /// Standard deviation of the value or of each end of the range, in W or as a ratio.
    pub accuracy: Value,
    /// Provenance.
    pub source: Option<String>,
}

/// The loss over which a mean is stated.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct RelativeTo {
    /// Other cycles or settings.
    pub drive: Option<RideEntry>,
    /// Other values of the gearbox, instead of those of the mean.
    #[schemars(extend("x-keys" = "path"))]
    pub set: Option<Ordered<Value>>,
    /// Another mechanism, or `all`.
    #[schemars(extend("x-refers-to" = "mechanism"))]
    pub mechanism: Option<String>,
}
