//! A WLTC of 1800 seconds through the electric drive unit: friction of both meshes solved at every second, and interpolated in
//! tables; seventeen temperatures, losses and temperatures consistent at the end of every second. One thread.
#![allow(clippy::unwrap_used, missing_docs)]

use crate::common::{build, gearbox, language, with};
use criterion::{BatchSize, Criterion, Throughput, criterion_group};
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::resolve::{Choice, lookup};
use gearloss_framework::thermal::network::{Scheme, StepSize};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::duty::{CycleEntry, Interval, ShippedCycleEntry, Vehicle, VehicleEntry};
use gearloss_studies::points::{OilTemperature, Ride, drive};
use serde_json::json;

/// Loss over the whole cycle. \[J\]
fn wltc(t: &Transmission, vehicle: &Vehicle, intervals: &[Interval], scheme: Scheme) -> f64 {
    let ride = Ride {
        intervals,
        port: "input",
        vehicle: Some(vehicle),
        gear: &t.states()[0].name,
        choice: None,
        oil: OilTemperature::Network,
        spectrum: false,
        start: Some(23.0),
        ambient: Some(23.0),
        scheme,
        step: StepSize::Fixed(1.0),
        flow: PowerFlow::Real,
    };
    let driven = drive(t, &ride, &|_| true).unwrap().unwrap();
    driven.total.parts.iter().sum()
}

fn cycle(c: &mut Criterion) {
    let language = language();
    let gearbox = gearbox(&language, "electric-drive-unit");
    let resolved = gearbox.resolve(&language, &Choice::default()).unwrap();
    let table = |mesh: &str, torques: [&str; 2]| {
        let model = lookup(&resolved.value, &format!("meshes.{mesh}.model")).unwrap();
        // The law as written in the gearbox; resolved values are SI.
        assert_eq!(model["type"], "path_integral");
        let law = json!({ "type": "ehl_mixed" });
        let of = json!({ "type": "path_integral", "load_sharing": "ramp", "tooth_friction": law });
        (
            format!("meshes.{mesh}.model"),
            json!({ "type": "tabulated", "of": of, "torques": torques }),
        )
    };
    let tabulated = with(vec![
        table("M1", ["0.3 Nm", "350 Nm"]),
        table("M2", ["0.8 Nm", "950 Nm"]),
    ]);
    let build = |choice: &Choice| build(&language, &gearbox, choice);
    let (full, fast) = (build(&Choice::default()), build(&tabulated));
    let vehicle: VehicleEntry = serde_json::from_value(json!({
        "mass": 1928.0, "coast_down": { "a": 165.34, "b": 0.46767, "c": 0.32052 }, "tyre_radius": 0.3357,
        "rotating_mass_factor": 1.04, "regeneration": { "torque": 350.0, "power": 190e3, "fade_speed": 2.0 },
    }))
    .unwrap();
    let vehicle = vehicle.vehicle("vehicles.car").unwrap();
    let entry = CycleEntry::Shipped(ShippedCycleEntry {
        shipped: "wltc_class3b".to_owned(),
        repeat: 1,
        start: None,
        end: None,
    });
    let duty = entry.read(language.registry(), |_| Err(String::new())).unwrap();
    let intervals = duty.intervals(Some(&vehicle)).unwrap();
    let run = |t: &Transmission, scheme| wltc(t, &vehicle, &intervals, scheme);
    let (exact, looked_up) = (run(&full, Scheme::Implicit), run(&fast, Scheme::Implicit));
    // The tables are as good as what they stand for.
    assert!((looked_up / exact - 1.0).abs() < 1e-3, "{looked_up} {exact}");
    let mut group = c.benchmark_group("cycle");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(intervals.len() as u64));
    group.bench_function("WLTC, friction solved", |b| {
        b.iter(|| run(&full, Scheme::Implicit));
    });
    group.bench_function("WLTC, friction solved, lagged", |b| {
        b.iter(|| run(&full, Scheme::Lagged));
    });
    group.bench_function("WLTC, friction from tables", |b| {
        b.iter(|| run(&fast, Scheme::Implicit));
    });
    group.bench_function("WLTC, friction from tables, lagged", |b| {
        b.iter(|| run(&fast, Scheme::Lagged));
    });
    group.bench_function("WLTC, friction from tables, with building them", |b| {
        b.iter_batched(
            || build(&tabulated),
            |t| run(&t, Scheme::Implicit),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, cycle);
