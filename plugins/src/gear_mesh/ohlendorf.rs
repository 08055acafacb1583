//! Mesh loss from the tooth loss factor of Ohlendorf and a mean friction law.
//!
//! Source: Ohlendorf 1958; Niemann/Winter: P = P_in mu_m H_v, H_v = pi (u + 1)/(z1 u cos beta_b) (1 - eps_alpha + eps_1^2 + eps_2^2),
//! with u - 1 for internal pairs. It is the exact mean over the mesh cycle if each pair carries half of the load in double contact,
//! friction is constant, the pitch point is on the path of contact and one to two pairs are in contact. Otherwise use `wimmer` or
//! `path_integral`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::mechanism::mean_friction::MeanFriction;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, formula};
use gearloss_framework::{limits, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::factor::{Factor, LOSS_FACTOR, MU, SLIDING};
use crate::checks::{SIX_DIGITS, helical, internal};

limits! {
    CONTACT_RATIO = ("eps_alpha", "transverse contact ratio", "-", 1.0, 2.0, "one to two pairs in contact");
    ADDENDUM = ("eps_1, eps_2", "addendum contact ratios", "-", 0.0, 1.0, "pitch point on the path of contact");
}

/// Mesh loss from the tooth loss factor of Ohlendorf and a mean friction law.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Law of the mean coefficient of friction.
    pub mean_friction: ModelRef<MeanFriction>,
}

struct Ohlendorf(Factor);

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ohlendorf, Diagnostic> {
    let friction = cx.slot("mean_friction", &params.mean_friction)?;
    let part = cx.own_part::<GearMesh>()?;
    Ok(Ohlendorf(Factor::new(part.pair.loss_factor_ohlendorf(), friction)))
}

impl GearMeshLaw for Ohlendorf {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        at.check(&CONTACT_RATIO, R::constant(at.part.pair.contact_ratio));
        for ratio in at.part.pair.addendum_ratio {
            at.check(&ADDENDUM, R::constant(ratio));
        }
        self.0.loss(at)
    }
}

register!(GearMesh, "ohlendorf", Params,
    source: "Ohlendorf 1958; Niemann/Winter, Maschinenelemente 2",
    example: "{ type: ohlendorf, mean_friction: { type: schlenk } }",
    evidence: [formula(Evidence::SeveralSources, "four sources and the derivation agree")],
    checks: [
        Check {
            input: "{ model: { type: ohlendorf, mean_friction: { type: constant, value: 0.05 } }, at: { torque: 100 Nm, \
                    speed: 100 rad/s } }",
            values: &[("H_v", "0.198635"), ("total", "99.3175 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: ohlendorf, mean_friction: { type: constant, value: 0.05 } }, part: ", helical!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0995648"), ("total", "49.7824 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: ohlendorf, mean_friction: { type: constant, value: 0.05 } }, part: ", internal!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0638342"), ("total", "31.9171 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [CONTACT_RATIO, ADDENDUM], terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);
