//! Analyses that find temperatures, as a user runs them, and what is said where they cannot.

use crate::common;
use crate::common::study::{Ran, number, of_gearbox, run_texts};

const GEARBOX: &str = "examples/planetary-reducer/gearbox.yaml";

/// Runs a study on the planetary example with files beside it; its results and what was printed.
fn run(study: &str, files: &[(&str, &str)]) -> (Ran, String) {
    let study = format!("conditions: {{ torque_at: output }}\n{study}");
    run_texts(&of_gearbox(GEARBOX, &study), files).with_text()
}

const POINTS: &str = "name,speed [rpm],torque [Nm],volume [ml],loss [W],oil_temperature [degC]
fast,3000,-16,130,60,47
slow,1000,-16,60,,
";

#[test]
fn points_of_a_file_bind_their_columns_and_stand_beside_measurements() {
    let study = "analyses:\n  tests: { type: operating_points, data: { file: points.csv, faulty_rows: keep }, bind: { volume: housing.oil.volume } }\n";
    let (results, text) = run(study, &[("points.csv", POINTS)]);
    let points = &results.json("tests")["operating_points"][0];
    let fast = &points["points"][0];
    assert_eq!(fast["bound"]["volume"], "130 ml", "{text}");
    let losses: f64 = fast["losses_w"].as_array().unwrap().iter().map(number).sum();
    assert!((losses / number(&fast["loss_w"]) - 1.0).abs() < 1e-12);
    let gap = 100.0 * (number(&fast["loss_w"]) / 60.0 - 1.0);
    assert!(
        text.contains(&format!(
            "loss minus measurement in %: mean {gap:.2}, max {gap:.2}, 1 points"
        )),
        "{text}"
    );
    let picture = results.picture("tests-own");
    for word in ["fast", "slow", "130 ml", "47", "measured: outline", "planetary_drag"] {
        assert!(picture.contains(word), "{word}");
    }
}

#[test]
fn a_tiny_measured_loss_has_no_deviation_in_percent() {
    let study = "analyses:\n  tests: { type: operating_points, data: { file: points.csv, faulty_rows: keep }, bind: { volume: housing.oil.volume } }\n";
    let tiny = format!("{POINTS}tiny,1000,-16,60,1e-300,\n");
    let (results, text) = run(study, &[("points.csv", &tiny)]);
    let fast = number(&results.json("tests")["operating_points"][0]["points"][0]["loss_w"]);
    let gap = 100.0 * (fast / 60.0 - 1.0);
    assert!(
        text.contains(&format!(
            "loss minus measurement in %: mean {gap:.2}, max {gap:.2}, 1 points"
        )) && text.contains("note: 1 points are omitted"),
        "{text}"
    );
    assert!(!text.contains("inf"), "{text}");
}

#[test]
fn a_faulty_file_of_points_is_refused_with_line_and_column() {
    let study = "analyses:\n  tests: { type: operating_points, data: { file: points.csv, faulty_rows: keep }, bind: { volume: housing.oil.volume } }\n";
    for (text, said) in [
        (
            POINTS.replace("1000,", "a,"),
            "line 3, column 2 `speed`: `a` is not a number",
        ),
        (
            POINTS.replace("[rpm]", "[bar]"),
            "`bar` is a pressure, not an angular speed",
        ),
        (POINTS.replace("[rpm]", ""), "column `speed` has no unit"),
        (
            POINTS.replace("volume [ml]", "volume [bottles]"),
            "`bottles` of column `volume` is not a unit",
        ),
        (POINTS.replace("volume", "amount"), "there is no column `volume`"),
        (POINTS.replace("speed", "slowness"), "there is no column for the speed"),
        (POINTS.lines().next().unwrap().to_owned(), "no points below the header"),
        (POINTS.replace("60,,", "-3,,"), "housing.oil.volume"),
        (POINTS.replace("3000,-16", "3000,"), "line 2, column 3 `torque`: empty"),
    ] {
        let (_, printed) = run(study, &[("points.csv", &text)]);
        assert!(printed.contains(said) && printed.contains("help:"), "{said}\n{printed}");
    }
}

#[test]
fn at_a_thermal_limit_the_balance_stands_at_it_and_the_reverse_finds_it_again() {
    let study = "analyses:
  torque: { type: thermal_limit, temperature: [60 degC, 90 degC], torque: [0 Nm, -300 Nm], speed: [1000 rpm, 2000 rpm, 4000 rpm] }
  speed: { type: thermal_limit, find: speed, temperature: [60 degC], torque: [-40 Nm], speed: { from: 100 rpm, to: 8000 rpm, step: 100 rpm } }
";
    let (results, text) = run(study, &[]);
    let limits = results.json("torque")["thermal_limits"][0]["limits"].clone();
    let mut reached = 0;
    for limit in limits.as_array().unwrap() {
        match limit["outcome"].as_str().unwrap() {
            "reached" => {
                reached += 1;
                assert!(
                    (number(&limit["lowest_balance_degc"]) - number(&limit["limit_degc"])).abs() < 1e-6,
                    "{limit}"
                );
                // The heat of the constant way at the limit is the loss.
                let heat = 24.7 * 0.0874 * (number(&limit["limit_degc"]) - 20.0);
                assert!((number(&limit["loss_w"]) / heat - 1.0).abs() < 1e-8, "{limit} {heat}");
            }
            outcome => assert_eq!(outcome, "not_reached", "{text}"),
        }
    }
    assert!(reached >= 3, "{text}");
    // At more speed less torque is left.
    let torque = |i: usize| number(&limits[i]["torque_nm"]);
    assert!(torque(1) < torque(2));
    let found = results.json("speed")["thermal_limits"][0]["limits"][0].clone();
    let again = format!(
        "analyses:\n  again: {{ type: thermal_limit, temperature: [60 degC], torque: [0 Nm, -300 Nm], speed: [{} rpm] }}\n",
        number(&found["speed_rpm"])
    );
    let (results, _) = run(&again, &[]);
    let torque = number(&results.json("again")["thermal_limits"][0]["limits"][0]["torque_nm"]);
    assert!((torque + 40.0).abs() < 1e-4, "{torque}");
    for picture in ["again", "again-power"] {
        assert!(results.draws(picture));
    }
}

#[test]
fn a_balance_shows_every_step_and_what_it_ended_at() {
    let set = "set: { thermal.sources: { motor: { heat: 15 W } }, thermal.oil_to_surface: 0.05 K/W }";
    let study = format!("analyses:\n  one: {{ type: balance, torque: -16 Nm, speed: 3000 rpm, {set} }}\n");
    let (results, text) = run(&study, &[]);
    let balance = &results.json("one")["balances"][0]["balance"];
    assert_eq!(balance["outcome"], "converged", "{text}");
    let history = balance["history"].as_array().unwrap();
    let last = history.last().unwrap();
    assert!(number(&last["residual_w"]).abs() < 1e-9 * number(&last["loss_w"]));
    // What leaves by the surface is loss and source; the oil is warmer by what goes through the resistance.
    let (oil, surface) = (
        number(&balance["oil_temperature_degc"]),
        number(&balance["surface_temperature_degc"]),
    );
    let ways: f64 = balance["ways"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| number(&w["heat_w"]))
        .sum();
    assert!((ways / (number(&last["loss_w"]) + 15.0) - 1.0).abs() < 1e-8);
    assert!(((oil - surface) / (0.05 * number(&last["loss_w"])) - 1.0).abs() < 1e-8);
    let rows = results.csv("one");
    assert_eq!(rows.lines().count(), 1 + history.len());
    for picture in ["one-own", "one-own-steps", "one-own-residual"] {
        assert!(results.draws(picture), "{picture}");
    }
}

#[test]
fn maps_bind_values_and_temperatures_are_compared() {
    let study = "model_sets:
  table: {}
  none: { planetary_drag: none }
grids:
  field: { gear: reducing, torque: -16 Nm, speed: [1000 rpm, 3000 rpm], bind: { housing.oil.volume: [60 ml, 130 ml] } }
  line: { gear: reducing, torque: -16 Nm, speed: [1000 rpm, 3000 rpm] }
  empty: { gear: reducing, torque: -16 Nm, speed: 1000 rpm, bind: { housing.oil.volume: 60 ml } }
analyses:
  field: { type: map, grid: field, write: [csv, json, svg] }
  gap: { type: compare, grid: line, base: none, against: [table], quantity: temperature }
  bound: { type: compare, grid: field, base: none, against: [table] }
  empty: { type: map, grid: empty }
  percent: { type: compare, grid: line, base: none, against: [table], quantity: temperature, difference: percent }
";
    let (results, text) = run(study, &[]);
    let csv = results.csv("field");
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|h| *h == name).unwrap();
    let cells: Vec<Vec<&str>> = csv.lines().skip(1).map(|l| l.split(',').collect()).collect();
    assert_eq!(cells.len(), 4);
    let oil = |row: usize| cells[row][column("oil_temperature_degc")].parse::<f64>().unwrap();
    assert_eq!(cells[2][column("housing.oil.volume")], "130 ml");
    assert!(oil(1) > oil(0) && oil(3) > oil(1), "{text}");
    assert!(cells.iter().all(|row| row[column("balance")] == "converged"));
    for picture in ["field-own-loss", "field-own-temperature", "field-own-efficiency"] {
        assert!(results.draws(picture), "{picture}");
    }
    let gap = &results.json("gap")["comparisons"][0];
    assert_eq!(gap["unit"], "k");
    assert!(number(&gap["least"]["difference"]) > 0.0);
    for said in [
        "without bound values",
        "has no list of values",
        "a temperature difference cannot be in percent",
    ] {
        assert!(text.contains(said), "{said}\n{text}");
    }
}

#[test]
fn a_temperature_that_is_not_found_is_reported_and_leaves_gaps() {
    let study = "grids:
  line: { gear: reducing, torque: -16 Nm, speed: [1000 rpm, 3000 rpm] }
analyses:
  hot: { type: map, grid: line }
";
    // With a way of next to nothing the losses stay above the heat.
    let conditions = "conditions: { torque_at: output, set: { thermal.heat_dissipation.casing.alpha: 2 W/(m2 K) } }\n";
    let results = run_texts(&of_gearbox(GEARBOX, &format!("{conditions}{study}")), &[]);
    assert!(results.succeeded, "{}", results.text);
    let points = results.json("hot")["maps"][0]["points"].clone();
    assert_eq!(points[1]["balance"], "none_below_maximum");
    assert!(points[1]["oil_temperature_degc"].is_null() && points[1]["loss_w"].is_null());
    // One point alone says so, and ends with a finding.
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args([
            "solve",
            common::file(GEARBOX).to_str().unwrap(),
            "--torque",
            "output=-16 Nm",
            "--speed",
            "3000 rpm",
        ])
        .args(["--set", "thermal.heat_dissipation.casing.alpha=2 W/(m2 K)"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text.contains("none_below_maximum") && text.contains("losses exceed the transferred heat up to 150"),
        "{text}"
    );
}
