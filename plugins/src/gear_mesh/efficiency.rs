//! Mesh loss from a known efficiency: a number, or a table over the quantities of the mesh.
//!
//! User-defined: P = (1 - eta) P_in. For pairs whose loss has been measured or computed by other means. For a table of power losses
//! instead of efficiencies use the model `table`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};

use crate::efficiency::{EFFICIENCY, Efficiency, Params, SLIDING};

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency<GearMesh>, Diagnostic> {
    Efficiency::prepare(params, cx)
}

impl GearMeshModel for Efficiency<GearMesh> {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        self.loss(at, [at.torque, at.speed], &SLIDING)
    }
}

register!(GearMesh, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.985 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [SLIDING], observed: [EFFICIENCY], geometry: false, prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gear_mesh::path_integral::tests::fzg_c14;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::registry::{Files, Registry, Slot};
    use std::sync::Arc;

    fn build(value: &serde_json::Value) -> Result<Slot<GearMesh>, String> {
        let registry = Registry::linked().unwrap_or_else(|found| panic!("{found:?}"));
        let files = Files::default();
        files.put("eta.csv", "torque [Nm],efficiency\n0,0.9\n100,0.99\n");
        let part = Arc::new(fzg_c14(0.4e-6, 0.5e-6));
        Build::new(&registry, &files)
            .slot_at("meshes.M1.model", &part, value)
            .map_err(|fault| fault.to_string())
    }

    #[test]
    fn a_number_and_a_table() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
            to.torque = 50.0;
            to.speed = 100.0;
        });
        let defaults = |mut value: serde_json::Value| {
            value["outside"] = "error".into();
            value["interpolation"] = "linear".into();
            value
        };
        let number = build(&defaults(serde_json::json!({ "type": "efficiency", "value": 0.98 }))).unwrap();
        assert!((number.loss(&at).unwrap().sum() - 100.0).abs() < 1e-9);
        let table = build(&defaults(
            serde_json::json!({ "type": "efficiency", "file": "eta.csv" }),
        ))
        .unwrap();
        assert!((table.loss(&at).unwrap().sum() - 0.055 * 5000.0).abs() < 1e-9);
        assert!(table.loss(&at.with(|to| to.torque = 500.0)).is_err());
        assert!(
            build(&serde_json::json!({ "type": "efficiency" }))
                .err()
                .unwrap()
                .contains("either")
        );
    }
}
