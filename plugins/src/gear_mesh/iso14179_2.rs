//! Mesh loss from a loss factor and one mean coefficient of friction, as in ISO/TR 14179-2.
//!
//! Sources: loss factor of Ohlendorf (1958); mean friction of Schlenk (1994) as in ISO/TR 14179-2:2001:
//! P = T w mu H_v, mu = 0.048 (F_bt/b/(v_SC rho_redC))^0.2 eta^-0.05 Ra^0.25 X_L; F_bt/b in N/mm, v_SC in m/s, rho_redC in mm,
//! eta in mPa s at oil temperature, Ra in um as the mean of both flanks.
//! Dip-lubricated, case-hardened, ground gears. The two clamps of the method are options, because public programs omit them: below
//! 150 N/mm the friction is that at 150 N/mm, above 50 m/s that at 50 m/s. Not for superfinished flanks (the exponent of Ra
//! overestimates their friction) nor for pitch points outside the path of contact.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::checks::SIX_DIGITS;
use crate::mean_friction::schlenk::{LINE_LOAD, MU, Mesh, PITCH_SPEED, Schlenk, VISCOSITY};

terms! { SLIDING = load("sliding"); }
limits! {
    after LINE_LOAD, PITCH_SPEED, VISCOSITY;
    CONTACT_RATIO = ("eps_alpha", "transverse contact ratio", "-", 1.0, 2.0, "one to two pairs in contact");
    ADDENDUM = ("eps_1, eps_2", "addendum contact ratios", "-", 0.0, 1.0, "pitch point on the path of contact");
}
observed! {
    after MU;
    LOSS_FACTOR = ("H_v", "-", "tooth loss factor");
}

/// Loss factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LossFactor {
    /// After Ohlendorf: half of the load on each pair in double contact.
    #[default]
    Ohlendorf,
    /// Evenly shared load, the upper bound for helical gears.
    Uniform,
}

/// Loss factor of Ohlendorf and mean friction of Schlenk, as in ISO/TR 14179-2.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    /// Mean friction.
    #[serde(flatten)]
    pub friction: Schlenk,
    /// Loss factor.
    #[serde(default)]
    pub loss_factor: LossFactor,
}

/// One pair, prepared.
struct Mean {
    friction: Schlenk,
    loss_factor: f64,
    ohlendorf: bool,
    /// Ratio of the sum velocity at the pitch point to the pitch line velocity.
    sum_per_speed: f64,
}

impl Mean {
    fn new(params: Iso14179, pair: &Pair) -> Self {
        let loss_factor = match params.loss_factor {
            LossFactor::Ohlendorf => pair.loss_factor_ohlendorf(),
            LossFactor::Uniform => pair.loss_factor_uniform(),
        };
        Self {
            friction: params.friction,
            loss_factor,
            ohlendorf: params.loss_factor == LossFactor::Ohlendorf,
            sum_per_speed: 2.0 * pair.working_angle.sin(),
        }
    }
}

fn prepare(params: Iso14179, cx: &mut Build<'_>) -> Result<Mean, Diagnostic> {
    let part = cx.own_part::<GearMesh>()?;
    Ok(Mean::new(params, &part.pair))
}

impl GearMeshLaw for Mean {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let pair = &at.part.pair;
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let mesh = Mesh {
            line_load: (at.torque / pair.base_radius[0] / pair.facewidth).n_mm(),
            pitch_speed: at.speed.abs() * pair.working_radius[0],
            sum_per_speed: R::constant(self.sum_per_speed),
            radius: R::constant(pair.pitch_radius.mm()),
            eta: at.eta.mpa_s(),
            ra: R::constant(at.part.ra.um()),
            x_l: at.x_l,
        };
        let mu = self.friction.friction(&mesh, at.notes);
        if self.ohlendorf {
            at.check(&CONTACT_RATIO, R::constant(pair.contact_ratio));
            for ratio in pair.addendum_ratio {
                at.check(&ADDENDUM, R::constant(ratio));
            }
        }
        let factor = at.observe(&LOSS_FACTOR, R::constant(self.loss_factor));
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        let watts = at.show("P", "W", input * mu * factor);
        Ok(Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts)))
    }
}

register!(GearMesh, "iso14179_2", Iso14179,
    source: "ISO/TR 14179-2:2001; Ohlendorf 1958; Schlenk 1994",
    example: "{ type: iso14179_2 }",
    evidence: [
        formula(Evidence::SeveralSources, "formula and loss factor agree in several public sources"),
        default_of("x_l", Evidence::Disputed, "tables of X_L differ between standards and tests"),
        default_of("oil", Evidence::Disputed, "tables of X_L differ between standards and tests"),
        default_of("loss_factor", Evidence::SeveralSources, "as in the method"),
        default_of("clamp_line_load", Evidence::Recalled, "the method has the clamp, public programs omit it"),
        default_of("clamp_speed", Evidence::Disputed, "two interpretations of the clamp"),
        default_of("greatest", Evidence::Assumed, "above the boundary friction of lubricated steel"),
    ],
    checks: [
        Check {
            input: "{ model: { type: iso14179_2, x_l: 1, greatest: 0.2 }, at: { torque: 200 Nm, speed: 1500 rpm, eta: 13.28 mPa s } }",
            values: &[("F_bt/b", "422.293 N/mm"), ("v_SC", "4.38883 m/s"), ("mu_m", "0.0546486"), ("total", "341.024 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [LINE_LOAD, PITCH_SPEED, VISCOSITY, CONTACT_RATIO, ADDENDUM], terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gear_mesh::path_integral::tests::fzg_c14;
    use crate::mean_friction::schlenk::{Constants, SpeedClamp};
    use gearloss_framework::loss::Notes;

    const PLAIN: Iso14179 = Iso14179 {
        friction: Schlenk {
            coefficients: Constants::PUBLISHED,
            x_l: Some(1.0),
            oil: None,
            clamp_line_load: true,
            clamp_speed: SpeedClamp::SumSpeed,
            greatest: 0.2,
        },
        loss_factor: LossFactor::Ohlendorf,
    };

    #[test]
    fn loss_vanishes_with_torque_and_speed_and_rises_with_torque() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let watts = |torque: f64, speed: f64| {
            let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
                to.torque = torque;
                to.speed = speed;
            });
            Mean::new(PLAIN, &part.pair).loss(&at).unwrap().total_watts(speed)
        };
        assert_eq!((watts(0.0, 100.0), watts(10.0, 0.0)), (0.0, 0.0));
        assert!(watts(20.0, 100.0) > watts(10.0, 100.0) && watts(10.0, 100.0) == watts(10.0, -100.0));
    }
}
