//! Loss of chains and belts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::loss::{Loss, Term, Undefined};
use crate::mechanism::{Answers, Mechanism, Scalar};
use crate::real::{Dual, Lane, Points as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Chain {}

/// Loss of one chain or belt between two wheels, without their bearings. A model returns powers.
///
/// The inputs are [`ChainAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait ChainModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &ChainAt<'_>) -> Result<Loss, Undefined>;

    /// The losses at several points together; written by a [law](ChainLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn losses(&self, _at: &ChainAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The loss with its derivatives; written by a [law](ChainLaw). `None` has them found by differences.
    fn loss_with_derivatives(&self, _at: &ChainAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        None
    }
}

/// A model of chains that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses wide
/// instructions.
pub trait ChainLaw: Send + Sync {
    /// Loss at one operating point, or at several. Pure; must not allocate.
    fn loss<R: Answers>(&self, at: &ChainAt<'_, R>) -> Result<Loss<R>, Undefined>;
}

impl<L: ChainLaw> ChainModel for L {
    fn loss(&self, at: &ChainAt<'_>) -> Result<Loss, Undefined> {
        ChainLaw::loss(self, at)
    }

    fn losses(&self, at: &ChainAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || ChainLaw::loss(self, at),
        )
    }

    fn loss_with_derivatives(&self, at: &ChainAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        Some(ChainLaw::loss(self, at))
    }
}

/// What runs over the wheels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ChainKind {
    /// Roller chain or bush chain: links turn on round pins.
    #[default]
    RollerChain,
    /// Silent chain (inverted tooth chain), also with rocker pins.
    SilentChain,
    /// Toothed belt (synchronous belt).
    ToothedBelt,
    /// Push belt or pull chain of a continuously variable transmission, with a stated `ratio`.
    VariableBelt,
}

/// A chain or belt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChainPart {
    /// What runs over the wheels.
    #[serde(default)]
    pub kind: ChainKind,
    /// Numbers of teeth of both wheels; none for a `variable_belt`. [-]
    #[schemars(inner(range(min = 5, max = 500)))]
    pub z: Option<[u32; 2]>,
    /// Pitch of the chain or belt. [mm]
    #[schemars(range(min = 1.0, max = 200.0))]
    pub pitch: Option<f64>,
    /// Diameter of the pins on which the links turn. [mm]
    #[schemars(range(min = 0.5, max = 100.0))]
    pub pin_diameter: Option<f64>,
    /// Tension of the slack strand, without centrifugal force. [N]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub slack_tension: f64,
    /// Number of links, or of teeth of a belt. [-]
    #[schemars(range(min = 10, max = 5000))]
    pub links: Option<u32>,
    /// Mass of the chain or belt, for its centrifugal force; requires `links`. [kg]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub mass: Option<f64>,
}

impl ChainPart {
    /// Radius at which the tension acts on each wheel: that of a circle with the circumference of the links. \[m\]
    pub fn radii(&self) -> Option<[f64; 2]> {
        let (z, pitch) = (self.z?, self.pitch?);
        Some(z.map(|z| f64::from(z) * pitch / std::f64::consts::TAU))
    }

    /// Mass per length; zero if it is not stated. \[kg/m\]
    pub fn mass_per_length(&self) -> f64 {
        let stated = self.mass.zip(self.links).zip(self.pitch);
        stated.map_or(0.0, |((mass, links), pitch)| mass / (f64::from(links) * pitch))
    }
}

context! {
    /// All inputs of a chain model: one chain or belt.
    pub struct ChainAt of Chain {
        /// Magnitude of the torque on the first wheel. [Nm]
        torque: 100.0 in 0.0..=5000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Speed of the first wheel, signed. [rpm]
        speed: 2000.0 in -30000.0..=30000.0 from "kinematics",
        /// One if the first wheel drives, zero if the second does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        /// Speed of the first wheel over that of the second. [-]
        ratio: 1.0 in 0.05..=20.0 from "the numbers of teeth, or `ratio` in the gear",
        ..oil from "`lubricant` of the chain or the oil of the housing",
    }
}

impl Mechanism for Chain {
    const KEY: &'static str = "chain";
    const MEANING: &'static str = "Loss of a chain or belt between two wheels.";
    const ANSWER: &'static str = "Power lost in the chain or belt. [W]";
    const EXAMPLE: &'static str =
        "{ z: [37, 37], pitch: 9.525 mm, links: 84, pin_diameter: 3.58 mm, slack_tension: 50 N, mass: 0.8 kg }";
    const TOTAL: Term = Term::load("total");
    type Part = ChainPart;
    type At<'a, R: Real> = ChainAt<'a, R>;
    type Answer = Loss;
    type Model = dyn ChainModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

impl ChainModel for Scalar<Chain> {
    fn loss(&self, at: &ChainAt<'_>) -> Result<Loss, Undefined> {
        self.power(at)
    }

    fn losses(&self, at: &ChainAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Ok(Loss::POWERS.with(&Chain::TOTAL, self.values(at)?))
    }

    fn loss_with_derivatives(&self, _at: &ChainAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        let value = self.constant()?;
        Some(Ok(Loss::POWERS.with(&Chain::TOTAL, Dual::constant(value))))
    }
}

crate::register_mechanism!(Chain);
