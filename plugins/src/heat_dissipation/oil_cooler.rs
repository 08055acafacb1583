//! An oil cooler by its effectiveness.
//!
//! Source: effectiveness and number of transfer units, textbooks (Kays and London): C = rho c_p V', C_r = C_min/C_max, NTU = UA/C_min, Q = eps C_min (T_oil - T_cold,in);
//! counterflow eps = (1 - E)/(1 - C_r E), E = exp(-NTU (1 - C_r)), NTU/(1 + NTU) at C_r = 1; parallel (1 - exp(-NTU (1 + C_r)))/(1 + C_r); crossflow, both
//! unmixed, 1 - exp(NTU^0.22/C_r (exp(-C_r NTU^0.78) - 1)), 1 - exp(-NTU) at C_r = 0.

use gearloss_framework::loss::{Observed, Undefined};
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, WarmSide,
};
use gearloss_framework::register;
use gearloss_framework::registry::{Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const EFFECTIVENESS: Observed = Observed::new(0, "eps", "-", "Effectiveness of the cooler.");

/// How oil and coolant flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// Against each other.
    #[default]
    Counterflow,
    /// With each other.
    Parallel,
    /// Across each other, both unmixed.
    Crossflow,
}

/// An oil cooler by its effectiveness.
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
    /// Temperature at which the coolant comes in. [degC]
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
    /// How oil and coolant flow.
    #[serde(default)]
    pub arrangement: Arrangement,
}

fn glycol_density() -> f64 {
    1040.0
}

fn glycol_heat() -> f64 {
    3600.0
}

/// Effectiveness from transfer units and ratio of the capacities.
fn effectiveness(arrangement: Arrangement, ntu: f64, c_r: f64) -> f64 {
    match arrangement {
        Arrangement::Counterflow if (1.0 - c_r).abs() < 1e-9 => ntu / (1.0 + ntu),
        Arrangement::Counterflow => {
            let e = (-ntu * (1.0 - c_r)).exp();
            (1.0 - e) / (1.0 - c_r * e)
        }
        Arrangement::Parallel => (1.0 - (-ntu * (1.0 + c_r)).exp()) / (1.0 + c_r),
        Arrangement::Crossflow if c_r < 1e-9 => 1.0 - (-ntu).exp(),
        Arrangement::Crossflow => 1.0 - (ntu.powf(0.22) / c_r * ((-c_r * ntu.powf(0.78)).exp() - 1.0)).exp(),
    }
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
        let eps = at.observe(&EFFECTIVENESS, effectiveness(self.arrangement, ntu, least / greatest));
        Ok(at.show("eps C_min", "W/K", eps * least))
    }
}

register!(HeatDissipation, "oil_cooler", OilCooler,
    meaning: "An oil cooler by its effectiveness.",
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
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::heat_dissipation::HousingPart;

    use super::*;

    /// Oil of 80 degC, air of 20 degC, 830 kg/m3 and 2100 J/(kg K), by hand.
    #[test]
    fn the_conductance_is_put_together_in_si() {
        let part = HousingPart {
            wall_thickness: 0.008,
            wall_conductivity: 150.0,
            emissivity: 0.9,
            ..HousingPart::default()
        };
        let at = HeatDissipationAt {
            surface_temperature: 80.0,
            ..HeatDissipationAt::usual(&part, Notes::MUTED)
        };
        let way = OilCooler {
            ua: 120.0,
            oil_flow: 8e-3 / 60.0,
            coolant_flow: 10e-3 / 60.0,
            coolant_temperature: 60.0,
            coolant_density: 1040.0,
            coolant_heat_capacity: 3600.0,
            arrangement: Arrangement::Counterflow,
        };
        let conductance = way.conductance(&at).unwrap();
        assert!((conductance / 88.0369 - 1.0).abs() < 1e-5, "{conductance}");
    }

    #[test]
    fn e6_effectiveness_of_three_arrangements() {
        for (arrangement, printed) in [
            (Arrangement::Counterflow, 0.672700),
            (Arrangement::Parallel, 0.568301),
            (Arrangement::Crossflow, 0.640193),
        ] {
            assert!((effectiveness(arrangement, 1.5, 0.6) / printed - 1.0).abs() < 1e-5);
            // With a coolant that does not warm up, all are the same.
            assert!((effectiveness(arrangement, 1.5, 0.0) - (1.0 - (-1.5_f64).exp())).abs() < 1e-9);
        }
        assert!((effectiveness(Arrangement::Counterflow, 2.0, 1.0) - 2.0 / 3.0).abs() < 1e-9);
        assert!((effectiveness(Arrangement::Counterflow, 2.0, 1.0 - 1e-7) - 2.0 / 3.0).abs() < 1e-6);
    }
}
