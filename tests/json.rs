//! What `check` and `models` tell programs: the published schemas hold, and every finding has its code, place and help.

use crate::common::{self, program::gearloss};

use serde_json::Value;

/// JSON output of a command, checked against its schema, with its exit code.
fn run_json(kind: &str, args: &[&str]) -> (Value, i32) {
    let output = gearloss(args);
    let text = String::from_utf8(output.stdout).unwrap();
    let value: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{args:?}: {e}\n{text}"));
    let schema: Value = serde_json::from_slice(&gearloss(&["schema", kind]).stdout).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let errors: Vec<String> = validator
        .iter_errors(&value)
        .map(|e| format!("{}: {e}", e.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{args:?}: {errors:#?}");
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    (value, output.status.code().unwrap())
}

fn check(args: &[&str]) -> (Value, i32) {
    let mut all = vec!["check", "--format", "json"];
    all.extend(args);
    run_json("check", &all)
}

#[test]
fn check_reports_valid_files() {
    let (value, code) = check(&["examples/two-speed-ev/gearbox.yaml", "examples/two-speed-ev/study.yaml"]);
    assert_eq!(code, 0);
    let files = value["files"].as_array().unwrap();
    assert_eq!(
        (&files[0]["kind"], &files[1]["kind"]),
        (&"gearbox".into(), &"study".into())
    );
    assert!(files.iter().all(|file| file["fine"] == true));
    assert_eq!(
        files[0]["gear_states"],
        serde_json::json!(["first", "second", "neutral"])
    );
    assert!(files[0]["resolved"].is_null());
    let ratio = |gear: &str| {
        let ratios = files[0]["ratios"].as_array().unwrap();
        ratios.iter().find(|r| r["gear"] == gear).unwrap()["ratio"].as_f64()
    };
    let stage = |mesh: &str| {
        let stages = files[0]["stages"].as_array().unwrap();
        stages.iter().find(|s| s["mesh"] == format!("meshes.{mesh}")).unwrap()["ratio"]
            .as_f64()
            .unwrap()
    };
    // Both stages are external pairs, so the output turns as the input does.
    let product = stage("M1") * stage("M2");
    assert!((ratio("first").unwrap() / product - 1.0).abs() < 1e-12, "{product}");
    let ratios = files[0]["ratios"].as_array().unwrap();
    assert!(ratios.iter().all(|r| r["gear"] != "neutral"), "{ratios:?}");
    let (value, code) = check(&["examples/two-speed-ev/gearbox.yaml", "--resolved", "--deny", "disputed"]);
    assert_eq!((code, &value["files"][0]["denied"]), (1, &true.into()));
    assert_eq!(value["files"][0]["resolved"]["gearloss"], "gearbox/1");
}

#[test]
fn every_finding_has_its_code_place_and_help() {
    let of = |case: &str| {
        let (value, code) = check(&[&format!("tests/cases/{case}/input.yaml")]);
        let file = value["files"][0].clone();
        assert_eq!((code == 2, file["fine"] == false), (true, true), "{case}");
        file["findings"][0].clone()
    };
    for (case, code, line) in [
        ("not_yaml", "E0002", true),
        ("duplicate_key", "E0003", true),
        ("misspelt_key", "E0101", true),
        ("missing_key", "E0102", true),
        ("model_without_type", "E0102", true),
        ("unknown_type", "E0103", true),
        ("wrong_unit", "E0106", true),
        ("out_of_range", "E0105", true),
        ("extends_missing", "E0001", true),
        ("unknown_designation", "E0205", true),
        ("no_overlap", "E0302", true),
    ] {
        let finding = of(case);
        assert_eq!(finding["code"], code, "{case}: {finding:#}");
        assert_eq!(finding["severity"], "error", "{case}");
        assert_eq!(
            finding["line"].is_u64() && finding["column"].is_u64(),
            line,
            "{case}: {finding:#}"
        );
        assert!(finding["help"].is_string(), "{case}: {finding:#}");
    }
    let wrong = of("wrong_unit");
    assert!(wrong["file"].as_str().unwrap().ends_with("wrong_unit/input.yaml"));
    assert_eq!(wrong["line"], 10);
    // The place that says why stands beside.
    assert!(!of("duplicate_key")["related"].as_array().unwrap().is_empty());
}

/// A gearbox whose bearings are too small for its rating, and whose faces hardly meet.
const DOUBTFUL: &str = "extends: ../../tests/cases/fine/input.yaml\nrating: { torque: 2000 Nm, speed: 1000 rpm }\n\
                        set: { gears.pinion.at: 42 mm }\n";

#[test]
fn warnings_of_a_gearbox_are_those_of_its_study() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("doubtful");
    std::fs::create_dir_all(&folder).unwrap();
    let fine = common::file("tests/cases/fine/input.yaml");
    let gearbox = DOUBTFUL.replace("../../tests/cases/fine/input.yaml", fine.to_str().unwrap());
    std::fs::write(folder.join("gearbox.yaml"), format!("gearloss: gearbox/1\n{gearbox}")).unwrap();
    let study = "gearloss: study/1\ngearboxes: { ours: gearbox.yaml }\ngrids: { few: { torque: 10 Nm, speed: 1000 rpm } }\n\
                 analyses: { map: { type: map, grid: few } }\n";
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let [of_gearbox, of_study] = ["gearbox.yaml", "study.yaml"].map(|name| {
        let (value, code) = check(&[folder.join(name).to_str().unwrap()]);
        assert_eq!(code, 0, "{value:#}");
        value["files"][0]["findings"].as_array().unwrap().clone()
    });
    let has = |list: &[Value], words: &str| list.iter().any(|f| f["message"].as_str().unwrap().contains(words));
    assert!(has(&of_gearbox, "S0 = C0/P0"), "{of_gearbox:#?}");
    assert!(
        has(&of_gearbox, "share only") && has(&of_study, "share only"),
        "{of_gearbox:#?} {of_study:#?}"
    );
}

#[test]
fn options_of_gearboxes_are_refused_for_studies() {
    for option in [
        &["--set", "a=1"][..],
        &["--models", "joint"],
        &["--resolved"],
        &["--deny", "recalled"],
    ] {
        let output = gearloss(&[&["check", "examples/two-speed-ev/study.yaml"], option].concat());
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(&format!("{} does not apply to", option[0])), "{error}");
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn a_missing_file_is_reported_beside_the_others() {
    let (value, code) = check(&["nowhere.yaml", "examples/two-speed-ev/gearbox.yaml"]);
    assert_eq!(code, 2);
    let finding = &value["files"][0]["findings"][0];
    assert_eq!((&finding["code"], &finding["line"]), (&"E0001".into(), &Value::Null));
    assert_eq!(value["files"][1]["fine"], true);
}

#[test]
fn models_lists_everything() {
    let (all, code) = run_json("models", &["models", "--format", "json"]);
    assert_eq!(code, 0);
    let mechanisms = all["mechanisms"].as_array().unwrap();
    let language = common::language();
    assert_eq!(mechanisms.len(), language.registry().mechanisms().len());
    for (known, listed) in language.registry().mechanisms().iter().zip(mechanisms) {
        assert_eq!(
            listed["models"].as_array().unwrap().len(),
            language.registry().models(known.key).count(),
            "{}",
            known.key
        );
    }
    let (one, _) = run_json("models", &["models", "bearing", "skf", "--format", "json"]);
    let bearing = &one["mechanisms"][0];
    assert_eq!(one["mechanisms"].as_array().unwrap().len(), 1);
    assert_eq!(bearing["models"].as_array().unwrap().len(), 1);
    let skf = &bearing["models"][0];
    let edition = skf["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .find(|p| p["name"] == "mu_bl")
        .unwrap();
    assert_eq!((&edition["unit"], &edition["least"]), (&"-".into(), &0.01.into()));
    let speed = &bearing["quantities"][0];
    assert_eq!(
        (&speed["name"], &speed["unit"], &speed["usual"]),
        (&"speed".into(), &"rpm".into(), &3000.0.into())
    );
    let (gears, _) = run_json("models", &["models", "gear_mesh", "--format", "json"]);
    assert_eq!(gears["mechanisms"][0]["laws"], serde_json::json!(["eta = nu rho"]));
    assert_eq!(
        gearloss(&["models", "bearing", "nothing", "--format", "json"])
            .status
            .code(),
        Some(2)
    );
}
