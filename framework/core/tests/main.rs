//! Tests of the framework with its registered mechanisms, and a model of its own where one is needed.
#![allow(clippy::unwrap_used)]

mod crossed;

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt, BevelMeshModel};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel};
use gearloss_framework::registry::{Evidence, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { TEETH = load("teeth"); }

/// A share of the power of the driving gear.
#[derive(Debug, Deserialize, JsonSchema)]
struct Share {
    /// The share. [-]
    value: f64,
}

impl GearMeshModel for Share {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        Ok(Loss::POWERS.with(&TEETH, self.value * at.torque * at.speed.abs()))
    }
}

register!(GearMesh, "share", Share,
    source: "made up for these tests",
    example: "{ type: share, value: 0.01 }",
    evidence: [formula(Evidence::Assumed, "made up for these tests")],
    terms: [TEETH]);

impl BevelMeshModel for Share {
    fn loss(&self, at: &BevelMeshAt<'_>) -> Result<Loss, Undefined> {
        Ok(Loss::POWERS.with(&TEETH, self.value * at.torque * at.speed.abs()))
    }
}

register!(BevelMesh, "share", Share,
    source: "made up for these tests",
    example: "{ type: share, value: 0.01 }",
    evidence: [formula(Evidence::Assumed, "made up for these tests")],
    terms: [TEETH]);
