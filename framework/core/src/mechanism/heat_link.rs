//! Links between the nodes of a thermal network, by conduction, convection or radiation.

use schemars::JsonSchema;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use crate::loss::Undefined;
use crate::material::{Conductor, Material, MaterialKind};
use crate::mechanism::Mechanism;
use crate::mechanism::Scalar;
use crate::mechanism::heat_dissipation::HousingPart;
use crate::real::Real;
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum HeatLink {}

/// One link between two nodes of a thermal network.
///
/// The inputs are [`HeatLinkAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait HeatLinkModel: Send + Sync {
    /// Heat flow from one node to the other over their temperature difference, not negative. Pure; must not allocate. \[W/K\]
    ///
    /// # Errors
    /// If the formula is undefined.
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined>;
}

/// What heat models take from the material of a gear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GearMaterial {
    /// Kind.
    #[serde(default)]
    pub kind: MaterialKind,
    /// Thermal properties, if they are stated.
    pub thermal: Option<Conductor>,
}

impl From<Material> for GearMaterial {
    fn from(of: Material) -> Self {
        Self {
            kind: of.kind,
            thermal: of.thermal,
        }
    }
}

/// The gear named by a link.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GearShape {
    /// Number of teeth. [-]
    #[schemars(range(min = 1, max = 2000))]
    pub teeth: u32,
    /// Diameter of the working pitch circle. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub pitch_diameter: f64,
    /// Tip diameter. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub tip_diameter: f64,
    /// Tooth height from root to tip. [mm]
    #[schemars(range(min = 0.05, max = 500.0))]
    pub tooth_height: f64,
    /// Face width. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: f64,
    /// Its material; default: a steel.
    #[serde(default)]
    pub material: GearMaterial,
    /// The material of the gear that meshes with it: of several, the first in the other node of the link, else the first; default: a steel.
    #[serde(default)]
    pub mate: GearMaterial,
}

/// Surroundings of a link; in a gearbox the framework fills it from `housing.outside` and from the gear named by the link.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeatLinkPart {
    /// The housing.
    pub housing: Option<HousingPart>,
    /// The gear named by the link.
    #[serde(default, deserialize_with = "gear")]
    pub gear: Option<GearShape>,
}

fn gear<'de, D: Deserializer<'de>>(from: D) -> Result<Option<GearShape>, D::Error> {
    let gear = Option::<GearShape>::deserialize(from)?;
    match gear {
        Some(gear) if gear.tooth_height >= 0.5 * gear.tip_diameter => Err(Error::custom(format!(
            "gear: tooth_height {} mm exceeds half of tip_diameter {} mm: correct one of them",
            gear.tooth_height * 1e3,
            gear.tip_diameter * 1e3
        ))),
        gear => Ok(gear),
    }
}

context! {
    /// All inputs of a heat link model.
    pub struct HeatLinkAt of HeatLink {
        /// Temperature of the first node. [degC]
        temperature_1: 80.0 in -60.0..=300.0 from "the network, or a trial value of its iteration",
        /// Temperature of the second node. [degC]
        temperature_2: 60.0 in -60.0..=300.0 from "the network, or a trial value of its iteration",
        /// Magnitude of the speed of the shaft or gear named by the link; zero if it names none. [rpm]
        speed: 3000.0 in 0.0..=30000.0 from "kinematics",
        /// Speed of the vehicle; zero outside a drive cycle. [m/s]
        vehicle_speed: 0.0 in 0.0..=100.0 from "the cycle",
        /// Kinematic viscosity of the oil at the mean of both temperatures. [mm2/s]
        nu: 12.0 in 0.5..=100000.0 from "`lubricant` of the link, else the oil of the housing",
        /// Dynamic viscosity of the oil at the mean of both temperatures. [mPa s]
        eta: 9.84 in 0.3..=100000.0 from "`nu` times `rho`",
        /// Density of the oil at the mean of both temperatures. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "`lubricant` of the link, else the oil of the housing",
        /// Specific heat of the oil at the mean of both temperatures. [J/(kg K)]
        heat_capacity: 2100.0 in 1000.0..=4000.0 from "`lubricant` of the link, else the oil of the housing",
        /// Thermal conductivity of the oil at the mean of both temperatures. [W/(m K)]
        conductivity: 0.14 in 0.05..=1.0 from "`lubricant` of the link, else the oil of the housing",
        /// Mass flow of the oil circuit; zero without one. [kg/s]
        oil_flow: 0.1 in 0.0..=100.0 from "the nozzle that the model names, else `oil_flow` of the network, or the flow in the cycle",
    } laws {
        "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
    }
}

impl Mechanism for HeatLink {
    const KEY: &'static str = "heat_link";
    const MEANING: &'static str = "Thermal conductance of a link between two nodes of a thermal network.";
    const ANSWER: &'static str = "Heat flow over the temperature difference of both nodes. [W/K]";
    const EXAMPLE: &'static str = "
housing:
  area: 4000 cm2
  oil_area: 3500 cm2
  height: 300 mm
  length: 400 mm
  wall_thickness: 8 mm
  wall_conductivity: 150 W/(m K)
  emissivity: 0.3
  air_speed: 0 m/s
gear:
  teeth: 31
  pitch_diameter: 56.3 mm
  tip_diameter: 59.9 mm
  tooth_height: 3.8 mm
  facewidth: 30 mm
";
    type Part = HeatLinkPart;
    type At<'a, R: Real> = HeatLinkAt<'a, R>;
    type Answer = f64;
    type Model = dyn HeatLinkModel;

    answered_by!(conductance);
}

impl HeatLinkModel for Scalar<HeatLink> {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        self.value(at)
    }
}

crate::register_mechanism!(HeatLink);
