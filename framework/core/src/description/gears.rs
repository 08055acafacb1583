//! Gears, meshes, planetary sets and differentials.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults::default_one;
use super::every_mesh::{MeshCommon, MeshMetal, OilOfComponent};
use super::housing::WallClearance;
use super::pins::PinsEntry;
use super::shafts::Unsupported;
use super::shift_sign::ShiftSign;
use crate::contact::sharing::modification::FlankModification;
use crate::mechanism::clutch::Clutch;
use crate::mechanism::differential::{Differential, DifferentialGears};
use crate::mechanism::gear_drag::GearDrag;
use crate::mechanism::gear_mesh::GearMesh;
use crate::mechanism::planetary_drag::PlanetaryDrag;
use crate::mechanism::{ModelRef, NamedSlots};

/// A gear.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct GearEntry {
    /// Shaft, carrier or planet body that carries the gear.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub shaft: String,
    /// Middle of the face width along the shaft. Gears on axes that cross have the position of their mean point, which follows; if it is
    /// stated, it is compared. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
    /// Number of teeth, of a worm that of its threads; also positive for ring gears. Cylindrical and bevel gears have at least 5. [-]
    #[schemars(range(min = 1, max = 2000), extend("x-also-called" = ["teeth", "number_of_teeth"]))]
    pub z: u32,
    /// Face width. [mm]
    #[schemars(range(min = 0.1, max = 2000.0), extend("x-also-called" = ["width"]))]
    pub facewidth: f64,
    /// Hand of the helix; that of the mate follows. Not needed for spur gears. Of a bevel gear: right if its teeth turn clockwise outwards,
    /// seen from the apex.
    pub hand: Option<Hand>,
    /// Side to which a bevel gear faces, that of its apex; default: `start`.
    pub faces: Option<Faces>,
    /// External teeth, or a ring gear with internal teeth.
    #[serde(default)]
    pub kind: GearKind,
    /// Profile shift coefficient; default: the value that matches the centre distance. For a ring gear see `profile_shift_sign`. [-]
    #[schemars(range(min = -3.0, max = 3.0))]
    pub profile_shift: Option<f64>,
    /// Sign of a ring gear's `profile_shift`; default: `outward`, with a warning. No effect for external teeth.
    pub profile_shift_sign: Option<ShiftSign>,
    /// Fixed to the shaft, or an idler gear that a coupling connects.
    #[serde(default)]
    pub mounted: Mounting,
    /// `none` for an idler gear without bearings in this description: it has no bearing loads and no bearing losses.
    pub bearings: Option<Unsupported>,
    /// Tip diameter; default: that of the standard basic rack. Required for ring gears, unless no model uses the tooth geometry.
    /// [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub tip_diameter: Option<f64>,
    /// Root diameter; default: that of the standard basic rack. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub root_diameter: Option<f64>,
    /// Flanks; default: those of the gearbox.
    pub surface: Option<Surface>,
    /// Material: a name of `materials`, or a designation of the catalogue. Default: that of its mesh.
    #[schemars(extend("x-refers-to" = "materials"))]
    pub material: Option<String>,
    /// Reliefs, crowning, slopes and pitch error of the flanks of a cylindrical gear, for `load_sharing: { type: slices }`.
    pub modification: Option<FlankModification>,
    /// Diameter of the bore of a cylindrical gear, or of the shaft below its rim, for `stiffness: sainsot` of thin slices. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub bore: Option<f64>,
    /// Oil height above the gear's axis, if it runs in a separate oil pocket. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub level: Option<f64>,
    /// Gap between this gear and a baffle, shroud or wall near it, for drag models that have one; default: that of the housing.
    pub clearance: Option<WallClearance>,
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Factor on the drag losses of the gear, for effects that the model does not include; drags at a mesh use the mean of both
    /// gears. An identification may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Drag models of this gear by name; they replace those in `models`.
    pub drag: Option<NamedSlots<GearDrag>>,
}

/// Hand of a helix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Hand {
    /// Right-hand helix.
    Right,
    /// Left-hand helix.
    Left,
}

/// Side of the apex of a bevel gear along its shaft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Faces {
    /// Towards smaller positions: the shaft runs from apex to base.
    #[default]
    Start,
    /// Towards larger positions.
    End,
}

/// External or internal teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GearKind {
    /// External teeth.
    #[default]
    External,
    /// Internal teeth.
    Ring,
}

/// Connection of a gear to its shaft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mounting {
    /// Rotates with the shaft.
    #[default]
    Fixed,
    /// Idler gear: rotates freely until a coupling connects it.
    Loose,
}

/// Roughness of flanks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Surface {
    /// Arithmetic mean roughness of one flank. [um]
    #[schemars(range(min = 0.001, max = 50.0))]
    pub ra: f64,
    /// Root mean square roughness of one flank; default: 1.25 times `ra`. [um]
    #[schemars(range(min = 0.001, max = 50.0))]
    pub rq: Option<f64>,
}

/// Two cylindrical gears in mesh, on parallel axes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MeshEntry {
    /// First and second gear. A ring gear is the second.
    #[schemars(extend("x-refers-to" = "gears"))]
    pub gears: [String; 2],
    /// Normal module. [mm]
    #[schemars(range(min = 0.05, max = 100.0), extend("x-also-called" = ["module"]))]
    pub normal_module: f64,
    /// Normal pressure angle. [deg]
    #[serde(default = "twenty_degrees")]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Helix angle at the reference circle; zero for spur gears. [deg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub helix_angle: f64,
    /// Working centre distance; default: that of the axes or of the profile shifts. [mm]
    #[schemars(range(min = 0.5, max = 1e5))]
    pub centre_distance: Option<f64>,
    /// Double-helical gears: the axial forces of both halves cancel.
    #[serde(default)]
    pub double_helical: bool,
    /// Elasticity of its gears.
    #[serde(flatten)]
    pub metal: MeshMetal,
    /// Misalignment of the flanks over the face width, such as from bores, for `load_sharing: { type: slices }`; positive if the end
    /// of the face opens. [um]
    #[serde(default)]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub misalignment: f64,
    /// Adds the misalignment by the deflection of both shafts and the stiffness of their bearings at the load, for `load_sharing: { type:
    /// slices }`; requires `sections` of both shafts and a `rating`. The shift of the resultant force at the rating enters the loads of the
    /// bearings.
    #[serde(default)]
    pub shaft_deflection: bool,
    /// Tip shortening maintains the tip clearance of external gears with profile shift.
    #[serde(default = "yes")]
    pub tip_shortening: bool,
    /// Oil and factor on the loss.
    #[serde(flatten)]
    pub common: MeshCommon,
    /// Loss model of the mesh; default: that of `models`.
    pub model: Option<ModelRef<GearMesh>>,
    /// Drag models of this mesh by name; they replace those in `models`.
    pub drag: Option<NamedSlots<GearDrag>>,
}

fn twenty_degrees() -> f64 {
    20.0_f64.to_radians()
}

fn yes() -> bool {
    true
}

/// Planets on a carrier.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct PlanetarySetEntry {
    /// Shaft of the carrier.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub carrier: String,
    /// Number of equal, equally spaced planets: their transverse forces on central members cancel if they share the load equally. [-]
    #[schemars(range(min = 2, max = 50))]
    pub count: u32,
    /// Load sharing among the planets, K_gamma: load of the most loaded planet over the mean; the others share the rest equally. Default: 1.
    /// The losses of meshes and bearings on the planets are means over the planets. Instead of it, `pins` calculates the sharing. [-]
    #[schemars(range(min = 1.0, max = 50.0))]
    pub load_sharing: Option<f64>,
    /// Position errors of the pins, play and stiffness, from which the load sharing is calculated.
    pub pins: Option<PinsEntry>,
    /// Shafts that are the planet bodies; each represents all of its equal copies.
    #[schemars(length(min = 1))]
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub planets: Vec<String>,
    /// Reference shaft of the drag model, which takes its moment, such as the input; default: the carrier. A table over its speed is
    /// valid for the ratio to the carrier at which it was made.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub reference: Option<String>,
    /// Size of the gearbox in its family, for drag tables with that axis. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub size: Option<f64>,
    /// Ratio of the gearbox in its family, for drag tables with that axis. [-]
    #[schemars(range(min = 0.001, max = 10000.0))]
    pub ratio: Option<f64>,
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Factor on the drag loss of the set, for effects that the model does not include. An identification may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Drag model of the carrier with its planets; default: that of `models`.
    pub model: Option<ModelRef<PlanetaryDrag>>,
}

/// A differential: the speeds of both sides relative to the case add up to zero. Without a `model` its gears have no friction.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct DifferentialEntry {
    /// Shaft that is the case.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub case: String,
    /// Left side shaft.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub left: String,
    /// Right side shaft.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub right: String,
    /// The difference of the speeds of both sides follows from `speed_difference` unless a point prescribes their speeds; `false` if every
    /// point prescribes them.
    #[serde(default = "yes")]
    pub equal_speeds: bool,
    /// Speed of the left side minus that of the right one, over the mean of both, as in a corner: track width over the radius of the
    /// corner if the right wheel is inside. Zero: both sides have equal speed. For ports of `wheels`, state `wheel_speeds`. [-]
    #[serde(default)]
    #[schemars(range(min = -2.0, max = 2.0))]
    pub speed_difference: f64,
    /// The gears inside, for models of their friction.
    pub gears: Option<DifferentialGears>,
    /// Friction between both sides that does not depend on torque, as of a limited slip differential with springs or preloaded discs (the
    /// moment of one side against the case), or of a viscous lock.
    pub locking: Option<ModelRef<Clutch>>,
    /// Its oil.
    #[serde(flatten)]
    pub oil: OilOfComponent,
    /// Factor on the losses, for effects that the models do not include. An identification may fit it. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub loss_factor: f64,
    /// Model of the friction of the gears; default: that of `models`, else none.
    pub model: Option<ModelRef<Differential>>,
}
