//! The corpus: every set is complete, every model at every set is as committed, and a faulty set is refused with place and help.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use assert_cmd::Command;
use gearloss_framework::files::Disk;
use gearloss_report::validation;
use gearloss_studies::corpus::{Basis, Corpus, cells_csv, over_sets};
use gearloss_studies::engine::progress::Silent;

use crate::common::study::run_texts;
use crate::common::{file, language};

/// The document and the cells that models carry. `UPDATE=1 cargo test --test all corpus::` writes them anew: a changed cell is a changed law, or a
/// changed set, and CHANGELOG.md says which.
#[test]
fn every_model_at_every_set_is_as_committed() {
    let language = language();
    let corpus = Corpus::read(&language, &Disk::shared(), &file("corpus"))
        .unwrap_or_else(|list| panic!("{}", list.iter().map(ToString::to_string).collect::<String>()));
    let validated = corpus
        .validate(&language, &Silent)
        .unwrap_or_else(|stopped| panic!("{stopped}"));
    let cells = validated.cells(&language);
    // Results with three digits; the rounding of another machine does not show.
    let texts = [
        ("plugins/catalogues/validation.csv", cells_csv(&cells)),
        ("docs/validation.md", validation::document(&language, &validated)),
    ];
    for (name, text) in &texts {
        if std::env::var_os("UPDATE").is_some() {
            fs::write(file(name), text).unwrap();
        }
        let committed = fs::read_to_string(file(name)).unwrap();
        let changed: Vec<String> = text
            .lines()
            .filter(|line| !committed.lines().any(|known| known == *line))
            .map(|line| format!("now:       {line}"))
            .chain(
                committed
                    .lines()
                    .filter(|line| !text.lines().any(|now| now == *line))
                    .map(|line| format!("committed: {line}")),
            )
            .collect();
        assert_eq!(*text, committed, "{name} (UPDATE=1 writes it):\n{}", changed.join("\n"));
    }
    let measured = corpus
        .sets
        .iter()
        .filter(|set| set.source.kind == Basis::Measured && set.study.is_some());
    assert!(measured.count() >= 8);
    assert!(corpus.sets.iter().filter(|set| set.study.is_some()).count() >= 13);
    // Sets are counted: no model has more than there are.
    assert!(over_sets(&cells).iter().all(|model| model.sets.len() <= 6));
}

/// A folder that is removed with its owner.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A copy of a set whose files are changed.
fn changed(change: impl FnOnce(&Path)) -> (Folder, PathBuf) {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = Folder(std::env::temp_dir().join(format!("gearloss-corpus-{}-{number}", std::process::id())));
    let set = folder.0.join("trb_32216_axial");
    fs::create_dir_all(&set).unwrap();
    for entry in fs::read_dir(file("corpus/trb_32216_axial")).unwrap() {
        let from = entry.unwrap().path();
        fs::copy(&from, set.join(from.file_name().unwrap())).unwrap();
    }
    change(&set);
    (folder, set)
}

fn replace(set: &Path, name: &str, from: &str, to: &str) {
    let text = fs::read_to_string(set.join(name)).unwrap();
    assert!(text.contains(from), "{name}: {from}");
    fs::write(set.join(name), text.replacen(from, to, 1)).unwrap();
}

/// What `check` says about a changed copy of a set.
fn refused(change: impl FnOnce(&Path)) -> String {
    let (_folder, set) = changed(change);
    let output = Command::cargo_bin("gearloss")
        .unwrap()
        .arg("check")
        .arg(&set)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("= help: ") && text.contains("error[E"), "{text}");
    text
}

#[test]
fn a_wrong_unit_is_refused_at_its_cell() {
    let text = refused(|set| replace(set, "data.csv", "N mm", "N m"));
    assert!(
        text.contains("`friction_torque` is in `N m` here, but the source states `N mm`"),
        "{text}"
    );
    assert!(text.contains("data.csv:2:16"), "{text}");
}

#[test]
fn numbers_in_another_unit_than_stated_are_refused() {
    // Written in N m while both places say N mm.
    let text = refused(|set| replace(set, "data.csv", "2950", "2.95"));
    assert!(
        text.contains("2.95 N mm of `friction_torque` is outside 1300 to 3750 N mm"),
        "{text}"
    );
    assert!(text.contains("data.csv:4:"), "{text}");
}

#[test]
fn a_swapped_column_is_refused() {
    let names = refused(|set| replace(set, "data.csv", "axial_load,radial_load", "radial_load,axial_load"));
    assert!(
        names.contains("column 2 is `radial_load`, but the source states `axial_load` there"),
        "{names}"
    );
    // The names stay, the numbers of two columns change places.
    let numbers = refused(|set| {
        for speed in ["500", "2000", "4000"] {
            replace(
                set,
                "data.csv",
                &format!("{speed},6000,0,50"),
                &format!("{speed},0,6000,50"),
            );
        }
        replace(set, "data.csv", "500,6000,0,42", "500,0,6000,42");
    });
    assert!(
        numbers.contains("of `axial_load` is outside 6000 to 6000 N"),
        "{numbers}"
    );
    assert!(numbers.contains("is it not swapped with another?"), "{numbers}");
}

#[test]
fn an_incomplete_source_is_refused() {
    let text = refused(|set| replace(set, "source.md", "licence: ", "# licence: "));
    assert!(
        text.contains("`licence` is missing") && text.contains("source.md"),
        "{text}"
    );
    let text = refused(|set| replace(set, "source.md", "kind: measured", "kind: guessed"));
    assert!(text.contains("source.md:4:7"), "{text}");
    let text = refused(|set| {
        let source = fs::read_to_string(set.join("source.md")).unwrap();
        let end = source.find("\n# Tapered").unwrap();
        fs::write(set.join("source.md"), &source[..end]).unwrap();
    });
    assert!(text.contains("there are no words behind the record"), "{text}");
    let text = refused(|set| fs::write(set.join("source.md"), "Measured by somebody.\n").unwrap());
    assert!(text.contains("there is no record of the source"), "{text}");
    let text = refused(|set| replace(set, "source.md", "from: 42, to: 50, what", "from: 42, what"));
    assert!(
        text.contains("a column of numbers needs `unit`, `from` and `to`"),
        "{text}"
    );
    let text = refused(|set| fs::remove_file(set.join("data.csv")).unwrap());
    assert!(text.contains("there is no data.csv"), "{text}");
    let text = refused(|set| replace(set, "source.md", "trust: low", "trust: low\nseen: [bearing/sfk]"));
    assert!(text.contains("skf"), "{text}");
}

#[test]
fn a_set_judges_models_or_says_what_it_needs() {
    let text = refused(|set| fs::remove_file(set.join("study.yaml")).unwrap());
    assert!(text.contains("there is no study.yaml that judges models"), "{text}");
    let text = refused(|set| replace(set, "source.md", "trust: low", "trust: low\nneeds: nothing"));
    assert!(text.contains("a set with a study needs nothing"), "{text}");
    let text = refused(|set| replace(set, "study.yaml", "mechanism: bearing", "mechanism: bearings"));
    assert!(text.contains("study.yaml"), "{text}");
}

/// The laws of the oil, as a data sheet has it: viscosities at 40 and 100 degC come out of the law that goes through them.
#[test]
fn laws_of_oils_are_judged_and_their_tables_are_checked() {
    let gearbox = "gearloss: gearbox/1
ports: { input: shaft }
shafts: { shaft: { axis: [0 mm, 0 mm] , bearings: none } }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s }, density: { value: 880 kg/m3, at: 15 degC } } }
thermal: { mode: fixed, oil: 40 degC }
";
    let study = |analyses: &str| {
        format!("gearloss: study/1\ngearboxes: {{ oils: gearbox.yaml }}\nanalyses: {{ {analyses} }}\n")
    };
    let run =
        |analyses: &str, table: &str| run_texts(&study(analyses), &[("gearbox.yaml", gearbox), ("oil.csv", table)]);
    let viscosity = "oil: { type: oil_property, property: kinematic_viscosity, file: oil.csv, accuracy: 2 % }";
    let table = "temperature,kinematic_viscosity\ndegC,mm2/s\n40,100\n100,11\n";
    let ran = run(viscosity, table);
    assert!(ran.succeeded, "{}", ran.text);
    let found = ran.json("oil")["oil_property"].clone();
    assert_eq!(found["laws"].as_array().unwrap().len(), 4);
    for law in found["laws"].as_array().unwrap() {
        let ratio = law["all"]["ratio"].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 1e-3 && law["all"]["in_band"] == 1.0, "{law}");
    }
    let refused = |analyses: &str, table: &str| {
        let ran = run(analyses, table);
        assert!(!ran.succeeded && ran.text.contains("= help: "), "{}", ran.text);
        ran.text
    };
    let unit = refused(viscosity, &table.replace("mm2/s", "mPa s"));
    assert!(unit.contains("`kinematic_viscosity` is in `mPa s`"), "{unit}");
    let oil = refused(
        viscosity,
        "oil,temperature,kinematic_viscosity\n-,degC,mm2/s\noli,40,100\n",
    );
    assert!(
        oil.contains("line 3: there is no lubricant `oli`") && oil.contains("write `oil`"),
        "{oil}"
    );
    let column = refused(&viscosity.replace("kinematic_viscosity", "density"), table);
    assert!(column.contains("no column `density`"), "{column}");
    let file = refused(&viscosity.replace("oil.csv", "oils.csv"), table);
    assert!(file.contains("oils.csv: cannot read"), "{file}");
}

#[test]
fn a_set_that_cannot_run_fails_the_run() {
    let (folder, _set) = changed(|set| {
        // A load that no model can carry at this speed is no reason to leave the set out in silence.
        replace(
            set,
            "study.yaml",
            "    mechanism: bearing",
            "    mechanism: bearing\n    models: { faulty: { type: formula, formula: \"sqrt(-1)\" } }",
        );
    });
    let mut command = Command::cargo_bin("gearloss").unwrap();
    let output = command.arg("validate").arg("--corpus").arg(&folder.0).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("analyses.bearings.models.faulty"), "{text}");
}

#[test]
fn validate_judges_a_users_own_folder() {
    let (folder, _set) = changed(|_| {});
    let validate = |name: &str| {
        let mut command = Command::cargo_bin("gearloss").unwrap();
        command
            .args(["validate", name, "--corpus"])
            .arg(&folder.0)
            .output()
            .unwrap()
    };
    let output = validate("trb_32216_axial");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && text.contains("trb_32216_axial  measured"),
        "{text}"
    );
    for name in ["validation.html", "validation.md", "cells.csv"] {
        assert!(folder.0.join("results").join(name).is_file(), "{name}");
    }
    let page = fs::read_to_string(folder.0.join("results/validation.html")).unwrap();
    assert!(page.contains("model by model"), "small multiples");
    let other = validate("trb_32216_axal");
    let text = String::from_utf8(other.stderr).unwrap();
    assert!(
        other.status.code() == Some(2) && text.contains("write `trb_32216_axial`"),
        "{text}"
    );
}

/// A bearing alone, and losses that `iso14179_2` itself gave, times a factor.
fn judged(factor: f64, more: &str) -> serde_json::Value {
    let gearbox = "gearloss: gearbox/1
title: A bearing alone
ports: { input: shaft }
shafts: { shaft: { axis: [0 mm, 0 mm], loads: [{ at: 0 mm, force: [0 N, 2000 N, 0 N] }] } }
bearings: { B: { shaft: shaft, at: 0 mm, designation: \"6208\", takes_moment: true } }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s } } }
thermal: { mode: fixed, oil: 60 degC }
models: { bearing: { type: iso14179_2 } }
";
    let first = run_texts(
        "gearloss: study/1
gearboxes: { bearing: gearbox.yaml }
analyses: { own: { type: spin_loss, speed: [500 rpm, 1500 rpm, 3000 rpm], by: component } }
",
        &[("gearbox.yaml", gearbox)],
    );
    let spin = first.json("own");
    let mut data = "speed [rpm],loss [W]\n".to_owned();
    for point in spin["breakdowns"][0]["points"].as_array().unwrap() {
        data += &format!(
            "{},{}\n",
            point["speed_rpm"],
            factor * point["losses_w"][0].as_f64().unwrap_or_else(|| panic!("{point:#}"))
        );
    }
    let study = format!(
        "gearloss: study/1
gearboxes: {{ bearing: gearbox.yaml }}
measurements: {{ set: {{ file: data.csv, constants: {{ torque: 0 Nm }}, stated_as: standard{more} }} }}
analyses:
  judged:
    type: validation
    data: set
    mechanism: bearing
    inputs: [{{ path: lubricants.oil.viscosity.factor, from: 0.8, to: 1.25 }}]
    samples: 32
"
    );
    let ran = run_texts(&study, &[("gearbox.yaml", gearbox), ("data.csv", &data)]);
    assert!(ran.succeeded, "{}", ran.text);
    ran.json("judged")["validation"].clone()
}

fn model<'v>(found: &'v serde_json::Value, name: &str) -> &'v serde_json::Value {
    let all = found["models"].as_array().unwrap();
    all.iter()
        .find(|model| model["name"] == name)
        .unwrap_or_else(|| panic!("{found:#}"))
}

#[test]
fn the_law_that_made_the_data_is_exact_and_twice_the_data_is_half() {
    for factor in [1.0, 2.0] {
        let found = judged(factor, "");
        let own = &model(&found, "iso14179_2")["all"];
        let near = |key: &str, value: f64| (own[key].as_f64().unwrap() - value).abs() < 1e-6;
        assert!(
            near("ratio", 1.0 / factor) && near("bias_percent", 100.0 / factor - 100.0),
            "{own:#}"
        );
        assert_eq!(
            own["in_band"].as_f64(),
            Some(if factor == 1.0 { 1.0 } else { 0.0 }),
            "{own:#}"
        );
        if factor == 1.0 {
            assert_eq!(found["models"][0]["name"], "iso14179_2", "the closest is first");
        }
    }
}

#[test]
fn an_inaccurate_measurement_widens_the_band() {
    let width = |more: &str| {
        let found = judged(1.0, more);
        let band = model(&found, "iso14179_2")["at"][0]["band"].clone();
        band[1].as_f64().unwrap() - band[0].as_f64().unwrap()
    };
    assert!(width(", accuracies: { loss: { percent_of_reading: 20 } }") > 2.0 * width(""));
}
