//! Centrifugal film cooling of wetted teeth: the heat removed in each revolution.
//!
//! Source: DeWinter and Blok, J. Eng. Ind. 96 (1974) 60-70, as used by Townsend and Akin, J. Mech. Des. 103 (1981) 219-226: a film
//! on a flank drains under omega^2 R until its thickness equals the thermal penetration depth, t* = sqrt(nu H/(chi omega^2 R));
//! until then it has absorbed q sqrt(k rho c t*) per kelvin, so alpha = sqrt(omega)/(2 pi) sqrt(k rho c) (nu H/(chi R))^(1/4) q,
//! over the flanks of all teeth. Oil properties are taken at the mean temperature of both nodes.
//!
//! Only for gears that are wetted by a jet or the sump in every revolution. Some authors write omega in front of the root: that
//! form has omega^2 in the bracket as well; a mixture of both does not have the dimension of a heat transfer coefficient.

use std::f64::consts::{PI, TAU};

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{of_gear, oil};
use crate::rotating::Fluid;

observed! { ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient on the wetted flanks"); }

/// Centrifugal film cooling of wetted teeth, from gear to oil.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Number of teeth; default: that of the gear. [-]
    #[schemars(range(min = 1.0, max = 2000.0))]
    pub teeth: Option<f64>,
    /// Tooth height; default: that of the gear. [mm]
    #[schemars(range(min = 0.05, max = 500.0))]
    pub tooth_height: Option<f64>,
    /// Pitch diameter; default: that of the gear. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub pitch_diameter: Option<f64>,
    /// Face width; default: that of the gear. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: Option<f64>,
    /// Number of wetted flanks per tooth. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 2))]
    pub flanks: u32,
    /// Normalised cooling q: heat absorbed by the film over sqrt(k rho c t*), per kelvin. [-]
    #[serde(default = "half_space")]
    #[schemars(range(min = 0.1, max = 3.0))]
    pub normalised_cooling: f64,
}

fn default_one() -> u32 {
    1
}

/// Half space that absorbs heat until t*.
fn half_space() -> f64 {
    2.0 / PI.sqrt()
}

struct FlingOff {
    tooth_height: f64,
    pitch_radius: f64,
    area: f64,
    normalised_cooling: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<FlingOff, Diagnostic> {
    let teeth = of_gear(
        params.teeth,
        |g| f64::from(g.teeth),
        "the number of teeth",
        "teeth: 31",
        cx,
    )?;
    let tooth_height = of_gear(
        params.tooth_height,
        |g| g.tooth_height,
        "the tooth height",
        "tooth_height: 4 mm",
        cx,
    )?;
    let pitch_diameter = of_gear(
        params.pitch_diameter,
        |g| g.pitch_diameter,
        "the pitch diameter",
        "pitch_diameter: 60 mm",
        cx,
    )?;
    let facewidth = of_gear(
        params.facewidth,
        |g| g.facewidth,
        "the face width",
        "facewidth: 30 mm",
        cx,
    )?;
    Ok(FlingOff {
        tooth_height,
        pitch_radius: 0.5 * pitch_diameter,
        area: teeth * facewidth * tooth_height * f64::from(params.flanks),
        normalised_cooling: params.normalised_cooling,
    })
}

/// Heat transfer coefficient from tooth height and radius (m), speed (rad/s) and normalised cooling. \[W/(m2 K)\]
fn coefficient(oil: &Fluid, height: f64, radius: f64, speed: f64, cooling: f64) -> f64 {
    let effusivity = (oil.conductivity * oil.density * oil.heat_capacity).sqrt();
    speed.sqrt() / TAU * effusivity * (oil.prandtl() * height / radius).sqrt().sqrt() * cooling
}

impl HeatLinkModel for FlingOff {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let alpha = coefficient(
            &oil(at),
            self.tooth_height,
            self.pitch_radius,
            at.speed,
            self.normalised_cooling,
        );
        Ok(at.show("alpha A", "W/K", at.observe(&ALPHA, alpha) * self.area))
    }
}

register!(HeatLink, "fling_off", Params,
    source: "DeWinter, Blok, J. Eng. Ind. 96 (1974) 60-70",
    example: "{ type: fling_off }",
    evidence: [
        formula(Evidence::Reconstructed, "structure from the article, scale derived"),
        default_of("flanks", Evidence::Assumed, "a jet or the sump wets one side"),
        default_of("normalised_cooling", Evidence::Derived, "half space until t*; tables of the literature have 0.6 to 1.2"),
    ],
    observed: [ALPHA], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    const OIL: [f64; 4] = [0.14, 1.5e-5, 820.0, 2100.0];

    fn teeth(flanks: u32) -> Params {
        Params {
            teeth: Some(31.0),
            tooth_height: Some(0.0038),
            pitch_diameter: Some(2.0 * 0.0298),
            facewidth: Some(0.030),
            flanks,
            normalised_cooling: half_space(),
        }
    }

    #[test]
    fn u4h_fling_off() {
        let part = HeatLinkPart::default();
        let here = at(&part, 209.4395, OIL);
        let alpha = coefficient(&oil(&here), 0.0038, 0.0298, 209.4395, half_space());
        close(alpha, 2810.451);
        let link = |flanks| built(prepare, teeth(flanks)).unwrap().conductance(&here).unwrap();
        close(link(1), alpha * 31.0 * 0.030 * 0.0038);
        close(link(2), 2.0 * link(1));
    }

    #[test]
    fn nothing_is_flung_off_at_rest_and_more_with_the_root_of_the_speed() {
        let part = HeatLinkPart::default();
        let model = built(prepare, teeth(1)).unwrap();
        let link = |speed| model.conductance(&at(&part, speed, OIL)).unwrap();
        assert!(link(0.0).abs() < f64::MIN_POSITIVE);
        close(link(400.0), 2.0 * link(100.0));
    }

    #[test]
    fn a_missing_figure_of_the_gear_is_named() {
        let params = Params {
            tooth_height: None,
            ..teeth(1)
        };
        let error = built(prepare, params).err().unwrap();
        assert!(
            error.contains("tooth height") && error.contains("tooth_height: 4 mm"),
            "{error}"
        );
    }
}
