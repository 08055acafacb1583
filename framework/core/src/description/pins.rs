//! What the load sharing of planets is calculated from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Position errors, play and stiffness of planets, from which their load sharing is calculated at every torque. For sets of one planet body in
/// mesh with two gears on the central axis.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct PinsEntry {
    /// Tangential position error of each pin on the carrier, positive towards positive turns of the carrier; in the order in which the planets
    /// follow each other in this sense. [um]
    #[schemars(inner(range(min = -5000.0, max = 5000.0)), length(min = 2))]
    pub errors: Vec<f64>,
    /// Radial play of each planet on its pin, half of that of the diameters; default: none. [um]
    #[serde(default)]
    #[schemars(inner(range(min = 0.0, max = 5000.0)))]
    pub clearances: Vec<f64>,
    /// Radial stiffness of one pin with its bearings against the carrier; default: rigid. [N/um]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub stiffness: Option<f64>,
    /// Stiffness of the rim of a ring gear at one mesh along the line of action, without its teeth; default: rigid. [N/um]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub rim_stiffness: Option<f64>,
    /// Stiffness of meshes of one planet that are not those of ISO 6336-1 by default.
    #[serde(default)]
    pub meshes: Vec<MeshStiffness>,
    /// Sun, ring or carrier that can move across the axis; all others are held.
    #[serde(default)]
    pub floating: Vec<FloatingMember>,
}

/// Stiffness of one mesh of a planet.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct MeshStiffness {
    /// The mesh.
    #[schemars(extend("x-refers-to" = "meshes"))]
    pub mesh: String,
    /// Mean stiffness of the teeth in mesh along the transverse line of action, over the whole face width. [N/um]
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub stiffness: f64,
}

/// A member of the set that can move across the axis.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct FloatingMember {
    /// Sun, ring or carrier.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub shaft: String,
    /// Radial stiffness of its bearings or of what centres it, at the set; default: zero, it floats freely. [N/um]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub stiffness: f64,
}
