//! Points, drawings, maps and texts.

use serde_json::{Value, json};

use super::common::{about, example, fault, first_point, value};

fn near(a: &Value, b: f64, tolerance: f64) {
    let a = a.as_f64().unwrap();
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
}

/// A loss is the sum of those of its components, and of the parts of the drawing.
#[test]
fn a_point_is_the_sum_of_its_components() {
    let session = about("two-speed-ev");
    let point = json!({
        "request": "point", "texts": {}, "gearbox": "gearbox.yaml", "gear": "first",
        "inputs": [
            { "quantity": "torque", "port": "input", "value": 10.0 },
            { "quantity": "speed", "port": "input", "value": 3000.0 },
        ],
        "oil_temperature": 60.0, "model_set": "joint",
    });
    let answer = value(&session, point);
    assert_eq!(answer["loss"], answer["point"]["loss_w"]);
    let parts = answer["losses"].as_array().unwrap();
    let sum: f64 = parts.iter().filter_map(|part| part["loss"].as_f64()).sum();
    near(&answer["loss"], sum, 1e-9);
    let drawn: f64 = answer["drawing"]
        .as_array()
        .unwrap()
        .iter()
        .map(|part| part[1].as_f64().unwrap())
        .sum();
    near(&answer["loss"], drawn, 1e-9);
    let losses: Vec<f64> = parts.iter().filter_map(|part| part["loss"].as_f64()).collect();
    assert!(losses.is_sorted_by(|a, b| a >= b), "{losses:?}");
}

/// What `solve` says last is what the notes of the page say first.
#[test]
fn what_is_outside_its_range_is_a_remark() {
    let session = about("two-speed-ev");
    let mut request = first_point(&session, &json!({}), "gearbox.yaml");
    request["model_set"] = json!("joint");
    let answer = value(&session, request);
    let blocks = answer["blocks"].as_array().unwrap();
    assert!(blocks.iter().any(|block| block["table"]["rows"][0][0] == "component"));
    let texts = blocks.iter().filter_map(|block| block["text"].as_str());
    let lines = texts.flat_map(str::lines);
    let outside: Vec<&str> = lines.filter(|line| line.starts_with("outside: ")).collect();
    let remarks: Vec<&str> = answer["remarks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r.as_str().unwrap())
        .collect();
    assert!(
        !outside.is_empty() && remarks.starts_with(&outside),
        "{outside:?} {remarks:?}"
    );
}

/// Both outputs of a differential turn alike at the first point, which has a result.
#[test]
fn the_first_point_of_a_differential_has_a_result() {
    let session = about("e-axle");
    let answer = value(&session, first_point(&session, &json!({}), "gearbox.yaml"));
    assert!(answer["loss"].as_f64().unwrap() > 0.0, "{answer}");
    let speed = |name: &str| {
        let members = answer["point"]["members"].as_array().unwrap().iter();
        members
            .clone()
            .find(|member| member["member"] == name)
            .map(|member| member["speed_rpm"].as_f64().unwrap())
    };
    let (left, right) = (speed("left_shaft").unwrap(), speed("right_shaft").unwrap());
    assert!((left / right - 1.0).abs() < 1e-3, "{left} {right}");
}

/// Unsaved texts count, and only for the request that has them.
#[test]
fn unsaved_texts_are_solved() {
    let session = about("two-speed-ev");
    let text = std::fs::read_to_string(example("two-speed-ev").join("gearbox.yaml")).unwrap();
    let saved = value(&session, first_point(&session, &json!({}), "gearbox.yaml"));
    let texts = json!({ "gearbox.yaml": text.replace("oil: 100 degC", "oil: 90 degC") });
    let changed = value(&session, first_point(&session, &texts, "gearbox.yaml"));
    assert_ne!(saved["loss"], changed["loss"]);
    assert_eq!(
        saved,
        value(&session, first_point(&session, &json!({}), "gearbox.yaml"))
    );
    let texts = json!({ "gearbox.yaml": text.replace("bearings:", "bearigs:") });
    let answer = fault(
        &session,
        json!({ "request": "controls", "texts": texts, "gearbox": "gearbox.yaml" }),
    );
    assert_eq!(answer["findings"][0]["help"], "write `bearings`");
}

/// The steps of the monitor end where the balance is: a temperature with a residual of nearly zero.
#[test]
fn the_monitor_follows_a_heat_balance() {
    let session = about("planetary-reducer");
    let answer = value(&session, first_point(&session, &json!({}), "gearbox.yaml"));
    let convergence = &answer["convergence"];
    assert_eq!(convergence["of"], "balance", "{convergence}");
    let steps = convergence["steps"].as_array().unwrap();
    assert!(steps.len() > convergence["scanned"].as_u64().unwrap() as usize);
    let last = steps.last().unwrap();
    near(&last["temperature"], answer["oil"].as_f64().unwrap(), 1e-3);
    let loss = answer["loss"].as_f64().unwrap();
    assert!(
        last["residual"].as_f64().unwrap().abs() < 1e-3 * loss,
        "{last}, loss {loss}"
    );
    assert_eq!(convergence["picture"]["kind"], "lines");
}

#[test]
fn the_monitor_follows_a_network() {
    let session = about("electric-drive-unit");
    let answer = value(&session, first_point(&session, &json!({}), "gearbox.yaml"));
    let convergence = &answer["convergence"];
    assert_eq!(
        (&convergence["of"], &convergence["unit"]),
        (&json!("network"), &json!("K"))
    );
    let steps = convergence["steps"].as_array().unwrap();
    let changes: Vec<f64> = steps.iter().map(|step| step["residual"].as_f64().unwrap()).collect();
    assert!(changes.len() > 2 && changes[0] > 1.0, "{changes:?}");
    assert!(*changes.last().unwrap() < 0.01, "{changes:?}");
}

/// Every part of the drawing has its place; the text there is its name.
#[test]
fn parts_of_a_drawing_lead_to_their_lines() {
    for name in ["two-speed-ev", "planetary-reducer", "electric-drive-unit", "e-axle"] {
        let session = about(name);
        let text = std::fs::read_to_string(example(name).join("gearbox.yaml")).unwrap();
        let answer = value(
            &session,
            json!({ "request": "drawing", "texts": {}, "gearbox": "gearbox.yaml" }),
        );
        let places = answer["places"].as_object().unwrap();
        let parts = answer["svg"].as_str().unwrap().matches("data-part=").count();
        assert!(
            parts > 5 && places.len() == parts,
            "{name}: {} places of {parts} parts",
            places.len()
        );
        for (part, place) in places {
            let [from, to] = ["from", "to"].map(|end| place["range"][end].as_u64().unwrap() as usize);
            assert_eq!(&text[from..to], part.rsplit('.').next().unwrap(), "{name}");
        }
    }
}

#[test]
fn parts_are_explained() {
    let session = about("two-speed-ev");
    for (part, expected) in [("bearings.B1", "bearings.B1"), ("gears.G1", "meshes.M1")] {
        let mut request = first_point(&session, &json!({}), "gearbox.yaml");
        request["request"] = json!("explain");
        request["part"] = json!(part);
        let answer = value(&session, request);
        assert!(answer["text"].as_str().unwrap().contains(expected), "{answer}");
    }
}

/// A cell of the map is the point there.
#[test]
fn a_map_has_the_losses_of_its_points() {
    let session = about("two-speed-ev");
    let map = json!({
        "request": "map", "texts": {}, "gearbox": "gearbox.yaml", "gear": "first", "model_set": "", "oil_temperature": null,
        "torque": { "from": 0.0, "to": 10.0 }, "speed": { "from": 0.0, "to": 10000.0 }, "count": 5,
    });
    let section = value(&session, map);
    let picture = &section["pictures"][0];
    let quantities = picture["quantities"].as_array().unwrap();
    let loss = quantities.iter().find(|quantity| quantity["unit"] == "W").unwrap();
    assert_eq!(picture["x"][1], json!([2000.0, 4000.0, 6000.0, 8000.0, 10000.0]));
    assert_eq!(picture["y"][1], json!([2.0, 4.0, 6.0, 8.0, 10.0]));
    let mut point = first_point(&session, &json!({}), "gearbox.yaml");
    point["inputs"][0]["value"] = json!(4.0);
    point["inputs"][1]["value"] = json!(6000.0);
    let solved = value(&session, point);
    assert_eq!(loss["panels"][0][5 + 2], solved["loss"]);
    for (count, torque, message) in [(5, [3.0, 3.0], "empty"), (5, [4.0, 1.0], "empty")] {
        let map = json!({
            "request": "map", "texts": {}, "gearbox": "gearbox.yaml", "gear": "first", "model_set": "", "oil_temperature": null,
            "torque": { "from": torque[0], "to": torque[1] }, "speed": { "from": 0.0, "to": 10000.0 }, "count": count,
        });
        let fault = fault(&session, map);
        assert!(fault["message"].as_str().unwrap().contains(message), "{fault}");
    }
}

/// Another volume of oil has the level that belongs to it: the point is that of a file with both, as is the map.
#[test]
fn a_given_volume_has_its_level() {
    let session = about("two-speed-ev");
    let text = std::fs::read_to_string(example("two-speed-ev/gearbox.yaml")).unwrap();
    let text = text.replace("{ type: iso14179_2, speed_of: pinion }", "{ type: changenet_2011 }");
    let law = json!({ "gearbox.yaml": text });
    let controls = value(
        &session,
        json!({ "request": "controls", "texts": law, "gearbox": "gearbox.yaml" }),
    );
    let [from, value_, to] = ["from", "value", "to"].map(|key| controls["fill"][key].as_f64().unwrap());
    assert!(from < value_ && value_ < to && value_ == 1.2, "{controls}");
    let point = first_point(&session, &law, "gearbox.yaml");
    let solved = |volume: Value| {
        let mut point = point.clone();
        point["oil_volume"] = volume;
        value(&session, point)
    };
    let (own, less, more) = (solved(Value::Null), solved(json!(1.0)), solved(json!(1.5)));
    let level = |answer: &Value| answer["point"]["oil_level"]["at_rest_mm"].as_f64().unwrap();
    assert_eq!(level(&own), -49.0);
    assert!(level(&less) < level(&more), "{less} {more}");
    assert!(less["loss"].as_f64() < more["loss"].as_f64());
    for answer in [&own, &less, &more] {
        let drawn = answer["oil_section"].as_str().unwrap();
        assert!(drawn.starts_with("<svg") && drawn.contains("oil at rest"), "{drawn}");
    }
    let mut map = json!({
        "request": "map", "texts": law, "gearbox": "gearbox.yaml", "gear": "first", "model_set": "", "oil_temperature": null,
        "oil_volume": 1.5, "torque": { "from": 0.0, "to": 10.0 }, "speed": { "from": 0.0, "to": 10000.0 }, "count": 5,
    });
    let section = value(&session, map.clone());
    let quantities = section["pictures"][0]["quantities"].as_array().unwrap().clone();
    let loss = quantities.iter().find(|quantity| quantity["unit"] == "W").unwrap();
    let mut there = point.clone();
    there["oil_volume"] = json!(1.5);
    there["inputs"][0]["value"] = json!(4.0);
    there["inputs"][1]["value"] = json!(6000.0);
    assert_eq!(loss["panels"][0][5 + 2], value(&session, there)["loss"]);
    map["oil_volume"] = json!(90.0);
    for request in [map, {
        let mut point = point.clone();
        point["oil_volume"] = json!(90.0);
        point
    }] {
        let fault = fault(&session, request);
        assert!(
            fault["message"].as_str().unwrap().contains("90 l of oil have no level"),
            "{fault}"
        );
    }
}

/// What cannot be solved is told with what to do.
#[test]
fn wrong_points_are_refused() {
    let session = about("two-speed-ev");
    let point = first_point(&session, &json!({}), "gearbox.yaml");
    let with = |key: &str, wrong: Value| {
        let mut point = point.clone();
        point[key] = wrong;
        point
    };
    for (request, expected) in [
        (with("gear", json!("fifth")), "fifth"),
        (with("oil_temperature", json!(900.0)), "900 degC"),
        (with("model_set", json!("none such")), "none such"),
        (with("gearbox", json!("other.yaml")), "other.yaml"),
        (with("inputs", json!([])), "torque"),
        (
            with(
                "inputs",
                json!([{ "quantity": "speed", "port": "nowhere", "value": 1.0 }]),
            ),
            "nowhere",
        ),
    ] {
        let fault = fault(&session, request);
        assert!(fault["message"].as_str().unwrap().contains(expected), "{fault}");
        assert!(fault["help"].is_string(), "{fault}");
    }
}

#[test]
fn catalogues_are_searched() {
    let session = about("two-speed-ev");
    let search = |of: &str, text: &str| value(&session, json!({ "request": "catalogue", "of": of, "text": text }));
    let found = search("bearings", "6208");
    assert!(
        found.as_array().unwrap().iter().any(|row| row["designation"] == "6208"),
        "{found}"
    );
    assert_eq!(search("bearings", "6208-2RS1")[0]["designation"], "6208-2RS1");
    assert_eq!(search("bearings", "SKF 6207-2RS")[0]["designation"], "6207-2RS");
    assert!(!search("oils", "vg 150").as_array().unwrap().is_empty());
    assert_eq!(search("materials", "pom")[0]["designation"], "POM");
    assert_eq!(search("bearings", "no such"), json!([]));
}
