//! Gap between a rotating shaft or rotor and its bore, such as the air gap of an electric motor.
//!
//! Source: Becker and Kaye, J. Heat Transfer 84 (1962) 97-104, quoted from memory: with Ta^2 = omega^2 r_m d^3/nu^2, r_m = r_i + d/2 and the
//! gap factor F_g, X = Ta^2/F_g gives Nu = 2 below 1700, 0.128 X^0.367 up to 1e4, 0.409 X^0.241 up to 1e7; alpha = Nu k/(2 d)
//! refers to the total temperature difference between rotor and bore, with the area at the mean circumference. Nu = 2 is conduction
//! through the gap.
//!
//! The data are for air. In oil the two upper branches are multiplied by (Pr/0.7)^0.3 according to Aoki, Nohira and Arai, Bull. JSME 10
//! (1967) 523-532, quoted from memory, who measured from X = 5e3 on. Between the onset of vortices and that value the exponent rises from
//! zero, so that the law is continuous. No axial flow, smooth surfaces; slots increase the heat transfer. Oil properties are taken
//! at the mean temperature of both nodes; properties of a mixture with air are weighted by volume, its specific heat by mass.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::oil;

limits! { TAYLOR = ("Ta^2/F_g", "Taylor number of the air gap", "-", 0.0, 1e7, "Becker and Kaye 1962, quoted from memory"); }
observed! {
    NUSSELT = ("Nu", "-", "Nusselt number over twice the gap");
    ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient for the total temperature difference");
}

/// Onset of vortices in the gap.
const ONSET: f64 = 1700.0;
/// Start of the second vortex branch.
const DEVELOPED: f64 = 1e4;
/// Prandtl number of air in the data.
const OF_AIR: f64 = 0.7;
/// Minimum X of the data for liquids.
const LIQUIDS: f64 = 5e3;

/// Part of the gap that the link crosses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// From the rotor to the bore.
    #[default]
    Both,
    /// From rotor or bore to a node in the middle of the gap, such as the oil in it: twice the coefficient.
    One,
}

/// Gap between a rotating shaft or rotor and its bore.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Radius of the rotor. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub radius: f64,
    /// Radial gap. [mm]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub gap: f64,
    /// Length of the gap. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub length: f64,
    /// Volume fraction of oil in the gap: 0 air, 1 full of oil. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fraction: f64,
    /// Part of the gap that the link crosses.
    #[serde(default)]
    pub sides: Sides,
    /// Apply the Prandtl number correction: vortices in oil transfer more heat than in air.
    #[serde(default = "yes")]
    pub prandtl_correction: bool,
}

fn yes() -> bool {
    true
}

struct Annulus {
    params: Params,
    mean_radius: f64,
    factor: f64,
}

/// Gap factor F_g from gap over mean radius, about one for thin gaps.
fn gap_factor(ratio: f64) -> f64 {
    let inner = 1.0 - 0.5 * ratio;
    let p = 1.0 - 0.652 * ratio / inner;
    let p = 0.0571 * p + 0.00056 / p;
    PI.powi(4) / 1697.0 / (p * inner * inner)
}

/// Nusselt number over twice the gap from X = Ta^2/F_g, with a Prandtl number factor on the vortices.
fn nusselt(x: f64, prandtl: f64) -> f64 {
    if x <= ONSET {
        return 2.0;
    }
    let air = if x < DEVELOPED {
        0.128 * x.powf(0.367)
    } else {
        0.409 * x.powf(0.241)
    };
    let risen = ((x / ONSET).ln() / (LIQUIDS / ONSET).ln()).min(1.0);
    // The branches meet within 2 %; vortices do not reduce conduction.
    (air * (prandtl / OF_AIR).powf(0.3 * risen)).max(2.0)
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Annulus, Diagnostic> {
    if params.gap > params.radius {
        return Err(cx
            .error("the gap exceeds the rotor radius; no data cover this")
            .help("check the units of `gap` and `radius`"));
    }
    let mean_radius = params.radius + 0.5 * params.gap;
    Ok(Annulus {
        factor: gap_factor(params.gap / mean_radius),
        mean_radius,
        params,
    })
}

impl HeatLinkModel for Annulus {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let (gap, fluid) = (self.params.gap, oil(at).mist(self.params.oil_fraction));
        let taylor = at.show(
            "Ta^2",
            "-",
            (at.speed / fluid.nu()).powi(2) * self.mean_radius * gap.powi(3),
        );
        let x = at.check(&TAYLOR, taylor / self.factor);
        let prandtl = if self.params.prandtl_correction {
            fluid.prandtl()
        } else {
            OF_AIR
        };
        let nu = at.observe(&NUSSELT, nusselt(x, prandtl));
        let alpha = at.observe(&ALPHA, nu * fluid.conductivity / (2.0 * gap));
        let sides = match self.params.sides {
            Sides::Both => 1.0,
            Sides::One => 2.0,
        };
        let area = 2.0 * PI * self.mean_radius * self.params.length;
        Ok(at.show("alpha A", "W/K", sides * alpha * area))
    }
}

register!(HeatLink, "annulus", Params,
    source: "Becker, Kaye, J. Heat Transfer 84 (1962) 97-104",
    example: "{ type: annulus, radius: 75 mm, gap: 0.8 mm, length: 134 mm, oil_fraction: 0.2 }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; the branches join within 2 %, which supports the constants"),
        default_of("sides", Evidence::User, "a link from rotor to stator"),
        default_of("prandtl_correction", Evidence::Recalled, "Aoki, Nohira, Arai 1967; its onset is assumed"),
    ],
    limits: [TAYLOR], observed: [NUSSELT, ALPHA], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn gap(sides: Sides) -> Params {
        Params {
            radius: 0.075,
            gap: 0.8e-3,
            length: 0.134,
            oil_fraction: 1.0,
            sides,
            prandtl_correction: false,
        }
    }

    fn link(params: Params, rpm: f64, nu: f64) -> f64 {
        let part = HeatLinkPart::default();
        let model = built(prepare, params).unwrap();
        model
            .conductance(&at(&part, rpm * PI / 30.0, [0.14, nu, 820.0, 2100.0]))
            .unwrap()
    }

    #[test]
    fn u5f_u5h_gap_of_a_motor() {
        let (mean, ratio) = (0.0754, 0.8e-3 / 0.0754);
        let factor = gap_factor(ratio);
        close(factor, 1.013059);
        for (rpm, nu, ta2, nusselt_number, h) in [
            (500.0, 2e-5_f64, 264.5931, 2.0, 175.0),
            (3000.0, 2e-5, 9525.353, 3.676134, 321.6617),
            (9000.0, 1e-5, 342_912.7, 8.797202, 769.7552),
        ] {
            let taylor = (rpm * PI / 30.0 / nu).powi(2) * mean * 0.8e-3_f64.powi(3);
            close(taylor, ta2);
            close(nusselt(taylor / factor, OF_AIR), nusselt_number);
            let area = 2.0 * PI * mean * 0.134;
            close(link(gap(Sides::Both), rpm, nu), h * area);
            // Two links in series through a node in the middle equal the whole gap.
            close(0.5 * link(gap(Sides::One), rpm, nu), h * area);
        }
    }

    #[test]
    fn a_gap_at_rest_conducts_as_a_ring() {
        let ring = 2.0 * PI * 0.14 * 0.134 / (0.0758_f64 / 0.075).ln();
        let rest = link(gap(Sides::Both), 0.0, 2e-5);
        assert!((rest / ring - 1.0).abs() < 1e-4, "{rest} {ring}");
    }

    #[test]
    fn vortices_in_oil_set_in_without_a_jump() {
        for prandtl in [0.7, 100.0, 1000.0] {
            for x in [ONSET, LIQUIDS, DEVELOPED] {
                let ratio = nusselt(x * (1.0 + 1e-9), prandtl) / nusselt(x * (1.0 - 1e-9), prandtl);
                assert!((ratio - 1.0).abs() < 5e-3, "{x} {prandtl} {ratio}");
            }
            let steps: Vec<f64> = (0..400)
                .map(|i| nusselt(10f64.powf(0.02 * f64::from(i)), prandtl))
                .collect();
            assert!(steps.windows(2).all(|nu| nu[1] >= nu[0]), "{prandtl}");
        }
        close(
            nusselt(1e5, 143.0),
            0.409 * 1e5_f64.powf(0.241) * (143.0_f64 / 0.7).powf(0.3),
        );
    }

    #[test]
    fn a_gap_wider_than_the_rotor_is_refused() {
        let wide = Params {
            gap: 0.1,
            ..gap(Sides::Both)
        };
        assert!(built(prepare, wide).err().unwrap().contains("exceeds"));
    }
}
