//! Comparison of models of the made-up problem, with parameters held.

use gearloss_numerics::inference::{Accuracy, Comparison, Decision, FittedModel, PointSet, akaike, ranking};

use super::check_problem::{OPTIMUM, measured, minimise, parameters};

#[test]
fn check_7_4_models() {
    let all: Vec<usize> = (0..440).collect();
    // Name, place and coordinate of what is held, sum of squares and criterion as printed.
    let cases: [(&str, Option<(usize, f64)>, f64, f64); 4] = [
        ("eight parameters", None, 468.403446, 484.737553),
        ("dT = 0", Some((7, 0.0)), 470.851687, 485.110947),
        ("a = 0.2", Some((2, 0.2)), 471.470102, 485.729361),
        ("f_L = 1", Some((3, 0.0)), 468.488149, 482.747409),
    ];
    let fitted = cases.map(|(name, held, squares, criterion)| {
        let mut start = parameters(&OPTIMUM);
        if let Some((k, u)) = held {
            start[k].u = u;
        }
        let places: Vec<usize> = held.iter().map(|(k, _)| *k).collect();
        let (found, _) = minimise(&all, &measured(), start, &places);
        assert!((found - squares).abs() < 1e-6, "{name}: {found} instead of {squares}");
        let parameters = 8 - places.len();
        let found = akaike(found, 440, parameters, Accuracy::Given).unwrap();
        assert!(
            (found - criterion).abs() < 1e-6,
            "{name}: {found} instead of {criterion}"
        );
        FittedModel {
            name: name.to_owned(),
            parameters,
            criterion: found,
            validation: None,
            residuals: Vec::new(),
            scatter: 1.0,
            is_suspect: false,
        }
    });
    // This noise does not prove an offset: no two can be told apart, and the one with most parameters comes last.
    for a in &fitted {
        let is_decided = |b: &FittedModel| Comparison::new(a, b, &PointSet::default()).decision != Decision::NotDecided;
        assert!(!fitted.iter().any(is_decided));
    }
    assert_eq!(ranking(&fitted, &PointSet::default()), [3, 1, 2, 0]);
}
