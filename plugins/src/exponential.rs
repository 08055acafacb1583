//! Exponentials of many numbers at once, for laws that ask for them at every place of a path.
//!
//! The way is the usual one: e^x = 2^k e^r with whole k and |r| at most ln 2 / 2, and the series of e^r. Without tables or
//! branches the compiler computes several numbers in one instruction, which a call for each of them rules out.

use std::f64::consts::LOG2_E;

/// ln 2 in two parts, the first so short that its products with whole numbers are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Added to a number and taken away again it rounds to a whole one, which is then in the lowest bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// The range in which 2^k is a normal number.
const RANGE: (f64, f64) = (-708.0, 709.0);
/// 1/n! up to n = 13; the next term is below 1e-17.
const SERIES: [f64; 14] = [
    1.0,
    1.0,
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// Replaces numbers by their exponentials, to about 1e-15 of each; zero below 1e-307, infinity above 1e308.
pub fn exponentials(numbers: &mut [f64]) {
    for x in numbers {
        *x = exponential(*x);
    }
}

fn exponential(x: f64) -> f64 {
    let shifted = x * LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = x - k * LN_2[0] - k * LN_2[1];
    // Summed in pairs, pairs of pairs and so on, which do not wait for each other.
    let r_2 = r * r;
    let r_4 = r_2 * r_2;
    let two = |n: usize| SERIES[n] + SERIES[n + 1] * r;
    let four = |n: usize| two(n) + two(n + 2) * r_2;
    let series = four(0) + four(4) * r_4 + (four(8) + two(12) * r_4) * (r_4 * r_4);
    // 2^k: the whole number in the lowest bits goes to the place of the exponent.
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    let value = series * power;
    let value = if x < RANGE.0 { 0.0 } else { value };
    if x > RANGE.1 { f64::INFINITY } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        let numbers: Vec<f64> = (-70_700..=70_800).map(|i| f64::from(i) * 0.010_007).collect();
        let mut ours = numbers.clone();
        exponentials(&mut ours);
        for (x, ours) in numbers.iter().zip(ours) {
            assert!((ours / x.exp() - 1.0).abs() < 1e-15, "{x}: {ours} against {}", x.exp());
        }
    }

    #[test]
    fn the_ends_of_the_range_and_what_is_no_number() {
        let mut ends = [0.0, -0.0, f64::NEG_INFINITY, -1e5, 1e5, f64::INFINITY, f64::NAN];
        exponentials(&mut ends);
        assert_eq!(ends[..6], [1.0, 1.0, 0.0, 0.0, f64::INFINITY, f64::INFINITY]);
        assert!(ends[6].is_nan());
    }
}
