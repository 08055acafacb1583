//! One point: the two-speed example under each set of models, the planetary one at a given temperature, and its equilibrium; and
//! many points of several speeds in batches.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;

use crate::common::{RPM, build, gearbox, language, point, set};
use criterion::{Criterion, Throughput, criterion_group};
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;

/// A point of the two-speed example in first gear.
fn two_speed(t: &Transmission) -> impl FnMut() -> Option<f64> {
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    move || {
        let (speeds, torques) = ([8000.0 * RPM], [10.0]);
        let point = point(black_box(&speeds), black_box(&torques));
        t.evaluate(&case, &point, &[100.0], &mut scratch).loss()
    }
}

/// Speeds of the points in batches.
const SPEEDS: u32 = 32;

/// The sum of the losses at as many torques as lanes and some speeds of the two-speed example in first gear, as a map has them.
fn side_by_side(t: &Transmission) -> impl FnMut() -> f64 {
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.batch_scratch(&case);
    let torques: Vec<f64> = (1..=LANES).map(|i| 20.0 * i as f64 / LANES as f64).collect();
    move || {
        let mut sum = 0.0;
        for speed in 0..SPEEDS {
            let speeds = [(8000.0 + 22.0 * f64::from(speed)) * RPM];
            let point = point(black_box(&speeds), &[0.0]);
            let mut row = t.batch(&case, &point, &[100.0], &mut scratch);
            let block = row.solve(&torques);
            assert!(!(0..LANES).any(|point| block.is_alone(point)));
            sum += block.losses().iter().sum::<f64>();
        }
        sum
    }
}

fn points(c: &mut Criterion) {
    let language = language();
    let mut group = c.benchmark_group("point");
    let example = gearbox(&language, "two-speed-ev");
    let of_set = |name: &str| build(&language, &example, &set(&language, name));
    let (iso, joint) = (of_set("iso"), of_set("joint"));
    group.bench_function("two-speed example, set iso", |b| b.iter(two_speed(&iso)));
    group.bench_function("two-speed example, set joint", |b| b.iter(two_speed(&joint)));

    let t = build(&language, &gearbox(&language, "planetary-reducer"), &Choice::default());
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    let (speeds, torques) = ([3000.0 * RPM], [-16.0]);
    group.bench_function("planetary example", |b| {
        let point = || point(black_box(&speeds), black_box(&torques));
        b.iter(|| t.evaluate(&case, &point(), black_box(&[50.0]), &mut scratch).loss());
    });
    group.bench_function("planetary example, equilibrium of losses and heat", |b| {
        let point = || point(black_box(&speeds), black_box(&torques));
        b.iter(|| t.equilibrium(&case, &point(), &mut scratch).oil());
    });
    group.throughput(Throughput::Elements(u64::from(SPEEDS) * LANES as u64));
    group.bench_function("two-speed example, set iso, batched", |b| {
        b.iter(side_by_side(&iso));
    });
    group.bench_function("two-speed example, set joint, batched", |b| {
        b.iter(side_by_side(&joint));
    });
    group.finish();
}

criterion_group!(benches, points);
