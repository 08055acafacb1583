//! Powers whose published exponents are roots or whole numbers; at those values the results are exact to the bit.

use gearloss_framework::real::Real;

/// A power: by root or product if the exponent is 1/2, 1/3 or a whole number up to five.
#[inline(always)]
pub fn power<R: Real>(x: R, exponent: f64) -> R {
    if exponent == 0.5 {
        x.root()
    } else if exponent == 1.0 / 3.0 {
        x.cube_root()
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
