//! The gearbox as it is going to be written: entries with their comments, in the units of gearbox files.

use gearloss_framework::material::SOFTEST_METAL;

/// A gearbox.
#[derive(Debug, Default)]
pub struct Draft {
    pub title: String,
    pub source: String,
    /// Lines of the head, without `# `.
    pub head: Vec<String>,
    pub ports: Vec<Port>,
    pub rating: Option<(f64, f64)>,
    pub shafts: Vec<Shaft>,
    pub gears: Vec<Gear>,
    pub meshes: Vec<Mesh>,
    pub crossed: Vec<CrossedMesh>,
    pub sets: Vec<Set>,
    pub couplings: Vec<Coupling>,
    /// Gear and its engaged couplings.
    pub states: Vec<(String, Vec<String>)>,
    pub bearings: Vec<Bearing>,
    pub lubricants: Vec<Lubricant>,
    /// Oil of the housing.
    pub sump: String,
    pub oil_temperature: Option<f64>,
    /// Heat transfer of the housing: area in cm2, coefficient in W/(m2 K).
    pub heat: Option<(f64, f64)>,
    /// Values that the file does not have, and why: paths, reason.
    pub assumed: Vec<(Vec<String>, String)>,
    /// Tables of loads on the teeth, by the name of their file.
    pub shares: Vec<(String, String)>,
    /// Sections that come from the file.
    pub from_file: Vec<&'static str>,
    /// Lines at the end, without `# `.
    pub report: Vec<String>,
}

#[derive(Debug)]
pub struct Port {
    pub name: String,
    pub shaft: String,
}

/// The axis of a shaft. \[mm\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Axis {
    /// Along x: y and z.
    AlongX([f64; 2]),
    /// A point and a direction.
    Directed([f64; 3], [f64; 3]),
}

#[derive(Debug, Default)]
pub struct Shaft {
    pub id: String,
    pub comment: String,
    pub axis: Option<Axis>,
    pub sections: Vec<Section>,
    pub mass: Option<(f64, f64)>,
    pub loads: Vec<Load>,
    /// Without bearings in this description.
    pub unsupported: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    pub from: f64,
    pub to: f64,
    pub outer: f64,
    pub inner: f64,
}

#[derive(Debug)]
pub struct Load {
    pub comment: String,
    pub at: f64,
    pub force: [f64; 3],
    pub moment: [f64; 2],
}

#[derive(Debug)]
pub struct Gear {
    pub id: String,
    pub comment: String,
    pub shaft: String,
    /// None where it follows from the teeth.
    pub at: Option<f64>,
    pub z: i64,
    pub facewidth: f64,
    pub ring: bool,
    /// Turns on its shaft until a coupling connects it.
    pub loose: bool,
    pub hand: Option<&'static str>,
    pub faces: Option<&'static str>,
    pub profile_shift: Option<f64>,
    pub tip_diameter: Option<f64>,
    pub root_diameter: Option<f64>,
    pub ra: Option<f64>,
}

#[derive(Debug)]
pub struct Mesh {
    pub id: String,
    pub comment: String,
    pub gears: [String; 2],
    pub normal_module: f64,
    pub pressure_angle: f64,
    pub helix_angle: f64,
    pub centre_distance: Option<f64>,
    pub modulus: Option<f64>,
    pub poisson: Option<f64>,
    /// Materials of both gears, if they differ or are soft.
    pub materials: Option<[Material; 2]>,
    pub lubricant: Option<String>,
    /// File with the loads on its teeth.
    pub shares: Option<String>,
}

/// Material of a gear.
#[derive(Debug, Clone)]
pub struct Material {
    pub id: String,
    pub comment: String,
    pub modulus: f64,
    pub poisson: f64,
}

impl Material {
    /// True if no metal of gears has such a Young's modulus.
    pub fn is_soft(&self) -> bool {
        self.modulus * 1e9 < SOFTEST_METAL
    }
}

/// A pair on axes that cross.
#[derive(Debug)]
pub struct CrossedMesh {
    /// Section of the gearbox file.
    pub section: &'static str,
    pub id: String,
    pub comment: String,
    pub gears: [String; 2],
    /// Keys and their values as text.
    pub keys: Vec<(&'static str, String)>,
    pub lubricant: Option<String>,
}

#[derive(Debug)]
pub struct Set {
    pub id: String,
    pub comment: String,
    pub carrier: String,
    pub planets: Vec<String>,
    pub count: usize,
}

#[derive(Debug)]
pub struct Coupling {
    pub id: String,
    pub comment: String,
    pub between: [String; 2],
}

#[derive(Debug, Default)]
pub struct Bearing {
    pub id: String,
    pub comment: String,
    pub shaft: String,
    pub outer: Option<String>,
    pub at: f64,
    pub axial: &'static str,
    /// Share of the thrust, if several bearings take it.
    pub axial_share: Option<f64>,
    /// Supports a shaft alone.
    pub takes_moment: bool,
    pub designation: Option<String>,
    pub kind: Option<&'static str>,
    pub series: Option<String>,
    pub bore: Option<f64>,
    pub outside: Option<f64>,
    pub width: Option<f64>,
    pub c: Option<f64>,
    pub c0: Option<f64>,
    pub e: Option<f64>,
    pub y: Option<f64>,
    pub y0: Option<f64>,
    pub pu: Option<f64>,
    pub radial_stiffness: Option<f64>,
    pub tilting_stiffness: Option<f64>,
    pub lubrication: Option<&'static str>,
    pub oil_height: Option<f64>,
    pub lubricant: Option<String>,
    /// Oil film of a plain bearing.
    pub film: Option<Film>,
    /// Its own model; none is that of `models`.
    pub model: Option<&'static str>,
    /// A designation of the catalogue in the name of a bearing that states none.
    pub known: Option<String>,
}

#[derive(Debug)]
pub struct Film {
    pub relative_clearance: f64,
    /// \[um\]
    pub least_thickness: f64,
}

#[derive(Debug, Default)]
pub struct Lubricant {
    pub id: String,
    pub comment: String,
    pub designation: Option<String>,
    pub kind: Option<&'static str>,
    pub kv40: Option<f64>,
    pub kv100: Option<f64>,
    /// Temperature and viscosity.
    pub points: Vec<(f64, f64)>,
    /// At 15 degC.
    pub density: Option<f64>,
    pub heat_capacity: Option<f64>,
    pub conductivity: Option<f64>,
    /// The values are those of the base oil of a grease.
    pub is_grease: bool,
}
