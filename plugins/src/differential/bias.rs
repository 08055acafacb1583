//! Differential with a stated torque bias, such as the locking value of a limited slip differential or the torque bias ratio of its maker.
//!
//! User-defined: S = (T_slow - T_fast)/T_case, or T_slow/T_fast = (1 + S)/(1 - S), for differentials whose friction is proportional to
//! torque: open ones with a known bias, and worm or helical gear differentials. The loss is (T_slow - T_fast) |w_left - w_right|/2.
//! While the wheels drive the case, the faster side carries more, with the same bias. Preload is stated as `locking` of the differential.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::differential::{Differential, DifferentialAt, DifferentialLaw};
use gearloss_framework::registry::{Build, Check, Evidence, USER_DEFINED, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::BY_HAND;

terms! { STATED = load("stated"); }

/// Differential with a stated torque bias, such as the locking value of a limited slip differential or the torque bias ratio of its maker.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Locking value S, the difference of the torques of both sides over their sum. [-]
    #[schemars(range(min = 0.0, max = 0.99))]
    pub value: Option<f64>,
    /// Torque bias ratio, torque of the slower side over that of the faster one, instead of `value`. [-]
    #[schemars(range(min = 1.0, max = 200.0))]
    pub ratio: Option<f64>,
}

struct Bias {
    /// Share of the torque of the driving side gear that is lost.
    share: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Bias, Diagnostic> {
    let share = match (params.value, params.ratio) {
        (Some(value), None) => 2.0 * value / (1.0 + value),
        (None, Some(ratio)) => 1.0 - 1.0 / ratio,
        _ => {
            return Err(cx
                .error("bias requires either `value` or `ratio`")
                .help("write `value: 0.4`, the locking value, or `ratio: 2.3`, the torque bias ratio"));
        }
    };
    Ok(Bias { share })
}

impl DifferentialLaw for Bias {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &DifferentialAt<'_, R>) -> Result<Loss<R>, Undefined> {
        Ok(Loss::POWERS.with(&STATED, at.torque * at.speed.abs() * self.share))
    }
}

register!(Differential, "bias", Params,
    source: USER_DEFINED,
    example: "{ type: bias, value: 0.1 }",
    evidence: [formula(Evidence::User, "the user states it")],
    checks: [
        Check {
            input: "{ model: { type: bias, value: 0.4 }, at: { torque: 700 Nm, speed: 5 rad/s } }",
            values: &[("total", "2000 W")],
            ..BY_HAND
        },
        Check {
            input: "{ model: { type: bias, ratio: 3.5 }, at: { torque: 700 Nm, speed: 5 rad/s } }",
            values: &[("total", "2500 W")],
            ..BY_HAND
        },
    ],
    terms: [STATED], prepare: prepare);
