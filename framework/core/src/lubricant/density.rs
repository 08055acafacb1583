//! Density over temperature.

/// Decrease of density with temperature, for d = t - 15 degC.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Density {
    /// rho15 (1 - a d), a in 1/K.
    Linear {
        /// Density at 15 degC. \[kg/m3\]
        rho15: f64,
        /// Thermal expansion. \[1/K\]
        expansion: f64,
    },
    /// rho15 exp(-a d (1 + 0.8 a d)), a = 0.6278/rho15: the lubricant tables of the API.
    Api {
        /// Density at 15 degC. \[kg/m3\]
        rho15: f64,
    },
}

/// Coefficient of the API's lubricant tables. \[kg/(m3 K)\]
const API: f64 = 0.6278;
/// Coefficient of the short form of DIN 51757. \[kg/(m3 K)\]
const DIN_51757: f64 = 0.7;
/// Temperature of the standard density. \[degC\]
const STANDARD: f64 = 15.0;

fn api_factor(rho15: f64, warmer: f64) -> f64 {
    let ad = API / rho15 * warmer;
    (-ad * (1.0 + 0.8 * ad)).exp()
}

impl Density {
    /// The linear law from the density at a temperature in degC; the expansion is relative to that temperature.
    pub fn linear(value: f64, at: f64, expansion: f64) -> Self {
        let rho15 = value * (1.0 - expansion * (STANDARD - at));
        Self::Linear {
            rho15,
            expansion: expansion * value / rho15,
        }
    }

    /// The short form of DIN 51757: 0.7 kg/m3 less per degree.
    pub(crate) fn din_51757(value: f64, at: f64) -> Self {
        Self::linear(value, at, DIN_51757 / value)
    }

    /// The API's correction. Its factor depends weakly on rho15, so the iteration contracts by about a d per step.
    pub fn api(value: f64, at: f64) -> Self {
        let rho15 = (0..60).fold(value, |rho15, _| value / api_factor(rho15, at - STANDARD));
        Self::Api { rho15 }
    }

    /// Density at 15 degC. \[kg/m3\]
    pub(crate) fn rho15(&self) -> f64 {
        match self {
            Self::Linear { rho15, .. } | Self::Api { rho15 } => *rho15,
        }
    }

    /// Density at a temperature in degC. \[kg/m3\]
    pub(crate) fn rho_at(&self, temperature: f64) -> f64 {
        let warmer = temperature - STANDARD;
        match self {
            Self::Linear { rho15, expansion } => rho15 * (1.0 - expansion * warmer),
            Self::Api { rho15 } => rho15 * api_factor(*rho15, warmer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-6, "{value} against {expected}");
    }

    #[test]
    fn d3_density_of_845_at_80_degc() {
        close(Density::linear(845.0, 15.0, 7e-4).rho_at(80.0), 806.553);
        close(Density::api(845.0, 15.0).rho_at(80.0), 803.662);
        close(Density::din_51757(845.0, 15.0).rho_at(80.0), 845.0 - 0.7 * 65.0);
    }

    #[test]
    fn a_density_given_elsewhere_is_met_there() {
        for law in [
            Density::linear(803.0, 80.0, 7e-4),
            Density::din_51757(803.0, 80.0),
            Density::api(803.0, 80.0),
        ] {
            close(law.rho_at(80.0), 803.0);
            close(law.rho_at(15.0), law.rho15());
        }
    }
}
