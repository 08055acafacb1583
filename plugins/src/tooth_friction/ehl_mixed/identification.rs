//! The rheology of an oil from measurements: Eyring stress and exponent over pressure from traction curves, boundary friction from
//! a Stribeck curve.
//!
//! Source: LaFountain, Johnston, Spikes, Tribol. Trans. 44 (2001) 648-656, in three steps. First, at one pressure and temperature
//! the stress rises with the logarithm of the shear rate, and the slope is the Eyring stress ([`Isotherm::slope`]); it is too low
//! where the stress is not well above it. Then the exponent over pressure with that stress. Finally both together, by least squares
//! of [`residual`] ([`TractionFit`]). Use only points above 1 % sliding
//! and below the shear rate of maximum stress, above which heating dominates. The law is linear in boundary friction, so its least
//! squares solution is closed ([`boundary_friction`]).

mod curves;

use gearloss_framework::lubricant::roelands::Roelands;
use gearloss_numerics::fit::Squares;
use gearloss_numerics::least_squares::{Parameter, Problem};

pub use curves::{Curve, curves, limiting};

use super::mixed::{boundary_share, friction};

/// One point of a traction curve. SI, temperature in degC.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TractionPoint {
    /// Mean pressure. \[Pa\]
    pub pressure: f64,
    /// Temperature of the film: that of the bodies with flash and film. \[degC\]
    pub temperature: f64,
    /// Sliding speed over measured film. \[1/s\]
    pub shear_rate: f64,
    /// Mean stress: friction times mean pressure. \[Pa\]
    pub stress: f64,
}

/// Stress according to Eyring at a shear rate for a viscosity law, of which `z` is used. \[Pa\]
pub fn stress(law: &Roelands, tau0: f64, pressure: f64, temperature: f64, shear_rate: f64) -> f64 {
    tau0 * (law.eta(pressure, temperature) * shear_rate / tau0).asinh()
}

/// Calculated minus measured stress for an Eyring stress (Pa) and an exponent over pressure; the viscosity at zero pressure is that
/// of the law. \[Pa\]
pub fn residual(law: &Roelands, tau0: f64, z: f64, point: &TractionPoint) -> f64 {
    let law = Roelands { z, ..*law };
    stress(&law, tau0, point.pressure, point.temperature, point.shear_rate) - point.stress
}

/// Eyring stress from the points of one pressure and temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotherm {
    /// Slope of stress over the logarithm of the shear rate: the Eyring stress. \[Pa\]
    pub slope: f64,
    /// Number of points used; the weight of the isotherm in a mean.
    pub points: usize,
}

/// Stress over the Eyring stress above which a point is on the straight part.
const STRAIGHT: f64 = 1.5;

impl Isotherm {
    /// The slope of the points whose stress is above one and a half times the slope, by iteration from all points; `None` with
    /// fewer than two.
    pub fn slope(points: &[TractionPoint]) -> Option<Self> {
        let mut found: Option<Self> = None;
        // Points may leave or return in each iteration; if the set alternates between two, the last one is used.
        for _ in 0..20 {
            let above = found.map_or(0.0, |f| STRAIGHT * f.slope);
            let chosen = || points.iter().filter(|p| p.stress > above && p.shear_rate > 0.0);
            let n = chosen().count();
            if n < 2 {
                return found;
            }
            let mean = |value: fn(&TractionPoint) -> f64| chosen().map(value).sum::<f64>() / n as f64;
            let (x, y) = (mean(|p| p.shear_rate.ln()), mean(|p| p.stress));
            let (xy, xx) = chosen().fold((0.0, 0.0), |(xy, xx), p| {
                let dx = p.shear_rate.ln() - x;
                (xy + dx * (p.stress - y), xx + dx * dx)
            });
            let next = Self {
                slope: xy / xx,
                points: n,
            };
            if !next.slope.is_finite() {
                return found;
            }
            if found == Some(next) {
                break;
            }
            found = Some(next);
        }
        found
    }

    /// Mean of several slopes weighted by their number of points, and the standard deviation. \[Pa\] `None` without slopes.
    pub fn mean(isotherms: &[Self]) -> Option<(f64, f64)> {
        let weight: f64 = isotherms.iter().map(|i| i.points as f64).sum();
        if weight == 0.0 {
            return None;
        }
        let weighted =
            |value: &dyn Fn(&Self) -> f64| isotherms.iter().map(|i| i.points as f64 * value(i)).sum::<f64>() / weight;
        let mean = weighted(&|i| i.slope);
        Some((mean, weighted(&|i| (i.slope - mean).powi(2)).sqrt()))
    }
}

/// Bounds of the Eyring stress as in `lubricants`. \[MPa\]
const TAU0: [f64; 2] = [0.1, 50.0];
/// Bounds of the pressure exponent.
const Z: [f64; 2] = [0.2, 1.2];
/// Start value of the pressure exponent.
pub const START: f64 = 0.5;
const MPA: f64 = 1e6;

/// The second and the third step of a fit to traction curves.
#[derive(Debug, Clone, PartialEq)]
pub struct TractionFit {
    /// Eyring stress of the second step: the mean slope within the bounds. \[MPa\]
    pub tau0: f64,
    /// The exponent with that stress; residuals in MPa.
    pub exponent: Squares,
    /// Eyring stress in MPa and exponent together; residuals in MPa.
    pub both: Squares,
}

impl TractionFit {
    /// Fits points, from the mean slope of their curves on (Pa).
    ///
    /// # Errors
    /// Why a fit did not converge, or its accuracy cannot be stated.
    pub fn new(law: &Roelands, points: &[TractionPoint], mean_slope: f64) -> Result<Self, String> {
        let residuals = |tau0: f64, z: f64| points.iter().map(|p| residual(law, tau0 * MPA, z, p) / MPA).collect();
        let bounded =
            |name: &str, start: f64, [lower, upper]: [f64; 2]| Parameter::new(name, start).within(lower, upper);
        let tau0 = (mean_slope / MPA).clamp(TAU0[0], TAU0[1]);
        let second = |theta: &[f64]| Ok(residuals(tau0, theta[0]));
        let exponent = Squares::solve(&Problem::new(second, vec![bounded("z", START, Z)]))?;
        let third = |theta: &[f64]| Ok(residuals(theta[0], theta[1]));
        let start = vec![
            bounded("tau0", tau0, TAU0),
            bounded("z", exponent.estimates[0].value, Z),
        ];
        let both = Squares::solve(&Problem::new(third, start))?;
        Ok(Self { tau0, exponent, both })
    }
}

/// One point of a Stribeck curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StribeckPoint {
    /// Film thickness over roughness.
    pub lambda: f64,
    /// Calculated friction of the film alone.
    pub film: f64,
    /// Measured friction.
    pub mu: f64,
}

/// Calculated minus measured friction for a coefficient of boundary friction.
pub fn mixed_residual(mu_b: f64, exponent: f64, point: &StribeckPoint) -> f64 {
    friction(point.film, mu_b, boundary_share(point.lambda, exponent)) - point.mu
}

/// The least squares coefficient of boundary friction of [`mixed_residual`]; `None` if no point has boundary friction.
pub fn boundary_friction(points: &[StribeckPoint], exponent: f64) -> Option<f64> {
    let (above, below) = points.iter().fold((0.0, 0.0), |(above, below), p| {
        let share = boundary_share(p.lambda, exponent);
        (above + share * (p.mu - (1.0 - share) * p.film), below + share * share)
    });
    (below > 0.0).then(|| above / below)
}

/// Bounds of the coefficient of boundary friction as in `lubricants`.
const MU_B: [f64; 2] = [0.01, 0.5];

/// The coefficient of boundary friction within its bounds, with its accuracy.
///
/// # Errors
/// Why the fit did not converge, or its accuracy cannot be stated.
pub fn fit_boundary_friction(points: &[StribeckPoint], exponent: f64) -> Result<Squares, String> {
    let start = boundary_friction(points, exponent).unwrap_or(MU_B[0]);
    let mu_b = Parameter::new("mu_b", start.clamp(MU_B[0], MU_B[1])).within(MU_B[0], MU_B[1]);
    let all = |theta: &[f64]| Ok(points.iter().map(|p| mixed_residual(theta[0], exponent, p)).collect());
    Squares::solve(&Problem::new(all, vec![mu_b]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::{base_oil, close};

    fn law(z: f64) -> Roelands {
        Roelands {
            ln_ratio: (0.022 / gearloss_framework::lubricant::roelands::ETA_INF).ln(),
            reference: 40.0,
            s0: 1.2,
            z,
        }
    }

    /// The synthetic data of the check: three pressures, four shear rates, 5.2 MPa and 0.62.
    fn synthetic() -> Vec<[TractionPoint; 4]> {
        [0.8e9, 1.0e9, 1.2e9]
            .map(|pressure| {
                [2e5, 5e5, 1e6, 2e6].map(|shear_rate| TractionPoint {
                    pressure,
                    temperature: 60.0,
                    shear_rate,
                    stress: stress(&law(0.62), 5.2e6, pressure, 60.0, shear_rate),
                })
            })
            .to_vec()
    }

    fn squares(tau0: f64, z: f64) -> f64 {
        let law = law(0.5);
        let all = synthetic();
        all.iter().flatten().map(|p| residual(&law, tau0, z, p).powi(2)).sum()
    }

    #[test]
    fn u3b_stress_of_newton_eyring_and_with_elastic_strain() {
        let oil = base_oil().roelands(None);
        let eta = oil.eta(1e9, 60.0);
        close(eta, 344.082254);
        close(eta * 1e5, 34.40823e6);
        close(stress(&oil, 5e6, 1e9, 60.0, 1e5), 13.13621e6);
        // Far above the Eyring stress the law is a straight line over the logarithm of the shear rate.
        close(5e6 * (2.0 * eta * 1e5 / 5e6).ln(), 13.11002e6);
    }

    #[test]
    fn u3l_synthetic_set() {
        let all = synthetic();
        close(all[0][0].stress, 9.744835e6);
        close(all[2][3].stress, 3.864934e7);
    }

    #[test]
    fn u3m_slopes_and_exponent_with_their_mean() {
        let isotherms: Vec<Isotherm> = synthetic().iter().map(|set| Isotherm::slope(set).unwrap()).collect();
        for (isotherm, printed) in isotherms.iter().zip([5.147599e6, 5.198162e6, 5.199923e6]) {
            close(isotherm.slope, printed);
            assert_eq!(isotherm.points, 4);
        }
        let (mean, deviation) = Isotherm::mean(&isotherms).unwrap();
        assert!(deviation < 0.01 * mean);
        // With the mean slope the sum of squares has its minimum at this exponent: it rises on both sides of its last digit.
        let z = 0.6204725;
        let at = |z: f64| squares(mean, z);
        assert!(at(z) < at(z - 1e-6) && at(z) < at(z + 1e-6));
    }

    #[test]
    fn u3n_both_together() {
        // The solution makes the residuals vanish, and no nearby value does.
        assert!(squares(5.2e6, 0.62) < 1e-10);
        for (dt, dz) in [
            (1e3, 0.0),
            (-1e3, 0.0),
            (0.0, 1e-4),
            (0.0, -1e-4),
            (1e3, -1e-4),
            (-1e3, 1e-4),
        ] {
            assert!(squares(5.2e6 + dt, 0.62 + dz) > 1e5);
        }
    }

    #[test]
    fn boundary_friction_of_a_stribeck_curve() {
        let curve = |noise: f64| -> Vec<StribeckPoint> {
            (0..12)
                .map(|i| {
                    let lambda = 0.05 * 1.5_f64.powi(i);
                    let film = 0.02 + 0.001 * f64::from(i);
                    let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                    StribeckPoint {
                        lambda,
                        film,
                        mu: friction(film, 0.13, boundary_share(lambda, 2.0)) + noise * sign,
                    }
                })
                .collect()
        };
        close(boundary_friction(&curve(0.0), 2.0).unwrap(), 0.13);
        let points = curve(0.002);
        let found = boundary_friction(&points, 2.0).unwrap();
        let sum = |mu_b: f64| points.iter().map(|p| mixed_residual(mu_b, 2.0, p).powi(2)).sum::<f64>();
        assert!((found - 0.13).abs() < 0.002 && sum(found) < sum(found + 1e-4) && sum(found) < sum(found - 1e-4));
        assert!(boundary_friction(&[], 2.0).is_none());
    }

    #[test]
    fn curves_that_say_nothing_have_no_slope() {
        let point = synthetic()[0][0];
        assert!(Isotherm::slope(&[]).is_none() && Isotherm::slope(&[point]).is_none());
        assert!(Isotherm::slope(&[point, point]).is_none());
        assert!(Isotherm::mean(&[]).is_none());
    }
}
