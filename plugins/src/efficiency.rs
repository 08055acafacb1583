//! A known efficiency of a mesh, chain or joint: a number, or a table over the quantities of the mechanism.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Term, Undefined};
use gearloss_framework::mechanism::{Inputs as _, Mechanism};
use gearloss_framework::registry::Build;
use gearloss_framework::table::{Interpolation, Outside, Reading};
use gearloss_framework::{observed, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { pub SLIDING = load("sliding"); }
observed! { pub EFFICIENCY = ("eta", "-", "efficiency"); }

/// Loss from a known efficiency: a number, or a table over the quantities of the mechanism.
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

/// A number, or a table over the quantities of the mechanism.
pub enum Efficiency<M: Mechanism> {
    Value(f64),
    Table(Lookup<M>),
}

impl<M: Mechanism> Efficiency<M> {
    pub fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Self, Diagnostic> {
        match (params.value, params.file) {
            (Some(value), None) => Ok(Self::Value(value)),
            (None, Some(file)) => {
                let reading = Reading {
                    outside: params.outside,
                    interpolation: params.interpolation,
                    ..Reading::default()
                };
                Ok(Self::Table(Lookup::read(&file, &reading, "-", cx)?))
            }
            _ => Err(cx
                .error("efficiency requires either `value` or `file`")
                .help("write `value: 0.985`, or `file:` with a table")),
        }
    }

    /// The loss as `term` at a torque in Nm and a speed in rad/s of the side that states both.
    pub fn loss(&self, at: &M::At<'_, f64>, [torque, speed]: [f64; 2], term: &Term) -> Result<Loss, Undefined> {
        let notes = at.notes();
        if speed == 0.0 || torque == 0.0 {
            notes.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let value = match self {
            Self::Value(value) => *value,
            Self::Table(table) => {
                let (value, place) = table.value(at)?;
                notes.check(&PLACE, place);
                value
            }
        };
        if !(0.0..=1.0).contains(&value) {
            return Err(Undefined {
                what: "efficiency, which is not between 0 and 1",
                value,
            });
        }
        let value = notes.observe(&EFFICIENCY, value);
        let input = notes.show("P_in", "W", torque * speed.abs());
        Ok(Loss::POWERS.with(term, (1.0 - value) * input))
    }
}
