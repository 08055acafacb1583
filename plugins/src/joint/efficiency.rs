//! Loss of a joint from a known efficiency: a number, or a table over the quantities of the joint, such as its angle.
//!
//! User-defined: P = (1 - eta) P_in. For constant-velocity joints, whose friction no open formula gives, with the values of the maker: their
//! loss rises with the angle, so a table over `angle` is better than a number. The joint has one `angle` in a gearbox; to vary it over
//! points, bind its path.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::joint::{Joint, JointAt, JointModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::table::{Interpolation, Outside, Reading};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { STATED = load("stated"); }
observed! { EFFICIENCY = ("eta", "-", "efficiency of the joint"); }

/// Loss of a joint from a known efficiency: a number, or a table over the quantities of the joint, such as its angle.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Efficiency, instead of a table. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: Option<f64>,
    /// CSV file with the efficiency over one to four quantities, such as `angle [deg]` and `torque [Nm]`.
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
    Table(Lookup<Joint>),
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
            .help("write `value: 0.99`, or `file:` with a table")),
    }
}

impl JointModel for Efficiency {
    fn loss(&self, at: &JointAt<'_>) -> Result<Loss, Undefined> {
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
                what: "efficiency of the joint, which is not between 0 and 1",
                value,
            });
        }
        let value = at.observe(&EFFICIENCY, value);
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        Ok(Loss::POWERS.with(&STATED, (1.0 - value) * input))
    }
}

register!(Joint, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.99 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [STATED], observed: [EFFICIENCY], prepare: prepare);
