//! A seal of a maker's own, for a mechanism of the framework.
//!
//! Source: invented for this example; the figures mean nothing.

use gearloss_framework::loss::{Loss, Term, Undefined};
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Evidence, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const LIP: Term = Term::no_load(0, "lip");

/// Friction force per circumference, as measured.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct MeasuredSeal {
    /// Friction force per circumference. [N/mm]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub force: f64,
}

impl SealModel for MeasuredSeal {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        let d = at.part.diameter;
        Ok(Loss::MOMENTS.with(&LIP, at.show("M", "Nm", self.force * std::f64::consts::PI * d * 0.5 * d)))
    }
}

register!(Seal, "measured", MeasuredSeal,
    meaning: "Friction force per circumference, as measured.",
    source: "rig report 18 of nobody",
    example: "{ type: measured, force: 0.02 N/mm }",
    evidence: [formula(Evidence::Assumed, "invented")],
    terms: [LIP]);
