//! The program as its users call it.

use crate::common::{
    self,
    program::{gearloss, out},
};
use assert_cmd::Command;

const GEARBOX: &str = "examples/two-speed-ev/gearbox.yaml";

#[test]
fn check_says_fine_or_what_is_wrong() {
    assert!(out(&["check", GEARBOX, "examples/two-speed-ev/study.yaml"]).contains("fine"));
    let wrong = gearloss(&["check", "tests/cases/wrong_unit/input.yaml"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8(wrong.stderr).unwrap().contains("input.yaml:10:"));
    let missing = gearloss(&["check", "nowhere.yaml"]);
    assert_eq!(missing.status.code(), Some(2));
    let denied = gearloss(&["check", GEARBOX, "--deny", "disputed"]);
    assert_eq!(denied.status.code(), Some(1));
}

#[test]
fn check_resolved_is_a_document_again() {
    let resolved = out(&["check", GEARBOX, "--resolved"]);
    assert!(resolved.contains("designation") && resolved.contains("c0"));
    // A file of the own text solves to the same digits.
    let copy = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("resolved.yaml");
    std::fs::write(&copy, &resolved).unwrap();
    let copy = copy.to_str().unwrap();
    assert!(out(&["check", copy]).contains("fine"));
    let solved = |file: &str| {
        out(&[
            "solve", file, "--gear", "second", "--torque", "17.3 Nm", "--speed", "4321 rpm", "--format", "json",
        ])
    };
    // Evidence knows what was written and what is a default.
    let losses = |text: &str| text.split("\"evidence\"").next().unwrap().to_owned();
    assert_eq!(losses(&solved(GEARBOX)), losses(&solved(copy)));
}

/// The resolved description of a gearbox without keys that have no value.
fn without_nulls(value: serde_json::Value) -> serde_json::Value {
    match value {
        serde_json::Value::Object(map) => map
            .into_iter()
            .filter(|(_, value)| !value.is_null())
            .map(|(key, value)| (key, without_nulls(value)))
            .collect(),
        serde_json::Value::Array(list) => list.into_iter().map(without_nulls).collect(),
        other => other,
    }
}

#[test]
fn every_resolved_gearbox_is_read_back_to_the_bit() {
    use gearloss_framework::gearbox::Gearbox;
    use gearloss_framework::resolve::Choice;

    let language = common::language();
    let examples = [
        "electric-drive-unit/gearbox.yaml",
        "electric-drive-unit/gearbox-40.yaml",
        "electric-drive-unit/gearbox-beam.yaml",
        "planetary-reducer/gearbox.yaml",
        "two-products/theirs.yaml",
        "two-speed-ev/gearbox.yaml",
    ];
    let mut files: Vec<std::path::PathBuf> = examples
        .iter()
        .map(|name| common::file("examples").join(name))
        .collect();
    files.extend(common::cases().into_iter().map(|case| case.join("input.yaml")));
    let mut compared = 0;
    for file in files {
        let Ok(gearbox) = Gearbox::read(&language, &file) else {
            continue;
        };
        let Ok(resolved) = gearbox.resolve(&language, &Choice::default()) else {
            continue;
        };
        if gearbox.build(&language, &resolved).is_err() || gearbox.check_sets(&language).is_err() {
            continue;
        }
        let text = out(&["check", file.to_str().unwrap(), "--resolved"]);
        let again = Gearbox::of_text(&language, &text, "resolved.yaml", file.parent().unwrap());
        let again = again.unwrap_or_else(|findings| panic!("{}: {}\n{text}", file.display(), findings.first()));
        let again = again.resolve(&language, &Choice::default()).unwrap();
        assert_eq!(
            without_nulls(again.value),
            without_nulls(resolved.value),
            "{}",
            file.display()
        );
        compared += 1;
    }
    assert!(compared >= examples.len() + 5, "{compared}");
}

#[test]
fn solve_prints_a_table_and_json_with_the_same_numbers() {
    let args = [
        "solve", GEARBOX, "--gear", "first", "--torque", "10 Nm", "--speed", "8000 rpm",
    ];
    let table = out(&args);
    assert!(
        table.contains("status drive") && table.contains("bearings.B5"),
        "{table}"
    );
    let json: serde_json::Value = serde_json::from_str(&out(&[&args[..], &["--format", "json"]].concat())).unwrap();
    assert_eq!(json["format"], "gearloss-point/1");
    let loss = json["loss_w"].as_f64().unwrap();
    assert!(table.contains(&format!("loss {loss:.1} W")), "{table}");
    let residual = json["power"]["residual_w"].as_f64().unwrap();
    assert!(residual.abs() < 1e-11 * json["power"]["largest_internal_power_w"].as_f64().unwrap());
    let parts = json["parts"].as_array().unwrap().iter();
    let parts: Vec<(&str, f64)> = parts
        .map(|part| (part["part"].as_str().unwrap(), part["loss_w"].as_f64().unwrap()))
        .collect();
    for (path, watts) in &parts {
        let mut rows = table.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let (path, watts) = (*path, format!("{watts:.4}"));
        assert!(
            rows.any(|cells| cells.first() == Some(&path) && cells.contains(&watts.as_str())),
            "{path}: {watts}: {table}"
        );
    }
    let sum: f64 = parts.iter().map(|(_, watts)| watts).sum();
    assert!((sum / loss - 1.0).abs() < 1e-12);
}

#[test]
fn solve_follows_overrides_sets_and_the_other_port() {
    let loss = |more: &[&str]| {
        let args = [
            &[
                "solve", GEARBOX, "--gear", "first", "--speed", "8000 rpm", "--format", "json",
            ][..],
            more,
        ]
        .concat();
        let json: serde_json::Value = serde_json::from_str(&out(&args)).unwrap();
        (
            json["loss_w"].as_f64().unwrap(),
            json["ports"][0]["torque_nm"].as_f64().unwrap(),
        )
    };
    let described = loss(&["--torque", "10 Nm"]).0;
    assert!(loss(&["--torque", "10 Nm", "--models", "joint"]).0 < described);
    assert!(loss(&["--torque", "10 Nm", "--set", "meshes.*.model.x_l=0.5"]).0 < described);
    assert!(loss(&["--torque", "10 Nm", "--set", "bearings.B1.designation=\"6204\""]).0 != described);
    let (_, input) = loss(&["--torque", "output=-218 Nm"]);
    assert!(input > 10.0 && input < 10.5, "{input}");
}

/// The surface of the gearbox is that of every gear which has none of its own, and so is an override of it.
#[test]
fn an_override_of_the_surface_reaches_the_gears() {
    let loss = |sets: &[&str]| {
        let gearbox = "examples/electric-drive-unit/gearbox-40.yaml";
        let mut args = vec![
            "solve", gearbox, "--torque", "30 Nm", "--speed", "3000 rpm", "--format", "json",
        ];
        args.extend(sets.iter().flat_map(|set| ["--set", set]));
        let json: serde_json::Value = serde_json::from_str(&out(&args)).unwrap();
        json["loss_w"].as_f64().unwrap()
    };
    let smooth = loss(&["gears.*.surface.rq=0.1 um"]);
    assert!(smooth < 0.9 * loss(&[]));
    assert_eq!(loss(&["surface.rq=0.1 um"]).to_bits(), smooth.to_bits());
    assert_eq!(
        loss(&["surface.rq=0.3 um", "surface.rq=0.1 um"]).to_bits(),
        smooth.to_bits()
    );
    let one = loss(&["gears.W2.surface.rq=0.1 um"]);
    assert_eq!(
        loss(&["gears.W2.surface.rq=0.1 um", "surface.rq=0.198 um"]).to_bits(),
        one.to_bits()
    );
}

/// A power is the torque or the speed that is not given.
#[test]
fn solve_takes_a_power_beside_torque_or_speed() {
    let solve = |given: &[&str]| {
        let args = [&["solve", GEARBOX, "--gear", "first", "--format", "json"][..], given].concat();
        let json: serde_json::Value = serde_json::from_str(&out(&args)).unwrap();
        json["loss_w"].as_f64().unwrap()
    };
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * b;
    // 10 Nm at 8000 rpm.
    let power = format!("{} kW", 10.0 * 8000.0 * std::f64::consts::PI / 30.0 / 1000.0);
    let loss = solve(&["--torque", "10 Nm", "--speed", "8000 rpm"]);
    assert!(close(solve(&["--power", &power, "--speed", "8000 rpm"]), loss));
    assert!(close(solve(&["--power", &power, "--torque", "10 Nm"]), loss));
}

#[test]
fn wrong_arguments_say_how_to_fix_them() {
    for (args, words) in [
        (vec!["solve", GEARBOX], "add --gear"),
        (
            vec![
                "solve", GEARBOX, "--gear", "third", "--speed", "1 rpm", "--torque", "1 Nm",
            ],
            "no gear state is called `third`",
        ),
        (
            vec![
                "solve", GEARBOX, "--gear", "first", "--speed", "1 Nm", "--torque", "1 Nm",
            ],
            "torque, not an angular speed",
        ),
        (
            vec!["solve", GEARBOX, "--gear", "first", "--speed", "1 rpm"],
            "add --torque",
        ),
        (
            vec!["solve", GEARBOX, "--gear", "first", "--power", "1 kW"],
            "add --speed \"input=1000 rpm\" or --torque",
        ),
        (
            vec![
                "solve", GEARBOX, "--gear", "first", "--speed", "0 rpm", "--power", "1 kW",
            ],
            "no power is transmitted at `input`",
        ),
        (
            vec![
                "solve", GEARBOX, "--gear", "first", "--speed", "1 rpm", "--torque", "1 Nm", "--power", "1 W",
            ],
            "delete one of the three",
        ),
        (
            vec![
                "solve", GEARBOX, "--gear", "first", "--speed", "1 rpm", "--torque", "1 Nm", "--models", "jiont",
            ],
            "write `joint`",
        ),
        (
            vec![
                "solve",
                GEARBOX,
                "--gear",
                "first",
                "--speed",
                "1 rpm",
                "--torque",
                "1 Nm",
                "--set",
                "bearings.B9.bore=1 mm",
            ],
            "`bearings` has no `B9`",
        ),
        (
            vec![
                "solve",
                GEARBOX,
                "--gear",
                "first",
                "--speed",
                "1 rpm",
                "--torque",
                "1 Nm",
                "--set",
                "bearings.B1.bore=1 Nm",
            ],
            "torque, not a length",
        ),
        (
            vec![
                "explain", GEARBOX, "B77", "--gear", "first", "--speed", "1 rpm", "--torque", "1 Nm",
            ],
            "there is no component",
        ),
        (
            vec![
                "solve",
                GEARBOX,
                "--gear",
                "first",
                "--speed",
                "1000 rpm",
                "--speed",
                "output=100 rpm",
                "--torque",
                "1 Nm",
            ],
            "tied by meshes.M1, meshes.M2, couplings.S1",
        ),
        (
            vec![
                "solve",
                GEARBOX,
                "--gear",
                "first",
                "--speed",
                "1 rpm",
                "--torque",
                "1 Nm",
                "--set",
                "meshes.*.model.load_sharing=uniform",
            ],
            "the key `load_sharing` does not exist here",
        ),
        (vec!["models", "bearings"], "write bearing"),
        (vec!["eval", "bearing/sfk"], "write skf"),
    ] {
        let output = gearloss(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(words), "{args:?}: {text}");
    }
}

#[test]
fn explain_shows_every_intermediate_branch_and_input() {
    let text = out(&[
        "explain", GEARBOX, "B1", "--gear", "first", "--torque", "10 Nm", "--speed", "8000 rpm",
    ]);
    for words in [
        "Fr = ",
        "branch: nu n at least 2000",
        "M0 = ",
        "N mm",
        "catalogue 6303, confidence high",
        "gearbox.yaml:",
        "source:",
    ] {
        assert!(text.contains(words), "{words} is missing:\n{text}");
    }
    let mesh = out(&[
        "explain", GEARBOX, "M1", "--gear", "first", "--torque", "10 Nm", "--speed", "8000 rpm",
    ]);
    assert!(mesh.contains("H_v") && mesh.contains("limited to 150"), "{mesh}");
}

#[test]
fn models_lists_explains_and_finds_needs() {
    let all = out(&["models"]);
    assert!(all.contains("gear_mesh") && all.contains("path_integral") && all.contains("set joint"));
    assert!(out(&["models", "bearing"]).contains("oil_height"));
    assert!(out(&["models", "bearing", "skf"]).contains("mu_bl"));
    let checks = out(&["models", "seal", "linke", "--checks"]);
    assert!(
        checks.contains("36.9120 W") && checks.contains("independent implementation"),
        "{checks}"
    );
    assert!(
        checks.ends_with("check values: 1, all within their tolerance\n"),
        "{checks}"
    );
    let checks = out(&["models", "rating", "iso_76", "--checks"]);
    assert!(checks.contains("max(Fr, 0.6 Fr + 0.5 Fa)"), "{checks}");
    assert_eq!(out(&["models", "seal", "constant", "--checks"]), "no check values\n");
    let needs = out(&["models", "--needs", GEARBOX]);
    assert!(
        needs.contains("housing.section") && needs.contains("assumed") && needs.contains("derived (catalogue 6303"),
        "{needs}"
    );
    assert!(
        needs.contains("missing: skf publishes no row for needle roller bearings"),
        "{needs}"
    );
}

#[test]
fn eval_answers_for_every_model_alone() {
    let language = common::language();
    for mechanism in language.registry().mechanisms() {
        for model in language.registry().models(mechanism.key).filter(|m| m.name != "table") {
            let text = out(&["eval", &format!("{}/{}", mechanism.key, model.name)]);
            assert!(text.contains("source:"), "{text}");
        }
    }
}

#[test]
fn eval_reads_its_input() {
    let folder = std::env::temp_dir().join(format!("gearloss-eval-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("input.yaml");
    std::fs::write(&file, "at: { speed: 3000 rpm, temperature: 70 degC, nu40: 30 mm2/s }\n").unwrap();
    let json: serde_json::Value = serde_json::from_str(&out(&[
        "eval",
        "seal/iso14179_2",
        "--input",
        file.to_str().unwrap(),
        "--format",
        "json",
    ]))
    .unwrap();
    assert!((json["total"].as_f64().unwrap() / 44.8643 - 1.0).abs() < 1e-5, "{json}");
    std::fs::write(&file, "at: { sped: 3000 rpm }\n").unwrap();
    let wrong = gearloss(&["eval", "seal/iso14179_2", "--input", file.to_str().unwrap()]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8(wrong.stderr).unwrap().contains("write `speed`"));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// One line for each analysis, what to be careful about, the path of the report: at most forty lines. Quiet: the path alone.
#[test]
fn run_prints_the_result_of_each_analysis_in_one_line() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("console");
    let study = common::file("examples/planetary-reducer/study.yaml");
    let run = |more: &[&str]| {
        let _ = std::fs::remove_dir_all(&folder);
        let output = gearloss(&[&["run", study.to_str().unwrap(), "-o", folder.to_str().unwrap()], more].concat());
        assert!(output.status.success());
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap())
    };
    let [text, notes] = run(&[]);
    for name in [
        "tests",
        "loaded",
        "unloaded",
        "limit",
        "fastest",
        "convergence",
        "careful",
    ] {
        let lines = text
            .lines()
            .filter(|line| line.trim_start_matches(['>', ' ']).starts_with(&format!("{name} ")));
        assert_eq!(lines.count(), 1, "{name}: {text}");
    }
    assert!(
        text.contains(
            "At 12 operating points with the gearbox's own models: loss 20.6 to 72.7 W (at the highest loss: bearings 42.3 %, seals 41.8 %), oil 29.5 to 53.7 °C"
        ),
        "{text}"
    );
    assert!(text.lines().count() + notes.lines().count() <= 40, "{text}{notes}");
    let [quiet, notes] = run(&["--quiet"]);
    assert!(
        quiet.starts_with("report: ") && quiet.lines().count() == 1 && notes.is_empty(),
        "{quiet}{notes}"
    );
    let [all, _] = run(&["--verbose"]);
    assert!(
        all.contains("oil °C  speed rpm  torque Nm") && all.lines().count() > 100,
        "{all}"
    );
    assert!(
        !gearloss(&["run", study.to_str().unwrap(), "--quiet", "--verbose"])
            .status
            .success()
    );
}

#[test]
fn run_writes_csv_and_json_and_prints_tables() {
    let common::StudyRun { folder, text, .. } = common::study_run("examples/two-speed-ev/study.yaml");
    assert!(
        text.contains("efficiency of joint minus iso in percentage points"),
        "{text}"
    );
    let maps: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("maps.json")).unwrap()).unwrap();
    assert_eq!(maps["format"], "gearloss-result/1");
    assert_eq!(maps["maps"].as_array().unwrap().len(), 3);
    assert_eq!(maps["maps"][0]["points"].as_array().unwrap().len(), 154);
    let csv = std::fs::read_to_string(folder.join("maps.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 3 * 154);
    for name in ["gap", "stack", "shares"] {
        assert!(folder.join(format!("{name}.csv")).exists() && folder.join(format!("{name}.json")).exists());
    }
}

#[test]
fn run_marks_answers_and_says_that_data_are_synthetic() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("answered");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::copy(common::file(GEARBOX), folder.join("gearbox.yaml")).unwrap();
    std::fs::copy(common::file("examples/two-speed-ev/rig.csv"), folder.join("rig.csv")).unwrap();
    let study = "gearloss: study/1\ngearboxes: { ours: gearbox.yaml }\nanswered_by: [last, second]\n\
        measurements: { rig: { file: rig.csv, about: synthetic, columns: { torque: T_in, speed: n_in, efficiency: eta, oil_temperature: T_oil } } }\n\
        grids: { few: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 8000 rpm] } }\n\
        analyses:\n  first: { type: map, grid: few }\n  second: { type: map, grid: few }\n  last: { type: map, grid: few }\n";
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let text = out(&["run", folder.join("study.yaml").to_str().unwrap()]);
    let begins = |line: &&str| {
        ["> ", "  first", "measurement"]
            .iter()
            .any(|start| line.starts_with(start))
    };
    let lines: Vec<&str> = text.lines().filter(begins).collect();
    assert!(
        lines[0] == "measurement `rig`: synthetic"
            && lines[1].starts_with("  first ")
            && lines[2].starts_with("> second ")
            && lines[3].starts_with("> last "),
        "{text}"
    );
    let report = std::fs::read_to_string(folder.join("results/report.html")).unwrap();
    assert!(report.contains("measurement `rig`: synthetic</p>"));
    let place = |name: &str| {
        report
            .find(&format!("id=\"analysis-{name}\""))
            .unwrap_or_else(|| panic!("no section {name}"))
    };
    assert!(place("first") < place("second") && place("second") < place("last"));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_model_that_a_set_does_not_reach_is_said() {
    let text = out(&["check", GEARBOX, "--models", "joint"]);
    assert!(
        text.contains("bearings: N3, N5 keep their own model under `joint`"),
        "{text}"
    );
}

fn scratch(name: &str) -> std::path::PathBuf {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn moments_of_openfoam_become_a_table_and_a_power_law() {
    let folder = scratch("openfoam");
    let mut runs = "speed [rpm],nu [mm2/s],folder\n".to_owned();
    for (i, (speed, nu)) in [(300.0_f64, 20.0_f64), (100.0, 20.0), (100.0, 80.0), (300.0, 80.0)]
        .into_iter()
        .enumerate()
    {
        let moment = -0.01 * (speed / 100.0).powf(0.7) * (nu / 20.0).powf(0.5);
        // The first start went wrong from 0.2 s on and was repeated.
        let line = |time: f64, factor: f64| {
            let part = 0.25 * factor * moment;
            format!("{time} 0 0 {} 0 0 {part} 0 0 {}\n", 4.0 * part, 3.0 * part)
        };
        for (start, text) in [
            ("0", line(0.0, 9.0) + &line(0.1, 1.0) + &line(0.2, 7.0)),
            ("0.15", line(0.15, 1.0) + &line(0.3, 1.0)),
        ] {
            let place = folder.join(format!("run{i}/{start}"));
            std::fs::create_dir_all(&place).unwrap();
            std::fs::write(
                place.join("moment.dat"),
                format!("# Time total pressure viscous\n{text}"),
            )
            .unwrap();
        }
        runs.push_str(&format!("{speed},{nu},run{i}\n"));
    }
    let (list, table) = (folder.join("runs.csv"), folder.join("drag.csv"));
    std::fs::write(&list, &runs).unwrap();
    let (list, table) = (list.to_str().unwrap(), table.to_str().unwrap());
    let import = [
        "import",
        "openfoam-forces",
        list,
        "--axis",
        "z",
        "--from",
        "0.1 s",
        "-o",
        table,
    ];
    assert!(out(&import).contains("run3"));
    let written = std::fs::read_to_string(table).unwrap();
    let rows: Vec<&str> = written.lines().skip(1).collect();
    assert_eq!(rows[0], "speed [rpm],nu [mm2/s],pressure [Nm],viscous [Nm]");
    assert!(rows[1].starts_with("100,20,0.0025,0.0075"), "{}", rows[1]);
    let fitted = out(&["fit", "power-law", table]);
    assert!(
        fitted.contains("speed_exponent: 0.7,") && fitted.contains("viscosity_exponent: 0.5,"),
        "{fitted}"
    );
    assert!(fitted.contains("max") && fitted.contains("4 points"), "{fitted}");
    // A file is not overwritten; another axis has no moment; a folder must hold something.
    for (args, said) in [
        (import.to_vec(), "not overwritten"),
        (
            [&import[..4], &["x", "--from", "0.1 s", "-o", "nowhere.csv"]].concat(),
            "whose sign differs",
        ),
        (
            [&import[..5], &["--from", "9 s", "-o", "nowhere.csv"]].concat(),
            "0 samples in the averaging time",
        ),
    ] {
        let failed = gearloss(&args);
        assert_eq!(failed.status.code(), Some(2));
        let text = String::from_utf8(failed.stderr).unwrap();
        assert!(text.contains(said) && text.contains("help:"), "{text}");
    }
    std::fs::write(list, runs.replace("run2", "run9")).unwrap();
    let failed = gearloss(&[&import[..8], &["nowhere.csv"]].concat());
    assert!(String::from_utf8(failed.stderr).unwrap().contains("line 4"));
}

#[test]
fn results_are_replaced_openly_and_other_files_are_left_alone() {
    let folder = scratch("replaced");
    let study = "examples/two-products/study.yaml";
    let place = folder.join("results");
    let run = |more: &[&str]| gearloss(&[&["run", study, "-o", place.to_str().unwrap()], more].concat());
    assert!(run(&[]).status.success());
    let again = run(&[]);
    assert!(
        String::from_utf8(again.stdout)
            .unwrap()
            .contains("replacing the results")
    );
    assert!(
        std::fs::read_dir(&place)
            .unwrap()
            .all(|f| !f.unwrap().path().to_str().unwrap().contains(".part"))
    );
    // A folder of somebody else.
    std::fs::write(folder.join("thesis.txt"), "text").unwrap();
    let other = gearloss(&["run", study, "-o", folder.to_str().unwrap()]);
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8(other.stderr).unwrap().contains("--force"));
    assert!(
        gearloss(&["run", study, "-o", folder.to_str().unwrap(), "--force"])
            .status
            .success()
    );
    // Leaving a stated range is a finding where that is denied.
    let denied = run(&["--deny", "extrapolation"]);
    assert_eq!(denied.status.code(), Some(1));
    assert!(
        String::from_utf8(denied.stdout)
            .unwrap()
            .contains("outside their stated ranges")
    );
    assert_eq!(run(&["--deny", "recalled"]).status.code(), Some(2));
}

const LOCKS: &str = "tests/results/self_locking.yaml";

/// The Wolfrom set of check P6 loses 1.2 % in each ring mesh and locks itself beyond 1.068 %.
#[test]
fn a_set_that_locks_itself_has_no_torques_and_says_which_way() {
    let point = ["solve", LOCKS, "--speed", "3000 rpm"];
    let at = |torque: &str, more: &[&str]| {
        let output = gearloss(&[&point[..], &["--torque", torque], more].concat());
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let (code, text) = at("-1 Nm", &[]);
    assert_eq!(code, Some(1));
    assert!(
        text.contains("self-locking: no power flows from `output` to `input` at any torque at `output`")
            && text.contains("locked by meshes.p_r1, meshes.p_out")
            && text.contains("efficiency from `input`: 46.82 %"),
        "{text}"
    );
    // Nothing that cannot be is printed: no watts but those of no equilibrium are left.
    let input = text.lines().find(|line| line.starts_with("input")).unwrap();
    let cells: Vec<&str> = input.split_whitespace().collect();
    assert_eq!(cells, ["input", "3000.00", "-", "-"]);
    assert!(!text.contains("sums W"), "{text}");
    let (_, text) = at("-1 Nm", &["--format", "json"]);
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["status"], "self_locking");
    assert_eq!(
        value["self_locking"],
        serde_json::json!({ "from": ["output"], "to": ["input"], "meshes": ["meshes.p_r1", "meshes.p_out"] })
    );
    for port in value["ports"].as_array().unwrap() {
        assert!(port["torque_nm"].is_null() && port["power_w"].is_null(), "{port}");
        assert!(port["speed_rpm"].is_number());
    }
    for part in value["parts"].as_array().unwrap() {
        assert!(part["loss_w"].is_null() && part["moment_of_one_nm"].is_null(), "{part}");
        let terms = part["terms"].as_array().unwrap();
        assert!(terms.iter().all(|term| term["loss_w"].is_null()), "{part}");
    }
    assert!(value["sums_w"].is_null() && value["power"]["largest_internal_power_w"].is_null());

    // Driven from there it turns only because the input drives as well; the status alone says `dragged`.
    let (code, text) = at("output=100 Nm", &[]);
    assert_eq!(code, Some(0));
    assert!(
        text.contains("status dragged")
            && text.contains("self-locking: torque at `output` alone does not turn it")
            && text.contains("maintained only because `input` (0.0548"),
        "{text}"
    );
    // Driven from the input, and with rings that lose less, nothing locks.
    for (torque, more) in [
        ("1 Nm", &[][..]),
        ("-1 Nm", &["--set", "meshes.*.model.value=0.994"]),
        ("output=100 Nm", &["--set", "meshes.*.model.value=0.994"]),
    ] {
        let (_, text) = at(torque, more);
        assert!(!text.contains("self-locking"), "{torque}: {text}");
    }
    let explained = gearloss(&[
        "explain",
        LOCKS,
        "meshes.sp",
        "--speed",
        "3000 rpm",
        "--torque",
        "-1 Nm",
    ]);
    let explained = String::from_utf8(explained.stdout).unwrap();
    assert!(explained.contains("self-locking: no power flows"), "{explained}");
}

/// In tables of studies what cannot be is empty.
#[test]
fn a_map_is_empty_where_a_set_locks_itself() {
    let folder = std::env::temp_dir().join(format!("gearloss-locks-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let study = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {} }}\nconditions: {{ oil_temperature: 80 degC }}\n\
         grids: {{ both: {{ torque: [-1 Nm, 1 Nm], speed: 3000 rpm }} }}\n\
         analyses: {{ map: {{ type: map, grid: both, write: [csv, json] }} }}\n",
        common::file(LOCKS).display()
    );
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    out(&["run", folder.join("study.yaml").to_str().unwrap()]);
    let read = |name: &str| std::fs::read_to_string(folder.join("results").join(name)).unwrap();
    let csv = read("map.csv");
    let row = csv.lines().nth(1).unwrap();
    let (_, after) = row.split_once("self_locking").unwrap();
    assert!(after.len() > 10 && after.chars().all(|c| c == ','), "{row}");
    let value: serde_json::Value = serde_json::from_str(&read("map.json")).unwrap();
    let point = &value["maps"][0]["points"][0];
    assert!(point["sums_w"].is_null() && point["loss_w"].is_null());
    let parts = point["parts_w"].as_array().unwrap();
    assert!(parts.iter().all(serde_json::Value::is_null), "{point}");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Drag that exceeds a small torque is no self-locking: pushing harder helps.
#[test]
fn a_torque_below_the_no_load_loss_is_only_dragged() {
    let text = out(&[
        "solve", GEARBOX, "--gear", "first", "--torque", "0.01 Nm", "--speed", "8000 rpm",
    ]);
    assert!(
        text.contains("status dragged") && !text.contains("self-locking"),
        "{text}"
    );
}

#[test]
fn an_ideal_flow_that_loses_more_than_goes_in_has_a_status_of_its_own() {
    let args = [
        "solve",
        GEARBOX,
        "--gear",
        "first",
        "--torque",
        "0.01 Nm",
        "--speed",
        "8000 rpm",
        "--power-flow",
        "ideal",
    ];
    let text = out(&args);
    assert!(text.contains("status loss_above_input"), "{text}");
    let output = text.lines().find(|line| line.starts_with("output")).unwrap();
    assert!(output.ends_with('-'), "{output}");
    let value: serde_json::Value = serde_json::from_str(&out(&[&args[..], &["--format", "json"]].concat())).unwrap();
    assert_eq!(value["status"], "loss_above_input");
    assert!(value["power"]["output_w"].is_null() && value["efficiency"].is_null());
    assert!(value["ports"][1]["power_w"].is_null() && value["ports"][1]["torque_nm"].is_null());
    // The power that goes in and the losses are known.
    let input = value["power"]["input_w"].as_f64().unwrap();
    assert!(input > 0.0 && value["power"]["loss_w"].as_f64().unwrap() > input);
    assert_eq!(value["ports"][0]["power_w"].as_f64().unwrap(), input);
    let enough = out(&[
        "solve",
        GEARBOX,
        "--gear",
        "first",
        "--torque",
        "10 Nm",
        "--speed",
        "8000 rpm",
        "--power-flow",
        "ideal",
    ]);
    assert!(enough.contains("status drive"), "{enough}");
}

#[test]
fn faults_of_an_override_point_into_the_option() {
    let wrong = |set: &str| {
        let output = gearloss(&[
            "solve", GEARBOX, "--gear", "first", "--torque", "1 Nm", "--speed", "1000 rpm", "--set", set,
        ]);
        assert_eq!(output.status.code(), Some(2), "{set}");
        String::from_utf8(output.stderr).unwrap()
    };
    for (set, column, carets) in [
        ("bearings.B9.bore=3 mm", 10, "^^"),
        ("gears.G1.facewith=3 mm", 10, "^^^^^^^^"),
        ("gears.G1.facewidth=3 kg", 20, "^^^^"),
        ("gears.*.facewidth = 3 kg", 21, "^^^^"),
        ("thermal.oil=-400 degC", 13, "^^^^^^^^^"),
        ("models.bearing.type=skf", 1, "^^^^^^"),
        ("gears.G1.z=[1", 12, "^"),
        ("nonsense", 1, "^^^^^^^^"),
    ] {
        let text = wrong(set);
        assert!(text.contains(&format!(" --> --set:1:{column}\n")), "{set}: {text}");
        let marked = format!("| {set}\n");
        let under = text.split(&marked).nth(1).unwrap_or_else(|| panic!("{set}: {text}"));
        let under = under.lines().next().unwrap();
        let (_, under) = under.split_once("| ").unwrap();
        assert_eq!(
            under.trim_end(),
            format!("{}{carets}", " ".repeat(column - 1)),
            "{set}: {text}"
        );
    }
    // Of what else is wrong nothing points there.
    let output = gearloss(&[
        "solve",
        "tests/cases/wrong_unit/input.yaml",
        "--speed",
        "1 rpm",
        "--set",
        "thermal.oil=40 degC",
    ]);
    assert!(!String::from_utf8(output.stderr).unwrap().contains("--set"));
}

#[test]
fn faults_of_an_input_of_eval_have_file_and_line() {
    let folder = std::env::temp_dir().join(format!("gearloss-eval-faults-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let wrong = |model: &str, input: &str| {
        let file = folder.join("input.yaml");
        std::fs::write(&file, input).unwrap();
        let output = gearloss(&["eval", model, "--input", file.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2), "{input}");
        (file.display().to_string(), String::from_utf8(output.stderr).unwrap())
    };
    for (model, input, place) in [
        // Found while building: a tapered bearing needs `y`.
        (
            "bearing/skf",
            "# a bearing\npart: { kind: tapered_roller, series: \"302\", bore: 30 mm, outside: 62 mm, width: 17 mm }\n",
            ":2:1",
        ),
        (
            "bearing/skf",
            "at: { speed: 100 rpm }\nmodel: { type: timken }\n",
            ":2:",
        ),
        ("bearing/skf", "\nat: { speed: 3 kg }\n", ":2:14"),
    ] {
        let (file, text) = wrong(model, input);
        assert!(text.contains(&format!(" --> {file}{place}")), "{input}: {text}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn too_many_threads_are_limited_with_a_note() {
    let output = Command::cargo_bin("gearloss")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("RAYON_NUM_THREADS", "20000")
        .args(["check", GEARBOX])
        .timeout(std::time::Duration::from_mins(1))
        .output()
        .unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(
        text.contains("note: RAYON_NUM_THREADS=20000: ") && text.contains("using "),
        "{text}"
    );
}

#[test]
fn a_limit_of_registers_is_one_of_their_widths() {
    for (width, code) in [("avx2", 0), ("avx1024", 2)] {
        let output = Command::cargo_bin("gearloss")
            .unwrap()
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .env("GEARLOSS_REGISTERS", width)
            .args(["check", GEARBOX])
            .timeout(std::time::Duration::from_mins(1))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{width}");
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            text.contains("write sse2, avx2, avx512, or delete the variable"),
            code == 2,
            "{text}"
        );
    }
}

#[test]
fn huge_speeds_are_printed_in_engineering_notation() {
    let output = gearloss(&[
        "solve",
        GEARBOX,
        "--gear",
        "first",
        "--torque",
        "1 Nm",
        "--speed",
        "1e300 rpm",
    ]);
    let text = String::from_utf8(output.stdout).unwrap();
    let input = text.lines().find(|line| line.starts_with("input")).unwrap();
    assert!(input.contains("1.00000e300"), "{input}");
    assert!(text.lines().all(|line| line.len() < 250), "{text}");
    // Answer, ports, loads, losses; the reason follows them.
    assert!(text.split("\n\n").take(4).all(|block| !block.contains("inf")), "{text}");
}

/// The test runs itself as a process of its own, in which a thread panics under the hook of the program.
#[test]
fn a_panic_in_any_thread_ends_the_program_with_exit_code_3() {
    const CHILD: &str = "PANICS_UNDER_THE_HOOK";
    if std::env::var_os(CHILD).is_some() {
        // Installs the hook, and refuses the arguments of the test program.
        let _ = gearloss::main();
        let _ = std::thread::spawn(|| panic!("of a model")).join();
        return;
    }
    let name = "program::a_panic_in_any_thread_ends_the_program_with_exit_code_3";
    let ended = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", name, "--nocapture"])
        .env(CHILD, "1")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3), "{text}");
    assert!(
        text.contains("of a model") && text.contains("This is a bug in gearloss"),
        "{text}"
    );
}

/// Scripts for shells and manual pages follow the commands themselves.
#[test]
fn completions_and_manual_pages_know_the_commands() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = out(&["completions", shell]);
        assert!(
            script.contains("explain") && script.contains("oil-temperature"),
            "{shell}"
        );
        assert!(!script.contains("fill-template"), "{shell}");
    }
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("man");
    out(&["man", folder.to_str().unwrap()]);
    let page = std::fs::read_to_string(folder.join("gearloss-solve.1")).unwrap();
    assert!(page.contains("oil\\-temperature"), "{page}");
    let page = std::fs::read_to_string(folder.join("gearloss.1")).unwrap();
    assert!(
        page.contains("gearloss\\-import(1)") && !page.contains("fill\\-template"),
        "{page}"
    );
    // Where a file stands no folder can be made.
    let refused = gearloss(&["man", GEARBOX]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8(refused.stderr).unwrap().contains("help:"));
}
