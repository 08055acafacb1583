//! Shafts and the external loads on them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shaft, a carrier or a planet body.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ShaftEntry {
    /// Axis in the housing. None for a planet body, whose axis moves with its carrier.
    pub axis: Option<AxisEntry>,
    /// Mass including all that is fixed to the shaft; its weight loads the bearings. [kg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub mass: f64,
    /// Position of the centre of mass along the shaft; required with a mass. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub mass_at: Option<f64>,
    /// Sections with their diameters; required if more than two bearings support the shaft, or a hinge or a tilting stiffness is
    /// stated.
    #[serde(default)]
    pub sections: Vec<SectionEntry>,
    /// Includes the shear deflection (Timoshenko) in addition to bending.
    #[serde(default)]
    pub shear_deformation: bool,
    /// Positions of hinges along the shaft. [mm]
    #[serde(default)]
    #[schemars(inner(range(min = -1e5, max = 1e5)))]
    pub hinges: Vec<f64>,
    /// External forces.
    #[serde(default)]
    pub loads: Vec<LoadEntry>,
    /// `none` for a loaded shaft without bearings in this description: it has no bearing loads and no bearing losses.
    pub bearings: Option<Unsupported>,
}

/// The axis of a shaft.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum AxisEntry {
    /// Along x, as most shafts: y and z, z upwards. [mm]
    AlongX(#[schemars(inner(range(min = -1e5, max = 1e5)))] [f64; 2]),
    /// In any direction.
    Directed(DirectedAxis),
}

/// An axis in any direction; positions along the shaft count from `through`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DirectedAxis {
    /// Point on the axis, x, y and z, at which positions along the shaft are zero. [mm]
    #[schemars(inner(range(min = -1e5, max = 1e5)))]
    pub through: [f64; 3],
    /// Direction in which positions count and about which speeds are positive; of any length. [-]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub direction: [f64; 3],
}

/// States that a shaft or an idler gear has no bearings in a description; otherwise a loaded one without bearings is an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Unsupported {
    /// No bearings: no bearing loads and no bearing losses.
    None,
}

/// A section of a shaft with constant diameters.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct SectionEntry {
    /// Start of the section. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub from: f64,
    /// End of the section. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub to: f64,
    /// Outer diameter. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub outer: f64,
    /// Inner diameter. [mm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub inner: f64,
}

/// An external force and moment on a shaft, fixed in the housing.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct LoadEntry {
    /// Position along the shaft. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
    /// Force: x, y, z upwards; x is along the shafts unless their axes have a direction. [N]
    #[serde(default)]
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub force: [f64; 3],
    /// Bending moment about y and about z; of an axis with a direction about both directions across it, the second as far upwards as
    /// possible. [Nm]
    #[serde(default)]
    #[schemars(inner(range(min = -1e9, max = 1e9)))]
    pub moment: [f64; 2],
}
