//! Hertzian contact spots: constriction resistance on both sides.
//!
//! Sources: stationary spot between two half spaces, R = 1/(4 k1 a) + 1/(4 k2 a), for an ellipse with K(e)/(2 pi a) instead of 1/(4
//! a), Carslaw and Jaeger, Conduction of heat in solids; K(e)/(2 pi a) equals 1/(4 M(a, b)), with Gauss's arithmetic-geometric mean
//! of both semi-axes as the equivalent radius. Moving spot, as between a rolling element and its raceway: the law of fast bands of
//! Blok 1937 and Jaeger 1942 on the area pi a b with the mean chord in the direction of motion, R = 4/3/(pi a b) sqrt(pi/2 a_r/(pi
//! k rho c U)) for each body. In each body the smaller of both resistances applies: a spot is nearly stationary below a Peclet
//! number of 0.1 and fast above 5; between these limits the true value is below both.
//! between them the truth lies below both.
//!
//! Spots in parallel: of the Z elements of a bearing about Z/3 carry a radial load, all carry an axial load. Both contacts of an
//! element are in series, so they are two links, or one link with half the `count`.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::STEEL;

observed! { PECLET = ("Pe", "-", "peclet number of the spot in the first body"); }

/// Hertzian contact spots, stationary or moving, such as between rolling elements and raceways.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Semi-axis of the spot in the direction of motion; for a circle its radius. [mm]
    #[schemars(range(min = 1e-4, max = 100.0))]
    pub along: f64,
    /// Semi-axis perpendicular to the motion; default: the spot is a circle. [mm]
    #[schemars(range(min = 1e-4, max = 100.0))]
    pub across: Option<f64>,
    /// Radius that gives the spot velocity from the shaft speed; default: the spot is stationary. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub radius: Option<f64>,
    /// Number of such spots in parallel. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub count: f64,
    /// Thermal conductivities of both bodies. [W/(m K)]
    #[serde(default = "conductivities")]
    #[schemars(inner(range(min = 0.01, max = 1000.0)))]
    pub conductivities: [f64; 2],
    /// Densities of both bodies. [kg/m3]
    #[serde(default = "densities")]
    #[schemars(inner(range(min = 500.0, max = 20000.0)))]
    pub densities: [f64; 2],
    /// Specific heats of both bodies. [J/(kg K)]
    #[serde(default = "heat_capacities")]
    #[schemars(inner(range(min = 100.0, max = 3000.0)))]
    pub heat_capacities: [f64; 2],
}

fn default_one() -> f64 {
    1.0
}
fn conductivities() -> [f64; 2] {
    [STEEL; 2]
}
fn densities() -> [f64; 2] {
    [7800.0; 2]
}
fn heat_capacities() -> [f64; 2] {
    [470.0; 2]
}

struct Spots {
    radius: f64,
    count: f64,
    /// Stationary resistance of each body. \[K/W\]
    resting: [f64; 2],
    /// Resistance of each body at 1 m/s. \[K/W\]
    moving: [f64; 2],
    /// Peclet number in the first body at 1 m/s.
    peclet: f64,
}

/// Arithmetic-geometric mean of two positive numbers. Each iteration doubles the number of correct digits.
fn gauss_mean(mut a: f64, mut b: f64) -> f64 {
    // Seven iterations are exact to the last digit for axis ratios up to a million.
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

#[allow(clippy::unnecessary_wraps)] // The registry asks for a result.
fn prepare(params: Params, _: &mut Build<'_>) -> Result<Spots, Diagnostic> {
    let (along, across) = (params.along, params.across.unwrap_or(params.along));
    let resting = params.conductivities.map(|k| 0.25 / (k * gauss_mean(along, across)));
    let moving = [0, 1].map(|i| {
        let effusivity = params.conductivities[i] * params.densities[i] * params.heat_capacities[i];
        4.0 / 3.0 / (PI * along * across) * (0.5 * along / effusivity).sqrt()
    });
    Ok(Spots {
        radius: params.radius.unwrap_or(0.0),
        count: params.count,
        resting,
        moving,
        peclet: 0.5 * along * params.densities[0] * params.heat_capacities[0] / params.conductivities[0],
    })
}

impl HeatLinkModel for Spots {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let speed = at.show("U", "m/s", at.speed * self.radius);
        at.observe(&PECLET, self.peclet * speed);
        let body = |i: usize| {
            if speed > 0.0 {
                self.resting[i].min(self.moving[i] / speed.sqrt())
            } else {
                self.resting[i]
            }
        };
        let resistance = at.show("R", "K/W", body(0) + body(1));
        Ok(at.show("G", "W/K", self.count / resistance))
    }
}

register!(HeatLink, "hertz_spot", Params,
    source: "Carslaw, Jaeger, Conduction of heat in solids; Blok 1937; Jaeger 1942",
    example: "{ type: hertz_spot, along: 0.2 mm, across: 1.5 mm, radius: 32 mm, count: 3 }",
    evidence: [
        formula(Evidence::Derived, "stationary spot from several sources, moving ellipse derived from the band"),
        default_of("count", Evidence::User, "one spot"),
        default_of("conductivities", Evidence::SeveralSources, "hardened steel; silicon nitride about 25"),
        default_of("densities", Evidence::SeveralSources, "steel"),
        default_of("heat_capacities", Evidence::SeveralSources, "steel"),
    ],
    observed: [PECLET], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::mechanism::heat_link::HeatLinkPart;

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    const OIL: [f64; 4] = [0.14, 1.5e-5, 820.0, 2100.0];

    fn spots(along: f64, across: Option<f64>) -> Params {
        Params {
            along,
            across,
            radius: Some(0.030),
            count: 1.0,
            conductivities: conductivities(),
            densities: densities(),
            heat_capacities: heat_capacities(),
        }
    }

    fn at_speed(params: Params, speed: f64) -> f64 {
        let part = HeatLinkPart::default();
        let model = built(prepare, params).unwrap();
        model.conductance(&at(&part, speed, OIL)).unwrap()
    }

    #[test]
    fn u5d_pair_of_steel_spots() {
        close(1.0 / at_speed(spots(1e-4, None), 0.0), 108.6957);
    }

    /// K(e) at e^2 = 1/2 is 1.854074677, Legendre's tables.
    #[test]
    fn an_ellipse_counts_with_the_mean_of_gauss() {
        let b = 0.5_f64.sqrt();
        close(PI / 2.0 / gauss_mean(1.0, b), 1.854_074_677);
        let resistance = 2.0 * 1.854_074_677 / (2.0 * PI * 1e-4 * STEEL);
        close(1.0 / at_speed(spots(1e-4, Some(1e-4 * b)), 0.0), resistance);
        // At standstill the axes can be swapped.
        close(
            at_speed(spots(2e-4, Some(1e-3)), 0.0),
            at_speed(spots(1e-3, Some(2e-4)), 0.0),
        );
    }

    #[test]
    fn a_fast_spot_conducts_as_the_band_of_its_mean_chord() {
        // 10 m/s: Pe = 160 in a spot of 0.4 mm.
        let (a, b, speed) = (0.4e-3, 2e-3, 10.0 / 0.030);
        let chord = PI / 2.0 * a;
        let flux = 1.0 / (PI * a * b);
        // Mean rise over the band: two thirds of 2 q''/k sqrt(chi x/(pi U)) at its end.
        let chi = STEEL / (7800.0 * 470.0);
        let rise = 2.0 / 3.0 * 2.0 * flux / STEEL * (chi * chord / (PI * 10.0)).sqrt();
        close(1.0 / at_speed(spots(a, Some(b)), speed), 2.0 * rise);
    }

    #[test]
    fn motion_never_insulates_and_spots_add_up() {
        let speeds = [0.0, 1e-3, 0.1, 1.0, 10.0, 100.0, 1000.0];
        let found = speeds.map(|w| at_speed(spots(2e-4, Some(1e-3)), w));
        assert!(found.windows(2).all(|g| g[1] >= g[0]), "{found:?}");
        let five = Params {
            count: 5.0,
            ..spots(2e-4, Some(1e-3))
        };
        close(at_speed(five, 100.0), 5.0 * found[5]);
    }
}
