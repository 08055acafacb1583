//! The mechanism and the models of this crate are full citizens.
#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use gearloss_framework::conformance::check_all;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Registry;
use in_house_plugin as _;

fn out(args: &[&str]) -> String {
    let output = Command::cargo_bin("in-house-plugin")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{args:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

const POINT: [&str; 4] = ["--speed", "3000 rpm", "--torque", "20 Nm"];

#[test]
fn all_models_conform() {
    // The built-in models are linked through the program's library.
    let _: fn() -> std::process::ExitCode = gearloss::main;
    let language = Language::new(Registry::linked().unwrap()).unwrap_or_else(|f| panic!("{f:#?}"));
    assert!(language.registry().model("parking_lock", "pawl").is_some());
    let faults = check_all(&language);
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn the_schema_has_the_section_and_the_models() {
    let schema = out(&["schema", "gearbox"]);
    assert!(schema.contains("\"parking_locks\"") && schema.contains("\"pawl\"") && schema.contains("\"measured\""));
}

#[test]
fn models_lists_them_with_their_crate() {
    let list = out(&["models"]);
    let line = list.lines().find(|l| l.contains("pawl")).unwrap();
    assert!(line.contains("in_house_plugin"), "{line}");
    assert!(out(&["models", "parking_lock", "pawl"]).contains("force"));
}

#[test]
fn check_solve_and_explain_know_them() {
    assert!(out(&["check", "gearbox.yaml"]).contains("fine"));
    let solved = out(&[&["solve", "gearbox.yaml"][..], &POINT].concat());
    // 0.5 N at 45 mm on the wheel at 1500 rpm.
    let expected = 0.5 * 0.045 * 1500.0 * std::f64::consts::PI / 30.0;
    assert!(
        solved.contains("parking_locks.lock") && solved.contains(&format!("{expected:.4}")),
        "{solved}"
    );
    let explained = out(&[&["explain", "gearbox.yaml", "lock"][..], &POINT].concat());
    assert!(
        explained.contains("rig report 17") && explained.contains("M = 0.0225 Nm"),
        "{explained}"
    );
    let formula = [
        &[
            "solve",
            "gearbox.yaml",
            "--set",
            "parking_locks.lock.model={ type: formula, formula: \"1e-5 * abs(speed)\" }",
        ][..],
        &POINT,
    ];
    assert!(out(&formula.concat()).contains("formula"));
}

#[test]
fn a_fault_in_the_section_is_found_like_any_other() {
    let wrong = Command::cargo_bin("in-house-plugin")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["check", "gearbox.yaml", "--set", "parking_locks.lock.wheel=90 Nm"])
        .output()
        .unwrap();
    assert_eq!(wrong.status.code(), Some(2));
    assert!(
        String::from_utf8(wrong.stderr)
            .unwrap()
            .contains("torque, not a length")
    );
}
