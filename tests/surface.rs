//! Deviation from measured points over two quantities: of points that a model made itself, and beside `compare`.

use crate::common::study::{Ran, number, of_gearbox, run_texts};
use std::fmt::Write as _;

use serde_json::Value;

const SETS: &str = "model_sets:
  joint:
    gear_mesh: { type: path_integral, load_sharing: rigid, tooth_friction: { type: xu } }
    gear_drag: { churning: { type: changenet_2011 } }
    bearing: { type: skf }
    seal: { type: iso14179_2 }
  fast: { extends: joint, seal: { type: formula, formula: \"0.01 * sqrt(7000 - abs(speed))\" } }
  never: { extends: joint, seal: { type: formula, formula: \"sqrt(-1)\" } }
grids:
  few: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 8000 rpm] }
";

const KV: &str = "lubricants.sump.viscosity.kv100";
const LEVEL: &str = "housing.oil.level_offset";

/// Runs analyses of the two-speed example beside a file of points; their results and what was printed.
fn run(conditions: &str, analyses: &str, points: &str) -> (Ran, String) {
    let study = format!("conditions: {{ {conditions} }}\n{SETS}analyses:\n{analyses}");
    let study = of_gearbox("examples/two-speed-ev/gearbox.yaml", &study);
    run_texts(&study, &[("rig.csv", points)]).with_text()
}

/// Points of the set `joint` with other values than the gearbox has; the last one is spoilt and has no weight.
fn made() -> String {
    let set = format!("oil_temperature: 100 degC, set: {{ {KV}: 7 mm2/s, {LEVEL}: -5 mm }}");
    let map = "  made: { type: map, grid: few, model_sets: [joint] }\n";
    let (results, _) = run(&set, map, "");
    let mut rig = "torque [Nm],speed [rpm],loss [W],weight\n".to_owned();
    for p in results.json("made")["maps"][0]["points"].as_array().unwrap() {
        let _ = writeln!(rig, "{},{},{},2", p["torque_nm"], p["speed_rpm"], p["loss_w"]);
    }
    rig + "10,5000,999,0\n"
}

fn surface(more: &str) -> String {
    format!(
        "type: rms_surface, gear: first, quantity: loss, data: {{ file: rig.csv }}, x: {{ path: {KV}, values: [5 mm2/s, 6.4 mm2/s, 7 mm2/s, 9 mm2/s] }}, y: {{ path: {LEVEL}, values: [-10 mm, -5 mm, 0 mm] }}{more}"
    )
}

/// The values that made the points are found, and an end of the values is told where they lie beyond.
#[test]
fn the_least_lies_at_the_values_that_made_the_points() {
    let all = surface(", against: [joint]");
    let short = all.replace(", 7 mm2/s, 9 mm2/s", "");
    let study = format!("  all: {{ {all} }}\n  short: {{ {short} }}\n");
    let (results, text) = run("oil_temperature: 100 degC", &study, &made());
    let found = results.json("all")["surfaces"][0].clone();
    let least = &found["least"];
    assert_eq!((number(&least["x"]), number(&least["y"])), (7.0, -5.0), "{text}");
    assert!(number(&least["rms"]) < 1e-6, "{least}");
    assert!(least["x_end"].is_null() && least["y_end"].is_null() && found["accuracy"].is_null());
    assert_eq!(found["pairs"].as_array().unwrap().len(), 12);
    assert!(
        text.contains("mm, inside the surface; within 5 % of the minimum: ") && text.contains(" only"),
        "{text}"
    );
    let least = results.json("short")["surfaces"][0]["least"].clone();
    assert_eq!((number(&least["x"]), &least["x_end"]), (6.4, &Value::from("upper")));
    assert!(text.contains("the minimum may be above 6.4 mm2/s"), "{text}");
    let picture = results.picture("all-joint");
    assert!(picture.contains("cross: minimum"));
    let csv = results.csv("all");
    assert!(csv.starts_with(&format!("model_set,{KV},{LEVEL},points,rms_w\n")) && csv.lines().count() == 13);
}

/// At the values of the gearbox the deviation is that of `compare`, for the same file with its bound column and weights.
#[test]
fn at_the_own_values_it_is_the_deviation_of_a_comparison() {
    let points =
        "torque [Nm],speed [rpm],efficiency [%],efficiency_accuracy [%],oil_temperature [degC],weight,ra [um],gear
5,2000,97.1,0.3,90,1,0.3,first
10,8000,97.9,0.2,100,3,0.4,first
20,16000,98.2,0.1,80,1,0.3,second
";
    let data = "data: { file: rig.csv, stated_as: standard }, bind: { ra: surface.ra }, against: [joint, ours/own]";
    let study = format!(
        "  both: {{ type: compare, {data} }}
  percent: {{ type: compare, {data}, difference: percent }}
  points: {{ type: rms_surface, {data}, x: {{ path: {KV}, values: [6, 6.4] }}, y: {{ path: {LEVEL}, values: [0 mm, 5 mm] }} }}
  shares: {{ type: rms_surface, {data}, difference: percent, x: {{ path: {KV}, values: [6, 6.4] }}, y: {{ path: {LEVEL}, values: [0 mm, 5 mm] }} }}
"
    );
    let (results, text) = run("", &study, points);
    for (compared, surface) in [("both", "points"), ("percent", "shares")] {
        for set in 0..2 {
            let rms = number(&results.json(compared)["comparisons"][set]["difference"]["rms"]);
            let of_set = results.json(surface)["surfaces"][set].clone();
            assert_eq!(
                (number(&of_set["pairs"][1]["x"]), number(&of_set["pairs"][1]["y"])),
                (6.4, 0.0)
            );
            let here = number(&of_set["pairs"][1]["rms"]);
            assert!((here - rms).abs() < 1e-9 * rms, "{here} {rms}\n{text}");
            assert!(number(&of_set["pairs"][0]["rms"]) != here);
        }
    }
    // Root of the mean of 0.3, 0.2 and 0.1 points squared.
    let accuracy = number(&results.json("points")["surfaces"][0]["accuracy"]);
    assert!((accuracy - (0.14_f64 / 3.0).sqrt()).abs() < 1e-12);
    assert!(
        text.contains("within the accuracy of one measurement, 0.216: "),
        "{text}"
    );
}

/// Points without a value somewhere are left out everywhere and named; pairs without any value are named and count nowhere.
#[test]
fn all_pairs_stand_on_the_same_points() {
    let points = "torque [Nm],speed [rpm],loss [W]\n5,2000,60\n10,6000,140\n10,8000,200\n";
    let blind = surface(", against: [joint, fast]");
    let far = surface(", against: [joint]").replace(
        &format!("path: {LEVEL}, values: [-10 mm, -5 mm, 0 mm]"),
        "path: \"bearings.*.at\", tie: factor, values: [1, 1000000]",
    );
    let study = format!("  blind: {{ {blind} }}\n  far: {{ {far} }}\n");
    let (results, text) = run("oil_temperature: 100 degC", &study, points);
    for set in 0..2 {
        let found = results.json("blind")["surfaces"][set].clone();
        assert_eq!(
            (&found["points"], &found["left_out"][0]["line"]),
            (&Value::from(2), &Value::from(4)),
            "{text}"
        );
    }
    assert!(
        text.contains("1 of 3 points have no value at some pair") && text.contains("line 4: models fast, "),
        "{text}"
    );
    let far = results.json("far")["surfaces"][0].clone();
    assert_eq!(
        (&far["points"], &far["pairs"][4]["rms"]),
        (&Value::from(3), &Value::Null)
    );
    assert!(
        far["pairs"][4]["reason"].as_str().unwrap().contains("out of range"),
        "{far}"
    );
    assert!(text.contains("no value at "), "{text}");
}

#[test]
fn what_cannot_be_drawn_is_reported_with_its_place_and_how_to_fix_it() {
    let points = "torque [Nm],speed [rpm],loss [W],kv\n5,2000,60,6\n";
    let good = surface(", against: [joint]");
    let replaced = |from: &str, to: &str| {
        assert!(good.contains(from));
        good.replace(from, to)
    };
    for (analysis, said) in [
        (replaced(KV, "lubricants.sump.viscosity.kv900"), ["kv900", "-->"]),
        (
            replaced(LEVEL, KV).replace("-10 mm, -5 mm, 0 mm", "5, 6"),
            ["change the same value", "analyses.what.y.path"],
        ),
        (
            replaced("5 mm2/s, 6.4 mm2/s", "7 mm2/s, 6.4 mm2/s"),
            ["the values are not ascending", "analyses.what.x.values.1"],
        ),
        (
            replaced("5 mm2/s, 6.4 mm2/s", "-5 mm2/s, 6.4 mm2/s"),
            ["-5 mm2/s is outside", "analyses.what.x.values.0"],
        ),
        (
            replaced("5 mm2/s, 6.4 mm2/s", "5 mm, 6.4 mm2/s"),
            ["kv100", "analyses.what.x.values.0"],
        ),
        (replaced("[-10 mm, -5 mm, 0 mm]", "[0 mm]"), ["values", "2"]),
        (
            replaced("rig.csv", "nowhere.csv"),
            ["nowhere.csv: cannot read", "analyses.what.data"],
        ),
        (
            replaced("quantity: loss", "quantity: temperature"),
            ["there is no measured oil_temperature_degc", "columns of torque"],
        ),
        (
            replaced("quantity: loss", "quantity: temperature, difference: percent"),
            ["a temperature difference cannot be in percent", "kelvins"],
        ),
        (
            format!("{good}, bind: {{ kv: {KV} }}"),
            ["column `kv` of the data changes", "analyses.what.x.path"],
        ),
        (
            replaced("[joint]", "[never]"),
            [
                "models never: no pair has a value: no point has a value: seals.D1",
                "move the values",
            ],
        ),
        (
            replaced(LEVEL, "thermal.oil").replace("-10 mm, -5 mm, 0 mm", "90, 100"),
            ["the conditions fix the temperature", "analyses.what.y.path"],
        ),
    ] {
        let study = format!("  what: {{ {analysis} }}\n");
        let (_, text) = run("oil_temperature: 100 degC", &study, points);
        for said in said {
            assert!(text.contains(said), "{analysis}: {said}\n{text}");
        }
        assert!(text.contains("help:"), "{text}");
    }
}
