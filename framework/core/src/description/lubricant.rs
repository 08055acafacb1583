//! Oils, and greases by their base oils.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults::default_one;

/// An oil with its friction properties; models use them and may override them.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct LubricantEntry {
    /// Designation in a catalogue of lubricants, such as `ISO VG 100 PAO`; fills the omitted keys.
    #[schemars(extend("x-refers-to" = "catalogue"))]
    pub designation: Option<String>,
    /// Kind; selects typical properties. Default: that of the catalogue, else mineral.
    pub kind: Option<LubricantKind>,
    /// Viscosity over temperature; default: that of the catalogue.
    pub viscosity: Option<ViscosityEntry>,
    /// Density at a reference temperature; default: that of the catalogue, else by kind.
    pub density: Option<DensityEntry>,
    /// How viscosity increases with pressure.
    #[serde(default)]
    pub pressure_viscosity: PressureViscosityEntry,
    /// Thermal conductivity; default: according to Cragoe for petroleum oils. [W/(m K)]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub conductivity: Option<f64>,
    /// Specific heat; default: according to Cragoe for petroleum oils. [J/(kg K)]
    #[schemars(range(min = 500.0, max = 5000.0))]
    pub heat_capacity: Option<f64>,
    /// Coefficient of boundary friction in rolling bearings; default: that of the model. [-]
    #[schemars(range(min = 0.01, max = 0.3))]
    pub mu_bl: Option<f64>,
    /// Coefficient of full-film friction in rolling bearings; default: by kind: 0.05 mineral, 0.04 synthetic, 0.1
    /// transmission fluid. [-]
    #[schemars(range(min = 0.001, max = 0.2))]
    pub mu_ehl: Option<f64>,
    /// Lubricant factor of mean mesh friction; default: by kind: 1 mineral and transmission fluid, 0.8
    /// polyalphaolefin and ester, 0.75 polyglycol. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
    /// Behaviour in a contact, for friction laws that need it.
    pub rheology: Option<RheologyEntry>,
    /// Makes the lubricant a grease, also without keys: `grease: {}`. All other values are then those of its base oil, which every model takes: a
    /// grease has no level, and no law of its churning by gears is known.
    pub grease: Option<GreaseEntry>,
}

/// What makes a grease of its base oil.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
pub struct GreaseEntry {
    /// Consistency class according to NLGI (DIN 51818), in quotes. `check` compares it with those of rolling bearings, 1 to 3; no law depends on it.
    pub consistency: Option<Consistency>,
}

/// Consistency class of a grease according to NLGI, from nearly fluid to very stiff.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub enum Consistency {
    /// Nearly fluid.
    #[serde(rename = "000")]
    Fluid,
    /// Semi-fluid.
    #[serde(rename = "00")]
    SemiFluid,
    /// Very soft.
    #[serde(rename = "0")]
    VerySoft,
    /// Soft.
    #[serde(rename = "1")]
    Soft,
    /// The most common one.
    #[serde(rename = "2")]
    Medium,
    /// Stiff.
    #[serde(rename = "3")]
    Stiff,
    /// Very stiff.
    #[serde(rename = "4")]
    VeryStiff,
    /// Hard.
    #[serde(rename = "5")]
    Hard,
    /// Block grease.
    #[serde(rename = "6")]
    Block,
}

impl Consistency {
    /// Whether such a grease stays in a rolling bearing and still gives off its oil: classes 1 to 3.
    pub fn suits_rolling_bearings(self) -> bool {
        (Self::Soft..=Self::Stiff).contains(&self)
    }
}

/// Behaviour of an oil under the pressure and shear of a contact, from traction curves and a Stribeck curve.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
pub struct RheologyEntry {
    /// Eyring stress, above which the oil is shear-thinning; typically 3 to 8. [MPa]
    #[schemars(range(min = 0.1, max = 50.0))]
    pub tau0: Option<f64>,
    /// Exponent of Roelands' law over pressure; default: the one that reproduces the oil's pressure-viscosity coefficient at 40
    /// degC. Film thicknesses take the coefficient that follows from it, unless `pressure_viscosity.value` is stated. [-]
    #[schemars(range(min = 0.1, max = 1.5))]
    pub z: Option<f64>,
    /// Slope of the limiting shear stress over mean pressure: the maximum traction at high pressure; typically 0.05 to 0.06 for
    /// polyalphaolefins, 0.07 to 0.09 for mineral oils. [-]
    #[schemars(range(min = 0.005, max = 0.2))]
    pub limiting_slope: Option<f64>,
    /// Effective shear modulus of film and surfaces; default: that of the model. [GPa]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub shear_modulus: Option<f64>,
    /// Coefficient of boundary friction between flanks. [-]
    #[schemars(range(min = 0.01, max = 0.5))]
    pub mu_b: Option<f64>,
}

/// Kind of an oil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LubricantKind {
    /// Mineral oil.
    #[default]
    Mineral,
    /// Polyalphaolefin.
    Polyalphaolefin,
    /// Ester.
    Ester,
    /// Polyglycol.
    Polyglycol,
    /// Transmission fluid.
    TransmissionFluid,
}

/// Viscosity over temperature: two of kv40, kv100 and vi, or two or three points.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ViscosityEntry {
    /// Kinematic viscosity at 40 degC. [mm2/s]
    #[schemars(range(min = 0.3, max = 1e5))]
    pub kv40: Option<f64>,
    /// Kinematic viscosity at 100 degC. [mm2/s]
    #[schemars(range(min = 0.3, max = 1e4))]
    pub kv100: Option<f64>,
    /// Dynamic viscosity at 40 degC instead of `kv40`; needs the oil's density. [mPa s]
    #[schemars(range(min = 0.2, max = 1e5))]
    pub eta40: Option<f64>,
    /// Dynamic viscosity at 100 degC instead of `kv100`; needs the oil's density. [mPa s]
    #[schemars(range(min = 0.2, max = 1e4))]
    pub eta100: Option<f64>,
    /// Viscosity index; negative for oils that thin faster than the reference oils, such as naphthenic ones. [-]
    #[schemars(range(min = -200.0, max = 400.0))]
    pub vi: Option<f64>,
    /// Two points, or three for the law of Vogel, instead of the values above.
    #[serde(default)]
    #[schemars(length(max = 3))]
    pub points: Vec<ViscosityPoint>,
    /// Law between and beyond the points.
    #[serde(default)]
    pub law: ViscosityLaw,
    /// Constant C of the law of Vogel through two points; three points determine it. [-]
    #[serde(default = "vogel_c")]
    #[schemars(range(min = 50.0, max = 300.0))]
    pub vogel_c: f64,
    /// Factor on the viscosity at every temperature, for a sheared, diluted or oxidised oil, or for identification. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub factor: f64,
}

impl Default for ViscosityEntry {
    fn default() -> Self {
        Self {
            kv40: None,
            kv100: None,
            eta40: None,
            eta100: None,
            vi: None,
            points: Vec::new(),
            law: ViscosityLaw::default(),
            vogel_c: vogel_c(),
            factor: default_one(),
        }
    }
}

/// Constant C of Vogel that is typical for mineral gear oils.
fn vogel_c() -> f64 {
    95.0
}

/// Viscosity at one temperature: `value` or `dynamic`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct ViscosityPoint {
    /// Temperature. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub at: f64,
    /// Kinematic viscosity. [mm2/s]
    #[schemars(range(min = 0.3, max = 1e7))]
    pub value: Option<f64>,
    /// Dynamic viscosity; needs the oil's density. [mPa s]
    #[schemars(range(min = 0.2, max = 1e7))]
    pub dynamic: Option<f64>,
}

/// Law of viscosity over temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ViscosityLaw {
    /// ASTM D341 with the constant 0.7, from 2 mm2/s.
    #[default]
    AstmD341,
    /// DIN 51563 with the constant 0.8; differs by about 2 % at 0 degC and not between the two points.
    Din51563,
    /// ASTM D341 for thin oils, from 0.21 mm2/s.
    AstmD341Low,
    /// Vogel: exponential over 1/(t + C).
    Vogel,
}

/// Density at one temperature.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct DensityEntry {
    /// Temperature. [degC]
    #[serde(default = "fifteen")]
    #[schemars(range(min = -50.0, max = 150.0))]
    pub at: f64,
    /// Density; default: by kind: 900 mineral, 855 polyalphaolefin, 915 ester, 1059 polyglycol, 850 transmission fluid. [kg/m3]
    #[schemars(range(min = 500.0, max = 1300.0))]
    pub value: Option<f64>,
    /// Decrease with temperature.
    #[serde(default)]
    pub law: DensityLaw,
    /// Relative decrease of the density per degree, for the linear law; default: by kind. [1/K]
    #[schemars(range(min = 0.0, max = 0.002))]
    pub expansion: Option<f64>,
}

/// Decrease of density with temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DensityLaw {
    /// By a constant share per degree.
    #[default]
    Linear,
    /// By 0.7 kg/m3 per degree, the short form of DIN 51757.
    Din51757,
    /// By the lubricant tables of the API.
    Api,
}

fn fifteen() -> f64 {
    15.0
}

impl Default for DensityEntry {
    fn default() -> Self {
        Self {
            at: fifteen(),
            value: None,
            law: DensityLaw::default(),
            expansion: None,
        }
    }
}

/// How viscosity increases with pressure.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
pub struct PressureViscosityEntry {
    /// Correlation.
    #[serde(default)]
    pub law: PressureViscosityLaw,
    /// The coefficient itself, instead of a correlation, at every temperature. Film thicknesses take it, also beside `rheology.z`, which
    /// then applies to the viscosity inside the film. [1/GPa]
    #[schemars(range(min = 1.0, max = 60.0))]
    pub value: Option<f64>,
}

/// Correlation of the pressure-viscosity coefficient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PressureViscosityLaw {
    /// Gold, by kind of oil.
    #[default]
    Gold,
    /// So and Klaus, from viscosity, its slope and density.
    SoKlaus,
    /// Wooster, from viscosity only.
    Wooster,
}
