//! Casing to ambient air: free and forced convection with radiation.
//!
//! Sources: free convection at a vertical plate or about a horizontal cylinder, Churchill and Chu 1975; forced convection along a
//! plate, Nu = 0.664 Re^0.5 Pr^(1/3), above Re = 5e5 (0.037 Re^0.8 - 871) Pr^(1/3); combined alpha^3 = alpha_n^3 + alpha_f^3;
//! radiation eps sigma (T_1^2 + T_2^2)(T_1 + T_2). Air at the mean temperature of both nodes; the law is symmetric in the nodes.
//!
//! In a vehicle the air speed is a share of the vehicle speed, 0.3 to 0.7 under the floor. A casing is not a flat plate and its
//! ribs are not modelled: a factor of two in either direction is common. The end faces of a cylinder are included in its `area`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{of_housing, part};
use crate::convection::{Shape, forced, free, mixed, radiation};
use crate::heat_dissipation::ZERO_CELSIUS;

limits! { RAYLEIGH = ("Ra", "Rayleigh number", "-", 0.0, 1e12, "Churchill and Chu 1975"); }
observed! {
    ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient with radiation");
    AIR = ("u", "m/s", "speed of the air along the casing");
}

/// Casing to ambient air: free and forced convection with radiation.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Shape for free convection.
    #[serde(default)]
    pub shape: Shape,
    /// Area that dissipates heat to the air; default: that of the housing. [cm2]
    #[schemars(range(min = 0.1, max = 1e8))]
    pub area: Option<f64>,
    /// Height of a plate; default: that of the housing. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub height: Option<f64>,
    /// Diameter of a cylinder. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub diameter: Option<f64>,
    /// Length along the air flow; default: that of the housing. [mm]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub length: Option<f64>,
    /// Emissivity: 0.9 painted, 0.1 to 0.3 bare aluminium; default: that of the housing. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: Option<f64>,
    /// Air speed with the vehicle at standstill; default: that of the housing, else still air. [m/s]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub air_speed: Option<f64>,
    /// Ratio of air speed along the casing to vehicle speed. [-]
    #[serde(default = "under_the_floor")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub vehicle_share: f64,
}

fn under_the_floor() -> f64 {
    0.5
}

struct Casing {
    shape: Shape,
    area: f64,
    /// Height or diameter. \[m\]
    size: f64,
    length: f64,
    emissivity: f64,
    air_speed: f64,
    vehicle_share: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Casing, Diagnostic> {
    let size = match (params.shape, params.height, params.diameter) {
        (Shape::Plate, height, None) => of_housing(height, |h| h.height, "its height", "height: 300 mm", cx)?,
        (Shape::Cylinder, None, Some(diameter)) => diameter,
        (Shape::Cylinder, None, None) => {
            return Err(cx
                .error("the link requires the diameter of the cylinder")
                .help("write `diameter: 250 mm` with your value, or `shape: plate`"));
        }
        (Shape::Plate, _, Some(_)) => {
            return Err(cx
                .error("a plate has no diameter")
                .help("write `shape: cylinder`, or omit `diameter`"));
        }
        (Shape::Cylinder, Some(_), _) => {
            return Err(cx
                .error("a horizontal cylinder has no `height`")
                .help("write `diameter` instead of `height`"));
        }
    };
    let air_speed = params
        .air_speed
        .or_else(|| part(cx).housing.map(|h| h.air_speed))
        .unwrap_or(0.0);
    // The length matters only with moving air.
    let length = if air_speed == 0.0 && params.vehicle_share == 0.0 {
        params.length.unwrap_or(size)
    } else {
        of_housing(
            params.length,
            |h| h.length,
            "the length along the flow of the air",
            "length: 400 mm",
            cx,
        )?
    };
    Ok(Casing {
        shape: params.shape,
        area: of_housing(params.area, |h| h.area, "its area", "area: 3500 cm2", cx)?,
        size,
        length,
        emissivity: of_housing(
            params.emissivity,
            |h| Some(h.emissivity),
            "its emissivity",
            "emissivity: 0.3",
            cx,
        )?,
        air_speed,
        vehicle_share: params.vehicle_share,
    })
}

impl HeatLinkModel for Casing {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let (one, two) = (at.temperature_1 + ZERO_CELSIUS, at.temperature_2 + ZERO_CELSIUS);
        let (ra, free) = free(self.shape, self.size, one, two);
        at.check(&RAYLEIGH, ra);
        at.show("alpha_n", "W/(m2 K)", free);
        let air = at.observe(&AIR, self.air_speed + self.vehicle_share * at.vehicle_speed);
        let forced = at.show("alpha_f", "W/(m2 K)", forced(air, self.length, 0.5 * (one + two)));
        let radiation = at.show("alpha_rad", "W/(m2 K)", radiation(self.emissivity, one, two));
        let alpha = at.observe(&ALPHA, mixed(forced, free) + radiation);
        Ok(at.show("alpha A", "W/K", alpha * self.area))
    }
}

register!(HeatLink, "casing_air", Params,
    source: "Churchill and Chu 1975; flat plate; Stefan-Boltzmann",
    example: "{ type: casing_air }",
    evidence: [
        formula(Evidence::SeveralSources, "textbooks agree; a casing is not a flat plate"),
        default_of("shape", Evidence::Assumed, "casing walls are mostly vertical"),
        default_of("vehicle_share", Evidence::Assumed, "middle of 0.3 to 0.7 under the floor of a car"),
    ],
    limits: [RAYLEIGH], observed: [ALPHA, AIR], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::built;
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn plate() -> Params {
        Params {
            shape: Shape::Plate,
            area: Some(0.35),
            height: Some(0.30),
            diameter: None,
            length: Some(0.40),
            emissivity: Some(0.3),
            air_speed: None,
            vehicle_share: 0.5,
        }
    }

    fn link(params: Params, [one, two]: [f64; 2], vehicle_speed: f64) -> f64 {
        let part = HeatLinkPart::default();
        let at = HeatLinkAt::usual(&part, Notes::MUTED).with(|to| {
            to.temperature_1 = one;
            to.temperature_2 = two;
            to.vehicle_speed = vehicle_speed;
        });
        built(prepare, params).unwrap().conductance(&at).unwrap()
    }

    #[test]
    fn u5e_radiation_alone_between_70_and_30_degc() {
        let black = |emissivity| {
            let params = Params {
                emissivity: Some(emissivity),
                ..plate()
            };
            link(params, [70.0, 30.0], 0.0)
        };
        close((black(0.3) - black(0.0)) / 0.35, 2.304973);
    }

    #[test]
    fn the_conductance_is_put_together_in_si() {
        let (wall, ambient) = (343.15, 303.15);
        let still = free(Shape::Plate, 0.30, wall, ambient).1;
        let blown = forced(15.0, 0.40, 323.15);
        let radiated = radiation(0.3, wall, ambient);
        close(
            link(plate(), [70.0, 30.0], 30.0),
            0.35 * (mixed(blown, still) + radiated),
        );
        close(link(plate(), [70.0, 30.0], 0.0), 0.35 * (still + radiated));
        let fan = Params {
            air_speed: Some(15.0),
            vehicle_share: 0.0,
            ..plate()
        };
        close(link(fan, [30.0, 70.0], 30.0), link(plate(), [70.0, 30.0], 30.0));
    }

    #[test]
    fn a_cylinder_counts_by_its_diameter() {
        let cylinder = Params {
            shape: Shape::Cylinder,
            height: None,
            diameter: Some(0.25),
            emissivity: Some(0.0),
            ..plate()
        };
        close(
            link(cylinder, [70.0, 30.0], 0.0),
            0.35 * free(Shape::Cylinder, 0.25, 343.15, 303.15).1,
        );
    }

    #[test]
    fn what_is_missing_or_belongs_to_another_shape_is_named() {
        for (params, words) in [
            (Params { area: None, ..plate() }, "area: 3500 cm2"),
            (
                Params {
                    height: None,
                    ..plate()
                },
                "height: 300 mm",
            ),
            (
                Params {
                    length: None,
                    ..plate()
                },
                "length: 400 mm",
            ),
            (
                Params {
                    emissivity: None,
                    ..plate()
                },
                "emissivity: 0.3",
            ),
            (
                Params {
                    diameter: Some(0.2),
                    ..plate()
                },
                "shape: cylinder",
            ),
            (
                Params {
                    shape: Shape::Cylinder,
                    ..plate()
                },
                "`diameter`",
            ),
            (
                Params {
                    shape: Shape::Cylinder,
                    height: None,
                    ..plate()
                },
                "diameter: 250 mm",
            ),
        ] {
            let error = built(prepare, params).err().unwrap();
            assert!(error.contains(words), "{error}");
        }
        // In still air the length does not matter.
        let still = Params {
            length: None,
            vehicle_share: 0.0,
            ..plate()
        };
        assert!(built(prepare, still).is_ok());
    }
}
