//! Active bounds, priors and parameters that cannot be told apart, in the made-up problem.

use gearloss_numerics::inference::{Accuracy, Fit, Parameter, Scale, Side, Standing, Verdict};
use gearloss_numerics::sensitivity::gradients;
use nalgebra::DMatrix;

use super::check_problem::{AT_BOUND, BOUNDS, NAMES, OPTIMUM, linearised, measured, model, parameters, points, scale};

fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance * y.abs(), "{x} instead of {y}");
}

/// Standard deviation in the parameter's own unit.
fn deviation(fit: &Fit, k: usize) -> f64 {
    let of = &fit.parameters()[k];
    fit.deviation(k).unwrap() * if of.scale == Scale::Log { of.theta() } else { 1.0 }
}

fn all() -> Vec<usize> {
    (0..440).collect()
}

#[test]
fn check_7_5_active_bound() {
    let mut list = parameters(&AT_BOUND);
    list[5].bounds[1] = 0.7;
    let (r, jacobian) = linearised(&list, &all(), &measured());
    let gradient: f64 = jacobian.column(5).iter().zip(&r).map(|(j, r)| j * r).sum();
    list[5].update_state(gradient);
    assert_eq!(list[5].standing, Standing::Active(Side::Upper));
    let fit = Fit::new(list, &jacobian, &r, 0, Accuracy::Given).unwrap();
    // Parameters are given with nine digits; the objective is flat there, its gradient in h is not: 1e-9 of the others
    // times their columns.
    near(fit.objective(), 468.5774166, 1e-9);
    near(fit.gradient(5), -6.90232241, 1e-5);
    let expected = [
        0.22643889,
        0.0516099143,
        0.0299510276,
        0.163000635,
        0.210153988,
        0.00742585455,
        0.00692512491,
    ];
    for (k, y) in [0, 1, 2, 3, 4, 6, 7].into_iter().zip(expected) {
        near(deviation(&fit, k), y, 2e-7);
    }
    assert!(fit.deviation(5).is_none() && fit.correlation(5, 0).is_none() && fit.freedom() == 433.0);
    assert_eq!(fit.determination(5).verdict, Verdict::OnBound(Side::Upper));
    assert_eq!(fit.sentence(5), "is at its upper bound 0.7000; the data prefer more");
    // One-sided 95 %: the objective may rise by 2.705543.
    let profile = fit.to_profile(5, 0.95).unwrap();
    assert!((profile.limit * profile.limit - 2.705543).abs() < 1e-6);
}

#[test]
fn check_7_5_prior() {
    let theta = [
        1.10609834,
        1.11692063,
        0.252810265,
        1.14267328,
        1.03121803,
        0.784450814,
        0.0388149211,
        0.0071040587,
    ];
    let list = parameters(&theta);
    let (mut r, jacobian) = linearised(&list, &all(), &measured());
    r.push(theta[7] / 0.010);
    let mut jacobian = jacobian.resize_vertically(441, 0.0);
    jacobian[(440, 7)] = 1.0 / 0.010;
    let fit = Fit::new(list, &jacobian, &r, 1, Accuracy::Given).unwrap();
    near(fit.objective(), 470.145676, 2e-9);
    assert!((fit.objective() - fit.chi_square() - 0.504676).abs() < 1e-6 && fit.freedom() == 433.0);
    assert_eq!((fit.residuals().len(), fit.leverage().len()), (440, 440));
    let expected = [
        0.208704877,
        0.0476921517,
        0.030670725,
        0.148571107,
        0.222183743,
        0.0382070647,
        0.0094313847,
        0.00846121596,
    ];
    for (k, y) in expected.into_iter().enumerate() {
        near(deviation(&fit, k), y, 2e-7);
    }
}

/// Fit with a model of its own parameters.
fn fit_of(list: Vec<Parameter>, model: impl Fn(&[f64], usize) -> f64 + Sync) -> Fit {
    let (points, measured) = (points(), measured());
    let residual = |theta: &[f64], i: usize| (model(theta, i) - measured[i]) / points[i].sigma();
    let residuals = |theta: &[f64]| (0..440).map(|i| residual(theta, i)).collect::<Vec<f64>>();
    let slopes = gradients(&list, 0.0, |theta| Ok(residuals(theta))).unwrap();
    let jacobian = DMatrix::from_fn(440, list.len(), |i, k| slopes[i][k]);
    let theta: Vec<f64> = list.iter().map(Parameter::theta).collect();
    Fit::new(list, &jacobian, &residuals(&theta), 0, Accuracy::Given).unwrap()
}

#[test]
fn check_7_5_offset_and_constant_drag() {
    let points = points();
    let mut list = parameters(&OPTIMUM);
    list.push(Parameter::new("M_c", Scale::Linear, 0.0, [-0.1, 0.1]).unwrap());
    let fit = fit_of(list, |theta, i| model(theta, &points[i]) + theta[8] * points[i].omega());
    let values = fit.singular_values();
    near(values[6], 0.0557442, 2e-6);
    near(values[7], 0.0182799, 5e-6);
    // Zero but for the noise of differences: 600 W have a last digit of 1e-13 W, a step of the offset moves them by 3e-4 W.
    assert!(values[8] < 4e-10 * values[0] && fit.is_singular());
    let null = fit.direction(8);
    for (k, entry) in null.iter().enumerate() {
        let expected = if k < 7 { 0.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
        assert!((entry.abs() - expected).abs() < 1e-6, "{null:?}");
    }
    assert!(null[7] * null[8] < 0.0);
    for (k, other) in [(7, 8), (8, 7)] {
        let found = fit.determination(k);
        assert_eq!(
            (found.verdict, found.partners, found.own_share),
            (Verdict::OnlyInCombination, vec![other], 0.0)
        );
        assert!(fit.deviation(k).is_none() && fit.interval(k, 0.95, 1.0).is_none());
        assert!(fit.sentence(k).contains("the data do not separate them"));
    }
    // Their sum is known as well as the offset alone was, and the others keep their intervals.
    let mut both = vec![0.0; 9];
    both[7] = 1.0;
    both[8] = 1.0;
    near(fit.deviation_along(&both).unwrap(), 0.0156225551, 1e-6);
    near(fit.deviation(6).unwrap(), 0.0171930824, 1e-6);
}

#[test]
fn check_7_5_pure_powers_of_viscosity() {
    let points = points();
    let list: Vec<Parameter> = (0..8)
        .map(|k| Parameter::new(NAMES[k], scale(k), OPTIMUM[k], BOUNDS[k]).unwrap())
        .collect();
    let fit = fit_of(list, |theta, i| {
        let at = &points[i];
        let (w, x, t) = (at.omega(), at.speed / 10000.0, at.torque / 10.0);
        let v = theta[0] * at.nu / 6.4;
        theta[1] * 0.0075 * at.torque * w * t.powf(theta[2]) * x.powf(-0.2) * v.powf(-0.1)
            + theta[3] * 14.0 * t.powf(1.55) * x
            + theta[4] * 12.0 * v.powf(2.0 / 3.0) * x.powf(5.0 / 3.0)
            + 20.0 * theta[5].powf(1.5) * v.powf(0.15) * x.powf(2.4)
            + theta[6] * w / (1.0 + 0.5 * x).sqrt()
            + theta[7] * w
    });
    assert!(fit.is_singular());
    // f_nu, f_mu, f_0 and h move together; the others keep their intervals.
    for k in 0..8 {
        assert_eq!(fit.deviation(k).is_none(), [0, 1, 4, 5].contains(&k), "{}", NAMES[k]);
    }
}

#[test]
fn parameters_that_nothing_depends_on_are_not_seen() {
    let points = points();
    let mut list = parameters(&OPTIMUM);
    list.push(Parameter::new("idle", Scale::Linear, 1.0, [0.0, 2.0]).unwrap());
    list.push(Parameter::new("held", Scale::Linear, 1.0, [1.0, 1.0]).unwrap());
    let fit = fit_of(list, |theta, i| model(theta, &points[i]));
    assert!(fit.is_singular() && fit.singular_values().len() == 8);
    assert_eq!(fit.determination(8).verdict, Verdict::NotSeen);
    assert_eq!(fit.determination(9).verdict, Verdict::Held);
    assert!(fit.deviation(8).is_none() && fit.deviation(9).is_none() && fit.to_profile(8, 0.95).is_none());
    assert!(
        fit.sentence(8)
            .contains("less effect than the accuracy of the instruments")
            && fit.sentence(9).contains("fixed at 1")
    );
    near(deviation(&fit, 1), 0.0560232651, 1e-7);
    let mut gradient = vec![0.0; 10];
    gradient[8] = 1.0;
    assert!(fit.deviation_along(&gradient).is_none());
}
