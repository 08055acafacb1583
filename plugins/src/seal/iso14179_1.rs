//! Radial lip seals according to ISO/TR 14179-1, of AGMA origin.
//!
//! Source: ISO/TR 14179-1:2001, quoted from memory: T = 3.737e-3 d for fluoro rubber, 2.429e-3 d for nitrile rubber, in N m with d in mm; one lip.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::checks::SIX_DIGITS;

terms! { LIP = no_load("lip"); }

/// Material of the lip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Fluoro rubber, FKM.
    Fkm,
    /// Nitrile rubber, NBR.
    Nbr,
}

coefficients! {
    /// Constants of the formula of ISO/TR 14179-1.
    struct Constants {
        /// Torque in N m per mm of diameter, fluoro rubber.
        fkm = 3.737e-3, in 1.8685e-3..=7.474e-3;
        /// Torque in N m per mm of diameter, nitrile rubber.
        nbr = 2.429e-3, in 1.2145e-3..=4.858e-3;
    }
}

/// Radial lip seals according to ISO/TR 14179-1: torque from diameter and material.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    /// Material of the lip.
    pub material: Material,
    #[serde(default)]
    coefficients: Constants,
}

impl Iso14179 {
    /// Friction torque from the diameter in mm. \[Nm\]
    fn moment(&self, d: f64) -> f64 {
        match self.material {
            Material::Fkm => self.coefficients.fkm * d,
            Material::Nbr => self.coefficients.nbr * d,
        }
    }
}

impl SealModel for Iso14179 {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        Ok(Loss::MOMENTS.with(&LIP, at.show("T_s", "Nm", self.moment(at.part.diameter.mm()))))
    }
}

register!(Seal, "iso14179_1", Iso14179,
    source: "ISO/TR 14179-1:2001",
    example: "{ type: iso14179_1, material: fkm }",
    evidence: [formula(Evidence::Recalled, "quoted from memory, not checked; the law of Linke is between both materials at 40 mm")],
    checks: [
        Check {
            input: "{ model: { type: iso14179_1, material: fkm }, part: { diameter: 40 mm }, at: { speed: 3000 rpm } }",
            values: &[("moment", "0.149480 Nm"), ("total", "46.9605 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: iso14179_1, material: nbr }, part: { diameter: 40 mm }, at: { speed: 3000 rpm } }",
            values: &[("moment", "0.0971600 Nm"), ("total", "30.5237 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [LIP]);
