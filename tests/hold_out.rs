//! Rows held out of an identification: which they are, what is predicted of them, and how often bands hold what they promise.
#![allow(clippy::print_stdout, reason = "the documentation quotes the table of coverage")]

use std::fmt::Write as _;
use std::path::Path;
use std::sync::LazyLock;

use crate::common::rig::Normal;
use crate::common::study::{Ran, run_texts};
use crate::common::{RPM, language};
use gearloss::api::InMemory;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_numerics::inference::{Coverage, Widening, succession};
use gearloss_studies::identify::{HoldOut, Identification, Settings};
use gearloss_studies::measured::MeasuredEntry;
use gearloss_studies::points::{Rows, levels};
use gearloss_studies::study::{HoldOutEntry, HoldOutRows, IdentifiedEntry, Quantity, ScaleEntry};
use serde_json::{Value, json};

/// One stage, small enough for thousands of evaluations.
const GEARBOX: &str = "gearloss: gearbox/1
title: One stage
ports: { input: pinion_shaft, output: wheel_shaft }
shafts:
  pinion_shaft: { axis: [0 mm, 0 mm] }
  wheel_shaft: { axis: [90 mm, 0 mm] }
gears:
  pinion: { shaft: pinion_shaft, at: 30 mm, z: 20, facewidth: 24 mm }
  wheel: { shaft: wheel_shaft, at: 30 mm, z: 70, facewidth: 22 mm }
meshes:
  stage: { gears: [pinion, wheel], normal_module: 2 mm }
surface: { ra: 0.4 um }
bearings:
  P1: { shaft: pinion_shaft, at: 0 mm, designation: \"6205\" }
  P2: { shaft: pinion_shaft, at: 60 mm, designation: \"6205\" }
  W1: { shaft: wheel_shaft, at: 0 mm, designation: \"6206\" }
  W2: { shaft: wheel_shaft, at: 60 mm, designation: \"6206\" }
seals:
  D1: { shaft: pinion_shaft, diameter: 25 mm, kind: radial_lip }
lubricants:
  oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s }, density: { value: 850 kg/m3, at: 15 degC } }
housing:
  oil: { lubricant: oil, volume: 0.8 l, level: -50 mm, measured_from: wheel_shaft }
thermal: { mode: fixed, oil: 80 degC }
models:
  gear_mesh: { type: iso14179_2 }
  gear_drag: { churning: none }
  bearing: { type: iso14179_2 }
  seal: { type: iso14179_2 }
";

const TORQUES: [f64; 6] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0];
const SPEEDS: [f64; 6] = [500.0, 1000.0, 2000.0, 3000.0, 4500.0, 6000.0];
/// What the points hide.
const TRUTH: [(&str, f64); 3] = [
    ("meshes.stage.loss_factor", 1.2),
    ("lubricants.oil.viscosity.factor", 0.8),
    ("seals.D1.loss_factor", 1.3),
];

fn gearbox(language: &Language) -> Gearbox {
    let files = InMemory::default().shared();
    let gearbox = Gearbox::from_text(language, &files, GEARBOX, "gearbox.yaml", Path::new(""));
    gearbox.unwrap_or_else(|f| panic!("{}", f.render()))
}

/// Torque in Nm, speed in rpm and loss in W of all points, with what is hidden and further overrides.
fn points(language: &Language, gearbox: &Gearbox, overrides: &[(&str, Value)]) -> Vec<[f64; 3]> {
    let hidden = TRUTH.iter().map(|(path, value)| ((*path).to_owned(), json!(value)));
    let further = overrides
        .iter()
        .map(|(path, value)| ((*path).to_owned(), value.clone()));
    let choice = Choice {
        overrides: hidden.chain(further).collect(),
        ..Choice::default()
    };
    let t = gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let state = t.states()[0].name.clone();
    let case = t.case(&state, &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut all = Vec::new();
    for torque in TORQUES {
        for speed in SPEEDS {
            let point = Point {
                speeds: &[speed * RPM],
                torques: &[torque],
                ..Point::default()
            };
            let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
            all.push([torque, speed, solution.loss().unwrap()]);
        }
    }
    all
}

/// Runs a study of the gearbox on a file of points, and gives what it printed.
fn run(keys: &str, csv: &str) -> (Ran, String) {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ ours: gearbox.yaml }}
conditions: {{ oil_temperature: 80 degC }}
analyses:
  found:
    type: identify
    data: {{ file: rig.csv, stated_as: standard }}
    residuals: [loss]
    profiles: false
    starts: 1
    parameters:
      mesh: {{ path: meshes.stage.loss_factor, from: 0.3, to: 3 }}
      viscosity: {{ path: lubricants.oil.viscosity.factor, from: 0.3, to: 3, scale: log }}
      seal: {{ path: seals.D1.loss_factor, from: 0.1, to: 10 }}
{keys}"
    );
    let ran = run_texts(&study, &[("gearbox.yaml", GEARBOX), ("rig.csv", csv)]);
    let text = ran.text.clone();
    (ran, text)
}

fn found(results: &Ran) -> Value {
    results.json("found")["identifications"][0].clone()
}

/// Exact points, but for 10 W more at the greatest torque, with a column that holds out the same rows.
static SPOILT: LazyLock<String> = LazyLock::new(spoilt);

fn spoilt() -> String {
    let language = language();
    let mut csv = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W],use_for_test,bench\n".to_owned();
    let gearbox = gearbox(&language);
    for (i, [torque, speed, loss]) in points(&language, &gearbox, &[]).into_iter().enumerate() {
        let spoilt = torque > 55.0;
        let loss = loss + if spoilt { 10.0 } else { 0.0 };
        let bench = ["A", "B", "C"][i % 3];
        let _ = writeln!(
            csv,
            "{torque},{speed},{loss},2,{},{bench}",
            if spoilt { "yes" } else { "" }
        );
    }
    csv
}

#[test]
fn rows_held_out_are_not_fitted_and_are_predicted() {
    let csv: &str = &SPOILT;
    let (results, text) = run("    hold_out: torque > 55 Nm\n    folds: 0\n", csv);
    let condition = found(&results);
    for (name, expected) in [("mesh", 1.2), ("viscosity", 0.8), ("seal", 1.3)] {
        let all = condition["parameters"].as_array().unwrap();
        let parameter = all.iter().find(|p| p["name"] == name).unwrap();
        let value = parameter["value"].as_f64().unwrap();
        assert!((value - expected).abs() < 1e-3, "{name} {value}\n{text}");
    }
    let held = &condition["hold_out"];
    assert_eq!((&held["rows"], &held["rows_fitted"]), (&json!(6), &json!(30)));
    let errors = &held["quantities"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(
        (number(&errors["held_out"]["mean"]) + 10.0).abs() < 0.1 && number(&errors["fitted"]["rms"]) < 0.1,
        "{errors}"
    );
    assert!((number(&errors["held_out"]["in_accuracies"]["rms"]) - 5.0).abs() < 0.05);
    assert_eq!(
        (&errors["coverage"]["inside"], &errors["coverage"]["points"]),
        (&json!(0), &json!(6))
    );
    // Nothing of the fit knows of them: all its points are the others.
    assert!(
        condition["points"]
            .as_array()
            .unwrap()
            .iter()
            .all(|p| number(&p["torque_nm"]) < 55.0)
    );
    assert!(
        held["points"]
            .as_array()
            .unwrap()
            .iter()
            .all(|p| number(&p["torque_nm"]) > 55.0)
    );
    for words in [
        "found: 6 of 36 rows are held out (torque > 55 Nm)",
        "found: predicts the loss of the 6 held-out points (torque > 55 Nm) with",
        "0 of 6 are inside their 95 % bands (0.0 %, 95 % interval 0.0 to 39.0 %); the bands are too narrow",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    let table = results.csv("found-hold-out");
    assert_eq!(table.lines().count(), 7);
    assert!(table.starts_with("model_set,line,name,gear,torque_nm,speed_rpm,oil_temperature_degc,quantity,measured,predicted,band_low,band_high,inside\n"));
    assert!(table.lines().skip(1).all(|line| line.ends_with(",false")), "{table}");
    assert!(results.draws("found-own-hold-out-loss-torque"));
    // A column that says the same gives the same.
    let (results, _) = run("    hold_out: { column: use_for_test }\n    folds: 0\n", csv);
    let column = found(&results);
    assert_eq!(column["hold_out"]["points"], held["points"]);
    assert_eq!(column["hold_out"]["chosen_by"], "column `use_for_test`");
}

/// Lines of rows that an entry holds out of 36.
fn lines(entry: &HoldOutEntry, measured: &gearloss_studies::measured::Measured) -> Vec<u64> {
    let choice = HoldOut::choose(entry, measured).unwrap();
    assert_eq!(
        choice.fitted.rows.len() + choice.held_out.rows.len(),
        measured.rows.len()
    );
    choice.held_out.rows.iter().map(|row| row.line).collect()
}

fn measured(csv: &str) -> gearloss_studies::measured::Measured {
    let entry: MeasuredEntry =
        serde_json::from_value(json!({ "file": "rig.csv", "stated_as": "standard", "faulty_rows": "keep" })).unwrap();
    entry.read(csv.as_bytes(), &[]).unwrap()
}

#[test]
fn rows_are_chosen_in_four_ways() {
    let measured = measured(&SPOILT);
    let rows = |value: Value| -> Vec<u64> { lines(&serde_json::from_value(value).unwrap(), &measured) };
    assert_eq!(rows(json!("torque > 55 Nm")), (32..=37).collect::<Vec<u64>>());
    assert_eq!(
        rows(json!({ "where": "torque > 55 Nm" })),
        (32..=37).collect::<Vec<u64>>()
    );
    assert_eq!(
        rows(json!({ "column": "use_for_test" })),
        (32..=37).collect::<Vec<u64>>()
    );
    assert_eq!(rows(json!({ "every": 12 })), [13, 25, 37]);
    let random = |seed: u32| rows(json!({ "random": 0.25, "seed": seed }));
    assert_eq!((random(1).len(), random(1)), (9, random(1)));
    assert_ne!(random(1), random(2));
    assert_eq!(rows(json!({ "random": 0.25 })), random(1));
}

#[test]
fn what_cannot_be_held_out_is_refused_with_its_place() {
    let csv: &str = &SPOILT;
    for (keys, place, message, help) in [
        (
            "hold_out: torque > 55",
            "found.hold_out",
            "column 10: `55` has no unit",
            "`55 Nm`",
        ),
        (
            "hold_out: { where: torqe > 5 Nm }",
            "found.hold_out.where",
            "`torqe` is neither a measured quantity",
            "`torque`",
        ),
        (
            "hold_out: { column: use_for_tset }",
            "found.hold_out.column",
            "no column `use_for_tset`",
            "`use_for_test`",
        ),
        (
            "hold_out: { column: bench }",
            "found.hold_out.column",
            "line 2: `a` in column `bench` is neither",
            "write 1",
        ),
        (
            "hold_out: torque > 99 Nm",
            "found.hold_out",
            "none of 36 rows is held out",
            "delete `hold_out`",
        ),
        (
            "hold_out: torque > 0 Nm",
            "found.hold_out",
            "no rows to fit",
            "fewer rows",
        ),
        (
            "hold_out: torque > 10 Nm or speed > 1000 rpm",
            "found.hold_out",
            "2 rows remain for the fit of 3 parameters",
            "fewer",
        ),
        (
            "hold_out: {}",
            "found.hold_out",
            "selection of held-out rows is missing",
            "`column`",
        ),
        (
            "hold_out: { every: 3, random: 0.2 }",
            "found.hold_out",
            "several selections",
            "one of",
        ),
        (
            "hold_out: { every: 3, seed: 2 }",
            "found.hold_out.seed",
            "applies to random groups only",
            "`random`",
        ),
        ("hold_out: { every: 1 }", "hold_out.every", "", ""),
        ("folds: { by: spede }", "found.folds.by", "no column `spede`", "`speed`"),
        (
            "folds: { by: sign }",
            "found.folds.by",
            "one group, `power in`",
            "varies",
        ),
        (
            "folds: { by: oil_temperature }",
            "found.folds.by",
            "the data do not contain `oil_temperature`",
            "columns: { oil_temperature: ... }",
        ),
        (
            "folds: { by: bench, count: 2 }",
            "found.folds.count",
            "given by its values",
            "delete `count`",
        ),
        (
            "folds: { by: torque, seed: 2 }",
            "found.folds.seed",
            "applies to random groups",
            "random",
        ),
        ("folds: 1", "found.folds", "at least two groups", "at least 2"),
    ] {
        let (results, text) = run(&format!("    {keys}\n"), csv);
        assert!(
            text.contains(place) && text.contains(message) && text.contains(help),
            "{keys}\n{text}"
        );
        assert!(!results.succeeded, "{keys}");
    }
}

#[test]
fn folds_group_by_what_is_asked() {
    let csv: &str = &SPOILT;
    for (keys, by, words, groups, first) in [
        ("4", "torque", "(band of torque): predicted residual", 4, "10.0 Nm"),
        (
            "{ by: torque, count: 3 }",
            "torque",
            "(band of torque)",
            3,
            "10.0 to 20.0 Nm",
        ),
        (
            "{ by: speed, count: 3 }",
            "speed",
            "(band of speed)",
            3,
            "500 to 1000 rpm",
        ),
        (
            "{ by: random, count: 4, seed: 3 }",
            "random",
            "(random group)",
            4,
            "random group 1",
        ),
        ("{ by: bench }", "bench", "(group of `bench`)", 3, "bench A"),
        ("{ by: loss, count: 2 }", "loss", "(group of `loss`)", 2, ""),
    ] {
        let (results, text) = run(&format!("    folds: {keys}\n    write: [json]\n"), csv);
        let folds = &found(&results)["folds"];
        assert!(
            text.contains("cross-validation over ") && text.contains(words),
            "{keys}\n{text}"
        );
        let bands = folds["bands"].as_array().unwrap();
        assert_eq!((folds["by"].as_str().unwrap(), bands.len()), (by, groups), "{keys}");
        assert!(
            bands[0]["name"].as_str().unwrap().starts_with(first),
            "{keys} {}",
            bands[0]
        );
        assert_eq!(bands[0]["from_nm"].is_null(), by != "torque");
        let points: u64 = bands.iter().map(|band| band["points"].as_u64().unwrap()).sum();
        assert_eq!(points, 36);
    }
    // Rows in which power leaves are predicted from those in which it enters.
    let both = csv.lines().enumerate().map(|(i, line)| match line.split_once(',') {
        Some((torque, rest)) if i % 3 == 1 => format!("-{torque},{rest}\n"),
        _ => format!("{line}\n"),
    });
    let (results, text) = run(
        "    folds: { by: sign }\n    write: [json]\n",
        &both.collect::<String>(),
    );
    let names: Vec<Value> = found(&results)["folds"]["bands"]
        .as_array()
        .unwrap()
        .iter()
        .map(|b| b["name"].clone())
        .collect();
    assert_eq!(names, [json!("power out"), json!("power in")], "{text}");
}

/// Noise over the loss, and over the mean loss where nobody states it.
const NOISE: [f64; 3] = [0.005, 0.02, 0.08];
/// Data sets of each noise and kind of accuracy, half of them for each way of holding out.
const SETS: u64 = 24;

/// What a data set is predicted to.
struct Simulated {
    /// Noise, whether accuracies are stated, and whether the greatest torques are held out or rows at random.
    kind: (usize, bool, bool),
    inside: Vec<bool>,
    widened: bool,
}

/// Simulates data sets of points, fits them and predicts what was held out.
fn simulate(language: &Language, gearbox: &Gearbox, truth: &[[f64; 3]]) -> Vec<Simulated> {
    let entries: Vec<(&str, IdentifiedEntry)> = TRUTH
        .iter()
        .map(|(path, _)| {
            let entry = IdentifiedEntry {
                scale: ScaleEntry::Log,
                ..IdentifiedEntry::between(*path, 0.1, 10.0)
            };
            (*path, entry)
        })
        .collect();
    let mean = truth.iter().map(|p| p[2]).sum::<f64>() / truth.len() as f64;
    let one = |number: u64| {
        let level = (number % 3) as usize;
        let is_stated = (number / 3).is_multiple_of(2);
        let set = number / 6;
        let extrapolates = set.is_multiple_of(2);
        let mut noise = Normal(7_919 * (number + 1));
        let mut csv =
            "torque [Nm],speed [rpm],loss [W]".to_owned() + if is_stated { ",loss_accuracy [W]\n" } else { "\n" };
        for [torque, speed, loss] in truth {
            let sigma = NOISE[level] * if is_stated { *loss } else { mean };
            let _ = write!(csv, "{torque},{speed},{}", loss + sigma * noise.next());
            let _ = if is_stated {
                writeln!(csv, ",{sigma}")
            } else {
                writeln!(csv)
            };
        }
        let measured = measured(&csv);
        let entry = HoldOutEntry::Rows(HoldOutRows {
            condition: extrapolates.then(|| "torque > 45 Nm".to_owned()),
            random: (!extrapolates).then_some(1.0 / 3.0),
            seed: (!extrapolates).then_some(set as u32),
            ..HoldOutRows::default()
        });
        let choice = HoldOut::choose(&entry, &measured).unwrap();
        let rows = Rows {
            measured: &choice.fitted,
            bind: Vec::new(),
            gear: None,
            torque_at: "input",
            speed_at: "input",
            oil: Some(80.0),
            flow: PowerFlow::Real,
            terms: false,
        };
        let entries = entries.iter().map(|(name, entry)| (*name, entry));
        let made = Identification::new(language, gearbox, Choice::default(), rows, entries, &[Quantity::Loss]);
        let mut identification = made.unwrap();
        let fitted = identification.fit(&Settings::default()).unwrap();
        let inference = &fitted.inference;
        // The checks that the program makes: lines of constant torque over speed.
        let torques: Vec<f64> = choice
            .fitted
            .rows
            .iter()
            .map(|row| choice.fitted.value(row, "torque").unwrap())
            .collect();
        let along = succession(&inference.standardised(), &levels(&torques));
        let widening = Widening::from_checks(inference.lack_of_fit().as_ref(), along.as_ref());
        let profiles = vec![None; TRUTH.len()];
        let predicted = identification
            .predict(&fitted, &choice.held_out, &[Quantity::Loss], (widening, &profiles))
            .unwrap();
        assert!(predicted.missing.is_empty() && predicted.no_bands.is_none());
        Simulated {
            kind: (level, is_stated, extrapolates),
            inside: predicted.numbers.iter().map(|n| n.is_inside().unwrap()).collect(),
            widened: widening.is_some(),
        }
    };
    let count = 6 * SETS;
    std::thread::scope(|scope| {
        let half = |first: u64| (first..count).step_by(2).map(&one).collect::<Vec<_>>();
        let other = scope.spawn(move || half(1));
        let mut all = half(0);
        all.extend(other.join().unwrap());
        all
    })
}

/// Share of what is inside over data sets of some kind, printed with its name.
fn covered(all: &[Simulated], name: &str, of_kind: impl Fn(&(usize, bool, bool)) -> bool) -> f64 {
    let simulated: Vec<&Simulated> = all.iter().filter(|s| of_kind(&s.kind)).collect();
    let coverage = Coverage::count(simulated.iter().flat_map(|s| s.inside.iter().copied())).unwrap();
    let [low, high] = coverage.interval(0.95).unwrap();
    let widened = simulated.iter().filter(|s| s.widened).count();
    println!(
        "{name}: {} data sets ({widened} widened), {} of {} inside, {:.1} % ({:.1} to {:.1} %)",
        simulated.len(),
        coverage.inside,
        coverage.count,
        100.0 * coverage.share(),
        100.0 * low,
        100.0 * high
    );
    coverage.share()
}

/// Coverage by noise and accuracy, by way of holding out, and in total.
fn table(all: &[Simulated]) -> Vec<f64> {
    let mut shares = Vec::new();
    for (level, noise) in NOISE.iter().enumerate() {
        for is_stated in [true, false] {
            let name = format!(
                "noise {} %, accuracy {}",
                100.0 * noise,
                if is_stated { "given" } else { "estimated" }
            );
            shares.push(covered(all, &name, |k| (k.0, k.1) == (level, is_stated)));
        }
    }
    shares.push(covered(all, "torque > 45 Nm held out", |k| k.2));
    shares.push(covered(all, "a third at random held out", |k| !k.2));
    shares.push(covered(all, "all", |_| true));
    shares
}

#[test]
fn bands_of_a_right_model_hold_what_they_promise() {
    let language = language();
    let gearbox = gearbox(&language);
    let all = simulate(&language, &gearbox, &points(&language, &gearbox, &[]));
    assert_eq!(all.len(), 144);
    for share in table(&all) {
        assert!((0.90..=0.98).contains(&share), "{share}");
    }
}

/// Mesh losses of another law, whose friction falls with the load and the speed in another way: where it was fitted the factors make up
/// for it, beyond they do not.
#[test]
fn bands_of_a_wrong_model_do_not_hold_beyond_what_was_fitted() {
    let language = language();
    let gearbox = gearbox(&language);
    let other = [("meshes.stage.model", json!({ "type": "anderson_loewenthal" }))];
    let all = simulate(&language, &gearbox, &points(&language, &gearbox, &other));
    table(&all);
    let beyond = covered(&all, "torque > 45 Nm held out, noise 0.5 %", |k| k.0 == 0 && k.2);
    let between = covered(&all, "a third at random held out, noise 0.5 %", |k| k.0 == 0 && !k.2);
    assert!(beyond < 0.9, "{beyond}");
    // Rows between fitted ones are predicted as badly as those are met, which the widened bands know.
    assert!(between > beyond, "{between} {beyond}");
}
