//! Meshes of gears whose axes cross: bevel and hypoid pairs, worms, crossed helical pairs.
//!
//! Shaft angle, offset and ratio follow from the axes and the teeth.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bevel_teeth::BevelTeeth;
use super::defaults::default_one;
use super::every_mesh::{MeshCommon, MeshMetal};
use crate::geometry::WormProfile;
use crate::mechanism::ModelRef;
use crate::mechanism::bevel_mesh::BevelMesh;
use crate::mechanism::crossed_helical_mesh::CrossedHelicalMesh;
use crate::mechanism::worm_mesh::{WheelMaterial, WormLubrication, WormMesh};

/// A pair of bevel gears, or of hypoid gears if the axes do not intersect.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct BevelMeshEntry {
    /// Pinion and wheel.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gears: [String; 2],
    /// The teeth.
    #[serde(flatten)]
    pub teeth: BevelTeeth,
    /// Shaft angle; only compared with that of the axes. [deg]
    #[schemars(range(min = 0.0, max = 180.0))]
    pub shaft_angle: Option<f64>,
    /// Hypoid offset; only compared with the distance of the axes. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub offset: Option<f64>,
    /// Distances of the mean points of pinion and wheel from the crossing point of the axes, along their axes; only compared. [mm]
    #[schemars(inner(range(min = -1e4, max = 1e4)))]
    pub mounting_distance: Option<[f64; 2]>,
    /// Elasticity of its gears.
    #[serde(flatten)]
    pub metal: MeshMetal,
    /// Oil and factor on the loss.
    #[serde(flatten)]
    pub common: MeshCommon,
    /// Loss model of the mesh; default: that of `models`.
    pub model: Option<ModelRef<BevelMesh>>,
}

/// A gear of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpiralAngleOf {
    /// The pinion.
    #[default]
    Pinion,
    /// The wheel.
    Wheel,
}

/// Pressure angles of the flanks of a bevel or hypoid pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FlankAngles {
    /// Nominal design pressure angle of the drive flank: concave of the pinion, convex of the wheel. [deg]
    #[serde(default = "twenty_degrees")]
    #[schemars(range(min = 5.0, max = 40.0))]
    pub drive: f64,
    /// Nominal design pressure angle of the coast flank. [deg]
    #[serde(default = "twenty_degrees")]
    #[schemars(range(min = 5.0, max = 40.0))]
    pub coast: f64,
    /// Share of the limit pressure angle that the cutter contains: 1 of most hypoid pairs, 0 of others. No effect where the axes
    /// intersect, because the limit pressure angle is zero. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub limit_factor: f64,
}

impl Default for FlankAngles {
    fn default() -> Self {
        Self {
            drive: twenty_degrees(),
            coast: twenty_degrees(),
            limit_factor: 1.0,
        }
    }
}

fn twenty_degrees() -> f64 {
    20.0_f64.to_radians()
}

/// The cutter of a hypoid pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CutterEntry {
    /// Radius of the cutter. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub radius: f64,
    /// Number of blade groups for face hobbing; 0 for face milling. [-]
    #[serde(default)]
    #[schemars(range(min = 0, max = 100))]
    pub blade_groups: u32,
}

/// Place of the mean point along the face of the wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CalculationPoint {
    /// As ISO 23509 method 1 places it, in the middle of the face of a first guess of the pitch angle: within some hundredths of a
    /// millimetre of the middle.
    #[default]
    Standard,
    /// In the middle of the face.
    MidFace,
}

/// Method of ISO 23509 by which a cutter determines the pitch cones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CuttingMethod {
    /// Method 1: the limit radius of the teeth is that of the cut.
    #[default]
    Gleason,
    /// Method 3: the cutter head rolls on both wheels.
    Klingelnberg,
}

/// Tooth depth of a bevel or hypoid pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DepthEntry {
    /// Mean working depth in mean normal modules, k_d. [-]
    #[serde(default = "usual_depth")]
    #[schemars(range(min = 0.5, max = 4.0))]
    pub working: f64,
    /// Clearance over the working depth, k_c. [-]
    #[serde(default = "usual_clearance")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub clearance: f64,
    /// Mean addendum of the wheel over the working depth, c_ham; default: 0.21 + 0.29/u^2, which decreases with the ratio u. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wheel_addendum: Option<f64>,
    /// Addendum angle of the wheel; zero for uniform depth. [deg]
    #[serde(default)]
    #[schemars(range(min = -10.0, max = 20.0))]
    pub addendum_angle: f64,
    /// Dedendum angle of the wheel; zero for uniform depth. [deg]
    #[serde(default)]
    #[schemars(range(min = -10.0, max = 20.0))]
    pub dedendum_angle: f64,
}

impl Default for DepthEntry {
    fn default() -> Self {
        Self {
            working: usual_depth(),
            clearance: usual_clearance(),
            wheel_addendum: None,
            addendum_angle: 0.0,
            dedendum_angle: 0.0,
        }
    }
}

fn usual_depth() -> f64 {
    2.0
}

fn usual_clearance() -> f64 {
    0.125
}

/// A worm with its wheel.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct WormMeshEntry {
    /// Worm and wheel. The `z` of the worm is its number of threads.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gears: [String; 2],
    /// Axial module of the worm m_x. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub module: f64,
    /// Reference diameter of the worm over the module, q; this or `worm_diameter` is stated. [-]
    #[schemars(range(min = 3.0, max = 100.0))]
    pub diameter_factor: Option<f64>,
    /// Reference diameter of the worm d_m1. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub worm_diameter: Option<f64>,
    /// Normal pressure angle. [deg]
    #[serde(default = "twenty_degrees")]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Profile of the threads.
    #[serde(default)]
    pub profile: WormProfile,
    /// Material of the rim of the wheel; default: the `worm_wheel` of its `material`, else tin bronze CuSn12.
    pub material: Option<WheelMaterial>,
    /// How oil comes to the mesh.
    #[serde(default)]
    pub lubrication: WormLubrication,
    /// Profile shift coefficient of the wheel; only compared with that of the axes. [-]
    #[schemars(range(min = -3.0, max = 3.0))]
    pub profile_shift: Option<f64>,
    /// Oil and factor on the loss.
    #[serde(flatten)]
    pub common: MeshCommon,
    /// Loss model of the mesh; default: that of `models`.
    pub model: Option<ModelRef<WormMesh>>,
}

/// Two cylindrical gears on axes that cross.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CrossedHelicalMeshEntry {
    /// First and second gear. Both state their `hand`, unless their helix angle is zero.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gears: [String; 2],
    /// Normal module. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub normal_module: f64,
    /// Normal pressure angle. [deg]
    #[serde(default = "twenty_degrees")]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Helix angles of both gears. Of equal hands they add up to the angle between the axes, else their difference is that angle. [deg]
    #[schemars(inner(range(min = 0.0, max = 85.0)))]
    pub helix_angle: [f64; 2],
    /// Elasticity of its gears.
    #[serde(flatten)]
    pub metal: MeshMetal,
    /// Oil and factor on the loss.
    #[serde(flatten)]
    pub common: MeshCommon,
    /// Loss model of the mesh; default: that of `models`.
    pub model: Option<ModelRef<CrossedHelicalMesh>>,
}
