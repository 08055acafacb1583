//! An oil cooler, described by its effectiveness.
//!
//! Source: effectiveness and number of transfer units, textbooks (Kays and London): C = rho c_p V', Q = eps C_min (T_oil -
//! T_cold,in), as for the heat exchangers of a thermal network.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, WarmSide,
};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::thermal::Arrangement;
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

observed! { EFFECTIVENESS = ("eps", "-", "effectiveness of the cooler"); }

/// An oil cooler, described by its effectiveness.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct OilCooler {
    /// Conductance between oil and coolant, UA. [W/K]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub ua: f64,
    /// Flow of the oil. [l/min]
    #[schemars(range(min = 0.001, max = 1e5))]
    pub oil_flow: f64,
    /// Flow of the coolant. [l/min]
    #[schemars(range(min = 0.001, max = 1e7))]
    pub coolant_flow: f64,
    /// Inlet temperature of the coolant. [degC]
    #[schemars(range(min = -60.0, max = 200.0))]
    pub coolant_temperature: f64,
    /// Density of the coolant. [kg/m3]
    #[serde(default = "glycol_density")]
    #[schemars(range(min = 0.5, max = 2000.0))]
    pub coolant_density: f64,
    /// Specific heat of the coolant. [J/(kg K)]
    #[serde(default = "glycol_heat")]
    #[schemars(range(min = 500.0, max = 5000.0))]
    pub coolant_heat_capacity: f64,
    /// Flow arrangement of oil and coolant.
    #[serde(default)]
    pub arrangement: Arrangement,
}

fn glycol_density() -> f64 {
    1040.0
}

fn glycol_heat() -> f64 {
    3600.0
}

impl HeatDissipationModel for OilCooler {
    fn warm_side(&self) -> WarmSide {
        WarmSide::Oil
    }
    fn sink(&self) -> Option<f64> {
        Some(self.coolant_temperature)
    }
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        let oil = at.show("C_oil", "W/K", at.rho * at.heat_capacity * self.oil_flow);
        let coolant = at.show(
            "C_coolant",
            "W/K",
            self.coolant_density * self.coolant_heat_capacity * self.coolant_flow,
        );
        let (least, greatest) = (oil.min(coolant), oil.max(coolant));
        let ntu = at.show("NTU", "-", self.ua / least);
        let eps = at.observe(&EFFECTIVENESS, self.arrangement.effectiveness(ntu, least / greatest));
        Ok(at.show("eps C_min", "W/K", eps * least))
    }
}

register!(HeatDissipation, "oil_cooler", OilCooler,
    source: "effectiveness and number of transfer units, textbooks",
    example: "{ type: oil_cooler, ua: 120 W/K, oil_flow: 8 l/min, coolant_flow: 10 l/min, coolant_temperature: 60 degC }",
    evidence: [
        formula(Evidence::SeveralSources, "textbooks agree"),
        default_of("coolant_density", Evidence::Assumed, "water with glycol"),
        default_of("coolant_heat_capacity", Evidence::Assumed, "water with glycol"),
    ],
    observed: [EFFECTIVENESS]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat_dissipation::cases::assert_conductance;

    #[test]
    fn the_conductance_is_put_together_in_si() {
        let way = OilCooler {
            ua: 120.0,
            oil_flow: 8e-3 / 60.0,
            coolant_flow: 10e-3 / 60.0,
            coolant_temperature: 60.0,
            coolant_density: 1040.0,
            coolant_heat_capacity: 3600.0,
            arrangement: Arrangement::Counterflow,
        };
        assert_conductance(&way, 88.0369);
    }
}
