//! Rim and faces of one immersed gear according to Seetharaman and Kahraman, without oil in the root spaces.
//!
//! Source: Seetharaman, Kahraman: Load-independent spin power losses of a spur gear pair, J. Tribol. 131 (2009), partly quoted from
//! memory: P_rim = 4 eta b r_o^2 w^2 phi; each face 0.41 rho nu^0.5 U^2.5 A/sqrt(r_o sin phi) to Re = 2 r_o sin phi U/nu = 1e5,
//! 0.025 rho nu^0.14 U^2.86 A/(r_o sin phi)^0.14 from 1e6, blended in lg Re between; phi = acos(1 - h/r_o), U = w r_o, A the
//! immersed area of a face. The laminar constant is that of a flat plate. The root filling and pocketing terms are missing, so the
//! model is incomplete; with the level at rest (quoted from memory), at high speed it overpredicts measurements by far, because oil
//! is thrown off. For research.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::CHURNING;
use super::rise::{Rise, SWELL, churning};
use crate::checks::SIX_DIGITS;
use crate::powers::power;

terms! {
    RIM = no_load("rim");
    FACES = no_load("faces");
}

coefficients! {
    /// Constants of both known terms.
    struct Constants {
        /// Factor of the rim.
        rim_factor = 4.0, in 2.0..=8.0;
        /// Factor of a face in laminar flow.
        laminar_factor = 0.41, in 0.205..=0.82;
        /// Exponent of viscosity over chord in laminar flow; the exponent of the speed is three minus this.
        laminar_exponent = 0.5, in 0.25..=0.75;
        /// Factor of a face in turbulent flow.
        turbulent_factor = 0.025, in 0.0125..=0.05;
        /// Exponent of viscosity over chord in turbulent flow; the exponent of the speed is three minus this.
        turbulent_exponent = 0.14, in 0.07..=0.28;
    }
}

churning! {
    /// Rim and faces of one immersed gear according to Seetharaman and Kahraman; incomplete.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Params {
        #[serde(default)]
        coefficients: Constants,
    }
}

struct SeetharamanKahraman {
    coefficients: Constants,
    rise: Rise,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<SeetharamanKahraman, Diagnostic> {
    Ok(SeetharamanKahraman {
        rise: params.rise(cx)?,
        coefficients: params.coefficients,
    })
}

/// Half of the immersed angle. \[rad\]
fn angle(depth: f64) -> f64 {
    (1.0 - depth.clamp(0.0, 2.0)).acos()
}

fn rim(c: &Constants, eta: f64, b: f64, r: f64, omega: f64, depth: f64) -> f64 {
    c.rim_factor * eta * b * r * r * omega * omega * angle(depth)
}

/// Power of one face, depth over tip radius at most one. \[W\]
fn face(c: &Constants, rho: f64, nu: f64, r: f64, omega: f64, depth: f64) -> f64 {
    let h = depth.min(1.0);
    let (chord, speed) = (r * angle(h).sin(), omega * r);
    if chord <= 0.0 || speed == 0.0 {
        return 0.0;
    }
    let half = std::f64::consts::FRAC_PI_2;
    // For a small segment both terms cancel to rounding.
    let area = r * r * (half - (1.0 - h).asin() - (1.0 - h) * (h * (2.0 - h)).sqrt()).max(0.0);
    let (m, n) = (c.laminar_exponent, c.turbulent_exponent);
    let laminar = c.laminar_factor * rho * power(nu, m) * speed.powf(3.0 - m) * area / power(chord, m);
    let turbulent = c.turbulent_factor * rho * nu.powf(n) * speed.powf(3.0 - n) * area / chord.powf(n);
    let t = ((2.0 * chord * speed / nu).log10() - 5.0).clamp(0.0, 1.0);
    laminar * (1.0 - t) + turbulent * t
}

impl GearDragModel for SeetharamanKahraman {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| Ok(self.alone(at)))
    }
}

impl SeetharamanKahraman {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Loss {
        let gear = &at.part.gear;
        let (r, omega) = (0.5 * gear.tip_diameter, at.speed.abs());
        let depth = at.show("h/r_o", "-", at.tip_dip / r);
        at.show("r_o", "mm", r.mm());
        Loss::POWERS
            .with(
                &RIM,
                at.show(
                    "P_rim",
                    "W",
                    rim(&self.coefficients, at.eta, gear.facewidth, r, omega, depth),
                ),
            )
            .with(
                &FACES,
                at.show(
                    "P_faces",
                    "W",
                    2.0 * face(&self.coefficients, at.rho, at.nu, r, omega, depth),
                ),
            )
    }
}

register!(GearDrag, "seetharaman_kahraman", Params,
    source: "Seetharaman, Kahraman, J. Tribol. 131 (2009)",
    example: "{ type: seetharaman_kahraman }",
    evidence: [
        formula(Evidence::Recalled, "two of four terms quoted from memory, not checked; the laminar constant is derived"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: "{ part: { gear: { z: 38, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 152 mm, \
                    working_diameter: 152 mm, tip_diameter: 160 mm, root_diameter: 142 mm, contact_height: 1 mm } }, \
                    at: { speed: 200 rad/s, tip_dip: 40 mm, eta: 20 mPa s } }",
            values: &[("rim", "0.428932 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 38, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 152 mm, \
                    working_diameter: 152 mm, tip_diameter: 160 mm, root_diameter: 142 mm, contact_height: 1 mm } }, \
                    at: { speed: 100 rad/s, tip_dip: 40 mm, nu: 23.5 mm2/s, rho: 850 kg/m3 } }",
            values: &[("faces", "9.13398 W")],
            source: "independent implementation of the formula: two faces of 4.56699 W",
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 48, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 192 mm, \
                    working_diameter: 192 mm, tip_diameter: 200 mm, root_diameter: 182 mm, contact_height: 1 mm } }, \
                    at: { speed: 800 rad/s, tip_dip: 50 mm, nu: 8 mm2/s, rho: 850 kg/m3 } }",
            values: &[("faces", "19710.78 W")],
            source: "independent implementation of the formula: two faces of 9855.39 W",
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL], terms: [RIM, FACES], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_rest_and_dry_there_is_no_loss() {
        assert_eq!(
            face(&Constants::PUBLISHED, 850.0, 8e-6, 0.1, 0.0, 0.5)
                + rim(&Constants::PUBLISHED, 20e-3, 0.02, 0.1, 100.0, 0.0),
            0.0
        );
    }
}
