//! Specific heat and thermal conductivity according to Cragoe 1929, for petroleum oils.

/// Specific heat from density at 15 degC and temperature in degC. \[J/(kg K)\]
pub fn heat_capacity(rho15: f64, temperature: f64) -> f64 {
    (1685.0 + 3.39 * temperature) / (rho15 * 1e-3).sqrt()
}

/// Thermal conductivity from density at 15 degC and temperature in degC. \[W/(m K)\]
pub fn conductivity(rho15: f64, temperature: f64) -> f64 {
    0.1172 / (rho15 * 1e-3) * (1.0 - 5.4e-4 * temperature)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d4_at_80_degc() {
        assert!((heat_capacity(845.0, 80.0) / 2128.07 - 1.0).abs() < 1e-5);
        assert!((conductivity(845.0, 80.0) / 0.132706 - 1.0).abs() < 1e-5);
    }
}
