//! Worm drives with known efficiencies: numbers, or a table over the quantities of the mesh.
//!
//! User-defined: P = (1 - eta) P_in. For drives whose efficiency has been measured or is stated by a maker. If only that of the driving worm is
//! stated, the other one has the same friction: tan rho = (1 - eta)/(tan gamma + eta/tan gamma), eta_back = (1 - tan rho/tan gamma)/(1 +
//! tan rho tan gamma).

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::{Lookup, PLACE};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::worm_mesh::{WormMesh, WormMeshAt, WormMeshModel};
use gearloss_framework::registry::{Build, Check, Evidence, USER_DEFINED, default_of, formula};
use gearloss_framework::table::{Interpolation, Outside, Reading};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::SLIDING;
use crate::checks::SIX_DIGITS;

observed! { EFFICIENCY = ("eta_z", "-", "efficiency in the direction of the power; below zero both must be driven"); }

/// Efficiencies of both directions of power: numbers, or a table over quantities of the mesh.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Efficiency if the worm drives, instead of a table. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub worm_drives: Option<f64>,
    /// Efficiency if the wheel drives; zero or less: self-locking, and the worm must be driven as well. Default: with the friction of
    /// `worm_drives`. [-]
    #[schemars(range(min = -20.0, max = 1.0))]
    pub wheel_drives: Option<f64>,
    /// CSV file with the efficiency over one to four quantities, such as `torque [Nm]`, `speed [rpm]` and `first_drives [-]`.
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
    Values([f64; 2]),
    Table(Lookup<WormMesh>),
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency, Diagnostic> {
    match (params.worm_drives, params.file) {
        (Some(forward), None) => {
            let back = if let Some(back) = params.wheel_drives {
                back
            } else {
                let pair = &cx.own_part::<WormMesh>()?.pair;
                pair.efficiencies(pair.tan_rho_of(forward))[1]
            };
            Ok(Efficiency::Values([forward, back]))
        }
        (None, Some(file)) if params.wheel_drives.is_none() => {
            let reading = Reading {
                outside: params.outside,
                interpolation: params.interpolation,
                ..Reading::default()
            };
            Ok(Efficiency::Table(Lookup::read(&file, &reading, "-", cx)?))
        }
        _ => Err(cx
            .error("efficiency requires either `worm_drives` or `file`")
            .help("write `worm_drives: 0.8`, and `wheel_drives: 0.6` if it is known; or `file:` with a table, in which `first_drives` distinguishes both")),
    }
}

impl WormMeshModel for Efficiency {
    fn loss(&self, at: &WormMeshAt<'_>) -> Result<Loss, Undefined> {
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let value = match self {
            Self::Values([forward, back]) => {
                if at.worm_drives() {
                    *forward
                } else {
                    *back
                }
            }
            Self::Table(table) => {
                let (value, place) = table.value(at)?;
                at.check(&PLACE, place);
                value
            }
        };
        if value > 1.0 {
            return Err(Undefined {
                what: "efficiency of the mesh, which is above one",
                value,
            });
        }
        let value = at.observe(&EFFICIENCY, value);
        let input = at.show("P_in", "W", at.input());
        Ok(Loss::POWERS.with(&SLIDING, (1.0 - value) * input))
    }
}

register!(WormMesh, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, worm_drives: 0.8 }",
    evidence: [
        formula(Evidence::User, "the user states it"),
        default_of("wheel_drives", Evidence::Derived, "friction of the driving worm"),
    ],
    checks: [
        Check {
            input: "{ model: { type: efficiency, worm_drives: 0.83005031 }, at: { speed: 1500 rpm, torque: 10 Nm, first_drives: 0 } }",
            values: &[("eta_z", "0.799125")],
            ..SIX_DIGITS
        },
    ],
    limits: [PLACE], terms: [SLIDING], observed: [EFFICIENCY], geometry: true, prepare: prepare);
