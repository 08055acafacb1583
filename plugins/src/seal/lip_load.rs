//! Radial lip seals from line load and friction coefficient of the lip.
//!
//! Derived: T = mu q pi d^2/2 with the radial load q per length of the lip, typically 50 to 150 N/m, and a coefficient of friction
//! of 0.2 to 0.5 when lubricated.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { LIP = no_load("lip"); }

/// Radial lip seals from line load and friction coefficient of the lip.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct LipLoad {
    /// Radial load per length of the lip, typically 50 to 150 N/m. [N/m]
    #[schemars(range(min = 0.0, max = 5000.0))]
    pub line_load: f64,
    /// Coefficient of friction, typically 0.2 to 0.5. [-]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub mu: f64,
}

impl LipLoad {
    /// Friction torque from the diameter in m. \[Nm\]
    fn moment(&self, d: f64) -> f64 {
        self.mu * self.line_load * std::f64::consts::PI * d * d / 2.0
    }
}

impl SealModel for LipLoad {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        at.show("d", "mm", at.part.diameter.mm());
        Ok(Loss::MOMENTS.with(&LIP, at.show("T", "Nm", self.moment(at.part.diameter))))
    }
}

register!(Seal, "lip_load", LipLoad,
    source: "derived: Coulomb friction of a loaded ring",
    example: "{ type: lip_load, line_load: 100 N/m, mu: 0.3 }",
    evidence: [formula(Evidence::Derived, "the user states load and friction")],
    checks: [
        Check {
            input: "{ model: { type: lip_load, line_load: 100 N/m, mu: 0.3 }, part: { diameter: 40 mm }, at: { speed: 3000 rpm } }",
            values: &[("total", "23.6871 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [LIP]);
