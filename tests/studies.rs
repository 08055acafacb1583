//! Studies of the two-speed example: maps, stacks, exports, bands, tournaments; what they show agrees with what was solved.

use crate::common;
use crate::common::study::{Ran, number, of_gearbox, run_texts};
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

const SETS: &str = "model_sets:
  joint:
    gear_mesh: { type: path_integral, load_sharing: rigid, tooth_friction: { type: xu } }
    gear_drag: { churning: { type: changenet_2011 } }
    bearing: { type: skf, edition: \"2013\", mu_bl: 0.15 }
    seal: { type: iso14179_2 }
    synchronizer: { type: cone_gap }
";

/// A study of the two-speed example.
fn study_of(sets: &str, rest: &str) -> String {
    let study = format!("conditions: {{ oil_temperature: 100 degC }}\n{sets}{rest}");
    of_gearbox("examples/two-speed-ev/gearbox.yaml", &study)
}

/// Runs a study with files beside it; its results and what was printed.
fn run(study: &str, files: &[(&str, &str)]) -> (Ran, String) {
    run_texts(&study_of(SETS, study), files).with_text()
}

/// A folder with a study and files beside it, for the program.
fn written(name: &str, study: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gearloss-studies-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("study.yaml"), study_of(SETS, study)).unwrap();
    for (file, text) in files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    folder
}

fn points(value: &Value) -> &[Value] {
    value["points"].as_array().unwrap()
}

fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1e-12), "{a} {b}");
}

const PLAIN: &str = "grids:
  few: { gear: first, torque: [5 Nm, 10 Nm, 20 Nm], speed: [2000 rpm, 8000 rpm, 20000 rpm] }
";

/// Power at the ports, stacks by every kind of share, and the loss of a map are one number.
#[test]
fn stacks_add_up_to_the_loss_of_the_map() {
    let study = format!(
        "{PLAIN}analyses:
  map: {{ type: map, grid: few, model_sets: [joint] }}
  mechanism: {{ type: breakdown, model_sets: [joint], torque: 10 Nm, speed: 8000 rpm }}
  component: {{ type: breakdown, model_sets: [joint], by: component, torque: 10 Nm, speed: 8000 rpm }}
  stage: {{ type: breakdown, model_sets: [joint], by: stage, torque: 10 Nm, speed: 8000 rpm }}
  term: {{ type: breakdown, model_sets: [joint], by: term, torque: 10 Nm, speed: 8000 rpm }}
  sum: {{ type: breakdown, model_sets: [joint], by: sum, torque: 10 Nm, speed: 8000 rpm }}
  percent: {{ type: breakdown, model_sets: [joint], as: percent, torque: 10 Nm, speed: 8000 rpm }}
  over_torque: {{ type: breakdown, model_sets: [joint], over: torque, torque: [5 Nm, 10 Nm], speed: 8000 rpm }}
  warm: {{ type: temperature_sweep, model_sets: [joint], oil_temperature: [40 degC, 100 degC], torque: 10 Nm, speed: 8000 rpm }}
"
    );
    let (results, text) = run(&study, &[]);
    let map = results.json("map");
    let loss = number(&points(&map["maps"][0])[4]["loss_w"]);
    let stack = |name: &str, point: usize| -> f64 {
        let result = results.json(name);
        let unit = result["breakdowns"][0]["unit"].as_str().unwrap();
        let list = points(&result["breakdowns"][0])[point][format!("losses_{unit}")]
            .as_array()
            .cloned();
        list.unwrap_or_else(|| panic!("{name}: {text}"))
            .iter()
            .map(number)
            .sum()
    };
    for name in ["mechanism", "component", "stage", "term", "sum"] {
        assert_close(stack(name, 0), loss, 1e-12);
    }
    assert_close(stack("percent", 0), 100.0, 1e-12);
    assert_close(stack("over_torque", 1), loss, 1e-12);
    assert_close(stack("warm", 1), loss, 1e-12);
    assert!(stack("warm", 0) > loss, "cold oil is thicker");
    let stages = results.json("stage")["breakdowns"][0]["shares"].clone();
    for share in ["meshes.M1", "meshes.M2", "shafts.input", "shafts.output"] {
        assert!(
            stages.as_array().unwrap().contains(&Value::from(share)),
            "{share}: {stages}"
        );
    }
}

#[test]
fn one_power_at_every_speed_and_a_measured_total_beside_the_bars() {
    let rig = "torque [Nm];speed [rpm];loss [W];loss_accuracy [W]\n9,95;8010;150;5\n10,05;7990;160;4\n10;20000;1;1\n";
    let study = "analyses:
  power: { type: breakdown, model_sets: [joint], power: 8 kW, speed: [4000 rpm, 8000 rpm] }
  seen: { type: breakdown, model_sets: [joint], torque: 10 Nm, speed: [8000 rpm, 9000 rpm], measured: { file: rig.csv } }
  standstill: { type: breakdown, model_sets: [joint], power: 8 kW, speed: [0 rpm, 8000 rpm] }
  both: { type: breakdown, model_sets: [joint], power: 8 kW, torque: 3 Nm, speed: 8000 rpm }
";
    let (results, text) = run(study, &[("rig.csv", rig)]);
    for point in points(&results.json("power")["breakdowns"][0]) {
        assert_close(
            number(&point["torque_nm"]) * number(&point["speed_rpm"]) * common::RPM,
            8000.0,
            1e-9,
        );
    }
    let seen = results.json("seen")["breakdowns"][0].clone();
    assert_close(number(&points(&seen)[0]["measured_loss_w"]), 155.0, 1e-12);
    assert!(points(&seen)[1]["measured_loss_w"].is_null());
    assert!(text.contains("a power at standstill is not possible"), "{text}");
    assert!(text.contains("a breakdown needs either `torque` or `power`"), "{text}");
}

/// Without load nothing comes out, and in neutral the port that is not turned stands still.
#[test]
fn losses_without_load_in_every_gear_state_and_towed() {
    let study = "analyses:
  spin: { type: spin_loss, model_sets: [joint], speed: [5000 rpm] }
  towed: { type: spin_loss, model_sets: [joint], turned_at: output, gears: [first], speed: [200 rpm] }
  wrong: { type: spin_loss, model_sets: [joint], turned_at: outptu, speed: [200 rpm] }
";
    let (results, text) = run(study, &[]);
    let spin = results.json("spin");
    let states = spin["breakdowns"].as_array().unwrap();
    assert_eq!(states.len(), 3);
    let loss = |state: &Value| -> f64 {
        points(state)[0]["losses_w"]
            .as_array()
            .unwrap()
            .iter()
            .map(number)
            .sum()
    };
    assert!(loss(&states[2]) < loss(&states[0]), "in neutral the loaded stage rests");
    assert!(text.contains("output stationary"), "{text}");
    let towed = results.json("towed")["breakdowns"][0].clone();
    assert!(loss(&towed) > 0.0);
    assert!(text.contains("write `output`"), "{text}");
}

#[test]
fn envelopes_ratings_and_listed_points_agree_with_the_plain_grid() {
    let gearbox = common::file("examples/two-speed-ev/gearbox.yaml");
    let rated = format!(
        "gearloss: gearbox/1\nextends: {}\nrating: {{ torque: 20 Nm, speed: 20000 rpm }}\n",
        gearbox.display()
    );
    let head = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {}, rated: rated.yaml }}\nconditions: {{ oil_temperature: 100 degC }}\n{SETS}",
        gearbox.display()
    );
    let study = "grids:
  few: { gear: first, torque: [5 Nm, 10 Nm, 20 Nm], speed: [2000 rpm, 8000 rpm, 20000 rpm] }
  inside: { gear: [first, second], torque: [5 Nm, 10 Nm, 20 Nm], speed: [2000 rpm, 8000 rpm, 20000 rpm], envelope: { speed: [0 rpm, 8000 rpm, 20000 rpm], torque: [20 Nm, 20 Nm, 8 Nm] } }
  shares: { gear: first, torque: { of_rating: [0.25, 0.5, 1] }, speed: { of_rating: [0.1, 0.4, 1] } }
analyses:
  plain: { type: map, grid: few, model_sets: [ours/joint] }
  inside: { type: map, grid: inside, model_sets: [ours/joint], write: [json, svg] }
  shares: { type: map, grid: shares, model_sets: [rated/joint], write: [json, svg] }
  unrated: { type: map, grid: shares, model_sets: [ours/joint] }
  listed: { type: map, points: { file: points.csv }, model_sets: [ours/joint], write: [csv, json, svg] }
";
    let listed = "torque [Nm],speed [rpm],oil_temperature [degC],gear\n10,8000,100,first\n10,8000,60,first\n10,8000,100,second\n";
    let files = [("rated.yaml", rated.as_str()), ("points.csv", listed)];
    let (results, text) = run_texts(&(head + study), &files).with_text();
    let plain = results.json("plain");
    let loss = |result: &Value, i: usize| number(&points(result)[i]["loss_w"]);
    // 20 Nm and 10 Nm at 20000 rpm lie beyond the envelope.
    let inside = results.json("inside");
    assert_eq!(
        inside["maps"].as_array().unwrap().len(),
        2,
        "one map for each gear state"
    );
    assert_eq!(points(&inside["maps"][0]).len(), 7);
    assert_close(loss(&inside["maps"][0], 4), loss(&plain["maps"][0], 4), 1e-12);
    let shares = results.json("shares");
    for i in 0..9 {
        assert_close(loss(&shares["maps"][0], i), loss(&plain["maps"][0], i), 1e-9);
    }
    let picture = results.picture("shares-rated-joint-loss");
    assert!(picture.contains("speed / rated speed"));
    assert!(
        text.contains("add `rating: { torque: 20 Nm, speed: 22000 rpm }` to the gearbox"),
        "{text}"
    );
    let listed = results.json("listed");
    let maps = listed["maps"].as_array().unwrap();
    assert_eq!(maps.len(), 2);
    assert_close(loss(&maps[0], 0), loss(&plain["maps"][0], 4), 1e-12);
    assert!(
        loss(&maps[0], 1) > loss(&maps[0], 0),
        "the temperature of a row holds for its point"
    );
}

/// Points in the study itself are those of a file; loads of an analysis are a load spectrum with equal shares.
#[test]
fn points_of_the_study_are_those_of_a_file() {
    let study = "cycles:
  spectrum: { spectrum: [{ torque: 10 Nm, speed: 8000 rpm, share: 0.5 }, { torque: 20 Nm, speed: 2000 rpm, share: 0.5 }] }
analyses:
  here: { type: operating_points, gear: first, points: [{ torque: 10 Nm, speed: 8000 rpm, name: road }, { torque: 10 Nm, speed: 8000 rpm, gear: second }, { torque: 20 Nm, speed: 2000 rpm, oil_temperature: 60 degC }] }
  file: { type: operating_points, gear: first, data: { file: points.csv } }
  fluids: { type: fluid_sweep, gear: first, kv100: [5 mm2/s, 6 mm2/s, 8 mm2/s], refine: false, points: [{ torque: 10 Nm, speed: 8000 rpm }, { torque: 20 Nm, speed: 2000 rpm }] }
  same: { type: fluid_sweep, gear: first, kv100: [5 mm2/s, 6 mm2/s, 8 mm2/s], refine: false, cycles: [spectrum] }
  best: { type: optimise, gear: first, designs: 16, points: [{ torque: 10 Nm, speed: 8000 rpm }], variables: { viscosity: { path: lubricants.*.viscosity.factor, from: 0.5, to: 1.5 } } }
";
    let listed = "torque [Nm],speed [rpm],oil_temperature [degC],gear,name\n10,8000,100,first,road\n10,8000,100,second,2\n20,2000,60,first,3\n";
    let (results, _) = run(study, &[("points.csv", listed)]);
    let [here, file] = ["here", "file"].map(|name| results.json(name)["operating_points"][0].clone());
    let calculated = |point: &Value| {
        [
            "name",
            "gear",
            "torque_nm",
            "speed_rpm",
            "oil_temperature_degc",
            "loss_w",
        ]
        .map(|key| point[key].clone())
    };
    let [entered, read] = [&here, &file].map(|of_set| points(of_set).iter().map(calculated).collect::<Vec<_>>());
    assert_eq!(entered, read);
    assert_eq!(entered[0][..2], ["road", "first"].map(Value::from));
    let measured = |point: &Value| point["measured"]["oil_temperature_degc"].is_null();
    assert!(points(&here).iter().all(measured));
    let [fluids, same] = ["fluids", "same"].map(|name| results.json(name)["fluid_sweep"][0]["cycles"][0].clone());
    assert_eq!(
        (&fluids["cycle"], &same["cycle"]),
        (&Value::from("points"), &Value::from("spectrum"))
    );
    assert_eq!(fluids["fluids"], same["fluids"]);
    assert!(results.json("best").is_object());
}

/// Neither, or both, of what only one can be.
#[test]
fn points_are_stated_once() {
    for (analysis, words) in [
        ("type: operating_points", "add `points: ["),
        (
            "type: operating_points, points: [{ torque: 1 Nm, speed: 1 rpm }], data: { file: points.csv }",
            "delete one of them",
        ),
        (
            "type: operating_points, points: [{ torque: 1 Nm, speed: 1 rpm }], bind: { volume: housing.oil.volume }",
            "`bind` names columns",
        ),
        (
            "type: fluid_sweep, kv100: [5 mm2/s]",
            "neither a cycle nor a point is stated",
        ),
    ] {
        let folder = written(
            "once",
            &format!("analyses: {{ own: {{ {analysis} }} }}\n"),
            &[("points.csv", "torque [Nm],speed [rpm]\n1,1\n")],
        );
        let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .args(["check", "study.yaml"])
            .current_dir(&folder)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && text.contains(words),
            "{analysis}: {text}"
        );
    }
}

/// Rows of a file of comma-separated numbers.
fn numbers(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| {
        line.split(',')
            .map(|c| c.trim().trim_end_matches([';', ']']).parse().unwrap())
            .collect()
    };
    text.lines().map(row).collect()
}

/// The tables for other programs are read back, and interpolated between their points: VECTO's is exact at them and within
/// 1.2 % of the loss torque half way, 5 % beside zero torque; the lines of `LossyGear` begin at the no-load loss, miss by what the
/// file says, and are refused where that is too much; MATLAB's have the loss torque, and an axis of temperature where there are
/// several.
#[test]
fn tables_for_other_programs_give_the_losses_back() {
    let study = "grids:
  wide: { gear: first, torque: { from: -20 Nm, to: 20 Nm, step: 2 Nm }, speed: { from: 1000 rpm, to: 21000 rpm, step: 1000 rpm } }
  half: { gear: first, torque: { from: -19 Nm, to: 19 Nm, step: 2 Nm }, speed: { from: 1500 rpm, to: 20500 rpm, step: 1000 rpm } }
  drive: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 4000 rpm] }
analyses:
  wide: { type: map, grid: wide, model_sets: [joint], export: [vecto, matlab, lossy_gear] }
  half: { type: map, grid: half, model_sets: [joint] }
  refused: { type: map, grid: drive, model_sets: [joint], export: [vecto] }
  strict: { type: map, grid: wide, model_sets: [joint], lossy_gear_limit: 0.1, export: [lossy_gear] }
";
    let (results, text) = run(study, &[]);
    let vecto = results.file("wide-joint-first.vtlm");
    let (header, rows) = vecto.split_once('\n').unwrap();
    assert_eq!(header, "Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]");
    let rows = numbers(rows.trim_end());
    assert_eq!(rows.len(), 21 * 21);
    assert!(rows.iter().all(|r| r[2] > 0.0));
    let at = |speed: f64, torque: f64| -> f64 {
        let row = rows
            .iter()
            .find(|r| (r[0] - speed).abs() < 1e-6 && (r[1] - torque).abs() < 1e-6);
        row.unwrap()[2]
    };
    let wide = results.json("wide");
    for point in points(&wide["maps"][0]) {
        let (torque, speed) = (number(&point["torque_nm"]), number(&point["speed_rpm"]));
        // Written to six decimals.
        assert!((at(speed, torque) - number(&point["loss_torque_nm"])).abs() < 6e-7);
    }
    let half = results.json("half");
    let mut worst = [0.0_f64; 2];
    for point in points(&half["maps"][0]) {
        let (torque, speed) = (number(&point["torque_nm"]), number(&point["speed_rpm"]));
        let corner = |dw: f64, dt: f64| at(speed + dw, torque + dt);
        let mean = 0.25 * (corner(-500.0, -1.0) + corner(500.0, -1.0) + corner(-500.0, 1.0) + corner(500.0, 1.0));
        let loss = number(&point["loss_torque_nm"]);
        // Beside zero torque the loss torque bends.
        let place = usize::from(torque.abs() > 2.0);
        worst[place] = worst[place].max((mean / loss - 1.0).abs());
    }
    assert!(worst[0] < 0.05 && worst[1] < 0.012, "{worst:?}");
    assert!(
        text.contains("VECTO needs rows below, at and above zero torque"),
        "{text}"
    );

    // The equations of the Modelica Standard Library: (1 - eta1) T + f1 where a drives, (1 - 1 / eta2) T + f2 where b does.
    let modelica = results.file("losses_wide_joint_first.mo");
    let said = |before: &str| -> f64 {
        let rest = modelica.split(before).nth(1);
        rest.and_then(|rest| rest.split(' ').next()).unwrap().parse().unwrap()
    };
    let (_, table) = modelica.split_once("= [\n").unwrap();
    let table = numbers(table.split_once("];").unwrap().0);
    assert_eq!((table.len(), table[0][0]), (22, 0.0));
    let (mut worst, mut rated) = (0.0_f64, 0.0_f64);
    for point in points(&wide["maps"][0]) {
        let (torque, speed) = (number(&point["torque_nm"]), number(&point["speed_rpm"]) * common::RPM);
        let loss = number(&point["loss_torque_nm"]);
        let row = table.iter().find(|r| (r[0] - speed).abs() < 1e-5).unwrap();
        let lines = [(1.0 - row[1]) * torque + row[3], (1.0 - 1.0 / row[2]) * torque + row[4]];
        if torque == 0.0 {
            // Written to eight decimals.
            assert!(lines.iter().all(|line| (line - loss).abs() < 1e-8), "{lines:?} {loss}");
            continue;
        }
        let gap = 100.0 * (lines[usize::from(torque < 0.0)] / loss - 1.0).abs();
        worst = worst.max(gap);
        if torque.abs() == 20.0 {
            rated = rated.max(gap);
        }
    }
    // Efficiencies are written to eight decimals, the percentage to one.
    assert!((worst - said("by at most ")).abs() < 0.051, "{worst}");
    let at_rated = modelica.split(" at the largest torque 20 Nm").next().unwrap();
    let at_rated: f64 = at_rated
        .rsplit('(')
        .next()
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((rated - at_rated.abs()).abs() < 0.051, "{rated} {at_rated}");
    assert!(worst > 15.0, "the refusal below would prove nothing: {worst}");
    assert!(
        text.contains("analyses.strict.export: the straight lines of `LossyGear` deviate from the loss torque by")
            && text.contains("the limit is 10 %")
            && text.contains("`lossy_gear_limit: 0."),
        "{text}"
    );
    assert!(!results.has_file("losses_strict_joint_first.mo"));

    // Simulink: rows are torques, columns speeds.
    let script = results.file("wide-joint-first.m");
    let list = |name: &str| -> Vec<f64> {
        let (_, rest) = script.split_once(&format!("{name} = [")).unwrap();
        rest.split(']')
            .next()
            .unwrap()
            .split_whitespace()
            .map(|x| x.parse().unwrap())
            .collect()
    };
    assert_eq!(list("Trq_bpts").len(), 21);
    assert!(!script.contains("Temp_bpts"), "only one temperature was computed");
    assert_close(list("omega_bpts")[0], 1000.0 * common::RPM, 1e-12);
    let slab = |name: &str| -> Vec<Vec<f64>> {
        let (_, slab) = script.split_once(&format!("{name} = [\n")).unwrap();
        let row = |line: &str| {
            let cells = line.trim_end_matches(';').split_whitespace();
            cells.map(|x| x.parse().unwrap()).collect()
        };
        slab.lines().take(21).map(row).collect()
    };
    let (eta, loss) = (slab("eta_tbl"), slab("loss_tbl"));
    for (i, point) in points(&wide["maps"][0]).iter().enumerate() {
        assert_close(eta[i / 21][i % 21], point["efficiency"].as_f64().unwrap_or(0.0), 1e-12);
        assert_close(loss[i / 21][i % 21], number(&point["loss_torque_nm"]), 1e-12);
    }
    let study = "grids:
  warm: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 4000 rpm], bind: { thermal.oil: [40 degC, 90 degC] } }
analyses:
  warm: { type: map, grid: warm, model_sets: [joint], export: [matlab] }
";
    let study = study_of(SETS, study).replace("{ oil_temperature: 100 degC }", "{}");
    let results = run_texts(&study, &[]);
    let warm = results.file("warm-joint-first.m");
    assert!(warm.contains("Temp_bpts = [313.15 363.15]; % K\n"), "{warm}");
    assert!(warm.contains("eta_tbl(:,:,2) = [\n") && warm.contains("loss_tbl(:,:,2) = [\n"));
}

/// A loss that is proportional to an input has the band of that input: 95 % of plus and minus 10 % are 9.5 %.
#[test]
fn a_band_is_that_of_the_input_where_the_loss_is_proportional_to_it() {
    let study = "  seals:
    gear_mesh: none
    gear_drag: { churning: none }
    bearing: none
    synchronizer: none
    seal: { type: constant, value: 0.1 Nm }
grids:
  few: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 8000 rpm] }
analyses:
  band:
    type: uncertainty
    grid: few
    model_sets: [seals]
    samples: 1024
    inputs:
      - { path: seals.*.model.value, percent: 10 }
      - { path: lubricants.sump.viscosity.kv100, plus_minus: 0.5 mm2/s, distribution: normal }
  wrong: { type: uncertainty, grid: few, model_sets: [seals], inputs: [{ path: seals.*.model.valeu, percent: 10 }] }
  unstated: { type: uncertainty, grid: few, model_sets: [seals], inputs: [{ path: seals.*.model.value }] }
  nothing: { type: uncertainty, grid: few, model_sets: [seals], inputs: [{ path: seals.*.model.value, from: 0.1 Nm, to: 0.1 Nm }] }
";
    let (results, text) = run(study, &[]);
    let band = results.json("band")["bands"][0].clone();
    for point in points(&band) {
        let nominal = number(&point["loss_w"]["nominal"]);
        let ends: Vec<f64> = point["loss_w"]["band"].as_array().unwrap().iter().map(number).collect();
        // Needle cages keep models of their own, so some 0.4 % of the loss do not change.
        for (end, share) in ends.iter().zip([0.905, 1.0, 1.095]) {
            assert_close(*end, share * nominal, 1e-3);
        }
    }
    let inputs = band["inputs"].as_array().unwrap();
    assert_close(number(&inputs[0]["correlation_with_mean_loss"]), 1.0, 1e-5);
    assert!(number(&inputs[1]["correlation_with_mean_loss"]).abs() < 0.05);
    for words in [
        "valeu",
        "one of `plus_minus`, `percent`",
        "two finite ends in ascending order",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// Points made by one combination are predicted best by it; the spread of a tournament has the extremes of its combinations.
#[test]
fn a_tournament_finds_the_models_that_made_the_data() {
    let made = "  truth:
    extends: joint
    bearing: { type: schaeffler }
    gear_drag: { churning: { type: diab } }
grids:
  rig: { gear: first, torque: [5 Nm, 10 Nm, 15 Nm, 20 Nm], speed: { from: 2000 rpm, to: 20000 rpm, step: 6000 rpm } }
analyses:
  truth: { type: map, grid: rig, model_sets: [truth] }
";
    let (results, _) = run(made, &[]);
    let truth = results.json("truth");
    let mut rig = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for p in points(&truth["maps"][0]) {
        rig.push_str(&format!("{},{},{},1\n", p["torque_nm"], p["speed_rpm"], p["loss_w"]));
    }
    let study = "grids:
  rig: { gear: first, torque: [5 Nm, 10 Nm, 15 Nm, 20 Nm], speed: { from: 2000 rpm, to: 20000 rpm, step: 6000 rpm } }
analyses:
  which:
    type: tournament
    model_set: joint
    data: { file: rig.csv }
    quantity: loss
    mechanisms:
      - { mechanism: bearing, models: { skf: { type: skf }, schaeffler: { type: schaeffler }, iso: { type: iso14179_2 } } }
      - { mechanism: gear_drag, slot: churning, models: { diab: { type: diab }, mauz: { type: mauz }, changenet: { type: changenet_2011 } } }
  fitted:
    type: tournament
    model_set: joint
    data: { file: rig.csv }
    quantity: loss
    factors: { least: 0.5, greatest: 2 }
    mechanisms: [{ mechanism: bearing, models: { schaeffler: { type: schaeffler } } }, { mechanism: gear_mesh }, { mechanism: gear_drag, models: { diab: { type: diab } } }]
  spread: { type: tournament, model_set: joint, grid: rig, mechanisms: [{ mechanism: bearing }, { mechanism: seal }] }
  wrong: { type: tournament, model_set: joint, grid: rig, mechanisms: [{ mechanism: bearings }] }
  twice: { type: tournament, model_set: joint, grid: rig, mechanisms: [{ mechanism: bearing }, { mechanism: bearing }] }
";
    let (results, text) = run(study, &[("rig.csv", &rig)]);
    let which = results.json("which")["tournament"].clone();
    let best = &which["ranking"][0];
    assert_eq!(best["models"], serde_json::json!(["schaeffler", "diab"]), "{text}");
    // Losses are added at the torques of the set, so a small difference is left.
    assert!(number(&best["predicted_rms"]) < 0.5, "{best}");
    for words in [
        "omitted: gear_mesh path_integral/mixed: its tooth_friction needs a further model",
        "omitted: gear_mesh tabulated: it needs another gear_mesh",
        "omitted: gear_mesh ohlendorf/schlenk: same loss as `iso14179_2` at every point",
        "which: best: schaeffler, diab, without fitted factors",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    // Whoever takes a law of friction takes part once with each.
    let fitted = results.json("fitted")["tournament"].clone();
    let candidates = fitted["mechanisms"][1]["candidates"].as_array().unwrap();
    for name in ["path_integral/misharin", "ohlendorf/michaelis", "even_share/michaelis"] {
        assert!(candidates.iter().any(|c| c["name"] == name), "{name}");
    }
    let best = &fitted["ranking"][usize::try_from(fitted["winner"].as_u64().unwrap()).unwrap()];
    let weights: f64 = fitted["ranking"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|r| r["weight"].as_f64())
        .sum();
    assert_close(weights, 1.0, 1e-9);
    assert!(best["weight"].as_f64().is_some());
    for point in points(&fitted) {
        let [least, mean, greatest] = ["least_loss_w", "mean_loss_w", "greatest_loss_w"].map(|k| number(&point[k]));
        assert!(least <= mean + 1e-9 && mean <= greatest + 1e-9);
    }
    assert!(!results.csv("fitted-shortlist").is_empty() && results.draws("fitted-shortlist"));
    let ranked = fitted["ranking"]
        .as_array()
        .unwrap()
        .iter()
        .find(|r| r["models"][1] == "as in joint")
        .unwrap();
    for factor in ranked["factors"].as_array().unwrap() {
        assert!((number(factor) - 1.0).abs() < 0.03, "{ranked}");
    }
    let spread = results.json("spread")["tournament"].clone();
    for point in points(&spread) {
        let [least, mean, greatest] = ["least_loss_w", "mean_loss_w", "greatest_loss_w"].map(|k| number(&point[k]));
        assert!(least <= mean && mean <= greatest);
    }
    let shares: f64 = spread["shares_of_spread"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| number(&s["share"]))
        .sum();
    assert_close(shares, 1.0, 1e-12);
    for words in ["`bearings` is not a mechanism", "`bearing` is listed twice"] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// Loss, loss torque and efficiency are one measurement: the ranking is the same whichever of them the file and the study name, without
/// torque too, where there is no efficiency.
#[test]
fn a_tournament_is_the_same_for_every_quantity() {
    let grid = "grids:
  rig: { gear: first, torque: [0 Nm, 5 Nm, 10 Nm, 20 Nm], speed: { from: 2000 rpm, to: 20000 rpm, step: 6000 rpm } }
analyses:
  truth: { type: map, grid: rig, model_sets: [joint] }
";
    let (results, _) = run(grid, &[]);
    let mut files = [
        "loss [W],loss_accuracy [W]",
        "loss_torque [Nm],loss_torque_accuracy [Nm]",
        "efficiency [%],efficiency_accuracy [%]",
    ]
    .map(|columns| format!("torque [Nm],speed [rpm],{columns}\n"));
    let mut bare = "torque [Nm],speed [rpm],loss [W]\n".to_owned();
    for (i, p) in points(&results.json("truth")["maps"][0]).iter().enumerate() {
        let [torque, speed, loss] = ["torque_nm", "speed_rpm", "loss_w"].map(|k| number(&p[k]));
        // Seven percent more or less, so that no combination meets the points.
        let loss = loss * [1.07, 0.95, 1.02, 0.97][i % 4];
        let omega = speed * std::f64::consts::PI / 30.0;
        let accuracy = 0.03 * loss + 2.0;
        bare.push_str(&format!("{torque},{speed},{loss}\n"));
        if torque > 0.0 {
            let power = torque * omega;
            let values = [
                [loss, accuracy],
                [loss / omega, accuracy / omega],
                [100.0 * (1.0 - loss / power), 100.0 * accuracy / power],
            ];
            for (file, [value, accuracy]) in files.iter_mut().zip(values) {
                file.push_str(&format!("{torque},{speed},{value},{accuracy}\n"));
            }
        }
    }
    let mechanisms = "mechanisms: [{ mechanism: bearing }, { mechanism: seal }]";
    let mut study = "analyses:\n".to_owned();
    for quantity in ["loss", "loss_torque", "efficiency"] {
        for file in ["loss", "loss_torque", "efficiency", "bare"] {
            study.push_str(&format!(
                "  {quantity}_of_{file}: {{ type: tournament, model_set: joint, data: {{ file: {file}.csv }}, quantity: {quantity}, {mechanisms} }}\n"
            ));
        }
    }
    study.push_str(&format!(
        "  stated: {{ type: tournament, model_set: joint, data: {{ file: bare.csv }}, correlation: 0.5, errors: {{ percent: 3, absolute: 2 W }}, {mechanisms} }}\n"
    ));
    study.push_str(&format!(
        "  zero: {{ type: tournament, model_set: joint, data: {{ file: bare.csv }}, errors: {{ percent: 0 }}, {mechanisms} }}\n"
    ));
    study.push_str(&format!(
        "  spread: {{ type: tournament, model_set: joint, grid: rig, correlation: 0.5, {mechanisms} }}\n"
    ));
    study.push_str("grids: { rig: { gear: first, torque: [5 Nm], speed: [2000 rpm] } }\n");
    let [loss, torque, efficiency] = &files;
    let files = [
        ("loss.csv", loss.as_str()),
        ("loss_torque.csv", torque),
        ("efficiency.csv", efficiency),
        ("bare.csv", &bare),
    ];
    let (results, text) = run(&study, &files);
    let order = |name: &str| {
        let ranking = results.json(name)["tournament"].clone();
        let list = ranking["ranking"]
            .as_array()
            .unwrap()
            .iter()
            .map(|r| (r["models"].clone(), number(&r["predicted_over_accuracy"])));
        (list.collect::<Vec<_>>(), ranking["winner"].as_u64().unwrap())
    };
    for file in ["loss", "bare"] {
        let (first, winner) = order(&format!("loss_of_{file}"));
        let others = if file == "bare" {
            vec!["bare"]
        } else {
            vec!["loss", "loss_torque", "efficiency"]
        };
        for quantity in ["loss", "loss_torque", "efficiency"] {
            for other in &others {
                let (found, place) = order(&format!("{quantity}_of_{other}"));
                assert_eq!(place, winner, "{quantity} of {other}");
                for ((a, x), (b, y)) in first.iter().zip(&found) {
                    assert_eq!(a, b, "{quantity} of {other}");
                    assert_close(*x, *y, 1e-6);
                }
            }
        }
    }
    let stated = results.json("stated")["tournament"].clone();
    assert_close(number(&stated["correlation"]), 0.5, 1e-12);
    for point in points(&stated) {
        let accuracy = (0.03 * number(&point["measured_loss_w"])).hypot(2.0);
        assert_close(number(&point["loss_accuracy_w"]), accuracy, 1e-9);
        assert_eq!(point["accuracy"].is_null(), number(&point["torque_nm"]) == 0.0);
    }
    for words in [
        "16 of 16 points have no accuracy in the file: 5 % of the loss",
        "16 of 16 points have no accuracy in the file: 3 % of the loss and 2 W, standard deviations, added as squares, stated under `errors`",
        "4 points have no efficiency: they are ranked by their loss",
        "accuracies of losses must be positive, and at least one must be stated",
        "`factors`, `gear`, `errors` and `correlation` belong to `data`",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// Sets of an identification stand side by side in one table, with a decision and a sentence; files hold the same.
#[test]
fn sets_of_an_identification_are_compared() {
    let sets = "  bare:
    extends: joint
    gear_mesh: { type: iso14179_2 }
    seal: none
";
    let grid = "grids:
  rig: { gear: first, torque: [4 Nm, 8 Nm, 12 Nm, 16 Nm, 20 Nm], speed: [3000 rpm, 8000 rpm, 16000 rpm] }
";
    let truth = format!("{sets}{grid}analyses:\n  truth: {{ type: map, grid: rig, model_sets: [joint] }}\n");
    let (results, _) = run(&truth, &[]);
    let mut rig = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for (i, p) in points(&results.json("truth")["maps"][0]).iter().enumerate() {
        let [torque, speed, loss] = ["torque_nm", "speed_rpm", "loss_w"].map(|k| number(&p[k]));
        let accuracy = 0.01 * loss;
        let noise = [0.8, -1.1, 0.3, -0.4, 1.2, -0.9, 0.5][i % 7];
        rig.push_str(&format!("{torque},{speed},{},{accuracy}\n", loss + noise * accuracy));
    }
    let study = format!(
        "{sets}analyses:
  both:
    type: identify
    data: {{ file: rig.csv }}
    residuals: [loss]
    model_sets: [bare, joint]
    profiles: false
    parameters: {{ level: {{ path: housing.oil.level_offset, from: -5 mm, to: 5 mm }} }}
"
    );
    let (results, text) = run(&study, &[("rig.csv", &rig)]);
    let result = results.json("both");
    let compared = &result["comparison_of_sets"];
    let names: Vec<&str> = compared["sets"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["model_set"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["joint", "bare"], "{text}");
    let against = &compared["sets"][1]["first_against_it"];
    assert_eq!(
        (against["decision"].as_str(), against["reason"].as_str()),
        (Some("better"), Some("folds")),
        "{text}"
    );
    assert_eq!(number(&against["folds"]["won"]), 5.0);
    let sentence = compared["sentence"].as_str().unwrap();
    assert!(
        sentence.starts_with("`joint` predicts left-out points better than `bare`"),
        "{sentence}"
    );
    assert!(
        text.contains("both: comparison of the model sets") && text.contains(sentence),
        "{text}"
    );
    let csv = results.csv("both-sets");
    assert!(csv.lines().count() == 3 && csv.contains("better"), "{csv}");
    // An accuracy in percent is another number of watts for each set; they are compared over what they have in common.
    let rows = rig
        .lines()
        .filter_map(|line| Some(format!("{}\n", line.rsplit_once(',')?.0)));
    let in_percent = "{ file: rig.csv, accuracies: { loss: { percent_of_reading: 1 } }, stated_as: standard }";
    let study = study.replace("{ file: rig.csv }", in_percent);
    let (results, text) = run(&study, &[("rig.csv", &rows.collect::<String>())]);
    let against = &results.json("both")["comparison_of_sets"]["sets"][1]["first_against_it"];
    assert_eq!(against["decision"].as_str(), Some("better"), "{text}");
}

#[test]
fn two_paths_are_swept_as_a_map() {
    let study = "analyses:
  two:
    type: sweep
    model_sets: [joint]
    path: lubricants.sump.viscosity.kv100
    values: [4 mm2/s, 6 mm2/s, 8 mm2/s]
    second: { path: housing.oil.level_offset, values: [-5 mm, 0 mm] }
    torque: 10 Nm
    speed: 8000 rpm
";
    let (results, text) = run(study, &[]);
    let sweep = results.json("two")["sweep"].clone();
    assert_eq!(sweep.as_array().unwrap().len(), 6, "{text}");
    assert_eq!(sweep[3]["second"]["value"], "0 mm");
    let csv = results.csv("two");
    assert!(csv.starts_with("model_set,gear,lubricants.sump.viscosity.kv100,housing.oil.level_offset,"));
}

/// Ctrl-C keeps the analyses that are finished, writes the report of them, and ends with 130.
#[cfg(unix)]
#[test]
fn an_interruption_keeps_what_is_finished() {
    let study = format!(
        "{PLAIN}analyses:
  quick: {{ type: map, grid: few, model_sets: [joint] }}
  long: {{ type: uncertainty, grid: few, model_sets: [joint], samples: 65536, inputs: [{{ path: lubricants.sump.viscosity.kv100, percent: 10 }}] }}
"
    );
    let folder = written("interrupted", &study, &[]);
    let child = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(folder.join("study.yaml"))
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let quick = folder.join("results/quick.json");
    // Each try is short; a machine under load gets many.
    for _ in 0..6000 {
        if quick.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(quick.exists());
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("1 of 2 analyses are finished and kept"), "{text}");
    let report = std::fs::read_to_string(folder.join("results/report.html")).unwrap();
    assert!(report.contains("id=\"analysis-quick\"") && !report.contains("id=\"analysis-long\""));
}

/// Points of a map as a file of measured losses.
fn measured(map: &Value) -> String {
    let mut text = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for point in points(&map["maps"][0]) {
        let [torque, speed, loss] = ["torque_nm", "speed_rpm", "loss_w"].map(|key| number(&point[key]));
        text.push_str(&format!("{torque},{speed},{loss},{}\n", 0.01 * loss));
    }
    text
}

/// Parameters stated once serve several analyses; what is found is a set of models for those that come later; a set holds values.
#[test]
fn what_is_found_serves_later_analyses() {
    let truth = "model_sets:
  joint:
    gear_mesh: { type: path_integral, load_sharing: rigid, tooth_friction: { type: xu } }
    bearing: { type: skf }
    seal: none
    synchronizer: none
  thick: { extends: joint, set: { lubricants.sump.viscosity.factor: 1.3 } }
";
    let made = format!("{PLAIN}analyses: {{ map: {{ type: map, grid: few, model_sets: [thick], write: [json] }} }}\n");
    let (results, text) = run_texts(&study_of(truth, &made), &[]).with_text();
    let rig = measured(&results.json("map"));
    assert!(!rig.is_empty(), "{text}");
    let study = format!(
        "parameters:
  viscosity: {{ path: lubricants.sump.viscosity.factor, from: 0.5, to: 2, scale: log }}
{PLAIN}measurements: {{ rig: {{ file: rig.csv }} }}
analyses:
  found:
    type: identify
    data: rig
    model_sets: [joint]
    residuals: [loss]
    parameters: [viscosity]
    starts: 1
    folds: 0
    posterior: {{ steps: 300, walkers: 8 }}
    then: fitted
    write: [csv, json]
  gap: {{ type: compare, data: rig, against: [joint, fitted], quantity: loss, write: [json] }}
  band: {{ type: uncertainty, grid: few, model_sets: [joint], inputs: [viscosity], samples: 8, write: [json] }}
"
    );
    let (results, text) = run_texts(&study_of(truth, &study), &[("rig.csv", &rig)]).with_text();
    let found = &results.json("found")["identifications"][0];
    let fitted = number(&found["parameters"][0]["value"]);
    assert_close(fitted, 1.3, 1e-4);
    // The misfit is zero there, so the accuracies alone make the posterior: the linearised interval but for its curvature.
    let posterior = &found["posterior"]["parameters"][0];
    let interval = [0, 1].map(|end| number(&posterior["interval"][end]));
    assert!(interval[0] < 1.3 && 1.3 < interval[1], "{posterior}");
    let linear = [0, 1].map(|end| number(&found["parameters"][0]["interval"][end]));
    let [drawn, linear] = [interval, linear].map(|ends| ends[1] - ends[0]);
    assert_close(drawn, linear, 0.2);
    let gap = results.json("gap");
    let rms = |set: usize| number(&gap["comparisons"][set]["difference"]["rms"]);
    assert!(rms(1) < 1e-3 * rms(0), "{text}");
    assert!(results.json("band").is_object(), "{text}");
    assert!(!results.csv("found-posterior").is_empty(), "{text}");
}

/// What finds no values leaves nothing to later analyses, and says so.
#[test]
fn an_analysis_without_the_values_it_waits_for_fails() {
    let study = format!(
        "{PLAIN}measurements: {{ rig: {{ file: rig.csv }} }}
analyses:
  found: {{ type: identify, data: rig, model_sets: [joint], parameters: {{ x: {{ path: \"meshes.*.loss_factor\", from: 0.5, to: 2 }} }}, robust: {{ loss: huber }}, posterior: {{}}, then: fitted }}
  map: {{ type: map, grid: few, model_sets: [fitted] }}
"
    );
    let rig = "torque [Nm],speed [rpm],loss [W]\n5,2000,10\n10,2000,20\n20,2000,30\n";
    let (_, text) = run(&study, &[("rig.csv", rig)]);
    assert!(
        text.contains("a robust loss does not define a posterior density"),
        "{text}"
    );
    assert!(
        text.contains("the model set `fitted` has no values, because the analysis `found` produced none"),
        "{text}"
    );
    let folder = written("waits", &study, &[("rig.csv", rig)]);
    let shard = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(["run", "--shard", "1/2"])
        .arg(folder.join("study.yaml"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&shard.stderr);
    // What waits for values of another analysis is left to the merge.
    assert!(
        shard.status.success()
            && text.contains("a robust loss does not define a posterior density")
            && !text.contains("has no values"),
        "{text}"
    );
}
