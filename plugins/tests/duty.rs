//! Shipped cycles: their check sums, and the duty of each.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::Registry;
use gearloss_plugins as _;
use gearloss_studies::duty::{
    CoastDownEntry, CycleEntry, Demand, Duty, Regeneration, RoadLoad, STANDARD_GRAVITY, ShippedCycleEntry, Trace,
    Vehicle, input_torque,
};

fn cycle(name: &str) -> Result<Trace, String> {
    let entry = CycleEntry::Shipped(ShippedCycleEntry {
        shipped: name.to_owned(),
        repeat: 1,
        start: None,
        end: None,
    });
    let registry = Registry::linked().unwrap();
    match entry.read(&registry, |_| Err("no file".to_owned())) {
        Ok(Duty::Trace(trace)) => Ok(trace),
        Ok(Duty::Spectrum(_)) => Err("a spectrum".to_owned()),
        Err(faults) => Err(format!("{} | {}", faults[0].message, faults[0].help)),
    }
}

fn speeds(trace: &Trace) -> Vec<f64> {
    trace
        .samples
        .iter()
        .map(|s| s.given.vehicle_speed.unwrap() * 3.6)
        .collect()
}

fn distance(trace: &Trace) -> f64 {
    trace
        .samples
        .windows(2)
        .map(|p| {
            let [a, b] = [&p[0], &p[1]].map(|s| s.given.vehicle_speed.unwrap());
            f64::midpoint(a, b) * (p[1].time - p[0].time)
        })
        .sum()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs()
}

#[test]
fn the_check_sums_of_the_regulations_are_met() {
    for (name, rows, sum, metres, most) in [
        ("wltc_class3b", 1801, Some(83758.6), 23266.28, 131.3),
        ("wltc_class3a", 1801, Some(83496.9), 23193.58, 131.3),
        ("nycc", 599, None, 1898.445, 44.5788),
        ("udds", 1370, None, 11990.24, 91.2498),
        ("hwfet", 766, None, 16506.55, 96.3997),
        ("us06", 601, None, 12887.58, 129.2303),
    ] {
        let trace = cycle(name).unwrap();
        let speeds = speeds(&trace);
        assert_eq!(trace.samples.len(), rows, "{name}");
        if let Some(sum) = sum {
            assert!(close(speeds.iter().sum(), sum), "{name}");
        }
        assert!(close(distance(&trace), metres), "{name} {}", distance(&trace));
        let greatest = speeds.iter().copied().fold(0.0, f64::max);
        assert!(close(greatest, most), "{name} {greatest}");
        assert_eq!((speeds[0], speeds[rows - 1]), (0.0, 0.0), "{name}");
    }
    // Lengths of the phases as published, to the metre.
    let trace = cycle("wltc_class3b").unwrap();
    for (from, to, metres) in [
        (0, 589, 3095.0),
        (589, 1022, 4756.0),
        (1022, 1477, 7162.0),
        (1477, 1800, 8254.0),
    ] {
        let phase = Trace {
            samples: trace.samples[from..=to].to_vec(),
            ..Trace::default()
        };
        assert!((distance(&phase) - metres).abs() < 0.6, "{from} {}", distance(&phase));
    }
}

/// Duty of a cycle at the motor: energies out of it and into it, root mean square of its torque, maximum and mean speed.
fn duty(name: &str) -> [f64; 5] {
    let car = Vehicle {
        mass: 1928.0,
        road_load: RoadLoad::CoastDown(CoastDownEntry {
            a: 165.3404,
            b: 0.467_668_3,
            c: 0.320_520_7,
        }),
        tyre_radius: 0.3357,
        rotating_mass_factor: 1.04,
        inertia: None,
        gravity: STANDARD_GRAVITY,
        regeneration: Some(Regeneration {
            torque: 350.0,
            power: 190e3,
            fade_speed: 2.0,
        }),
        efficiency: Some(0.97),
    };
    let ratio = 9.036_290_3;
    let (mut driven, mut regained, mut squares, mut fastest, mut turns, mut time) = (0.0, 0.0, 0.0, 0.0_f64, 0.0, 0.0);
    for interval in cycle(name).unwrap().intervals(Some(&car)).unwrap() {
        time += interval.duration;
        let Demand::Wheel { torque, speed, .. } = interval.demand else {
            assert_eq!(interval.demand, Demand::Rest);
            continue;
        };
        let speed = speed * ratio;
        let torque = input_torque(torque, ratio, car.efficiency.unwrap());
        let torque = car.regained(torque, speed, interval.given.vehicle_speed.unwrap());
        let energy = torque * speed * interval.duration;
        if energy > 0.0 {
            driven += energy;
        } else {
            regained += energy;
        }
        squares += torque * torque * interval.duration;
        fastest = fastest.max(speed);
        turns += speed * interval.duration;
    }
    let rpm = 30.0 / std::f64::consts::PI;
    [
        driven / 1e3,
        regained / 1e3,
        (squares / time).sqrt(),
        fastest * rpm,
        turns / time * rpm,
    ]
}

#[test]
fn u7d_duties_of_an_electric_sedan() {
    for (name, expected) in [
        ("wltc_class3b", [12980.35, -4540.338, 40.90644, 9371.455, 3322.497]),
        ("nycc", [1414.195, -984.7493, 50.70381, 3177.252, 816.0316]),
        ("udds", [6284.920, -3099.154, 47.41083, 6515.378, 2251.306]),
        ("hwfet", [6901.648, -1022.861, 25.85953, 6883.089, 5546.322]),
        ("us06", [9397.342, -3532.167, 75.41480, 9227.245, 5521.161]),
    ] {
        for (got, expected) in duty(name).into_iter().zip(expected) {
            assert!(close(got, expected), "{name}: {got} {expected}");
        }
    }
}

#[test]
fn an_unknown_cycle_finds_its_neighbour() {
    assert_eq!(
        cycle("wltc_class_3b").unwrap_err(),
        "there is no cycle `wltc_class_3b` | write `wltc_class3b`"
    );
}

#[test]
fn two_cycles_of_one_name_are_refused() {
    let registry = Registry::linked().unwrap();
    let names: Vec<&str> = registry.cycles().iter().map(|c| c.name).collect();
    assert_eq!(names, ["hwfet", "nycc", "udds", "us06", "wltc_class3a", "wltc_class3b"]);
    let again = *registry.cycle("nycc").unwrap();
    let found: Vec<Diagnostic> = registry.with_cycles([again]).err().unwrap();
    assert_eq!(found[0].message, "two registrations of the cycle `nycc`");
}
