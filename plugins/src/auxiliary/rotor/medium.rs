//! Air with some oil in it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::air::Air;

/// Viscosity of a mixture of air and oil. No measurement decides: in the gap of a motor, 1 % of oil multiplies the loss by 4 to 9.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MixtureViscosity {
    /// Weighted by volume; between the other rules.
    #[default]
    Volume,
    /// Air with droplets that do not deform, according to Einstein: mu_air (1 + 2.5 a). The lowest; for little oil.
    Droplets,
    /// Fluidities weighted by mass, according to McAdams. The highest.
    Mass,
}

/// Density and dynamic viscosity of what surrounds a rotor. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Medium {
    /// Density. \[kg/m3\]
    pub rho: f64,
    /// Dynamic viscosity. \[Pa s\]
    pub mu: f64,
}

impl Medium {
    /// Air at a temperature (degC) with a volume fraction of oil.
    pub fn new(temperature: f64, oil: Self, fraction: f64, rule: MixtureViscosity) -> Self {
        if fraction >= 1.0 {
            return oil;
        }
        let air = Air::at_temperature(temperature + 273.15);
        let rho = fraction * oil.rho + (1.0 - fraction) * air.rho;
        let mu = match rule {
            MixtureViscosity::Volume => fraction * oil.mu + (1.0 - fraction) * air.mu,
            MixtureViscosity::Droplets => air.mu * (1.0 + 2.5 * fraction),
            MixtureViscosity::Mass => {
                let of_air = (1.0 - fraction) * air.rho / rho;
                1.0 / (of_air / air.mu + (1.0 - of_air) / oil.mu)
            }
        };
        Self { rho, mu }
    }
}
