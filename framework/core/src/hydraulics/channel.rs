//! Friction in pipes, bores and ducts: one law for laminar, transitional and turbulent flow, so that a flow is a smooth function of the
//! pressure difference.
//!
//! Source: Churchill, Chemical Engineering 84 (1977) 91, confirmed with an independent program.

use crate::real::{Mask as _, Real};

/// Reynolds number below which the turbulent part of the law is zero to rounding.
const LAMINAR: f64 = 100.0;

/// Maximum number of Newton steps for the flow of a channel.
const MOST_STEPS: usize = 60;

/// A pipe, bore or duct with its losses at inlet, outlet and bends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel {
    /// Hydraulic diameter. \[m\]
    pub diameter: f64,
    /// Area of the cross-section. \[m2\]
    pub area: f64,
    /// Length. \[m\]
    pub length: f64,
    /// Height of the roughness. \[m\]
    pub roughness: f64,
    /// Sum of the loss coefficients of inlet, outlet and bends. \[-\]
    pub losses: f64,
}

/// Friction factor (Darcy) at a Reynolds number, with the relative height of the roughness. \[-\]
pub fn friction_factor<R: Real>(reynolds: R, roughness: f64) -> R {
    friction(reynolds, roughness).0 / reynolds
}

/// Friction factor times the Reynolds number, and the slope of the logarithm of the pressure difference over that of the Reynolds number.
/// \[-\]
fn friction<R: Real>(reynolds: R, roughness: f64) -> (R, R) {
    // Below, the bracket is one to rounding, and its powers would be too large for the numbers.
    let x = reynolds.at_least(1.0);
    let sevenths = (x * (1.0 / 7.0)).power(-0.9);
    let rough = sevenths + 0.27 * roughness;
    let log = -rough.ln() * 2.457;
    let fifteenth = power_15(log);
    let a = fifteenth * log;
    let b = power_15(R::constant(37530.0) / x) * 37530.0 / x;
    // Slopes of both over the logarithm of the Reynolds number.
    let a_slope = fifteenth * (16.0 * 2.457 * 0.9) * sevenths / rough;
    let b_slope = b * -16.0;
    let sum = a + b;
    let eighth = x * 0.125;
    let cube = eighth * eighth * eighth;
    let w = cube * cube * (cube * cube) / (sum * sum.sqrt());
    let bracket = w + 1.0;
    let slope = w / bracket * (R::constant(12.0) - (a_slope + b_slope) / sum * 1.5) * (1.0 / 12.0) + 1.0;
    let twelfth = bracket.sqrt().sqrt().cbrt();
    (twelfth * 64.0, slope)
}

fn power_15<R: Real>(x: R) -> R {
    let square = x * x;
    let fourth = square * square;
    fourth * fourth * fourth * square * x
}

impl Channel {
    /// A round pipe or bore. \[m and -\]
    pub fn round(diameter: f64, length: f64, losses: f64) -> Self {
        Self {
            diameter,
            area: 0.25 * std::f64::consts::PI * diameter * diameter,
            length,
            roughness: 0.0,
            losses,
        }
    }

    /// Pressure difference over a Reynolds number, both as `2 dp d2/(rho nu2)`, and its slope.
    fn resistance<R: Real>(&self, reynolds: R) -> (R, R) {
        let ratio = self.length / self.diameter;
        let (friction, slope) = friction(reynolds, self.roughness / self.diameter);
        let (friction, losses) = (friction * ratio, reynolds * self.losses);
        ((friction + losses) * reynolds, friction * slope + losses * 2.0)
    }

    /// Pressure difference for a flow. \[m3/s, m2/s, kg/m3, Pa\]
    pub fn pressure<R: Real>(&self, flow: R, nu: R, rho: R) -> R {
        let reynolds = flow.abs() * (self.diameter / self.area) / nu;
        let (scaled, _) = self.resistance(reynolds);
        let size = scaled * rho * nu * nu * (0.5 / (self.diameter * self.diameter));
        R::select(flow.is_below(R::ZERO), -size, size)
    }

    /// Flow for a pressure difference, and its slope over the pressure difference. \[m3/s and m3/(s Pa)\]
    pub fn flow<R: Real>(&self, pressure: R, nu: R, rho: R) -> (R, R) {
        let unit = R::constant(2.0 * self.diameter * self.diameter) / (rho * nu * nu);
        let wanted = pressure.abs() * unit;
        // The flow without turbulence is the larger one.
        let laminar = 64.0 * self.length / self.diameter;
        let root = (wanted * (4.0 * self.losses) + laminar * laminar).sqrt();
        let start = wanted * 2.0 / (root + laminar);
        let mut reynolds = start;
        let mut open = start.is_above(R::constant(LAMINAR));
        if open.any() {
            let target = wanted.at_least(f64::MIN_POSITIVE).ln();
            let (mut low, mut high) = (R::constant(LAMINAR.ln()), start.at_least(LAMINAR).ln());
            let mut at = high;
            for _ in 0..MOST_STEPS {
                let (found, tangent) = self.resistance(at.exp());
                let excess = found.ln() - target;
                let is_above = excess.is_above(R::ZERO);
                high = R::select(is_above, at, high);
                low = R::select(is_above, low, at);
                let newton = at - excess * found / (tangent * at.exp());
                let inside = newton.is_above(low) & newton.is_below(high);
                let next = R::select(inside, newton, (low + high) * 0.5);
                let small = (next - at).abs().is_below(R::constant(1e-13));
                at = R::select(open, next, at);
                open = open & !small;
                if !open.any() {
                    break;
                }
            }
            reynolds = R::select(start.is_above(R::constant(LAMINAR)), at.exp(), start);
        }
        // One more step over numbers with derivatives: those of the root.
        let (found, tangent) = self.resistance(reynolds);
        reynolds -= (found - wanted) / tangent;
        let per_reynolds = nu * (self.area / self.diameter);
        let flow = reynolds * per_reynolds;
        let slope = unit * per_reynolds / tangent;
        (R::select(pressure.is_below(R::ZERO), -flow, flow), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydraulics::tests::{L_MIN, close};
    use crate::real::{Dual, Lane, Points as _};

    #[test]
    fn friction_factors_of_churchill() {
        for (re, factor) in [
            (1000.0, 0.064_000_0),
            (2300.0, 0.030_840_1),
            (4000.0, 0.040_589_7),
            (1e5, 0.017_874_8),
        ] {
            close(friction_factor(re, 0.0), factor, 6);
        }
        close(friction_factor(1e5, 1e-3), 0.022_343_2, 6);
    }

    #[test]
    fn a_laminar_pipe() {
        let pipe = Channel::round(6e-3, 0.5, 0.0);
        let flow = 4.0 * L_MIN;
        close(flow * pipe.diameter / pipe.area / 1e-5, 1414.71, 6);
        close(pipe.pressure(flow, 1e-5, 830.0), 8697.85, 6);
    }

    #[test]
    fn flow_and_pressure_are_inverse_in_all_regimes() {
        for pipe in [
            Channel::round(6e-3, 0.5, 0.0),
            Channel::round(3e-3, 1e-3, 2.5),
            Channel {
                roughness: 6e-5,
                ..Channel::round(10e-3, 2.0, 1.0)
            },
        ] {
            let mut last = -1.0;
            for step in 0..400 {
                let pressure = 1e-6 * 10.0_f64.powf(f64::from(step) * 0.035);
                for sign in [1.0, -1.0] {
                    let (flow, slope) = pipe.flow(sign * pressure, 1e-5, 830.0);
                    assert!((pipe.pressure(flow, 1e-5, 830.0) / (sign * pressure) - 1.0).abs() < 1e-12);
                    let h = 1e-5 * pressure;
                    let [up, down] = [h, -h].map(|h| pipe.flow(sign * pressure + h, 1e-5, 830.0).0);
                    assert!((slope * 2.0 * h / (up - down) - 1.0).abs() < 1e-4, "{pressure} {slope}");
                    if sign > 0.0 {
                        assert!(flow > last);
                        last = flow;
                    }
                }
            }
            assert_eq!(pipe.flow(0.0, 1e-5, 830.0).0, 0.0);
        }
    }

    #[test]
    fn lanes_have_the_bits_of_single_points_and_duals_their_slope() {
        let pipe = Channel::round(8e-3, 0.4, 1.5);
        let pressures = |i: usize| 10.0_f64.powf(0.45 * i as f64) - 3.0;
        let together = pipe.flow(Lane::each(pressures), Lane::constant(1e-5), Lane::constant(830.0));
        for i in 0..Lane::COUNT {
            let (flow, slope) = pipe.flow(pressures(i), 1e-5, 830.0);
            assert_eq!(together.0.at_point(i).to_bits(), flow.to_bits());
            assert_eq!(together.1.at_point(i).to_bits(), slope.to_bits());
            let dual = pipe
                .flow(
                    Dual::variable(pressures(i), 0),
                    Dual::constant(1e-5),
                    Dual::constant(830.0),
                )
                .0;
            assert!(
                (dual.slopes[0] / slope - 1.0).abs() < 1e-9,
                "{i}: {} {slope}",
                dual.slopes[0]
            );
        }
    }
}
