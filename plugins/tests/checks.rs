//! The check values of the models and ratings hold, and each of them would fail if it were wrong.

use gearloss_framework::checks::{faults, faults_of_rating};
use gearloss_framework::registry::{Check, Entry, RatingPlugin};
use gearloss_framework::testing::language;
use gearloss_plugins as _;

fn models() -> impl Iterator<Item = &'static Entry> {
    let registry = language().registry();
    let mechanisms = registry.mechanisms().iter();
    mechanisms.flat_map(|mechanism| registry.models(mechanism.key))
}

fn ratings() -> impl Iterator<Item = &'static RatingPlugin> {
    language().registry().ratings().iter()
}

/// Faults of a model with one other check.
fn of_model(entry: &Entry, check: Check) -> Vec<String> {
    let checks = vec![check].leak();
    faults(language(), &Entry { checks, ..*entry })
}

/// Faults of a rating with one other check.
fn of_rating(rating: &RatingPlugin, check: Check) -> Vec<String> {
    let checks = vec![check].leak();
    let entry = Entry { checks, ..rating.entry };
    faults_of_rating(language(), &RatingPlugin { entry, ..*rating })
}

#[test]
fn every_check_value_holds() {
    let models = models().flat_map(|entry| faults(language(), entry));
    let ratings = ratings().flat_map(|rating| faults_of_rating(language(), rating));
    let all: Vec<String> = models.chain(ratings).collect();
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// Every value is moved by two and a half tolerances, upwards and downwards; zero becomes a small number.
#[test]
fn every_check_value_can_fail() {
    let fails = |check: &Check, faults: &dyn Fn(Check) -> Vec<String>| {
        for sign in [1.0, -1.0] {
            let moved = check.values.iter().map(|(quantity, stated)| {
                let (number, unit) = stated.split_once(' ').unwrap_or((stated, "-"));
                let other = match number.parse().unwrap() {
                    0.0 => sign * 1e-9,
                    number => number * (1.0_f64 + sign * 2.5 * check.tolerance),
                };
                (*quantity, &*format!("{other:e} {unit}").leak())
            });
            let values: &[_] = moved.collect::<Vec<_>>().leak();
            let found = faults(Check { values, ..*check });
            assert_eq!(found.len(), values.len(), "{}: {values:?}: {found:?}", check.input);
        }
        check.values.len()
    };
    let mut values = 0;
    for entry in models() {
        let checks = entry.checks.iter();
        values += checks
            .map(|check| fails(check, &|other| of_model(entry, other)))
            .sum::<usize>();
    }
    for rating in ratings() {
        let checks = rating.entry.checks.iter();
        values += checks
            .map(|check| fails(check, &|other| of_rating(rating, other)))
            .sum::<usize>();
    }
    assert!(values > 150, "{values}");
}

#[test]
fn a_check_that_cannot_fail_is_a_fault() {
    let is_linke = |entry: &&Entry| (entry.mechanism, entry.name) == ("seal", "linke");
    let entry = models().find(is_linke).unwrap();
    let first = entry.checks[0];
    assert_eq!(of_model(entry, first), [""; 0]);
    let values = |values| Check { values, ..first };
    for (check, words) in [
        (values(&[]), "has no value"),
        (values(&[("total", "36.9 W")]), "total is 36.91"),
        (values(&[("total", "36.9120 Nm")]), "total is in [W], not in [Nm]"),
        (values(&[("total", "36.9120")]), "total is in [W], not in [-]"),
        (values(&[("total", "some W")]), "does not begin with a number"),
        (values(&[("total", "inf W")]), "does not begin with a number"),
        (values(&[("totla", "36.9120 W")]), "`totla` is no result"),
        (
            Check {
                tolerance: f64::INFINITY,
                ..first
            },
            "its tolerance inf",
        ),
        (
            Check {
                tolerance: f64::NAN,
                ..first
            },
            "its tolerance NaN",
        ),
        (
            Check {
                tolerance: 0.5,
                ..first
            },
            "its tolerance 0.5",
        ),
        (Check { source: " ", ..first }, "has no source"),
        (Check { because: "", ..first }, "no reason for its tolerance"),
        (
            Check {
                input: "{ part: { diametre: 40 mm } }",
                ..first
            },
            "diameter",
        ),
    ] {
        let found = of_model(entry, check);
        assert!(found.iter().any(|fault| fault.contains(words)), "{words}: {found:?}");
    }
}
