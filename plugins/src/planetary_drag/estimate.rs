//! A first estimate of the drag of carrier and planets, from gear churning and disc friction.
//!
//! Source: none. Published laws for planetary sets (Kettler; Höhn) were not available. The planets are treated as gears that rotate
//! at their speed in the housing frame, with the mean immersion depth over the orbit at rest, as churning laws take it; the drag of
//! their orbital motion is neglected. The carrier is treated as discs in oil with the disc friction of Diab et al. 2004 (J. Mech.
//! Des. 126, 903-908), P = 1/2 C_f rho w^3 R^5 for both faces, times the oil-covered share of the faces. Expect a factor of three
//! in either direction.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::immersion::{dip, orbiting_dip};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt};
use gearloss_framework::mechanism::planetary_drag::{PlanetaryDrag, PlanetaryDragAt, PlanetaryDragModel};
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::gear_drag::diab::{Constants, faces};
use crate::gear_drag::wetted::Wetted;

terms! {
    PLANETS = no_load("planets");
    CARRIER = no_load("carrier");
}
observed! {
    SHARE = ("A_wet/A", "-", "oil-covered share of the carrier faces");
    REYNOLDS = ("Re", "-", "Reynolds number of the carrier in oil");
}

/// A first estimate of carrier and planets in oil; expect a factor of three in either direction.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Churning law of the planets, which must be a law for a single gear; `none` if `gear_drag` covers them.
    pub planet: ModelRef<GearDrag>,
    /// Outer diameter of the carrier discs; default: that of the circle around the planets. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub diameter: Option<f64>,
    /// Number of discs. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 10))]
    pub discs: u32,
    #[serde(default)]
    coefficients: Constants,
}

fn two() -> u32 {
    2
}

struct Estimate {
    /// One for each gear on the planet body.
    planets: Vec<Slot<GearDrag>>,
    radius: f64,
    discs: f64,
    coefficients: Constants,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Estimate, Diagnostic> {
    let part = cx.own_part::<PlanetaryDrag>()?.clone();
    if !part.has_level {
        return Err(cx
            .error("estimate requires the oil level")
            .help("state `housing.oil.level` and `housing.oil.measured_from`"));
    }
    let name = params.planet.value["type"].as_str().unwrap_or("none").to_owned();
    if part.bodies > 1 && name != "none" {
        return Err(cx
            .error("estimate supports one planet body only")
            .help("write `planet: none` and give the planet gears their own churning model"));
    }
    if cx.is_pair(&name) {
        return Err(cx
            .error(format!("`{name}` is a law for meshes, not for a single gear"))
            .help("choose a law for a single gear, such as `changenet_2011`"));
    }
    let reach = part.planets.iter().map(|p| p.gear.tip_diameter).fold(0.0, f64::max);
    let mut planets = Vec::new();
    for planet in part.planets {
        planets.push(cx.slot_of("planet", &std::sync::Arc::new(planet), &params.planet)?);
    }
    Ok(Estimate {
        planets,
        radius: params.diameter.map_or(part.orbit + 0.5 * reach, |d| 0.5 * d),
        discs: f64::from(params.discs),
        coefficients: params.coefficients,
    })
}

impl PlanetaryDragModel for Estimate {
    fn covers(&self) -> Covers {
        Covers {
            churning: self.planets.iter().any(|slot| !slot.off),
            squeezing: false,
            windage: false,
        }
    }

    fn loss(&self, at: &PlanetaryDragAt<'_>) -> Result<Loss, Undefined> {
        if at.at_rest()? {
            return Ok(Loss::POWERS);
        }
        let mut planets = 0.0;
        for (slot, planet) in self.planets.iter().zip(&at.part.planets) {
            let depth = |diameter: f64| orbiting_dip(at.level, 0.5 * diameter, at.part.orbit);
            let loss = slot.loss(&GearDragAt::usual(planet, at.notes.nested(slot.notes)).with(|to| {
                to.speed = at.planet_speed;
                to.speed_2 = at.planet_speed;
                to.tip_dip = depth(planet.gear.tip_diameter);
                to.dip = depth(planet.gear.reference_diameter);
                to.tip_dip_2 = 0.0;
                to.dip_2 = 0.0;
                to.towards_mesh = 0.0;
                to.towards_mesh_2 = 0.0;
                to.temperature = at.temperature;
                to.nu = at.nu;
                to.eta = at.eta;
                to.rho = at.rho;
            }))?;
            planets += f64::from(at.part.count) * loss.total_watts(at.planet_speed);
        }
        at.show("P_planets", "W", planets);
        let r = self.radius;
        at.show("R", "mm", r.mm());
        let omega = at.carrier_speed.abs();
        let wetted = Wetted::new(r, dip(at.level, r), 0.0, 1.0, 0.0, 0.0, 0.0);
        let share = at.observe(&SHARE, wetted.side / (2.0 * std::f64::consts::PI * r * r));
        let carrier = if omega > 0.0 && share > 0.0 {
            let re = at.observe(&REYNOLDS, omega * r * r / at.nu);
            let c_f = at.show("C_f", "-", faces(&self.coefficients, re));
            0.5 * c_f * at.rho * omega.powi(3) * r.powi(5) * share * self.discs
        } else {
            0.0
        };
        at.show("P_carrier", "W", carrier);
        Ok(Loss::POWERS.with(&PLANETS, planets).with(&CARRIER, carrier))
    }
}

register!(PlanetaryDrag, "estimate", Params,
    source: "composed of laws for single gears and discs",
    example: "{ type: estimate, planet: { type: changenet_2011 } }",
    evidence: [
        formula(Evidence::Assumed, "no law for planetary sets is published in full; uncalibrated"),
        default_of("diameter", Evidence::Assumed, "the discs cover the planets"),
        default_of("discs", Evidence::Assumed, "one disc on each side of the planets"),
    ],
    terms: [PLANETS, CARRIER], observed: [SHARE, REYNOLDS], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_carrier_in_oil_loses_half_of_what_a_drowned_one_does() {
        let share = |level: f64| {
            let wetted = Wetted::new(0.04, dip(level, 0.04), 0.0, 1.0, 0.0, 0.0, 0.0);
            wetted.side / (2.0 * std::f64::consts::PI * 0.04 * 0.04)
        };
        for (level, expected) in [(-0.05, 0.0), (0.0, 0.5), (0.05, 1.0)] {
            assert!((share(level) - expected).abs() < 1e-12);
        }
    }
}
