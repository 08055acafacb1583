//! Functions that several laws share. Powers whose published exponents are roots or whole numbers; at those values the results are exact to the bit.

use gearloss_framework::real::Real;

/// A power: by root or product if the exponent is 1/2, 1/3 or a whole number up to five.
#[inline(always)]
pub fn power<R: Real>(x: R, exponent: f64) -> R {
    if exponent == 0.5 {
        x.sqrt()
    } else if exponent == 1.0 / 3.0 {
        x.cbrt()
    } else if exponent == 1.0 {
        x
    } else if exponent == 2.0 {
        x * x
    } else if exponent == 3.0 {
        x * x * x
    } else if exponent == 4.0 {
        x * x * (x * x)
    } else if exponent == 5.0 {
        x * x * (x * x) * x
    } else {
        x.power(exponent)
    }
}

/// ln(1 + x), to the digits of x also where it is small.
#[inline(always)]
pub fn ln_1p<R: Real>(x: R) -> R {
    // The rounding of 1 + x cancels.
    let whole = x + 1.0;
    R::select(whole.is_equal(R::constant(1.0)), x, whole.ln() * x / (whole - 1.0))
}

/// exp(x) - 1 of a number that is not positive, to its digits also where it is small.
#[inline(always)]
pub fn exp_m1<R: Real>(x: R) -> R {
    let whole = x.exp();
    let less = whole - 1.0;
    let small = R::select(whole.is_equal(R::constant(1.0)), x, less * x / whole.ln());
    R::select(x.is_below(R::constant(-1.0)), less, small)
}

/// Inverse hyperbolic sine of a number that is not negative.
#[inline(always)]
pub fn asinh<R: Real>(x: R) -> R {
    let small = ln_1p(x + x * x / ((x * x + 1.0).sqrt() + 1.0));
    // Where one no longer counts, its square is not needed; it might overflow.
    R::select(x.is_above(R::constant(1e8)), (x * 2.0).ln(), small)
}
