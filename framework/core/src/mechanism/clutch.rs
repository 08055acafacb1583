//! Drag of open wet clutches and brakes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attach::{Clearance, ClearanceSite};
use crate::loss::{Loss, Notes, Undefined};
use crate::mechanism::{Component, Mechanism, Scalar};
use crate::real::{Points, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Clutch {}

/// Drag of one open clutch or brake. When closed, its members have equal speed and the loss is zero.
///
/// The inputs are [`ClutchAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait ClutchModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &ClutchAt<'_>) -> Result<Loss, Undefined>;
}

/// A clutch between two members, or a brake between a member and the housing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClutchPart {
    /// Inner diameter of the friction faces. [mm]
    #[schemars(range(min = 1.0, max = 2000.0))]
    pub inner_diameter: Option<f64>,
    /// Outer diameter of the friction faces. [mm]
    #[schemars(range(min = 1.0, max = 2000.0))]
    pub outer_diameter: Option<f64>,
    /// Number of friction interfaces. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 100))]
    pub faces: u32,
    /// Gap of one open interface. [mm]
    #[schemars(range(min = 0.01, max = 5.0))]
    pub gap: Option<f64>,
}

fn default_one() -> u32 {
    1
}

context! {
    /// All inputs of a clutch model.
    pub struct ClutchAt of Clutch {
        /// Speed of the first member relative to the second, signed; zero when closed. [rpm]
        speed: 500.0 in -30000.0..=30000.0 from "kinematics of both members and the gear state",
        /// Speed of the first member, signed. [rpm]
        first_speed: 1000.0 in -30000.0..=30000.0 from "kinematics",
        /// Temperature of the oil. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the component: given, balanced or a node of the network, and `temperature_offset`",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 8.0 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of the oil. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
    }
}

impl Mechanism for Clutch {
    const KEY: &'static str = "clutch";
    const MEANING: &'static str = "Drag of an open wet clutch or brake.";
    const ANSWER: &'static str = "Drag moment. [Nm]";
    const EXAMPLE: &'static str = "{ inner_diameter: 110 mm, outer_diameter: 140 mm, faces: 12, gap: 0.15 mm }";
    type Part = ClutchPart;
    type At<'a, R: Real> = ClutchAt<'a, R>;
    type Answer = Loss;
    type Model = dyn ClutchModel;

    answered_by!(loss);
}

impl Component for Clutch {
    const SECTION: &'static str = "clutches";
    type Attachment = Clearance;

    #[inline(always)]
    fn context<'a, R: Points>(
        part: &'a ClutchPart,
        site: ClearanceSite<'a, R>,
        notes: Notes<'a, R>,
    ) -> ClutchAt<'a, R> {
        let oil = site.oil;
        ClutchAt {
            part,
            speed: site.speed,
            first_speed: site.first_speed,
            temperature: oil.temperature,
            eta: oil.eta,
            rho: oil.rho,
            notes,
        }
    }

    fn lowest(_part: &ClutchPart) -> Option<f64> {
        None
    }
}

impl ClutchModel for Scalar<Clutch> {
    fn loss(&self, at: &ClutchAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

crate::register_component!(Clutch);
