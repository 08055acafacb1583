//! Identification: what went into made-up points comes out of them, and what cannot be identified is told with its place.

use std::fmt::Write as _;

use crate::common::rig::{SEED, TRUTH};
use crate::common::study::{Ran, of_gearbox, run_texts};
use crate::common::{self, RPM, language};
use gearloss_framework::evaluate::Point;
use gearloss_framework::resolve::Choice;
use gearloss_numerics::inference::Standing;
use gearloss_numerics::inference::probability::chi_square_quantile;
use gearloss_numerics::least_squares::Loss;
use gearloss_studies::identify::Settings;
use serde_json::{Value, json};

/// Runs a study with files beside it; its results and what it prints.
fn run(study: &str, files: &[(&str, &str)]) -> (Ran, String) {
    run_texts(study, files).with_text()
}

/// A study of the two-speed example under its own models at 80 degC.
fn study(analyses: &str) -> String {
    let rest = format!("conditions: {{ oil_temperature: 80 degC }}\n{analyses}");
    of_gearbox("examples/two-speed-ev/gearbox.yaml", &rest)
}

fn first(results: &Ran, name: &str) -> Value {
    results.json(name)["identifications"][0].clone()
}

/// Points of the example under its own models and further overrides: torque in Nm, speed in rpm, loss in W, torque and speed at
/// the output.
fn points(overrides: &[(&str, Value)], torques: &[f64], speeds: &[f64]) -> Vec<[f64; 5]> {
    let language = language();
    let gearbox = common::rig::gearbox(&language);
    let overrides = overrides
        .iter()
        .map(|(path, value)| ((*path).to_owned(), value.clone()));
    let choice = Choice {
        overrides: overrides.collect(),
        ..Choice::default()
    };
    let t = gearbox
        .transmission(&language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let case = t.case("first", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let out = t.port("output").unwrap();
    let mut all = Vec::new();
    for torque in torques {
        for speed in speeds {
            let point = Point {
                speeds: &[speed * RPM],
                torques: &[*torque],
                ..Point::default()
            };
            let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
            let turning = solution.speed(t.ports()[out].member) / RPM;
            all.push([*torque, *speed, solution.loss().unwrap(), solution.torque(out), turning]);
        }
    }
    all
}

const TORQUES: [f64; 6] = [2.0, 5.0, 8.0, 12.0, 16.0, 20.0];
const SPEEDS: [f64; 6] = [1000.0, 4000.0, 8000.0, 12000.0, 17000.0, 22000.0];

fn losses(points: &[[f64; 5]], accuracy: f64) -> String {
    let mut csv = "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n".to_owned();
    for [torque, speed, loss, ..] in points {
        let _ = writeln!(csv, "{torque},{speed},{loss},{accuracy}");
    }
    csv
}

/// Ends of a search lie within a thousandth of a standard error of the optimum, which is exact where there is no noise.
fn near(found: &Value, name: &str, expected: f64) {
    let all = found["parameters"].as_array().unwrap();
    let parameter = all.iter().find(|p| p["name"] == name).unwrap();
    let x = parameter["value"].as_f64().unwrap();
    let [low, high] = [0, 1].map(|i| parameter["interval"][i].as_f64().unwrap_or(x));
    let room = 0.01 * (high - low) + 1e-6 * expected.abs();
    assert!(
        (x - expected).abs() <= room,
        "{name}: {x} instead of {expected}\n{parameter}"
    );
}

#[test]
fn the_example_finds_its_hidden_parameters() {
    let language = language();
    let (gearbox, study) = (common::rig::gearbox(&language), common::rig::study(&language));
    let file = std::fs::read(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    let measured = common::rig::entry(&study).read(&file, &[]).unwrap();
    assert!(String::from_utf8_lossy(&file).contains(&format!("seed {SEED}")));
    let mut identification = common::rig::identification(&language, &gearbox, &study, &measured);
    let fitted = identification.fit(&Settings::default()).unwrap();
    assert!(fitted.fit().converged());
    let inference = &fitted.inference;
    assert!(inference.parameters().iter().all(|p| p.standing == Standing::Free));
    // The hidden parameters together lie in the 99 % region, by the sum of squares itself.
    let hidden: Vec<f64> = TRUTH.iter().map(|(_, truth)| *truth).collect();
    let squares: f64 = identification.residuals(&hidden).unwrap().iter().map(|r| r * r).sum();
    let rise = squares - inference.objective();
    let limit = chi_square_quantile(0.99, 8.0).unwrap();
    assert!(rise > 0.0 && rise < limit, "{rise} {limit}");
    // The measurement is as accurate as the study says.
    let lack = inference.lack_of_fit().unwrap();
    assert!((0.01..0.99).contains(&lack.probability), "{}", lack.probability);
    for (k, (name, _)) in TRUTH.iter().enumerate() {
        let interval = inference.interval(k, 0.9999, 1.0).unwrap();
        assert!(
            (interval.uncut[0]..=interval.uncut[1]).contains(&hidden[k]),
            "{name}: {interval:?}"
        );
    }
}

#[test]
fn what_went_in_without_noise_comes_out() {
    let overrides = [
        ("lubricants.sump.viscosity.factor", json!(0.8)),
        (
            "bearings.*.radial_factor",
            json!({ "port": "input", "torques": [2, 20], "factors": [1.3, 0.8] }),
        ),
        ("meshes.M1.loss_factor", json!(1.2)),
    ];
    let csv = losses(&points(&overrides, &TORQUES, &SPEEDS), 1.0);
    let study = study(
        "analyses:
  all:
    type: identify
    data: { file: rig.csv, stated_as: standard }
    residuals: [loss]
    parameters:
      viscosity: { path: lubricants.sump.viscosity.factor, from: 0.3, to: 3, scale: log }
      loads: { path: \"bearings.*.radial_factor\", from: 0.3, to: 3, over: { port: input, torques: [2 Nm, 20 Nm] } }
      mesh: { path: meshes.M1.loss_factor, from: 0.5, to: 2 }
",
    );
    let (results, text) = run(&study, &[("rig.csv", &csv)]);
    let found = first(&results, "all");
    assert_eq!(found["search"]["status"], "converged", "{text}");
    near(&found, "viscosity", 0.8);
    near(&found, "loads at 2 Nm", 1.3);
    near(&found, "loads at 20 Nm", 0.8);
    near(&found, "mesh", 1.2);
    assert!(found["misfit"]["quantities"][0]["rms"].as_f64().unwrap() < 0.01);
    // The values go back into a study as they were written.
    let values = results.file("all-own.yaml");
    let set = values.split("conditions:\n").nth(1).unwrap().split('#').next().unwrap();
    let head = "conditions: { oil_temperature: 80 degC }\n";
    let again = study.replace(head, &format!("conditions:\n  oil_temperature: 80 degC\n{set}"));
    let (results, text) = run(&again, &[("rig.csv", &csv)]);
    let before = first(&results, "all")["misfit"]["quantities"][0]["rms_before"].as_f64();
    assert!(before.unwrap_or_else(|| panic!("{text}")) < 0.01, "{before:?}\n{again}");
}

#[test]
fn offsets_and_bearings_of_the_rig_are_found_at_either_port() {
    // The meters show 0.05 and -0.4 Nm too much; the rig's bearings brake by 0.02 Nm at 1000 rpm, with the speed.
    let mut csv = "torque [Nm],speed [rpm],torque_out [Nm],speed_out [rpm]\n".to_owned();
    let mut back = csv.clone();
    for [torque, speed, _, out, turning] in points(&[], &TORQUES, &SPEEDS) {
        let shown = torque + 0.05 + 0.02 * speed / 1000.0;
        let there = out.abs() - 0.4;
        let _ = writeln!(csv, "{shown},{speed},{there},{}", turning.abs());
        // The same with the torque given at the output, signed as applied to the transmission there.
        let given = out + 0.4 * turning.signum() * speed.signum();
        let _ = writeln!(back, "{given},{turning},{shown},{speed}");
    }
    let data = "stated_as: standard, rig: { support_in: { torque: 0.01 Nm, speed: 1000 rpm, exponent: 1 }, torque_in: { absolute: 0.01 Nm }, torque_out: { absolute: 0.1 Nm } }";
    let parameters = "{ offset_in: { path: rig.torque_offset_in, from: -0.2 Nm, to: 0.2 Nm }, offset_out: { path: rig.torque_offset_out, from: -1 Nm, to: 1 Nm, prior: { mean: -0.4 Nm, deviation: 0.001 Nm } }, support: { path: rig.support_in.torque, from: 0 Nm, to: 0.1 Nm } }";
    let analyses = format!(
        "analyses:\n  there: {{ type: identify, data: {{ file: rig.csv, {data} }}, residuals: [loss], folds: 0, profiles: false, parameters: {parameters} }}\n"
    );
    let (results, text) = run(&study(&analyses), &[("rig.csv", &csv)]);
    let found = first(&results, "there");
    for (name, expected) in [("offset_in", 0.05), ("offset_out", -0.4), ("support", 0.02)] {
        near(&found, name, expected);
    }
    assert!(
        found["misfit"]["quantities"][0]["rms"].as_f64().unwrap() < 0.05,
        "{text}"
    );
    let conditions = "conditions: { oil_temperature: 80 degC, torque_at: output, speed_at: output }";
    let other = study(&analyses).replace("conditions: { oil_temperature: 80 degC }", conditions);
    let (results, text) = run(&other, &[("rig.csv", &back)]);
    let found = first(&results, "there");
    for (name, expected) in [("offset_in", 0.05), ("offset_out", -0.4), ("support", 0.02)] {
        near(&found, name, expected);
    }
    assert!(
        found["misfit"]["quantities"][0]["rms"].as_f64().unwrap() < 0.05,
        "{text}"
    );
}

#[test]
fn a_known_rig_is_taken_out_of_a_comparison() {
    let mut csv = "torque [Nm],speed [rpm],torque_out [Nm],speed_out [rpm]\n".to_owned();
    for [torque, speed, _, out, turning] in points(&[], &TORQUES, &SPEEDS) {
        let _ = writeln!(
            csv,
            "{},{speed},{},{}",
            torque + 0.05 + 0.02,
            out.abs() - 0.4,
            turning.abs()
        );
    }
    let data = "data: { file: rig.csv, rig: { torque_offset_in: 0.05 Nm, torque_offset_out: -0.4 Nm, support_in: { torque: 0.02 Nm } } }";
    let analyses = format!("analyses:\n  seen: {{ type: compare, against: [ours/own], quantity: loss, {data} }}\n");
    let (results, _) = run(&study(&analyses), &[("rig.csv", &csv)]);
    let value = results.json("seen");
    let rms = value["comparisons"][0]["difference"]["rms"].as_f64().unwrap();
    // Nothing is left but rounding of the flow, a billionth of the power.
    assert!(rms < 1e-4, "{rms}");
}

#[test]
fn temperatures_are_fitted_where_the_model_finds_its_own() {
    let gearbox = common::file("examples/planetary-reducer/gearbox.yaml");
    let head = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {} }}\nconditions: {{ set: {{ thermal.heat_dissipation.casing.alpha: 20 W/(m2 K) }} }}\n",
        gearbox.display()
    );
    let grid = "grids: { g: { gear: reducing, torque: [2 Nm, 3 Nm], speed: [1000 rpm, 2000 rpm, 3000 rpm] } }\nanalyses:\n  map: { type: map, grid: g }\n";
    let (results, text) = run(&(head.clone() + grid), &[]);
    let map = results.json("map");
    let mut csv =
        "torque [Nm],speed [rpm],oil_temperature [degC],oil_temperature_accuracy [K],loss [W],loss_accuracy [W]\n"
            .to_owned();
    for p in map["maps"][0]["points"].as_array().expect(&text) {
        let number = |key: &str| p[key].as_f64().unwrap();
        let _ = writeln!(
            csv,
            "{},{},{},1,{},2",
            number("torque_nm"),
            number("speed_rpm"),
            number("oil_temperature_degc"),
            number("loss_w")
        );
    }
    let analysis = "analyses:
  warm:
    type: identify
    gear: reducing
    data: { file: rig.csv, stated_as: standard }
    residuals: [temperature, loss]
    parameters:
      alpha: { path: thermal.heat_dissipation.casing.alpha, from: 5 W/(m2 K), to: 60 W/(m2 K), scale: log }
      viscosity: { path: \"lubricants.*.viscosity.factor\", from: 0.3, to: 3, scale: log }
";
    let head = head.replace("alpha: 20 W", "alpha: 35 W");
    let (results, text) = run(&(head + analysis), &[("rig.csv", &csv)]);
    let found = first(&results, "warm");
    assert_eq!(found["search"]["status"], "converged", "{text}");
    near(&found, "alpha", 20.0);
    near(&found, "viscosity", 1.0);
    assert_eq!(found["misfit"]["quantities"].as_array().unwrap().len(), 2);
}

#[test]
fn factors_of_accuracies_are_found_and_outliers_pull_less() {
    let language = language();
    let (gearbox, study) = (common::rig::gearbox(&language), common::rig::study(&language));
    let text = std::fs::read_to_string(common::file("examples/two-speed-ev/rig.csv")).unwrap();
    // Every ninth efficiency is off by five standard deviations or more.
    let mut spoilt = String::new();
    for (i, line) in text.lines().enumerate() {
        let mut cells: Vec<String> = line.split(';').map(str::to_owned).collect();
        if i > 12 && i % 9 == 0 {
            let eta: f64 = cells[5].replace(',', ".").parse().unwrap();
            cells[5] = format!("{:.4}", eta - 6.0).replace('.', ",");
        }
        spoilt += &(cells.join(";") + "\n");
    }
    let fit = |text: &str, settings: Settings<'_>| {
        let measured = common::rig::entry(&study).read(text.as_bytes(), &[]).unwrap();
        let mut identification = common::rig::identification(&language, &gearbox, &study, &measured);
        identification.fit(&settings).unwrap()
    };
    let sound = fit(&text, Settings::default());
    let distance = |theta: &[f64]| -> f64 {
        let part = |k: usize| {
            let parameter = &sound.inference.parameters()[k];
            let u = parameter.scale.coordinate(theta[k]).unwrap();
            (u - parameter.u) / sound.inference.deviation(k).unwrap()
        };
        (0..8).map(|k| part(k).powi(2)).sum::<f64>().sqrt()
    };
    let pulled = fit(&spoilt, Settings::default());
    let robust = fit(
        &spoilt,
        Settings {
            loss: Loss::Cauchy,
            ..Settings::default()
        },
    );
    assert!(
        distance(robust.theta()) < 0.2 * distance(pulled.theta()),
        "{} {}",
        distance(robust.theta()),
        distance(pulled.theta())
    );
    assert!(robust.inference.lack_of_fit().is_none() && pulled.inference.lack_of_fit().unwrap().probability < 1e-6);
    // The same file with accuracies that are stated half as great as they are.
    let mut half = common::rig::study(&language);
    let rig = &mut half.measurements.0[0].1.rig;
    for meter in [rig.torque_in.as_mut().unwrap(), rig.torque_out.as_mut().unwrap()] {
        meter.percent_of_full_scale *= 0.5;
    }
    let measured = common::rig::entry(&half).read(text.as_bytes(), &[]).unwrap();
    let mut identification = common::rig::identification(&language, &gearbox, &half, &measured);
    let settings = Settings {
        accuracy_factors: true,
        ..Settings::default()
    };
    let settled = identification.fit(&settings).unwrap();
    let variance = sound.inference.objective() / sound.inference.freedom();
    let (_, factor) = settled.factors[0];
    // Two, times the scatter of this file; it is settled to one percent.
    assert!(
        (factor / (2.0 * variance.sqrt()) - 1.0).abs() < 0.01,
        "{factor} {variance}"
    );
}

#[test]
fn the_same_bits_on_one_thread_and_on_two() {
    let csv = losses(
        &points(&[("lubricants.sump.viscosity.factor", json!(0.8))], &TORQUES, &SPEEDS),
        1.0,
    );
    let study = study(
        "grids: { g: { gear: first, torque: [5 Nm, 10 Nm], speed: [4000 rpm, 8000 rpm] } }
analyses:
  all:
    type: identify
    data: { file: rig.csv }
    residuals: [loss]
    starts: 3
    next: { grid: g, points: 2 }
    parameters:
      viscosity: { path: lubricants.sump.viscosity.factor, from: 0.3, to: 3, scale: log }
      mesh: { path: \"meshes.*.loss_factor\", from: 0.5, to: 2 }
",
    );
    let all = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run_texts(&study, &[("rig.csv", &csv)]).json("all"))
    });
    assert_eq!(all[0], all[1]);
}

#[test]
fn what_the_points_do_not_see_is_reported_and_the_rest_is_found() {
    let csv = losses(&points(&[("meshes.*.loss_factor", json!(1.2))], &TORQUES, &SPEEDS), 1.0);
    let study = study(
        "analyses:
  all:
    type: identify
    data: { file: rig.csv, stated_as: standard }
    residuals: [loss]
    parameters:
      mesh: { path: \"meshes.*.loss_factor\", from: 0.5, to: 2 }
      idle: { path: couplings.S1.loss_factor, from: 0.5, to: 2 }
      held: { path: \"seals.*.loss_factor\", from: 1, to: 1 }
",
    );
    let (results, text) = run(&study, &[("rig.csv", &csv)]);
    let found = first(&results, "all");
    near(&found, "mesh", 1.2);
    assert_eq!(
        (&found["parameters"][1]["verdict"], &found["parameters"][2]["verdict"]),
        (&json!("not_seen"), &json!("held")),
        "{text}"
    );
    assert!(
        text.contains("`idle` has no effect") && text.contains("`held` is fixed"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_identified_is_reported_with_its_place_and_how_to_fix_it() {
    let csv = losses(&points(&[], &[5.0, 10.0], &[4000.0, 8000.0]), 1.0);
    let mesh = "mesh: { path: \"meshes.*.loss_factor\", from: 0.5, to: 2 }";
    let bare = "torque [Nm],speed [rpm],loss [W],loss_torque [Nm]\n5,4000,90,0.21\n10,4000,130,0.31\n5,8000,220,0.26\n";
    for (parameters, more, file, place, said) in [
        (
            "x: { path: meshes.M9.loss_factor, from: 0, to: 1 }",
            "",
            csv.as_str(),
            "parameters.x.path",
            "M9",
        ),
        (
            "x: { path: rig.torque_offset, from: 0, to: 1 }",
            "",
            &csv,
            "parameters.x.path",
            "rig.torque_offset_in",
        ),
        (
            "x: { path: gears.G1.shaft, from: 0, to: 1 }",
            "",
            &csv,
            "parameters.x.path",
            "is not a number",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 2, to: 1 }",
            "",
            &csv,
            "parameters.x.to",
            "the bounds are reversed",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: -1, to: 1 }",
            "",
            &csv,
            "parameters.x.from",
            "is outside the range of the path",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0, to: 1, scale: log }",
            "",
            &csv,
            "parameters.x.scale",
            "a positive lower bound",
        ),
        (
            "x: { path: rig.torque_offset_in }",
            "",
            &csv,
            "parameters.x.path",
            "add `from: ...`",
        ),
        (
            "x: { path: rig.torque_offset_in, from: 1 mm, to: 2 Nm }",
            "",
            &csv,
            "parameters.x.from",
            "help:",
        ),
        (
            "x: { path: lubricants.sump.mu_ehl, from: 0.03, to: 0.2 }",
            "",
            &csv,
            "parameters.x.path",
            "add `start: ...`",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2, prior: { deviation: 0 } }",
            "",
            &csv,
            "parameters.x.prior.deviation",
            "is not positive",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2, over: { port: input, torques: [1, 2] } }",
            "",
            &csv,
            "parameters.x.over",
            "is not a load factor",
        ),
        (
            "x: { path: \"bearings.*.radial_factor\", from: 0.5, to: 2, over: { port: input, torques: [2, 1] } }",
            "",
            &csv,
            "parameters.x.over.torques",
            "the torques are not ascending",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2 }, z: { path: \"meshes.*.loss_factor\", from: 0.5, to: 2 }",
            "",
            &csv,
            "parameters.z.path",
            "also changes `meshes.M1.loss_factor`",
        ),
        (
            mesh,
            "residuals: [temperature],",
            &csv,
            "data",
            "there is no measured oil temperature",
        ),
        (
            mesh,
            "residuals: [loss, loss_torque],",
            bare,
            "data",
            "needs their accuracies",
        ),
        (
            mesh,
            "",
            "torque [Nm],speed [rpm],loss [W]\n5,4000,90\n10,4000,NaN\n",
            "data",
            "line 3, column 3 `loss`: `NaN` is not a number",
        ),
        (
            mesh,
            "",
            "torque [Nm],speed [rpm],loss [W]\n5,4000,\n",
            "data",
            "line 2, column 3 `loss`: empty",
        ),
        (
            "a: { path: meshes.M1.loss_factor, from: 0.5, to: 2 }, b: { path: meshes.M2.loss_factor, from: 0.5, to: 2 }",
            "",
            "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n5,4000,90,2\n",
            "data",
            "1 measured values and 0 priors for 2 parameters",
        ),
        (mesh, "next: { grid: nowhere },", &csv, "next.grid", "nowhere"),
        (
            mesh,
            "accuracy_factors: true, robust: { loss: cauchy },",
            &csv,
            "accuracy_factors",
            "delete one of them",
        ),
        (
            mesh,
            "residuals: [efficiency],",
            "torque [Nm],speed [rpm],efficiency [-],efficiency_accuracy [-]\n5,4000,0.96,0.01\n0,4000,0.96,0.01\n",
            "data",
            "line 3: no calculated efficiency",
        ),
        (
            mesh,
            "",
            "torque [Nm],speed [rpm],loss [W],weight\n5,4000,90,0\n10,4000,130,0\n",
            "data",
            "all points have zero weight",
        ),
        (
            mesh,
            "accuracy_factors: true,",
            bare,
            "accuracy_factors",
            "`accuracy_factors` needs stated accuracies",
        ),
        (mesh, "folds: 1,", &csv, "folds", "write at least 2"),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2, start: 3 }",
            "",
            &csv,
            "parameters.x.start",
            "is outside",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2, prior: { deviation: 1 } }",
            "",
            bare,
            "parameters.x.prior",
            "needs accuracies",
        ),
        (mesh, "residuals: [loss, loss],", &csv, "residuals", "is listed twice"),
        (
            mesh,
            "residuals: [efficiency, loss],",
            &csv,
            "residuals",
            "has no column and is computed",
        ),
        (
            "x: { path: \"bearings.*.radial_factor\", from: 0.5, to: 2, over: { port: outptu, torques: [1, 2] } }",
            "",
            &csv,
            "parameters.x.over.port",
            "outptu",
        ),
        (
            "x: { path: meshes.M1.loss_factor, from: 0.5, to: 2, prior: { mean: 3, deviation: 1 } }",
            "",
            &csv,
            "parameters.x.prior",
            "is outside",
        ),
        (
            mesh,
            "",
            "torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n5,4000,90,2\n10,4000,130,0\n",
            "data",
            "line 3: an accuracy of zero",
        ),
    ] {
        let residuals = if more.contains("residuals") {
            ""
        } else {
            "residuals: [loss],"
        };
        let study = study(&format!(
            "analyses:\n  all: {{ type: identify, data: {{ file: rig.csv }}, {residuals} {more} parameters: {{ {parameters} }} }}\n"
        ));
        let (_, text) = run(&study, &[("rig.csv", file)]);
        assert!(
            text.contains(&format!("analyses.all.{place}"))
                && text.contains(said)
                && text.contains("help:")
                && text.contains("-->"),
            "{parameters} {more}: {place}: {said}\n{text}"
        );
    }
    let named = study(
        "analyses:\n  all: { type: identify, data: nowhere, parameters: { x: { path: meshes.M1.loss_factor } } }\n",
    );
    let (_, text) = run(&named, &[]);
    assert!(
        text.contains("analyses.all.data") && text.contains("no measurement"),
        "{text}"
    );
}

/// Means over cycles of the example with a thicker oil and less friction of the teeth: over all losses, of the teeth over all, and with half
/// the viscosity over the viscosity as it is.
const LOADS: &str = "cycles: { loads: { spectrum: [{ torque: 20 Nm, speed: 3000 rpm, share: 0.75 }, { torque: 60 Nm, speed: 2000 rpm, share: 0.25 }] } }";

fn means(values: [String; 3], parameters: &str) -> String {
    let [all, teeth, thin] = values;
    study(&format!(
        "{LOADS}
analyses:
  fit:
    type: identify
    gear: first
    means:
      all: {{ drive: {{ cycles: [loads] }}, {all}, accuracy: 0.1 W, source: made up }}
      teeth: {{ drive: {{ cycles: [loads] }}, mechanism: gear_mesh, relative_to: {{ mechanism: all }}, {teeth}, accuracy: 0.001 }}
      thin: {{ drive: {{ cycles: [loads] }}, set: {{ lubricants.sump.viscosity.kv100: 5 mm2/s }}, relative_to: {{ set: {{}} }}, {thin}, accuracy: 0.001 }}
    starts: 2
    parameters: {parameters}
"
    ))
}

/// The row of a mean in the text shows the numbers of its record with four digits.
fn shows(text: &str, record: &Value) {
    let name = record["name"].as_str().unwrap();
    let row = text.lines().find(|line| line.starts_with(name)).unwrap();
    let shown: Vec<f64> = row.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let end = if record["from"].is_null() { "to" } else { "from" };
    let keys = [end, "accuracy", "model_before", "model", "residual"];
    assert_eq!(shown.len(), keys.len(), "{row}");
    for (shown, key) in shown.iter().zip(keys) {
        let expected = record[key].as_f64().unwrap();
        assert!(
            (shown - expected).abs() <= 6e-4 * expected.abs(),
            "{key}: {row}\n{record}"
        );
    }
}

#[test]
fn means_of_cycles_find_what_was_hidden() {
    let truth = study(&format!(
        "{LOADS}
model_sets:
  hidden: {{ set: {{ bearings.*.loss_factor: 1.3, meshes.*.loss_factor: 0.9 }} }}
  thin: {{ extends: hidden, set: {{ lubricants.sump.viscosity.kv100: 5 mm2/s }} }}
analyses:
  truth: {{ type: cycle, cycles: [loads], gear: first, model_sets: [hidden, thin] }}
"
    ));
    let (truth, _) = run(&truth, &[]);
    let cycles = truth.json("truth")["cycles"].clone();
    let loss = |i: usize| cycles[i]["mean_loss_w"].as_f64().unwrap();
    let shares = cycles[0]["shares"].as_array().unwrap();
    let place = shares.iter().position(|share| share == "gear_mesh").unwrap();
    let teeth = cycles[0]["mean_losses_w"][place].as_f64().unwrap();
    let value = |x: f64| format!("value: {x}");
    let parameters = "{ bearings: { path: bearings.*.loss_factor, from: 0.5, to: 2 }, meshes: { path: meshes.*.loss_factor, from: 0.5, to: 2 } }";
    let stated = [value(loss(0)), value(teeth / loss(0)), value(loss(1) / loss(0))];
    let (found, text) = run(&means(stated, parameters), &[]);
    let fit = first(&found, "fit");
    for (k, truth) in [1.3, 0.9].into_iter().enumerate() {
        let value = fit["parameters"][k]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 1e-5, "{value} {truth}");
        assert_eq!(
            fit["parameters"][k]["verdict"]["kind"]
                .as_str()
                .or(fit["parameters"][k]["verdict"].as_str()),
            Some("well_determined"),
            "{}",
            fit["parameters"][k]
        );
    }
    assert!(fit["points"].as_array().unwrap().is_empty());
    let records = fit["means"].as_array().unwrap();
    assert_eq!(records.len(), 3);
    assert_eq!(records[0]["unit"], "W");
    assert_eq!(records[1]["unit"], "-");
    assert!(
        records
            .iter()
            .all(|mean| mean["residual"].as_f64().unwrap().abs() < 0.01),
        "{records:?}"
    );
    assert!(
        records[1]["residual_before"].as_f64().unwrap().abs() > 10.0,
        "{records:?}"
    );
    // Two parameters take two of three means.
    let leverage: f64 = records.iter().map(|mean| mean["leverage"].as_f64().unwrap()).sum();
    assert!((leverage - 2.0).abs() < 1e-6, "{leverage}");
    shows(&text, &records[1]);
    assert_eq!(found.csv("fit-means").lines().count(), 4);
}

/// A range pulls only from outside of it, and a mean that no parameter reaches is named.
#[test]
fn ranges_of_means_hold_or_are_named() {
    let parameters = "{ bearings: { path: bearings.*.loss_factor, from: 0.5, to: 2, start: 1.2 } }";
    let wide = ["from: 1 W, to: 1e6 W", "from: 0.01", "to: 100"].map(str::to_owned);
    let (found, _) = run(&means(wide, parameters), &[]);
    let fit = first(&found, "fit");
    assert!(
        fit["means"]
            .as_array()
            .unwrap()
            .iter()
            .all(|mean| mean["residual"] == 0.0)
    );
    assert_eq!(fit["misfit"]["objective"], 0.0);
    assert_eq!(fit["parameters"][0]["value"], 1.2);
    let narrow = ["from: 1 W", "from: 0.01", "to: 0.01"].map(str::to_owned);
    let (found, text) = run(&means(narrow, parameters), &[]);
    let thin = first(&found, "fit")["means"][2].clone();
    assert!(thin["residual"].as_f64().unwrap() > 100.0);
    shows(&text, &thin);
    let row = text.lines().find(|line| line.starts_with("thin")).unwrap();
    assert!(row.contains("at most 0.01"), "{row}");
}

/// A study with means in braces and one parameter.
fn of_means(means: &str) -> String {
    study(&format!(
        "{LOADS}
analyses:
  fit:
    type: identify
    gear: first
    starts: 1
    means: {means}
    parameters: {{ bearings: {{ path: bearings.*.loss_factor, from: 0.5, to: 2 }} }}
"
    ))
}

#[test]
fn a_mean_over_no_loss_is_named() {
    let over_none = "{ day: { drive: { cycles: [loads] }, mechanism: gear_mesh, relative_to: { set: { meshes.*.loss_factor: 0 } }, value: 1, accuracy: 0.1 } }";
    let (_, text) = run(&of_means(over_none), &[]);
    assert!(
        text.contains("analyses.fit")
            && text.contains("`day` has no value: the loss over which it is stated is zero")
            && text.contains("help:"),
        "{text}"
    );
}

/// What models observe in cycles with other values is told with the rest.
#[test]
fn notes_of_cycles_with_other_values_are_kept() {
    let notes = |means: &str| {
        let (found, _) = run(&of_means(means), &[]);
        first(&found, "fit")["outside"].as_array().unwrap().clone()
    };
    let plain = "all: { drive: { cycles: [loads] }, value: 100 W, accuracy: 10 W }";
    let thin = "thin: { drive: { cycles: [loads] }, set: { lubricants.sump.viscosity.kv100: 5 mm2/s }, value: 100 W, accuracy: 10 W }";
    let (alone, both) = (
        notes(&format!("{{ {plain} }}")),
        notes(&format!("{{ {plain}, {thin} }}")),
    );
    assert!(!alone.is_empty());
    let points = |note: &Value| note["points"].as_u64().unwrap();
    for note in &alone {
        let same = |other: &&Value| ["path", "name"].iter().all(|key| other[key] == note[key]);
        let found = both.iter().find(same).unwrap_or_else(|| panic!("{note}"));
        assert!(points(found) > points(note), "{found} {note}");
    }
    assert!(!notes(&format!("{{ {thin} }}")).is_empty());
}

/// Points of a rig with instruments, whose scatter is a third of what is stated: the rest is common to all points. Two sets and further means.
fn beside_points(means: &str) -> Value {
    let mut csv = "torque [Nm],speed [rpm],torque_out [Nm],speed_out [rpm]\n".to_owned();
    let noise = [0.8, -1.1, 0.3, -0.4, 1.2, -0.9, 0.5];
    for (i, [torque, speed, _, out, turning]) in points(&[], &TORQUES, &SPEEDS).into_iter().enumerate() {
        let there = out.abs() + 0.03 * noise[i % noise.len()];
        let _ = writeln!(csv, "{torque},{speed},{there},{}", turning.abs());
    }
    let study = study(&format!(
        "{LOADS}
model_sets:
  right: {{ set: {{ lubricants.sump.viscosity.factor: 1 }} }}
  thick: {{ set: {{ lubricants.sump.viscosity.factor: 1.5 }} }}
analyses:
  fit:
    type: identify
    gear: first
    model_sets: [right, thick]
    data: {{ file: rig.csv, stated_as: standard, rig: {{ torque_in: {{ absolute: 0.005 Nm }}, torque_out: {{ absolute: 0.1 Nm }} }} }}
    residuals: [loss]
    means: {means}
    folds: 5
    starts: 1
    profiles: false
    parameters: {{ bearings: {{ path: bearings.*.loss_factor, from: 0.5, to: 2 }}, meshes: {{ path: meshes.*.loss_factor, from: 0.5, to: 2 }} }}
"
    ));
    run(&study, &[("rig.csv", &csv)]).0.json("fit")
}

/// Leverage of the points of the first set, and of its means.
fn leverages(result: &Value) -> [f64; 2] {
    ["points", "means"].map(|key| {
        let list = result["identifications"][0][key].as_array();
        let of = |list: &Vec<Value>| list.iter().map(|x| x["leverage"].as_f64().unwrap()).sum::<f64>();
        list.map_or(0.0, of)
    })
}

#[test]
fn a_mean_beside_points_weighs_as_much_as_it_is_accurate() {
    let alone = beside_points("{}");
    let vague = beside_points("{ all: { drive: { cycles: [loads] }, value: 100 W, accuracy: 1e9 W } }");
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    // A mean that says nothing changes nothing: neither the parameters nor the comparison of the sets.
    for k in 0..2_usize {
        let [with, without] = [&vague, &alone].map(|result| &result["identifications"][k]["parameters"]);
        for i in 0..2_usize {
            let value = number(&without[i]["value"]);
            let [low, high] = [0_usize, 1].map(|end| without[i]["interval"][end].as_f64().unwrap_or(value));
            let apart = number(&with[i]["value"]) - value;
            assert!(
                apart.abs() <= 0.01 * (high - low) + 1e-6,
                "{apart}\n{}\n{}",
                with[i],
                without[i]
            );
        }
    }
    let [with, without] = [&vague, &alone].map(|result| &result["comparison_of_sets"]["sets"]);
    assert_eq!(with[0]["model_set"], without[0]["model_set"]);
    let [with, without] = [with, without].map(|sets| &sets[1]["first_against_it"]);
    assert_eq!(with["decision"], without["decision"]);
    assert_eq!(with["reason"], without["reason"]);
    // Without an allowance for common errors, the separation would be another.
    assert!(number(&without["correlation"]) > 0.1, "{without}");
    for key in ["separation", "evidence", "correlation"] {
        let (x, y) = (number(&with[key]), number(&without[key]));
        assert!((x - y).abs() <= 0.01 * y.abs().max(1.0), "{key}: {x} {y}");
    }
    let [points, means] = leverages(&vague);
    assert!((points - 2.0).abs() < 1e-6 && means < 1e-6, "{points} {means}");
    // One that agrees to a percent takes a part of the two parameters from the points.
    let model = number(&vague["identifications"][0]["means"][0]["model"]);
    let exact = beside_points(&format!(
        "{{ all: {{ drive: {{ cycles: [loads] }}, value: {model}, accuracy: {} }} }}",
        0.01 * model
    ));
    let [points, means] = leverages(&exact);
    assert!((points + means - 2.0).abs() < 1e-6 && means > 0.01, "{points} {means}");
}
