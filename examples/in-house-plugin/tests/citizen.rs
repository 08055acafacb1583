//! The mechanism and the models of this crate have all features of built-in ones.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, program};

/// Everything that is linked, including the models of this crate.
#[test]
fn all_models_conform() {
    use in_house_plugin as _;
    let language = gearloss_framework::testing::language();
    let models = [
        ("bearing", "rig_line"),
        ("bearing", "rig_power"),
        ("gear_drag", "baffled"),
        ("parking_lock", "pawl"),
        ("bearing", "skf"),
    ];
    for (mechanism, model) in models {
        assert!(
            language.registry().model(mechanism, model).is_some(),
            "{mechanism}/{model} is not linked"
        );
    }
    assert!(language.registry().rating_named("lock_speed").is_ok());
    gearloss_framework::testing::conformance();
}

#[test]
fn models_lists_them_with_their_crate() {
    let list = program(&["models"]).fine();
    for model in ["rig_line", "rig_power", "baffled", "pawl"] {
        let line = list.lines().find(|l| l.contains(model)).unwrap();
        assert!(line.contains("in-house-plugin"), "{line}");
    }
    assert!(
        list.contains("crate in-house-plugin 0.1.0") && list.contains("crate gearloss-plugins"),
        "{list}"
    );
    let one = program(&["models", "parking_lock", "pawl"]).fine();
    assert!(
        one.contains("Mean force of the pawl on the wheel. [N]") && one.contains("src/pawl.rs"),
        "{one}"
    );
}

/// Ids, descriptions, units, ranges and defaults, which an editor offers and checks.
#[test]
fn the_schema_has_the_section_and_the_models() {
    let schema = program(&["schema", "gearbox"]).json();
    let locks = &schema["properties"]["parking_locks"];
    assert_eq!(locks["description"], "Drag of an open parking lock.");
    let wheel = &locks["additionalProperties"]["properties"]["wheel"];
    assert_eq!(wheel["description"], "Outside diameter of the wheel. [mm]");
    let text = schema["definitions"]["bearing_model"].to_string();
    assert!(
        text.contains("Friction of ball bearings as measured on the rig"),
        "{text}"
    );
    let text = schema["definitions"]["parking_lock_model"].to_string();
    for stated in [
        "Mean force of the pawl on the wheel. [N]",
        "\"default\":0.5",
        "\"maximum\":100.0",
    ] {
        assert!(text.contains(stated), "{stated}: {text}");
    }
}

const POINT: [&str; 5] = ["gearbox.yaml", "--speed", "3000 rpm", "--torque", "20 Nm"];

#[test]
fn check_solve_and_explain_know_them() {
    assert!(
        program(&["check", "gearbox.yaml", "study.yaml"])
            .fine()
            .contains("fine")
    );
    let solved = program(&[&["solve"][..], &POINT, &["--format", "json"]].concat()).json();
    let part = |path: &str| {
        let parts = solved["parts"].as_array().unwrap();
        parts
            .iter()
            .find(|p| p["part"] == path)
            .unwrap_or_else(|| panic!("{path}"))
            .clone()
    };
    // 0.5 N at 45 mm on the wheel at 3000/3.5 rpm.
    let ratings = solved["ratings"].as_array().unwrap();
    let rating = ratings.iter().find(|rating| rating["rating"] == "lock_speed").unwrap();
    assert_eq!(rating["component"], "parking_locks.lock");
    let expected = 0.5 * 0.045 * 3000.0 / 3.5 * std::f64::consts::PI / 30.0;
    assert!((part("parking_locks.lock")["loss_w"].as_f64().unwrap() - expected).abs() < 1e-9);
    assert_eq!(part("bearings.P1")["model"], "rig_line");
    assert_eq!(part("gears.wheel.drag.churning")["model"], "baffled");
    // Origin of a result: every linked crate with its version.
    let crates = solved["packages"].as_array().unwrap();
    assert!(
        crates
            .iter()
            .any(|p| p["name"] == "in-house-plugin" && p["version"] == "0.1.0")
    );
    let explained = program(&[&["explain"][..], &POINT[..1], &["lock"], &POINT[1..]].concat()).fine();
    assert!(
        explained.contains("rig report 17") && explained.contains("M = 0.0225 Nm"),
        "{explained}"
    );
}

/// `formula` works for the mechanism of this crate without further code.
#[test]
fn a_formula_takes_the_place_of_a_model() {
    let formula = "parking_locks.lock.model={ type: formula, formula: \"1e-5 * abs(speed)\" }";
    let solved = program(&[&["solve"][..], &POINT, &["--set", formula, "--format", "json"]].concat()).json();
    let lock = solved["parts"]
        .as_array()
        .unwrap()
        .iter()
        .find(|p| p["part"] == "parking_locks.lock")
        .unwrap();
    assert!((lock["moment_of_one_nm"].as_f64().unwrap() - 1e-5 * 3000.0 / 3.5).abs() < 1e-12);
}

#[test]
fn a_fault_in_the_section_is_found_like_any_other() {
    let told = program(&["check", "gearbox.yaml", "--set", "parking_locks.lock.wheel=90 Nm"]).refused();
    assert!(told.contains("torque, not a length"), "{told}");
    let told = program(&[
        "check",
        "gearbox.yaml",
        "--set",
        "bearings.P1.model={ type: rig_lien, loaded: 1e-4 }",
    ])
    .refused();
    assert!(told.contains("write `rig_line`"), "{told}");
}

/// A model for a gear pair cannot be nested in a model for a single gear.
#[test]
fn a_law_of_a_mesh_is_no_law_of_a_gear() {
    let nested = "gears.wheel.drag.churning.free={ type: mauz_injection, flow: 1 l/min }";
    let told = program(&["check", "gearbox.yaml", "--set", nested]).refused();
    assert!(told.contains("is a law for meshes"), "{told}");
}

/// A parameter of this crate is identified from measured points by its path; the true value is 4.2e-4.
#[test]
fn the_study_runs_and_identifies_a_parameter() {
    let folder = common::folder("study");
    let text = program(&[
        "run",
        "study.yaml",
        "--verbose",
        "--force",
        "-o",
        folder.to_str().unwrap(),
    ])
    .fine();
    let line = text
        .lines()
        .find(|l| l.starts_with("loaded  "))
        .unwrap_or_else(|| panic!("{text}"));
    let numbers: Vec<f64> = line.split_whitespace().filter_map(|w| w.parse().ok()).collect();
    let [stated, fitted, least, greatest, ..] = numbers[..] else {
        panic!("{line}")
    };
    assert!(
        (stated - 3e-4).abs() < 1e-12 && (fitted / 4.2e-4 - 1.0).abs() < 0.01,
        "{line}"
    );
    assert!(
        least < 4.2e-4 && 4.2e-4 < greatest && line.contains("well determined"),
        "{line}"
    );
    let report = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(report.contains("parking_locks.lock") && report.contains("in-house-plugin 0.1.0"));
}

impl Run {
    fn json(self) -> serde_json::Value {
        serde_json::from_str(&self.fine()).unwrap()
    }
}

/// Schema, `check`, `run`, its files and the report include the analysis of this crate.
#[test]
fn an_analysis_of_this_crate_runs_like_any_other() {
    let schema = program(&["schema", "study"]).json().to_string();
    assert!(
        schema.contains("drag_torque") && schema.contains("over the temperature of the oil"),
        "{schema}"
    );
    let results = program(&["schema", "result"]).json().to_string();
    assert!(results.contains("Torque at the first temperature over that at the last."));
    let folder = common::folder("drag");
    let printed = program(&["run", "study.yaml", "--force", "-o", folder.to_str().unwrap()]).fine();
    assert!(
        printed.contains("cold oil takes 2.99 times the torque, models own"),
        "{printed}"
    );
    let rows = std::fs::read_to_string(folder.join("drag.csv")).unwrap();
    assert!(
        rows.starts_with("model_set,oil_temperature_degc,torque_nm\n") && rows.lines().count() == 5,
        "{rows}"
    );
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.join("drag.json")).unwrap()).unwrap();
    assert_eq!(json["sets"][0]["torques"].as_array().map(Vec::len), Some(4));
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.contains("cold oil takes"));
}
