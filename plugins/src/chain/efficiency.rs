//! Loss of a chain or belt from a known efficiency: a number, or a table over the quantities of the chain.
//!
//! User-defined: P = (1 - eta) P_in. For chains and belts whose loss has been measured or is stated by the maker, and for the map of a
//! variable belt over `ratio`, `torque` and `speed`. For a table of power losses instead of efficiencies use the model `table`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::chain::{Chain, ChainAt, ChainModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::table::{Interpolation, Outside, Reading};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { STATED = load("stated"); }
observed! { EFFICIENCY = ("eta", "-", "efficiency of the chain or belt"); }

/// Loss of a chain or belt from a known efficiency: a number, or a table over the quantities of the chain.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Efficiency, instead of a table. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: Option<f64>,
    /// CSV file with the efficiency over one to four quantities, such as `ratio [-]`, `torque [Nm]` and `speed [rpm]`.
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
    Table(Lookup<Chain>),
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
            .help("write `value: 0.97`, or `file:` with a table")),
    }
}

impl ChainModel for Efficiency {
    fn loss(&self, at: &ChainAt<'_>) -> Result<Loss, Undefined> {
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
                what: "efficiency of the chain or belt, which is not between 0 and 1",
                value,
            });
        }
        let value = at.observe(&EFFICIENCY, value);
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        Ok(Loss::POWERS.with(&STATED, (1.0 - value) * input))
    }
}

register!(Chain, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.97 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [STATED], observed: [EFFICIENCY], prepare: prepare);
