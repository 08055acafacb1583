//! Complete elliptic integrals.

use std::f64::consts::FRAC_PI_2;

/// The complete elliptic integrals of the first and second kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Elliptic {
    /// K(m).
    pub first: f64,
    /// E(m).
    pub second: f64,
    /// (K - E)/(m E), which tends to 1/2 where m tends to zero.
    pub excess: f64,
}

impl Elliptic {
    /// The integrals of the parameter m = 1 - k'^2, from the complementary modulus k' in (0, 1], by arithmetic-geometric means
    /// (Abramowitz and Stegun 17.6).
    pub fn complementary(modulus: f64) -> Self {
        let parameter = (1.0 - modulus) * (1.0 + modulus);
        let (mut a, mut b) = (1.0, modulus);
        // The sum of 2^(n-1) c_n^2 over the parameter, whose first term is a half; c_n = (a - b)/2.
        let (mut sum, mut weight, mut c) = (0.5, 1.0, 0.5 * (1.0 - modulus));
        while c > 1e-15 * a {
            sum += weight * c * c / parameter;
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
            (weight, c) = (2.0 * weight, 0.5 * (a - b));
        }
        let first = FRAC_PI_2 / a;
        let share = 1.0 - parameter * sum;
        Self {
            first,
            second: first * share,
            excess: sum / share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Elliptic;
    use crate::testing::assert_close;
    use std::f64::consts::FRAC_PI_2;

    /// Abramowitz and Stegun, tables 17.1 and 17.2: m = 0.5 and 0.99.
    #[test]
    fn tabulated_values() {
        for (m, first, second) in [
            (0.5_f64, 1.854_074_677_301_37, 1.350_643_881_047_68),
            (0.99, 3.695_637_362_989_87, 1.015_993_545_025_22),
        ] {
            let found = Elliptic::complementary((1.0 - m).sqrt());
            assert_close(found.first, first, 1e-13);
            assert_close(found.second, second, 1e-13);
            assert_close(found.excess, (first - second) / (m * second), 1e-12);
        }
    }

    /// Of a circle, and of a long ellipse: K = ln(4/k').
    #[test]
    fn both_ends() {
        let circle = Elliptic::complementary(1.0);
        assert_eq!(
            [circle.first, circle.second, circle.excess],
            [FRAC_PI_2, FRAC_PI_2, 0.5]
        );
        let nearly = Elliptic::complementary(1.0 - 1e-12);
        assert_close(nearly.excess, 0.5, 1e-11);
        let long = Elliptic::complementary(1e-7);
        assert_close(long.first, (4e7_f64).ln(), 1e-12);
        assert_close(long.second, 1.0, 1e-12);
    }
}
