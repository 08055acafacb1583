//! Dry air at one atmosphere.
//!
//! Source: Sutherland's law for the viscosity, the gas law for the density, conductivity 0.02624 (T/300)^0.8646 W/(m K), specific
//! heat 1006 J/(kg K); T in K.

/// Air at a temperature.
#[derive(Debug, Clone, Copy)]
pub struct Air {
    /// Density. \[kg/m3\]
    pub rho: f64,
    /// Dynamic viscosity. \[Pa s\]
    pub mu: f64,
    /// Kinematic viscosity. \[m2/s\]
    pub nu: f64,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: f64,
    /// Prandtl number.
    pub prandtl: f64,
}

impl Air {
    /// Air at a temperature in K.
    pub fn at_temperature(kelvin: f64) -> Self {
        let mu = 1.458e-6 * kelvin.powf(1.5) / (kelvin + 110.4);
        let rho = 101_325.0 / (287.05 * kelvin);
        let conductivity = 0.02624 * (kelvin / 300.0).powf(0.8646);
        Self {
            rho,
            mu,
            nu: mu / rho,
            conductivity,
            prandtl: mu * 1006.0 / conductivity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn e4_air_at_50_degc() {
        let air = Air::at_temperature(323.15);
        assert!((air.nu / 1.78842e-5 - 1.0).abs() < 1e-5, "{}", air.nu);
        assert!((air.rho * air.nu / air.mu - 1.0).abs() < 1e-15);
        assert!((0.68..0.73).contains(&air.prandtl));
    }
}
