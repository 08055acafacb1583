//! Heat dissipation of the gearbox: from the housing to the air, through the flange, through a cooler.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::loss::Undefined;
use crate::mechanism::Mechanism;
use crate::mechanism::Scalar;
use crate::real::Real;
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum HeatDissipation {}

/// Start of a heat dissipation path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WarmSide {
    /// The oil.
    Oil,
    /// The surface of the housing.
    Surface,
}

/// One heat dissipation path: a conductance between a warm side and a heat sink.
///
/// The inputs are [`HeatDissipationAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait HeatDissipationModel: Send + Sync {
    /// Start of the path.
    fn warm_side(&self) -> WarmSide {
        WarmSide::Surface
    }
    /// Temperature of the heat sink; `None`: the ambient temperature. \[degC\]
    fn sink(&self) -> Option<f64> {
        None
    }
    /// Heat flow over temperature difference. Pure; must not allocate. \[W/K\]
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined>;
}

/// The outside of the housing; in a gearbox the framework fills it from `housing.outside`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HousingPart {
    /// Area that dissipates heat to the air, without fins. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub area: Option<f64>,
    /// Oil-wetted inside area. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub oil_area: Option<f64>,
    /// Height. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub height: Option<f64>,
    /// Length along the air flow. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub length: Option<f64>,
    /// Thickness of the wall. [mm]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub wall_thickness: f64,
    /// Thermal conductivity of the wall. [W/(m K)]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub wall_conductivity: f64,
    /// Emissivity. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Air speed along the housing. [m/s]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub air_speed: f64,
}

context! {
    /// All inputs of a heat dissipation model.
    pub struct HeatDissipationAt of HeatDissipation {
        /// Temperature of the oil. [degC]
        oil_temperature: 80.0 in -60.0..=250.0 from "the balance, or a trial value of its iteration",
        /// Temperature of the surface of the housing. [degC]
        surface_temperature: 75.0 in -60.0..=250.0 from "the balance, with `thermal.oil_to_surface`",
        /// Ambient temperature. [degC]
        ambient: 20.0 in -60.0..=120.0 from "`thermal.ambient`",
        /// Density of the oil. [kg/m3]
        rho: 830.0 in 500.0..=1300.0 from "the oil of the housing at its temperature",
        /// Specific heat of the oil. [J/(kg K)]
        heat_capacity: 2100.0 in 1000.0..=4000.0 from "the oil of the housing at its temperature",
    }
}

impl Mechanism for HeatDissipation {
    const KEY: &'static str = "heat_dissipation";
    const MEANING: &'static str =
        "Heat dissipation of the gearbox: from the housing to the air, through the flange, through a cooler.";
    const ANSWER: &'static str = "Heat flow over the temperature difference of surface and ambient. [W/K]";
    const EXAMPLE: &'static str = "
area: 4000 cm2
oil_area: 3500 cm2
height: 300 mm
length: 300 mm
wall_thickness: 8 mm
wall_conductivity: 150 W/(m K)
emissivity: 0.9
air_speed: 0 m/s
";
    const OWN: &'static [&'static str] = &["constant"];
    type Part = HousingPart;
    type At<'a, R: Real> = HeatDissipationAt<'a, R>;
    type Answer = f64;
    type Model = dyn HeatDissipationModel;

    answered_by!(conductance);
}

impl HeatDissipationModel for Scalar<HeatDissipation> {
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        self.value(at)
    }
}

crate::register_mechanism!(HeatDissipation);
