//! Ratings beside losses: what is printed, what documents may choose, and what they must not change.

use crate::common::program::{gearloss, out};
use crate::common::study::{of_gearbox, run_texts};
use assert_cmd::Command;
use serde_json::Value;

const UNIT: &str = "examples/electric-drive-unit/gearbox.yaml";

fn at(torque: &str, more: &[&str]) -> Vec<String> {
    let point = [
        "--torque",
        torque,
        "--speed",
        "1000 rpm",
        "--oil-temperature",
        "80 degC",
    ];
    point.iter().chain(more).map(|text| (*text).to_owned()).collect()
}

fn solved(torque: &str, more: &[&str]) -> String {
    let at = at(torque, more);
    let args: Vec<&str> = ["solve", UNIT]
        .into_iter()
        .chain(at.iter().map(String::as_str))
        .collect();
    out(&args)
}

fn json(torque: &str, more: &[&str]) -> Value {
    let mut more = more.to_vec();
    more.extend(["--format", "json"]);
    serde_json::from_str(&solved(torque, &more)).unwrap()
}

fn quantity(value: &Value, component: &str, symbol: &str) -> Option<Value> {
    let rated = value["ratings"].as_array().unwrap().iter();
    let rated = rated.filter(|rating| rating["component"] == component);
    let mut quantities = rated.flat_map(|rating| rating["quantities"].as_array().unwrap());
    quantities.find(|quantity| quantity["symbol"] == symbol).cloned()
}

#[test]
fn an_overloaded_bearing_is_a_warning_with_numbers_and_a_bound_of_the_user() {
    let text = solved("350 Nm", &[]);
    let warning = "warning: bearings.B4: static safety S0 = 0.9347 is below 1 (ratings.iso_76)";
    assert!(text.contains("Ratings: bearing") && text.contains(warning), "{text}");
    assert!(
        text.contains("warning: bearings.B4: load ratio C/P = 1.647 is below 3 (ratings.iso_281)"),
        "{text}"
    );
    assert!(
        text.contains("note: bearings.B4: iso_281: equivalent load over dynamic load rating P/C"),
        "{text}"
    );
    let fewer = solved("350 Nm", &["--set", "ratings.iso_76.least_safety=0.9"]);
    assert!(!fewer.contains("(ratings.iso_76)"), "{fewer}");
    let more = solved("350 Nm", &["--set", "ratings.iso_76.least_safety=1.4"]);
    assert!(more.contains("warning: bearings.B3: static safety"), "{more}");
    let without = solved("350 Nm", &["--set", "ratings.iso_76=none"]);
    assert!(!without.contains("S0"), "{without}");
}

#[test]
fn no_loss_depends_on_a_rating() {
    let with = json("120 Nm", &[]);
    let without = json(
        "120 Nm",
        &[
            "--set",
            "ratings.iso_281=none",
            "--set",
            "ratings.flank_contact=none",
            "--set",
            "ratings.minimum_load=none",
        ],
    );
    assert!(quantity(&with, "bearings.B1", "L10h").is_some() && quantity(&without, "bearings.B1", "L10h").is_none());
    for key in [
        "loss_w",
        "efficiency",
        "parts",
        "power",
        "sums_w",
        "supports",
        "notes",
        "evidence",
    ] {
        assert_eq!(with[key], without[key], "{key}");
    }
}

#[test]
fn static_safety_agrees_with_that_of_the_supports() {
    let value = json("350 Nm", &[]);
    for support in value["supports"].as_array().unwrap() {
        let path = support["support"].as_str().unwrap();
        let safety = quantity(&value, path, "S0").unwrap();
        assert_eq!(safety["value"], support["static_safety"], "{path}");
        assert_eq!(safety["outside"], safety["value"].as_f64().unwrap() < 1.0);
    }
}

#[test]
fn a_parameter_of_a_rating_changes_its_result() {
    let life = |more: &[&str]| {
        quantity(&json("120 Nm", more), "bearings.B1", "Lnmh").unwrap()["value"]
            .as_f64()
            .unwrap()
    };
    let (usual, safer) = (life(&[]), life(&["--set", "ratings.iso_281.reliability=0.99"]));
    assert!((safer / usual - 0.248).abs() < 1e-3, "{usual} {safer}");
    let reported = solved("120 Nm", &["--set", "ratings.iso_281.least_life=1e8 h"]);
    assert!(reported.contains("modified rating life Lnmh"), "{reported}");
}

#[test]
fn explain_shows_the_steps_and_eval_a_rating_alone() {
    let at = at("350 Nm", &[]);
    let args: Vec<&str> = ["explain", UNIT, "bearings.B1"]
        .into_iter()
        .chain(at.iter().map(String::as_str))
        .collect();
    let text = out(&args);
    for step in [
        "bearings.B1: ratings",
        "nu1 = ",
        "e_C Cu/P = ",
        "a_ISO = ",
        "evidence: recalled",
    ] {
        assert!(text.contains(step), "{step}: {text}");
    }
    let alone = out(&["eval", "rating/flash_temperature"]);
    assert!(alone.contains("maximum contact temperature theta_B = "), "{alone}");
    let listed = out(&["models", "rating", "lip_seal"]);
    assert!(
        listed.contains("greatest_speed") && listed.contains("evidence: formula: recalled"),
        "{listed}"
    );
}

#[test]
fn a_wrong_parameter_or_name_is_an_error_with_its_place() {
    for set in [
        "ratings.iso_281.reliability=2",
        "ratings.iso_281.reliabilty=0.95",
        "ratings.iso_282=none",
    ] {
        let output = gearloss(&["solve", UNIT, "--torque", "1 Nm", "--speed", "1 rpm", "--set", set]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && text.contains("ratings.iso_28"),
            "{set}: {text}"
        );
    }
}

/// A spectrum of two loads at given temperatures: 1/L = sum of the time shares over the lives at each.
#[test]
fn damages_of_a_spectrum_add_up_after_miner() {
    let study = of_gearbox(
        UNIT,
        "
conditions: { oil_temperature: 80 degC }
cycles:
  both: { spectrum: [{ torque: 100 Nm, speed: 1000 rpm, share: 0.75 }, { torque: 300 Nm, speed: 1000 rpm, share: 0.25 }] }
analyses:
  lives: { type: cycle, cycles: [both], ratings: true, write: [json] }
",
    );
    let (ran, text) = run_texts(&study, &[]).with_text();
    assert!(ran.succeeded, "{text}");
    let lives = ran.json("lives");
    let over = lives["cycles"][0]["ratings"].as_array().unwrap();
    let of = |component: &str, symbol: &str| {
        let found = over
            .iter()
            .find(|rating| rating["component"] == component && rating["symbol"] == symbol);
        found.unwrap().clone()
    };
    let [light, heavy] = ["100 Nm", "300 Nm"].map(|torque| json(torque, &[]));
    for bearing in ["bearings.B1", "bearings.B4"] {
        let at = |point: &Value, symbol: &str| quantity(point, bearing, symbol).unwrap()["value"].as_f64().unwrap();
        for symbol in ["L10h", "Lnmh"] {
            let by_hand = 1.0 / (0.75 / at(&light, symbol) + 0.25 / at(&heavy, symbol));
            let value = of(bearing, symbol)["value"].as_f64().unwrap();
            assert!(
                (value / by_hand - 1.0).abs() < 1e-9,
                "{bearing} {symbol}: {value}, by hand {by_hand}"
            );
        }
        let least = of(bearing, "S0")["value"].as_f64().unwrap();
        assert_eq!(least, at(&heavy, "S0"), "the minimum of the static safety");
    }
    assert_eq!(of("bearings.B4", "C/P")["outside_share"], 0.25);
}

/// Arguments that explain the bearing B1 of the drive unit, which is another one, beside a catalogue of its own, in a folder of this name.
fn with_bearing(name: &str, bearing: &str) -> Vec<String> {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("internal-geometry-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    let unit = std::fs::read_to_string(crate::common::file(UNIT)).unwrap();
    let own = format!("{{ shaft: input, at: 0 mm, {bearing},");
    let changed = unit
        .replace("{ shaft: input,        at: 0 mm,    designation: \"6208\",", &own)
        .replace("\nports:", "\ncatalogues: { bearings: own.csv }\nports:");
    assert!(changed.contains(&own));
    let catalogue = "designation,kind,series,bore [mm],outside [mm],c [N],c0 [N],internal.elements [-],internal.diameter [mm]\n\
                     X1,deep_groove_ball,62,40,80,32500,19000,8,12.5\n";
    std::fs::write(folder.join("own.csv"), catalogue).unwrap();
    let map = crate::common::file("examples/electric-drive-unit/motor_map.csv");
    std::fs::copy(map, folder.join("motor_map.csv")).unwrap();
    std::fs::write(folder.join("gearbox.yaml"), changed).unwrap();
    let path = folder.join("gearbox.yaml").to_str().unwrap().to_owned();
    let args = ["explain", &path, "bearings.B1"].map(str::to_owned);
    args.into_iter().chain(at("120 Nm", &[])).collect()
}

/// Ratings from the load distribution use the internal geometry of the file, of a catalogue, or an estimate, which they say.
#[test]
fn internal_geometry_is_stated_or_estimated() {
    let explained = |name: &str, bearing: &str| {
        let args = with_bearing(name, bearing);
        out(&args.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let estimated = explained("estimated", "designation: \"6208\"");
    let note = "internal geometry is estimated";
    assert!(estimated.contains(note) && estimated.contains("Z = 9\n"), "{estimated}");
    let stated = explained(
        "stated",
        "designation: \"6208\", internal: { elements: 8, diameter: 11 mm, clearance: 12 um }",
    );
    assert!(!stated.contains(note), "{stated}");
    assert!(stated.contains("Z = 8\n") && stated.contains("D = 11 mm"), "{stated}");
    let of_catalogue = explained("catalogue", "designation: X1");
    assert!(!of_catalogue.contains(note), "{of_catalogue}");
    assert!(
        of_catalogue.contains("Z = 8\n") && of_catalogue.contains("D = 12.5 mm"),
        "{of_catalogue}"
    );
}

#[test]
fn internal_geometry_that_cannot_be_is_an_error() {
    for (number, (internal, reason)) in [
        ("{ elements: 20, diameter: 12 mm }", "do not fit"),
        ("{ length: 10 mm }", "`internal.length` is for rollers only"),
        ("{ elements: 2 }", "write 3 to 500"),
    ]
    .into_iter()
    .enumerate()
    {
        let args = with_bearing(
            &format!("wrong-{number}"),
            &format!("designation: \"6208\", internal: {internal}"),
        );
        let output = Command::cargo_bin("gearloss").unwrap().args(&args).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{internal}");
        assert!(text.contains(reason) && text.contains("B1"), "{internal}: {text}");
    }
}

/// A bearing that is tilted or loose lives shorter; the losses are the same.
#[test]
fn misalignment_changes_a_rating_and_no_loss() {
    let life = |value: &Value| {
        quantity(value, "bearings.B3", "L10rh").unwrap()["value"]
            .as_f64()
            .unwrap()
    };
    let (straight, tilted) = (
        json("200 Nm", &[]),
        json("200 Nm", &["--set", "ratings.iso_16281.misalignment=15 arcmin"]),
    );
    assert!(
        life(&tilted) < 0.95 * life(&straight),
        "{} {}",
        life(&tilted),
        life(&straight)
    );
    assert_eq!(tilted["loss_w"], straight["loss_w"]);
}
