//! Mesh loss from the local tooth loss factor and a mean friction law.
//!
//! Source: Wimmer 2006: P = P_in mu_m H_vL, H_vL = 1/p_et integral of K(x)/cos(beta_b) v_g/v_tb dx along the path of contact, v_tb
//! the speed of the base circle. With half of the load on each pair in double contact it equals the factor of Ohlendorf. It is also
//! valid if the pitch point is outside the path of contact, for more than two pairs, and for any load sharing.

use gearloss_framework::contact::sharing::SharingEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::mechanism::mean_friction::MeanFriction;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::factor::{Factor, LOSS_FACTOR, MU, SLIDING};
use crate::checks::{SIX_DIGITS, helical, internal};

/// Mesh loss from the local tooth loss factor and a mean friction law.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default)]
    pub load_sharing: SharingEntry,
    /// Law of the mean coefficient of friction.
    pub mean_friction: ModelRef<MeanFriction>,
}

struct Wimmer(Factor);

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Wimmer, Diagnostic> {
    let friction = cx.slot("mean_friction", &params.mean_friction)?;
    let part = cx.own_part::<GearMesh>()?.clone();
    let sharing = cx.load_sharing(&part, &params.load_sharing)?;
    Ok(Wimmer(Factor::of_sharing(&part.pair, &sharing, friction)))
}

impl GearMeshLaw for Wimmer {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        self.0.loss(at)
    }
}

register!(GearMesh, "wimmer", Params,
    source: "Wimmer 2006",
    example: "{ type: wimmer, load_sharing: contact_lines, mean_friction: { type: schlenk } }",
    evidence: [
        formula(Evidence::SeveralSources, "two sources and the derivation agree"),
        default_of("load_sharing", Evidence::Assumed, "rigid teeth"),
    ],
    checks: [
        Check {
            input: "{ model: { type: wimmer, load_sharing: rigid, mean_friction: { type: constant, value: 0.05 } }, \
                    at: { torque: 100 Nm, speed: 100 rad/s } }",
            values: &[("H_v", "0.198635"), ("total", "99.3175 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: wimmer, load_sharing: rigid, mean_friction: { type: constant, value: 0.05 } }, part: ", helical!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0995648"), ("total", "49.7824 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: wimmer, load_sharing: rigid, mean_friction: { type: constant, value: 0.05 } }, part: ", internal!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0638342"), ("total", "31.9171 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: wimmer, load_sharing: uniform, mean_friction: { type: constant, value: 0.05 } }, \
                    at: { torque: 100 Nm, speed: 100 rad/s } }",
            values: &[("H_v", "0.239309"), ("total", "119.6545 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: wimmer, load_sharing: uniform, mean_friction: { type: constant, value: 0.05 } }, part: ", helical!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.116033"), ("total", "58.0165 W")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: wimmer, load_sharing: uniform, mean_friction: { type: constant, value: 0.05 } }, part: ", internal!(), ", at: { torque: 100 Nm, speed: 100 rad/s } }"),
            values: &[("H_v", "0.0732882"), ("total", "36.6441 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);

#[cfg(test)]
mod tests {
    use crate::gear_mesh::path_integral::tests::{Kind, loss_factor};

    #[test]
    fn contact_lines_lie_between_rigid_and_even_share() {
        // Overlap ratio 1.54: the total length of the lines of contact varies half as much as that of spur gears.
        let factor = |sharing: &str| {
            loss_factor(
                &serde_json::json!({ "type": "wimmer", "load_sharing": sharing }),
                Kind::Helical,
            )
        };
        let lines = factor("contact_lines");
        assert!(factor("rigid") < lines && lines < 1.01 * factor("uniform"), "{lines}");
    }
}
