//! Keys of the entry of every component, in addition to those of its attachment and its part.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::description::{MeshCommon, OilOfComponent};

/// Common keys of every component, independent of its mechanism.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
pub struct Common {
    /// Oil; default: that of the housing.
    #[schemars(extend("x-refers-to" = "lubricants"))]
    pub lubricant: Option<String>,
    /// Oil temperature at the component minus that of the sump. [K]
    #[serde(default)]
    #[schemars(range(min = -200.0, max = 200.0))]
    pub temperature_offset: f64,
    /// Factor on the loss of the model, for effects that the model does not include. An identification may fit it. [-]
    #[serde(default = "whole")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Number of equal components at this position; each carries the full load of the position. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
}

impl Common {
    /// The common keys of an entry that states them itself; its count is one.
    pub fn of(oil: &OilOfComponent, loss_factor: f64) -> Self {
        Self {
            lubricant: oil.lubricant.clone(),
            temperature_offset: oil.temperature_offset,
            loss_factor,
            count: 1,
        }
    }
}

impl From<&MeshCommon> for Common {
    fn from(mesh: &MeshCommon) -> Self {
        Self::of(&mesh.oil, mesh.loss_factor)
    }
}

fn default_one() -> u32 {
    1
}

fn whole() -> f64 {
    1.0
}
