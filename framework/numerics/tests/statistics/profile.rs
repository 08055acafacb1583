//! Intervals by profile for the made-up problem.

use gearloss_numerics::inference::{Accuracy, Fit, Parameter, Reach, Refit, Side, Standing};

use super::check_problem::{AT_BOUND, OPTIMUM, fit, linearised, measured, minimise, parameters};

/// The best of the others when one parameter is held, among parameters with their bounds.
fn refit(list: &[Parameter], parameter: usize, value: f64, start: &[f64]) -> Refit {
    let mut at = list.to_vec();
    for (p, u) in at.iter_mut().zip(start) {
        p.u = *u;
    }
    at[parameter].u = value;
    let all: Vec<usize> = (0..440).collect();
    let (objective, u) = minimise(&all, &measured(), at, &[parameter]);
    Refit { objective, u }
}

#[test]
fn check_7_2_profiles() {
    let fit = fit(parameters(&OPTIMUM));
    let expected = [
        [0.83103527, 1.6527908],
        [1.0499074, 1.2570434],
        [0.1934547, 0.31147673],
        [0.70551224, 1.3609637],
        [0.65675193, 1.4250165],
        [0.6178903, 0.84008601],
        [0.0, 0.053601711],
        [-0.0062474922, 0.044854964],
    ];
    for (k, ends) in expected.into_iter().enumerate() {
        let found = fit
            .profile(k, 0.95, |p, v, u| Ok(refit(fit.parameters(), p, v, u)))
            .unwrap();
        // The upper half of dT is shortened by the bound of M_s, the others are nearly linear.
        assert_eq!(found.nonlinear, k == 7, "{k}");
        let unit = fit.deviation(k).unwrap();
        for (side, end) in ends.into_iter().enumerate() {
            let reach = if end == 0.0 { Reach::Bound } else { Reach::Limit };
            assert_eq!(found.ends[side].reach, reach);
            // In standard deviations: both searches end within 1e-6 of the limit of 1.96.
            let theta = found.theta[side];
            let scale = if fit.parameters()[k].theta() == fit.parameters()[k].u {
                1.0
            } else {
                end
            };
            assert!(
                (theta - end).abs() < 1e-5 * unit * scale,
                "{k}: {theta} instead of {end}"
            );
        }
    }
}

#[test]
fn check_7_5_one_sided_profile_of_an_active_bound() {
    let mut list = parameters(&AT_BOUND);
    list[5].bounds[1] = 0.7;
    list[5].standing = Standing::Active(Side::Upper);
    let all: Vec<usize> = (0..440).collect();
    let (r, jacobian) = linearised(&list, &all, &measured());
    let fit = Fit::new(list, &jacobian, &r, 0, Accuracy::Given).unwrap();
    let found = fit
        .profile(5, 0.95, |p, v, u| Ok(refit(fit.parameters(), p, v, u)))
        .unwrap();
    assert_eq!(
        (found.ends[1].reach, found.theta[1], found.ends[1].fits),
        (Reach::Bound, 0.7, 0)
    );
    assert_eq!(found.ends[0].reach, Reach::Limit);
    // One-sided 95 %: the sum of squares has risen by 2.705543, of which the search leaves 6e-6 open.
    let start: Vec<f64> = fit.parameters().iter().map(|p| p.u).collect();
    let there = refit(fit.parameters(), 5, found.ends[0].u, &start);
    assert!((there.objective - fit.objective() - 2.705543).abs() < 1e-5);
}
