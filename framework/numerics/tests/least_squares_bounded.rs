//! Bounded least squares on classic problems.

use crate::classics::{INF, Residual, beale, broyden, helix, parameters, powell, problem, rosenbrock, ways, wood};
use gearloss_numerics::least_squares::{Fit, Noise, Options, Parameter, Problem, Side, halton, solve};

/// No point of the box near a fit is better, by how much ever.
fn least_nearby(residual: Residual, fit: &Fit, lower: &[f64], upper: &[f64]) {
    let cost = |x: &[f64]| 0.5 * residual(x).iter().map(|r| r * r).sum::<f64>();
    let n = fit.theta.len();
    for size in [1e-1, 1e-2, 1e-3, 1e-4] {
        for i in 1..200 {
            let there: Vec<f64> = (0..n)
                .map(|j| fit.theta[j] + size * (2.0 * halton(i, n)[j] - 1.0))
                .zip(lower.iter().zip(upper))
                .map(|(x, (l, h))| x.clamp(*l, *h))
                .collect();
            assert!(
                cost(&there) >= fit.cost * (1.0 - 1e-12),
                "{there:?} is better than {:?}",
                fit.theta
            );
        }
    }
}

#[test]
fn check_2_4_rosenbrock_in_boxes() {
    // Problems 1 to 4 of Hock and Schittkowski, "Test Examples for Nonlinear Programming Codes" (1981), and boxes about
    // the bent valley from several starts, as in the tests of SciPy.
    let far = 1.2243707487363527;
    let cases: [([f64; 2], [f64; 2], [f64; 2], &[[f64; 2]]); 9] = [
        ([-2.0, 1.0], [-INF, -INF], [INF, INF], &[[1.0, 1.0]]),
        ([-2.0, 1.0], [-INF, -1.5], [INF, INF], &[[1.0, 1.0]]),
        ([2.0, 2.0], [-INF, 1.5], [INF, INF], &[[far, 1.5]]),
        (
            [-2.0, 2.0],
            [-INF, 1.5],
            [INF, INF],
            &[[far, 1.5], [-1.2210262421071016, 1.5]],
        ),
        (
            [0.0, 2.0],
            [-INF, 1.5],
            [1.0, INF],
            &[[1.0, 1.5], [-1.2210262421071016, 1.5]],
        ),
        ([2.0, 2.0], [1.0, 1.5], [3.0, 3.0], &[[far, 1.5]]),
        ([-1.2, 1.0], [-50.0, 0.0], [0.5, 100.0], &[[0.5, 0.25]]),
        ([-1.2, 1.0], [-INF, -INF], [INF, 0.3], &[[0.551423110961498, 0.3]]),
        ([-1.2, 1.0], [-1.5, -1.5], [-0.5, 2.0], &[[-0.5, 0.25]]),
    ];
    for (start, lower, upper, ends) in cases {
        for options in ways() {
            let fit = solve(&problem(rosenbrock, &start, &lower, &upper), &options).unwrap();
            assert!(fit.converged(), "{lower:?} {:?}", fit.reason);
            let met = |end: &&[f64; 2]| (0..2).all(|j| (fit.theta[j] - end[j]).abs() < 1e-7);
            assert!(ends.iter().any(|end| met(&end)), "{lower:?} {upper:?} {:?}", fit.theta);
            least_nearby(rosenbrock, &fit, &lower, &upper);
        }
    }
}

#[test]
fn check_2_4_classics_in_boxes_that_bind() {
    // Problems of Moré, Garbow and Hillstrom, "Testing Unconstrained Optimization Software" (1981), in boxes that leave out
    // their solutions. Which bounds bind follows from the gradient, and no neighbour is better.
    let cases: [(Residual, &[f64], &[f64], &[f64], &[Option<Side>]); 5] = [
        (
            powell,
            &[3.0, -1.0, 0.0, 1.0],
            &[0.1, -20.0, -1.0, -1.0],
            &[100.0, 20.0, 1.0, 50.0],
            &[Some(Side::Lower), None, None, None],
        ),
        (
            wood,
            &[-3.0, -1.0, -3.0, -1.0],
            &[-100.0, -100.0, -100.0, -100.0],
            &[0.0, 10.0, 100.0, 100.0],
            &[Some(Side::Upper), None, None, None],
        ),
        (beale, &[1.0, 1.0], &[0.6, 0.5], &[10.0, 100.0], &[None, None]),
        (
            beale,
            &[1.0, 0.4],
            &[0.6, -5.0],
            &[2.0, 0.45],
            &[Some(Side::Upper), None],
        ),
        (
            helix,
            &[-1.0, 0.0, 0.0],
            &[-100.0, -1.0, -1.0],
            &[0.8, 1.0, 1.0],
            &[Some(Side::Upper), None, None],
        ),
    ];
    for (residual, start, lower, upper, active) in cases {
        let fits = ways().map(|options| solve(&problem(residual, start, lower, upper), &options).unwrap());
        for fit in &fits {
            assert!(fit.converged(), "{:?} {:?}", fit.reason, fit.theta);
            assert_eq!(fit.active, active, "{:?}", fit.theta);
            for (j, side) in active.iter().enumerate() {
                let gradient = fit.derivative.as_ref().unwrap().gradient[j];
                match side {
                    None => assert!(gradient.abs() < 1e-5, "{gradient:e}"),
                    Some(Side::Lower) => assert!(gradient > 1e-3 && fit.theta[j] == lower[j]),
                    Some(Side::Upper) => assert!(gradient < -1e-3 && fit.theta[j] == upper[j]),
                }
            }
            least_nearby(residual, fit, lower, upper);
        }
        assert!((fits[0].cost - fits[1].cost).abs() <= 1e-8 * fits[0].cost.max(1e-9));
    }
}

#[test]
fn check_2_4_broyden_tridiagonal_with_a_hundred_parameters() {
    let n = 100;
    let even = |from: f64, to: f64| {
        (0..n)
            .map(|i| from + (to - from) * f64::from(i) / 99.0)
            .collect::<Vec<f64>>()
    };
    for options in ways() {
        let free = solve(&problem(broyden, &[-1.0; 100], &[-INF; 100], &[INF; 100]), &options).unwrap();
        assert!(free.converged() && free.cost < 1e-20, "{:e}", free.cost);
        // Most values at the solution, near -0.7071, are shut out.
        let (lower, upper) = (even(-2.0, -1.5), even(-0.8, 0.0));
        let boxed = solve(&problem(broyden, &[-1.0; 100], &lower, &upper), &options).unwrap();
        assert!(boxed.converged(), "{:?}", boxed.reason);
        assert!(boxed.active.contains(&Some(Side::Upper)) && boxed.active.contains(&None));
        for (side, gradient) in boxed.active.iter().zip(&boxed.derivative.as_ref().unwrap().gradient) {
            assert!(
                *side != Some(Side::Lower) && (*side == Some(Side::Upper) || gradient.abs() < 1e-6),
                "{gradient:e}"
            );
        }
    }
}

#[test]
fn check_2_5_noise_is_found_and_respected() {
    // Rounded to seven digits, as of an iteration inside.
    let rough = |x: f64| (x * 1e7).round() / 1e7;
    let times: Vec<f64> = (1..40).map(|i| 0.1 * f64::from(i)).collect();
    let law = |x: &[f64], t: f64| x[0] * (-x[1] * t).exp() + x[2];
    let y: Vec<f64> = times
        .iter()
        .map(|t| law(&[2.0, 1.3, 0.4], *t) + 0.01 * (17.0 * t).sin())
        .collect();
    let residual = |x: &[f64]| {
        Ok(times
            .iter()
            .zip(&y)
            .map(|(t, y)| rough(law(x, *t) - y) / 0.01)
            .collect())
    };
    let exact = |x: &[f64]| Ok(times.iter().zip(&y).map(|(t, y)| (law(x, *t) - y) / 0.01).collect());
    let start = || parameters(&[1.0, 1.0, 0.0], &[0.0, 0.1, -1.0], &[10.0, 10.0, 1.0]);
    let best = solve(&Problem::new(exact, start()), &Options::exact()).unwrap();
    for noise in [Noise::Estimated, Noise::Known(1e-7)] {
        let options = Options {
            noise,
            ..Options::fit()
        };
        let fit = solve(&Problem::new(residual, start()), &options).unwrap();
        assert!(fit.converged(), "{:?}", fit.reason);
        for j in 0..3 {
            assert!(
                (fit.theta[j] - best.theta[j]).abs() < 1e-3,
                "{:?} {:?}",
                fit.theta,
                best.theta
            );
        }
    }
    let options = Options {
        noise: Noise::Known(1e-5),
        ..Options::fit()
    };
    let fit = solve(&Problem::new(residual, start()), &options).unwrap();
    assert!(fit.notes.iter().any(|n| n.contains("noisy")) && fit.log.iter().all(|step| !step.central));
}

#[test]
fn check_2_5_no_call_leaves_the_bounds() {
    let (lower, upper) = ([-1.5, 0.0], [0.5, 0.2500001]);
    let residual = |x: &[f64]| {
        assert!((0..2).all(|j| lower[j] <= x[j] && x[j] <= upper[j]), "{x:?}");
        Ok(rosenbrock(x))
    };
    for options in ways() {
        for start in [[-1.5, 0.0], [0.5, 0.2500001], [-1.2, 0.1]] {
            let fit = solve(&Problem::new(residual, parameters(&start, &lower, &upper)), &options).unwrap();
            assert!(fit.converged() && (fit.theta[0] - 0.5).abs() < 1e-12, "{:?}", fit.theta);
        }
    }
    // A box of a few roundings, and one of a single point.
    let fit = solve(
        &problem(rosenbrock, &[0.0, 0.0], &[0.0, 0.0], &[1e-300, 1e-12]),
        &Options::exact(),
    )
    .unwrap();
    assert!(fit.theta.iter().all(|x| x.is_finite()));
    let fit = solve(
        &problem(rosenbrock, &[0.0, 0.0], &[0.0; 2], &[0.0; 2]),
        &Options::exact(),
    )
    .unwrap();
    assert!(fit.converged() && fit.cost == 0.5 && fit.fixed == [true, true]);
}

#[test]
fn a_logarithmic_parameter_needs_no_bounds() {
    let y: Vec<f64> = (1..6).map(|i| 1e-6 * f64::from(i).powf(1.5)).collect();
    let residual = |p: &[f64]| {
        Ok((1..6)
            .zip(&y)
            .map(|(i, y)| (p[0] * f64::from(i).powf(p[1]) - y) / 1e-8)
            .collect())
    };
    let parameters = vec![Parameter::new("factor", 1.0).log(), Parameter::new("power", 0.1)];
    let fit = solve(&Problem::new(residual, parameters), &Options::exact()).unwrap();
    assert!(fit.converged(), "{:?}", fit.reason);
    assert!((fit.theta[0] / 1e-6 - 1.0).abs() < 1e-9 && (fit.theta[1] - 1.5).abs() < 1e-9);
    assert_eq!(fit.u[0], fit.theta[0].ln());
}
