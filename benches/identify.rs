//! Eight parameters of the two-speed example on its 440 points, under the set `joint`: all residuals, a fit, a fit from 32 starts.
#![allow(clippy::unwrap_used, missing_docs)]

use std::fmt::Arguments;
use std::hint::black_box;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use crate::identification::Prepared;
use criterion::{Criterion, SamplingMode, criterion_group};
use gearloss_studies::identify::{Fitted, Settings};

/// Starts of the longest fit.
const STARTS: usize = 32;

/// Beside the times, where the reader of a bench looks.
fn say(words: Arguments<'_>) {
    std::io::stdout().write_fmt(words).unwrap();
}

fn work(what: &str, fitted: &Fitted) {
    let (minima, fit) = (&fitted.minima, fitted.fit());
    say(format_args!(
        "{what}: {} evaluations, cost {:.6}, {} ({}), {} minima\n",
        minima.evaluations,
        fit.cost,
        fit.status.name(),
        fit.reason.name(),
        minima.minima.len(),
    ));
}

fn identify(c: &mut Criterion) {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/two-speed-ev/study.yaml");
    let prepared = Prepared::read(&study, "eight").unwrap_or_else(|fault| panic!("{fault}"));
    let mut identification = prepared
        .identification("joint")
        .unwrap_or_else(|fault| panic!("{fault}"));
    let (points, parameters) = (identification.observations().len(), identification.parameters().len());
    assert_eq!((points, parameters), (440, 8));
    let mut group = c.benchmark_group("identify");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    let start = identification.start();
    group.bench_function("440 residuals", |b| {
        b.iter(|| identification.residuals(black_box(&start)).unwrap());
    });
    let settings = Settings::default();
    group.bench_function("fit of eight parameters", |b| {
        b.iter(|| identification.fit(&settings).unwrap());
    });
    group.finish();
    work("fit of eight parameters", &identification.fit(&settings).unwrap());
    // Once: ten samples would take minutes.
    let settings = Settings {
        starts: STARTS,
        ..settings
    };
    let begun = Instant::now();
    let fitted = identification.fit(&settings).unwrap();
    let seconds = begun.elapsed().as_secs_f64();
    work(&format!("fit from {STARTS} starts"), &fitted);
    say(format_args!(
        "fit from {STARTS} starts: {seconds:.2} s, once, on {} threads\n",
        rayon::current_num_threads()
    ));
}

criterion_group!(benches, identify);
