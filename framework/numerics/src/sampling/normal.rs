//! Quantiles of the normal distribution.

/// Numerator and denominator, in ascending powers, of the three ranges of Wichura's rational approximations.
const CENTRE: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_5,
        133.141_667_891_784_38,
        1_971.590_950_306_551_3,
        13_731.693_765_509_46,
        45_921.953_931_549_87,
        67_265.770_927_008_7,
        33_430.575_583_588_13,
        2_509.080_928_730_122_7,
    ],
    [
        1.0,
        42.313_330_701_600_91,
        687.187_007_492_057_9,
        5_394.196_021_424_751,
        21_213.794_301_586_597,
        39_307.895_800_092_71,
        28_729.085_735_721_943,
        5_226.495_278_852_854,
    ],
];
const SHOULDER: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        0.241_780_725_177_450_6,
        0.022_723_844_989_269_184,
        7.745_450_142_783_414e-4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        0.689_767_334_985_1,
        0.148_103_976_427_480_08,
        0.015_198_666_563_616_457,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
];
const TAIL: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        0.296_560_571_828_504_87,
        0.026_532_189_526_576_124,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ],
    [
        1.0,
        0.599_832_206_555_888,
        0.136_929_880_922_735_8,
        0.014_875_361_290_850_615,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
];

/// Quantile of the standard normal distribution; absent outside the open interval from zero to one.
///
/// Source: Wichura, Algorithm AS 241, Appl. Statist. 37 (1988) 477-484, the long version: relative error near 1e-16.
pub fn inverse_normal(probability: f64) -> Option<f64> {
    if !(probability > 0.0 && probability < 1.0) {
        return None;
    }
    let offset = probability - 0.5;
    if offset.abs() <= 0.425 {
        return Some(offset * ratio(&CENTRE, 0.425 * 0.425 - offset * offset));
    }
    let depth = (-probability.min(1.0 - probability).ln()).sqrt();
    let size = if depth <= 5.0 {
        ratio(&SHOULDER, depth - 1.6)
    } else {
        ratio(&TAIL, depth - 5.0)
    };
    Some(size.copysign(offset))
}

fn ratio([above, below]: &[[f64; 8]; 2], x: f64) -> f64 {
    let sum = |coefficients: &[f64; 8]| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    sum(above) / sum(below)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn quantiles_known_to_fifteen_digits() {
        for (p, x) in [
            (0.5, 0.0),
            (0.25, -0.674_489_750_196_081_7),
            (0.975, 1.959_963_984_540_054),
            (0.995, 2.575_829_303_548_900_4),
            (0.001, -3.090_232_306_167_813_5),
            (1e-9, -5.997_807_015_007_686),
            (1e-20, -9.262_340_089_798_409),
            (1e-300, -37.047_096_299_361_2),
        ] {
            let y = inverse_normal(p).unwrap();
            assert!((y - x).abs() <= 4e-15 * x.abs(), "{p}: {y} {x}");
        }
    }

    #[test]
    fn it_is_odd_and_rises_across_the_joints() {
        let mut before = f64::NEG_INFINITY;
        for i in 1..4000 {
            let p = f64::from(i) / 4000.0;
            let x = inverse_normal(p).unwrap();
            assert!(x > before);
            assert!((x + inverse_normal(1.0 - p).unwrap()).abs() < 1e-12);
            before = x;
        }
        // Either side of the joint at a depth of five.
        let joint = (-25.0_f64).exp();
        let sides = [joint * (1.0 - 1e-12), joint * (1.0 + 1e-12)].map(|p| inverse_normal(p).unwrap());
        assert!((sides[0] - sides[1]).abs() < 1e-12);
    }

    #[test]
    fn there_is_no_value_outside_of_the_open_interval() {
        for p in [0.0, 1.0, -0.1, 1.1, f64::NAN, f64::INFINITY] {
            assert_eq!(inverse_normal(p), None);
        }
        assert!(inverse_normal(f64::MIN_POSITIVE).unwrap().is_finite());
        assert!(inverse_normal(1.0 - f64::EPSILON / 2.0).unwrap().is_finite());
    }
}
