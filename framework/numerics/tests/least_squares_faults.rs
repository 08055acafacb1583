//! What becomes of fits that make no sense, or that something stops.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::classics::{INF, Residual, parameters, problem, rosenbrock, wood};
use gearloss_numerics::least_squares::{Options, Parameter, Problem, Reason, Status, solve};

fn fault(of: &Problem<'_>) -> String {
    solve(of, &Options::fit()).unwrap_err().to_string()
}

#[test]
fn check_2_9_invalid_problems_are_refused_at_once() {
    let mut three = parameters(&[1.0, -1.0, f64::NAN], &[2.0, 0.0, -INF], &[0.0, 5.0, INF]);
    three[1] = three[1].clone().log().prior(-1.0, 0.0);
    let text = fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), three));
    for part in [
        "parameter `x1`: its lower bound 2 is above its upper bound 0; exchange them",
        "parameter `x2`: its lower bound 0 has no logarithm",
        "parameter `x2`: its start -1 has no logarithm",
        "parameter `x2`: the deviation 0 of its prior is not positive",
        "parameter `x2`: the mean -1 of its prior is not possible on its scale",
        "parameter `x3`: its start is NaN; give a number",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let twice = vec![Parameter::new("a", 1.0), Parameter::new("a", 1.0)];
    assert!(fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), twice)).contains("used twice"));
    assert!(fault(&Problem::new(|_: &[f64]| Ok(vec![0.0; 9]), Vec::new())).contains("there are none"));
    let options = Options {
        loss_scale: 0.0,
        ..Options::fit()
    };
    let text = solve(&problem(rosenbrock, &[1.0, 2.0], &[-INF; 2], &[INF; 2]), &options).unwrap_err();
    assert!(text.to_string().contains("option loss_scale: 0 is not positive"));
}

#[test]
fn check_2_9_fewer_rows_than_free_parameters() {
    let one: Residual = |x| vec![10.0 * (x[1] - x[0] * x[0])];
    let text = fault(&problem(one, &[-2.0, 1.0], &[-INF; 2], &[INF; 2]));
    assert!(
        text.contains("1 rows, including priors, for 2 free parameters; fix parameters, or give some of them a prior")
    );
    // Either of which fixes it.
    let mut fixed = parameters(&[-2.0, 1.0], &[-INF, -INF], &[INF, INF]);
    fixed[0] = fixed[0].clone().prior(0.5, 0.1);
    let fit = solve(&Problem::new(move |x: &[f64]| Ok(one(x)), fixed), &Options::exact()).unwrap();
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
        fit.notes.iter().any(|n| n.contains("near `a` = 1: off the rails")),
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
    assert!(!fit.converged() && fit.notes.iter().any(|n| n.contains("residuals, but 2")));
}

#[test]
fn check_2_9_a_parameter_that_is_not_seen() {
    let law: Residual = |x| vec![x[0] - 1.0, 0.5 * x[0] - 1.0, 0.1];
    let fit = solve(&problem(law, &[3.0, 7.0], &[-INF; 2], &[INF; 2]), &Options::fit()).unwrap();
    assert!(fit.converged() && (fit.theta[0] - 1.2).abs() < 1e-9 && fit.theta[1] == 7.0);
    assert_eq!(fit.derivative.unwrap().unseen, [false, true]);
    assert!(
        fit.notes
            .iter()
            .any(|n| n.contains("`x2` has no effect on any residual"))
    );
    // Unseen at the start only: it joins.
    let law: Residual = |x| vec![x[0] - 3.0, (x[0] - 1.0).max(0.0) * (x[1] - 2.0), 0.1];
    let fit = solve(&problem(law, &[0.0, 7.0], &[-INF; 2], &[INF; 2]), &Options::fit()).unwrap();
    assert!(fit.converged() && (fit.theta[1] - 2.0).abs() < 1e-6, "{:?}", fit.theta);
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
fn limits_are_kept_and_reported() {
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
