//! Effectiveness of a heat exchanger.
//!
//! Source: effectiveness and number of transfer units (Kays and London, Compact Heat Exchangers; Incropera and DeWitt):
//! NTU = UA/C_min, C_r = C_min/C_max; counterflow eps = (1 - E)/(1 - C_r E) with E = exp(-NTU (1 - C_r)), NTU/(1 + NTU) at
//! C_r = 1; parallel (1 - exp(-NTU (1 + C_r)))/(1 + C_r); crossflow, both unmixed,
//! 1 - exp(NTU^0.22/C_r (exp(-C_r NTU^0.78) - 1)), 1 - exp(-NTU) at C_r = 0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Flow arrangement of a heat exchanger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// Counterflow.
    #[default]
    Counterflow,
    /// Parallel flow.
    Parallel,
    /// Crossflow, both unmixed.
    Crossflow,
}

impl Arrangement {
    /// Effectiveness from transfer units and the ratio of the smaller capacity flow to the larger.
    pub fn effectiveness(self, ntu: f64, c_r: f64) -> f64 {
        match self {
            Self::Counterflow if (1.0 - c_r).abs() < 1e-9 => ntu / (1.0 + ntu),
            Self::Counterflow => {
                let e = (-ntu * (1.0 - c_r)).exp();
                (1.0 - e) / (1.0 - c_r * e)
            }
            Self::Parallel => (1.0 - (-ntu * (1.0 + c_r)).exp()) / (1.0 + c_r),
            Self::Crossflow if c_r < 1e-9 => 1.0 - (-ntu).exp(),
            Self::Crossflow => 1.0 - (ntu.powf(0.22) / c_r * ((-c_r * ntu.powf(0.78)).exp() - 1.0)).exp(),
        }
    }

    /// Heat flow over the difference of both inlet temperatures, from conductance and both capacity flows (W/K); zero if a fluid is
    /// stationary. \[W/K\]
    pub fn transfer(self, ua: f64, flows: [f64; 2]) -> f64 {
        let (least, greatest) = (flows[0].min(flows[1]), flows[0].max(flows[1]));
        if least <= 0.0 {
            return 0.0;
        }
        self.effectiveness(ua / least, least / greatest) * least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn e6_effectiveness_of_three_arrangements() {
        for (arrangement, printed) in [
            (Arrangement::Counterflow, 0.672700),
            (Arrangement::Parallel, 0.568301),
            (Arrangement::Crossflow, 0.640193),
        ] {
            assert!((arrangement.effectiveness(1.5, 0.6) / printed - 1.0).abs() < 1e-5);
            // With a coolant of constant temperature, all arrangements are equal.
            assert!((arrangement.effectiveness(1.5, 0.0) - (1.0 - (-1.5_f64).exp())).abs() < 1e-9);
        }
        let counter = Arrangement::Counterflow;
        assert!((counter.effectiveness(2.0, 1.0) - 2.0 / 3.0).abs() < 1e-9);
        assert!((counter.effectiveness(2.0, 1.0 - 1e-7) - 2.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn u6a_u6b_u6c_oil_cooled_by_glycol() {
        let counter = Arrangement::Counterflow;
        // Mass flows of oil and coolant, kg/s; heat, W.
        for (oil, coolant, effectiveness, heat) in [
            (0.10, 0.15, 0.7432523, 5462.904),
            (0.10, 0.0561, 0.6418084, 4536.687),
            (0.02, 0.20, 0.9996320, 1469.459),
        ] {
            let flows = [oil * 2100.0, coolant * 3600.0];
            let transfer = counter.transfer(350.0, flows);
            let least = flows[0].min(flows[1]);
            assert!(
                (transfer / least / effectiveness - 1.0_f64).abs() < 1e-6,
                "{}",
                transfer / least
            );
            assert!((transfer * 35.0 / heat - 1.0).abs() < 1e-6);
        }
        let [oil, coolant] = [0.10 * 2100.0, 0.15 * 3600.0];
        let heat = counter.transfer(350.0, [oil, coolant]) * 35.0;
        assert!((80.0 - heat / oil - 53.98617).abs() < 1e-5 && (45.0 + heat / coolant - 55.11649).abs() < 1e-5);
        assert_eq!(counter.transfer(350.0, [oil, 0.0]), 0.0);
    }
}
