//! Checks of the residuals at the optimum of the made-up problem.

use gearloss_numerics::inference::{anderson_darling, band_means, succession};

use super::check_problem::{OPTIMUM, fit, parameters, points};

fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance, "{x} instead of {y}");
}

#[test]
fn check_7_4_residuals() {
    let fit = fit(parameters(&OPTIMUM));
    let r = fit.residuals();
    let count = r.len() as f64;
    let mean = r.iter().sum::<f64>() / count;
    let moment = |n: i32| r.iter().map(|r| (r - mean).powi(n)).sum::<f64>() / count;
    // Printed with four to six digits; residuals are known to ten.
    near(mean, 2.146e-4, 6e-8);
    near(moment(3) / moment(2).powf(1.5), -0.0408597, 1e-6);
    near(moment(4) / moment(2).powi(2) - 3.0, -0.462811, 1e-6);
    let normal = anderson_darling(r).unwrap();
    near(normal.statistic, 0.559741758, 1e-8);
    near(normal.corrected, 0.560702368, 1e-8);
    near(normal.probability, 0.147283, 6e-7);
}

#[test]
fn check_7_4_succession() {
    let fit = fit(parameters(&OPTIMUM));
    let lines: Vec<Vec<usize>> = (0..20).map(|k| (22 * k..22 * (k + 1)).collect()).collect();
    let found = succession(fit.residuals(), &lines).unwrap();
    near(found.durbin_watson, 2.04831132, 1e-8);
    near(found.correlation, -0.0717013424, 1e-8);
    assert_eq!(found.runs, 235);
    near(found.expected, 229.636364, 1e-6);
    near(found.score.unwrap(), 0.549518, 6e-7);
    assert!(found.words().is_none() && found.points == 440);
}

#[test]
fn check_7_4_leverage() {
    let fit = fit(parameters(&OPTIMUM));
    let greatest = |list: &[f64]| {
        (0..440)
            .max_by(|a, b| list[*a].abs().total_cmp(&list[*b].abs()))
            .unwrap()
    };
    let i = greatest(fit.leverage());
    assert_eq!(i + 1, 419);
    near(fit.leverage()[i], 0.136032615, 1e-8);
    // As many in all as there are parameters.
    near(fit.leverage().iter().sum(), 8.0, 1e-10);
    let standardised = fit.standardised();
    let i = greatest(&standardised);
    assert_eq!(i + 1, 423);
    near(standardised[i].abs(), 2.99956905, 1e-7);
    assert!(fit.outliers().is_empty() && fit.weighty().is_empty());
}

#[test]
fn means_over_torque_stay_within_their_limits_as_a_rule() {
    let fit = fit(parameters(&OPTIMUM));
    let torque: Vec<f64> = points().iter().map(|p| p.torque).collect();
    let bands = band_means(fit.residuals(), &torque).unwrap();
    assert_eq!(bands.iter().map(|b| b.count).sum::<usize>(), 440);
    // One of twenty lies outside if the model is right; more than two of eight have a probability below 1 %.
    assert!(bands.iter().filter(|b| b.mean.abs() > b.limit).count() <= 2);
}
