//! Crossed helical meshes with a stated coefficient of friction, at the pitch point.
//!
//! User-defined coefficient; forces as vectors at the pitch point: eta = (1 + mu tan(beta_2)/cos(alpha_n))/(1 + mu tan(beta_1)/cos(alpha_n)) if the
//! first gear drives, with beta_2 = beta_1 - Sigma; if the second does, the inverse with -mu. Profile sliding beside the pitch point is neglected.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::crossed_helical_mesh::{
    CrossedHelicalMesh, CrossedHelicalMeshAt, CrossedHelicalMeshLaw,
};
use gearloss_framework::real::Mask as _;
use gearloss_framework::register;
use gearloss_framework::registry::{Check, Evidence, USER_DEFINED, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{EFFICIENCY, MU, SLIDING, normal_force, sliding_loss};

/// A stated coefficient of friction, with forces at the pitch point.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Friction {
    /// Coefficient of friction. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: f64,
}

impl CrossedHelicalMeshLaw for Friction {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &CrossedHelicalMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let mu = at.observe(&MU, R::constant(self.value));
        let [sliding, arm] = at.part.at_pitch.map(|length| mu * length);
        let normal = normal_force(at, [sliding, arm])?;
        Ok(sliding_loss(at, idle, sliding, normal))
    }
}

register!(CrossedHelicalMesh, "friction", Friction,
    source: USER_DEFINED,
    example: "{ type: friction, value: 0.05 }",
    evidence: [formula(Evidence::User, "the user states the coefficient; the forces are derived")],
    checks: [
        Check {
            input: "{ model: { type: friction, value: 0.05 }, at: { torque: 10 Nm, speed: 1000 rpm } }",
            values: &[("eta", "0.8989585272")],
            tolerance: 1e-9,
            because: "the value has ten digits",
            source: "independent implementation of forces as vectors",
        },
        Check {
            input: "{ model: { type: friction, value: 0.1 }, at: { torque: 10 Nm, speed: -1000 rpm } }",
            values: &[("eta", "0.8076354530")],
            tolerance: 1e-9,
            because: "the value has ten digits",
            source: "independent implementation of forces as vectors",
        },
    ],
    terms: [SLIDING], observed: [MU, EFFICIENCY]);
