//! Oil drag of a planetary set: the carrier and its orbiting planets, from tables, power laws or estimates.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::loss::{Loss, Undefined};
use crate::mechanism::gear_drag::{Covers, DragPart};
use crate::mechanism::{Mechanism, Scalar, ShopUnits};
use crate::real::Real;
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum PlanetaryDrag {}

/// Load-independent loss of a carrier with its planets. A model returns moments about the speed of the set's reference shaft, or
/// powers; that shaft takes the reaction.
///
/// The inputs are [`PlanetaryDragAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait PlanetaryDragModel: Send + Sync {
    /// The losses of the planet gears that the model covers, so that none is counted twice.
    fn covers(&self) -> Covers;
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &PlanetaryDragAt<'_>) -> Result<Loss, Undefined>;
}

/// A carrier with its planets in the housing; in a gearbox the framework fills it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanetaryPart {
    /// Number of planets. [-]
    #[schemars(range(min = 2, max = 50))]
    pub count: u32,
    /// Radius of the planets' orbit. [mm]
    #[schemars(range(min = 0.5, max = 10000.0))]
    pub orbit: f64,
    /// Number of different planet bodies on the orbit. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 10))]
    pub bodies: u32,
    /// Gears on the first planet body.
    pub planets: Vec<DragPart>,
    /// Size of the gearbox in its family. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub size: Option<f64>,
    /// Ratio of the gearbox in its family. [-]
    #[schemars(range(min = 0.001, max = 10000.0))]
    pub ratio: Option<f64>,
    /// Volume of the oil in the housing. [l]
    #[schemars(range(min = 0.001, max = 10000.0))]
    pub oil_volume: Option<f64>,
    /// True if an oil level is stated.
    #[serde(default)]
    pub has_level: bool,
}

fn default_one() -> u32 {
    1
}

context! {
    /// All inputs of a planetary drag model.
    pub struct PlanetaryDragAt of PlanetaryDrag {
        /// Speed of the reference shaft, signed. [rpm]
        speed: 300.0 in -30000.0..=30000.0 from "kinematics of `reference`, else of the carrier",
        /// Speed of the carrier, signed. [rpm]
        carrier_speed: 300.0 in -30000.0..=30000.0 from "kinematics",
        /// Speed of the first planet in the housing's frame, signed. [rpm]
        planet_speed: -750.0 in -100000.0..=100000.0 from "kinematics",
        /// Volume of the oil. [ml]
        volume: 90.0 in 1.0..=100000.0 from "`housing.oil.volume`",
        /// Oil height at rest above the carrier's axis. [mm]
        level: -10.0 in -10000.0..=10000.0 from "the oil level at rest and the position of the carrier",
        /// Temperature of the oil. [degC]
        temperature: 60.0 in -40.0..=200.0 from "`lubricant` of the set or the oil of the housing: given, balanced or a node of the network, and `temperature_offset`",
        /// Kinematic viscosity of the oil. [mm2/s]
        nu: 100.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 85.0 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of the oil. [kg/m3]
        rho: 850.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
        /// Size of the gearbox in its family. [mm]
        size: 75.0 in 1.0..=10000.0 from "`size` of the planetary set",
        /// Ratio of the gearbox in its family. [-]
        ratio: 10.0 in 0.001..=10000.0 from "`ratio` of the planetary set",
    } laws {
        "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
    }
}

impl Mechanism for PlanetaryDrag {
    const KEY: &'static str = "planetary_drag";
    const MEANING: &'static str = "Oil drag of a planetary set: the carrier and its orbiting planets.";
    const ANSWER: &'static str = "Drag moment on the reference shaft. [Nm]";
    const EXAMPLE: &'static str = "
count: 3
orbit: 25 mm
planets:
  - gear: { z: 32, normal_module: 1 mm, pressure_angle: 20 deg, facewidth: 14 mm, reference_diameter: 32 mm, \
working_diameter: 32 mm, tip_diameter: 34 mm, root_diameter: 29.5 mm, contact_height: 17 mm }
    oil_volume: 0.09 l
    section_area: 60 cm2
    section_perimeter: 30 cm
    radial_clearance: 2 mm
    axial_clearance: 3 mm
size: 75 mm
ratio: 10
oil_volume: 0.09 l
has_level: true
";
    /// Losses in oil are nearly power laws of speed and viscosity.
    const LOGARITHMIC: &'static [&'static str] = &["speed", "carrier_speed", "nu", "eta", "answer"];
    type Part = PlanetaryPart;
    type At<'a, R: Real> = PlanetaryDragAt<'a, R>;
    type Answer = Loss;
    type Model = dyn PlanetaryDragModel;

    answered_by!(loss);

    fn needs(part: &PlanetaryPart, quantity: &str) -> Option<&'static str> {
        match quantity {
            "volume" if part.oil_volume.is_none() => Some("`housing.oil.volume`"),
            "level" if !part.has_level => Some("`housing.oil.level`, or `volume` with `housing.inside`"),
            "size" if part.size.is_none() => Some("`size` of the planetary set"),
            "ratio" if part.ratio.is_none() => Some("`ratio` of the planetary set"),
            _ => None,
        }
    }
}

impl PlanetaryDragAt<'_> {
    /// True at standstill, where there is no drag.
    ///
    /// # Errors
    /// If the carrier rotates while the reference shaft is stationary and can take no moment.
    pub fn at_rest(&self) -> Result<bool, Undefined> {
        if self.speed == 0.0 && self.carrier_speed != 0.0 {
            return Err(Undefined {
                what: "speed of the carrier in rpm, with a stationary reference shaft of the set",
                value: self.carrier_speed.rpm(),
            });
        }
        if self.speed == 0.0 {
            self.branch("at standstill: no drag");
        }
        Ok(self.speed == 0.0)
    }
}

impl PlanetaryDragModel for Scalar<PlanetaryDrag> {
    /// A set simulated or measured as a whole includes the planets in oil and air. Oil between the teeth is not included:
    /// simulations omit the teeth of sun and ring.
    fn covers(&self) -> Covers {
        Covers {
            churning: true,
            squeezing: false,
            windage: true,
        }
    }
    fn loss(&self, at: &PlanetaryDragAt<'_>) -> Result<Loss, Undefined> {
        if at.at_rest()? {
            return Ok(Loss::MOMENTS);
        }
        self.moment(at)
    }
}

crate::register_mechanism!(PlanetaryDrag);
