//! From text to a transmission: the two-speed example, and a document of 10,000 lines.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;

use crate::common::{build, example, language, long};
use criterion::{Criterion, Throughput, criterion_group};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;

fn reading(c: &mut Criterion) {
    let language = language();
    let choice = Choice::default();
    let read = |text: &str| {
        let read = Gearbox::of_text(&language, text, "gearbox.yaml", example("two-speed-ev"));
        read.unwrap_or_else(|f| panic!("{}", f.render()))
    };
    let mut group = c.benchmark_group("reading");
    group.sample_size(20);

    let text = std::fs::read_to_string(example("two-speed-ev").join("gearbox.yaml")).unwrap();
    group.throughput(Throughput::Elements(text.lines().count() as u64));
    let gearbox = read(&text);
    group.bench_function("two-speed example, YAML to walked document", |b| {
        b.iter(|| read(black_box(&text)));
    });
    group.bench_function("two-speed example, walked document to resolved one", |b| {
        b.iter(|| gearbox.resolve(&language, black_box(&choice)).unwrap());
    });
    group.bench_function("two-speed example, walked document to transmission", |b| {
        b.iter(|| build(&language, &gearbox, black_box(&choice)));
    });

    let text = long::yaml();
    assert_eq!(text.lines().count(), long::LINES);
    group.throughput(Throughput::Elements(long::LINES as u64));
    let gearbox = read(&text);
    group.bench_function("10,000 lines, YAML to walked document", |b| {
        b.iter(|| read(black_box(&text)));
    });
    group.bench_function("10,000 lines, walked document to resolved one", |b| {
        b.iter(|| gearbox.resolve(&language, black_box(&choice)).unwrap());
    });
    group.finish();
}

criterion_group!(benches, reading);
