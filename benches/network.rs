//! A thermal network of 64 nodes around the two-speed example: its steady state, and a time step of one second.
#![allow(clippy::unwrap_used, missing_docs)]

use crate::common::{RPM, build, gearbox, language, plate, point, with};
use criterion::{Criterion, criterion_group};
use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::{March, Moment, Scheme, StepSize, Surroundings};

fn network(c: &mut Criterion) {
    let language = language();
    let t = build(&language, &gearbox(&language, "two-speed-ev"), &with(plate::network()));
    let network = t.network().unwrap();
    assert_eq!(network.names().len(), plate::NODES);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let (speeds, torques) = ([6000.0 * RPM], [15.0]);
    let moment = Moment {
        case: &case,
        point: &point(&speeds, &torques),
        around: &Surroundings::default(),
    };
    let mut group = c.benchmark_group("network");
    group.bench_function("64 nodes, steady state", |b| {
        b.iter(|| {
            let steady = t.steady(&moment, &mut scratch).unwrap();
            assert_eq!(steady.outcome, Outcome::Converged);
        });
    });
    let start = network.start(Some(40.0), moment.around);
    let mut scratch = t.batch_scratch(&case);
    group.bench_function("64 nodes, a step of one second", |b| {
        let mut march = March::new(&t, network, start.clone(), Scheme::Implicit, StepSize::Fixed(1.0));
        b.iter(|| {
            march.temperatures.clone_from(&start);
            march.advance(&moment, 1.0, &mut scratch).unwrap()
        });
    });
    group.finish();
}

criterion_group!(benches, network);
