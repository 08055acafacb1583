//! Exponential and logarithm, because `core` has none and those of a C library would need a newer version of it.

const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// e to the power of a number; relative error below 1e-15.
pub fn exp(x: f64) -> f64 {
    if x.is_nan() || x > 709.0 {
        return if x > 709.0 { f64::INFINITY } else { x };
    }
    if x < -708.0 {
        return 0.0;
    }
    let half = if x < 0.0 { -0.5 } else { 0.5 };
    let k = (x * core::f64::consts::LOG2_E + half) as i64;
    let rest = (x - k as f64 * LN_2_HIGH) - k as f64 * LN_2_LOW;
    let mut sum = 1.0;
    for i in (1..=14).rev() {
        sum = 1.0 + sum * rest / f64::from(i);
    }
    sum * f64::from_bits(((k + 1023) as u64) << 52)
}

/// Natural logarithm of a positive normal number; relative error below 1e-15 away from one.
pub fn ln(x: f64) -> f64 {
    let bits = x.to_bits();
    let mut exponent = i64::from((bits >> 52) as u32) - 1023;
    let mut fraction = f64::from_bits(bits & 0x000f_ffff_ffff_ffff | 0x3ff0_0000_0000_0000);
    if fraction > core::f64::consts::SQRT_2 {
        fraction *= 0.5;
        exponent += 1;
    }
    // ln f = 2 artanh s with s = (f - 1)/(f + 1), at most 0.172.
    let s = (fraction - 1.0) / (fraction + 1.0);
    let mut sum = 0.0;
    for i in (0..12).rev() {
        sum = sum * s * s + 1.0 / f64::from(2 * i + 1);
    }
    let series = 2.0 * s * sum;
    exponent as f64 * LN_2_HIGH + (exponent as f64 * LN_2_LOW + series)
}

/// A number that is not negative to a power.
pub fn pow(x: f64, power: f64) -> f64 {
    if x > 0.0 { exp(power * ln(x)) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_the_standard_library() {
        for i in -7000..7000 {
            let x = 0.1 * f64::from(i) + 0.037;
            assert!((exp(x) / x.exp() - 1.0).abs() < 2e-15, "{x}");
            let y = (0.01 * x).exp();
            assert!((ln(y) - y.ln()).abs() <= 2e-15 * y.ln().abs().max(1e-3), "{y}");
        }
        assert!((pow(2.5, 0.78) - 2.5_f64.powf(0.78)).abs() < 1e-14);
        assert_eq!(
            (exp(0.0), exp(-800.0), pow(0.0, 0.22), exp(800.0)),
            (1.0, 0.0, 0.0, f64::INFINITY)
        );
        assert!(exp(f64::NAN).is_nan());
    }
}
