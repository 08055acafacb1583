//! The analyses of one component and of one path of contact agree with the whole transmission.

use crate::common::study::{Ran, number, of_gearbox, run_texts};

/// Runs a study on the two-speed example; its results and what it prints.
fn run(analyses: &str, files: &[(&str, &str)]) -> (Ran, String) {
    let study = of_gearbox("examples/two-speed-ev/gearbox.yaml", &format!("analyses:\n{analyses}"));
    run_texts(&study, files).with_text()
}

const POINT: &str = "torque: 10 Nm, speed: 10000 rpm";

#[test]
fn the_loss_along_the_path_is_that_of_the_mesh() {
    let analyses = format!(
        "  contact: {{ type: contact_path, model_sets: [joint], mesh: M1, {POINT}, places: 2001 }}\n  \
           whole: {{ type: breakdown, model_sets: [joint], by: component, {POINT} }}\n"
    );
    let (results, text) = run(&analyses, &[]);
    let contact = results.json("contact");
    let places = contact["paths"][0]["places"].as_array().expect(&text);
    let column = |key: &str| -> Vec<f64> { places.iter().map(|p| p[key].as_f64().unwrap()).collect() };
    let integral = |values: &[f64]| -> f64 {
        let x = column("from_pitch_point_mm");
        x.windows(2)
            .zip(values.windows(2))
            .map(|(x, y)| 0.5 * (y[0] + y[1]) * (x[1] - x[0]))
            .sum()
    };
    // The shares add up to one base pitch, so the mean over a cycle needs no other length.
    let mean = integral(&column("sliding_loss_w")) / integral(&column("load_share"));
    let whole = results.json("whole");
    let breakdown = &whole["breakdowns"][0];
    let shares = breakdown["shares"].as_array().unwrap();
    let place = shares.iter().position(|s| s == "meshes.M1").unwrap();
    let mesh = breakdown["points"][0]["losses_w"][place].as_f64().unwrap();
    // The trapezium crosses four jumps of the share.
    assert!((mean / mesh - 1.0).abs() < 3e-3, "{mean} {mesh}");
}

#[test]
fn models_of_one_component_stand_beside_measured_points() {
    let analyses = "  b1:\n    type: component_compare\n    component: bearings.B1\n    torque: [10 Nm]\n    speed: [5000 rpm, 10000 rpm]\n    \
                    measured: { file: measured.csv }\n    models: { iso: { type: iso14179_2 }, double: { type: iso14179_2, f1: 0.0018 }, off: none }\n";
    let first = run(
        analyses,
        &[(
            "measured.csv",
            "torque [Nm],speed [rpm],loss [W]\n10,5000,1\n10,10000,1e-300\n",
        )],
    );
    // A loss that nobody can have measured has no deviation in percent.
    assert!(
        first.1.contains("note: 1 points are omitted") && !first.1.contains("inf"),
        "{}",
        first.1
    );
    let compared = first.0.json("b1")["component_comparison"].clone();
    let loss = |model: usize, point: usize| compared["models"][model]["points"][point]["loss_w"].as_f64().unwrap();
    let term = |model: usize, name: &str| {
        compared["models"][model]["points"][0]["terms_w"][name]
            .as_f64()
            .unwrap()
    };
    assert!(loss(0, 1) > loss(0, 0) && loss(2, 0) == 0.0);
    assert!((term(0, "load") + term(0, "no_load") - loss(0, 0)).abs() < 1e-12);
    // A bearing that loses 0.1 % more of the power leaves that much less load, to the power of 1.55.
    assert!((term(1, "load") / term(0, "load") - 2.0).abs() < 1e-2);
    let percent = compared["deviations"][0]["mean_percent"].as_f64().unwrap();
    assert!((percent - 100.0 * (loss(0, 0) - 1.0)).abs() < 1e-9, "{percent}");
    let csv = first.0.csv("b1");
    assert!(csv.contains("measured,10,5000,total,1,"), "{csv}");
}

/// One model that cannot answer fails the analysis, and keeps no other from its file.
#[test]
fn what_the_other_models_answered_is_kept() {
    let (results, text) = run(
        "  b1:\n    type: component_compare\n    component: bearings.B1\n    torque: [10 Nm]\n    speed: [5000 rpm]\n    \
         models: { iso: { type: iso14179_2 }, timken: { type: timken } }\n",
        &[],
    );
    assert!(!results.succeeded, "{text}");
    assert!(results.json("b1").to_string().contains("\"iso\""), "{text}");
}

#[test]
fn wrong_names_and_files_say_what_to_write() {
    let (_, text) = run(
        "  a: { type: contact_path, mesh: M9, torque: 1 Nm, speed: 100 rpm }\n  \
           b: { type: component_compare, component: bearings.B9, models: { x: { type: skf } }, torque: 1 Nm, speed: 100 rpm }\n  \
           c: { type: component_compare, component: bearings.B1, models: { x: { type: skff } }, torque: 1 Nm, speed: 100 rpm }\n  \
           d: { type: component_compare, component: bearings.B1, models: { x: { type: skf } }, torque: 1 Nm, speed: 100 rpm, measured: { file: none.csv } }\n  \
           e: { type: component_compare, component: bearings.B1, models: {}, torque: 1 Nm, speed: 100 rpm }\n",
        &[],
    );
    for words in [
        "no mesh is called `M9`",
        "B9",
        "write `skf`",
        "none.csv",
        "no model is given",
    ] {
        assert!(text.contains(words), "{words} is missing:\n{text}");
    }
}

#[test]
fn the_loss_outside_a_range_is_that_of_the_component_at_the_points_outside() {
    let rest = "grids: { field: { gear: first, torque: [0 Nm, 8 Nm, 16 Nm], speed: { from: 2000 rpm, to: 20000 rpm, step: 2000 rpm } } }\n\
                analyses: { maps: { type: map, grid: field, write: [json] } }";
    let ran = run_texts(&of_gearbox("examples/two-speed-ev/gearbox.yaml", rest), &[]);
    let result = ran.json("maps");
    let map = &result["maps"][0];
    let points = map["points"].as_array().unwrap();
    let total: f64 = points.iter().map(|point| number(&point["loss_w"])).sum();
    let parts = map["parts"].as_array().unwrap();
    let mut torques: Vec<f64> = points.iter().map(|point| number(&point["torque_nm"])).collect();
    torques.sort_by(f64::total_cmp);
    let mut counts = Vec::new();
    for note in map["notes"].as_array().unwrap() {
        let outside = note["outside"].as_u64().unwrap() as usize;
        if note["name"] != "F_bt/b" || outside == 0 {
            continue;
        }
        // The line load grows with the torque, so the points with the smallest torques are below its range.
        let path = note["path"].as_str().unwrap().trim_end_matches(".model");
        let place = parts.iter().position(|part| part["part"] == path).unwrap();
        let lightest = points
            .iter()
            .filter(|point| number(&point["torque_nm"]) <= torques[outside - 1]);
        let lost: f64 = lightest.map(|point| number(&point["parts_w"][place])).sum();
        let share = number(&note["loss_share"]);
        assert!((share - lost / total).abs() < 1e-9, "{path}: {share} {}", lost / total);
        counts.push(outside);
    }
    assert_eq!(counts, [30, 20, 30]);
}
