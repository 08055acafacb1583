//! Gears chosen in cycles: the rule against brute force, the optimum, maps, shifts, and what is refused.

use serde_json::{Value, json};

use crate::common::study::{Ran, number, run_texts};
use crate::common::{file, language, two_speed_with};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::machine::Machine;
use gearloss_framework::motor::MotorMap;
use gearloss_framework::thermal::network::{Scheme, StepSize};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::duty::{CycleEntry, Demand, Interval, ShippedCycleEntry, Vehicle, VehicleEntry};
use gearloss_studies::points::{Choosing, ChosenBy, Driven, GearChoice, OilTemperature, Ride, Rule, drive};

/// A small car, with a rotor of 0.006 kg m2 if its inertia is stated.
fn car(inertia: bool) -> Vehicle {
    let mut entry = json!({
        "mass": 1400.0, "drag_area": 0.55, "rolling_resistance": 0.009, "tyre_radius": 0.31,
        "regeneration": { "torque": 40.0, "power": 40e3, "fade_speed": 2.0 },
    });
    if inertia {
        entry["inertia"] = json!({ "wheels": 2.8, "rotor": 0.006 });
    }
    let entry: VehicleEntry = serde_json::from_value(entry).unwrap();
    entry.vehicle("vehicles.car").unwrap()
}

fn intervals(name: &str, vehicle: &Vehicle, part: Option<[f64; 2]>) -> Vec<Interval> {
    let entry = CycleEntry::Shipped(ShippedCycleEntry {
        shipped: name.to_owned(),
        repeat: 1,
        start: part.map(|[start, _]| start),
        end: part.map(|[_, end]| end),
    });
    let duty = entry.read(language().registry(), |_| Err(String::new())).unwrap();
    duty.intervals(Some(vehicle)).unwrap()
}

fn choice(by: ChosenBy) -> GearChoice {
    GearChoice {
        by,
        among: Vec::new(),
        shift_energy: None,
        actuation: 0.0,
        most_speed: None,
        most_torque: None,
        place: "analyses.c.gear".to_owned(),
    }
}

fn rule(saving: f64, dwell: f64) -> ChosenBy {
    ChosenBy::Rule(Rule { saving, dwell })
}

/// A ride in a gear.
fn ride<'a>(t: &Transmission, (vehicle, intervals): (&'a Vehicle, &'a [Interval]), gear: &'a str) -> Ride<'a> {
    Ride {
        intervals,
        port: "input",
        vehicle: Some(vehicle),
        gear,
        choice: None,
        oil: OilTemperature::from_conditions(t, None),
        spectrum: false,
        start: Some(25.0),
        ambient: Some(20.0),
        scheme: Scheme::default(),
        step: StepSize::Fixed(1.0),
        flow: PowerFlow::Real,
    }
}

/// A cycle in a gear, or with a choice and a machine.
fn driven(
    t: &Transmission,
    (vehicle, intervals): (&Vehicle, &[Interval]),
    gear: &str,
    choice: Option<(&GearChoice, Option<&Machine>)>,
) -> Driven {
    let ride = Ride {
        choice: choice.map(|(choice, machine)| Choosing { choice, machine }),
        ..ride(t, (vehicle, intervals), gear)
    };
    let driven = drive(t, &ride, &|_| true).unwrap().unwrap();
    assert!(driven.broken.is_none());
    driven
}

fn shifts(driven: &Driven) -> usize {
    driven
        .stretches
        .iter()
        .filter(|stretch| stretch.shift.is_some())
        .count()
}

fn machine() -> Machine {
    let bytes = std::fs::read(file("examples/two-speed-ev/machine.csv")).unwrap();
    Machine::of_map("machine", (0, 0), MotorMap::read(&bytes).unwrap())
}

/// At a given temperature the momentary best gear draws what the better of two whole runs draws, second by second, to the bit.
#[test]
fn the_best_gear_is_that_of_brute_force_at_a_given_temperature() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let map = machine();
    for (machine, with_inertia) in [(None, false), (Some(&map), false), (Some(&map), true)] {
        let vehicle = car(with_inertia);
        let intervals = intervals("nycc", &vehicle, Some([20.0, 320.0]));
        let of_gear = |gear: &str| driven(&t, (&vehicle, &intervals), gear, None);
        let both = [of_gear("first"), of_gear("second")];
        let best = driven(
            &t,
            (&vehicle, &intervals),
            "first",
            Some((&choice(rule(0.0, 0.0)), machine)),
        );
        let drawn = |driven: &Driven, i: usize| {
            let stretch = &driven.stretches[i];
            match machine {
                Some(map) => {
                    let power = stretch.torque * stretch.speed;
                    power + map.loss(stretch.speed, stretch.torque, stretch.temperatures[0]).sum()
                }
                None => stretch.heats.parts.iter().sum::<f64>() / stretch.heats.duration,
            }
        };
        let mut used = [0, 0];
        for i in 0..intervals.len() {
            // Gears beyond the border of the machine's map are left out.
            let excess = |run: &Driven| {
                let stretch = &run.stretches[i];
                let map = machine.and_then(Machine::map);
                map.map_or(0.0, |map| map.excess(stretch.speed, stretch.torque))
            };
            let smallest = excess(&both[0]).min(excess(&both[1]));
            let allowed = both.iter().filter(|run| excess(run) <= smallest);
            let least = allowed.map(|run| drawn(run, i)).fold(f64::INFINITY, f64::min);
            assert!(
                (drawn(&best, i) - least).abs() <= 1e-9 * least.abs().max(1.0),
                "interval {i}: {} {least}",
                drawn(&best, i)
            );
            used[best.stretches[i].gear.min(1)] += 1;
        }
        if machine.is_some() {
            assert!(used.iter().all(|count| *count > 20), "{used:?}");
        }
    }
}

/// With a thermal network the gear of each second is the better one at the temperatures at its start.
#[test]
fn the_best_gear_is_that_of_brute_force_at_the_temperatures_of_a_network() {
    let language = language();
    let overrides = [
        ("housing.outside", json!({ "box": ["400 mm", "250 mm", "300 mm"] })),
        ("thermal", json!({ "mode": "network", "network": "auto" })),
    ];
    let t = two_speed_with(&language, None, &overrides);
    let vehicle = car(false);
    let intervals = intervals("nycc", &vehicle, Some([20.0, 320.0]));
    let best = driven(
        &t,
        (&vehicle, &intervals),
        "first",
        Some((&choice(rule(0.0, 0.0)), None)),
    );
    assert!(best.stretches[0].temperatures.len() > 1);
    let cases = ["first", "second"].map(|gear| t.case(gear, &["output"], &["output"]).unwrap());
    let mut compared = 0;
    for (i, interval) in intervals.iter().enumerate() {
        let Demand::Wheel { torque, speed, .. } = interval.demand else {
            continue;
        };
        if torque <= 0.0 {
            continue;
        }
        let before = if i == 0 {
            &best.start
        } else {
            &best.stretches[i - 1].temperatures
        };
        let losses = [0, 1].map(|gear| {
            let mut scratch = t.scratch(&cases[gear]);
            let ratio = t.speeds(&cases[gear], &[1.0])[t.ports()[t.reference_port()].member];
            let point = Point {
                speeds: &[speed * ratio.signum()],
                torques: &[-torque * ratio.signum()],
                ..Point::default()
            };
            t.evaluate(&cases[gear], &point, before, &mut scratch).loss().unwrap()
        });
        let least = usize::from(losses[1] < losses[0]);
        assert_eq!(best.stretches[i].gear, least, "interval {i}: {losses:?}");
        compared += 1;
    }
    assert!(compared > 80, "{compared}");
}

#[test]
fn saving_and_dwell_never_add_shifts_in_a_cycle() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let map = machine();
    let vehicle = car(true);
    let intervals = intervals("nycc", &vehicle, None);
    let count = |saving: f64, dwell: f64| {
        let by = choice(rule(saving, dwell));
        shifts(&driven(&t, (&vehicle, &intervals), "first", Some((&by, Some(&map)))))
    };
    let free = count(0.0, 0.0);
    assert!(free > 20, "{free}");
    for (saving, dwell) in [(50.0, 0.0), (300.0, 0.0), (0.0, 3.0), (100.0, 5.0), (1e9, 0.0)] {
        let with = count(saving, dwell);
        assert!(with <= free, "{saving} W, {dwell} s: {with} instead of {free}");
    }
    assert_eq!(count(1e9, 0.0), 0);
}

/// At a given temperature the frozen temperatures are the real ones: the energies of the comparison are those of the runs.
#[test]
fn the_optimum_is_never_worse_than_the_rule_and_states_the_gap() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let map = machine();
    let vehicle = car(true);
    let intervals = intervals("nycc", &vehicle, Some([20.0, 320.0]));
    for energy in [None, Some(0.0), Some(2000.0)] {
        let hysteresis = Rule {
            saving: 200.0,
            dwell: 3.0,
        };
        let with = |by: ChosenBy| GearChoice {
            shift_energy: energy,
            ..choice(by)
        };
        let run = |by: ChosenBy| driven(&t, (&vehicle, &intervals), "first", Some((&with(by), Some(&map))));
        let (by_rule, best) = (run(ChosenBy::Rule(hysteresis)), run(ChosenBy::Optimum(hysteresis)));
        let total = |driven: &Driven| -> f64 {
            let of = |s: &gearloss_studies::points::Stretch| {
                let power = s.torque * s.speed + map.loss(s.speed, s.torque, s.temperatures[0]).sum();
                power * s.heats.duration + s.shift.map_or(0.0, |shift| shift.heat - shift.released)
            };
            driven.stretches.iter().map(of).sum()
        };
        let optimum = best.optimum.unwrap();
        assert!(optimum.energy <= optimum.rule_energy, "{optimum:?}");
        for (found, stated) in [(total(&best), optimum.energy), (total(&by_rule), optimum.rule_energy)] {
            assert!((found - stated).abs() < 1e-9 * stated.abs(), "{found} {stated}");
        }
        assert_eq!(optimum.rule_shifts, shifts(&by_rule));
        assert!(by_rule.optimum.is_none());
    }
}

/// F3 of the kinetic energies: 0.05 kg m2 from 1000 to 583.33 rad/s dissipate 4340.28 J and release 16493.06 J.
#[test]
fn the_energy_of_a_shift_is_that_of_synchronising_the_rotor() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let vehicle = car(true);
    let intervals = intervals("nycc", &vehicle, Some([20.0, 320.0]));
    let map = machine();
    let driven = driven(
        &t,
        (&vehicle, &intervals),
        "first",
        Some((&choice(rule(0.0, 0.0)), Some(&map))),
    );
    let ratios = ["first", "second"].map(|gear| {
        let case = t.case(gear, &["output"], &["output"]).unwrap();
        t.speeds(&case, &[1.0])[t.ports()[t.reference_port()].member].abs()
    });
    let mut found = 0;
    for (pair, interval) in driven.stretches.windows(2).zip(&intervals[1..]) {
        let Some(shift) = pair[1].shift else { continue };
        let Demand::Wheel {
            speed, acceleration, ..
        } = interval.demand
        else {
            continue;
        };
        let wheels = (speed - 0.5 * acceleration * interval.duration / vehicle.tyre_radius).max(0.0);
        let [before, after] = [pair[0].gear, pair[1].gear].map(|gear| ratios[gear] * wheels);
        let heat = 0.5 * 0.006 * (before - after).powi(2);
        let released = 0.5 * 0.006 * (before * before - after * after);
        assert!((shift.heat - heat).abs() <= 1e-9 * heat.max(1.0), "{shift:?} {heat}");
        assert!((shift.released - released).abs() <= 1e-9 * released.abs().max(1.0));
        found += usize::from(heat > 0.0);
    }
    assert!(found > 10, "{found}");
}

/// The example's gearbox in a study with a cycle, and its vehicle.
fn study(gear: &str, cycle: &str, more: &str) -> String {
    format!(
        "gearloss: study/1
gearboxes: {{ box: {} }}
conditions: {{ oil_temperature: 60 degC }}
cycles: {{ c: {cycle} }}
vehicles:
  car:
    mass: 1400 kg
    drag_area: 0.55 m2
    rolling_resistance: 0.009
    tyre_radius: 310 mm
    inertia: {{ wheels: 2.8 kg m2, rotor: 0.006 kg m2 }}
    regeneration: {{ torque: 40 Nm, power: 40 kW }}
    motor_map: {}
    battery: {{ energy: 30 kWh, efficiency: 0.95, auxiliaries: 300 W }}
analyses: {{ c: {{ type: cycle, cycles: [c], gear: {gear}{more} }} }}
",
        file("examples/two-speed-ev/gearbox.yaml").display(),
        file("examples/two-speed-ev/machine.csv").display(),
    )
}

const TOWN: &str = "{ shipped: nycc, start: 20 s, end: 320 s }";

fn ran(gear: &str, cycle: &str, files: &[(&str, &str)]) -> Ran {
    let ran = run_texts(&study(gear, cycle, ""), files);
    assert!(ran.succeeded, "{}", ran.text);
    ran
}

#[test]
fn results_state_time_energy_and_shifts() {
    let ran = ran(
        "{ choose: best, saving: 100 W, dwell: 2 s, actuation: 20 J }",
        TOWN,
        &[],
    );
    let duty = &ran.json("c")["cycles"][0];
    let gears = &duty["gears_used"];
    assert_eq!(gears["criterion"], "machine_power");
    let sum = |key: &str| -> f64 { gears["gears"].as_array().unwrap().iter().map(|g| number(&g[key])).sum() };
    for key in ["time_share", "input_share", "loss_share"] {
        assert!((sum(key) - 1.0).abs() < 1e-12, "{key}");
    }
    assert!((sum("time_s") - number(&duty["duration_s"])).abs() < 1e-9);
    assert!((sum("loss_j") - number(&duty["energy"]["loss_j"])).abs() < 1e-6);
    // The balance of battery, wheels, losses, brakes, auxiliaries and shifts closes.
    let consumption = &duty["consumption"];
    assert!(number(&consumption["residual_share"]) < 1e-12, "{consumption}");
    assert!(number(&consumption["shifts_kwh_per_100_km"]) > 0.0);
    let csv = ran.csv("c");
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let column = head.iter().position(|name| *name == "gear").unwrap();
    let gear_of = |line: &str| line.split(',').nth(column).unwrap().to_owned();
    let lines: Vec<String> = csv.lines().skip(1).map(gear_of).collect();
    let first = lines.iter().filter(|gear| *gear == "first").count();
    let stated = gears["gears"][0]["time_s"].as_f64().unwrap();
    assert!((first as f64 - stated).abs() < 1e-9, "{first} {stated}");
    for words in [
        "gears: the best gear of the moment, if a shift saves more than 100 W",
        " shifts",
    ] {
        assert!(ran.text.contains(words), "{}", ran.text);
    }
}

#[test]
fn a_map_states_the_gears() {
    let map = "speed [rpm],torque [Nm],gear\n0,-5000,first\n0,0,first\n200,-5000,second\n200,0,first\n";
    let ran = ran("{ map: shift.csv }", TOWN, &[("shift.csv", map)]);
    let gears = &ran.json("c")["cycles"][0]["gears_used"];
    assert_eq!(gears["criterion"], Value::Null);
    assert!(number(&gears["shifts"]) > 3.0);
    // Only braking above 200 rpm uses the second gear.
    assert!(number(&gears["gears"][1]["time_share"]) < 0.4);
}

#[test]
fn limits_shift_at_once_and_are_counted() {
    // 60 km/h are 13.3 times 60/3.6/0.31 rad/s: the first gear turns the input at 11200 rpm.
    let ran = ran(
        "{ choose: best, saving: 100 kW, most_speed: 6000 rpm }",
        "{ shipped: udds, start: 160 s, end: 340 s }",
        &[],
    );
    let gears = &ran.json("c")["cycles"][0]["gears_used"];
    assert!(number(&gears["forced_shifts"]) > 0.0, "{gears}");
    assert!(number(&gears["intervals_beyond_limits"]) > 0.0, "{gears}");
}

/// Loads without an order in time have a best gear each, and no shifts.
#[test]
fn a_spectrum_has_the_best_gear_of_each_load() {
    let cycle = "{ spectrum: [{ torque: -300 Nm, speed: 100 rpm, share: 0.5 }, { torque: -40 Nm, speed: 1000 rpm, share: 0.5 }], port: output }";
    let ran = ran("best", cycle, &[]);
    let gears = &ran.json("c")["cycles"][0]["gears_used"];
    assert_eq!(gears["shifts"], Value::Null);
    assert!(!gears["gears"].as_array().unwrap().is_empty());
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    let map = "speed [rpm],torque [Nm],gear\n0,0,first\n100,0,third\n";
    let table = "time [s],torque [Nm],speed [rpm]\n0,10,1000\n1,10,1000\n2,10,1000\n";
    let cases = [
        ("third", TOWN, "no gear state is called `third`"),
        ("{ saving: 10 W }", TOWN, "needs either `choose` or `map`"),
        (
            "{ choose: best, map: shift.csv }",
            TOWN,
            "needs either `choose` or `map`",
        ),
        (
            "{ map: shift.csv, saving: 10 W }",
            TOWN,
            "`saving` has no effect beside `map`",
        ),
        (
            "{ map: shift.csv }",
            TOWN,
            "line 3: the gearbox has no gear state `third`",
        ),
        ("{ map: none.csv }", TOWN, "cannot read none.csv"),
        (
            "{ choose: best, gears: [first, neutral] }",
            TOWN,
            "`neutral` cannot be chosen",
        ),
        ("{ choose: best, gears: [first, third] }", TOWN, "third"),
        ("best", "{ file: rig.csv }", "they already depend on the gear"),
    ];
    for (gear, cycle, message) in cases {
        let files = [("shift.csv", map), ("rig.csv", table)];
        let ran = run_texts(&study(gear, cycle, ""), &files);
        assert!(!ran.succeeded, "{gear}");
        assert!(ran.text.contains(message), "{gear}: {}", ran.text);
    }
}

/// Without the time of a thermal network the temperatures of an interval in a gear are those of its simulation: at given temperatures and at
/// those of an equilibrium, the evaluation that chooses a gear is the interval, to the bit.
#[test]
fn each_gear_is_evaluated_once_where_its_temperatures_are_those_of_the_interval() {
    let language = language();
    let vehicle = car(true);
    let network = [
        ("housing.outside", json!({ "box": ["400 mm", "250 mm", "300 mm"] })),
        ("thermal", json!({ "mode": "network", "network": "auto" })),
    ];
    // Loads of a spectrum are each at the steady state of the network.
    for (overrides, spectrum, part) in [
        (&network[..0], false, [20.0, 320.0]),
        (&network[..], true, [20.0, 80.0]),
    ] {
        let t = two_speed_with(&language, None, overrides);
        let intervals = intervals("nycc", &vehicle, Some(part));
        let by = choice(rule(0.0, 0.0));
        let run = |gear: &str, choice: Option<&GearChoice>| {
            let ride = Ride {
                choice: choice.map(|choice| Choosing { choice, machine: None }),
                spectrum,
                ..ride(&t, (&vehicle, &intervals), gear)
            };
            drive(&t, &ride, &|_| true).unwrap().unwrap()
        };
        let both = ["first", "second"].map(|gear| run(gear, None));
        let best = run("first", Some(&by));
        assert!(best.broken.is_none() && best.stretches.len() == intervals.len());
        for (i, stretch) in best.stretches.iter().enumerate() {
            let alone = &both[stretch.gear.min(1)].stretches[i];
            // Equal numbers have equal bits, except the sign of zero.
            assert_eq!(stretch.temperatures, alone.temperatures, "{i}");
            assert_eq!(stretch.torque, alone.torque, "{i}");
            assert_eq!(stretch.heats, alone.heats, "{i}");
            assert_eq!(stretch.status, alone.status, "{i}");
        }
        if !spectrum {
            // Nothing is noted of a gear that is not chosen.
            let with_gears = |(interval, stretch): (&Interval, &gearloss_studies::points::Stretch)| {
                let mut interval = interval.clone();
                interval.given.gear = Some(t.states()[stretch.gear].name.clone());
                interval
            };
            let intervals: Vec<Interval> = intervals.iter().zip(&best.stretches).map(with_gears).collect();
            let ride = ride(&t, (&vehicle, &intervals), "first");
            let stated = drive(&t, &ride, &|_| true).unwrap().unwrap();
            assert_eq!(best.seen, stated.seen);
            assert_eq!(best.lost_outside, stated.lost_outside);
        }
        // Standing intervals are evaluated once. At an equilibrium a demand that regeneration may limit is solved again with its limit.
        let is_standing = |interval: &&Interval| interval.demand == Demand::Rest;
        let standing = intervals.iter().filter(is_standing).count();
        let sum = both[0].evaluations + both[1].evaluations;
        if spectrum {
            assert!(
                best.evaluations as f64 <= 1.3 * sum as f64,
                "{} of {sum}",
                best.evaluations
            );
        } else {
            assert!(best.evaluations <= sum - standing, "{} of {sum}", best.evaluations);
            assert!(best.evaluations >= 2 * (intervals.len() - standing));
        }
    }
}

/// With a thermal network the choice adds one evaluation of each gear to the steps: less than another run.
#[test]
fn the_best_gear_costs_less_than_a_run_per_gear() {
    let language = language();
    let overrides = [
        ("housing.outside", json!({ "box": ["400 mm", "250 mm", "300 mm"] })),
        ("thermal", json!({ "mode": "network", "network": "auto" })),
    ];
    let t = two_speed_with(&language, None, &overrides);
    let map = machine();
    let vehicle = car(true);
    let intervals = intervals("wltc_class3b", &vehicle, None);
    let evaluations = |gear: &str, choice: Option<(&GearChoice, Option<&Machine>)>| {
        driven(&t, (&vehicle, &intervals), gear, choice).evaluations
    };
    let sum = evaluations("first", None) + evaluations("second", None);
    let by = choice(rule(200.0, 3.0));
    let best = evaluations("first", Some((&by, Some(&map))));
    assert!(best as f64 <= 1.3 * sum as f64, "{best} of {sum}");
}

/// Whatever simulates cycles chooses the gears of the cycle alone: sweeps, comparisons, searches, oils, bands.
#[test]
fn every_analysis_of_cycles_chooses_the_same_gears() {
    let oil = "lubricants.sump.viscosity.kv100";
    for gear in [
        "best",
        "{ choose: best, saving: 100 W, dwell: 2 s }",
        "{ choose: optimum }",
    ] {
        let ride = format!("gear: {gear}, cycles: [c]");
        let beside = format!("gear: {gear}, drive: {{ cycles: [c] }}");
        let analyses = format!(
            "analyses:
  swept: {{ type: sweep, gearbox: box, {beside}, path: {oil}, values: [6.4 mm2/s, 5 mm2/s] }}
  compared: {{ type: compare, gearbox: box, {beside}, base: own, variants: {{ thin: {{ {oil}: 5 mm2/s }} }} }}
  found: {{ type: optimise, gearbox: box, {ride}, variables: {{ oil: {{ path: {oil}, values: [6.4 mm2/s, 5 mm2/s] }} }} }}
  oils: {{ type: fluid_sweep, gearbox: box, {ride}, kv100: [5 mm2/s, 6.4 mm2/s, 8 mm2/s], refine: false }}
  thin: {{ type: cycle, {ride}, gearbox: thin }}
  banded: {{ type: cycle, gearbox: box, {ride}, samples: 8, inputs: [{{ path: {oil}, from: 5 mm2/s, to: 6.4 mm2/s }}] }}
  c: {{ type: cycle, gearbox: box, {ride} }}
"
        );
        let text = study(gear, "{ shipped: nycc, start: 20 s, end: 120 s }", "");
        let (head, _) = text.split_once("analyses:").unwrap();
        let head = head.replace("gearboxes: { ", "gearboxes: { thin: thin.yaml, ");
        let thin = format!(
            "gearloss: gearbox/1\nextends: {}\nset: {{ {oil}: 5 mm2/s }}\n",
            file("examples/two-speed-ev/gearbox.yaml").display()
        );
        let ran = run_texts(&(head + &analyses), &[("thin.yaml", &thin)]);
        assert!(ran.succeeded, "{}", ran.text);
        let net = |of: &Value| number(&of["consumption"]["consumption_kwh_per_100_km"]).to_bits();
        let alone = ["c", "thin"].map(|name| ran.json(name)["cycles"][0].clone());
        let [present, thin] = [net(&alone[0]), net(&alone[1])];
        assert_ne!(present, thin);
        let swept = ran.json("swept");
        assert_eq!([net(&swept["cycles"][0]), net(&swept["cycles"][1])], [present, thin]);
        let compared = &ran.json("compared")["comparisons"][0];
        assert_eq!(net(compared), thin, "{compared}");
        let gain = &ran.json("found")["gains"][0];
        let of_search = |key: &str| number(&gain["consumption"][key]["consumption_kwh_per_100_km"]).to_bits();
        assert_eq!(of_search("present"), present, "{gain}");
        let least = f64::from_bits(present).min(f64::from_bits(thin));
        assert_eq!(f64::from_bits(of_search("best")), least);
        let oils = &ran.json("oils")["fluid_sweep"][0]["cycles"][0];
        assert_eq!(net(&oils["present"]), present);
        let least = oils["fluids"].as_array().unwrap().iter();
        let least = least
            .map(|fluid| f64::from_bits(net(fluid)))
            .fold(f64::INFINITY, f64::min);
        assert_eq!(number(&oils["least_consumption"]["consumption_kwh_per_100_km"]), least);
        let banded = &ran.json("banded")["cycles"][0];
        assert_eq!(net(banded), present);
        let band = banded["bands"]["consumption_kwh_per_100_km"].as_array().unwrap();
        let [low, high] = [0, 2].map(|i| number(&band[i]));
        let ends = [present, thin].map(f64::from_bits);
        assert!(
            low >= ends[0].min(ends[1]) - 1e-9 && high <= ends[0].max(ends[1]) + 1e-9,
            "{band:?} {ends:?}"
        );
        for gears in [banded, &alone[0]] {
            assert_eq!(gears["gears_used"]["shifts"], alone[0]["gears_used"]["shifts"]);
        }
    }
}

/// Points have no time in which to shift.
#[test]
fn a_sweep_over_points_refuses_a_choice() {
    let text = study("first", TOWN, "");
    let (head, _) = text.split_once("analyses:").unwrap();
    let oil = "path: lubricants.sump.viscosity.kv100, values: [5 mm2/s, 6 mm2/s]";
    let analyses = format!("analyses: {{ s: {{ type: sweep, gear: best, {oil}, torque: 5 Nm, speed: 3000 rpm }} }}");
    let ran = run_texts(&(head.to_owned() + &analyses), &[]);
    assert!(!ran.succeeded);
    assert!(ran.text.contains("gears are chosen in cycles and maps"), "{}", ran.text);
}
