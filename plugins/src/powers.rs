//! Powers whose published exponents are roots or whole numbers; at those values the results are exact to the bit.

/// A power: by root or product if the exponent is 1/2, 1/3 or a whole number up to five.
pub fn power(x: f64, exponent: f64) -> f64 {
    if exponent == 0.5 {
        x.sqrt()
    } else if exponent == 1.0 / 3.0 {
        x.cbrt()
    } else if exponent == 1.0 {
        x
    } else if exponent == 2.0 {
        x * x
    } else if exponent == 3.0 {
        x.powi(3)
    } else if exponent == 4.0 {
        x.powi(4)
    } else if exponent == 5.0 {
        x.powi(5)
    } else {
        x.powf(exponent)
    }
}
