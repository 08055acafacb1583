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
use gearloss_framework::registry::{Build, Evidence, ModelRef, formula};
use gearloss_framework::{limits, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::factor::{Factor, LOSS_FACTOR, MU, SLIDING};

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
    Ok(Ohlendorf(Factor {
        value: part.pair.loss_factor_ohlendorf(),
        friction,
    }))
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
    limits: [CONTACT_RATIO, ADDENDUM], terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);

#[cfg(test)]
mod tests {
    use crate::gear_mesh::path_integral::tests::{Kind, loss_factor};

    #[test]
    fn b1_ohlendorf() {
        for (kind, printed) in [
            (Kind::Spur, 0.198635),
            (Kind::Helical, 0.0995648),
            (Kind::Internal, 0.0638342),
        ] {
            let factor = loss_factor(&serde_json::json!({ "type": "ohlendorf" }), kind);
            assert!((factor / printed - 1.0).abs() < 1e-5, "{factor} {printed}");
        }
    }
}
