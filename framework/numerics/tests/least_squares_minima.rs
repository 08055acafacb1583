//! Several minima of a fit.

use crate::classics::{himmelblau, parameters, problem};
use gearloss_numerics::least_squares::{Kinship, Options, Problem, Status, multistart};

#[test]
fn check_2_7_himmelblau_has_four_minima() {
    let of = problem(himmelblau, &[0.0, 0.0], &[-5.0, -5.0], &[5.0, 5.0]);
    let found = multistart(&of, &Options::exact(), 32).unwrap();
    let mut minima: Vec<(f64, f64, usize)> = found
        .minima
        .iter()
        .map(|m| (m.fit.theta[0], m.fit.theta[1], m.starts.len()))
        .collect();
    minima.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected = [
        (-3.77931, -3.28319),
        (-2.80512, 3.13131),
        (3.0, 2.0),
        (3.58443, -1.84813),
    ];
    assert_eq!(minima.len(), 4, "{minima:?}");
    for ((x, y, hits), (a, b)) in minima.iter().zip(expected) {
        assert!((x - a).abs() < 1e-5 && (y - b).abs() < 1e-5);
        assert!((7..=9).contains(hits), "{minima:?}");
    }
    assert_eq!(found.kinship, Some(Kinship::Equivalent));
    assert!((found.minima.iter().map(|m| m.share).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[test]
fn check_2_7_a_valley_is_distinguished_from_equivalent_minima() {
    // Only the product of both is seen.
    let law = |x: &[f64]| [1.0, 2.0, 3.0].map(|t| x[0] * x[1] * t - t - 0.1 * t * t).to_vec();
    let of = problem(law, &[1.0, 1.0], &[0.2, 0.2], &[5.0, 5.0]);
    let found = multistart(&of, &Options::fit(), 12).unwrap();
    assert_eq!(found.kinship, Some(Kinship::Valley));
    assert_eq!(found.minima[0].fit.status, Status::Singular);
    // Two decays that may be exchanged.
    let times: Vec<f64> = (0..20).map(|i| 0.2 * f64::from(i)).collect();
    let law = |x: &[f64], t: f64| (-x[0] * t).exp() + (-x[1] * t).exp();
    let residual = |x: &[f64]| {
        Ok(times
            .iter()
            .map(|t| (law(x, *t) - law(&[0.5, 2.0], *t)) / 0.01)
            .collect())
    };
    let of = Problem::new(residual, parameters(&[1.0, 1.5], &[0.1, 0.1], &[5.0, 5.0]));
    let found = multistart(&of, &Options::fit(), 12).unwrap();
    assert_eq!((found.kinship, found.minima.len()), (Some(Kinship::Equivalent), 2));
}

#[test]
fn check_2_7_a_start_in_a_poorer_minimum_is_reported() {
    // A parabola with a wave on it: many minima, the lowest at zero.
    let law = |x: &[f64]| vec![0.3 * x[0], 2.0 * (2.0 * x[0]).sin(), 2.0 * ((2.0 * x[0]).cos() - 1.0)];
    let of = problem(law, &[6.0], &[-8.0], &[8.0]);
    let found = multistart(&of, &Options::exact(), 16).unwrap();
    assert!(found.minima[0].fit.theta[0].abs() < 1e-6 && found.minima.len() > 2);
    assert!(found.notes[0].contains("does not lead to the lowest"));
}
