//! Mesh loss from a mean friction law and the tooth loss factor of an evenly shared load.
//!
//! Derived: P = P_in mu_m H_v with every pair carrying the share 1/eps_alpha along the whole path: H_v = pi (u + 1)/(z1 u cos
//! beta_b) (eps_1^2 + eps_2^2)/eps_alpha, with u - 1 for internal pairs. This is the limit of helical gears with a large overlap
//! ratio and 10 to 25 % above Ohlendorf: an upper bound.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::mechanism::mean_friction::MeanFriction;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::factor::{Factor, LOSS_FACTOR, MU, SLIDING};
use crate::checks::{SIX_DIGITS, helical, internal};

/// Mesh loss from a mean friction law and the tooth loss factor of an evenly shared load.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Law of the mean coefficient of friction.
    pub mean_friction: ModelRef<MeanFriction>,
}

struct EvenShare(Factor);

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<EvenShare, Diagnostic> {
    let friction = cx.slot("mean_friction", &params.mean_friction)?;
    let part = cx.own_part::<GearMesh>()?;
    Ok(EvenShare(Factor::new(part.pair.loss_factor_uniform(), friction)))
}

impl GearMeshLaw for EvenShare {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        self.0.loss(at)
    }
}

register!(GearMesh, "even_share", Params,
    source: "derived; equal to the geometry factor of ISO/TR 14179-1 for spur gears",
    example: "{ type: even_share, mean_friction: { type: schlenk } }",
    evidence: [formula(Evidence::Derived, "follows from even load sharing; equals 1/M of ISO/TR 14179-1 for spur gears")],
    checks: [
        Check {
            input: "{ model: { type: even_share, mean_friction: { type: constant, value: 0.05 } }, at: { torque: 100 Nm, \
                    speed: 100 rad/s } }",
            values: &[("H_v", "0.239309"), ("total", "119.6545 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: even_share, mean_friction: { type: constant, value: 0.05 } }, part: ", helical!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.116033"), ("total", "58.0165 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: even_share, mean_friction: { type: constant, value: 0.05 } }, part: ", internal!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0732882"), ("total", "36.6441 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);
