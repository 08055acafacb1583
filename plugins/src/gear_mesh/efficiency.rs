//! Mesh loss from a known efficiency: a number, or a table over the quantities of the mesh.
//!
//! User-defined: P = (1 - eta) P_in. For pairs whose loss has been measured or computed by other means. For a table of power losses
//! instead of efficiencies use the model `table`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::table::{Interpolation, Outside, Reading};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { SLIDING = load("sliding"); }
observed! { EFFICIENCY = ("eta", "-", "efficiency of the mesh"); }

/// Mesh loss from a known efficiency: a number, or a table over quantities of the mesh.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Efficiency, instead of a table. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: Option<f64>,
    /// CSV file with the efficiency over one to four quantities, such as `torque [Nm]` and `speed [rpm]`.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: Option<String>,
    /// Extrapolation of the table.
    #[serde(default)]
    pub outside: Outside,
    /// Interpolation of the table.
    #[serde(default)]
    pub interpolation: Interpolation,
}

enum Efficiency {
    Value(f64),
    Table(Lookup<GearMesh>),
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency, Diagnostic> {
    match (params.value, params.file) {
        (Some(value), None) => Ok(Efficiency::Value(value)),
        (None, Some(file)) => {
            let reading = Reading {
                outside: params.outside,
                interpolation: params.interpolation,
                ..Reading::default()
            };
            Ok(Efficiency::Table(Lookup::read(&file, &reading, "-", cx)?))
        }
        _ => Err(cx
            .error("efficiency requires either `value` or `file`")
            .help("write `value: 0.985`, or `file:` with a table")),
    }
}

impl GearMeshModel for Efficiency {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let value = match self {
            Self::Value(value) => *value,
            Self::Table(table) => {
                let (value, place) = table.value(at)?;
                at.check(&PLACE, place);
                value
            }
        };
        if !(0.0..=1.0).contains(&value) {
            return Err(Undefined {
                what: "efficiency of the mesh, which is not between 0 and 1",
                value,
            });
        }
        let value = at.observe(&EFFICIENCY, value);
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        Ok(Loss::POWERS.with(&SLIDING, (1.0 - value) * input))
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
