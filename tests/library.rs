//! The examples of the library: each runs, and says what the program says.

use std::path::PathBuf;
use std::process::Command;

use crate::common::file;
use assert_cmd::cargo::CommandCargoExt as _;
use serde_json::Value;

/// What an example prints. Tests build the examples, which then lie beside them.
fn printed(example: &str) -> String {
    let test = std::env::current_exe().unwrap();
    let built = test.parent().and_then(|deps| deps.parent()).unwrap();
    let binary: PathBuf = built
        .join("examples")
        .join(format!("{example}{}", std::env::consts::EXE_SUFFIX));
    assert!(
        binary.is_file(),
        "{} is not built: `cargo build --examples` builds it where only this test is asked for",
        binary.display()
    );
    let output = Command::new(&binary).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{example}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// What the program answers for 10 Nm in first gear under a set.
fn solved(set: &str, rpm: &str, overrides: &[&str]) -> Value {
    let mut command = Command::cargo_bin("gearloss").unwrap();
    command.arg("solve").arg(file("examples/two-speed-ev/gearbox.yaml"));
    command.args([
        "--gear", "first", "--torque", "10 Nm", "--format", "json", "--models", set,
    ]);
    command.args(["--speed", &format!("{rpm} rpm")]);
    for change in overrides {
        command.args(["--set", change]);
    }
    serde_json::from_slice(&command.output().unwrap().stdout).unwrap()
}

/// A number of the answer in digits after the point.
fn digits(value: &Value, factor: f64, digits: usize) -> String {
    format!("{:.digits$}", factor * value.as_f64().unwrap())
}

#[test]
fn one_point_has_the_digits_of_the_program() {
    let text = printed("one_point");
    let answer = solved("joint", "8000", &[]);
    let parts = answer["parts"].as_array().unwrap();
    let mut compared = 0;
    for line in text.lines() {
        let cells: Vec<&str> = line.split_whitespace().collect();
        let of = |part: &&Value| cells.first().copied() == part["part"].as_str();
        if let Some(part) = parts.iter().find(of) {
            assert_eq!(cells[1], part["model"], "{line}");
            assert_eq!(cells[2], digits(&part["loss_w"], 1.0, 3), "{line}");
            compared += 1;
        }
    }
    assert_eq!(compared, parts.len());
    let last = format!(
        "loss {} W, efficiency {} %",
        digits(&answer["loss_w"], 1.0, 3),
        digits(&answer["efficiency"], 100.0, 3)
    );
    assert_eq!(text.lines().last().unwrap(), last);
}

#[test]
fn compared_models_have_the_digits_of_the_program() {
    let text = printed("compare_models");
    let variants: [(&str, &[&str]); 4] = [
        ("iso14179_2", &[]),
        ("joint", &[]),
        ("joint", &["housing.oil.level_offset=-10 mm"]),
        ("joint", &["bearings.*.model={ type: harris }"]),
    ];
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(2)
        .map(|row| row.split_whitespace().collect())
        .collect();
    assert_eq!(rows.len(), 10);
    for row in [&rows[0], &rows[9]] {
        let expected: Vec<String> = variants
            .iter()
            .map(|(set, changes)| digits(&solved(set, row[0], changes)["efficiency"], 100.0, 3))
            .collect();
        assert_eq!(row[1..], expected, "at {} rpm", row[0]);
    }
    let [as_written, less, harris] = [2, 3, 4].map(|column| rows[9][column]);
    assert!(
        as_written != less && as_written != harris && less != harris,
        "an override changes nothing"
    );
}

#[test]
fn fitted_parameters_enclose_what_is_hidden_in_the_points() {
    let text = printed("fit_parameters");
    assert!(text.starts_with("440 efficiencies"), "{text}");
    let hidden = [
        ("viscosity", 0.85),
        ("roughness", 0.45),
        ("oil level", 4.0),
        ("bearing loads", 1.15),
        ("boundary friction", 0.12),
        ("seals", 1.3),
        ("torque meter", 0.03),
        ("bearing of the rig", 0.02),
    ];
    for (name, value) in hidden {
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|cell| cell.parse().ok()).collect();
        let [found, from, to] = numbers[..] else {
            panic!("no interval: {line}");
        };
        assert!(from < found && found < to, "{line}");
        assert!((from..=to).contains(&value), "{value} is hidden: {line}");
    }
}

/// What the program writes of an analysis of a study of an example.
fn written(folder: &std::path::Path, analysis: &str) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join(format!("{analysis}.json"))).unwrap()).unwrap()
}

#[test]
fn a_study_has_the_digits_of_the_program() {
    let text = printed("run_study");
    let folder = std::env::temp_dir().join(format!("gearloss-run-study-{}", std::process::id()));
    let mut command = Command::cargo_bin("gearloss").unwrap();
    command
        .arg("run")
        .arg(file("examples/two-speed-ev/town.yaml"))
        .arg("-o")
        .arg(&folder);
    assert!(command.output().unwrap().status.success());
    let mean = digits(&written(&folder, "sets")["comparisons"][0]["mean"], 1.0, 3);
    assert!(
        text.contains(&format!("joint minus iso14179_2, mean {mean} ")),
        "{text}"
    );
    let mean = digits(&written(&folder, "town")["cycles"][0]["mean_loss_w"], 1.0, 3);
    assert!(
        text.contains(&format!("town under joint, mean loss {mean} W")),
        "{text}"
    );
    assert!(
        text.contains("sets: 12 rows") && text.contains("town: 100 rows"),
        "{text}"
    );
    assert!(!text.contains("NaN"), "{text}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_book_shows_lines_of_the_examples() {
    let page = std::fs::read_to_string(file("docs/library.md")).unwrap();
    let (_, code) = page.split_once("```rust\n").unwrap();
    let (code, _) = code.split_once("```").unwrap();
    let example = std::fs::read_to_string(file("examples/one_point.rs")).unwrap();
    let bare = |text: &str| text.lines().map(str::trim).collect::<Vec<&str>>().join("\n");
    assert!(
        !code.trim().is_empty() && bare(&example).contains(bare(code).trim()),
        "examples/one_point.rs has no such lines in one piece:\n{code}"
    );
}
