//! The dilogarithm, which gives the mean stress over a transit in closed form.

use std::f64::consts::PI;

use gearloss_framework::real::{Mask as _, Real};

use crate::powers::ln_1p;

/// B_2k/(2k + 1)! from k = 1; with |ln(1 - x)| below ln 2 the next term is below 1e-17.
const SERIES: [f64; 8] = [
    1.0 / 36.0,
    -1.0 / 3_600.0,
    1.0 / 211_680.0,
    -1.0 / 10_886_400.0,
    1.0 / 526_901_760.0,
    -4.064_761_645_144_226e-11,
    8.921_691_020_456_453e-13,
    -1.993_929_586_072_108e-14,
];

/// The sum of x^n/n^2 and its continuation to minus infinity, for x up to one, to about 1e-15.
#[inline(always)]
pub fn dilogarithm<R: Real>(x: R) -> R {
    const WHOLE: f64 = PI * PI / 6.0;
    let (far, mirrored) = (x.is_below(R::constant(-1.0)), x.is_above(R::HALF));
    let rest = (R::constant(1.0) - x).at_least(0.0);
    // Debye's series in u = -ln(1 - y), from minus one to one half.
    let y = R::select(far, R::constant(1.0) / x, R::select(mirrored, rest, x));
    let u = -ln_1p(-y);
    let u_2 = u * u;
    let mut tail = R::ZERO;
    for term in SERIES.iter().rev() {
        tail = tail * u_2 + *term;
    }
    let near = u - u_2 * 0.25 + u * u_2 * tail;
    if !(far | mirrored).any() {
        return near;
    }
    let ln = R::select(far, -x, rest).logarithm();
    // At one the product of both logarithms is zero.
    let product = R::select(rest.is_zero(), R::ZERO, u * ln);
    let beyond = R::select(far, -(ln * ln * 0.5) - WHOLE, product + WHOLE) - near;
    R::select(far | mirrored, beyond, near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn special_values() {
        let ln_2 = std::f64::consts::LN_2;
        for (x, value) in [
            (0.0, 0.0),
            (1.0, PI * PI / 6.0),
            (-1.0, -PI * PI / 12.0),
            (0.5, PI * PI / 12.0 - 0.5 * ln_2 * ln_2),
        ] {
            assert!((dilogarithm(x) - value).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn is_its_series_and_its_inversion() {
        for i in 1..60 {
            let x = f64::from(i) / 60.0 - 0.5;
            let series: f64 = (1..200).map(|n| x.powi(n) / f64::from(n * n)).sum();
            assert!((dilogarithm(x) - series).abs() < 1e-14, "{x}");
            let far = -1.0 - f64::from(i * i);
            let inverted = -PI * PI / 6.0 - 0.5 * (-far).ln().powi(2) - dilogarithm(1.0 / far);
            assert!((dilogarithm(far) / inverted - 1.0).abs() < 1e-14, "{far}");
            // Reflection connects the two sides of one half.
            let y = 0.5 + 0.5 * f64::from(i) / 60.0;
            let both = dilogarithm(y) + dilogarithm(1.0 - y) + y.ln() * (1.0 - y).ln();
            assert!((both - PI * PI / 6.0).abs() < 1e-14, "{y}");
        }
    }
}
