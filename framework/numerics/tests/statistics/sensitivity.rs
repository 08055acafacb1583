//! Screening, shares of variance and local sensitivities.

use std::f64::consts::PI;

use gearloss_numerics::sampling::Sobol;
use gearloss_numerics::sensitivity::{Influence, VarianceShares, local, screening, variance_shares};

use super::check_problem::{self, OPTIMUM, Point, parameters, scale, terms};

/// Check values are printed with seven digits, small ones to the same place.
fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance * y.abs().max(1e-3), "{x} instead of {y}");
}

fn all_near<const N: usize>(list: impl IntoIterator<Item = f64>, expected: [f64; N], tolerance: f64) {
    let list: Vec<f64> = list.into_iter().collect();
    assert!(list.len() >= N);
    for (x, y) in list.into_iter().zip(expected) {
        near(x, y, tolerance);
    }
}

fn first(shares: &VarianceShares) -> Vec<f64> {
    shares.first.iter().map(|s| s.value).collect()
}

fn total(shares: &VarianceShares) -> Vec<f64> {
    shares.total.iter().map(|s| s.value).collect()
}

/// A function of one output in the form that is asked for.
fn alone(function: impl Fn(&[f64]) -> f64 + Sync) -> impl Fn(&[f64]) -> Result<Vec<f64>, String> + Sync {
    move |x| Ok(vec![function(x)])
}

fn ishigami(unit: &[f64]) -> f64 {
    let x: Vec<f64> = unit.iter().map(|u| -PI + 2.0 * PI * u).collect();
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

#[test]
fn check_4_ishigami_screening() {
    let found = screening(3, 20, alone(ishigami)).unwrap();
    assert_eq!(found.runs, 80);
    let effects = &found.effects[0];
    all_near(effects.iter().map(|e| e.magnitude), [7.079175, 7.875, 7.498555], 1e-6);
    all_near(effects.iter().map(|e| e.deviation), [6.378993, 8.07958, 9.848964], 1e-6);
    near(effects[0].mean, 7.079175, 1e-6);
    // The mean of the second cancels but for rounding.
    assert!(effects[1].mean.abs() < 1e-12);
    near(effects[2].mean, 1.249759, 1e-6);
    let influences = found.influences(0);
    assert_eq!(influences[0], Influence::Steady);
    assert_eq!(influences[1..], [Influence::NonlinearOrInteracting; 2]);
}

#[test]
fn check_4_ishigami_shares() {
    let few = &variance_shares(3, 1024, 200, alone(ishigami)).unwrap()[0];
    all_near(first(few), [0.3128448, 0.4261678, -0.002624053], 1e-6);
    all_near(total(few), [0.558179, 0.4432846, 0.2421494], 1e-6);
    near(few.variance, 13.81895, 1e-6);
    let many = &variance_shares(3, 8192, 0, alone(ishigami)).unwrap()[0];
    // The last is printed with seven places.
    all_near(first(many), [0.3140874, 0.4417117, 0.0000412], 1e-4);
    all_near(total(many), [0.5586456, 0.4424188, 0.243449], 1e-6);
    // Exact values; the tolerance is the error of quadrature by 8192 points, about five times that of the shares above.
    for (x, y) in first(many).iter().zip([0.313905191, 0.442411145, 0.0]) {
        assert!((x - y).abs() < 2e-3);
    }
    for (x, y) in total(many).iter().zip([0.557588855, 0.442411145, 0.243683664]) {
        assert!((x - y).abs() < 2e-3);
    }
    assert!((many.variance - 13.8445879).abs() < 0.02);
    assert!(many.interact());
    // Another generator draws other rows: an end of the interval is itself known to some tenth of its width.
    let firsts = [[0.26, 0.37], [0.37, 0.47], [-0.11, 0.10]];
    let totals = [[0.48, 0.66], [0.41, 0.48], [0.21, 0.26]];
    for (estimates, expected) in [(&few.first, firsts), (&few.total, totals)] {
        for (estimate, [low, high]) in estimates.iter().zip(expected) {
            let slack = 0.15 * (high - low) + 0.005;
            assert!((estimate.interval[0] - low).abs() < slack, "{estimate:?} {low}");
            assert!((estimate.interval[1] - high).abs() < slack, "{estimate:?} {high}");
        }
    }
}

const G: [f64; 8] = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0];

fn g_function(unit: &[f64]) -> f64 {
    unit.iter()
        .zip(G)
        .map(|(u, a)| ((4.0 * u - 2.0).abs() + a) / (1.0 + a))
        .product()
}

#[test]
fn check_4_g_function_screening() {
    let found = screening(8, 20, alone(g_function)).unwrap();
    let magnitudes = [
        2.864154, 1.563872, 0.674786, 0.3644659, 0.03774648, 0.0348888, 0.03792755, 0.04022099,
    ];
    all_near(found.effects[0].iter().map(|e| e.magnitude), magnitudes, 1e-6);
    let deviations = [3.080461, 1.8186, 0.7764066, 0.4481637];
    all_near(found.effects[0].iter().map(|e| e.deviation), deviations, 1e-6);
    assert_eq!(found.influences(0)[4..], [Influence::None; 4]);
}

#[test]
fn check_4_g_function_shares() {
    let found = &variance_shares(8, 8192, 0, alone(g_function)).unwrap()[0];
    all_near(first(found), [0.7163219, 0.1794296, 0.02457129, 0.00845889], 1e-6);
    all_near(
        total(found),
        [0.7863405, 0.2406328, 0.0343173, 0.01045706, 1.049455e-4],
        1e-6,
    );
    // Exact shares: V_i = 1/(3 (1 + a)^2), V the product of 1 + V_i, less one.
    let parts = G.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    let whole: f64 = parts.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
    near(whole, 0.465424432, 1e-9);
    near(parts[0] / whole, 0.716192169, 1e-9);
    near(parts[4] * (whole + 1.0) / (1.0 + parts[4]) / whole, 1.04949052e-4, 1e-6);
    for k in 0..5 {
        assert!((first(found)[k] - parts[k] / whole).abs() < 2e-3);
        assert!((total(found)[k] - parts[k] * (whole + 1.0) / (1.0 + parts[k]) / whole).abs() < 2e-3);
    }
}

/// The point at which the made-up transmission is looked at.
const AT: Point = Point {
    nu: 6.4,
    torque: 10.0,
    speed: 10000.0,
};

/// The five losses together, without the offset of the rig.
fn total_loss(theta: &[f64]) -> f64 {
    terms(theta, &AT)[..5].iter().sum()
}

/// The coordinates of all parameters over their bounds.
fn total_of_unit(unit: &[f64]) -> f64 {
    let theta: Vec<f64> = (0..8)
        .map(|k| {
            let [low, high] = check_problem::BOUNDS[k].map(|x| scale(k).coordinate(x).unwrap());
            scale(k).theta(low + unit[k] * (high - low))
        })
        .collect();
    total_loss(&theta)
}

#[test]
fn check_4_total_loss_screening() {
    let found = screening(8, 20, alone(total_of_unit)).unwrap();
    let effects = &found.effects[0];
    let magnitudes = [27.42105, 91.95778, 0.0, 51.96533, 66.05073, 57.22212, 85.50332, 0.0];
    all_near(effects.iter().map(|e| e.magnitude), magnitudes, 1e-6);
    let deviations = [39.02109, 7.218559, 23.40448, 48.10534, 10.61361];
    all_near([0, 1, 3, 4, 5].map(|k| effects[k].deviation), deviations, 1e-6);
}

#[test]
fn check_4_total_loss_shares() {
    let found = &variance_shares(8, 8192, 0, alone(total_of_unit)).unwrap()[0];
    let totals = [
        0.02634546, 0.3310527, 0.0, 0.09846326, 0.1436036, 0.1276664, 0.2902711, 0.0,
    ];
    all_near(total(found), totals, 1e-6);
    // Two of them are printed with two digits.
    let firsts = [
        0.008783453,
        0.3298195,
        1.2e-4,
        0.09851724,
        0.1282937,
        0.1269276,
        0.2904194,
        1.2e-4,
    ];
    for (x, y) in first(found).into_iter().zip(firsts) {
        assert!((x - y).abs() <= if y == 1.2e-4 { 5e-6 } else { 1e-6 * y }, "{x} {y}");
    }
    near(found.variance, 2098.847, 1e-6);
    // The mean of the check is that over A alone; ours, as the variance, is over A and B together.
    let sobol = Sobol::new(16).unwrap();
    let alone: f64 = (0..8192).map(|i| total_of_unit(&sobol.point(i)[..8]) / 8192.0).sum();
    near(alone, 180.7869, 3e-7);
    near(found.mean, 180.787093, 3e-9);
}

#[test]
fn check_4_total_loss_elasticities() {
    let found = local(&parameters(&OPTIMUM), 0.0, alone(total_loss)).unwrap();
    // The optimum has ten digits, and so have central differences.
    let expected = [
        0.02093611, 0.5411397, 0.0, 0.117245, 0.1047584, 0.1518217, 0.1356424, 0.0,
    ];
    for (local, y) in found[0].iter().zip(expected) {
        assert!((local.elasticity.unwrap() - y).abs() < 6e-8, "{local:?} {y}");
    }
}
