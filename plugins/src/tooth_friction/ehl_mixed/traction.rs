//! Mean shear stress in a film: the oil enters unstressed, has Eyring shear thinning, elastic strain and a limiting stress.
//!
//! Sources: Johnson and Tevaarwerk, Proc. R. Soc. A 356 (1977) 215-236: D0 dtau/dtheta = S - sinh tau over the share theta of the
//! transit, in units of the Eyring stress, with D0 = eta U/(2 a G) and S = eta gdot/tau0; limiting stress and regimes according to Evans
//! and Johnson, IMechE C 200 (1986) 313-324; mean over the transit according to Olver and Spikes, Proc. IMechE J 212 (1998) 321-336.
//! The viscosity is that at the mean pressure and the film temperature: with the inlet viscosity S and D0 would be orders of
//! magnitude too small for the flow law from which they are derived.

use gearloss_framework::real::{Mask as _, Points, Real};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::dilogarithm::{dilogarithm_of_negative, dilogarithm_of_small};
use crate::powers::{asinh, exp_m1, ln_1p};

/// Build-up of the stress over the transit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Transit {
    /// Exact mean over the transit.
    #[default]
    Exact,
    /// By regimes; up to 25 % error where S is about 3 and D0 about 1, below 0.4 % for D0 below 0.02, as in gears.
    Chart,
    /// Immediately: steady flow.
    Steady,
}

impl Transit {
    /// Mean stress over the Eyring stress, from S, D0 and the limiting stress.
    #[inline(always)]
    pub fn mean_stress<R: Points>(self, s: R, d0: R, limit: &Limit<R>) -> R {
        match self {
            Self::Exact => exact(s, d0, limit),
            Self::Chart => {
                R::each(|point| chart(s.at_point(point), d0.at_point(point), limit.stress.at_point(point)).0)
            }
            Self::Steady => asinh(s).min(limit.stress),
        }
    }
}

/// Limiting stress of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit<R = f64> {
    /// Over the Eyring stress.
    stress: R,
    /// Of `stress`.
    exponential: R,
}

impl<R: Real> Limit<R> {
    /// From the limiting stress over the Eyring stress.
    #[inline(always)]
    pub fn new(stress: R) -> Self {
        Self {
            stress,
            exponential: stress.exp(),
        }
    }
}

/// Below this S, and above this D0 over sqrt(1 + S^2), the stress remains a fraction of the Eyring stress and the flow is linear,
/// to 1e-8.
const LINEAR: f64 = 1e-4;

/// Above this S its square might overflow, and one is negligible.
const LARGE: f64 = 1e100;

/// Number of relaxations per transit after which the entry has no effect to the last digit.
const STEADY: f64 = 45.0;

/// Exact mean. With c = sqrt(1 + S^2), u = S + c and y = (u (u - 1)/(u + 1)) exp(-c theta/D0) the stress is ln u + ln(1 - y/u^2) -
/// ln(1 + y), whose integral over theta is closed by dilogarithms; after it reaches the limit it stays there.
#[inline(always)]
pub fn exact<R: Real>(s: R, d0: R, limit: &Limit<R>) -> R {
    let (limit, cap) = (limit.stress, limit.exponential);
    let one = R::constant(1.0);
    let c = R::select(s.is_below(R::constant(LARGE)), (s * s + 1.0).sqrt(), s);
    let linear = s.is_below(R::constant(LINEAR)) | (d0 * LINEAR).is_above(c);
    let u = s + c;
    let steady = u.ln();
    let pace = c / d0;
    let entry = u * ((u - 1.0) / (u + 1.0));
    // Leaves the contact at theta = 1, or reaches the limit before. In gears the flow is steady long before.
    let leaves = pace.is_below(R::constant(STEADY));
    let mut y = R::ZERO;
    if leaves.any() {
        y = R::select(leaves, entry * (-pace).exp(), y);
    }
    let mut flowing = one;
    let plastic = limit.is_below(steady);
    if plastic.any() {
        let reached = (u - cap) / (cap + one / u);
        let reaches = plastic & reached.is_above(y);
        y = R::select(reaches, reached, y);
        flowing = R::select(reaches, (entry / reached).ln() / pace, flowing);
    }
    let g = one / (u * u);
    let mean = capped(steady * flowing + (part(entry, g) - part(y, g)) / pace, flowing, limit);
    let mean = if linear.any() {
        R::select(linear, maxwell(s, d0, limit), mean)
    } else {
        mean
    };
    R::select(s.is_zero(), R::ZERO, mean)
}

/// The integral of the stress of y and g = 1/u^2 up to the end of the transit. As y is at most u (u - 1)/(u + 1), g y is at most
/// 3 - 2 sqrt(2).
#[inline(always)]
fn part<R: Real>(y: R, g: R) -> R {
    let some = y.is_above(R::ZERO);
    if some.any() {
        R::select(some, dilogarithm_of_negative(y) - dilogarithm_of_small(g * y), R::ZERO)
    } else {
        R::ZERO
    }
}

/// Adds the part of the transit after the stress has reached its limit.
#[inline(always)]
fn capped<R: Real>(rising: R, flowing: R, limit: R) -> R {
    let one = R::constant(1.0);
    rising + R::select(flowing.is_below(one), (one - flowing) * limit, R::ZERO)
}

/// Mean for a linear viscoelastic oil.
#[inline(always)]
fn maxwell<R: Real>(s: R, d0: R, limit: R) -> R {
    let reaches = limit.is_below(s);
    let yields = (-d0 * ln_1p(-limit / s)).at_most(1.0);
    let flowing = R::select(reaches, yields, R::constant(1.0));
    let x = flowing / d0;
    // The difference in the exact form cancels for stiff oils; its series does not.
    let series = flowing * 0.5 * x * (R::constant(1.0) - x / 3.0 + x * x / 12.0);
    let rising = R::select(x.is_below(R::constant(1e-3)), series, flowing + d0 * exp_m1(-x));
    capped(s * rising, flowing, limit)
}

/// Regime of the stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Linear flow.
    Newtonian,
    /// Shear-thinning flow.
    Eyring,
    /// The limiting stress.
    Plastic,
    /// Elastic strain only.
    Elastic,
    /// Elastic strain and linear flow.
    Viscoelastic,
    /// Elastic strain, then shear-thinning flow.
    ElasticEyring,
    /// Elastic strain, then the limiting stress.
    ElasticPlastic,
}

/// Mean by regimes, and the regime, as in the chart of Evans and Johnson; the boundaries between regimes follow from the exact
/// mean.
pub fn chart(s: f64, d0: f64, limit: f64) -> (f64, Regime) {
    if s <= 0.0 {
        return (0.0, Regime::Newtonian);
    }
    let steady = s.asinh();
    let plastic = limit < steady;
    let least = steady.min(limit);
    if s > 3.0 {
        let rise = d0 * least / s;
        return if rise >= 1.0 {
            (0.5 * s / d0, Regime::Elastic)
        } else {
            let regime = match (plastic, rise < 0.05) {
                (true, true) => Regime::Plastic,
                (true, false) => Regime::ElasticPlastic,
                (false, true) => Regime::Eyring,
                (false, false) => Regime::ElasticEyring,
            };
            (least * (1.0 - 0.5 * rise), regime)
        };
    }
    let d = d0 * steady / s;
    let yields = if plastic {
        -d * (-limit / steady).ln_1p()
    } else {
        f64::INFINITY
    };
    let flowing = yields.min(1.0);
    let after = if flowing < 1.0 { (1.0 - flowing) * limit } else { 0.0 };
    let mean = steady * (flowing + d * (-flowing / d).exp_m1()) + after;
    let regime = if yields < 0.05 {
        Regime::Plastic
    } else if yields < 1.0 {
        Regime::ElasticPlastic
    } else if d >= 0.05 {
        Regime::Viscoelastic
    } else if s <= 1.0 {
        Regime::Newtonian
    } else {
        Regime::Eyring
    };
    (mean, regime)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn exact(s: f64, d0: f64, limit: f64) -> f64 {
        super::exact(s, d0, &Limit::new(limit))
    }

    /// The mean by a fourth-order Runge-Kutta integration, independent of the closed form.
    fn integrated(s: f64, d0: f64, limit: f64) -> f64 {
        let steps = 400_000;
        let h = 1.0 / f64::from(steps);
        let slope = |tau: f64| (s - tau.sinh()) / d0;
        let (mut tau, mut sum) = (0.0_f64, 0.0);
        for _ in 0..steps {
            let k1 = slope(tau);
            let k2 = slope(tau + 0.5 * h * k1);
            let k3 = slope(tau + 0.5 * h * k2);
            let k4 = slope(tau + h * k3);
            let next = (tau + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)).min(limit);
            sum += 0.5 * h * (tau + next);
            tau = next;
        }
        sum
    }

    const FREE: f64 = f64::INFINITY;

    #[test]
    fn u3c_to_u3i_mean_stress() {
        use Regime::{Elastic, ElasticPlastic, Eyring, Newtonian, Plastic, Viscoelastic};
        for (s, d0, limit, printed, by_chart, regime) in [
            (0.5, 0.01, FREE, 0.4767200, 0.4765805, Newtonian),
            (0.5, 2.0, FREE, 0.1064936, 0.1058962, Viscoelastic),
            (50.0, 0.1, FREE, 4.580961, 4.584062, Eyring),
            (50.0, 20.0, FREE, 1.222452, 1.25, Elastic),
            (1e4, 10.0, 6.0, 5.981980, 5.982, Plastic),
            (1e4, 5000.0, 6.0, 0.9999187, 1.0, Elastic),
            (3.0, 0.5, 1.2, 1.057307, 1.038465, ElasticPlastic),
        ] {
            close(exact(s, d0, limit), printed);
            close(chart(s, d0, limit).0, by_chart);
            assert_eq!(chart(s, d0, limit).1, regime, "{s} {d0}");
        }
    }

    #[test]
    fn the_closed_form_solves_the_equation() {
        for s in [2e-4, 0.01, 0.3, 1.0, 3.0, 20.0] {
            for d0 in [0.02, 0.3, 1.0, 30.0, 900.0] {
                for limit in [FREE, 1.5, 0.2] {
                    let (closed, solved) = (exact(s, d0, limit), integrated(s, d0, limit));
                    // The integration step that reaches the limit is cut; that leaves about 1e-6.
                    assert!(
                        (closed / solved - 1.0).abs() < 3e-6,
                        "{s} {d0} {limit}: {closed} {solved}"
                    );
                }
            }
        }
    }

    #[test]
    fn limits_of_the_theory() {
        // Newtonian, Eyring and plastic flow without build-up; linear Maxwell; elastic strain only.
        close(exact(1e-3, 1e-9, FREE), 1e-3_f64.asinh());
        close(exact(1e4, 1e-9, FREE), 1e4_f64.asinh());
        close(exact(1e4, 1e-9, 6.0), 6.0);
        let d0: f64 = 0.7;
        close(exact(1e-3, d0, FREE), 1e-3 * (1.0 - d0 * (1.0 - (-1.0 / d0).exp())));
        // The second term of the series in 1/D0 is a third of it.
        assert!((exact(2.0, 3e3, FREE) / (2.0 / 6e3) - 1.0).abs() < 2e-4);
        assert!((exact(2.0, 1e9, FREE) / (2.0 / 2e9) - 1.0).abs() < 1e-8);
        for ends in [
            exact(0.0, 0.1, 6.0),
            exact(1e-300, 0.1, 6.0),
            exact(1e300, 1e-3, 6.0),
            exact(1e300, 1e300, 6.0),
        ] {
            assert!((0.0..=6.0).contains(&ends), "{ends}");
        }
    }

    #[test]
    fn forms_meet_where_one_takes_over_from_the_other() {
        for (below, above) in [
            (
                exact(LINEAR * (1.0 - 1e-9), 0.3, FREE),
                exact(LINEAR * (1.0 + 1e-9), 0.3, FREE),
            ),
            (
                exact(1.0, 1.999_999e4 / 2.0_f64.sqrt(), FREE),
                exact(1.0, 2.000_001e4 / 2.0_f64.sqrt(), FREE),
            ),
            (exact(2.0, 0.3, 2.0_f64.asinh() - 1e-12), exact(2.0, 0.3, FREE)),
        ] {
            assert!((below / above - 1.0).abs() < 2e-6, "{below} {above}");
        }
    }

    #[test]
    fn the_chart_is_within_its_stated_error() {
        let (mut worst, mut in_gears) = (0.0_f64, 0.0_f64);
        for i in 0..=180 {
            for j in 0..=120 {
                let (s, d0) = (
                    10.0_f64.powf(-3.0 + 0.05 * f64::from(i)),
                    10.0_f64.powf(-3.0 + 0.05 * f64::from(j)),
                );
                for limit in [FREE, 8.0, 1.2, 0.1] {
                    let off = (chart(s, d0, limit).0 / exact(s, d0, limit) - 1.0).abs();
                    worst = worst.max(off);
                    if d0 < 0.02 {
                        in_gears = in_gears.max(off);
                    }
                }
            }
        }
        assert!(worst < 0.26 && in_gears < 0.004, "{worst} {in_gears}");
    }
}
