//! Whether intervals contain the hidden values as often as they state: measurements of the synthetic rig, each with other noise.
//!
//! 40 measurements; `FULL=1 cargo test --test all coverage:: -- --ignored --nocapture` takes 200, with closer limits.
#![allow(clippy::print_stdout)]

use crate::common::rig::{Rig, TRUTH, csv, entry, gearbox, identification, study};
use crate::common::{is_full, language};
use gearloss_numerics::inference::Standing;
use gearloss_numerics::inference::probability::chi_square_quantile;
use gearloss_numerics::least_squares::Status;
use gearloss_studies::identify::Settings;
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Coverage of one simulated measurement.
struct Coverage {
    /// Whether the 95 % interval of each parameter holds what is hidden.
    hits: Vec<bool>,
    /// Whether a bound is active, or a parameter within one standard error of one.
    at_bound: bool,
    /// Rise of the sum of squares from the optimum to what is hidden.
    rise: f64,
    evaluations: usize,
}

fn fit_seed(seed: u64) -> Coverage {
    let language = language();
    let (gearbox, study) = (gearbox(&language), study(&language));
    let text = csv(&Rig::new(&language, "complete"), seed);
    let measured = entry(&study).read(text.as_bytes(), &[]).unwrap();
    let mut identification = identification(&language, &gearbox, &study, &measured);
    let fitted = identification.fit(&Settings::default()).unwrap();
    let inference = &fitted.inference;
    assert_eq!(fitted.fit().status, Status::Converged, "seed {seed}");
    let mut hits = Vec::new();
    let mut at_bound = false;
    for (k, (name, truth)) in TRUTH.iter().enumerate() {
        let parameter = &inference.parameters()[k];
        assert_eq!(parameter.name, *name);
        let near = |deviation: f64| {
            let [low, high] = parameter.bounds;
            parameter.u - low <= deviation || high - parameter.u <= deviation
        };
        at_bound |= parameter.standing != Standing::Free || inference.deviation(k).is_some_and(near);
        let interval = inference.interval(k, 0.95, 1.0).map(|i| i.uncut);
        hits.push(interval.is_some_and(|[low, high]| (low..=high).contains(truth)));
    }
    let hidden: Vec<f64> = TRUTH.iter().map(|(_, truth)| *truth).collect();
    let squares: f64 = identification.residuals(&hidden).unwrap().iter().map(|r| r * r).sum();
    Coverage {
        hits,
        at_bound,
        rise: squares - inference.objective(),
        evaluations: fitted.minima.evaluations,
    }
}

/// What a correct method keeps to with a number of measurements.
struct Limits {
    seeds: u64,
    /// Shares over the runs without a parameter at a bound.
    pooled: RangeInclusive<f64>,
    each: RangeInclusive<f64>,
    /// Minimum number of runs whose joint region of 99 % contains what is hidden.
    joint: usize,
}

impl Limits {
    /// Of 200 runs, the central 95 % of a count with probability 0.95 are 92 to 98 %, the central 99 % 90.5 to 98.5 %; parameters of
    /// one fit depend on each other, so that the pooled share is held to 93 to 97 %.
    ///
    /// Of 40 runs the central 99 % of the count are 34 to 40, and of the pooled one of 320 about 0.92 to 0.98. The pooled share of these
    /// runs is 0.947; with intervals a tenth narrower it is 0.897, a fifth narrower 0.844, half wider 1: all are outside.
    fn of_the_run() -> Self {
        if is_full() {
            Self {
                seeds: 200,
                pooled: 0.93..=0.97,
                each: 0.91..=0.985,
                joint: 194,
            }
        } else {
            Self {
                seeds: 40,
                pooled: 0.92..=0.98,
                each: 0.85..=1.0,
                joint: 38,
            }
        }
    }
}

#[test]
#[ignore = "takes two minutes on two cores; a stage of `.ci/full`"]
fn intervals_hold_what_is_hidden_as_often_as_they_say() {
    let limits = Limits::of_the_run();
    let seeds = limits.seeds;
    let all: Vec<Coverage> = (1..=seeds).into_par_iter().map(fit_seed).collect();
    let free: Vec<&Coverage> = all.iter().filter(|t| !t.at_bound).collect();
    let share = |list: &[&Coverage], k: usize| list.iter().filter(|t| t.hits[k]).count() as f64 / list.len() as f64;
    let whole: Vec<&Coverage> = all.iter().collect();
    let pooled = |list: &[&Coverage]| (0..TRUTH.len()).map(|k| share(list, k)).sum::<f64>() / TRUTH.len() as f64;
    let inside = |confidence: f64| {
        let limit = chi_square_quantile(confidence, TRUTH.len() as f64).unwrap();
        all.iter().filter(|t| t.rise <= limit).count()
    };
    let evaluations = all.iter().map(|t| t.evaluations).sum::<usize>() as f64 / all.len() as f64;
    println!(
        "{} of {seeds} runs with a parameter at a bound or within one standard error of one; {evaluations:.0} evaluations a fit",
        all.len() - free.len()
    );
    for (k, (name, _)) in TRUTH.iter().enumerate() {
        println!(
            "{name}: {:.3} of the free runs, {:.3} of all",
            share(&free, k),
            share(&whole, k)
        );
    }
    println!(
        "pooled: {:.4} of the free runs, {:.4} of all; joint regions: 95 % {} of {seeds}, 99 % {}",
        pooled(&free),
        pooled(&whole),
        inside(0.95),
        inside(0.99)
    );
    assert!(4 * free.len() >= 3 * all.len(), "{}", free.len());
    assert!(limits.pooled.contains(&pooled(&free)), "{}", pooled(&free));
    for (k, (name, _)) in TRUTH.iter().enumerate() {
        assert!(limits.each.contains(&share(&free, k)), "{name}: {}", share(&free, k));
    }
    assert!(inside(0.99) >= limits.joint, "{}", inside(0.99));
}
