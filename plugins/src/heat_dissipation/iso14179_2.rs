//! Heat dissipation of the housing according to ISO/TR 14179-2 (Funck).
//!
//! Source: ISO/TR 14179-2:2001, according to Funck 1985, partly quoted from memory: Q = k A_ca (T_oil - T_ambient), 1/k = A_ca/(alpha_oil A_oil) + s/lambda +
//! 1/alpha_ca, alpha_ca = alpha_con + alpha_rad; alpha_rad = 0.23e-6 eps ((T_wall + T_amb)/2)^3; free: alpha_con = 18 h^-0.1 ((T_wall -
//! T_amb)/T_amb)^0.3; forced: alpha_con = 0.0086 Re'^0.64/l_x, Re' = sqrt(Re^2 + Gr/2.5); T in K, lengths in m. T_wall follows from
//! T_wall = T_amb + k (T_oil - T_amb)/alpha_ca, here in three iterations from the oil temperature.
//!
//! Its free convection is about twice the textbook value, because the air in a workshop moves.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, HousingPart, WarmSide,
};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{coefficients, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{ZERO_CELSIUS, needed, part};
use crate::air::Air;

observed! {
    WALL = ("T_wall", "degC", "temperature of the wall");
    ALPHA = ("alpha_ca", "W/(m2 K)", "heat transfer coefficient to the air with radiation");
}
const GRAVITY: f64 = 9.80665;

coefficients! {
    /// Constants of the convection of ISO/TR 14179-2.
    struct Constants {
        /// Factor of free convection.
        free_factor = 18.0, in 9.0..=36.0;
        /// Exponent of the height in m in free convection.
        height_exponent = -0.1, in -0.2..=-0.05;
        /// Exponent of the temperature difference over the ambient temperature in free convection.
        difference_exponent = 0.3, in 0.15..=0.6;
        /// Factor of forced convection.
        forced_factor = 0.0086, in 0.0043..=0.0172;
        /// Exponent of the Reynolds number in forced convection.
        forced_exponent = 0.64, in 0.32..=0.9;
        /// Divisor of the Grashof number, which is added to the squared Reynolds number.
        buoyancy_divisor = 2.5, in 1.25..=5.0;
    }
}

/// Heat dissipation of the housing with free or forced convection, radiation, wall and oil inside.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Heat transfer coefficient from splashing oil to the wall. [W/(m2 K)]
    #[serde(default = "splash")]
    #[schemars(range(min = 1.0, max = 1e5))]
    pub alpha_oil: f64,
    /// Factor on convection to the air. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.01, max = 100.0))]
    pub factor: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn splash() -> f64 {
    200.0
}

fn default_one() -> f64 {
    1.0
}

struct Ready {
    params: Params,
    part: HousingPart,
    area: f64,
    oil_area: f64,
    /// Height for free convection, length along the flow for forced convection.
    size: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ready, Diagnostic> {
    let part = part(cx);
    let model = "iso14179_2";
    let area = needed(part.area, model, "the area of the housing", "area: 500 cm2", cx)?;
    let size = if part.air_speed > 0.0 {
        needed(
            part.length,
            model,
            "the length along the flow of the air",
            "length: 200 mm",
            cx,
        )?
    } else {
        needed(part.height, model, "the height of the housing", "height: 200 mm", cx)?
    };
    Ok(Ready {
        area,
        oil_area: part.oil_area.unwrap_or(area),
        size,
        params,
        part,
    })
}

/// Free convection; height in m, temperatures in K. \[W/(m2 K)\]
fn free(c: &Constants, height: f64, wall: f64, ambient: f64) -> f64 {
    c.free_factor * height.powf(c.height_exponent) * ((wall - ambient).abs() / ambient).powf(c.difference_exponent)
}

/// Forced convection; speed in m/s, length in m, viscosity of the air in m2/s, temperatures in K. \[W/(m2 K)\]
fn forced(c: &Constants, v: f64, length: f64, nu: f64, wall: f64, ambient: f64) -> f64 {
    let re = v * length / nu;
    let gr = GRAVITY * length.powi(3) * (wall - ambient).abs() / (ambient * nu * nu);
    c.forced_factor * (re * re + gr / c.buoyancy_divisor).sqrt().powf(c.forced_exponent) / length
}

/// Radiation; temperatures in K. \[W/(m2 K)\]
fn radiation(emissivity: f64, wall: f64, ambient: f64) -> f64 {
    0.23e-6 * emissivity * (0.5 * (wall + ambient)).powi(3)
}

/// k over the outside area; alpha of oil and air, areas, wall thickness over conductivity. \[W/(m2 K)\]
fn overall(alpha_oil: f64, alpha_ca: f64, area: f64, oil_area: f64, wall: f64) -> f64 {
    1.0 / (area / (alpha_oil * oil_area) + wall + 1.0 / alpha_ca)
}

impl HeatDissipationModel for Ready {
    fn warm_side(&self) -> WarmSide {
        WarmSide::Oil
    }
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        let ambient = at.ambient + ZERO_CELSIUS;
        let oil = at.oil_temperature + ZERO_CELSIUS;
        let wall_resistance = self.part.wall_thickness / self.part.wall_conductivity;
        let (mut wall, mut k, mut alpha) = (oil, 0.0, 0.0);
        for _ in 0..3 {
            let convection = if self.part.air_speed > 0.0 {
                let air = Air::at_temperature(0.5 * (wall + ambient));
                forced(
                    &self.params.coefficients,
                    self.part.air_speed,
                    self.size,
                    air.nu,
                    wall,
                    ambient,
                )
            } else {
                free(&self.params.coefficients, self.size, wall, ambient)
            };
            alpha = self.params.factor * convection + radiation(self.part.emissivity, wall, ambient);
            if alpha <= 0.0 {
                // Equal temperatures, still air and no radiation: no heat flows.
                return Ok(0.0);
            }
            k = overall(self.params.alpha_oil, alpha, self.area, self.oil_area, wall_resistance);
            wall = ambient + k * (oil - ambient) / alpha;
        }
        at.observe(&WALL, wall - ZERO_CELSIUS);
        at.observe(&ALPHA, alpha);
        at.show("k", "W/(m2 K)", k);
        Ok(at.show("k A_ca", "W/K", k * self.area))
    }
}

register!(HeatDissipation, "iso14179_2", Params,
    source: "ISO/TR 14179-2:2001, according to Funck",
    example: "{ type: iso14179_2 }",
    evidence: [
        formula(Evidence::Recalled, "free and forced convection quoted from memory, not checked; radiation derived"),
        default_of("alpha_oil", Evidence::Recalled, "dip lubrication, about 200"),
    ],
    observed: [WALL, ALPHA], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat_dissipation::cases::{assert_conductance, part};

    #[test]
    fn the_conductance_is_put_together_in_si() {
        let way = Ready {
            params: Params {
                coefficients: Constants::PUBLISHED,
                alpha_oil: 200.0,
                factor: 1.0,
            },
            part: part(),
            area: 0.40,
            oil_area: 0.35,
            size: 0.3,
        };
        assert_conductance(&way, 6.85657);
    }

    #[test]
    fn e3_wall_at_80_degc_in_air_of_20_degc() {
        let (wall, ambient) = (353.15, 293.15);
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        close(free(&Constants::PUBLISHED, 0.3, wall, ambient), 12.6148);
        close(forced(&Constants::PUBLISHED, 3.0, 0.3, 1.8e-5, wall, ambient), 29.4029);
        close(radiation(0.9, wall, ambient), 6.98526);
        let alpha = free(&Constants::PUBLISHED, 0.3, wall, ambient) + radiation(0.9, wall, ambient);
        close(alpha, 19.6000);
        close(overall(200.0, alpha, 0.40, 0.35, 0.008 / 150.0), 17.6094);
    }
}
