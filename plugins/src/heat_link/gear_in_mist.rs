//! A gear rotating in oil, air or a mist of both: its sides and its toothed face.
//!
//! Sources: Olver, IMechE G 205 (1991) 35-43 (sides and track of a gear); rotating disc in free fluid, laminar and turbulent; rotating
//! cylinder according to Becker, Int. J. Heat Mass Transfer 6 (1963) 1053-1062, Nu = 0.133 Re^(2/3) Pr^(1/3) with the diameter and the speed of
//! the surface, 1e3 < Re < 1e5. Mist properties are weighted by volume, its specific heat by mass. At standstill the heat transfer
//! is zero: free convection is not included.
//!
//! The least certain of all links: the pinion of a small stage at 2000 rpm has 0.064 K/W in pure oil and about 3 K/W in air. Some
//! authors use twice Becker's Reynolds number, which gives 1.6 times the heat transfer on the toothed face.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{of_gear, oil};
use crate::rotating::Body;

limits! { REYNOLDS = ("Re_D", "Reynolds number of the gear", "-", 1e3, 1e5, "Becker 1963, toothed face as a cylinder"); }

/// A gear rotating in oil, air or a mist of both: its sides and its toothed face.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Tip diameter; default: that of the gear. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub tip_diameter: Option<f64>,
    /// Face width; default: that of the gear. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: Option<f64>,
    /// Volume fraction of oil in the mist: 0.02 to 0.2 splash, 1 submerged. [-]
    #[serde(default = "mist")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fraction: f64,
    /// Ratio of the shaft or hub radius to the tip radius; the sides do not dissipate heat inside it. [-]
    #[serde(default = "hub")]
    #[schemars(range(min = 0.0, max = 0.95))]
    pub hub_ratio: f64,
}

fn mist() -> f64 {
    0.1
}
fn hub() -> f64 {
    0.6
}

struct Gear {
    body: Body,
    oil_fraction: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Gear, Diagnostic> {
    let diameter = of_gear(
        params.tip_diameter,
        |g| g.tip_diameter,
        "the tip diameter",
        "tip_diameter: 60 mm",
        cx,
    )?;
    let tip = 0.5 * diameter;
    Ok(Gear {
        body: Body {
            sides: [tip, params.hub_ratio * tip],
            track: tip,
            facewidth: of_gear(
                params.facewidth,
                |g| g.facewidth,
                "the face width",
                "facewidth: 30 mm",
                cx,
            )?,
        },
        oil_fraction: params.oil_fraction,
    })
}

impl HeatLinkModel for Gear {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let mist = oil(at).mist(self.oil_fraction);
        at.check(&REYNOLDS, mist.cylinder_reynolds(self.body.track, at.speed));
        at.show("alpha_side", "W/(m2 K)", mist.disc(self.body.sides[0], at.speed));
        at.show("alpha_track", "W/(m2 K)", mist.cylinder(self.body.track, at.speed));
        Ok(at.show("G", "W/K", self.body.conductance(&mist, at.speed)))
    }
}

register!(HeatLink, "gear_in_mist", Params,
    source: "Olver 1991; Becker, Int. J. Heat Mass Transfer 6 (1963) 1053-1062",
    example: "{ type: gear_in_mist }",
    evidence: [
        formula(Evidence::Disputed, "two definitions of the cylinder's Reynolds number exist; a gear is not a smooth cylinder"),
        default_of("oil_fraction", Evidence::Assumed, "splash lubrication, middle of 0.02 to 0.2"),
        default_of("hub_ratio", Evidence::Assumed, "a typical solid gear"),
    ],
    limits: [REYNOLDS], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn pinion(oil_fraction: f64) -> Gear {
        let params = Params {
            tip_diameter: Some(2.0 * 0.0298),
            facewidth: Some(0.030),
            oil_fraction,
            hub_ratio: 0.018 / 0.0298,
        };
        built(prepare, params).unwrap()
    }

    #[test]
    fn u4g_pinion_in_pure_oil() {
        // A specific heat that gives Pr = 143.
        let (k, nu, rho) = (0.14, 1.2e-5, 820.0);
        let part = HeatLinkPart::default();
        let here = at(&part, 209.4395, [k, nu, rho, 143.0 * k / (nu * rho)]);
        close(1.0 / pinion(1.0).conductance(&here).unwrap(), 0.06418579);
    }

    #[test]
    fn more_oil_and_more_speed_cool_more_and_rest_cools_nothing() {
        let part = HeatLinkPart::default();
        let link = |share, speed| {
            let here = at(&part, speed, [0.14, 1.2e-5, 820.0, 2100.0]);
            pinion(share).conductance(&here).unwrap()
        };
        assert!(link(0.1, 0.0).abs() < f64::MIN_POSITIVE);
        let shares = [0.0, 0.05, 0.2, 1.0].map(|share| link(share, 200.0));
        assert!(shares.windows(2).all(|g| g[1] > g[0]), "{shares:?}");
        // About 3 K/W in air.
        assert!((2.0..4.0).contains(&(1.0 / shares[0])), "{shares:?}");
        let speeds = [1.0, 10.0, 100.0, 1000.0].map(|w| link(0.1, w));
        assert!(speeds.windows(2).all(|g| g[1] > g[0]), "{speeds:?}");
    }

    #[test]
    fn a_missing_tip_diameter_is_named() {
        let params = Params {
            tip_diameter: None,
            facewidth: None,
            oil_fraction: 0.1,
            hub_ratio: 0.6,
        };
        let error = built(prepare, params).err().unwrap();
        assert!(error.contains("tip_diameter: 60 mm"), "{error}");
    }
}
