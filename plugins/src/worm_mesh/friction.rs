//! Worm drives with a stated coefficient of friction.
//!
//! User-defined: efficiency from forces as vectors with tan rho = mu/cos alpha_n. For pairs whose friction is known from measurements, such as
//! small drives of steel and plastic, to which the published laws do not apply.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::worm_mesh::{AtRest, WormMesh, WormMeshAt, WormMeshLaw, WormPart};
use gearloss_framework::register;
use gearloss_framework::registry::{Check, Evidence, USER_DEFINED, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{BACK, EFFICIENCY, MU, SLIDING, of_friction};

/// A stated coefficient of friction of the teeth.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Friction {
    /// Coefficient of friction in motion. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: f64,
    /// Coefficient of friction at rest; default: not known. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub at_rest: Option<f64>,
}

impl WormMeshLaw for Friction {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &WormMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        Ok(of_friction(
            at,
            |_| R::constant(self.value),
            |mu| at.part.pair.tan_rho(mu),
        ))
    }

    fn at_rest(&self, part: &WormPart) -> Option<AtRest> {
        let friction = self.at_rest?;
        Some(AtRest::new(&part.pair, friction, part.pair.tan_rho(friction)))
    }
}

register!(WormMesh, "friction", Friction,
    source: USER_DEFINED,
    example: "{ type: friction, value: 0.05, at_rest: 0.1 }",
    evidence: [formula(Evidence::User, "the user states it")],
    checks: [
        Check {
            input: "{ model: { type: friction, value: 0.0403544 }, at: { speed: 1500 rpm, torque: 10 Nm } }",
            values: &[("eta_z", "0.83005031"), ("eta_back", "0.79912467")],
            tolerance: 1e-8,
            because: "the values have eight digits",
            source: "independent implementation of forces as vectors",
        },
        Check {
            input: "{ model: { type: friction, value: 0.0403544 }, at: { speed: -1500 rpm, torque: 10 Nm, first_drives: 0 } }",
            values: &[("eta_z", "0.79912467"), ("total", "315.5342 W")],
            tolerance: 1e-6,
            because: "the power has seven digits",
            source: "independent implementation of forces as vectors; (1 - 0.79912467) of 1570.796 W",
        },
    ],
    terms: [SLIDING], observed: [MU, EFFICIENCY, BACK]);
