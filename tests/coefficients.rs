//! Constants and exponents of published formulas: their values are those of the sources, their ranges keep formulas
//! defined, and what is changed counts and is reported.

use crate::common;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use gearloss_framework::coefficients::{COEFFICIENTS, changed_from_source};
use gearloss_framework::eval::evaluate_input;
use gearloss_framework::registry::Files;
use gearloss_framework::resolve::{Choice, lookup};
use gearloss_framework::testing::language;
use gearloss_studies::varied::{Tie, Varied};
use serde_json::{Value, json};

/// A number as sources write it, such as `1/3`.
fn number(text: &str) -> f64 {
    match text.split_once('/') {
        Some((above, below)) => above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap(),
        None => text.parse().unwrap(),
    }
}

/// Coefficients by `mechanism/model`, as sources print them.
fn printed() -> BTreeMap<String, Vec<(String, f64)>> {
    let text = include_str!("tables/coefficients.txt");
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    lines
        .map(|line| {
            let (model, list) = line.split_once(": ").unwrap();
            let list = list.split("; ").map(|coefficient| {
                let (name, value) = coefficient.split_once(' ').unwrap();
                (name.to_owned(), number(value))
            });
            (model.to_owned(), list.collect())
        })
        .collect()
}

#[test]
fn every_published_value_is_that_of_its_source() {
    let mut printed = printed();
    for mechanism in language().registry().mechanisms() {
        for entry in language().registry().models(mechanism.key) {
            let declared = entry.coefficients();
            let name = format!("{}/{}", mechanism.key, entry.name);
            let of_source = printed.remove(&name).unwrap_or_default();
            let declared: Vec<(String, f64)> = declared.into_iter().map(|c| (c.name, c.published)).collect();
            assert_eq!(declared, of_source, "{name}");
            // What nobody writes is the published value to the bit, and stands in the resolved model.
            let example = language().example_of(entry).unwrap().0;
            for (coefficient, value) in of_source {
                assert_eq!(
                    example[COEFFICIENTS][&coefficient],
                    json!(value),
                    "{name} {coefficient}"
                );
            }
        }
    }
    assert!(printed.is_empty(), "no such models: {:?}", printed.keys());
}

#[test]
fn no_value_of_a_range_makes_a_formula_undefined() {
    let registry = language().registry();
    let mut faults = Vec::new();
    for mechanism in registry.mechanisms() {
        for entry in registry.models(mechanism.key) {
            let coefficients = entry.coefficients();
            for coefficient in &coefficients {
                let name = format!("{}/{} {}", mechanism.key, entry.name, coefficient.name);
                assert!(
                    coefficient.least < coefficient.published && coefficient.published < coefficient.greatest,
                    "{name}"
                );
                assert!(!coefficient.meaning.is_empty(), "{name}");
            }
            if coefficients.is_empty() {
                continue;
            }
            let (example, part) = language().example_of(entry).unwrap();
            let files = Files::default();
            files.put_all(entry.files);
            for choice in 0..3_usize {
                let mut model = example.clone();
                for (i, coefficient) in coefficients.iter().enumerate() {
                    let low = choice == 0 || (choice == 2 && i % 2 == 0);
                    model[COEFFICIENTS][&coefficient.name] =
                        json!(if low { coefficient.least } else { coefficient.greatest });
                }
                for fault in (mechanism.conform)(registry, &files, entry, &model, &part) {
                    faults.push(format!("{}/{} {choice}: {fault}", mechanism.key, entry.name));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// The answer of a model on its mechanism's usual point with one coefficient changed.
fn with(model: &str, key: &str, value: f64, more: &str) -> f64 {
    let name = model.split_once('/').unwrap().1;
    let input = format!("model: {{ type: {name}{more}, coefficients: {{ {key}: {value} }} }}");
    match evaluate_input(language(), model, "input", &input, Path::new("")) {
        Ok(evaluated) => evaluated.total,
        Err(found) => panic!("{model}: {found}"),
    }
}

#[test]
fn a_changed_value_changes_the_answer_as_the_formula_says() {
    // A factor in front of everything counts in proportion.
    for (model, key, published, more) in [
        ("mean_friction/schlenk", "factor", 0.048, ", clamp_line_load: false"),
        ("mean_friction/michaelis", "factor", 0.045, ""),
        ("mean_friction/fernandes", "factor", 0.014, ""),
        ("mean_friction/iso_13989", "factor", 0.06, ""),
        ("tooth_friction/iso_tc60", "factor", 0.12, ""),
        ("tooth_friction/misharin", "factor", 0.325, ", held: false"),
        ("gear_drag/dawson", "factor", 1e-20, ""),
        ("gear_drag/maurer", "factor", 1.37e-9, ""),
        ("gear_drag/shore", "factor", 0.38, ", fill: 0.35"),
        ("gear_drag/diab", "factor", 60.0, ""),
        ("gear_drag/anderson_loewenthal", "factor", 2.82e-7, ""),
        ("seal/linke", "factor", 7.69e-6, ""),
        ("seal/simrit", "factor", 0.5, ""),
    ] {
        let ratio = with(model, key, 1.2 * published, more) / with(model, key, published, more);
        assert!((ratio - 1.2).abs() < 1e-9, "{model}: {ratio}");
    }
    // A divisor counts inversely, an exponent with its base: speeds above 1 and exponents of loads below the usual.
    let falls = |model: &str, key: &str, from: f64, to: f64, more: &str| {
        let [before, after] = [from, to].map(|value| with(model, key, value, more));
        assert!(after < before, "{model} {key}: {before} {after}");
    };
    falls("gear_mesh/iso14179_1", "divisor", 3.239, 4.0, "");
    falls("mean_friction/schlenk", "viscosity_exponent", -0.05, -0.1, "");
    falls("tooth_friction/xu", "b1", -8.916465, -9.5, "");
    falls("tooth_friction/xu", "b9", 0.620305, 0.5, "");
    falls("bearing/iso14179_2", "viscous_exponent", 2.0 / 3.0, 0.6, "");
    falls("bearing/skf", "rolling_exponent", 0.6, 0.5, "");
    falls("gear_drag/changenet_2011", "slow_froude_exponent", -0.6, -0.7, "");
    falls("gear_drag/iso14179_2", "speed_constant", 0.2, 0.1, ", speed_of: wheel");
    falls("clutch/disc_gap", "own_pumping", 0.3, 0.5, ", flow: 3 l/min");
}

#[test]
fn schlenk_with_other_exponents_is_the_product_of_its_powers() {
    let input = |coefficients: &str| {
        format!(
            "model: {{ type: schlenk, x_l: 1, coefficients: {{ {coefficients} }} }}\nat: {{ line_load: 422.293, \
             sum_speed: 4.38883, radius: 8.38205, eta: 13.28, ra: 0.4 }}"
        )
    };
    let mu = |coefficients: &str| {
        evaluate_input(
            language(),
            "mean_friction/schlenk",
            "input",
            &input(coefficients),
            Path::new(""),
        )
        .unwrap_or_else(|found| panic!("{found}"))
        .total
    };
    // B2: the published example, then the same with a load exponent of 0.25: (F_bt/b/(v_SC rho_redC))^0.05 more.
    assert!((mu("") / 0.0546486 - 1.0).abs() < 1e-5, "{}", mu(""));
    let more = (422.293_f64 / (4.38883 * 8.38205)).powf(0.05);
    assert!((mu("load_exponent: 0.25") / (0.0546486 * more) - 1.0).abs() < 1e-5);
    // The one root and the three powers are the same formula.
    let beside = mu("load_exponent: 0.2000000001");
    assert!((beside / mu("") - 1.0).abs() < 1e-8 && beside != mu(""));
}

/// The program's text and whether it ended well.
fn program(arguments: &[&str]) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(arguments)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.success(), text)
}

fn two_speed() -> String {
    common::file("examples/two-speed-ev/gearbox.yaml").display().to_string()
}

const EXPONENT: &str = "meshes.*.model.coefficients.load_exponent";

#[test]
fn a_value_outside_its_range_is_refused_with_place_and_help() {
    let gearbox = two_speed();
    let (fine, text) = program(&["check", &gearbox, "--set", &format!("{EXPONENT}=0.5")]);
    assert!(!fine, "{text}");
    for part in [
        "meshes.M1.model.coefficients.load_exponent",
        "0.5 is out of range",
        "write 0.1 to 0.4",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // The range is that of the model at hand: `factor` of another one goes farther.
    let (fine, text) = program(&["check", &gearbox, "--set", "meshes.*.model.coefficients.factor=0.12"]);
    assert!(!fine && text.contains("write 0.024 to 0.096"), "{text}");
    let (fine, text) = program(&[
        "check",
        &gearbox,
        "--set",
        "meshes.*.model.coefficients.load_exponen=0.3",
    ]);
    assert!(!fine && text.contains("write `load_exponent`"), "{text}");

    // In a document, at the line where it stands.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("coefficients-range");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("gearbox.yaml");
    let model =
        "gear_mesh: { type: ohlendorf, mean_friction: { type: michaelis, coefficients: { roughness_factor: 5 } } }";
    let text = format!("gearloss: gearbox/1\nextends: {gearbox}\nmodels:\n  {model}\n");
    std::fs::write(&file, text).unwrap();
    let (fine, text) = program(&["check", &file.display().to_string()]);
    assert!(!fine, "{text}");
    for part in [
        "roughness_factor",
        "gearbox.yaml:4:",
        "5 is out of range",
        "write 1.1 to 4.4",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_change_is_reported_once_for_all_models_that_have_it() {
    let gearbox = two_speed();
    let set = format!("{EXPONENT}=0.25");
    let note = "coefficients.load_exponent 0.25 instead of 0.2, changed from the source (ISO/TR 14179-2:2001";
    for command in [
        &["check", &gearbox, "--set", &set][..],
        &[
            "solve", &gearbox, "--gear", "first", "--torque", "10", "--speed", "3000", "--set", &set,
        ],
        &[
            "explain", &gearbox, "M1", "--gear", "first", "--torque", "10", "--speed", "3000", "--set", &set,
        ],
    ] {
        let (fine, text) = program(command);
        assert!(fine, "{text}");
        assert_eq!(text.matches(note).count(), 1, "{command:?}: {text}");
    }
    let (_, text) = program(&["check", &gearbox]);
    assert!(!text.contains("changed from the source"), "{text}");

    let (_, text) = program(&["check", &gearbox, "--set", &set, "--format", "json"]);
    let value: Value = serde_json::from_str(&text).unwrap();
    let changed = &value["files"][0]["changed_from_source"];
    assert_eq!(changed.as_array().unwrap().len(), 1, "{changed}");
    assert_eq!(changed[0]["published"], 0.2);
    assert!(changed[0]["paths"].as_array().unwrap().len() > 1, "{changed}");
}

/// Default models, sets and single components of sets take coefficients, and all end in the resolved document.
#[test]
fn sets_and_their_components_take_coefficients() {
    let language = common::language();
    let gearbox = common::two_speed(&language);
    let mine = "gear_mesh: { type: ohlendorf, mean_friction: { type: schlenk, coefficients: { load_exponent: 0.3 } } }\n\
                components: { bearings.B1.model: { type: iso14179_2, coefficients: { viscous_factor: 1.5e-7 } } }";
    let mine = language.part_of_document(mine, "model_sets.mine").unwrap();
    let sets = json!({ "mine": mine });
    let choice = Choice {
        set: Some("mine".to_owned()),
        sets: sets.as_object().unwrap().clone(),
        overrides: vec![("bearings.B1.model.coefficients.constant_factor".to_owned(), json!(2e-5))],
        ..Choice::default()
    };
    let resolved = gearbox
        .resolve(&language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let at = |path: &str| lookup(&resolved.value, path).and_then(Value::as_f64);
    assert_eq!(
        at("meshes.M1.model.mean_friction.coefficients.load_exponent"),
        Some(0.3)
    );
    assert_eq!(at("meshes.M1.model.mean_friction.coefficients.factor"), Some(0.048));
    assert_eq!(at("bearings.B1.model.coefficients.viscous_factor"), Some(1.5e-7));
    assert_eq!(at("bearings.B1.model.coefficients.constant_factor"), Some(2e-5));
    let t = gearbox
        .build(&language, &resolved)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let names: Vec<String> = changed_from_source(&t, &resolved)
        .into_iter()
        .map(|c| c.coefficient)
        .collect();
    assert_eq!(names.len(), 3, "{names:?}");

    let varied = Varied::new(
        &language,
        &resolved,
        "meshes.*.model.mean_friction.coefficients.load_exponent",
        Tie::Value,
    );
    let varied = varied.unwrap();
    assert_eq!((varied.range, varied.published()), ([0.1, 0.4], Some(0.2)));
    assert_eq!(varied.changed_from_source(0.2), None);
    assert_eq!(
        varied.changed_from_source(0.3).unwrap(),
        "0.3 instead of the published 0.2"
    );
}

/// Points of the two-speed example under a change: torque, speed and loss as a file of measurements.
fn measured(overrides: &[(&str, Value)], accuracy: f64) -> String {
    use gearloss_framework::evaluate::Point;
    let language = common::language();
    let t = common::two_speed_with(&language, None, overrides);
    let case = t.case("first", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut csv = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for torque in [2.0, 5.0, 9.0, 14.0, 20.0] {
        for speed in [1000.0, 4000.0, 9000.0] {
            let point = Point {
                speeds: &[speed * common::RPM],
                torques: &[torque],
                ..Point::default()
            };
            let loss = t.evaluate(&case, &point, &[80.0], &mut scratch).loss().unwrap();
            csv.push_str(&format!("{torque},{speed},{loss},{accuracy}\n"));
        }
    }
    csv
}

/// Runs a study of the two-speed example; its text and the folder of the results.
fn run(name: &str, analyses: &str, csv: &str) -> (std::path::PathBuf, String) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("coefficients-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let study = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {} }}\nconditions: {{ oil_temperature: 80 degC }}\n{analyses}",
        two_speed()
    );
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    std::fs::write(folder.join("rig.csv"), csv).unwrap();
    let (fine, text) = program(&["run", "--verbose", &folder.join("study.yaml").display().to_string()]);
    assert!(fine, "{text}");
    (folder.join("results"), text)
}

fn result(folder: &Path, name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap()).unwrap()
}

const RIG: &str = "measurements: { rig: { file: rig.csv, columns: { torque: torque, speed: speed, loss: loss } } }\n";

#[test]
fn an_identification_finds_the_load_exponent_of_schlenk() {
    let csv = measured(&[(EXPONENT, json!(0.27))], 0.01);
    let analyses = format!(
        "{RIG}analyses:\n  what:\n    type: identify\n    data: rig\n    residuals: [loss]\n    \
         parameters: {{ exponent: {{ path: \"{EXPONENT}\" }} }}\n    write: [json, csv]\n"
    );
    let (folder, text) = run("identify", &analyses, &csv);
    let found = &result(&folder, "what")["identifications"][0]["parameters"][0];
    assert!((found["value"].as_f64().unwrap() / 0.27 - 1.0).abs() < 1e-4, "{found}");
    // Bounds are those of the coefficient.
    assert_eq!((&found["least"], &found["greatest"]), (&json!(0.1), &json!(0.4)));
    assert_eq!(found["published"], 0.2);
    assert!(text.contains("instead of the published 0.2"), "{text}");
}

#[test]
fn analyses_move_coefficients_and_say_what_is_published() {
    let analyses = format!(
        "grids: {{ few: {{ torque: [5 Nm, 15 Nm], speed: [3000 rpm] }} }}\n\
         model_sets: {{ mine: {{ gear_mesh: {{ type: iso14179_2, coefficients: {{ factor: 0.05 }} }} }} }}\n\
         analyses:\n  \
         swept: {{ type: sweep, path: \"{EXPONENT}\", values: [0.2, 0.3], torque: 10 Nm, speed: 3000 rpm }}\n  \
         bands: {{ type: uncertainty, grid: few, samples: 16, inputs: [{{ path: \"{EXPONENT}\", from: 0.15, to: 0.25 }}] }}\n  \
         local: {{ type: sensitivity, grid: few, methods: [local], parameters: [{{ path: \"{EXPONENT}\", from: 0.15, to: 0.25 }}] }}\n  \
         maps: {{ type: map, grid: few, model_sets: [mine], write: [json] }}\n"
    );
    let (folder, text) = run("analyses", &analyses, "");
    let said =
        format!("`{EXPONENT}`: a coefficient of a formula, published value 0.2; other values differ from the source");
    assert_eq!(text.matches(&said).count(), 3, "{text}");
    let note = "ours, models mine: ";
    assert!(
        text.contains(note) && text.contains("coefficients.factor 0.05 instead of 0.048, changed from the source"),
        "{text}"
    );
    let maps = result(&folder, "maps");
    let changed = &maps["changed_from_source"][0];
    assert_eq!(changed["model_set"], "mine");
    assert_eq!(changed["coefficients"][0]["value"], 0.05);
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.contains("Coefficients that differ from their source"));
}

/// A table that the document states, with values that have paths.
#[test]
fn values_of_tables_and_lists_are_parameters() {
    let language = common::language();
    let gearbox = common::two_speed(&language);
    let table = json!({ "type": "table", "axes": { "speed": [0, 5000, 20000] }, "values": [0.01, 0.02, 0.05], "outside": "clamp" });
    let with = |more: &[(&str, Value)]| {
        let mut choice = Choice::default().with("bearings.B1.model", table.clone());
        for (path, value) in more {
            choice = choice.with(*path, value.clone());
        }
        gearbox.resolve(&language, &choice).map_err(|found| found.render())
    };
    let resolved = with(&[]).unwrap();
    let one = Varied::new(&language, &resolved, "bearings.B1.model.values.1", Tie::Value).unwrap();
    assert_eq!((one.start(), one.range[0]), (Some(0.02), 0.0));
    let all = Varied::new(&language, &resolved, "bearings.B1.model.values.*", Tie::Factor).unwrap();
    assert_eq!(all.paths.len(), 3);
    let doubled: Vec<f64> = all.overrides(2.0).map(|(_, value)| value.as_f64().unwrap()).collect();
    assert_eq!(doubled, [0.02, 0.04, 0.1]);

    // Between the middle and the last speed both count, half and half at 12500 rpm.
    let moment = |resolved| {
        use gearloss_framework::evaluate::Point;
        let t = gearbox
            .build(&language, &resolved)
            .unwrap_or_else(|f| panic!("{}", f.render()));
        let case = t.case("first", &["input"], &["input"]).unwrap();
        let part = t.parts().iter().position(|part| part.path == "bearings.B1").unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[12500.0 * common::RPM],
            torques: &[5.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let (_, loss) = solution.parts().nth(part).unwrap();
        loss.moment().unwrap()
    };
    assert!((moment(resolved) - 0.035).abs() < 1e-9);
    let changed = with(&[("bearings.B1.model.values.2", json!(0.09))]).unwrap();
    assert!((moment(changed) - 0.055).abs() < 1e-9);

    // What is no place of a list, or no value of it, is refused with its place.
    let beyond = with(&[("bearings.B1.model.values.3", json!(0.1))]).unwrap_err();
    assert!(
        beyond.contains("write a number from 0 to 2, or `*` for all"),
        "{beyond}"
    );
    let negative = with(&[("bearings.B1.model.values.0", json!(-0.1))]).unwrap_err();
    assert!(negative.contains("-0.1 is out of range"), "{negative}");
    let of_file = [
        ("bearings.B1.model", json!({ "type": "table", "file": "drag.csv" })),
        ("bearings.B1.model.values.1", json!(0.1)),
    ];
    let of_file = with(&of_file).unwrap_err();
    assert!(
        of_file.contains("the values of the table are in the file `drag.csv`"),
        "{of_file}"
    );
    assert!(of_file.contains("`axes:` and `values:`"), "{of_file}");
    let factors = json!({ "port": "input", "torques": [1, 10], "factors": [1, 1.2] });
    let curve = with(&[
        ("bearings.B2.radial_factor", factors),
        ("bearings.B2.radial_factor.factors.1", json!(1.4)),
    ])
    .unwrap();
    assert_eq!(curve.value["bearings"]["B2"]["radial_factor"]["factors"][1], 1.4);

    // Both halves of a table, or its file.
    let both = json!({ "type": "table", "axes": { "speed": [0, 1] } });
    let half = gearbox
        .resolve(&language, &Choice::default().with("bearings.B1.model", both))
        .unwrap();
    let refused = gearbox.build(&language, &half).err().unwrap().render();
    assert!(
        refused.contains("table requires `file`, or `axes` and `values`"),
        "{refused}"
    );
    let misspelt = json!({ "type": "table", "axes": { "sped": [0, 1] }, "values": [1, 2] });
    let half = gearbox
        .resolve(&language, &Choice::default().with("bearings.B1.model", misspelt))
        .unwrap();
    let refused = gearbox.build(&language, &half).err().unwrap().render();
    assert!(
        refused.contains("no quantity `sped`") && refused.contains("write `speed`"),
        "{refused}"
    );
}

#[test]
fn an_identification_finds_values_of_a_table() {
    let table = json!({ "type": "table", "axes": { "speed": [0, 20000] }, "values": [0.02, 0.08] });
    let csv = measured(&[("bearings.B1.model", table)], 0.001);
    let analyses = format!(
        "{RIG}analyses:\n  what:\n    type: identify\n    data: rig\n    residuals: [loss]\n    write: [json]\n    parameters:\n      \
         low:  {{ path: bearings.B1.model.values.0, from: 0, to: 0.2 }}\n      \
         high: {{ path: bearings.B1.model.values.1, from: 0, to: 0.2 }}\n\
         model_sets: {{ t: {{ components: {{ bearings.B1.model: {{ type: table, axes: {{ speed: [0, 20000] }}, values: [0.05, 0.05] }} }} }} }}\n"
    );
    let analyses = analyses.replace("    data: rig\n", "    data: rig\n    model_sets: [t]\n");
    let (folder, _) = run("table", &analyses, &csv);
    let found = &result(&folder, "what")["identifications"][0]["parameters"];
    for (i, truth) in [0.02, 0.08].into_iter().enumerate() {
        assert!(
            (found[i]["value"].as_f64().unwrap() / truth - 1.0).abs() < 1e-3,
            "{found}"
        );
    }
}
