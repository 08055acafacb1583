//! Bounded least squares on classic problems, and what becomes of problems that make no sense.
#![allow(clippy::unwrap_used)]

use std::sync::atomic::{AtomicUsize, Ordering};

use gearloss_framework::least_squares::{
    Fit, Kinship, Noise, Options, Parameter, Problem, Reason, Side, Status, Subproblem, halton, multistart, solve,
};

const INF: f64 = f64::INFINITY;

type Residual = fn(&[f64]) -> Vec<f64>;

fn parameters(start: &[f64], lower: &[f64], upper: &[f64]) -> Vec<Parameter> {
    let each = start.iter().zip(lower).zip(upper).enumerate();
    each.map(|(i, ((x, l), h))| Parameter::new(format!("x{}", i + 1), *x).within(*l, *h))
        .collect()
}

fn problem<'a>(residual: Residual, start: &[f64], lower: &[f64], upper: &[f64]) -> Problem<'a> {
    Problem::new(move |x: &[f64]| Ok(residual(x)), parameters(start, lower, upper))
}

fn rosenbrock(x: &[f64]) -> Vec<f64> {
    vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
}

fn powell(x: &[f64]) -> Vec<f64> {
    vec![
        x[0] + 10.0 * x[1],
        5.0_f64.sqrt() * (x[2] - x[3]),
        (x[1] - 2.0 * x[2]).powi(2),
        10.0_f64.sqrt() * (x[0] - x[3]).powi(2),
    ]
}

fn wood(x: &[f64]) -> Vec<f64> {
    vec![
        10.0 * (x[1] - x[0] * x[0]),
        1.0 - x[0],
        90.0_f64.sqrt() * (x[3] - x[2] * x[2]),
        1.0 - x[2],
        10.0_f64.sqrt() * (x[1] + x[3] - 2.0),
        (x[1] - x[3]) / 10.0_f64.sqrt(),
    ]
}

fn beale(x: &[f64]) -> Vec<f64> {
    [1.5, 2.25, 2.625]
        .iter()
        .zip(1..)
        .map(|(y, i)| y - x[0] * (1.0 - x[1].powi(i)))
        .collect()
}

fn helix(x: &[f64]) -> Vec<f64> {
    let turn = x[1].atan2(x[0]) / (2.0 * std::f64::consts::PI);
    vec![10.0 * (x[2] - 10.0 * turn), 10.0 * (x[0].hypot(x[1]) - 1.0), x[2]]
}

fn broyden(x: &[f64]) -> Vec<f64> {
    let at = |i: usize| if i < x.len() { x[i] } else { 0.0 };
    (0..x.len())
        .map(|i| (3.0 - x[i]) * x[i] + 1.0 - at(i.wrapping_sub(1)) - 2.0 * at(i + 1))
        .collect()
}

fn himmelblau(x: &[f64]) -> Vec<f64> {
    vec![x[0] * x[0] + x[1] - 11.0, x[0] + x[1] * x[1] - 7.0]
}

/// Both ways to find steps, to as many digits as there are.
fn ways() -> [Options<'static>; 2] {
    [Subproblem::Cone, Subproblem::Dogleg].map(|subproblem| Options {
        subproblem,
        ..Options::exact()
    })
}

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
fn check_2_7_a_valley_is_told_from_equivalent_minima() {
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
fn check_2_7_a_start_in_a_poorer_minimum_is_told() {
    // A parabola with a wave on it: many minima, the lowest at zero.
    let law = |x: &[f64]| vec![0.3 * x[0], 2.0 * (2.0 * x[0]).sin(), 2.0 * ((2.0 * x[0]).cos() - 1.0)];
    let of = problem(law, &[6.0], &[-8.0], &[8.0]);
    let found = multistart(&of, &Options::exact(), 16).unwrap();
    assert!(found.minima[0].fit.theta[0].abs() < 1e-6 && found.minima.len() > 2);
    assert!(found.notes[0].contains("does not lead to the lowest"));
}

fn fault(of: &Problem<'_>) -> String {
    solve(of, &Options::fit()).unwrap_err().to_string()
}

#[test]
fn check_2_9_what_makes_no_sense_is_told_at_once() {
    let mut three = parameters(&[1.0, -1.0, f64::NAN], &[2.0, 0.0, -INF], &[0.0, 5.0, INF]);
    three[1] = three[1].clone().log().prior(-1.0, 0.0);
    let text = fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), three));
    for part in [
        "parameter `x1`: its lower bound 2 lies above its upper bound 0; exchange them",
        "parameter `x2`: its lower bound 0 has no logarithm",
        "parameter `x2`: its start -1 has no logarithm",
        "parameter `x2`: the deviation 0 of its prior is not above zero",
        "parameter `x2`: the mean -1 of its prior has no value",
        "parameter `x3`: its start is NaN; give a number",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let twice = vec![Parameter::new("a", 1.0), Parameter::new("a", 1.0)];
    assert!(fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), twice)).contains("taken twice"));
    assert!(fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), Vec::new())).contains("there are none"));
    let options = Options {
        loss_scale: 0.0,
        ..Options::fit()
    };
    let text = solve(&problem(rosenbrock, &[1.0, 2.0], &[-INF; 2], &[INF; 2]), &options).unwrap_err();
    assert!(text.to_string().contains("option loss_scale: 0 is not above zero"));
}

#[test]
fn check_2_9_fewer_rows_than_free_parameters() {
    let one: Residual = |x| vec![10.0 * (x[1] - x[0] * x[0])];
    let text = fault(&problem(one, &[-2.0, 1.0], &[-INF; 2], &[INF; 2]));
    assert!(
        text.contains("1 rows, priors counted, for 2 free parameters; fix parameters, or give some of them a prior")
    );
    // Either of which mends it.
    let mut mended = parameters(&[-2.0, 1.0], &[-INF, -INF], &[INF, INF]);
    mended[0] = mended[0].clone().prior(0.5, 0.1);
    let fit = solve(&Problem::new(move |x: &[f64]| Ok(one(x)), mended), &Options::exact()).unwrap();
    assert!(fit.converged() && (fit.theta[0] - 0.5).abs() < 1e-8 && (fit.theta[1] - 0.25).abs() < 1e-8);
    let fit = solve(
        &problem(one, &[-2.0, 1.0], &[-2.0, -INF], &[-2.0, INF]),
        &Options::exact(),
    )
    .unwrap();
    assert!(fit.converged() && fit.fixed == [true, false] && (fit.theta[1] - 4.0).abs() < 1e-9);
    assert!(fit.notes[0].contains("`x1` is fixed at -2"));
    let derivative = fit.derivative.unwrap();
    assert_eq!((derivative.jacobian[(0, 0)], derivative.gradient.len()), (0.0, 2));
}

#[test]
fn check_2_9_residuals_without_value() {
    let refused = Problem::new(|_: &[f64]| Err("no oil".to_owned()), vec![Parameter::new("a", 1.0)]);
    assert!(fault(&refused).contains("residuals at the start: no oil"));
    let infinite = Problem::new(|x: &[f64]| Ok(vec![x[0], x[0].ln()]), vec![Parameter::new("a", 0.0)]);
    assert!(fault(&infinite).contains("residual 2 of 2 is -inf"));
    // Beside the start there are none: named with the parameter, never a success.
    let lone = |x: &[f64]| {
        if x[0] == 1.0 {
            Ok(vec![1.0, 2.0])
        } else {
            Err("off the rails".to_owned())
        }
    };
    let fit = solve(&Problem::new(lone, vec![Parameter::new("a", 1.0)]), &Options::fit()).unwrap();
    assert_eq!((fit.status, fit.reason), (Status::Failed, Reason::DerivativeNotFinite));
    assert!(
        fit.notes.iter().any(|n| n.contains("beside `a` = 1: off the rails")),
        "{:?}",
        fit.notes
    );
    assert!(fit.notes.iter().any(|n| n.contains("had no value")));
    // On the way they only turn steps back. The least lies at the edge of where there are values.
    let edge = |x: &[f64]| {
        if x[0] < 1.0 {
            Err("too small".to_owned())
        } else {
            Ok(vec![x[0] * x[0], 0.1])
        }
    };
    let fit = solve(&Problem::new(edge, vec![Parameter::new("a", 3.0)]), &Options::exact()).unwrap();
    assert!(
        (1.0..1.1).contains(&fit.theta[0]) && !fit.converged(),
        "{:?} {:?}",
        fit.theta,
        fit.reason
    );
    // A function that changes its mind about how many rows there are.
    let calls = AtomicUsize::new(0);
    let fickle = |x: &[f64]| Ok(vec![x[0]; 2 + calls.fetch_add(1, Ordering::Relaxed)]);
    let fit = solve(&Problem::new(fickle, vec![Parameter::new("a", 1.0)]), &Options::fit()).unwrap();
    assert!(!fit.converged() && fit.notes.iter().any(|n| n.contains("residuals where there were 2")));
}

#[test]
fn check_2_9_a_parameter_that_is_not_seen() {
    let law: Residual = |x| vec![x[0] - 1.0, 0.5 * x[0] - 1.0, 0.1];
    let fit = solve(&problem(law, &[3.0, 7.0], &[-INF; 2], &[INF; 2]), &Options::fit()).unwrap();
    assert!(fit.converged() && (fit.theta[0] - 1.2).abs() < 1e-9 && fit.theta[1] == 7.0);
    assert_eq!(fit.derivative.unwrap().unseen, [false, true]);
    assert!(fit.notes.iter().any(|n| n.contains("`x2` is not seen")));
    // Unseen at the start only: it joins.
    let law: Residual = |x| vec![x[0] - 3.0, (x[0] - 1.0).max(0.0) * (x[1] - 2.0), 0.1];
    let fit = solve(&problem(law, &[0.0, 7.0], &[-INF; 2], &[INF; 2]), &Options::fit()).unwrap();
    assert!(fit.converged() && (fit.theta[1] - 2.0).abs() < 1e-6, "{:?}", fit.theta);
}

#[test]
fn check_2_9_a_parameter_that_is_lost_on_the_way_is_no_success() {
    // The first step goes where the exponential is zero to the last bit.
    let data: Vec<(f64, f64)> = [2.0, 4.0, 6.0, 10.0].iter().map(|x| (*x, 5.0 - 0.01 * x)).collect();
    let residual = |p: &[f64]| Ok(data.iter().map(|(x, y)| p[0] + (-p[1] * x).exp() - y).collect());
    let lost = vec![Parameter::new("level", 1.0), Parameter::new("decay", 500.0)];
    let fit = solve(&Problem::new(residual, lost), &Options::exact()).unwrap();
    // Never seen from here: it is said, and the rest is solved.
    assert_eq!(fit.derivative.as_ref().unwrap().unseen, [false, true]);
    let seen = vec![
        Parameter::new("level", 1.0),
        Parameter::new("decay", 2.0).typical(100.0),
    ];
    let fit = solve(&Problem::new(residual, seen), &Options::exact()).unwrap();
    assert!(
        fit.status == Status::Singular || fit.theta[1] < 20.0,
        "{:?} {:?}",
        fit.theta,
        fit.reason
    );
}

#[test]
fn check_2_9_an_interruption_gives_the_best_point_so_far() {
    for allowed in [1, 2, 3, 7, 20, 40] {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= allowed;
        let options = Options {
            interrupt: Some(&stop),
            ..Options::exact()
        };
        let fit = solve(
            &problem(wood, &[-3.0, -1.0, -3.0, -1.0], &[-10.0; 4], &[10.0; 4]),
            &options,
        )
        .unwrap();
        assert_eq!((fit.status, fit.reason), (Status::Interrupted, Reason::Interrupted));
        let start = 0.5 * wood(&[-3.0, -1.0, -3.0, -1.0]).iter().map(|r| r * r).sum::<f64>();
        assert!(fit.cost <= start && fit.cost == 0.5 * wood(&fit.theta).iter().map(|r| r * r).sum::<f64>());
        assert_eq!(fit.log.len(), fit.counts.steps.min(fit.log.len()));
        assert!(fit.counts.evaluations <= 1 + allowed);
    }
}

#[test]
fn limits_are_kept_and_told() {
    let of = problem(wood, &[-3.0, -1.0, -3.0, -1.0], &[-INF; 4], &[INF; 4]);
    let options = Options {
        iterations: 3,
        attempts: false,
        ..Options::exact()
    };
    let fit = solve(&of, &options).unwrap();
    assert_eq!(
        (fit.status, fit.reason, fit.counts.steps),
        (Status::Failed, Reason::IterationLimit, 3)
    );
    assert!(fit.derivative.is_some());
    let options = Options {
        evaluations: 20,
        attempts: false,
        ..Options::exact()
    };
    let fit = solve(&of, &options).unwrap();
    assert_eq!((fit.status, fit.reason), (Status::Failed, Reason::EvaluationLimit));
    // Those of a last step and of the derivatives at the end come on top.
    assert!(fit.counts.evaluations <= 20 + 2 + 4 + 8, "{:?}", fit.counts);
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
