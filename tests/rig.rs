//! The synthetic measurement of the two-speed example: made here, and compared as a user compares his own.
#![allow(clippy::unwrap_used)]

mod common;

use std::fmt::Write as _;

use common::{RPM, language};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use serde_json::{Value, json};

/// What the models are not told: a thinner oil than stated, rougher flanks, a higher level, more boundary friction in the
/// bearings. Chosen before anything was fitted, as the seed was.
const HIDDEN: [(&str, &str); 4] = [
    ("lubricants.sump.viscosity.kv100", "5.8 mm2/s"),
    ("gears.*.surface.rq", "0.45 um"),
    ("housing.oil.level_offset", "4 mm"),
    ("bearings.*.model.mu_bl", "0.12"),
];
/// Offset of the torque meter at the input. \[Nm\]
const OFFSET: f64 = 0.03;
/// Standard deviations: 0.05 % of the full scale of each torque meter, 50 and 500 Nm; of the oil's temperature.
const NOISE: [f64; 3] = [0.025, 0.25, 0.5];
const SEED: u64 = 20151118;

/// Numbers of a normal distribution, always the same ones (SplitMix64, Box and Muller).
struct Normal(u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (2.0 * std::f64::consts::PI * self.uniform()).cos()
    }
}

fn comma(x: f64, digits: usize) -> String {
    format!("{x:.digits$}").replace('.', ",")
}

/// `UPDATE=1` writes the file.
#[test]
fn the_synthetic_measurement_is_what_the_hidden_parameters_make() {
    let language = language();
    let folder = common::file("examples/two-speed-ev");
    let gearbox = Gearbox::read(&language, &folder.join("gearbox.yaml")).unwrap_or_else(|f| panic!("{}", f.render()));
    let study = std::fs::read_to_string(folder.join("study.yaml")).unwrap();
    let read = gearloss_framework::document::read_yaml(0, &study);
    let sets = language.walk_study(&read.node).value["model_sets"]
        .as_object()
        .cloned()
        .unwrap();
    let value = |text: &str| text.parse::<f64>().map_or_else(|_| json!(text), |x| json!(x));
    let overrides = HIDDEN
        .iter()
        .map(|(path, text)| ((*path).to_owned(), value(text)))
        .collect();
    let choice = Choice {
        set: Some("complete".to_owned()),
        sets,
        overrides,
    };
    let t = gearbox
        .transmission(&language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let case = t.case("first", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut noise = Normal(SEED);
    let mut csv =
        "# SYNTHETIC: no rig has measured this. Made by the set `complete` of study.yaml with these hidden changes:\n"
            .to_owned();
    for (path, value) in HIDDEN {
        let _ = writeln!(csv, "#   {path} = {value}");
    }
    let _ = writeln!(
        csv,
        "# The torque meter at the input shows {OFFSET} Nm too much. Noise: standard deviations of {} Nm at the input and {} Nm at",
        NOISE[0], NOISE[1]
    );
    let _ = writeln!(
        csv,
        "# the output (0.05 % of full scales of 50 and 500 Nm) and {} K of the oil, seed {SEED}. The accuracy of the efficiency",
        NOISE[2]
    );
    csv.push_str("# follows from those of both torques.\n");
    csv.push_str("T_in;n_in;T_out;n_out;eta;s_eta;T_oil\nNm;1/min;Nm;1/min;%;%;degC\n");
    for torque in [3.6, 5.0, 7.0, 10.0, 13.0, 16.0, 20.0] {
        for thousand in (2..=22).step_by(2) {
            let speed = f64::from(thousand) * 1000.0;
            let oil = 100.0 + NOISE[2] * noise.next();
            let point = Point {
                speeds: &[speed * RPM],
                torques: &[torque],
                flow: PowerFlow::Real,
                tolerance: Tolerance::default(),
            };
            let solution = t.evaluate(&case, &point, &[oil], &mut scratch);
            let out = t.port("output").unwrap();
            let turning = solution.speed(t.ports()[out].member);
            let shown_in = torque + OFFSET + NOISE[0] * noise.next();
            let shown_out = solution.torque(out).abs() + NOISE[1] * noise.next();
            let eta = shown_out * turning.abs() / (shown_in * speed * RPM);
            let spread = eta * (NOISE[0] / shown_in).hypot(NOISE[1] / shown_out);
            let _ = writeln!(
                csv,
                "{};{};{};{};{};{};{}",
                comma(shown_in, 3),
                comma(speed, 0),
                comma(shown_out, 2),
                comma(turning.abs() / RPM, 2),
                comma(100.0 * eta, 3),
                comma(100.0 * spread, 3),
                comma(oil, 1)
            );
        }
    }
    let file = folder.join("rig.csv");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, &csv).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), csv, "UPDATE=1 writes it");
}

/// Runs a study on the example with the synthetic file beside it.
fn run(name: &str, study: &str, rig: &str) -> (std::path::PathBuf, String) {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("rig-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let gearbox = common::file("examples/two-speed-ev/gearbox.yaml");
    let head = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {0}, theirs: {0} }}\n",
        gearbox.display()
    );
    std::fs::write(folder.join("study.yaml"), head + study).unwrap();
    std::fs::write(folder.join("rig.csv"), rig).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(folder.join("study.yaml"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (folder, text)
}

fn json_of(folder: &std::path::Path, name: &str) -> Value {
    let path = folder.join(format!("results/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

const DATA: &str = "data: { file: rig.csv, columns: { torque: T_in, speed: n_in, efficiency: eta, efficiency_accuracy: s_eta, oil_temperature: T_oil } }";

#[test]
fn models_are_compared_with_the_file_in_points_and_in_percent_of_loss() {
    let rig = std::fs::read_to_string(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    let study = format!(
        "analyses:\n  fit: {{ type: compare, gear: first, against: [own, theirs/own], write: [csv, json, svg], {DATA} }}\n"
    );
    let study = study.replace("[own, theirs/own]", "[ours/own, theirs/own]");
    let (folder, text) = run("compare", &study, &rig);
    let comparisons = json_of(&folder, "fit")["comparisons"].clone();
    let first = &comparisons[0];
    let points = first["points"].as_array().expect(&text);
    assert_eq!(points.len(), 77);
    let number = |v: &Value| v.as_f64().unwrap();
    // The figures are those of the points.
    let differences: Vec<f64> = points.iter().map(|p| number(&p["difference"])).collect();
    let mean = differences.iter().sum::<f64>() / 77.0;
    assert!((number(&first["difference"]["mean"]) - mean).abs() < 1e-12);
    for point in points {
        let (saw, model) = (number(&point["measured"]), number(&point["model"]));
        assert!((number(&point["difference"]) - 100.0 * (model - saw)).abs() < 1e-12);
        let of_loss = 100.0 * ((1.0 - model) / (1.0 - saw) - 1.0);
        assert!((number(&point["loss_difference_percent_of_loss"]) - of_loss).abs() < 1e-6 * of_loss.abs().max(1.0));
    }
    // The second is the same product by another name: no measurement tells them apart.
    assert_eq!(first["difference"], comparisons[1]["difference"]);
    assert!(
        text.contains("indistinguishable") && text.contains("decimal comma") && text.contains("units in line"),
        "{text}"
    );
    for picture in ["fit-parity.svg", "fit-histogram.svg"] {
        assert!(folder.join("results").join(picture).is_file());
    }
}

#[test]
fn without_an_efficiency_the_torques_at_both_ports_give_it() {
    let rig = std::fs::read_to_string(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    let both = "data: { file: rig.csv, columns: { torque: T_in, speed: n_in, torque_out: T_out, speed_out: n_out, oil_temperature: T_oil } }";
    let study = format!(
        "analyses:\n  eta: {{ type: compare, gear: first, against: [ours/own], {DATA} }}\n  both: {{ type: compare, gear: first, against: [ours/own], {both} }}\n  loss: {{ type: compare, gear: first, against: [ours/own], quantity: loss_torque, {both} }}\n"
    );
    let (folder, text) = run("both", &study, &rig);
    let mean = |name: &str| {
        json_of(&folder, name)["comparisons"][0]["difference"]["mean"]
            .as_f64()
            .unwrap_or_else(|| panic!("{text}"))
    };
    // The file rounds its torques and its efficiency.
    assert!(
        (mean("eta") - mean("both")).abs() < 0.01,
        "{} {}",
        mean("eta"),
        mean("both")
    );
    // A model that is less efficient than the file loses more.
    assert!(
        mean("eta") < 0.0 && mean("loss") > 0.0,
        "{} {}",
        mean("eta"),
        mean("loss")
    );
}

#[test]
fn what_a_comparison_lacks_is_told() {
    for (analysis, said) in [
        (
            format!("against: [ours/own], grid: g, {DATA}"),
            "needs either `grid` and `base`, or `data`",
        ),
        (
            "against: [ours/own], data: { file: nowhere.csv }".to_owned(),
            "cannot read",
        ),
        (
            "against: [ours/own], data: { file: rig.csv, columns: { torque: T_in, speed: n_in } }".to_owned(),
            "nothing gives a measured efficiency",
        ),
        (format!("against: [nobody/own], {DATA}"), "nobody"),
        (
            "against: [ours/own], data: { file: rig.csv, columns: { torque: T_in, speed: drehzahl } }".to_owned(),
            "no column is called `drehzahl`",
        ),
    ] {
        let study = format!(
            "grids: {{ g: {{ gear: first, torque: 10 Nm, speed: 1000 rpm }} }}\nanalyses:\n  fit: {{ type: compare, {analysis} }}\n"
        );
        let (_, text) = run("lacks", &study, "T_in;n_in\nNm;1/min\n10;1000\n");
        assert!(text.contains(said) && text.contains("mend:"), "{said}\n{text}");
    }
}

#[test]
fn a_sweep_changes_one_value_and_is_the_map_at_each() {
    let study = "grids: { g: { gear: first, torque: 10 Nm, speed: 8000 rpm, bind: { lubricants.sump.viscosity.kv100: [4 mm2/s, 8 mm2/s] } } }
analyses:
  oil: { type: sweep, gear: first, path: lubricants.sump.viscosity.kv100, values: [4 mm2/s, 8 mm2/s], torque: [0 Nm, 10 Nm], speed: 8000 rpm }
  hot: { type: sweep, gear: first, path: thermal.oil, values: [60 degC, 100 degC], torque: 10 Nm, speed: 8000 rpm }
  map: { type: map, grid: g }
  none: { type: sweep, path: lubricants.sump.viscosity.kv900, values: [1], torque: 10 Nm, speed: 8000 rpm }
";
    let (folder, text) = run("sweep", study, "");
    let sweep = json_of(&folder, "oil")["sweep"].clone();
    let map = json_of(&folder, "map")["maps"].clone();
    for i in 0..2 {
        assert_eq!(sweep[i]["points"][1]["loss_w"], map[i]["points"][0]["loss_w"], "{text}");
    }
    let loss = |value: &Value| value["points"][0]["loss_w"].as_f64().unwrap();
    assert!(loss(&sweep[0]) < loss(&sweep[1]), "thick oil loses more without load");
    let hot = json_of(&folder, "hot")["sweep"].clone();
    assert!(loss(&hot[0]) > loss(&hot[1]) && hot[0]["points"][0]["oil_temperature_degc"] == 60.0);
    assert!(
        folder.join("results/oil-loss.svg").is_file() && text.contains("kv900"),
        "{text}"
    );
}
