//! The planetary example: one point at a given temperature, and its equilibrium.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Registry;
use gearloss_framework::resolve::Choice;
use gearloss_plugins as _;

fn reducer(c: &mut Criterion) {
    let language = Language::new(Registry::linked().unwrap()).unwrap_or_else(|f| panic!("{f:#?}"));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/planetary-reducer/gearbox.yaml");
    let gearbox = Gearbox::read(&language, &file).unwrap_or_else(|f| panic!("{}", f.render()));
    let t = gearbox
        .transmission(&language, &Choice::default())
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = || Point {
        speeds: black_box(&[314.159]),
        torques: black_box(&[-16.0]),
        flow: PowerFlow::Real,
        tolerance: Tolerance::default(),
    };
    c.bench_function("one point of the reducer", |b| {
        b.iter(|| t.evaluate(&case, &point(), black_box(&[50.0]), &mut scratch).loss());
    });
    c.bench_function("equilibrium of the reducer", |b| {
        b.iter(|| t.equilibrium(&case, &point(), &mut scratch).oil());
    });
}

criterion_group!(benches, reducer);
criterion_main!(benches);
