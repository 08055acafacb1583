//! Level of the paired comparison of folds, without and with the correction for shared training data, by simulation.
//!
//! Two wrong models with three fitted factors each, equally wrong on average: their shapes are those of the truth times random smooth
//! functions. Five bands of torque are predicted from the others. What a decision is worth is known, since the points are made without
//! noise as well.
#![allow(clippy::print_stdout, reason = "the documentation quotes what the simulation finds")]

use gearloss_numerics::inference::{Decision, Paired, PointSet};
use gearloss_numerics::sampling::inverse_normal;
use gearloss_numerics::selection::{Losses, MeasuredLosses, validate};

/// Uniform and normal numbers that are the same every time (Steele, Lea, Flood: SplitMix, 2014).
pub struct Random(pub u64);

impl Random {
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        inverse_normal(self.uniform()).unwrap()
    }
}

const TORQUES: usize = 5;
const SPEEDS: usize = 8;

/// Torque and speed of all points, from 0.2 and 0.125 to 1.
fn points() -> Vec<[f64; 2]> {
    let point = |i: usize| {
        [
            (i / SPEEDS + 1) as f64 / TORQUES as f64,
            (i % SPEEDS + 1) as f64 / SPEEDS as f64,
        ]
    };
    (0..TORQUES * SPEEDS).map(point).collect()
}

/// A smooth function of torque and speed about one.
fn smooth(random: &mut Random, size: f64) -> impl Fn(&[f64; 2]) -> f64 + use<> {
    let terms: Vec<[f64; 4]> = (0..3)
        .map(|_| {
            [
                random.normal(),
                4.0 * random.normal(),
                4.0 * random.normal(),
                6.3 * random.uniform(),
            ]
        })
        .collect();
    move |[t, w]| {
        1.0 + size
            * terms
                .iter()
                .map(|[a, x, y, phase]| a * (x * t + y * w + phase).sin())
                .sum::<f64>()
    }
}

fn shapes() -> [Vec<f64>; 3] {
    let all = points();
    [
        all.iter().map(|[t, w]| 100.0 * t * w).collect(),
        all.iter().map(|[_, w]| 40.0 * w * w).collect(),
        all.iter().map(|[_, w]| 20.0 * w).collect(),
    ]
}

/// Mean squares of the folds of a model with these shapes, for some losses.
fn folds(shapes: &[Vec<f64>; 3], losses: &[f64], deviation: f64) -> Vec<f64> {
    let measured = MeasuredLosses {
        losses: losses.to_vec(),
        deviations: vec![deviation; losses.len()],
        weights: vec![1.0; losses.len()],
        units: vec![Some(1.0); losses.len()],
        folds: (0..TORQUES).map(|k| (k * SPEEDS..(k + 1) * SPEEDS).collect()).collect(),
        points: PointSet::default(),
    };
    let rest = vec![0.0; losses.len()];
    let losses = Losses {
        rest: &rest,
        mechanisms: shapes.iter().map(|s| vec![s.as_slice()]).collect(),
    };
    validate(&losses, &measured, Some([0.2, 5.0]), vec![0; 3])
        .unwrap()
        .mean_squares
}

fn rms(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn the_plain_interval_keeps_its_level() {
    let truth: Vec<f64> = (0..TORQUES * SPEEDS)
        .map(|i| shapes().iter().map(|s| s[i]).sum())
        .collect();
    // With the correction of Nadeau and Bengio the interval is wider by the root of (1/K + 1/(K - 1)) K.
    let wider = (1.0 + TORQUES as f64 / (TORQUES as f64 - 1.0)).sqrt();
    let mut random = Random(20_031_128);
    // Plain, corrected: wrong decisions, decisions between models whose true errors differ by less than a fifth, all decisions.
    let (mut wrong, mut of_ties, mut decided) = ([0_usize; 2], [0_usize; 2], [0_usize; 2]);
    let (mut all, mut ties) = (0, 0);
    for _ in 0..1500 {
        let deviation = [0.5, 2.0][all % 2];
        let noisy: Vec<f64> = truth.iter().map(|x| x + deviation * random.normal()).collect();
        let mut model = || {
            shapes().map(|shape| {
                let factor = smooth(&mut random, 0.05);
                let changed = shape.iter().zip(points()).map(|(x, p)| x * factor(&p));
                changed.collect::<Vec<f64>>()
            })
        };
        let [a, b] = [model(), model()];
        let [found, exact] = [&noisy, &truth].map(|losses| [&a, &b].map(|shapes| folds(shapes, losses, deviation)));
        let true_ratio = (rms(&exact[0]) / rms(&exact[1])).ln();
        let is_tie = true_ratio.abs() < 0.2;
        all += 1;
        ties += usize::from(is_tie);
        let plain = Paired::from_folds(&found[0], &found[1], 0.01).unwrap();
        let widened = plain.interval.map(|end| plain.ratio * (end / plain.ratio).powf(wider));
        let corrected = Paired {
            interval: widened,
            ..plain
        };
        for (k, paired) in [plain, corrected].into_iter().enumerate() {
            let decision = paired.decision();
            let is_wrong = match decision {
                Decision::Better => true_ratio > 0.0,
                Decision::Worse => true_ratio < 0.0,
                Decision::NotDecided => false,
            };
            wrong[k] += usize::from(is_wrong);
            decided[k] += usize::from(decision != Decision::NotDecided);
            of_ties[k] += usize::from(is_tie && decision != Decision::NotDecided);
        }
    }
    let percent = |x: usize, of: usize| 100.0 * x as f64 / of as f64;
    for (k, words) in ["plain", "corrected"].into_iter().enumerate() {
        println!(
            "{words}: of {ties} ties decided {:.1} %, of {all} pairs decided {:.1} %, wrongly {:.1} %",
            percent(of_ties[k], ties),
            percent(decided[k], all),
            percent(wrong[k], all)
        );
    }
    assert!(percent(of_ties[0], ties) <= 5.0 && percent(wrong[0], decided[0]) <= 5.0);
    assert!(
        3 * decided[1] < 2 * decided[0],
        "the correction costs decisions: {decided:?}"
    );
}
