//! The dilogarithm, the sum of x^n/n^2, which gives the mean stress over a transit in closed form.

use std::f64::consts::PI;

use gearloss_framework::real::{Mask as _, Real};

use crate::powers::ln_1p;

/// B_2k/(2k + 1)! from k = 1; with |ln(1 - x)| below ln 2 the next term is below 1e-17.
const DEBYE: [f64; 8] = [
    1.0 / 36.0,
    -1.0 / 3_600.0,
    1.0 / 211_680.0,
    -1.0 / 10_886_400.0,
    1.0 / 526_901_760.0,
    -4.064_761_645_144_226e-11,
    8.921_691_020_456_453e-13,
    -1.993_929_586_072_108e-14,
];

/// Terms of the sum; for x up to 0.172 the next one is below 1e-17.
const TERMS: usize = 18;

/// The dilogarithm of -y, for y from zero to infinity, to about 1e-15.
#[inline(always)]
pub fn dilogarithm_of_negative<R: Real>(y: R) -> R {
    let far = y.is_above(R::constant(1.0));
    // Debye's series in u = -ln(1 - x), from minus one to zero.
    let u = -ln_1p(R::select(far, R::constant(1.0) / y, y));
    let u_2 = u * u;
    let mut tail = R::ZERO;
    for term in DEBYE.iter().rev() {
        tail = tail * u_2 + *term;
    }
    let near = u - u_2 * 0.25 + u * u_2 * tail;
    if !far.any() {
        return near;
    }
    let ln = y.ln();
    R::select(far, -(ln * ln * 0.5) - PI * PI / 6.0 - near, near)
}

/// The dilogarithm of x from zero to 3 - 2 sqrt(2), about 0.1716, to about 1e-16.
#[inline(always)]
pub fn dilogarithm_of_small<R: Real>(x: R) -> R {
    let mut sum = R::ZERO;
    for n in (1..=TERMS).rev() {
        sum = (sum + 1.0 / (n * n) as f64) * x;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn special_values() {
        assert_eq!((dilogarithm_of_negative(0.0), dilogarithm_of_small(0.0)), (0.0, 0.0));
        assert!((dilogarithm_of_negative(1.0) + PI * PI / 12.0).abs() < 1e-15);
    }

    #[test]
    fn is_its_sum() {
        for i in 1..60 {
            let y = f64::from(i) / 120.0;
            let sum: f64 = (1..200).map(|n| (-y).powi(n) / f64::from(n * n)).sum();
            assert!((dilogarithm_of_negative(y) - sum).abs() < 1e-14, "{y}");
        }
    }

    /// Landen: Li2(-y) = -Li2(y/(1 + y)) - ln(1 + y)^2/2, where the sum converges for any y.
    #[test]
    fn is_its_sum_after_landen() {
        for i in 1..=80 {
            let y = 0.1 * f64::from(i);
            let z = y / (1.0 + y);
            let sum: f64 = (1..600).rev().map(|n| z.powi(n) / f64::from(n * n)).sum();
            let expected = -sum - 0.5 * y.ln_1p().powi(2);
            assert!((dilogarithm_of_negative(y) / expected - 1.0).abs() < 1e-14, "{y}");
        }
    }

    #[test]
    fn duplication_connects_both_functions() {
        for i in 1..=100 {
            let x = 0.00172 * f64::from(i);
            let (both, of_square) = (
                dilogarithm_of_small(x) + dilogarithm_of_negative(x),
                0.5 * dilogarithm_of_small(x * x),
            );
            assert!((both - of_square).abs() < 2e-16, "{x}: {both} {of_square}");
        }
    }
}
