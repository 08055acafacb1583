//! Auxiliaries: pumps and other components driven by a shaft.

use crate::attach::{MemberSite, OnMember};
use crate::loss::{Loss, Notes, Undefined};
use crate::mechanism::{Component, Mechanism, NoPart, Scalar};
use crate::real::{Points, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Auxiliary {}

/// Torque that an auxiliary takes from its shaft. A model returns a torque.
///
/// The inputs are [`AuxiliaryAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait AuxiliaryModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined>;
}

context! {
    /// All inputs of an auxiliary model.
    pub struct AuxiliaryAt of Auxiliary {
        /// Speed of the shaft that drives it, signed. [rpm]
        speed: 2000.0 in -30000.0..=30000.0 from "kinematics of its shaft",
        /// Temperature of the oil. [degC]
        temperature: 80.0 in -40.0..=200.0 from "the oil of the component: given, balanced or a node of the network, and `temperature_offset`",
        /// Kinematic viscosity of the oil. [mm2/s]
        nu: 10.0 in 1.0..=10000.0 from "the viscosity of that oil at this temperature",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 8.2 in 0.5..=10000.0 from "`nu` times `rho`",
        /// Density of the oil. [kg/m3]
        rho: 820.0 in 500.0..=1300.0 from "the density of that oil at this temperature",
        /// Flow through the pump or the rotating channels that the model names. [l/min]
        flow: 8.0 in 0.0..=100.0 from "the oil network",
        /// Pressure rise of that pump. [bar]
        pressure: 4.0 in 0.0..=100.0 from "the oil network",
        /// Displacement of that pump per turn. [cm3]
        displacement: 8.0 in 0.0..=100.0 from "the oil network",
        /// Torque that the oil takes in that element without friction: displacement times pressure rise, or the change of its angular momentum. [Nm]
        oil_torque: 0.5 in 0.0..=100.0 from "the oil network",
    } laws {
        "eta = nu rho" { eta: |at| at.nu * at.rho, nu: |at| at.eta / at.rho, rho: |at| at.eta / at.nu }
    }
}

impl Mechanism for Auxiliary {
    const KEY: &'static str = "auxiliary";
    const MEANING: &'static str = "Torque that a pump or another auxiliary takes from a shaft.";
    const ANSWER: &'static str = "Torque taken from the shaft. [Nm]";
    const EXAMPLE: &'static str = "{}";
    type Part = NoPart;
    type At<'a, R: Real> = AuxiliaryAt<'a, R>;
    type Answer = Loss;
    type Model = dyn AuxiliaryModel;

    answered_by!(loss);
}

impl Component for Auxiliary {
    const SECTION: &'static str = "auxiliaries";
    type Attachment = OnMember;

    #[inline(always)]
    fn context<'a, R: Points>(part: &'a NoPart, site: MemberSite<'a, R>, notes: Notes<'a, R>) -> AuxiliaryAt<'a, R> {
        let oil = site.oil;
        AuxiliaryAt {
            part,
            speed: site.speed,
            temperature: oil.temperature,
            nu: oil.nu,
            eta: oil.eta,
            rho: oil.rho,
            flow: site.supply.flow.max(R::ZERO),
            pressure: site.supply.rise.max(R::ZERO),
            displacement: site.supply.displacement,
            oil_torque: site.supply.torque.max(R::ZERO),
            notes,
        }
    }

    fn lowest(_part: &NoPart) -> Option<f64> {
        None
    }
}

impl AuxiliaryModel for Scalar<Auxiliary> {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

crate::register_component!(Auxiliary);
