//! Friction of shaft seals.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attach::{MemberSite, OnMember};
use crate::loss::{Loss, Notes, Undefined};
use crate::mechanism::{Component, Mechanism, Scalar};
use crate::real::{Points, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Seal {}

/// Friction of one shaft seal. A model returns a moment about the shaft.
///
/// The inputs are [`SealAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait SealModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined>;
}

/// Kind of a shaft seal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SealKind {
    /// Radial lip seal.
    #[default]
    RadialLip,
    /// Non-contact seal, such as a labyrinth.
    NonContact,
}

/// Material of a sealing lip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SealMaterial {
    /// Acrylonitrile-butadiene rubber.
    Nbr,
    /// Hydrogenated acrylonitrile-butadiene rubber.
    Hnbr,
    /// Polyacrylate rubber.
    Acm,
    /// Fluoro rubber.
    Fkm,
    /// Silicone rubber.
    Vmq,
    /// Polytetrafluoroethylene.
    Ptfe,
}

/// A shaft seal against the housing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SealPart {
    /// Shaft diameter at the lip. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub diameter: f64,
    /// Kind of the seal.
    #[serde(default)]
    pub kind: SealKind,
    /// Material of the lip; for ratings.
    pub material: Option<SealMaterial>,
}

context! {
    /// All inputs of a seal model.
    pub struct SealAt of Seal {
        /// Speed of the shaft in the seal, signed. [rpm]
        speed: 3000.0 in -30000.0..=30000.0 from "kinematics of its shaft",
        /// Temperature of the oil at the seal. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the component: given, balanced or a node of the network, and `temperature_offset`",
        /// Kinematic viscosity of the oil at the seal. [mm2/s]
        nu: 10.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Kinematic viscosity of the oil at 40 degC. [mm2/s]
        nu40: 32.0 in 2.0..=1000.0 from "the viscosity of that oil",
        /// Density of the oil at the seal. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
    }
}

impl Mechanism for Seal {
    const KEY: &'static str = "seal";
    const MEANING: &'static str = "Friction of a shaft seal.";
    const ANSWER: &'static str = "Friction moment. [Nm]";
    const EXAMPLE: &'static str = "{ diameter: 40 mm, kind: radial_lip }";
    type Part = SealPart;
    type At<'a, R: Real> = SealAt<'a, R>;
    type Answer = Loss;
    type Model = dyn SealModel;

    answered_by!(loss);
}

impl Component for Seal {
    const SECTION: &'static str = "seals";
    type Attachment = OnMember;

    #[inline(always)]
    fn context<'a, R: Points>(part: &'a SealPart, site: MemberSite<'a, R>, notes: Notes<'a, R>) -> SealAt<'a, R> {
        let oil = site.oil;
        SealAt {
            part,
            speed: site.speed,
            temperature: oil.temperature,
            nu: oil.nu,
            nu40: oil.nu40,
            rho: oil.rho,
            notes,
        }
    }

    fn lowest(_part: &SealPart) -> Option<f64> {
        None
    }
}

impl SealModel for Scalar<Seal> {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

crate::register_component!(Seal);
