//! Exponentials and logarithms, which determine the minimum time of a point: those of the framework in lanes, and those of the
//! standard library one by one.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group};
use gearloss_framework::real::{LANES, Lane, Points as _, exp, ln};

/// Lanes in one call; they stay in the cache.
const MANY: usize = 32;

/// Numbers from one third to three.
fn numbers() -> Vec<Lane> {
    let count = (MANY * LANES) as f64;
    (0..MANY)
        .map(|k| Lane::each(|i| (1.0 + 8.0 * (k * LANES + i) as f64 / count) / 3.0))
        .collect()
}

/// The function comes as a type of its own, so that it is compiled into the loop.
fn side_by_side(numbers: &[Lane], answers: &mut [Lane], function: impl Fn(f64) -> f64) {
    Lane::wide(
        #[inline(always)]
        || {
            for (answers, numbers) in answers.iter_mut().zip(black_box(numbers)) {
                *answers = numbers.map(&function);
            }
        },
    );
}

fn one_by_one(numbers: &[Lane], answers: &mut [Lane], function: fn(f64) -> f64) {
    for (answers, numbers) in answers.iter_mut().zip(black_box(numbers)) {
        *answers = Lane::each(|i| function(numbers[i]));
    }
}

fn functions(c: &mut Criterion) {
    let numbers = numbers();
    let mut answers = numbers.clone();
    let mut group = c.benchmark_group("elementary");
    group.throughput(Throughput::Elements((MANY * LANES) as u64));
    group.bench_function("exponentials in lanes", |b| {
        b.iter(|| side_by_side(&numbers, black_box(&mut answers), exp));
    });
    group.bench_function("logarithms in lanes", |b| {
        b.iter(|| side_by_side(&numbers, black_box(&mut answers), ln));
    });
    group.bench_function("exponentials of the standard library", |b| {
        b.iter(|| one_by_one(&numbers, black_box(&mut answers), f64::exp));
    });
    group.bench_function("logarithms of the standard library", |b| {
        b.iter(|| one_by_one(&numbers, black_box(&mut answers), f64::ln));
    });
    group.bench_function("powers of the standard library", |b| {
        b.iter(|| one_by_one(&numbers, black_box(&mut answers), |x| x.powf(0.54)));
    });
    group.finish();
}

criterion_group!(benches, functions);
