//! Mesh loss by a loss factor and one mean coefficient of friction, as ISO/TR 14179-2 does.
//!
//! Sources: loss factor of Ohlendorf (1958); mean friction of Schlenk (1994) as in ISO/TR 14179-2:2001:
//! P = T w mu H_v, mu = 0.048 (F_bt/b/(v_SC rho_redC))^0.2 eta^-0.05 Ra^0.25 X_L; F_bt/b in N/mm, v_SC in m/s, rho_redC in mm,
//! eta in mPa s at oil temperature, Ra in um as the mean of both flanks.
//! Dip-lubricated, case-hardened, ground gears. The two clamps of the method are options, because open programs leave them
//! out: below 150 N/mm the friction stays that of 150 N/mm, above 50 m/s that of 50 m/s.
//! Not for superfinished flanks (the exponent of Ra overrates them) nor for pitch points outside of the path of contact.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::{Limit, Loss, Observed, Term, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const SLIDING: Term = Term::load(0, "sliding");
const LINE_LOAD: Limit = Limit::new(0, "F_bt/b", "N/mm", 150.0, 3000.0, "lower clamp of the method");
const PITCH_SPEED: Limit = Limit::new(1, "v_t", "m/s", 0.0, 60.0, "tests behind the method");
const VISCOSITY: Limit = Limit::new(2, "eta", "mPa s", 5.0, 500.0, "tests behind the method, recalled");
const CONTACT_RATIO: Limit = Limit::new(3, "eps_alpha", "-", 1.0, 2.0, "one to two pairs in contact");
const MU: Observed = Observed::new(0, "mu_m", "-", "Mean coefficient of friction.");
const LOSS_FACTOR: Observed = Observed::new(1, "H_v", "-", "Tooth loss factor.");

/// The speed at which the friction stops falling. \[m/s\]
const FASTEST: f64 = 50.0;
/// The line load below which the friction stops falling. \[N/mm\]
const LIGHTEST: f64 = 150.0;

/// Which speed the upper clamp holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpeedClamp {
    /// The sum of the surface speeds at the pitch point stays at 50 m/s.
    #[default]
    SumSpeed,
    /// The sum of the surface speeds stays at that of 50 m/s pitch line speed.
    PitchSpeed,
    /// No clamp.
    None,
}

/// Which loss factor counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LossFactor {
    /// Halved load in double contact, after Ohlendorf.
    #[default]
    Ohlendorf,
    /// Evenly spread load, the upper bracket of helical gears.
    Uniform,
}

/// Mesh loss by a loss factor and a mean coefficient of friction.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso14179 {
    /// Lubricant factor; absent, that of the oil. [-]
    #[schemars(range(min = 0.1, max = 2.0))]
    pub x_l: Option<f64>,
    /// Below 150 N/mm the friction stays that of 150 N/mm.
    #[serde(default = "yes")]
    pub clamp_line_load: bool,
    /// Which speed the upper clamp holds.
    #[serde(default)]
    pub clamp_speed: SpeedClamp,
    /// Which loss factor counts.
    #[serde(default)]
    pub loss_factor: LossFactor,
}

fn yes() -> bool {
    true
}

/// Friction from shop units: N/mm, m/s, mm, mPa s, um.
fn schlenk(line_load: f64, sum_speed: f64, radius: f64, eta: f64, ra: f64, x_l: f64) -> f64 {
    // One root in place of three powers: 0.2, -0.05 and 0.25 are multiples of 0.05.
    0.048 * ((line_load / (sum_speed * radius)).powi(4) / eta * ra.powi(5)).powf(0.05) * x_l
}

/// One pair, prepared.
struct Mean {
    params: Iso14179,
    loss_factor: f64,
    /// Sum of the surface speeds at the pitch point over the pitch line speed.
    sum_per_speed: f64,
}

impl Mean {
    fn new(params: Iso14179, pair: &Pair) -> Self {
        let loss_factor = match params.loss_factor {
            LossFactor::Ohlendorf => pair.loss_factor_ohlendorf(),
            LossFactor::Uniform => pair.loss_factor_uniform(),
        };
        Self {
            params,
            loss_factor,
            sum_per_speed: 2.0 * pair.working_angle.sin(),
        }
    }
}

fn prepare(params: Iso14179, cx: &mut Build<'_>) -> Result<Mean, Diagnostic> {
    let part = cx.part::<GearMesh>().ok_or_else(|| cx.error("bug: no pair"))?;
    Ok(Mean::new(params, &part.pair))
}

impl GearMeshModel for Mean {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        let (pair, params) = (&at.part.pair, &self.params);
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let line_load = at.check(&LINE_LOAD, (at.torque / pair.base_radius[0] / pair.facewidth).n_mm());
        let line_load = if params.clamp_line_load && line_load < LIGHTEST {
            at.branch("line load below 150 N/mm: held there");
            LIGHTEST
        } else {
            line_load
        };
        let v_t = at.check(&PITCH_SPEED, at.speed.abs() * pair.working_radius[0]);
        let v_t_held = if params.clamp_speed == SpeedClamp::PitchSpeed {
            v_t.min(FASTEST)
        } else {
            v_t
        };
        let sum = self.sum_per_speed * v_t_held;
        let sum = if params.clamp_speed == SpeedClamp::SumSpeed {
            sum.min(FASTEST)
        } else {
            sum
        };
        let sum = at.show("v_SC", "m/s", sum);
        let radius = at.show("rho_redC", "mm", pair.pitch_radius.mm());
        let eta = at.check(&VISCOSITY, at.eta.mpa_s());
        at.check(&CONTACT_RATIO, pair.contact_ratio);
        let x_l = at.show("X_L", "-", params.x_l.unwrap_or(at.x_l));
        let ra = at.show("Ra", "um", at.part.ra.um());
        let mu = at.observe(&MU, schlenk(line_load, sum, radius, eta, ra, x_l));
        let factor = at.observe(&LOSS_FACTOR, self.loss_factor);
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        Ok(Loss::POWERS.with(&SLIDING, at.show("P", "W", input * mu * factor)))
    }
}

register!(GearMesh, "iso14179_2", Iso14179,
    meaning: "Loss factor of Ohlendorf and mean friction of Schlenk, as in ISO/TR 14179-2.",
    source: "ISO/TR 14179-2:2001; Ohlendorf 1958; Schlenk 1994",
    example: "{ type: iso14179_2 }",
    evidence: [
        formula(Evidence::SeveralSources, "formula and loss factor agree in several open sources"),
        default_of("clamp_line_load", Evidence::Recalled, "the clamp stands in the method but not in open programs"),
        default_of("clamp_speed", Evidence::Disputed, "two readings of the clamp"),
    ],
    limits: [LINE_LOAD, PITCH_SPEED, VISCOSITY, CONTACT_RATIO], terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gear_mesh::path_integral::tests::fzg_c14;
    use gearloss_framework::loss::Notes;

    const PLAIN: Iso14179 = Iso14179 {
        x_l: Some(1.0),
        clamp_line_load: true,
        clamp_speed: SpeedClamp::SumSpeed,
        loss_factor: LossFactor::Ohlendorf,
    };

    #[test]
    fn b2_fzg_c14_at_200_nm() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let speed = 1500.0 * std::f64::consts::PI / 30.0;
        let at = GearMeshAt {
            torque: 200.0,
            speed,
            eta: 13.28e-3,
            ..GearMeshAt::usual(&part, Notes::MUTED)
        };
        let watts = Mean::new(PLAIN, &part.pair).loss(&at).unwrap().total_watts(speed);
        assert!((watts / 341.024 - 1.0).abs() < 1e-5, "{watts}");
        let line_load = 200.0 / part.pair.base_radius[0] / part.pair.facewidth * 1e-3;
        assert!((line_load / 422.293 - 1.0).abs() < 1e-5);
        let sum = 2.0 * speed * part.pair.working_radius[0] * part.pair.working_angle.sin();
        assert!((sum / 4.38883 - 1.0).abs() < 1e-5);
        let mu = schlenk(line_load, sum, part.pair.pitch_radius * 1e3, 13.28, 0.4, 1.0);
        assert!((mu / 0.0546486 - 1.0).abs() < 1e-5, "{mu}");
    }

    #[test]
    fn b2_both_clamps() {
        let mu = |w: f64, v: f64| schlenk(w, v, 9.0, 20.0, 0.5, 0.8);
        assert!((mu(150.0, 50.0) / 0.0223151 - 1.0).abs() < 1e-5);
        assert!((mu(80.0, 62.0) / 0.0188501 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn b2b_mean_friction_level() {
        assert!((schlenk(300.0, 8.0, 8.0, 20.0, 0.4, 1.0) / 0.0447603 - 1.0).abs() < 1e-5);
        assert!((schlenk(200.0, 4.0, 12.0, 60.0, 0.8, 0.8) / 0.039369 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn loss_vanishes_with_torque_and_speed_and_rises_with_torque() {
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let watts = |torque: f64, speed: f64| {
            let at = GearMeshAt {
                torque,
                speed,
                ..GearMeshAt::usual(&part, Notes::MUTED)
            };
            Mean::new(PLAIN, &part.pair).loss(&at).unwrap().total_watts(speed)
        };
        assert_eq!((watts(0.0, 100.0), watts(10.0, 0.0)), (0.0, 0.0));
        assert!(watts(20.0, 100.0) > watts(10.0, 100.0) && watts(10.0, 100.0) == watts(10.0, -100.0));
    }
}
