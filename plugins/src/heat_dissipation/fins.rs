//! A finned part of the housing.
//!
//! Source: straight fins of constant thickness: eta_f = tanh(m L_c)/(m L_c), m = sqrt(2 alpha/(lambda t)), L_c = L + t/2; Q = alpha
//! (A_base + eta_f A_fins) (T_surface - T_ambient); any textbook on heat transfer. Shafts and feet can be modelled as fins, too.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, HousingPart,
};
use gearloss_framework::registry::{Build, Evidence, formula};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::textbook::length;
use super::{ZERO_CELSIUS, needed, part};
use crate::convection::{Shape, forced, free, mixed};

observed! { EFFICIENCY = ("eta_f", "-", "efficiency of the fins"); }

/// A finned part of the housing.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Area between the fins. [cm2]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e8))]
    pub base_area: f64,
    /// Total area of both sides of the fins. [cm2]
    #[schemars(range(min = 0.01, max = 1e8))]
    pub fin_area: f64,
    /// Length of the fins from the housing. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub fin_length: f64,
    /// Thickness of the fins. [mm]
    #[schemars(range(min = 0.1, max = 1e3))]
    pub fin_thickness: f64,
    /// Heat transfer coefficient; default: textbook convection over the height and length of the housing, without radiation.
    /// [W/(m2 K)]
    #[schemars(range(min = 0.1, max = 1e5))]
    pub alpha: Option<f64>,
}

struct Ready {
    params: Params,
    part: HousingPart,
    height: f64,
    length: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ready, Diagnostic> {
    let part = part(cx);
    let height = match params.alpha {
        Some(_) => 1.0,
        None => needed(part.height, "fins", "the height of the housing", "height: 200 mm", cx)?,
    };
    Ok(Ready {
        length: match params.alpha {
            Some(_) => 1.0,
            None => length(&part, "fins", cx)?,
        },
        params,
        part,
        height,
    })
}

/// Fin efficiency from heat transfer coefficient, conductivity, thickness and length.
fn efficiency(alpha: f64, lambda: f64, t: f64, l: f64) -> f64 {
    let ml = (2.0 * alpha / (lambda * t)).sqrt() * (l + 0.5 * t);
    if ml < 1e-6 { 1.0 } else { ml.tanh() / ml }
}

impl HeatDissipationModel for Ready {
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        let alpha = self.params.alpha.unwrap_or_else(|| {
            let (wall, ambient) = (at.surface_temperature + ZERO_CELSIUS, at.ambient + ZERO_CELSIUS);
            let (_, free) = free(Shape::Plate, self.height, wall, ambient);
            let forced = if self.part.air_speed > 0.0 {
                forced(self.part.air_speed, self.length, 0.5 * (wall + ambient))
            } else {
                0.0
            };
            mixed(forced, free)
        });
        at.show("alpha", "W/(m2 K)", alpha);
        at.show("L", "mm", self.params.fin_length.mm());
        let p = &self.params;
        let eta = efficiency(alpha, self.part.wall_conductivity, p.fin_thickness, p.fin_length);
        let eta = at.observe(&EFFICIENCY, eta);
        Ok(at.show("G", "W/K", alpha * (p.base_area + eta * p.fin_area)))
    }
}

register!(HeatDissipation, "fins", Params,
    source: "straight fins of constant thickness, textbooks",
    example: "{ type: fins, fin_area: 800 cm2, fin_length: 20 mm, fin_thickness: 3 mm, alpha: 20 W/(m2 K) }",
    evidence: [formula(Evidence::SeveralSources, "textbooks agree")],
    observed: [EFFICIENCY], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat_dissipation::cases::{assert_conductance, part};

    #[test]
    fn the_conductance_is_put_together_in_si() {
        let way = Ready {
            params: Params {
                base_area: 0.01,
                fin_area: 0.08,
                fin_length: 0.020,
                fin_thickness: 0.003,
                alpha: Some(20.0),
            },
            part: part(),
            height: 1.0,
            length: 1.0,
        };
        assert_conductance(&way, 1.77844);
    }

    #[test]
    fn e5_a_short_fin_is_nearly_perfect() {
        assert!((efficiency(20.0, 150.0, 0.003, 0.020) / 0.986525 - 1.0).abs() < 1e-6);
        assert!((efficiency(1e-12, 150.0, 0.003, 0.020) - 1.0).abs() < 1e-9);
    }
}
