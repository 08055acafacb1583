//! Oil to casing inside: splash of an immersed gear, free convection at standstill.
//!
//! Sources: flow along a plate of the casing height at the tip speed of the gear, Nu = 0.664 Re^0.5 Pr^(1/3), as in the thermal
//! networks of Changenet, Oviedo-Marlot and Velex, J. Mech. Des. 128 (2006) 618-625, quoted from memory; free convection of the oil after
//! Churchill and Chu 1975, which remains at standstill; combined alpha^3 = alpha_n^3 + alpha_f^3. The wetted area grows with the
//! tip speed: A = A_rest + (A_inside - A_rest) min(1, u/u_full).
//!
//! Oil properties are taken at the mean temperature of both nodes. Splash usually gives 100 to 400 W/(m2 K).

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{of_gear, of_housing, oil};
use crate::convection::{Shape, along_plate, mixed, rayleigh};

limits! { RAYLEIGH = ("Ra", "Rayleigh number", "-", 0.0, 1e12, "Churchill and Chu 1975"); }
observed! {
    ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient from oil to casing");
    REYNOLDS = ("Re", "-", "Reynolds number over the height of the casing");
}

/// Oil to casing inside: splash of an immersed gear, free convection at standstill.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Tip diameter of the immersed gear; default: that of the gear named by the link. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub tip_diameter: Option<f64>,
    /// Height of the casing; default: that of the housing. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub height: Option<f64>,
    /// Inside area wetted when oil splashes everywhere; default: that of the housing. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub oil_area: Option<f64>,
    /// Share of that area wetted by the sump at standstill. [-]
    #[serde(default = "sump")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rest_share: f64,
    /// Tip speed above which oil splashes everywhere. [m/s]
    #[serde(default = "everywhere")]
    #[schemars(range(min = 0.01, max = 200.0))]
    pub full_speed: f64,
    /// Thermal expansion coefficient of the oil. [1/K]
    #[serde(default = "expansion")]
    #[schemars(range(min = 1e-5, max = 1e-2))]
    pub expansion: f64,
}

fn sump() -> f64 {
    0.3
}
fn everywhere() -> f64 {
    10.0
}
fn expansion() -> f64 {
    7.5e-4
}

struct Inside {
    tip_radius: f64,
    height: f64,
    area: f64,
    rest_share: f64,
    full_speed: f64,
    expansion: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Inside, Diagnostic> {
    let diameter = of_gear(
        params.tip_diameter,
        |g| g.tip_diameter,
        "the tip diameter of the immersed gear",
        "tip_diameter: 150 mm",
        cx,
    )?;
    Ok(Inside {
        tip_radius: 0.5 * diameter,
        height: of_housing(
            params.height,
            |h| h.height,
            "the height of the casing",
            "height: 300 mm",
            cx,
        )?,
        area: of_housing(
            params.oil_area,
            |h| h.oil_area,
            "the wetted area",
            "oil_area: 3500 cm2",
            cx,
        )?,
        rest_share: params.rest_share,
        full_speed: params.full_speed,
        expansion: params.expansion,
    })
}

impl Inside {
    /// Wetted area at a tip speed in m/s. \[m2\]
    fn wetted(&self, speed: f64) -> f64 {
        self.area * (self.rest_share + (1.0 - self.rest_share) * (speed / self.full_speed).min(1.0))
    }
}

impl HeatLinkModel for Inside {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let oil = oil(at);
        let speed = at.show("u", "m/s", at.speed * self.tip_radius);
        let re = at.observe(&REYNOLDS, speed * self.height / oil.nu());
        let difference = at.temperature_1 - at.temperature_2;
        let ra = rayleigh(self.expansion, difference, self.height, oil.nu(), oil.diffusivity());
        let ra = at.check(&RAYLEIGH, ra);
        let over = oil.conductivity / self.height;
        let splash = at.show("alpha_f", "W/(m2 K)", along_plate(re, oil.prandtl()) * over);
        let free = at.show("alpha_n", "W/(m2 K)", Shape::Plate.free(ra, oil.prandtl()) * over);
        let alpha = at.observe(&ALPHA, mixed(splash, free));
        let area = at.show("A", "m2", self.wetted(speed));
        Ok(at.show("alpha A", "W/K", alpha * area))
    }
}

register!(HeatLink, "oil_casing", Params,
    source: "Changenet, Oviedo-Marlot, Velex, J. Mech. Des. 128 (2006) 618-625; Churchill and Chu 1975",
    example: "{ type: oil_casing }",
    evidence: [
        formula(Evidence::Recalled, "plate law quoted from memory, not checked; growth of the wetted area assumed"),
        default_of("rest_share", Evidence::Assumed, "a sump of about a third of the height"),
        default_of("full_speed", Evidence::Assumed, "splash reaches all of a typical casing above about 10 m/s"),
        default_of("expansion", Evidence::SeveralSources, "mineral and synthetic oils 6.5e-4 to 8e-4"),
    ],
    limits: [RAYLEIGH], observed: [ALPHA, REYNOLDS], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    const OIL: [f64; 4] = [0.14, 1.5e-5, 820.0, 2100.0];

    fn casing() -> Params {
        Params {
            tip_diameter: Some(0.15),
            height: Some(0.30),
            oil_area: Some(0.35),
            rest_share: 0.3,
            full_speed: 10.0,
            expansion: 7.5e-4,
        }
    }

    fn link(speed: f64) -> f64 {
        let part = HeatLinkPart::default();
        let model = built(prepare, casing()).unwrap();
        model.conductance(&at(&part, speed, OIL)).unwrap()
    }

    /// 15 m/s tip speed gives Re = 3e5 over the height; 80 and 60 degC.
    #[test]
    fn splash_and_rest_by_hand() {
        let prandtl = 1.5e-5 * 820.0 * 2100.0 / 0.14;
        close(prandtl, 184.5);
        let splash = 0.664 * 3e5_f64.sqrt() * 184.5_f64.cbrt() * 0.14 / 0.30;
        let ra: f64 = 9.80665 * 7.5e-4 * 20.0 * 0.027 / (1.5e-5 * 0.14 / (820.0 * 2100.0));
        let falling = (1.0 + (0.492 / 184.5_f64).powf(9.0 / 16.0)).powf(8.0 / 27.0);
        let free = (0.825 + 0.387 * ra.powf(1.0 / 6.0) / falling).powi(2) * 0.14 / 0.30;
        close(link(0.0), 0.3 * 0.35 * free);
        close(link(200.0), 0.35 * (splash.powi(3) + free.powi(3)).cbrt());
    }

    #[test]
    fn the_wetted_area_grows_until_oil_is_everywhere() {
        let model = built(prepare, casing()).unwrap();
        close(model.wetted(0.0), 0.105);
        close(model.wetted(5.0), 0.2275);
        close(model.wetted(10.0), 0.35);
        close(model.wetted(40.0), 0.35);
        let found = [0.0, 0.1, 1.0, 10.0, 100.0, 1000.0].map(link);
        assert!(found.windows(2).all(|g| g[1] > g[0]), "{found:?}");
    }

    #[test]
    fn what_is_missing_is_named() {
        for (params, words) in [
            (
                Params {
                    tip_diameter: None,
                    ..casing()
                },
                "tip_diameter: 150 mm",
            ),
            (
                Params {
                    oil_area: None,
                    ..casing()
                },
                "oil_area: 3500 cm2",
            ),
        ] {
            let error = built(prepare, params).err().unwrap();
            assert!(error.contains(words), "{error}");
        }
    }
}
