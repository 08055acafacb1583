//! Exponential, logarithm and functions derived from them, without tables, branches or calls.
//!
//! The methods are the usual ones: e^x = 2^k e^r with integer k and |r| at most ln 2 / 2, and a polynomial for e^r; ln x = k ln 2 +
//! ln m with m between the roots of one half and of two, and a polynomial for the inverse hyperbolic tangent. The polynomials have
//! nearly the minimum error of their degree: they were computed by the Remez algorithm with 60 digits, and then rounded. The
//! standard library computes one number per call; the compiler computes several of these in one instruction.

use std::f64::consts::LOG2_E;

/// ln 2 in two parts, the first so short that its products with integers are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Added to a number and subtracted again it rounds to an integer, which is then in the lowest bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// The range in which 2^k is a normal number.
const RANGE: (f64, f64) = (-708.0, 709.0);
/// Powers of r in e^r, with a relative error of 1.1e-17.
const POWERS: [f64; 12] = [
    1.0,
    1.0,
    0.500_000_000_000_001_1,
    0.166_666_666_666_664_13,
    0.041_666_666_666_530_267,
    0.008_333_333_333_494_34,
    0.001_388_888_894_359_759_9,
    0.000_198_412_695_067_647_23,
    2.480_149_313_628_451_5e-5,
    2.755_758_628_115_929e-6,
    2.763_023_388_608_424_6e-7,
    2.500_006_726_352_361e-8,
];
/// Powers of s^2 in (artanh(s)/s - 1)/s^2, with an error of 2e-18 of the inverse hyperbolic tangent.
const TANGENT: [f64; 7] = [
    0.333_333_333_333_336_7,
    0.199_999_999_997_074_52,
    0.142_857_143_711_727_64,
    0.111_110_992_885_016_34,
    0.090_917_820_731_686_26,
    0.076_570_273_943_754_47,
    0.073_979_550_911_318_32,
];
/// Bits of the root of one half.
const ROOT_HALF: u64 = 0x3FE6_A09E_667F_3BCD;

/// The exponential, to a relative error of about 1e-15; zero for x below -708, infinity above 709.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let shifted = x * LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = x - k * LN_2[0] - k * LN_2[1];
    // Summed in pairs, pairs of pairs and so on, which are independent of each other.
    let r_2 = r * r;
    let r_4 = r_2 * r_2;
    let two = |n: usize| POWERS[n] + POWERS[n + 1] * r;
    let four = |n: usize| two(n) + two(n + 2) * r_2;
    let series = four(0) + (four(4) + four(8) * r_4) * r_4;
    // 2^k: the integer in the lowest bits is moved to the exponent.
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    let value = series * power;
    let value = if x < RANGE.0 { 0.0 } else { value };
    if x > RANGE.1 { f64::INFINITY } else { value }
}

/// The natural logarithm, to a relative error of about 5e-16; minus infinity at zero and for subnormal numbers, below 2.3e-308.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    // The integer k, with 1024 added, and the mantissa m = x 2^-k.
    let whole = x.to_bits().wrapping_sub(ROOT_HALF).wrapping_add(1024 << 52) >> 52;
    let k = f64::from_bits(whole.wrapping_add(ROUNDER.to_bits())) - (ROUNDER + 1024.0);
    let m = f64::from_bits(x.to_bits().wrapping_sub(whole.wrapping_sub(1024) << 52));
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let z_2 = z * z;
    let two = |n: usize| TANGENT[n] + z * TANGENT[n + 1];
    let series = two(0) + z_2 * (two(2) + z_2 * (two(4) + z_2 * TANGENT[6]));
    let double = s + s;
    let value = k * LN_2[0] + (double + (double * z * series + k * LN_2[1]));
    let value = if x < f64::MIN_POSITIVE {
        f64::NEG_INFINITY
    } else {
        value
    };
    let value = if x < 0.0 { f64::NAN } else { value };
    if x < f64::INFINITY { value } else { x }
}

/// The cube root of a normal positive number or of zero, to a relative error of about 3e-16.
///
/// Newton's method computes the inverse root y from a first guess in the bits, whose upper half is nearly a logarithm, and the root
/// is improved once more. There is no division.
#[inline(always)]
pub fn cbrt(x: f64) -> f64 {
    /// 2^52: integers below it, when added, are in its lowest bits.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    /// Four thirds of the exponent of one, minus the value that minimises the maximum error, which is 3.4 %.
    const FIRST: f64 = 1_430_257_664.0 - 69_000.0;
    let upper = f64::from_bits((x.to_bits() >> 32) | WHOLE.to_bits()) - WHOLE;
    let mut y = f64::from_bits((FIRST - upper * (1.0 / 3.0) + WHOLE).to_bits() << 32);
    // 3.4e-2, 2.4e-3, 1.1e-5, 2.5e-10.
    let mut pass = 0;
    while pass < 3 {
        y += y * (1.0 - x * y * y * y) * (1.0 / 3.0);
        pass += 1;
    }
    let square = y * y;
    let root = x * square;
    let root = root - (root * root * root - x) * square * (1.0 / 3.0);
    if x < f64::INFINITY { root } else { x }
}

/// The sine of an angle of at most 45 deg to either side, to about 3e-16.
#[inline(always)]
pub fn sine(x: f64) -> f64 {
    // (-1)^n/(2n + 1)! for n = 7 down to 1; the next term is below 1e-16 of the sine.
    const TERMS: [f64; 7] = [
        -1.0 / 1_307_674_368_000.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 39_916_800.0,
        1.0 / 362_880.0,
        -1.0 / 5_040.0,
        1.0 / 120.0,
        -1.0 / 6.0,
    ];
    let square = x * x;
    let mut series = TERMS[0];
    let mut n = 1;
    while n < TERMS.len() {
        series = series * square + TERMS[n];
        n += 1;
    }
    x + x * (square * series)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::registers::limited;
    use crate::real::{LANES, Lane, Points as _, Real, WIDTHS};

    #[test]
    fn the_exponential_agrees_with_the_standard_library() {
        for i in -70_700..=70_800 {
            let x = f64::from(i) * 0.010_007;
            assert!(
                (exp(x) / x.exp() - 1.0).abs() < 1e-15,
                "{x}: {} against {}",
                exp(x),
                x.exp()
            );
        }
        assert_eq!(
            [0.0, -0.0, f64::NEG_INFINITY, -1e5, 1e5, f64::INFINITY].map(exp),
            [1.0, 1.0, 0.0, 0.0, f64::INFINITY, f64::INFINITY]
        );
        assert!(exp(f64::NAN).is_nan());
    }

    #[test]
    fn the_logarithm_agrees_with_the_standard_library() {
        for i in -10_210..=10_230 {
            let x = 2.0_f64.powf(f64::from(i) * 0.100_07);
            let (ours, std) = (ln(x), x.ln());
            assert!((ours - std).abs() <= 5e-16 * std.abs(), "{x:e}: {ours} against {std}");
        }
        for i in 1..100_000 {
            let x = 0.5 + f64::from(i) * 1.5e-5;
            let (ours, std) = (ln(x), x.ln());
            assert!((ours - std).abs() <= 5e-16 * std.abs(), "{x}: {ours} against {std}");
        }
        assert_eq!(
            [1.0, 0.0, -0.0, f64::MIN_POSITIVE / 2.0, f64::INFINITY].map(ln),
            [
                0.0,
                f64::NEG_INFINITY,
                f64::NEG_INFINITY,
                f64::NEG_INFINITY,
                f64::INFINITY
            ]
        );
        assert!(ln(-1.0).is_nan() && ln(f64::NAN).is_nan());
    }

    #[test]
    fn the_cube_root_and_the_sine_agree_with_the_standard_library() {
        for i in -900..=900 {
            let x = 10.0_f64.powf(f64::from(i) / 3.1);
            assert!((cbrt(x) / x.cbrt() - 1.0).abs() < 4e-16, "{x:e}");
            let angle = f64::from(i) * 8.72e-4;
            assert!((sine(angle) - angle.sin()).abs() <= 3e-16, "{angle}");
        }
        assert_eq!((cbrt(0.0), cbrt(f64::INFINITY)), (0.0, f64::INFINITY));
    }

    #[test]
    fn wide_instructions_have_the_bits_of_single_numbers() {
        let x = Lane::each(|i| 0.37 + 11.3 * i as f64);
        for width in WIDTHS {
            let together = limited(Some(width)).dispatch(
                #[inline(always)]
                || {
                    let sum = x * x * 0.3 + x / 7.0 - x.power(1.6);
                    [x.map(exp), x.map(ln), x.map(cbrt), x.map(|x| sine(x * 0.007)), sum]
                },
            );
            for i in 0..LANES {
                let x = x[i];
                let sum = x * x * 0.3 + x / 7.0 - x.power(1.6);
                let alone = [exp(x), ln(x), cbrt(x), sine(x * 0.007), sum];
                assert_eq!(
                    together.map(|lane: Lane| lane[i].to_bits()),
                    alone.map(f64::to_bits),
                    "{width}"
                );
            }
        }
    }
}
