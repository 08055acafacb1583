//! Loss of a bevel or hypoid mesh from a known efficiency: a number, or a table over the quantities of the mesh.
//!
//! User-defined: P = (1 - eta) P_in. For pairs whose loss has been measured or computed by other means. Values of regulations, such as 0.955 of
//! 40 CFR 1037, are those of whole axles with bearings, seals and oil.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt, BevelMeshModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};

use crate::efficiency::{EFFICIENCY, Efficiency, Params, SLIDING};

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency<BevelMesh>, Diagnostic> {
    Efficiency::prepare(params, cx)
}

impl BevelMeshModel for Efficiency<BevelMesh> {
    fn loss(&self, at: &BevelMeshAt<'_>) -> Result<Loss, Undefined> {
        self.loss(at, [at.torque, at.speed], &SLIDING)
    }
}

register!(BevelMesh, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.975 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [SLIDING], observed: [EFFICIENCY], geometry: false, prepare: prepare);
