//! Measured data in studies: columns that are changed, torque and speed at the other port, several files, filters, steady intervals.

use crate::common::study::{Ran, of_gearbox, run_texts};
use crate::common::{self, RPM, language};
use std::path::{Path, PathBuf};

use gearloss::api::{Choice, Gearbox, OilTemperature, PowerFlow};
use gearloss_studies::points::PreparedPoint;
use serde_json::Value;

/// One stage from 3000 to 1500 rpm, which turns the sense of rotation.
const GEARBOX: &str = "tests/cases/fine/input.yaml";

fn gearloss(args: &[&str]) -> (Option<i32>, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(args)
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

/// A study of the gearbox.
fn study(rest: &str) -> String {
    of_gearbox(GEARBOX, rest)
}

/// Runs a study with files beside it; its results and what was printed.
fn run(rest: &str, files: &[(&str, &str)]) -> (Ran, String) {
    let ran = run_texts(&study(rest), files);
    assert!(ran.succeeded, "{}", ran.text);
    ran.with_text()
}

/// A folder with a study and files beside it, for the program.
fn folder(name: &str, rest: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("measured-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("study.yaml"), study(rest)).unwrap();
    for (file, text) in files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    folder
}

fn check(folder: &Path) -> String {
    let (code, text) = gearloss(&["check", folder.join("study.yaml").to_str().unwrap()]);
    assert_eq!(code, Some(2), "{text}");
    text
}

/// Torque at the output, which leaves positive, and loss where the input has a torque at 3000 rpm.
fn solved(torque: f64) -> (f64, f64) {
    let language = language();
    let gearbox = Gearbox::read(&language, &common::file(GEARBOX)).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let gear = &t.states()[0].name;
    let case = t.case(gear, &["input"], &["input"]).unwrap();
    let point = PreparedPoint {
        case,
        gear: gear.clone(),
        speeds: vec![3000.0 * RPM],
        torques: vec![torque],
        oil: OilTemperature::from_conditions(&t, None),
        flow: PowerFlow::Real,
    };
    let mut scratch = t.scratch(&point.case);
    let solution = point.solve(&t, &mut scratch).solution;
    let out = t.port("output").unwrap();
    assert!(solution.speed(t.ports()[out].member) < 0.0);
    // What is applied has the sense of the output, which turns backward.
    (solution.torque(out), solution.loss().unwrap())
}

#[test]
fn torque_and_speed_at_the_output_alone_find_the_same_points() {
    let ((drive, drive_loss), (coast, coast_loss)) = (solved(10.0), solved(-10.0));
    let rows = format!("{drive},1500,{drive_loss}\n{coast},1500,{coast_loss}\n");
    let rig = format!("torque_out [Nm],speed_out [rpm],loss [W]\n{rows}");
    // The same with the input speed, and with the input torque.
    let half = format!(
        "torque_out [Nm],speed [rpm],loss [W]\n{}",
        rows.replace(",1500,", ",3000,")
    );
    let other = format!("torque [Nm],speed_out [rpm],loss [W]\n10,1500,{drive_loss}\n-10,1500,{coast_loss}\n");
    let study = "
measurements: { rig: { file: rig.csv }, half: { file: half.csv }, other: { file: other.csv } }
analyses:
  rig:   { type: compare, data: rig, against: [own], quantity: loss, difference: percent, write: [json] }
  half:  { type: compare, data: half, against: [own], quantity: loss, difference: percent, write: [json] }
  other: { type: compare, data: other, against: [own], quantity: loss, difference: percent, write: [json] }
";
    let files = [("rig.csv", rig.as_str()), ("half.csv", &half), ("other.csv", &other)];
    let (results, text) = run(study, &files);
    assert!(
        text.contains("there is no column for `torque`: `torque_out` gives it at the other port"),
        "{text}"
    );
    for name in ["rig", "half", "other"] {
        let value = results.json(name);
        for point in value["comparisons"][0]["points"].as_array().unwrap() {
            // The tolerance of a point, 1e-9 of 3 kW, in percent of 50 W.
            assert!(point["difference"].as_f64().unwrap().abs() < 1e-5, "{name} {point}");
        }
        assert_eq!(value["comparisons"][0]["model_set"], "own");
    }
    let point = &results.json("rig")["comparisons"][0]["points"][0];
    assert!((point["speed_rpm"].as_f64().unwrap() + 1500.0).abs() < 1e-9, "{point}");
}

#[test]
fn a_torque_at_the_output_gives_the_loss_by_the_ratio_alone() {
    let (output, loss) = solved(10.0);
    let rig = format!("torque [Nm],speed [rpm],torque_out [Nm]\n10,3000,{output}\n");
    let study = "
analyses: { rig: { type: compare, data: { file: rig.csv }, against: [own], quantity: loss, difference: points, write: [json] } }
";
    let (results, _) = run(study, &[("rig.csv", &rig)]);
    let measured = results.json("rig")["comparisons"][0]["points"][0]["measured"]
        .as_f64()
        .unwrap();
    assert!((measured - loss).abs() < 1e-6 * loss, "{measured} {loss}");
}

#[test]
fn analyses_that_need_the_input_refuse_the_output_alone() {
    let study = "
measurements: { rig: { file: rig.csv } }
analyses: { which: { type: tournament, data: rig, mechanisms: [{ mechanism: bearing }] } }
";
    let rig = "torque_out [Nm],speed_out [rpm],loss [W]\n19,1500,50\n";
    let text = check(&folder("refused", study, &[("rig.csv", rig)]));
    assert!(
        text.contains("analyses.which.data: rig.csv: `torque_out` alone does not determine the torque"),
        "{text}"
    );
    assert!(text.contains("columns: { torque: ... }"), "{text}");
}

#[test]
fn files_are_joined_filtered_and_given_accuracies() {
    let study = r#"
measurements:
  rig:
    file: [first.csv, { file: second.csv, name: warm, columns: { torque: { column: T_brake, scale: 0.001, sign: -1 } }, units: { torque: Nm } }]
    units: { loss: W }
    rows: "torque > 5 Nm"
    accuracies: { loss: { percent_of_reading: 3, full_scale: 1 kW, percent_of_full_scale: 0.4 } }
    stated_as: standard
analyses:
  fit: { type: compare, data: rig, against: [own], quantity: loss, difference: points }
  list: { type: operating_points, data: rig, model_sets: [own] }
"#;
    let first = "torque [Nm],speed [rpm],loss\n10,3000,50\n1,3000,40\n";
    let second = "T_brake,speed [rpm],loss\n-20000,3000,60\n";
    let (results, text) = run(study, &[("first.csv", first), ("second.csv", second)]);
    assert!(
        text.contains("warm: column `T_brake` is read multiplied by 0.001, with the opposite sign as torque"),
        "{text}"
    );
    assert!(
        text.contains("1 of 3 rows are omitted by `rows: torque > 5 Nm`"),
        "{text}"
    );
    let value = results.json("fit");
    let points = value["comparisons"][0]["points"].as_array().unwrap();
    assert_eq!(
        (points.len(), &points[1]["file"], &points[1]["line"]),
        (2, &"warm".into(), &2.into())
    );
    for point in points {
        let model = point["model"].as_f64().unwrap();
        let expected = (0.03 * model).hypot(4.0);
        assert!((point["accuracy"].as_f64().unwrap() - expected).abs() < 1e-9, "{point}");
    }
    // Both files are told with their hashes.
    let inputs = value["inputs"].to_string();
    assert!(
        inputs.contains("first.csv") && inputs.contains("second.csv"),
        "{inputs}"
    );
    let csv = results.csv("fit");
    assert!(csv.contains("own,first.csv:2,") && csv.contains("own,warm:2,"), "{csv}");
    let schema: Value =
        serde_json::from_str(&std::fs::read_to_string(common::file("schemas/result.schema.json")).unwrap()).unwrap();
    assert!(jsonschema::is_valid(&schema, &value), "{value}");
}

#[test]
fn a_recording_is_compared_by_its_steady_stretches() {
    let study = "
measurements:
  recording:
    file: recording.csv
    units: { time: min }
    steady: { time: t, window: 10 s, drift: { torque: 0.5 Nm, speed: 20 rpm }, scatter: { torque: 1 Nm } }
analyses:
  fit: { type: compare, data: recording, against: [own], quantity: loss, difference: points }
";
    let mut text = "t,torque [Nm],speed [rpm],loss [W]\n".to_owned();
    for k in 0..600 {
        let seconds = 0.1 * f64::from(k);
        let torque = match seconds {
            s if s < 20.0 => 10.0,
            s if s < 30.0 => 10.0 + (s - 20.0),
            _ => 20.0,
        };
        text.push_str(&format!(
            "{},{torque},3000,{}\n",
            seconds / 60.0,
            50.0 + f64::from(k % 3)
        ));
    }
    let (results, printed) = run(study, &[("recording.csv", &text)]);
    assert!(
        printed.contains("fit: recording.csv: 2 steady intervals, 8"),
        "{printed}"
    );
    assert!(
        printed.contains("largest standard errors of the means: torque"),
        "{printed}"
    );
    let value = results.json("fit");
    let torques: Vec<f64> = value["comparisons"][0]["points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| p["torque_nm"].as_f64().unwrap())
        .collect();
    assert!(
        (torques[0] - 10.0).abs() < 0.1 && (torques[1] - 20.0).abs() < 0.1 && torques.len() == 2,
        "{torques:?}"
    );
}

#[test]
fn every_fault_of_a_file_is_found_once_however_many_analyses_use_it() {
    let study = "
measurements:
  rig: { file: rig.csv, columns: { loss: P_loss, efficency: eta } }
  unused: { file: nowhere.csv }
analyses:
  one: { type: compare, data: rig, against: [own], quantity: loss, difference: points }
  two: { type: operating_points, data: rig, bind: { p: housing.oil.volume } }
";
    let rig = "torque,speed [rpm],P_los [W]\n10,3000,50\n10,x,50\n";
    let folder = folder("faults", study, &[("rig.csv", rig)]);
    let text = check(&folder);
    for told in [
        "measurements.rig.columns.efficency: `efficency` is not a measured quantity",
        "measurements.rig.units.torque: rig.csv: line 1, column `torque` has no unit",
        "measurements.rig.columns.loss: rig.csv: line 1: there is no column `P_loss`",
        "write `P_los`",
        "measurements.rig: rig.csv: line 3, column 2 `speed`: `x` is not a number",
        "measurements.unused.file: nowhere.csv: cannot read",
        "analyses.two.bind.p: rig.csv: line 1: there is no column `p`, which is bound",
    ] {
        assert_eq!(text.matches(told).count(), 1, "{told}\n{text}");
    }
    let (code, refused) = gearloss(&["run", folder.join("study.yaml").to_str().unwrap()]);
    assert_eq!(code, Some(2));
    assert!(refused.contains(text.trim_end()), "{refused}");
    assert!(refused.contains("2 of 2 analyses failed"), "{refused}");
    assert_eq!(refused.matches("column `torque` has no unit").count(), 1, "{refused}");
}
