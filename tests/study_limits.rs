//! Limits of a study: every analysis reports where they are not kept, with the values of `solve`.

use serde_json::Value;

use crate::common::study::{Ran, number, of_gearbox, run_texts};

const GEARBOX: &str = "examples/two-speed-ev/gearbox.yaml";

const LIMITS: &str = "
conditions: { oil_temperature: 60 degC }
limits:
  life: { quantity: rating, rating: iso_281.L10h, of: bearings.B2, least: 8000 h }
  film: { quantity: rating, rating: flank_contact.lambda, least: 0.1 }
  efficient: { quantity: efficiency, least: 0.95 }
  cool: { quantity: temperature, most: 61 degC }
  small: { quantity: mean_loss, most: 100 W, of: loads }
cycles:
  loads: { spectrum: [{ torque: 20 Nm, speed: 6000 rpm, share: 0.75 }, { torque: 3 Nm, speed: 9000 rpm, share: 0.25 }] }
grids:
  field: { gear: first, torque: [2 Nm, 10 Nm, 20 Nm], speed: [1000 rpm, 8000 rpm] }
analyses:
";

fn run(analyses: &str) -> Ran {
    run_texts(
        &of_gearbox(GEARBOX, &format!("{LIMITS}{analyses}")),
        &[("points.csv", POINTS)],
    )
}

const POINTS: &str = "torque [Nm];speed [rpm]\n2;1000\n20;8000\n";

fn limit<'j>(outcome: &'j Value, name: &str) -> &'j Value {
    let all = outcome["study_limits"].as_array().unwrap();
    all.iter().find(|limit| limit["limit"] == name).unwrap()
}

/// A rating as `solve` prints it.
fn solved(torque: &str, speed: &str, component: &str, symbol: &str) -> f64 {
    let output = assert_cmd::Command::cargo_bin("gearloss")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args([
            "solve", GEARBOX, "--gear", "first", "--torque", torque, "--speed", speed,
        ])
        .args(["--oil-temperature", "60 degC", "--format", "json"])
        .output()
        .unwrap();
    let point: Value = serde_json::from_slice(&output.stdout).unwrap();
    let ratings = point["ratings"].as_array().unwrap().iter();
    let of_component = ratings.filter(|rating| rating["component"] == component);
    let mut quantities = of_component.flat_map(|rating| rating["quantities"].as_array().unwrap());
    number(&quantities.find(|quantity| quantity["symbol"] == symbol).unwrap()["value"])
}

#[test]
fn a_map_has_the_ratings_of_solve_and_counts_what_is_beyond() {
    let ran = run("  m: { type: map, grid: field }");
    let map = ran.json("m");
    let points = map["maps"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 6);
    for point in points {
        let torque = format!("{} Nm", point["torque_nm"]);
        let speed = format!("{} rpm", point["speed_rpm"]);
        let life = solved(&torque, &speed, "bearings.B2", "L10h");
        assert_eq!(number(&point["limit_values"]["life"]), life, "{torque} {speed}");
        assert_eq!(point["limit_values"]["efficient"], point["efficiency"]);
    }
    for (name, bound) in [("life", 8000.0), ("film", 0.1), ("efficient", 0.95)] {
        let values: Vec<f64> = points
            .iter()
            .map(|point| number(&point["limit_values"][name]))
            .collect();
        let reached = limit(&map, name);
        assert_eq!(reached["points"], 6);
        assert_eq!(reached["beyond"], values.iter().filter(|value| **value < bound).count());
        assert_eq!(
            number(&reached["worst"]),
            values.iter().copied().fold(f64::INFINITY, f64::min)
        );
    }
    assert_eq!(limit(&map, "life")["at"]["component"], "bearings.B2");
    assert_eq!(limit(&map, "cool")["beyond"], 0);
    // A limit of a cycle limits no point.
    assert!(
        map["study_limits"]
            .as_array()
            .unwrap()
            .iter()
            .all(|limit| limit["limit"] != "small")
    );
    let head = ran.csv("m").lines().next().unwrap().to_owned();
    assert!(
        head.ends_with("limit_life_h,limit_film,limit_efficient,limit_cool_degc"),
        "{head}"
    );
}

#[test]
fn limits_change_no_loss() {
    let analysis = "  m: { type: map, grid: field }";
    let with = run(analysis);
    let without = LIMITS
        .lines()
        .filter(|line| !line.contains("quantity") && *line != "limits:");
    let study = format!("{}\n{analysis}", without.collect::<Vec<_>>().join("\n"));
    let without = run_texts(&of_gearbox(GEARBOX, &study), &[]);
    let losses = |ran: &Ran| {
        let csv = ran.csv("m");
        let columns = csv
            .lines()
            .next()
            .unwrap()
            .split(',')
            .take_while(|name| !name.starts_with("limit_"))
            .count();
        let rows = csv
            .lines()
            .map(|line| line.split(',').take(columns).collect::<Vec<_>>().join(","));
        rows.collect::<Vec<_>>()
    };
    assert_eq!(losses(&with), losses(&without));
    assert!(without.json("m").get("study_limits").is_none());
}

#[test]
fn rows_of_a_file_and_sweeps_are_marked() {
    let ran = run("  p: { type: operating_points, gear: first, data: { file: points.csv } }
  s: { type: sweep, gear: first, path: lubricants.sump.viscosity.kv100, values: [3 mm2/s, 8 mm2/s], torque: 10 Nm, speed: 3000 rpm }");
    let points = ran.json("p");
    assert_eq!(limit(&points, "life")["beyond"], 1);
    assert_eq!(limit(&points, "life")["points"], 2);
    let sweep = ran.json("s");
    let films: Vec<f64> = sweep["sweep"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| number(&v["points"][0]["limit_values"]["film"]))
        .collect();
    assert!(films[1] > 1.5 * films[0], "thicker oil, thicker film: {films:?}");
    assert!(ran.draws("s-limit-film") && ran.draws("s-limit-life"));
}

#[test]
fn a_cycle_and_a_sweep_of_oils_keep_the_limits_of_the_study() {
    let ran = run("  c: { type: cycle, gear: first, cycles: [loads], ratings: true }
  o: { type: fluid_sweep, gear: first, cycles: [loads], kv100: [3 mm2/s, 5 mm2/s, 8 mm2/s], limits: { film: { quantity: rating, rating: flank_contact.lambda, least: 0.01 } } }");
    let cycle = ran.json("c");
    let life = limit(&cycle, "life");
    assert_eq!((life["points"].clone(), life["beyond"].clone()), (1.into(), 1.into()));
    assert_eq!(life["at"]["cycle"], "loads");
    let rated = cycle["cycles"][0]["ratings"].as_array().unwrap().iter();
    let mut lives = rated.filter(|rating| rating["component"] == "bearings.B2" && rating["symbol"] == "L10h");
    assert_eq!(life["worst"], lives.next().unwrap()["value"]);
    assert_eq!(limit(&cycle, "small")["beyond"], 1);
    let oils = ran.json("o");
    let names: Vec<&str> = oils["fluid_sweep"][0]["limits"]
        .as_array()
        .unwrap()
        .iter()
        .map(|limit| limit["limit"].as_str().unwrap())
        .collect();
    // Its own limit replaces the one of the same name.
    assert_eq!(names, ["life", "efficient", "cool", "small", "film"]);
}

#[test]
fn a_limit_of_severity_error_ends_the_run_with_a_finding() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("study-limits");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let study = of_gearbox(
        GEARBOX,
        &format!("{LIMITS}  m: {{ type: map, grid: field, write: [json] }}"),
    );
    let run = |severity: &str| {
        let study = study.replace("least: 0.95 }", &format!("least: 0.95, severity: {severity} }}"));
        std::fs::write(folder.join("study.yaml"), study).unwrap();
        let output = assert_cmd::Command::cargo_bin("gearloss")
            .unwrap()
            .current_dir(&folder)
            .args(["run", "study.yaml"])
            .output()
            .unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let (code, text) = run("error");
    assert_eq!(code, Some(1), "{text}");
    assert!(
        text.contains("limits with `severity: error` are not kept: efficient"),
        "{text}"
    );
    assert!(
        text.contains("m: life: basic rating life L10h of bearing B2 is"),
        "{text}"
    );
    assert!(
        text.contains("the limits `life`, `film` and `efficient` are not kept"),
        "{text}"
    );
    assert_eq!(run("warning").0, Some(0));
    let report = std::fs::read_to_string(folder.join("results/report.html")).unwrap();
    assert!(report.contains("limit life: basic rating life L10h of bearing B2"));
}
