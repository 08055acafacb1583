//! Drag of synchronizers, dog couplings and rings with a gap.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attach::{Clearance, ClearanceSite};
use crate::loss::{Loss, Notes, Undefined};
use crate::mechanism::{Component, Mechanism, Scalar};
use crate::real::{Points, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Synchronizer {}

/// Drag of one open coupling. When engaged, its members have equal speed and the loss is zero.
///
/// The inputs are [`SynchronizerAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait SynchronizerModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &SynchronizerAt<'_>) -> Result<Loss, Undefined>;
}

/// Kind of a coupling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CouplingKind {
    /// Synchronizer with friction cones.
    #[default]
    Synchronizer,
    /// Dog clutch.
    Dog,
    /// Cylindrical gap that never closes: an idler gear on a plain shaft, a bush.
    Ring,
}

/// A coupling between two members: a synchronizer, a dog clutch, or a ring with a gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CouplingPart {
    /// Kind of the coupling.
    #[serde(default)]
    pub kind: CouplingKind,
    /// Number of friction cones. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 4))]
    pub cones: u32,
    /// Mean diameter of a cone, or diameter of a ring gap. [mm]
    #[schemars(range(min = 5.0, max = 500.0))]
    pub cone_diameter: Option<f64>,
    /// Width of a cone along the axis, or length of a ring gap. [mm]
    #[schemars(range(min = 0.5, max = 200.0))]
    pub cone_width: Option<f64>,
    /// Half angle of a cone against the axis. [deg]
    #[schemars(range(min = 1.0, max = 45.0))]
    pub cone_angle: Option<f64>,
    /// Gap normal to the faces. [mm]
    #[schemars(range(min = 0.01, max = 5.0))]
    pub gap: Option<f64>,
    /// Share of the gap filled with oil: 1 flooded, 0.1 to 0.5 splashed. [-]
    #[serde(default = "flooded")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fill: f64,
}

fn default_one() -> u32 {
    1
}

fn flooded() -> f64 {
    1.0
}

context! {
    /// All inputs of the model of an open coupling.
    pub struct SynchronizerAt of Synchronizer {
        /// Speed of the first member relative to the second, signed; zero when engaged. [rpm]
        speed: 1000.0 in -30000.0..=30000.0 from "kinematics of both members and the gear state",
        /// Speed of the first member, signed. [rpm]
        first_speed: 3000.0 in -30000.0..=30000.0 from "kinematics",
        /// Temperature of the oil. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the component: given, balanced or a node of the network, and `temperature_offset`",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 8.0 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of the oil. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
    }
}

impl Mechanism for Synchronizer {
    const KEY: &'static str = "synchronizer";
    const MEANING: &'static str = "Drag of an open synchronizer, dog coupling or ring gap.";
    const ANSWER: &'static str = "Drag moment. [Nm]";
    const EXAMPLE: &'static str =
        "{ kind: synchronizer, cones: 1, cone_diameter: 62 mm, cone_width: 8 mm, cone_angle: 6.5 deg, gap: 0.15 mm }";
    type Part = CouplingPart;
    type At<'a, R: Real> = SynchronizerAt<'a, R>;
    type Answer = Loss;
    type Model = dyn SynchronizerModel;

    answered_by!(loss);
}

impl Component for Synchronizer {
    const SECTION: &'static str = "couplings";
    type Attachment = Clearance;

    #[inline(always)]
    fn context<'a, R: Points>(
        part: &'a CouplingPart,
        site: ClearanceSite<'a, R>,
        notes: Notes<'a, R>,
    ) -> SynchronizerAt<'a, R> {
        let oil = site.oil;
        SynchronizerAt {
            part,
            speed: site.speed,
            first_speed: site.first_speed,
            temperature: oil.temperature,
            eta: oil.eta,
            rho: oil.rho,
            notes,
        }
    }

    fn lowest(_part: &CouplingPart) -> Option<f64> {
        None
    }
}

impl SynchronizerModel for Scalar<Synchronizer> {
    fn loss(&self, at: &SynchronizerAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

crate::register_component!(Synchronizer);
