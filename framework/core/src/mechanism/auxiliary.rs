//! Auxiliaries: pumps and other components driven by a shaft.

use crate::attach::{MemberSite, OnMember};
use crate::loss::{Loss, Notes, Undefined};
use crate::mechanism::{Component, Mechanism, NoPart, Scalar, with_oil};
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
        ..oil from "the oil of the component",
        /// Flow through the pump or the rotating channels that the model names. [l/min]
        flow: 8.0 in 0.0..=100.0 from "the oil network",
        /// Pressure rise of that pump. [bar]
        pressure: 4.0 in 0.0..=100.0 from "the oil network",
        /// Displacement of that pump per turn. [cm3]
        displacement: 8.0 in 0.0..=100.0 from "the oil network",
        /// Torque that the oil takes in that element without friction: displacement times pressure rise, or the change of its angular momentum. [Nm]
        oil_torque: 0.5 in 0.0..=100.0 from "the oil network",
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
        with_oil!(from oil, AuxiliaryAt {
            part,
            speed: site.speed,
            flow: site.supply.flow.max(R::ZERO),
            pressure: site.supply.rise.max(R::ZERO),
            displacement: site.supply.displacement,
            oil_torque: site.supply.torque.max(R::ZERO),
            notes,
        })
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
