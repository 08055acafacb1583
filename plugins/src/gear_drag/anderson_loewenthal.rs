//! Windage of one gear in air-oil mist after Anderson and Loewenthal.
//!
//! Source: Anderson, Loewenthal, NASA TP-1622 (1980), recalled: P = 2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 eta + 0.019)^0.2 in kW; n in
//! 1/min, R and b in m, eta in mPa s. The constants assume a mist; without viscosity only the viscous part falls away.

use gearloss_framework::loss::{Loss, Term, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;

const TERM: Term = Term::no_load(0, "windage");

/// Windage of one gear in air-oil mist after Anderson and Loewenthal.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct AndersonLoewenthal {
    /// Oil mist counts with its viscosity; else air alone.
    #[serde(default = "yes")]
    pub mist: bool,
}

fn yes() -> bool {
    true
}

/// Power from 1/min, m and mPa s. \[W\]
fn power(n: f64, r: f64, b: f64, eta: f64) -> f64 {
    2.82e-7 * (1.0 + 2.3 * b / r) * n.powf(2.8) * r.powf(4.6) * (0.028 * eta + 0.019).powf(0.2) * 1e3
}

impl GearDragModel for AndersonLoewenthal {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let eta = if self.mist { at.eta.mpa_s() } else { 0.0 };
        let power = power(at.speed.abs().rpm(), 0.5 * gear.working_diameter, gear.facewidth, eta);
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

register!(GearDrag, "anderson_loewenthal", AndersonLoewenthal,
    source: "Anderson, Loewenthal, NASA TP-1622 (1980)",
    example: "{ type: anderson_loewenthal }",
    evidence: [
        formula(Evidence::Recalled, "four independent windage laws agree within a factor of two"),
        default_of("mist", Evidence::Recalled, "as the original assumes"),
    ],
    terms: [TERM]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c14_published_gears() {
        for (value, printed) in [
            (power(10000.0, 0.100, 0.030, 20.0), 1700.87),
            (power(15000.0, 0.060, 0.025, 5.0), 451.821),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}
