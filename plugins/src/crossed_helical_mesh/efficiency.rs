//! Loss of a crossed helical mesh from a known efficiency: a number, or a table over the quantities of the mesh.
//!
//! User-defined: P = (1 - eta) P_in. For pairs whose loss has been measured or computed by other means.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::crossed_helical_mesh::{
    CrossedHelicalMesh, CrossedHelicalMeshAt, CrossedHelicalMeshModel,
};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};

use crate::efficiency::{EFFICIENCY, Efficiency, Params, SLIDING};

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency<CrossedHelicalMesh>, Diagnostic> {
    Efficiency::prepare(params, cx)
}

impl CrossedHelicalMeshModel for Efficiency<CrossedHelicalMesh> {
    fn loss(&self, at: &CrossedHelicalMeshAt<'_>) -> Result<Loss, Undefined> {
        self.loss(at, [at.torque, at.speed], &SLIDING)
    }
}

register!(CrossedHelicalMesh, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.85 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [SLIDING], observed: [EFFICIENCY], geometry: false, prepare: prepare);
