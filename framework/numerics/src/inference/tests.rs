//! Fits with estimated accuracies, replicates and too little data.

use nalgebra::DMatrix;

use super::{Accuracy, Fit, Parameter, Scale, Side, Standing, Verdict, pure_error};

fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance * y.abs(), "{x} instead of {y}");
}

fn parameter(name: &str, value: f64) -> Parameter {
    Parameter::new(name, Scale::Linear, value, [f64::NEG_INFINITY, f64::INFINITY]).unwrap()
}

/// A straight line a + b x through points, already at its optimum.
fn line(points: &[[f64; 2]], accuracy: Accuracy) -> Fit {
    let count = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let b = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    let a = y - b * x;
    let jacobian = DMatrix::from_fn(points.len(), 2, |i, k| if k == 0 { 1.0 } else { points[i][0] });
    let residuals: Vec<f64> = points.iter().map(|p| a + b * p[0] - p[1]).collect();
    Fit::new(
        vec![parameter("a", a), parameter("b", b)],
        &jacobian,
        &residuals,
        0,
        accuracy,
    )
    .unwrap()
}

/// Standard deviations that the National Institute of Standards and Technology certifies for its problem Misra1a.
#[test]
fn certified_standard_deviations() {
    let x = [
        77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0,
    ];
    let y = [
        10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78,
    ];
    let [b1, b2]: [f64; 2] = [238.942_129_18, 5.501_564_318_1e-4];
    let residuals: Vec<f64> = x.iter().zip(y).map(|(x, y)| b1 * (1.0 - (-b2 * x).exp()) - y).collect();
    let jacobian = DMatrix::from_fn(14, 2, |i, k| {
        let left = (-b2 * x[i]).exp();
        if k == 0 { 1.0 - left } else { b1 * x[i] * left }
    });
    let parameters = vec![parameter("b1", b1), parameter("b2", b2)];
    let fit = Fit::new(parameters, &jacobian, &residuals, 0, Accuracy::Estimated).unwrap();
    // Certified to eleven digits; the parameters are given with as many, which leaves eight of the residuals.
    near(fit.objective(), 0.124_551_388_94, 1e-8);
    near(fit.variance().sqrt(), 0.101_878_763_30, 1e-8);
    near(fit.deviation(0).unwrap(), 2.707_007_524_1, 1e-8);
    near(fit.deviation(1).unwrap(), 7.266_868_843_6e-6, 1e-8);
    // Student's t of 12 degrees of freedom.
    near(fit.quantile(0.95).unwrap(), 2.178_812_829_667_2, 1e-12);
    assert!(fit.lack_of_fit().is_none());
    // Two of F(2, 12) = 3.885294: the variance times that.
    near(
        fit.joint_limit(0.95).unwrap(),
        2.0 * 3.885_293_834_652_4 * fit.variance(),
        1e-10,
    );
}

#[test]
fn a_line_has_its_textbook_deviations() {
    let points = [[0.0, 1.0], [1.0, 2.5], [2.0, 4.5], [3.0, 7.5]];
    let fit = line(&points, Accuracy::Given);
    // Sum of (x - mean)^2 = 5: 1/sqrt(5) for the slope; sqrt(1/4 + 1.5^2/5) for the value at zero.
    near(fit.deviation(1).unwrap(), 0.2_f64.sqrt(), 1e-14);
    near(fit.deviation(0).unwrap(), 0.7_f64.sqrt(), 1e-14);
    near(fit.covariance(0, 1), -0.3, 1e-14);
    near(fit.leverage()[0], 0.7, 1e-14);
    // At x = 1.5 the two do not correlate.
    near(fit.deviation_along(&[1.0, 1.5]).unwrap(), 0.5, 1e-14);
    assert!(fit.deviation_along(&[1.0]).is_none());
}

#[test]
fn lack_of_fit_is_described_in_words() {
    let wild = line(&[[0.0, 0.0], [1.0, 9.0], [2.0, -9.0], [3.0, 0.0]], Accuracy::Given)
        .lack_of_fit()
        .unwrap();
    assert!(wild.words().unwrap().contains("does not reproduce") && wild.widening().unwrap() > 1.0);
    let tame = line(&[[0.0, 0.0], [1.0, 0.02], [2.0, 0.0], [3.0, 0.01]], Accuracy::Given)
        .lack_of_fit()
        .unwrap();
    assert!(tame.words().unwrap().contains("pessimistic") && tame.widening().is_none());
}

#[test]
fn replicates_split_what_is_left_over() {
    // Two points at each of three places; a parabola is fitted by a line.
    let points = [[0.0, 0.1], [0.0, -0.1], [1.0, 1.1], [1.0, 0.9], [2.0, 4.1], [2.0, 3.9]];
    let fit = line(&points, Accuracy::Given);
    let split = pure_error(&fit, &[vec![0, 1], vec![2, 3], vec![4, 5]]).unwrap();
    // 6 deviations of 0.1 each; a line leaves 1/3, -2/3, 1/3 of a parabola, twice: 4/3.
    near(split.pure[0], 0.06, 1e-12);
    near(split.lack[0], 4.0 / 3.0, 1e-12);
    assert_eq!([split.pure[1], split.lack[1]], [3.0, 1.0]);
    near(split.ratio, (4.0 / 3.0) / 0.02, 1e-12);
    assert!(split.probability < 0.01);
    assert_eq!(pure_error(&fit, &[]), None);
    assert_eq!(pure_error(&fit, &[vec![0, 9]]), None);
}

#[test]
fn too_few_points_resolve_no_more_directions_than_they_are() {
    let jacobian = DMatrix::from_row_slice(1, 2, &[100.0, 100.0]);
    let two = vec![parameter("a", 1.0), parameter("b", 1.0)];
    let fit = Fit::new(two.clone(), &jacobian, &[0.0], 0, Accuracy::Given).unwrap();
    assert!(fit.is_singular() && fit.condition().is_none_or(|c| c > 1e12) && fit.lack_of_fit().is_none());
    assert!(fit.deviation(0).is_none() && fit.determination(0).partners == [1]);
    // Their sum is the total of the point.
    near(fit.deviation_along(&[1.0, 1.0]).unwrap(), 0.01, 1e-12);
    assert!(
        Fit::new(two, &jacobian, &[0.0], 0, Accuracy::Estimated)
            .unwrap_err()
            .contains("1 points for 2")
    );
}

#[test]
fn held_parameters_leave_nothing_to_say() {
    let mut a = parameter("a", 1.0);
    a.standing = Standing::Fixed;
    let fit = Fit::new(
        vec![a],
        &DMatrix::from_element(3, 1, 1.0),
        &[1.0; 3],
        0,
        Accuracy::Given,
    )
    .unwrap();
    assert!(!fit.is_singular() && fit.condition().is_none() && fit.ranged_singular_values().is_empty());
    assert_eq!(fit.determination(0).verdict, Verdict::Held);
    assert_eq!(
        (fit.freedom(), fit.leverage(), fit.rise(&[5.0])),
        (3.0, &[0.0; 3][..], 0.0)
    );
    assert_eq!(fit.draws(2, 0.95).unwrap(), [[1.0], [1.0]]);
}

#[test]
fn a_bound_that_holds_a_parameter_says_so() {
    let mut a = Parameter::new("a", Scale::Log, 2.0, [2.0, 9.0]).unwrap();
    a.update_state(1.0);
    assert_eq!(a.standing, Standing::Active(Side::Lower));
    let fit = Fit::new(
        vec![a],
        &DMatrix::from_element(3, 1, 1.0),
        &[1.0; 3],
        0,
        Accuracy::Given,
    )
    .unwrap();
    assert!(fit.sentence(0).contains("lower bound 2.000") && fit.sentence(0).contains("prefer less"));
    assert_eq!(fit.gradient(0), 3.0);
}

#[test]
fn what_is_no_fit_is_refused() {
    let one = || vec![parameter("a", 1.0)];
    let column = |x: f64| DMatrix::from_element(2, 1, x);
    assert!(Fit::new(one(), &column(f64::NAN), &[0.0; 2], 0, Accuracy::Given).is_err());
    assert!(Fit::new(one(), &column(1e200), &[0.0; 2], 0, Accuracy::Given).is_err());
    assert!(Fit::new(one(), &column(1.0), &[f64::INFINITY, 0.0], 0, Accuracy::Given).is_err());
    assert!(
        Fit::new(one(), &column(1.0), &[0.0; 3], 0, Accuracy::Given)
            .unwrap_err()
            .contains("3 residuals")
    );
    assert!(Fit::new(one(), &column(1.0), &[0.0; 2], 3, Accuracy::Given).is_err());
    assert!(Fit::new(Vec::new(), &column(1.0), &[0.0; 2], 0, Accuracy::Given).is_err());
}

#[test]
fn an_exact_fit_has_no_scatter_and_no_nonsense() {
    let fit = line(&[[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]], Accuracy::Estimated);
    assert_eq!(fit.variance(), 0.0);
    assert_eq!(fit.deviation(0), Some(0.0));
    assert_eq!((fit.correlation(0, 1), fit.combination(0, 1)), (None, None));
    assert_eq!(fit.determination(0).verdict, Verdict::WellDetermined);
    assert!(fit.standardised().iter().all(|r| *r == 0.0));
    assert!(fit.ranged_singular_values().iter().all(|s| s.is_finite()));
    assert!(fit.sentence(0).contains("95 %"), "{}", fit.sentence(0));
}
