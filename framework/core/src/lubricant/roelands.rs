//! Viscosity over pressure and temperature in one law, as needed for contacts.
//!
//! Source: Roelands, thesis, Delft 1966: eta = eta_inf exp[ln(eta_r/eta_inf) (1 + p/p_r)^z ((T_r + 135)/(T + 135))^S0], T in
//! degC, eta_inf = 6.31e-5 Pa s, p_r = 1.96e8 Pa. A law fitted at 40 and 100 degC is within 2 % of ASTM D341 from 20 to 140 degC
//! and 4.5 % at 0 degC. Above about 1 GPa the viscosity is too high.

use crate::real::Real;

/// Limit viscosity of all isotherms and isobars. \[Pa s\]
pub const ETA_INF: f64 = 6.31e-5;
/// Reference pressure of the law. \[Pa\]
pub const P_R: f64 = 1.96e8;
/// Zero of the law's temperature scale, below 0 degC. \[K\]
const ZERO: f64 = 135.0;
/// Viscosity at which the law is cut off; far below it a contact is already plastic. \[Pa s\]
const THICKEST: f64 = 1e9;
/// Minimum ln(eta/eta_inf) of a point: a liquid is thicker than the law's limit.
const LEAST: f64 = 1e-2;
/// Maximum logarithm of a change of ln(eta/eta_inf) with temperature, far beyond any oil, to avoid overflow.
const FARTHEST: f64 = 30.0;

/// A fitted law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roelands<R = f64> {
    /// ln(eta_r/eta_inf) at the reference temperature and zero pressure.
    pub ln_ratio: R,
    /// Reference temperature. \[degC\]
    pub reference: R,
    /// Slope index over temperature.
    pub s0: R,
    /// Exponent over pressure.
    pub z: R,
}

#[inline(always)]
fn ln_ratio<R: Real>(eta: R) -> R {
    (eta / ETA_INF).ln().at_least(LEAST)
}

#[inline(always)]
fn above_zero<R: Real>(temperature: R) -> R {
    (temperature + ZERO).at_least(1.0)
}

impl Roelands {
    /// The law through two points of temperature in degC and viscosity in Pa s at zero pressure.
    pub fn through(first: (f64, f64), second: (f64, f64), z: f64) -> Self {
        let (one, two) = (ln_ratio(first.1), ln_ratio(second.1));
        Self {
            ln_ratio: one,
            reference: first.0,
            s0: (one / two).ln() / (above_zero(second.0) / above_zero(first.0)).ln(),
            z,
        }
    }

    /// The same law at each of several points.
    #[inline(always)]
    pub fn everywhere<R: Real>(&self) -> Roelands<R> {
        let [ln_ratio, reference, s0, z] = [self.ln_ratio, self.reference, self.s0, self.z].map(R::constant);
        Roelands {
            ln_ratio,
            reference,
            s0,
            z,
        }
    }
}

impl<R: Real> Roelands<R> {
    /// The law through one point of temperature in degC and viscosity in Pa s, with the relative decrease of viscosity there in
    /// 1/K.
    #[inline(always)]
    pub fn tangent(temperature: R, eta: R, beta: R, z: R) -> Self {
        let ratio = ln_ratio(eta);
        Self {
            ln_ratio: ratio,
            reference: temperature,
            s0: beta * above_zero(temperature) / ratio,
            z,
        }
    }

    /// The exponent that reproduces a pressure-viscosity coefficient in 1/Pa for an oil with a viscosity in Pa s.
    #[inline(always)]
    pub fn exponent(alpha: R, eta: R) -> R {
        alpha * P_R / ln_ratio(eta)
    }

    /// The pressure-viscosity coefficient from an exponent for an oil with a viscosity in Pa s; the inverse of
    /// [`exponent`](Self::exponent). \[1/Pa\]
    #[inline(always)]
    pub fn coefficient(z: R, eta: R) -> R {
        z * ln_ratio(eta) / P_R
    }

    /// ln(eta/eta_inf) at a temperature in degC and zero pressure.
    #[inline(always)]
    pub fn ln_ratio(&self, temperature: R) -> R {
        let cooler = above_zero(self.reference) / above_zero(temperature);
        let change = (self.s0 * cooler.ln()).at_least(-FARTHEST).at_most(FARTHEST);
        self.ln_ratio * change.exp()
    }

    /// Factor of a pressure in Pa on [`ln_ratio`](Self::ln_ratio).
    #[inline(always)]
    pub fn pressed(&self, pressure: R) -> R {
        (self.z * (pressure / P_R + 1.0).ln()).exp()
    }

    /// Viscosity at a temperature in degC under a pressure with this factor. \[Pa s\] At most 1e9 Pa s.
    #[inline(always)]
    pub fn eta_pressed(&self, pressed: R, temperature: R) -> R {
        let power = (self.ln_ratio(temperature) * pressed).at_most(700.0);
        (power.exp() * ETA_INF).at_most(THICKEST)
    }

    /// Viscosity at a pressure in Pa and a temperature in degC. \[Pa s\] At most 1e9 Pa s.
    #[inline(always)]
    pub fn eta(&self, pressure: R, temperature: R) -> R {
        self.eta_pressed(self.pressed(pressure), temperature)
    }

    /// Pressure-viscosity coefficient at zero pressure and a temperature in degC. \[1/Pa\]
    #[inline(always)]
    pub fn alpha(&self, temperature: R) -> R {
        self.z * self.ln_ratio(temperature) / P_R
    }

    /// Relative decrease of viscosity with temperature, at zero pressure and a temperature in degC. \[1/K\]
    #[inline(always)]
    pub fn beta(&self, temperature: R) -> R {
        self.s0 * self.ln_ratio(temperature) / above_zero(temperature)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-6, "{value} against {printed}");
    }

    /// The base oil of the check cases.
    fn base_oil() -> Roelands {
        Roelands::through((40.0, 0.02254980), (100.0, 0.004643300), 0.60)
    }

    #[test]
    fn u3a_base_oil() {
        let oil = base_oil();
        close(oil.s0, 1.062041);
        close(oil.alpha(40.0), 1.799621e-8);
        close(oil.beta(40.0), 0.03567706);
        close(oil.eta(1e9, 60.0), 344.0823);
        close(oil.eta(0.0, 60.0), 0.01191115);
        close(Roelands::exponent(oil.alpha(40.0), 0.02254980), 0.60);
    }

    #[test]
    fn a_tangent_has_the_point_and_its_slope() {
        let oil = base_oil();
        let tangent = Roelands::tangent(60.0, oil.eta(0.0, 60.0), oil.beta(60.0), 0.60);
        for (p, t) in [(0.0, 60.0), (1e9, 60.0), (0.5e9, 120.0), (0.0, -20.0)] {
            close(tangent.eta(p, t), oil.eta(p, t));
        }
    }

    #[test]
    fn beta_and_alpha_are_the_slopes_of_the_law() {
        let oil = base_oil();
        let beta = (oil.eta(0.0, 59.999) / oil.eta(0.0, 60.001)).ln() / 0.002;
        let alpha = (oil.eta(1e3, 60.0) / oil.eta(0.0, 60.0)).ln() / 1e3;
        // Differences over 2 mK and 1 kPa have five accurate digits.
        assert!((beta / oil.beta(60.0) - 1.0).abs() < 1e-5 && (alpha / oil.alpha(60.0) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn no_oil_is_too_thin_too_cold_or_too_hot() {
        for eta in [1e-9, 1e-4, 1.0, 1e4] {
            for t in [-200.0, 0.0, 500.0, 1e9] {
                let oil = Roelands::tangent(40.0, eta, 0.04, 0.6);
                assert!(oil.eta(4e9, t).is_finite() && oil.eta(4e9, t) > 0.0 && oil.alpha(t) > 0.0);
            }
        }
    }
}
