//! What the entries of several kinds of components have in common.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults::default_one;

/// The oil of a component.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct OilOfComponent {
    /// Oil; default: that of the housing.
    #[schemars(extend("x-refers-to" = "lubricants"))]
    pub lubricant: Option<String>,
    /// Oil temperature at the component minus that of the sump. [K]
    #[serde(default)]
    #[schemars(range(min = -200.0, max = 200.0))]
    pub temperature_offset: f64,
}

/// What the entries of all kinds of meshes state alike.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MeshCommon {
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Factor on the loss of the teeth in mesh, without drag losses, for effects that the model does not include. An identification
    /// may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
}

/// Elasticity of the gears of a mesh that name no material.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct MeshMetal {
    /// Young's modulus of the gears that name no `material`. [GPa]
    #[serde(default = "crate::mechanism::gear_mesh::steel")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub elastic_modulus: f64,
    /// Poisson's ratio of the gears that name no `material`. [-]
    #[serde(default = "crate::mechanism::gear_mesh::steel_poisson")]
    #[schemars(range(min = 0.0, max = 0.49))]
    pub poisson: f64,
}
