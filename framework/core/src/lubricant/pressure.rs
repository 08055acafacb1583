//! Pressure-viscosity coefficient, and viscosity under pressure.

use crate::real::Real;

/// How the pressure-viscosity coefficient is computed from the oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PressureViscosity {
    /// Gold et al., Ind. Lubr. Tribol. 2001: alpha = s nu^t 1e-9 1/Pa, nu in mm2/s.
    Gold {
        /// Factor s.
        s: f64,
        /// Exponent t.
        t: f64,
    },
    /// So and Klaus, ASLE Trans. 1980, from viscosity, its slope B over temperature, and density.
    SoKlaus {
        /// Slope B of ASTM D341.
        slope: f64,
    },
    /// Wooster: alpha = (0.6 + 0.965 lg eta) 1e-8 1/Pa, eta in mPa s.
    Wooster,
    /// A given coefficient. \[1/Pa\]
    Constant(f64),
}

/// Minimum coefficient of a correlation: below 1 mm2/s correlations end or become negative. \[1/Pa\]
const LEAST: f64 = 1e-9;

impl PressureViscosity {
    /// Coefficient from viscosity in mm2/s, dynamic viscosity in mPa s and density in kg/m3. \[1/Pa\]
    pub fn alpha(self, nu: f64, eta: f64, rho: f64) -> f64 {
        match self {
            Self::Gold { s, t } => s * nu.powf(t) * 1e-9,
            Self::SoKlaus { slope } => so_klaus(nu, slope, rho).max(LEAST),
            Self::Wooster => ((0.6 + 0.965 * eta.log10()) * 1e-8).max(LEAST),
            Self::Constant(alpha) => alpha,
        }
    }
}

/// So and Klaus from viscosity in mm2/s above 1, slope B of ASTM D341 and density in kg/m3. \[1/Pa\]
fn so_klaus(nu: f64, slope: f64, rho: f64) -> f64 {
    let lg = nu.max(1.0).log10();
    let viscous = 4.143 * lg.powf(3.0627);
    let thermal = 2.848e-4 * slope.powf(5.1903) * lg.powf(1.5976);
    let dense = 3.999 * lg.powf(3.0975) * (rho * 1e-3).powf(0.1162);
    (1.216 + viscous + thermal - dense) * 1e-8
}

/// Viscosity under pressure according to Roelands 1966. \[Pa s\] `eta0` in Pa s at zero pressure, `alpha` its coefficient in 1/Pa.
#[inline(always)]
pub fn roelands<R: Real>(eta0: R, alpha: R, pressure: R) -> R {
    let one = R::constant(1.0);
    let ln_ratio = eta0.ln() + 9.67;
    let z = alpha / (ln_ratio * 5.1e-9);
    let compressed = ((pressure * 5.1e-9 + one).ln() * z).exp();
    eta0 * (ln_ratio * (compressed - one)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d5_so_klaus_roelands() {
        for (value, printed) in [
            (so_klaus(100.0, 3.5847, 880.0), 2.75857e-8),
            (roelands(0.01, 2e-8, 5e8), 46.4348),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
        }
    }

    #[test]
    fn coefficients_lie_where_oils_lie_and_never_vanish() {
        for law in [
            PressureViscosity::Gold { s: 9.904, t: 0.1390 },
            PressureViscosity::SoKlaus { slope: 3.6 },
            PressureViscosity::Wooster,
        ] {
            let alpha = law.alpha(30.0, 25.0, 850.0);
            assert!((0.7e-8..3e-8).contains(&alpha), "{law:?} {alpha}");
            assert!(law.alpha(0.1, 0.08, 850.0) > 0.0);
        }
    }
}
