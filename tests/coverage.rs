//! Whether intervals hold what is hidden as often as they say: 200 measurements of the synthetic rig, each with other noise.
#![allow(clippy::print_stdout)]

use crate::common::language;
use crate::common::rig::{Rig, TRUTH, csv, entry, gearbox, identification, study};
use gearloss_studies::identify::Settings;
use gearloss_numerics::inference::Standing;
use gearloss_numerics::inference::probability::chi_square_quantile;
use gearloss_numerics::least_squares::Status;
use rayon::prelude::*;

const SEEDS: u64 = 200;

/// What one measurement tells.
struct Told {
    /// Whether the 95 % interval of each parameter holds what is hidden.
    hits: Vec<bool>,
    /// Whether a bound is active, or a parameter within one standard error of one.
    at_bound: bool,
    /// Rise of the sum of squares from the optimum to what is hidden.
    rise: f64,
    evaluations: usize,
}

fn told(seed: u64) -> Told {
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
    Told {
        hits,
        at_bound,
        rise: squares - inference.objective(),
        evaluations: fitted.minima.evaluations,
    }
}

/// Bands of a correct method for 200 runs: the central 95 % of a count with probability 0.95 are 92 to 98 %, the central 99 %
/// 90.5 to 98.5 %; parameters of one fit depend on each other, so that the pooled share is held to 93 to 97 %.
#[test]
fn intervals_hold_what_is_hidden_as_often_as_they_say() {
    let all: Vec<Told> = (1..=SEEDS).into_par_iter().map(told).collect();
    let free: Vec<&Told> = all.iter().filter(|t| !t.at_bound).collect();
    let share = |list: &[&Told], k: usize| list.iter().filter(|t| t.hits[k]).count() as f64 / list.len() as f64;
    let whole: Vec<&Told> = all.iter().collect();
    let pooled = |list: &[&Told]| (0..TRUTH.len()).map(|k| share(list, k)).sum::<f64>() / TRUTH.len() as f64;
    let inside = |confidence: f64| {
        let limit = chi_square_quantile(confidence, TRUTH.len() as f64).unwrap();
        all.iter().filter(|t| t.rise <= limit).count()
    };
    let evaluations = all.iter().map(|t| t.evaluations).sum::<usize>() as f64 / all.len() as f64;
    println!(
        "{} of {SEEDS} runs with a parameter at a bound or within one standard error of one; {evaluations:.0} evaluations a fit",
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
        "pooled: {:.4} of the free runs, {:.4} of all; joint regions: 95 % {} of {SEEDS}, 99 % {}",
        pooled(&free),
        pooled(&whole),
        inside(0.95),
        inside(0.99)
    );
    assert!(free.len() >= 150, "{}", free.len());
    assert!((0.93..=0.97).contains(&pooled(&free)), "{}", pooled(&free));
    for (k, (name, _)) in TRUTH.iter().enumerate() {
        assert!((0.91..=0.985).contains(&share(&free, k)), "{name}: {}", share(&free, k));
    }
    assert!(inside(0.99) >= 194, "{}", inside(0.99));
}
