//! Static safety of rolling bearings.
//!
//! Source: ISO 76:2006: S0 = C0/P0 with P0 = X0 Fr + Y0 Fa, and never less than Fr for radial bearings.

use crate::real::Real;

/// Minimum static safety below which a bearing is reported: ISO 76 requires 1 in normal, smoothly running service with ball
/// bearings, and more with roller bearings.
pub const LEAST_STATIC_SAFETY: f64 = 1.0;

/// Data for the static safety of a rolling bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticRating {
    /// Basic static load rating C0. \[N\]
    pub c0: f64,
    /// Factors of the equivalent static load.
    pub factors: StaticFactors,
}

/// Factors of the equivalent static load P0 = max(minimum share times Fr, X0 Fr + Y0 Fa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticFactors {
    /// X0.
    pub radial: f64,
    /// Y0.
    pub axial: f64,
    /// Minimum of P0 over the radial load: one for radial bearings, zero for thrust bearings.
    pub least: f64,
}

impl StaticFactors {
    /// The factors of a radial bearing.
    pub const fn radial(x0: f64, y0: f64) -> Self {
        Self {
            radial: x0,
            axial: y0,
            least: 1.0,
        }
    }

    /// Equivalent static load P0. \[N\]
    #[inline]
    pub fn load<R: Real>(&self, radial: R, axial: R) -> R {
        (radial * self.radial + axial * self.axial).max(radial * self.least)
    }
}

impl StaticRating {
    /// Static safety S0 = C0/P0; infinite without load.
    #[inline]
    pub fn safety<R: Real>(&self, radial: R, axial: R) -> R {
        R::constant(self.c0) / self.factors.load(radial, axial.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deep_groove_after_iso_76() {
        // 6308: C0 24 kN. A purely radial load counts fully; at 3 kN and 1 kN the radial load is the larger one.
        let rating = StaticRating {
            c0: 24_000.0,
            factors: StaticFactors::radial(0.6, 0.5),
        };
        assert_eq!(rating.safety(3000.0, 1000.0), 8.0);
        assert_eq!(rating.safety(1000.0, 3000.0), 24_000.0 / 2100.0);
        assert_eq!(rating.safety(1000.0, -3000.0), 24_000.0 / 2100.0);
        assert_eq!(rating.safety(0.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn thrust_bearings_count_their_thrust_alone() {
        let rating = StaticRating {
            c0: 50_000.0,
            factors: StaticFactors {
                radial: 0.0,
                axial: 1.0,
                least: 0.0,
            },
        };
        assert_eq!(rating.safety(10.0, 100_000.0), 0.5);
    }
}
