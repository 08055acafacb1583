//! The certified problems of nonlinear regression of the NIST (StRD), from both starts.
#![allow(clippy::print_stderr)]

use gearloss_numerics::least_squares::{Differences, Options, Parameter, Status, Steps, Subproblem, halton};

use crate::nist::{Certified, LAWS, all, digits};

/// Sums over the runs of all problems from both starts.
#[derive(Default)]
struct Tally {
    solved: usize,
    evaluations: usize,
    /// Without MGH17 from afar, whose way hangs on the last bits.
    tame: usize,
    cone_solves: usize,
    cone_failures: usize,
    /// Converged by status, with fewer than six digits.
    wrong: Vec<String>,
    /// Not solved, and not said to be.
    missed: Vec<String>,
    poor_deviations: Vec<String>,
}

fn tally(options: &Options<'_>, parameters: impl Fn(&Certified, usize) -> Vec<Parameter>) -> Tally {
    let mut tally = Tally::default();
    for problem in all() {
        for start in [0, 1] {
            let fit = problem.solve(parameters(&problem, start), options);
            let (digits, deviations) = (problem.digits(&fit), problem.deviation_digits(&fit));
            eprintln!(
                "{:9} {start} {digits:5.1} {deviations:5.1} {:5} {:4} {} {:?} {:?} {:.1e} {:.1e}",
                problem.name,
                fit.counts.evaluations,
                fit.counts.cone_solves,
                fit.attempt,
                fit.status,
                fit.reason,
                fit.derivative.as_ref().map_or(0.0, |d| d.independence),
                fit.chi2() / problem.sum - 1.0,
            );
            tally.evaluations += fit.counts.evaluations;
            if (problem.name, start) != ("MGH17", 0) {
                tally.tame += fit.counts.evaluations;
            }
            tally.cone_solves += fit.counts.cone_solves;
            tally.cone_failures += fit.counts.cone_failures;
            let label = format!("{} {start}: {digits:.1}, {deviations:.1}", problem.name);
            let needed = if problem.name == "Lanczos1" { 3.0 } else { 4.0 };
            if deviations < needed {
                tally.poor_deviations.push(label.clone());
            }
            match (digits >= 6.0, fit.converged()) {
                (true, true) => tally.solved += 1,
                (false, true) => tally.wrong.push(label),
                (_, false) => tally.missed.push(label),
            }
        }
    }
    eprintln!(
        "{} solved, {} evaluations, {} cone solves, {} failed; wrong {:?}, missed {:?}",
        tally.solved, tally.evaluations, tally.cone_solves, tally.cone_failures, tally.wrong, tally.missed
    );
    tally
}

#[test]
fn check_2_8_all_54_runs_have_six_digits() {
    let tally = tally(&Options::exact(), Certified::parameters);
    assert!(
        tally.wrong.is_empty() && tally.missed.is_empty(),
        "{:?} {:?}",
        tally.wrong,
        tally.missed
    );
    assert_eq!(tally.solved, 54);
    assert!(tally.poor_deviations.is_empty(), "{:?}", tally.poor_deviations);
    assert!(
        tally.tame < 7800 && tally.evaluations < 17_000,
        "{} {}",
        tally.tame,
        tally.evaluations
    );
    assert!(tally.cone_failures <= 20, "{}", tally.cone_failures);
}

#[test]
fn check_2_8_dogleg_alone() {
    let options = Options {
        subproblem: Subproblem::Dogleg,
        ..Options::exact()
    };
    let tally = tally(&options, Certified::parameters);
    assert!(tally.solved >= 52, "{:?} {:?}", tally.wrong, tally.missed);
}

#[test]
fn check_2_8_boxes_that_bind() {
    let cases: [(&str, &[(usize, f64, f64)], &[f64], f64, &[(usize, f64)]); 3] = [
        (
            "Misra1a",
            &[(0, f64::NEG_INFINITY, 230.0)],
            &[230.0, 0.0005752257721],
            0.24762196991,
            &[(0, -0.01437)],
        ),
        (
            "Rat42",
            &[(2, 0.07, f64::INFINITY)],
            &[71.4268306, 2.67568313, 0.07],
            8.8589160707,
            &[(2, 299.4)],
        ),
        (
            "Thurber",
            &[(0, f64::NEG_INFINITY, 1280.0), (5, f64::NEG_INFINITY, 0.39)],
            &[1280.0, 1476.00046, 574.650622, 73.805263, 0.96185089, 0.39, 0.046298106],
            6267.7262152,
            &[(0, -70.19), (5, -6686.0)],
        ),
    ];
    for (name, bounds, optimum, sum, gradients) in cases {
        let law = LAWS.iter().find(|law| law.0 == name).unwrap();
        let problem = Certified::read(*law);
        for subproblem in [Subproblem::Cone, Subproblem::Dogleg] {
            let mut parameters = problem.parameters(1);
            for (j, lower, upper) in bounds {
                parameters[*j] = parameters[*j].clone().within(*lower, *upper);
            }
            let options = Options {
                subproblem,
                ..Options::exact()
            };
            let fit = problem.solve(parameters, &options);
            assert!(fit.converged(), "{name} {:?}", fit.reason);
            assert!(digits(&fit.theta, optimum) > 7.0, "{name} {:?}", fit.theta);
            assert!((fit.chi2() / sum - 1.0).abs() < 1e-9, "{name} {}", fit.chi2());
            for (j, gradient) in gradients {
                assert!(fit.active[*j].is_some() && fit.theta[*j] == optimum[*j]);
                let found = fit.derivative.as_ref().unwrap().gradient[*j];
                assert!((found / gradient - 1.0).abs() < 1e-3, "{name} {found}");
            }
        }
    }
}

#[test]
fn check_2_8_in_a_wide_box() {
    let parameters = |problem: &Certified, start: usize| -> Vec<Parameter> {
        let bounded = |(p, b): (Parameter, &f64)| {
            let reach = 10.0 * b.abs().max(p.start.abs());
            p.within(-reach, reach)
        };
        problem
            .parameters(start)
            .into_iter()
            .zip(&problem.values)
            .map(bounded)
            .collect()
    };
    let tally = tally(&Options::exact(), parameters);
    assert!(
        tally.wrong.is_empty() && tally.missed.is_empty(),
        "{:?} {:?}",
        tally.wrong,
        tally.missed
    );
}

#[test]
fn check_2_8_moved_starts_are_solved_or_said_to_be_not() {
    let mut tallies = Vec::new();
    for k in 1..=5 {
        let parameters = |problem: &Certified, start: usize| -> Vec<Parameter> {
            let mut parameters = problem.parameters(start);
            let n = parameters.len();
            for (p, x) in parameters.iter_mut().zip(halton(17 * k + start, n)) {
                p.start *= 1.0 + 0.02 * (2.0 * x - 1.0);
            }
            parameters
        };
        tallies.push(tally(&Options::exact(), parameters));
    }
    let solved: usize = tallies.iter().map(|t| t.solved).sum();
    let wrong: Vec<&String> = tallies.iter().flat_map(|t| &t.wrong).collect();
    let missed: Vec<&String> = tallies.iter().flat_map(|t| &t.missed).collect();

    assert!(solved >= 265, "{solved} {wrong:?} {missed:?}");
    // The waves of ENSO have minima of their own.
    assert!(wrong.iter().all(|label| label.starts_with("ENSO")), "{wrong:?}");
}

#[test]
fn check_2_8_the_hardest_starts_moved_by_roundings() {
    // What other processors and libraries do to the last bits. MGH17 from afar is solved most of the time, and where it is
    // not, it says so.
    for (name, least) in [("MGH09", 12), ("MGH10", 12), ("MGH17", 9)] {
        let law = LAWS.iter().find(|law| law.0 == name).unwrap();
        let problem = Certified::read(*law);
        let mut solved = 0;
        for k in 1..=12 {
            let mut parameters = problem.parameters(0);
            for (p, x) in parameters.iter_mut().zip(halton(k, 5)) {
                p.start *= 1.0 + 1e-13 * (x - 0.5);
            }
            let fit = problem.solve(parameters, &Options::exact());
            assert!(
                problem.digits(&fit) > 6.0 || !fit.converged(),
                "{name} {k} {:?}",
                fit.theta
            );
            solved += usize::from(fit.converged());
        }
        assert!(solved >= least, "{name} {solved}");
    }
}

#[test]
fn check_2_8_variants() {
    let central = Options {
        differences: Differences::Central,
        ..Options::exact()
    };
    assert_eq!(tally(&central, Certified::parameters).solved, 54);
    // Without further attempts MGH17 is lost from afar, and said to be.
    let once = Options {
        attempts: false,
        ..Options::exact()
    };
    let once = tally(&once, Certified::parameters);
    assert!(once.solved >= 53 && once.wrong.is_empty(), "{:?}", once.wrong);
}

#[test]
fn check_2_4_the_preset_for_fits_ends_within_a_hundredth_of_the_standard_errors() {
    // The standard errors of Lanczos1 are roundings of its data.
    for problem in all().iter().filter(|problem| problem.name != "Lanczos1") {
        for start in [0, 1] {
            let fit = problem.solve(problem.parameters(start), &Options::fit());
            assert!(fit.converged(), "{} {start} {:?}", problem.name, fit.reason);
            let offset = |j: usize| ((fit.theta[j] - problem.values[j]) / problem.deviations[j]).abs();
            let worst = (0..fit.theta.len()).map(offset).fold(0.0, f64::max);
            assert!(worst < 0.01, "{} {start}: {worst}", problem.name);
        }
    }
}

#[test]
fn check_2_9_a_parameter_that_is_lost_on_the_way_is_no_success() {
    // Without a bound of the step, the first one goes where the exponential is zero to the last bit.
    let problem = Certified::read(LAWS[1]);
    let options = Options {
        steps: Steps {
            radius: 100.0,
            bound: 1e9,
            ..Options::exact().steps
        },
        attempts: false,
        ..Options::exact()
    };
    let fit = problem.solve(problem.parameters(0), &options);
    assert!(fit.theta[1] > 50.0 && fit.reason.is_convergence());
    assert_eq!(
        (fit.status, fit.derivative.unwrap().independence),
        (Status::Singular, 0.0)
    );
    // Never seen from there on: it is told by name, and the rest is solved.
    let lost = vec![Parameter::new("b1", 100.0), Parameter::new("b2", 1e4)];
    let fit = problem.solve(lost, &Options::exact());
    assert_eq!(fit.derivative.as_ref().unwrap().unseen, [false, true]);
    assert!(fit.notes[0].contains("`b2` has no effect on any residual"));
}
