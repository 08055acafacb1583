//! Corrections of an identification: a known smooth error of the physics comes out, with a band, and nowhere outside of the data.

use std::fmt::Write as _;

use serde_json::Value;

use crate::common::RPM;
use crate::common::study::{Ran, number, of_gearbox, run_texts};

const TORQUES: [f64; 5] = [2.0, 6.0, 10.0, 15.0, 20.0];
const SPEEDS: [f64; 6] = [1000.0, 4000.0, 8000.0, 12000.0, 16000.0, 20000.0];

/// What the physics omits, as loss torque. \[Nm\]
fn error(torque: f64, speed: f64) -> f64 {
    0.02 + 0.02 * (torque / 8.0).sin() + 0.03 * (speed / 20000.0).powi(2)
}

/// A study of the two-speed example at 80 degC.
fn study(analyses: &str) -> String {
    let list = |values: &[f64], unit: &str| {
        let all: Vec<String> = values.iter().map(|x| format!("{x} {unit}")).collect();
        all.join(", ")
    };
    let grids = format!(
        "{{ rig: {{ gear: first, torque: [{}], speed: [{}] }}, field: {{ gear: first, torque: [4 Nm, 12 Nm, 18 Nm, 30 Nm], speed: [3000 rpm, 10000 rpm, 15000 rpm] }} }}",
        list(&TORQUES, "Nm"),
        list(&SPEEDS, "rpm")
    );
    let rest = format!("conditions: {{ oil_temperature: 80 degC }}\ngrids: {grids}\nanalyses:\n{analyses}");
    of_gearbox("examples/two-speed-ev/gearbox.yaml", &rest)
}

const FIT: &str = "  fit: { type: identify, data: { file: rig.csv }, gear: first, residuals: [loss], starts: 1, profiles: false, folds: 0, correction: {}, then: fitted,
         parameters: { churning: { path: \"gears.*.loss_factor\", from: 0.5, to: 2 } } }
";

/// Points of a map as torque, speed and loss torque.
fn points(ran: &Ran, name: &str) -> Vec<Value> {
    ran.json(name)["maps"][0]["points"].as_array().unwrap().clone()
}

/// Losses of the example with the error.
fn rig() -> String {
    let ran = run_texts(&study("  losses: { type: map, grid: rig }\n"), &[]);
    let mut csv = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for point in points(&ran, "losses") {
        let [torque, speed, loss] = ["torque_nm", "speed_rpm", "loss_w"].map(|key| number(&point[key]));
        let angular = speed * RPM;
        writeln!(
            csv,
            "{torque},{speed},{},{}",
            loss + error(torque, speed) * angular,
            0.001 * angular
        )
        .unwrap();
    }
    csv
}

fn run(analyses: &str, files: &[(&str, &str)]) -> Ran {
    let rig = rig();
    let all: Vec<(&str, &str)> = files.iter().copied().chain([("rig.csv", rig.as_str())]).collect();
    run_texts(&study(analyses), &all)
}

#[test]
fn a_known_error_is_corrected_in_maps_and_comparisons_inside_of_the_data() {
    let maps = "  corrected: { type: map, grid: field, model_sets: [fitted], correction: { of: fit } }
  plain: { type: map, grid: field, model_sets: [fitted] }
  left: { type: compare, data: { file: rig.csv }, gear: first, against: [fitted], quantity: loss_torque, correction: { of: fit } }
";
    let ran = run(&format!("{FIT}{maps}"), &[]);
    assert!(ran.succeeded, "{}", ran.text);
    let fit = ran.json("fit");
    let of_fit = &fit["identifications"][0]["correction"][0];
    let [before, after] = ["rms_before_nm", "rms_left_out_nm"].map(|key| number(&of_fit[key]));
    assert!(after < 0.25 * before, "{before} {after}");
    assert!(
        ran.text
            .contains("a smooth correction over torque, speed, which is no physics"),
        "{}",
        ran.text
    );
    // True losses: those of the example with its own values, and the error.
    let truth = run_texts(&study("  losses: { type: map, grid: field }\n"), &[]);
    let mut inside = 0;
    let (corrected, plain) = (points(&ran, "corrected"), points(&ran, "plain"));
    for ((point, plain), truth) in corrected.iter().zip(&plain).zip(points(&truth, "losses")) {
        // The columns of the physics are those without a correction, to the bit.
        assert_eq!(point["loss_w"], plain["loss_w"]);
        assert!(plain.get("correction").is_none());
        let [torque, speed] = ["torque_nm", "speed_rpm"].map(|key| number(&point[key]));
        let Some(correction) = point.get("correction") else {
            assert_eq!(torque, 30.0, "{point}");
            continue;
        };
        inside += 1;
        let expected = number(&truth["loss_torque_nm"]) + error(torque, speed);
        let found = number(&correction["corrected_loss_torque_nm"]);
        assert!((found - expected).abs() < 0.004, "{torque} {speed}: {found} {expected}");
    }
    assert_eq!(inside, 9);
    let used = &ran.json("corrected")["corrections"][0];
    assert_eq!((used["inside"].as_u64(), used["outside"].as_u64()), (Some(9), Some(3)));
    assert!(
        ran.csv("corrected")
            .lines()
            .next()
            .unwrap()
            .contains("corrected_loss_w")
    );
    let left = &ran.json("left")["comparisons"][0];
    let [physics, with] = ["difference", "corrected_difference"].map(|key| number(&left[key]["rms"]));
    assert!(with < 0.2 * physics, "{physics} {with}");
}

#[test]
fn a_result_file_gives_the_same_correction_in_another_study() {
    let map =
        |from: &str, more: &str| format!("  corrected: {{ type: map, grid: field, {more}correction: {{ {from} }} }}\n");
    let ran = run(&format!("{FIT}{}", map("of: fit", "model_sets: [fitted], ")), &[]);
    let fit = ran.json("fit");
    let values = number(&fit["identifications"][0]["parameters"][0]["value"]);
    let result = fit.to_string();
    let files = [("fit.json", result.as_str())];
    let sets = format!("model_sets:\n  again: {{ set: {{ \"gears.*.loss_factor\": {values} }} }}\n");
    let text = study(&map("file: fit.json", "model_sets: [again], ")).replace("analyses:", &format!("{sets}analyses:"));
    let again = run_texts(&text, &files);
    assert!(again.succeeded, "{}", again.text);
    for (a, b) in points(&ran, "corrected").iter().zip(points(&again, "corrected")) {
        let (a, b) = (a.get("correction"), b.get("correction"));
        assert_eq!(a.is_some(), b.is_some());
        if let (Some(a), Some(b)) = (a, b) {
            assert!((number(&a["torque_nm"]) - number(&b["torque_nm"])).abs() < 1e-9);
        }
    }
    // The example with its own values is other physics.
    let own = run_texts(&study(&map("file: fit.json", "")), &files);
    assert!(
        own.text.contains("belongs to another gearbox or other parameters"),
        "{}",
        own.text
    );
}

#[test]
fn what_cannot_be_corrected_is_refused_with_place_and_help() {
    let refused = |analyses: &str, files: &[(&str, &str)], expected: &str| {
        let ran = run(analyses, files);
        assert!(!ran.succeeded, "{analyses}");
        assert!(
            ran.text.contains("error[E0610]") && ran.text.contains("= help: "),
            "{}",
            ran.text
        );
        assert!(ran.text.contains(expected), "{expected}\n{}", ran.text);
    };
    let map = |keys: &str| format!("  corrected: {{ type: map, {keys} }}\n");
    refused(
        &map("grid: field, correction: { of: fit }"),
        &[],
        "no analysis `fit` above this one identifies",
    );
    refused(
        &map("grid: field, correction: { file: no.json }"),
        &[],
        "no.json: cannot read",
    );
    refused(
        &map("grid: field, correction: {}"),
        &[],
        "either `of` an analysis or from a `file`",
    );
    let empty = [("fit.json", "{\"identifications\": [{\"model_set\": \"own\"}]}")];
    refused(
        &map("grid: field, correction: { file: fit.json }"),
        &empty,
        "it has no correction",
    );
    let sets = format!(
        "{FIT}{}",
        map("grid: field, model_sets: [fitted, own], correction: { of: fit }")
    );
    refused(&sets, &[], "belongs to the identified model set");
    let efficiency = format!(
        "{FIT}  left: {{ type: compare, data: {{ file: rig.csv }}, gear: first, against: [fitted], correction: {{ of: fit }} }}\n"
    );
    refused(&efficiency, &[], "a correction is of the loss torque");
}
