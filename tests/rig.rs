//! The synthetic measurement of the two-speed example: made here, and compared as a user compares his own.

use crate::common::study::{Ran, run_file, run_texts};
use crate::common::{self, language};
use serde_json::Value;

/// `UPDATE=1` writes the file.
#[test]
fn the_synthetic_measurement_is_what_the_hidden_parameters_make() {
    let language = language();
    let csv = common::rig::csv(&common::rig::Rig::new(&language, "complete"), common::rig::SEED);
    let file = common::file("examples/two-speed-ev/rig.csv");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, &csv).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), csv, "UPDATE=1 writes it");
}

/// The map of examples/foreign-map is what the gearbox that it hides loses, as a design tool would write it. `UPDATE=1` writes it.
#[test]
fn the_foreign_map_is_what_its_hidden_gearbox_loses() {
    let ran = run_file("tests/foreign_map/study.yaml");
    assert!(ran.succeeded, "{}", ran.text);
    let map = ran.json("map");
    let mut csv = "T_wheel_Nm,n_wheel_rpm,T_oil_C,P_loss_W\n".to_owned();
    for temperature in map["maps"].as_array().unwrap() {
        for point in temperature["points"].as_array().unwrap() {
            let number = |key: &str| point[key].as_f64().unwrap();
            let [torque, speed] = [-number("torque_nm"), number("speed_rpm")];
            let [oil, loss] = ["oil_temperature_degc", "loss_w"].map(number);
            csv.push_str(&format!("{torque},{speed},{oil},{loss:.3}\n"));
        }
    }
    let file = common::file("examples/foreign-map/map.csv");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, &csv).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), csv, "UPDATE=1 writes it");
}

/// Runs a study on the example, under two names, with the synthetic file beside it; its results and what was printed.
fn run(study: &str, rig: &str) -> (Ran, String) {
    let gearbox = common::file("examples/two-speed-ev/gearbox.yaml");
    let head = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {0}, theirs: {0} }}\n",
        gearbox.display()
    );
    run_texts(&(head + study), &[("rig.csv", rig)]).with_text()
}

const DATA: &str = "data: { file: rig.csv, columns: { torque: T_in, speed: n_in, efficiency: eta, oil_temperature: T_oil }, stated_as: standard, rig: { torque_in: { full_scale: 20 Nm, percent_of_full_scale: 0.05 }, torque_out: { full_scale: 500 Nm, percent_of_full_scale: 0.05 } } }";

#[test]
fn models_are_compared_with_the_file_in_points_and_in_percent_of_loss() {
    let rig = std::fs::read_to_string(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    let study = format!(
        "analyses:\n  fit: {{ type: compare, gear: first, against: [own, theirs/own], write: [csv, json, svg], {DATA} }}\n"
    );
    let study = study.replace("[own, theirs/own]", "[ours/own, theirs/own]");
    let (results, text) = run(&study, &rig);
    let comparisons = results.json("fit")["comparisons"].clone();
    let first = &comparisons[0];
    let points = first["points"].as_array().expect(&text);
    assert_eq!(points.len(), 440);
    let number = |v: &Value| v.as_f64().unwrap();
    // The figures are those of the points.
    let differences: Vec<f64> = points.iter().map(|p| number(&p["difference"])).collect();
    let mean = differences.iter().sum::<f64>() / 440.0;
    assert!((number(&first["difference"]["mean"]) - mean).abs() < 1e-12);
    for point in points {
        let (saw, model) = (number(&point["measured"]), number(&point["model"]));
        assert!((number(&point["difference"]) - 100.0 * (model - saw)).abs() < 1e-12);
        let of_loss = 100.0 * ((1.0 - model) / (1.0 - saw) - 1.0);
        assert!((number(&point["loss_difference_percent_of_loss"]) - of_loss).abs() < 1e-6 * of_loss.abs().max(1.0));
    }
    // The second is the same product by another name: no measurement tells them apart.
    assert_eq!(first["difference"], comparisons[1]["difference"]);
    assert!(
        text.contains("indistinguishable") && text.contains("decimal comma") && text.contains("units in line"),
        "{text}"
    );
    for picture in ["fit-parity", "fit-histogram"] {
        assert!(results.draws(picture));
    }
}

#[test]
fn without_an_efficiency_the_torques_at_both_ports_give_it() {
    let rig = std::fs::read_to_string(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    let both = "data: { file: rig.csv, columns: { torque: T_in, speed: n_in, torque_out: T_out, speed_out: n_out, oil_temperature: T_oil } }";
    let study = format!(
        "analyses:\n  eta: {{ type: compare, gear: first, against: [ours/own], {DATA} }}\n  both: {{ type: compare, gear: first, against: [ours/own], {both} }}\n  loss: {{ type: compare, gear: first, against: [ours/own], quantity: loss_torque, {both} }}\n"
    );
    let (results, text) = run(&study, &rig);
    let mean = |name: &str| {
        results.json(name)["comparisons"][0]["difference"]["mean"]
            .as_f64()
            .unwrap_or_else(|| panic!("{text}"))
    };
    // The file rounds its torques and its efficiency.
    assert!(
        (mean("eta") - mean("both")).abs() < 0.01,
        "{} {}",
        mean("eta"),
        mean("both")
    );
    // A model that is more efficient than the file loses less.
    assert!(
        mean("eta") > 0.0 && mean("loss") < 0.0,
        "{} {}",
        mean("eta"),
        mean("loss")
    );
}

#[test]
fn what_a_comparison_lacks_is_reported() {
    for (analysis, said) in [
        (
            format!("against: [ours/own], grid: g, {DATA}"),
            "needs `base` with `grid` or with `drive`, or else `data`",
        ),
        (
            "against: [ours/own], data: { file: nowhere.csv }".to_owned(),
            "cannot read",
        ),
        (
            "against: [ours/own], data: { file: rig.csv, columns: { torque: T_in, speed: n_in } }".to_owned(),
            "there is no measured efficiency",
        ),
        (format!("against: [nobody/own], {DATA}"), "nobody"),
        (
            "against: [ours/own], data: { file: rig.csv, columns: { torque: T_in, speed: drehzahl } }".to_owned(),
            "there is no column `drehzahl`",
        ),
    ] {
        let study = format!(
            "grids: {{ g: {{ gear: first, torque: 10 Nm, speed: 1000 rpm }} }}\nanalyses:\n  fit: {{ type: compare, {analysis} }}\n"
        );
        let (_, text) = run(&study, "T_in;n_in\nNm;1/min\n10;1000\n");
        assert!(text.contains(said) && text.contains("help:"), "{said}\n{text}");
    }
}

#[test]
fn a_sweep_changes_one_value_and_is_the_map_at_each() {
    let study = "grids: { g: { gear: first, torque: 10 Nm, speed: 8000 rpm, bind: { lubricants.sump.viscosity.kv100: [4 mm2/s, 8 mm2/s] } } }
analyses:
  oil: { type: sweep, gear: first, path: lubricants.sump.viscosity.kv100, values: [4 mm2/s, 8 mm2/s], torque: [0 Nm, 10 Nm], speed: 8000 rpm }
  hot: { type: sweep, gear: first, path: thermal.oil, values: [60 degC, 100 degC], torque: 10 Nm, speed: 8000 rpm }
  map: { type: map, grid: g }
  none: { type: sweep, path: lubricants.sump.viscosity.kv900, values: [1], torque: 10 Nm, speed: 8000 rpm }
";
    let (results, text) = run(study, "");
    let sweep = results.json("oil")["sweep"].clone();
    let map = results.json("map")["maps"].clone();
    for i in 0..2 {
        assert_eq!(sweep[i]["points"][1]["loss_w"], map[i]["points"][0]["loss_w"], "{text}");
    }
    let loss = |value: &Value| value["points"][0]["loss_w"].as_f64().unwrap();
    assert!(loss(&sweep[0]) < loss(&sweep[1]), "thick oil loses more without load");
    let hot = results.json("hot")["sweep"].clone();
    assert!(loss(&hot[0]) > loss(&hot[1]) && hot[0]["points"][0]["oil_temperature_degc"] == 60.0);
    assert!(results.draws("oil-loss") && text.contains("kv900"), "{text}");
}
