//! Bounded least squares on a problem with the shape of a gearbox.

use gearloss_numerics::least_squares::{
    Differences, Known, Loss, Options, Parameter, Problem, Side, Status, Subproblem, multistart, solve,
};

use crate::loss_map::{
    AT_BOUND, DEVIATIONS, NAMES, OPTIMUM, Point, TRUTH, deviations, errors, loss, measured, near, omega, parameters,
    points, problem, problem_of, sigma,
};

#[test]
fn check_7_1_definition() {
    let (e, y) = (errors(1), measured(1));
    near(&e[..4], &[-1.1055668, -0.244727797, 0.175113429, 1.02267693], 1e-8);
    near(&[e[439]], &[-0.783267586], 1e-8);
    near(
        &[e.iter().sum::<f64>() / 440.0, e.iter().map(|e| e * e).sum()],
        &[-0.0378588396, 481.228298],
        1e-8,
    );
    near(
        &[y[0], y[219], y[220], y[439]],
        &[6.26363816, 720.482356, 6.04763707, 594.175206],
        1e-8,
    );
    near(&[y.iter().sum()], &[92375.0749707], 1e-11);
    let chi2 = |p: &[f64]| {
        problem(&y, parameters())
            .residual(p)
            .unwrap()
            .iter()
            .map(|r| r * r)
            .sum::<f64>()
    };
    let start: Vec<f64> = parameters().iter().map(|p| p.start).collect();
    near(&[chi2(&start), chi2(&TRUTH)], &[10929.0224, 481.228298], 1e-8);
}

#[test]
fn check_7_2_optimum() {
    let y = measured(1);
    let exact = solve(&problem(&y, parameters()), &Options::exact()).unwrap();
    assert!(exact.converged() && exact.active.iter().all(Option::is_none));
    near(&exact.theta, &OPTIMUM, 1e-6);
    near(&deviations(&exact), &DEVIATIONS, 1e-6);
    near(&[exact.chi2()], &[468.4034462], 1e-9);
    let fit = solve(&problem(&y, parameters()), &Options::fit()).unwrap();
    assert!(fit.converged());
    for j in 0..8 {
        assert!((fit.theta[j] - OPTIMUM[j]).abs() < 1e-3 * DEVIATIONS[j], "{}", NAMES[j]);
    }
}

#[test]
fn check_7_2_work() {
    let y = measured(1);
    let of = problem(&y, parameters());
    let fit = solve(&of, &Options::fit()).unwrap();
    assert!(
        fit.counts.evaluations <= 130 && fit.counts.steps <= 9,
        "{:?}",
        fit.counts
    );
    let exact = solve(&of, &Options::exact()).unwrap();
    assert!(exact.counts.evaluations <= 300, "{:?}", exact.counts);
    let mut forward = Options::fit();
    forward.differences = Differences::Forward;
    forward.forward.relative_offset = 1e-3;
    let fit = solve(&of, &forward).unwrap();
    // Derivatives at the end are central ones all the same.
    assert!(
        fit.converged() && fit.counts.evaluations <= 64 + 16 + 10,
        "{:?}",
        fit.counts
    );
    assert!((fit.chi2() - 468.4034462).abs() < 1e-4);
}

#[test]
fn check_7_2_dogleg_finds_the_same() {
    let y = measured(1);
    let options = Options {
        subproblem: Subproblem::Dogleg,
        ..Options::exact()
    };
    let fit = solve(&problem(&y, parameters()), &options).unwrap();
    near(&fit.theta, &OPTIMUM, 1e-6);
}

#[test]
fn check_7_5_active_bound() {
    let y = measured(1);
    let mut parameters = parameters();
    parameters[5].upper = 0.7;
    let fit = solve(&problem(&y, parameters), &Options::exact()).unwrap();
    assert!(fit.converged());
    // The start lies beyond the bound.
    assert!(fit.notes[0].contains("`h` starts at its bound 0.7"), "{:?}", fit.notes);
    near(&fit.theta, &AT_BOUND, 1e-6);
    near(&[fit.chi2()], &[468.5774166], 1e-9);
    assert_eq!(fit.theta[5], 0.7);
    assert_eq!(fit.active[5], Some(Side::Upper));
    near(&[fit.derivative.as_ref().unwrap().gradient[5]], &[-6.90232241], 1e-6);
    let expected = [
        0.22643889,
        0.0516099143,
        0.0299510276,
        0.163000635,
        0.210153988,
        0.00742585455,
        0.00692512491,
    ];
    near(&deviations(&fit), &expected, 1e-6);
}

#[test]
fn check_7_5_prior_is_generalised_least_squares() {
    let y = measured(1);
    let mut with_prior = parameters();
    with_prior[7] = with_prior[7].clone().prior(0.0, 0.010);
    let fit = solve(&problem(&y, with_prior), &Options::exact()).unwrap();
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
    near(&fit.theta, &theta, 1e-6);
    near(&[fit.chi2()], &[470.145676], 1e-8);
    assert_eq!((fit.rows, fit.residuals.len()), (440, 441));
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
    near(&deviations(&fit), &expected, 1e-6);

    // The same with the offset inside the covariance I + v v^T of the weighted residuals, whose inverse root is known.
    let points = points();
    let v: Vec<f64> = points.iter().map(|p| 0.010 * omega(p) / sigma(p)).collect();
    let square: f64 = v.iter().map(|v| v * v).sum();
    let factor = (1.0 - 1.0 / (1.0 + square).sqrt()) / square;
    let residual = |p: &[f64]| {
        let p = [p, &[0.0]].concat();
        let r: Vec<f64> = points
            .iter()
            .zip(&y)
            .map(|(at, y)| (loss(&p, at) - y) / sigma(at))
            .collect();
        let along: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
        Ok(r.iter().zip(&v).map(|(r, v)| r - factor * along * v).collect())
    };
    let generalised = solve(&Problem::new(residual, parameters()[..7].to_vec()), &Options::exact()).unwrap();
    near(&generalised.theta, &theta[..7], 1e-6);
    near(&deviations(&generalised), &expected[..7], 1e-6);
    near(&[generalised.chi2()], &[470.145676], 1e-8);
}

#[test]
fn check_7_5_a_constant_drag_torque_is_the_same_column_as_the_offset() {
    let y = measured(1);
    let mut nine = parameters();
    nine.push(Parameter::new("M_c", 0.0).within(-0.1, 0.1));
    let law = |p: &[f64], at: &Point| loss(p, at) + p[8] * omega(at);
    for options in [Options::fit(), Options::exact()] {
        let fit = solve(&problem_of(&y, nine.clone(), law), &options).unwrap();
        assert_eq!(fit.status, Status::Singular, "{:?}", fit.reason);
        let independence = fit.derivative.as_ref().unwrap().independence;
        assert!(independence < 1e-9, "{independence:e}");
        assert!((fit.chi2() - 468.4034462).abs() < 1e-4);
    }
}

#[test]
fn check_7_5_pure_powers_of_viscosity_are_singular() {
    let y = measured(1);
    let law = |p: &[f64], at: &Point| {
        let [nu, torque, speed] = *at;
        let (w, x, t, v) = (omega(at), speed / 10000.0, torque / 10.0, p[0] * nu / 6.4);
        p[1] * 0.0075 * torque * w * t.powf(p[2]) * x.powf(-0.2) * v.powf(-0.1)
            + p[3] * 14.0 * t.powf(1.55) * x
            + p[4] * 12.0 * v.powf(2.0 / 3.0) * x.powf(5.0 / 3.0)
            + 20.0 * p[5].powf(1.5) * v.powf(0.15) * x.powf(2.4)
            + p[6] * w / (1.0 + 0.5 * x).sqrt()
            + p[7] * w
    };
    let fit = solve(&problem_of(&y, parameters(), law), &Options::fit()).unwrap();
    assert_eq!(fit.status, Status::Singular, "{:?} {:?}", fit.reason, fit.active);
}

#[test]
fn check_7_5_outliers() {
    let mut y = measured(1);
    for (i, at) in points().iter().enumerate().skip(7).step_by(44) {
        y[i] += 10.0 * sigma(at);
    }
    let table = [
        (
            Loss::Linear,
            751.5057991,
            [
                1.069357, 1.083459, 0.26658, 1.220365, 1.203271, 0.5554501, 0.0, 0.04591442,
            ],
        ),
        (
            Loss::SoftL1,
            372.0228423,
            [
                1.201982, 1.140719, 0.2616393, 1.057859, 0.9857072, 0.6719541, 0.0103079, 0.03430422,
            ],
        ),
        (
            Loss::Huber,
            414.1644751,
            [
                1.208838, 1.143028, 0.260726, 1.055433, 0.9652641, 0.6854496, 0.01192517, 0.03270158,
            ],
        ),
        (
            Loss::Cauchy,
            245.5054805,
            [
                1.209899, 1.143619, 0.2572349, 1.059852, 0.9527303, 0.7240964, 0.02124263, 0.02367041,
            ],
        ),
        (
            Loss::Arctan,
            229.2517756,
            [
                1.206577, 1.140468, 0.2557272, 1.07895, 0.9382722, 0.7458582, 0.02562222, 0.01944411,
            ],
        ),
    ];
    for (loss, cost, theta) in table {
        let options = Options {
            loss,
            ..Options::exact()
        };
        let fit = solve(&problem(&y, parameters()), &options).unwrap();
        assert!(fit.converged(), "{loss:?} {:?}", fit.reason);
        near(&[fit.cost], &[cost], 1e-9);
        // As many digits as the reference was written down with.
        near(&fit.theta, &theta, 5e-6);
        assert_eq!(fit.active[6], (loss == Loss::Linear).then_some(Side::Lower));
    }
}

#[test]
fn check_2_7_one_minimum_from_32_starts() {
    let y = measured(1);
    let found = multistart(&problem(&y, parameters()), &Options::fit(), 32).unwrap();
    let [only] = &found.minima[..] else {
        panic!("{} minima", found.minima.len())
    };
    assert_eq!((only.starts.len(), only.share, found.kinship), (32, 1.0, None));
    assert!((only.fit.chi2() - 468.4034462).abs() < 1e-7 * 468.0);
    assert!(found.notes.is_empty());
    assert!(found.evaluations < 5300, "{}", found.evaluations);
}

#[test]
fn a_robust_loss_finds_its_scale_where_residuals_have_no_weights() {
    let mut y = measured(1);
    for i in (7..440).step_by(44) {
        y[i] += 10.0 * sigma(&points()[i]);
    }
    // Residuals in thousandths of their uncertainty: the spread must come out as a thousand.
    let points = points();
    let residual = |p: &[f64]| {
        Ok(points
            .iter()
            .zip(&y)
            .map(|(at, y)| (loss(p, at) - y) / sigma(at) * 1e3)
            .collect())
    };
    let options = Options {
        loss: Loss::Huber,
        estimate_spread: true,
        ..Options::exact()
    };
    let fit = solve(&Problem::new(residual, parameters()), &options).unwrap();
    assert!(
        fit.converged() && (1.8e3..2.4e3).contains(&fit.loss_scale),
        "{}",
        fit.loss_scale
    );
    assert!((fit.theta[1] - 1.143).abs() < 0.01);
}

/// With one parameter moved by its standard error, the others follow: derivatives at the optimum serve as those near it.
#[test]
fn known_derivatives_save_calls_and_find_the_same_minimum() {
    let y = measured(1);
    let best = solve(&problem(&y, parameters()), &Options::fit()).unwrap();
    let jacobian = &best.derivative.as_ref().unwrap().jacobian;
    for (k, share) in [(0, 1.02), (1, 0.97), (3, 1.05)] {
        let mut moved = parameters();
        for (parameter, theta) in moved.iter_mut().zip(&best.theta) {
            parameter.start = *theta;
        }
        let held = share * best.theta[k];
        moved[k] = moved[k].clone().within(held, held);
        let with = |known: Option<Known<'_>>| {
            let options = Options {
                known,
                ..Options::fit()
            };
            solve(&problem(&y, moved.clone()), &options).unwrap()
        };
        let alone = with(None);
        for sufficient in [true, false] {
            let fit = with(Some(Known { jacobian, sufficient }));
            assert!(fit.converged() && fit.derivative.is_some(), "{:?}", fit.reason);
            // Twice the cost in squares of a standard error.
            assert!((fit.cost - alone.cost).abs() < 1e-3, "{} {}", fit.cost, alone.cost);
            // Differences that confirm the end are half of the calls that are left.
            let most = alone.counts.evaluations / if sufficient { 2 } else { 1 };
            let calls = fit.counts.evaluations;
            assert!(calls < most, "{sufficient} {calls} {most}");
        }
    }
}

#[test]
fn known_derivatives_of_another_problem_are_refused() {
    let y = measured(1);
    let jacobian = &nalgebra::DMatrix::zeros(3, 8);
    let options = Options {
        known: Some(Known {
            jacobian,
            sufficient: true,
        }),
        ..Options::fit()
    };
    let fault = solve(&problem(&y, parameters()), &options).unwrap_err().to_string();
    assert!(fault.contains("3 rows and 8 columns for 440 rows"), "{fault}");
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let y = measured(1);
    let of = problem(&y, parameters());
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (solve(&of, &Options::exact()), multistart(&of, &Options::fit(), 6)))
    };
    let one = on(1);
    assert_eq!(one, on(1));
    assert_eq!(one, on(3));
    assert_eq!(one, on(8));
}
