//! Duties driven through the electric drive unit: energies, temperatures, schemes, counts, and what is refused.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{self, contact_work, file, language};
use gearloss_framework::contact::path::Path as ContactPath;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::thermal::network::{March, Moment, Passed, Scheme, Stage, StepSize, Surroundings};
use gearloss_framework::transmission::Transmission;
use gearloss_plugins::tooth_friction::ehl_mixed::EhlMixed;
use gearloss_studies::duty::{CycleEntry, Duty, FileCycleEntry, Interval, ShippedCycleEntry, Vehicle, VehicleEntry};
use gearloss_studies::points::{Driven, OilTemperature, Ride, Stretch, can_drive, drive};
use serde_json::json;

const UNIT: &str = "examples/electric-drive-unit/gearbox.yaml";

fn unit(language: &Language) -> Transmission {
    let gearbox = Gearbox::read(language, &file(UNIT)).unwrap();
    gearbox.transmission(language, &Choice::default()).unwrap()
}

/// The vehicle of the example, from the road load of the EPA.
fn vehicle() -> Vehicle {
    let entry = json!({
        "mass": 1928.0, "coast_down": { "a": 165.34, "b": 0.46767, "c": 0.32052 }, "tyre_radius": 0.3357,
        "rotating_mass_factor": 1.04, "regeneration": { "torque": 350.0, "power": 190e3, "fade_speed": 2.0 },
    });
    let entry: VehicleEntry = serde_json::from_value(entry).unwrap();
    entry.vehicle("vehicles.car").unwrap()
}

fn shipped(language: &Language, name: &str) -> Duty {
    let entry = CycleEntry::Shipped(ShippedCycleEntry {
        shipped: name.to_owned(),
        repeat: 1,
        start: None,
        end: None,
    });
    entry.read(language.registry(), |_| Err(String::new())).unwrap()
}

/// Drives from 23 degC.
fn driven(t: &Transmission, duty: &Duty, scheme: Scheme, step: StepSize) -> Driven {
    let intervals = duty.intervals(Some(&vehicle())).unwrap();
    driven_over(t, &intervals, 23.0, scheme, step)
}

fn driven_over(t: &Transmission, intervals: &[Interval], start: f64, scheme: Scheme, step: StepSize) -> Driven {
    driven_by(t, &vehicle(), intervals, start, scheme, step)
}

fn driven_by(
    t: &Transmission,
    vehicle: &Vehicle,
    intervals: &[Interval],
    start: f64,
    scheme: Scheme,
    step: StepSize,
) -> Driven {
    let ride = Ride {
        intervals,
        port: "input",
        vehicle: Some(vehicle),
        gear: &t.states()[0].name,
        choice: None,
        oil: OilTemperature::Network,
        spectrum: false,
        start: Some(start),
        ambient: Some(23.0),
        scheme,
        step,
        flow: PowerFlow::Real,
    };
    drive(t, &ride, &|_| true).unwrap().unwrap()
}

fn loss(driven: &Driven) -> f64 {
    driven.total.parts.iter().sum::<f64>()
}

const SECOND: StepSize = StepSize::Fixed(1.0);

#[test]
fn energy_closes_over_both_cycles_and_in_every_second() {
    let language = language();
    let t = unit(&language);
    for name in ["wltc_class3b", "nycc"] {
        let duty = shipped(&language, name);
        for scheme in [Scheme::Implicit, Scheme::Lagged] {
            let driven = driven(&t, &duty, scheme, SECOND);
            assert!(driven.broken.is_none());
            let total = &driven.total;
            // Asked is 1e-6; what is left is rounding.
            let flow = total.input - total.output - loss(&driven);
            assert!(flow.abs() < 1e-9 * total.input, "{name}: {flow}");
            assert!(
                total.residual().abs() < 1e-9 * total.heat_input(),
                "{name}: {}",
                total.residual()
            );
            for s in &driven.stretches {
                let scale = s.heats.heat_input().max(1.0);
                assert!(
                    s.heats.residual().abs() < 1e-6 * scale,
                    "{name} {}: {}",
                    s.start,
                    s.heats.residual()
                );
                assert!(s.temperatures.iter().all(|t| (22.9..80.0).contains(t)));
            }
        }
    }
}

#[test]
fn shorter_steps_and_adaptive_ones_agree() {
    let language = language();
    let t = unit(&language);
    let duty = shipped(&language, "nycc");
    let whole = driven(&t, &duty, Scheme::Implicit, SECOND);
    let fine = driven(&t, &duty, Scheme::Implicit, StepSize::Fixed(0.125));
    let last = |d: &Driven| d.stretches.last().unwrap().temperatures.clone();
    let farthest = |a: &Driven, b: &Driven| {
        let pairs = last(a).into_iter().zip(last(b));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // A second is short beside all but the time constants of oil in the motor.
    assert!(farthest(&whole, &fine) < 0.05, "{}", farthest(&whole, &fine));
    assert!((loss(&whole) / loss(&fine) - 1.0).abs() < 2e-4);
    let lagged = driven(&t, &duty, Scheme::Lagged, SECOND);
    assert!(farthest(&lagged, &fine) < 0.3 && (loss(&lagged) / loss(&fine) - 1.0).abs() < 2e-3);
    let adaptive = driven(&t, &duty, Scheme::Implicit, StepSize::Adaptive(0.02));
    assert!(farthest(&adaptive, &fine) < 0.05 && adaptive.steps[1] > 0);
    assert!((loss(&adaptive) / loss(&fine) - 1.0).abs() < 2e-4);
}

#[test]
fn the_loss_outside_a_range_is_weighed_by_the_time_of_each_step() {
    let language = language();
    let t = unit(&language);
    let duty = shipped(&language, "wltc_class3b");
    let intervals = duty.intervals(Some(&vehicle())).unwrap();
    let mut long = intervals[1550].clone();
    long.duration = 7200.0;
    let shares = |step: StepSize| {
        let driven = driven_over(&t, std::slice::from_ref(&long), -20.0, Scheme::Implicit, step);
        let total = loss(&driven);
        driven
            .lost_outside
            .iter()
            .map(|lost| lost / total)
            .collect::<Vec<f64>>()
    };
    // Steps grow from a second to half an hour while the oil warms up and ranges are left or entered.
    let (adaptive, fine) = (shares(StepSize::Adaptive(0.5)), shares(StepSize::Fixed(20.0)));
    assert!(fine.iter().any(|share| *share > 0.01 && *share < 0.5), "{fine:?}");
    for (adaptive, fine) in adaptive.iter().zip(&fine) {
        assert!((adaptive - fine).abs() <= 0.02, "{adaptive} {fine}");
    }
}

/// Losses are evaluated at temperatures that are within 0.01 K of those at the end of a step if it is solved alone, and within 0.001 K
/// together with others. Losses change by about 1 % per kelvin at most, so that both agree to 1e-5, and much closer on average.
#[test]
fn intervals_together_are_those_one_by_one() {
    let language = language();
    let t = unit(&language);
    let network = t.network().unwrap();
    let duty = shipped(&language, "nycc");
    let stretches = driven(&t, &duty, Scheme::Implicit, SECOND).stretches;
    let case = t.case(&t.states()[0].name, &["input"], &["input"]).unwrap();
    let points: Vec<Point<'_>> = stretches
        .iter()
        .map(|s| Point {
            speeds: std::slice::from_ref(&s.speed),
            torques: std::slice::from_ref(&s.torque),
            ..Point::default()
        })
        .collect();
    let around: Vec<Surroundings> = stretches
        .iter()
        .map(|s| Surroundings {
            ambient: Some(23.0),
            vehicle_speed: s.vehicle_speed.unwrap(),
            ..Surroundings::default()
        })
        .collect();
    let stages: Vec<Stage<'_>> = (0..points.len())
        .map(|i| Stage {
            moment: Moment {
                case: &case,
                point: &points[i],
                around: &around[i],
            },
            duration: 1.0,
            scratch: 0,
        })
        .collect();
    let start = network.start(Some(23.0), &around[0]);
    let simulated = |most: usize| {
        let mut march = March::new(&t, network, start.clone(), Scheme::Implicit, SECOND);
        let mut scratches = [t.batch_scratch(&case)];
        let mut passed: Vec<Passed> = Vec::new();
        while passed.len() < stages.len() {
            let next = &stages[passed.len()..];
            let some = &next[..most.min(next.len())];
            passed.extend(march.advance_together(some, &mut scratches).unwrap());
        }
        assert_eq!(march.steps(), [stages.len(), 0]);
        let seen: Vec<[u32; 2]> = march.seen().iter().map(|seen| [seen.seen, seen.outside]).collect();
        (passed, seen, march.lost_outside().to_vec())
    };
    let (single, single_seen, single_lost) = simulated(1);
    let (together, seen, lost) = simulated(usize::MAX);
    assert_eq!(single_seen, seen);
    let total = |passed: &[Passed]| passed.iter().flat_map(|p| &p.heats.parts).sum::<f64>();
    assert!((total(&together) / total(&single) - 1.0).abs() < 2e-6);
    for (shared, single) in lost.iter().zip(single_lost) {
        assert!((shared - single).abs() <= 1e-5 * single, "{shared} {single}");
    }
    for (shared, single) in together.iter().zip(&single) {
        let pairs = shared.temperatures.iter().zip(&single.temperatures);
        let farthest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(farthest < 1e-3, "{farthest}");
        assert_eq!(shared.status, single.status);
        assert!(shared.heats.residual().abs() < 1e-6 * shared.heats.heat_input().max(1.0));
    }
}

/// Whether losses bring a torque below the limit of regeneration is decided beforehand where it does not depend on temperature, so that
/// such intervals are solved together with others.
#[test]
fn braking_beyond_regeneration_does_not_divide_a_cycle() {
    let language = language();
    let t = unit(&language);
    let mut vehicle = vehicle();
    vehicle.regeneration = None;
    let duty = shipped(&language, "nycc");
    let intervals = duty.intervals(Some(&vehicle)).unwrap();
    let driven = driven_by(&t, &vehicle, &intervals, 23.0, Scheme::Implicit, SECOND);
    assert!(driven.broken.is_none() && driven.brakes > 0.5e6);
    let total = &driven.total;
    assert!((total.input - total.output - loss(&driven)).abs() < 1e-9 * total.input);
    // No power flows to the source, and what the vehicle does not lose elsewhere heats the brakes.
    assert!(driven.stretches.iter().all(|s| s.torque * s.speed > -1e-9));
    let braked = driven.stretches.iter().filter(|s| s.brakes > 0.0).count();
    assert!(braked > 100, "{braked}");
    // Three or four evaluations of each interval, and one more for each limit.
    assert!(driven.evaluations < 5 * intervals.len(), "{}", driven.evaluations);
}

/// Ways, passes of the inner loop and places of both meshes at a second of a drive.
fn work(t: &Transmission, laws: &[(EhlMixed, ContactPath)], s: &Stretch) -> Vec<(u32, u32, usize)> {
    let case = t.case(&t.states()[0].name, &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[s.speed],
        torques: &[s.torque],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &s.temperatures, &mut scratch);
    contact_work::work(laws, &solution)
}

/// Counts are the same on every machine; they grow only with a reason.
#[test]
fn a_wltc_takes_few_evaluations_and_few_passes() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file(UNIT)).unwrap();
    let resolved = gearbox.resolve(&language, &Choice::default()).unwrap();
    let t = gearbox.build(&language, &resolved).unwrap();
    let driven = driven(&t, &shipped(&language, "wltc_class3b"), Scheme::Implicit, SECOND);
    assert_eq!((driven.stretches.len(), driven.steps), (1800, [1800, 0]));
    // Three evaluations a second, with those of other seconds in lanes: at the temperatures before some 30 seconds, at those that they lead
    // to, and at the corrected ones; a fourth where temperatures change fast. One by one there were two.
    assert_eq!(driven.evaluations, 5847);
    let laws = contact_work::laws(&language, &resolved, &t);
    let mut sum = (0, 0, 0);
    for s in driven.stretches.iter().step_by(10) {
        for (runs, passes, places) in work(&t, &laws, s) {
            sum = (sum.0 + runs, sum.1 + passes, sum.2 + places);
        }
    }
    // With the bodies known there is one way along each path, and some two passes at each of its places.
    assert_eq!((sum.0 as usize) * laws[0].1.len(), sum.2);
    assert_eq!(sum, (312, 18019, 9984));
}

/// Acceleration and grade incline the oil of a housing that says how it travels: each interval has the loss of a point with its inclination,
/// and on a level road at constant speed nothing changes.
#[test]
fn a_cycle_inclines_the_oil_of_a_housing_that_travels() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file(UNIT)).unwrap();
    let choice = Choice {
        overrides: vec![("housing.travel".to_owned(), json!("+y"))],
        ..Choice::default()
    };
    let (level, travels) = (unit(&language), gearbox.transmission(&language, &choice).unwrap());
    assert!(travels.travels() && !level.travels());
    let read = |csv: &str| {
        let entry = FileCycleEntry::named("drive.csv");
        let duty = CycleEntry::File(Box::new(entry));
        duty.read(language.registry(), |_| Ok(csv.as_bytes().to_vec())).unwrap()
    };
    let both = |duty: &Duty| [&level, &travels].map(|t| driven(t, duty, Scheme::Lagged, SECOND));
    let flat = read("time [s],vehicle_speed [km/h],grade [-]\n0,50,0\n1,50,0\n2,50,0\n");
    let [without, with] = both(&flat);
    assert_eq!(without.total.parts, with.total.parts);
    let hills = read("time [s],vehicle_speed [km/h],grade [-]\n0,50,0\n1,60,0\n2,60,0.1\n3,60,0.1\n4,50,0.1\n");
    let intervals = hills.intervals(Some(&vehicle())).unwrap();
    let acceleration = 10.0_f64 / 3.6;
    let expected = [
        (acceleration / 9.80665).atan(),
        0.05_f64.atan(),
        0.1_f64.atan(),
        (0.1 - acceleration / 9.80665 * 0.1_f64.hypot(1.0)).atan(),
    ];
    for (interval, expected) in intervals.iter().zip(expected) {
        assert!(
            (interval.inclination - expected).abs() < 1e-12,
            "{interval:?} {expected}"
        );
    }
    let [without, with] = both(&hills);
    let drag = |t: &Transmission, driven: &Driven, i: usize| {
        let parts = t.parts().iter().zip(&driven.stretches[i].heats.parts);
        let drag = parts
            .filter(|(part, _)| part.mechanism == "gear_drag")
            .map(|(_, joule)| joule);
        drag.sum::<f64>()
    };
    let changes: Vec<f64> = (0..4)
        .map(|i| drag(&travels, &with, i) / drag(&level, &without, i) - 1.0)
        .collect();
    // Uphill and braking move the oil to opposite sides of the gears.
    assert!(changes[0].abs() > 0.01 && changes[0] * changes[3] < 0.0, "{changes:?}");
    let case = travels.case(&travels.states()[0].name, &["input"], &["input"]).unwrap();
    let mut scratch = travels.scratch(&case);
    for (i, (stretch, interval)) in with.stretches.iter().zip(&intervals).enumerate() {
        let before = if i == 0 {
            &with.start
        } else {
            &with.stretches[i - 1].temperatures
        };
        let point = Point {
            speeds: &[stretch.speed],
            torques: &[stretch.torque],
            inclination: interval.inclination,
            ..Point::default()
        };
        let solution = travels.evaluate(&case, &point, before, &mut scratch);
        let parts = solution.parts().filter(|(part, _)| part.mechanism == "gear_drag");
        let watts: f64 = parts.map(|(_, loss)| loss.watts()).sum();
        let expected = drag(&travels, &with, i) / interval.duration;
        assert!((watts / expected - 1.0).abs() < 1e-9, "{i}: {watts} {expected}");
    }
    // An inclination that no vehicle has is an error of the cycle.
    let steep = read("time [s],vehicle_speed [km/h],grade [-]\n0,50,2\n1,50,2\n2,50,2\n");
    let intervals = steep.intervals(Some(&vehicle())).unwrap();
    let vehicle = vehicle();
    let checked = |t: &Transmission| {
        let ride = Ride {
            intervals: &intervals,
            port: "input",
            vehicle: Some(&vehicle),
            gear: &t.states()[0].name,
            choice: None,
            oil: OilTemperature::Network,
            spectrum: false,
            start: None,
            ambient: None,
            scheme: Scheme::Implicit,
            step: SECOND,
            flow: PowerFlow::Real,
        };
        can_drive(t, &ride)
    };
    assert!(checked(&level).is_ok());
    let found = checked(&travels).unwrap_err();
    assert!(found[0].message.contains("63.4 deg at 0 s"), "{found:?}");
}

/// Runs a study of one duty with the drive unit; what it says to standard error.
fn refused(name: &str, cycles: &str, csv: &str, more: &str) -> String {
    let folder: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cycle").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("drive.csv"), csv).unwrap();
    let study = format!(
        "gearloss: study/1\ngearboxes: {{ unit: {} }}\ncycles:\n  own: {cycles}\nanalyses:\n  drive: {{ type: cycle, cycles: [own]{more} }}\n",
        file(UNIT).display()
    );
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .current_dir(&folder)
        .args(["run", "study.yaml"])
        .output()
        .unwrap();
    assert_eq!(
        output.status.code(),
        Some(2),
        "{name}: {}",
        String::from_utf8_lossy(&output.stdout)
    );
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_faulty_file_is_refused_with_its_line() {
    let source = "{ file: drive.csv, columns: { time: t, torque: T_in, speed: n_in } }";
    let trace = "{ file: drive.csv, columns: { time: t, vehicle_speed: v } }";
    let head = "t [s],T_in [Nm],n_in [rpm]\n";
    for (name, cycles, csv, words) in [
        (
            "falls",
            source,
            format!("{head}0,1,100\n2,1,100\n1,1,100\n"),
            ["line 4", "time"],
        ),
        (
            "repeats",
            source,
            format!("{head}0,1,100\n1,1,100\n1,1,100\n"),
            ["line 4", "time"],
        ),
        (
            "gap",
            source,
            format!("{head}0,1,100\n1,1,100\n2,1,100\n3,1,100\n30,1,100\n"),
            ["line 6", "gap"],
        ),
        ("nan", source, format!("{head}0,1,100\n1,NaN,100\n"), ["line 3", "NaN"]),
        (
            "column",
            source,
            "t [s],T_in [Nm]\n0,1\n1,1\n".to_owned(),
            ["n_in", "line 1"],
        ),
        (
            "leap",
            trace,
            "t [s],v [km/h]\n0,0\n1,5\n2,150\n".to_owned(),
            ["line 4", "m/s2"],
        ),
    ] {
        let said = refused(name, cycles, &csv, "");
        for word in words {
            assert!(said.contains(word), "{name}: no `{word}` in {said}");
        }
        assert!(said.contains("help:") && said.contains("study.yaml:"), "{name}: {said}");
    }
}

#[test]
fn what_does_not_fit_together_is_reported() {
    let source = "{ file: drive.csv, columns: { time: t, torque: T_in, speed: n_in }, temperatures: { swamp: T } }";
    let csv = "t [s],T_in [Nm],n_in [rpm],T [degC],v [km/h]\n0,1,100,20,3\n1,1,100,20,3\n2,1,100,20,3\n";
    assert!(refused("node", source, csv, "").contains("no node is called `swamp`"));
    let trace = "{ file: drive.csv, columns: { time: t, vehicle_speed: v } }";
    assert!(refused("vehicle", trace, csv, "").contains("state the `vehicle`"));
    let oil = "{ file: drive.csv, columns: { time: t, torque: T_in, speed: n_in, oil_temperature: T } }";
    assert!(refused("oil", oil, csv, "").contains("which the thermal network computes"));
    let two = "{ file: drive.csv, columns: { time: t, vehicle_speed: v } }\nvehicles:\n  small: { mass: 900 kg, drag_area: 0.5 m2, rolling_resistance: 0.01, tyre_radius: 300 mm, regeneration: none }\n  big: { mass: 1900 kg, drag_area: 0.6 m2, rolling_resistance: 0.01, tyre_radius: 330 mm, regeneration: none }";
    assert!(refused("vehicles", two, csv, "").contains("several vehicles: small, big"));
    let plain = "{ file: drive.csv, columns: { time: t, torque: T_in, speed: n_in } }";
    assert!(refused("both", plain, csv, ", step: 1 s, tolerance: 0.1 K").contains("both `step` and `tolerance`"));
    assert!(refused("terms", plain, csv, ", by: term").contains("by mechanism, component or stage"));
    assert!(refused("elsewhere", plain, csv, ", reference: { wltc: { loss: 1 W } }").contains("`wltc`"));
}

#[test]
fn an_interval_has_the_means_of_its_rows() {
    let language = language();
    let t = unit(&language);
    let mut entry = FileCycleEntry::named("drive.csv");
    entry.columns = serde_json::from_value(json!({ "time": "t", "torque": "T_in", "speed": "n_in" })).unwrap();
    let csv = b"t [s],T_in [Nm],n_in [rpm]\n0,0,0\n1,50,1000\n2,50,1000\n3,0,0\n";
    let duty = CycleEntry::File(Box::new(entry))
        .read(language.registry(), |_| Ok(csv.to_vec()))
        .unwrap();
    let driven = driven(&t, &duty, Scheme::Implicit, SECOND);
    let powers: Vec<f64> = driven.stretches.iter().map(|s| s.heats.input).collect();
    // Means of torque and speed over each second: 25 Nm at 500 rpm, then 50 Nm at 1000 rpm.
    let printed = [25.0 * 500.0, 50.0 * 1000.0, 25.0 * 500.0].map(|x| x * common::RPM);
    for (power, printed) in powers.iter().zip(printed) {
        assert!((power / printed - 1.0).abs() < 1e-12, "{power} {printed}");
    }
}
