//! Radial lip seals according to Niemann and Winter, with a user-defined coefficient.
//!
//! Source: Niemann/Winter, Maschinenelemente 2, as quoted by Concli: P = lambda_L d^2 n/1000 in W, d in mm, n in 1/min. No value of
//! lambda_L is published; it depends on temperature and wear. 7.69e-3 gives the law of Linke. A number, or a table over quantities
//! of the seal such as `temperature [degC]`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use gearloss_framework::table::{Outside, Reading};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::SIX_DIGITS;

terms! { LIP = no_load("lip"); }

/// Radial lip seals with a user-defined coefficient, a number or a table.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Coefficient lambda_L, instead of a table. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub lambda_l: Option<f64>,
    /// CSV file with lambda_L over one to four quantities.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: Option<String>,
    /// Extrapolation of the table.
    #[serde(default)]
    pub outside: Outside,
}

enum NiemannWinter {
    Value(f64),
    Table(Lookup<Seal>),
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<NiemannWinter, Diagnostic> {
    match (params.lambda_l, params.file) {
        (Some(value), None) => Ok(NiemannWinter::Value(value)),
        (None, Some(file)) => {
            let reading = Reading {
                outside: params.outside,
                ..Reading::default()
            };
            Ok(NiemannWinter::Table(Lookup::read(&file, &reading, "-", cx)?))
        }
        _ => Err(cx
            .error("niemann_winter requires either `lambda_l` or `file`")
            .help("write `lambda_l: 7.69e-3`, which is the law of Linke, or your own value")),
    }
}

/// Friction torque from the coefficient and the diameter in mm. \[Nm\]
fn moment(lambda: f64, d: f64) -> f64 {
    lambda * d * d * 1e-3 / (std::f64::consts::PI / 30.0)
}

impl SealModel for NiemannWinter {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        let lambda = match self {
            Self::Value(value) => *value,
            Self::Table(table) => {
                let (value, place) = table.value(at)?;
                at.check(&PLACE, place);
                value
            }
        };
        if lambda < 0.0 {
            return Err(Undefined {
                what: "coefficient lambda_L, which is negative",
                value: lambda,
            });
        }
        let lambda = at.show("lambda_L", "-", lambda);
        Ok(Loss::MOMENTS.with(&LIP, at.show("T", "Nm", moment(lambda, at.part.diameter.mm()))))
    }
}

register!(Seal, "niemann_winter", Params,
    source: "Niemann/Winter, Maschinenelemente 2, as quoted by Concli 2015",
    example: "{ type: niemann_winter, lambda_l: 7.69e-3 }",
    evidence: [formula(Evidence::OneSource, "one article; the user states the coefficient")],
    checks: [
        Check {
            input: "{ model: { type: niemann_winter, lambda_l: 7.69e-3 }, part: { diameter: 40 mm }, at: { speed: 3000 rpm } }",
            values: &[("total", "36.9120 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [PLACE], terms: [LIP], prepare: prepare);
