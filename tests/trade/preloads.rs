//! Opposed bearings with a stated preload: their axial loads, what temperature makes of it, and what is reported.

use serde_json::Value;

use super::{Case, changed};
use crate::common;

const POINT: [&str; 4] = ["--torque", "0 Nm", "--speed", "1500 rpm"];
const PRELOAD: &str = "preload: { force: 1000 N, distance: 120 mm, housing: { material: steel } }";
const AT_B: &str = "pitch_diameter: 52.237634189792 mm }";

/// A solved point.
fn solved(case: &Case, text: &str, more: &[&str]) -> Value {
    case.write("changed.yaml", text);
    let mut args = [&["solve", "changed.yaml", "--format", "json"], &POINT[..], more].concat();
    // With ideal flow the friction of the bearings adds no tooth force.
    args.extend(["--power-flow", "ideal"]);
    let said = case.gearloss(&args);
    assert_eq!(said.code, Some(0), "{}", said.text);
    serde_json::from_str(&said.text).unwrap()
}

fn axial(point: &Value) -> [f64; 2] {
    [0, 1].map(|bearing: usize| point["supports"][bearing]["axial_n"].as_f64().unwrap())
}

fn number(point: &Value, key: &str) -> f64 {
    point["preloads"][0][key].as_f64().unwrap()
}

/// Radial loads of A and B, thrust, preload at the temperature of the oil, axial loads; by an independent calculation (SciPy).
#[test]
fn axial_loads_are_those_of_the_load_distributions() {
    let case = Case::new("preloaded-bearings", "loads");
    let play = "closing: 0 um";
    for (radial, thrust, preload, expected) in [
        ([0, 0], 500, "force: 1000 N", [753.152_941, 1_253.152_94]),
        ([2000, 3000], 0, "force: 1000 N", [1_129.774_84, 1_129.774_84]),
        ([2000, 3000], 500, "force: 1000 N", [827.415_441, 1_327.415_44]),
        (
            [2000, 3000],
            500,
            "closing: 10.239077930 um",
            [827.415_441, 1_327.415_44],
        ),
        ([2000, 3000], 500, play, [583.741_361, 1_083.741_36]),
        ([2000, 3000], 0, play, [886.322_994, 886.322_994]),
        // Mirrored.
        ([3000, 2000], -500, play, [1_083.741_36, 583.741_361]),
    ] {
        let [at_a, at_b] = radial;
        let text = changed(
            &case,
            &[
                ("[500 N, 2000 N, 0 N]", &format!("[{thrust} N, {at_a} N, 0 N]")),
                ("[0 N, 3000 N, 0 N]", &format!("[0 N, {at_b} N, 0 N]")),
                ("force: 1000 N", &format!("mounting_temperature: 60 degC, {preload}")),
            ],
        );
        let point = solved(&case, &text, &[]);
        for (found, expected) in axial(&point).into_iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-3,
                "{radial:?} {thrust} {preload}: {found} {expected}"
            );
        }
        assert!(point["supports"][0]["induced_n"].is_null());
        assert_eq!(number(&point, "thermal_closing_um"), 0.0);
    }
}

/// 60 K of the shaft, 45 K of the housing: by hand, of the formula.
#[test]
fn temperatures_change_the_closing() {
    let case = Case::new("preloaded-bearings", "temperatures");
    for (turned, material, follows, expected) in [
        (false, "steel", 0, 65.670_881_2),
        (true, "steel", 0, 24.270_881_2),
        (false, "aluminium", 1, -131.341_762_4),
        (true, "aluminium", 1, -48.541_762_4),
    ] {
        let preload = format!(
            "preload: {{ force: 1000 N, distance: 120 mm, ring_follows: {follows}, shaft: {{ temperature: 80 degC }}, \
             housing: {{ temperature: 65 degC, material: {material} }} }}"
        );
        let mut changes = vec![(PRELOAD, preload.as_str())];
        if turned {
            changes.extend([
                ("axial: left", "axial: RIGHT"),
                ("axial: right", "axial: left"),
                ("RIGHT", "right"),
            ]);
        }
        let point = solved(&case, &changed(&case, &changes), &[]);
        let found = number(&point, "thermal_closing_um");
        assert!((found - expected).abs() < 1e-6, "{turned} {material}: {found}");
        let whole = number(&point, "closing_um");
        assert!((whole - found - 10.239_077_930).abs() < 1e-6, "{whole}");
        assert_eq!(number(&point, "preload_n") == 0.0, whole < 0.0);
        assert_eq!(point["preloads"][0]["lost"].as_bool(), Some(whole < 0.0));
    }
}

/// The oil is the default: an aluminium housing loosens bearings face to face, and the loss of preload is noted.
#[test]
fn lost_preload_is_noted() {
    let case = Case::new("preloaded-bearings", "lost");
    let text = changed(
        &case,
        &[
            ("material: steel", "material: aluminium"),
            ("500 N, 2000 N", "0 N, 2000 N"),
        ],
    );
    let cold = solved(&case, &text, &["--oil-temperature", "20 degC"]);
    assert!((axial(&cold)[0] - 1_129.774_84).abs() < 1e-3, "{cold}");
    assert_eq!(cold["preloads"][0]["lost"].as_bool(), Some(false));
    let warm = solved(&case, &text, &[]);
    // Loose outer rings of steel grow with the inner ones, the housing is longer: 40 K of 11.5e-6 and 120 mm.
    assert!((number(&warm, "thermal_closing_um") + 55.2).abs() < 1e-6, "{warm}");
    let notes = warm["notes"].as_array().unwrap();
    let lost = notes
        .iter()
        .filter(|note| note["name"] == "closing" && note["path"] == "bearings.B");
    assert_eq!(lost.count(), 1, "{warm}");
    let args = [&["solve", "changed.yaml"], &POINT[..]].concat();
    let said = case.gearloss(&args);
    for line in [
        "pair A/B of a: end play 44.96 um, of it -55.2",
        "preload lost",
        "closing",
    ] {
        assert!(said.text.contains(line), "{line}\n{}", said.text);
    }
}

/// Shaft and casing of `network: auto` have the temperatures of their nodes, which the friction under preload warms.
#[test]
fn a_network_has_the_temperatures() {
    let case = Case::new("preloaded-bearings", "network");
    let example = common::file("examples/industrial-reducer/gearbox.yaml");
    case.write("reducer.yaml", std::fs::read_to_string(example).unwrap());
    let solved = |closing: &str| -> Value {
        let preload = format!("bearings.B1.preload={{ closing: {closing}, housing: {{ material: cast_iron }} }}");
        let said = case.gearloss(&[
            "solve",
            "reducer.yaml",
            "--torque",
            "290 Nm",
            "--speed",
            "1480 rpm",
            "--set",
            "thermal={ mode: network, network: auto, ambient: 20 degC }",
            "--set",
            &preload,
            "--format",
            "json",
        ]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        serde_json::from_str(&said.text).unwrap()
    };
    let points = ["-120 um", "-80 um"].map(solved);
    for point in &points {
        let nodes = point["network"]["nodes"].as_array().unwrap();
        for (key, name) in [("shaft_degc", "input"), ("housing_degc", "casing")] {
            let node = nodes.iter().find(|node| node["node"] == name).unwrap();
            let temperature = node["temperature_degc"].as_f64().unwrap();
            assert!((number(point, key) - temperature).abs() < 1e-6, "{point}");
        }
    }
    let [loose, tight] = &points;
    assert!(tight["loss_w"].as_f64() > loose["loss_w"].as_f64());
    assert!(number(tight, "shaft_degc") > number(loose, "shaft_degc"));
    // The friction of the tighter pair closes it further.
    assert!(number(tight, "closing_um") - number(loose, "closing_um") > 41.0);
}

#[test]
fn a_torque_is_that_of_the_friction_models() {
    let case = Case::new("preloaded-bearings", "torque");
    let text = changed(
        &case,
        &[
            ("bearing: none", "bearing: { type: skf }"),
            (
                "contact_angle: 14 deg",
                "contact_angle: 14 deg, y: 1.6, width: 20 mm, series: \"302\"",
            ),
        ],
    );
    // Without other loads and oil bath the moment of both bearings at 1500 rpm under 1000 N.
    let alone = text
        .replace("[500 N, 2000 N, 0 N]", "[0 N, 0 N, 0 N]")
        .replace("[0 N, 3000 N, 0 N]", "[0 N, 0 N, 0 N]")
        .replace("force: 1000 N", "force: 1000 N, mounting_temperature: 60 degC");
    let point = solved(&case, &alone, &[]);
    let moments = point["parts"].as_array().unwrap().iter();
    let moments = moments.filter(|part| part["mechanism"] == "bearing");
    let torque: f64 = moments.map(|part| part["moment_of_one_nm"].as_f64().unwrap()).sum();
    assert!(torque > 0.0, "{point}");
    let stated = alone.replace("force: 1000 N", &format!("torque: {torque} Nm, torque_speed: 1500 rpm"));
    let again = solved(&case, &stated, &[]);
    assert!((number(&again, "preload_n") - 1000.0).abs() < 1e-6, "{again}");
    let constant = alone.replace("type: skf", "type: constant, value: 0.001");
    for (torque, message) in [("1e-6 Nm", "without preload it is"), ("1e5 Nm", "no preload has it")] {
        let wrong = constant.replace("force: 1000 N", &format!("torque: {torque}, torque_speed: 30 rpm"));
        case.write("changed.yaml", wrong);
        let said = case.gearloss(&["check", "changed.yaml"]);
        assert!(
            said.code == Some(2) && said.text.contains(message),
            "{message}\n{}",
            said.text
        );
    }
}

#[test]
fn contradictions_are_errors_and_omissions_warnings() {
    let case = Case::new("preloaded-bearings", "findings");
    let findings: [(&[(&str, &str)], i32, &[&str]); 17] = [
        (
            &[(", housing: { material: steel }", "")],
            0,
            &[
                "W0309]: bearings.A.preload.housing: the housing is taken to expand as steel",
                "material: aluminium",
            ],
        ),
        (
            &[(
                "kind: tapered_roller, bore: 40 mm, outside: 80 mm,",
                "kind: tapered_roller, bore: 40 mm, outside: 80 mm, c0: 700 N, y0: 0.9,",
            )],
            0,
            &["W0309]: bearings.A.preload: 1000 N of preload alone exceed the static rating of `bearings.A`"],
        ),
        (
            &[("force: 1000 N,", "force: 1000 N, closing: 3 um,")],
            2,
            &["a preload is one of `force`, `closing` and `torque`"],
        ),
        (
            &[("force: 1000 N,", "")],
            2,
            &["a preload is one of `force`, `closing` and `torque`"],
        ),
        (
            &[("force: 1000 N,", "torque: 1 Nm,")],
            2,
            &["speed at which `torque` is measured", "add `torque_speed:`"],
        ),
        (
            &[("force: 1000 N,", "torque: 1 Nm, torque_speed: 30 rpm,")],
            2,
            &["`bearings.A` has no friction model"],
        ),
        (
            &[("force: 1000 N,", "force: 1000 N, torque_speed: 30 rpm,")],
            2,
            &["there is no `torque` at this speed"],
        ),
        (
            &[("material: steel", "material: steel, expansion: 1e-5 1/K")],
            2,
            &["both state the expansion"],
        ),
        (
            &[("material: steel", "temperature: 40 degC, above_oil: 3 K")],
            2,
            &["one of `temperature`, `node` and `above_oil`"],
        ),
        (
            &[("material: steel", "node: wall")],
            2,
            &["there is no thermal network with nodes"],
        ),
        (
            &[(AT_B, &(AT_B.to_owned() + ", preload: { force: 3 N }"))],
            2,
            &["bearings.B.preload: `bearings.A` states the preload of this pair, too"],
        ),
        (
            &[(AT_B, &(AT_B.to_owned() + ", spring_preload: -300 N"))],
            2,
            &["`bearings.B` is on a spring"],
        ),
        (
            &[(AT_B, &(AT_B.to_owned() + ", induced_thrust: 0.3"))],
            2,
            &["bearings.B.induced_thrust: the pair has a preload"],
        ),
        (
            &[("axial: right", "axial: both")],
            2,
            &["presses no opposed bearing: `bearings.B` does not take the opposite thrust"],
        ),
        (
            &[("axial: right", "axial: none")],
            2,
            &["presses no opposed bearing: no other bearing takes thrust of `a`"],
        ),
        (
            &[("axial: left", "axial: none")],
            2,
            &["presses no opposed bearing: the bearing has no `axial: left`"],
        ),
        (
            &[
                ("axial: left", "axial: RIGHT"),
                ("axial: right", "axial: left"),
                ("RIGHT", "right"),
                ("at: 100 mm, kind", "at: 5 mm, kind"),
                ("distance: 120 mm, ", ""),
            ],
            2,
            &["5.0 mm apart, less than their pressure centres can be back to back"],
        ),
    ];
    for (changes, code, messages) in findings {
        case.write("changed.yaml", changed(&case, changes));
        let said = case.gearloss(&["check", "changed.yaml"]);
        assert_eq!(said.code, Some(code), "{changes:?}\n{}", said.text);
        for message in messages {
            assert!(said.text.contains(message), "{message}\n{}", said.text);
        }
    }
}

#[test]
fn a_preload_is_described_and_explained() {
    let case = Case::new("preloaded-bearings", "described");
    let text = changed(&case, &[("bearing: none", "bearing: { type: constant, value: 0.001 }")]);
    case.write("changed.yaml", text);
    let said = case.gearloss(&["check", "changed.yaml"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    let line = "pair A/B of a: face to face; preload 1000 N (10.24 um, 434.1 N/um) at 20 degC, +4.378 um/K of the shaft (that of the oil), \
                -4.378 um/K of the housing (that of the oil), contacts 120 mm apart";
    assert!(said.text.contains(line), "{}", said.text);
    let said = case.gearloss(&[&["explain", "changed.yaml", "B"], &POINT[..]].concat());
    for line in [
        "half loaded from Fa/Fr(A) = 0.313",
        "d at 20 degC = 10.2391 um, 1000 N",
        "delta(A) + delta(B) = d and Fa(B) - Fa(A) = Ka by the load distributions:",
        "Fa(B) = 1327.4",
        "delta(B) = 6.285",
    ] {
        assert!(said.text.contains(line), "{line}\n{}", said.text);
    }
}
