//! Intervals by profile for the made-up problem.

use gearloss_framework::inference::{Reach, Refit};

use crate::check_problem::{OPTIMUM, fit, measured, minimise, parameters};

#[test]
fn check_7_2_profiles() {
    let fit = fit(parameters(&OPTIMUM));
    let (all, measured) = ((0..440).collect::<Vec<usize>>(), measured());
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
        let refit = |parameter: usize, value: f64, start: &[f64]| {
            let mut at = fit.parameters().to_vec();
            for (p, u) in at.iter_mut().zip(start) {
                p.u = *u;
            }
            at[parameter].u = value;
            let (objective, u) = minimise(&all, &measured, at, &[parameter]);
            Ok(Refit { objective, u })
        };
        let found = fit.profile(k, 0.95, refit).unwrap();
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
