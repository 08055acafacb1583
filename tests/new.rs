//! Files to start from: they run as they are, and with every option that they show.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::{language, program::gearloss_in as gearloss};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::resolve::Choice;

/// Layout, arguments of the point that the program proposes, least and greatest efficiency in percent of a usual one.
const LAYOUTS: [(&str, &[&str], [f64; 2]); 6] = [
    (
        "single-stage",
        &["--torque", "90 Nm", "--speed", "1500 rpm"],
        [98.2, 99.3],
    ),
    ("two-stage", &["--torque", "45 Nm", "--speed", "1500 rpm"], [97.0, 98.5]),
    (
        "three-stage",
        &["--torque", "15 Nm", "--speed", "1500 rpm"],
        [93.0, 96.5],
    ),
    (
        "planetary",
        &["--gear", "reducing", "--torque", "60 Nm", "--speed", "3000 rpm"],
        [97.0, 99.2],
    ),
    (
        "two-speed",
        &["--gear", "first", "--torque", "80 Nm", "--speed", "3000 rpm"],
        [98.2, 99.4],
    ),
    (
        "dual-countershaft",
        &["--torque", "400 Nm", "--speed", "1500 rpm"],
        [97.5, 99.0],
    ),
];

/// The same of layouts with axes that cross.
const CROSSED: [(&str, &[&str], [f64; 2]); 3] = [
    (
        "bevel-helical",
        &["--torque", "45 Nm", "--speed", "1500 rpm"],
        [94.0, 97.0],
    ),
    ("worm", &["--torque", "18 Nm", "--speed", "1500 rpm"], [82.0, 90.0]),
    ("axle", &["--torque", "150 Nm", "--speed", "1500 rpm"], [95.0, 98.0]),
];

fn out(folder: &Path, args: &[&str]) -> String {
    let output = gearloss(folder, args);
    let wrong = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && wrong.is_empty(), "{args:?}: {wrong}");
    String::from_utf8(output.stdout).unwrap()
}

fn refused(folder: &Path, args: &[&str]) -> String {
    let output = gearloss(folder, args);
    assert_eq!(output.status.code(), Some(2), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// A new empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("new").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Lines that are options: `#` and a key right behind it.
fn is_option(line: &str) -> bool {
    line.trim_start()
        .strip_prefix('#')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_lowercase()))
}

/// The text with the options of some lines taken in.
fn with(text: &str, taken: &BTreeSet<usize>) -> String {
    text.lines()
        .enumerate()
        .map(|(i, line)| {
            if taken.contains(&i) {
                line.replacen('#', "", 1) + "\n"
            } else {
                line.to_owned() + "\n"
            }
        })
        .collect()
}

/// Runs of options on neighbouring lines, which belong together, and last all options of the text.
fn choices(text: &str) -> Vec<BTreeSet<usize>> {
    let mut runs: Vec<BTreeSet<usize>> = Vec::new();
    for (i, _) in text.lines().enumerate().filter(|(_, line)| is_option(line)) {
        match runs.last_mut() {
            Some(run) if i > 0 && run.contains(&(i - 1)) => {
                run.insert(i);
            }
            _ => runs.push(BTreeSet::from([i])),
        }
    }
    let all = runs.iter().flatten().copied().collect();
    runs.push(all);
    runs
}

fn built(language: &Language, text: &str) {
    let gearbox = Gearbox::of_text(language, text, "gearbox.yaml", ".").unwrap_or_else(|e| panic!("{}", e.render()));
    let transmission = gearbox
        .transmission(language, &Choice::default())
        .unwrap_or_else(|e| panic!("{}", e.render()));
    let warnings: Vec<String> = transmission
        .warnings
        .iter()
        .map(|w| gearbox.sources.render(w))
        .collect();
    assert!(warnings.is_empty(), "{warnings:?}");
}

fn efficiency(folder: &Path, point: &[&str], more: &[&str]) -> f64 {
    let args = [&["solve", "gearbox.yaml", "--format", "json"][..], point, more].concat();
    let solved: serde_json::Value = serde_json::from_str(&out(folder, &args)).unwrap();
    assert_eq!(solved["status"], "drive", "{args:?}");
    100.0 * solved["efficiency"].as_f64().unwrap()
}

/// Writes the gearbox of a layout, which is fine; what is proposed is what is tested.
fn create(folder: &Path, layout: &str, point: &[&str]) {
    let told = out(folder, &["new", "gearbox", layout]);
    let proposed = told.lines().find(|line| line.contains("gearloss solve")).unwrap();
    assert_eq!(
        proposed.replace('"', "").trim(),
        format!("gearloss solve gearbox.yaml {}", point.join(" "))
    );
    let checked = out(folder, &["check", "gearbox.yaml"]);
    assert!(
        checked.starts_with("gearbox.yaml: fine") && !checked.contains("warning"),
        "{checked}"
    );
}

#[test]
fn every_layout_checks_and_loses_what_such_gearboxes_lose() {
    for (layout, point, [least, greatest]) in LAYOUTS {
        let folder = folder(&format!("checks-{layout}"));
        create(&folder, layout, point);
        for set in [&[][..], &["--models", "iso14179_2"], &["--models", "joint"]] {
            let found = efficiency(&folder, point, set);
            assert!(found > least && found < greatest, "{layout} {set:?}: {found}");
        }
    }
}

/// The shipped model sets have no drag of worms, so these layouts are solved with their own models.
#[test]
fn every_layout_with_axes_that_cross_is_fine_and_maps() {
    for (layout, point, [least, greatest]) in CROSSED {
        let folder = folder(&format!("crossed-{layout}"));
        create(&folder, layout, point);
        let found = efficiency(&folder, point, &[]);
        assert!(found > least && found < greatest, "{layout}: {found}");
        out(&folder, &["new", "study"]);
        assert_eq!(out(&folder, &["check", "study.yaml"]), "study.yaml: fine\n");
        out(&folder, &["run", "study.yaml"]);
        for result in ["maps.csv", "stack.csv", "spin.csv", "report.html"] {
            assert!(folder.join("results").join(result).is_file(), "{layout}: {result}");
        }
        let maps = std::fs::read_to_string(folder.join("results/maps.csv")).unwrap();
        assert!(maps.lines().skip(1).all(|line| line.contains(",drive,")), "{maps}");
    }
}

#[test]
fn every_option_of_a_gearbox_is_valid_alone_and_with_all_others() {
    let language = language();
    for (layout, point, _) in LAYOUTS.into_iter().chain(CROSSED) {
        let folder = folder(&format!("options-{layout}"));
        out(&folder, &["new", "gearbox", layout]);
        let text = std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap();
        let choices = choices(&text);
        assert!(choices.len() > 6, "{layout}: {} options", choices.len());
        for taken in &choices {
            built(&language, &with(&text, taken));
        }
        // With all options the file also has what a balance of temperature needs.
        std::fs::write(folder.join("gearbox.yaml"), with(&text, choices.last().unwrap())).unwrap();
        let args = [&["solve", "gearbox.yaml", "--set", "thermal.mode=balance"][..], point].concat();
        let solved = out(&folder, &args);
        assert!(solved.contains("converged"), "{layout}: {solved}");
    }
}

#[test]
fn the_study_runs_over_every_layout_with_and_without_its_options() {
    for (layout, ..) in LAYOUTS {
        let folder = folder(&format!("study-{layout}"));
        out(&folder, &["new", "gearbox", layout]);
        let told = out(&folder, &["new", "study"]);
        assert!(told.contains("the first that transmits torque"), "{told}");
        assert_eq!(out(&folder, &["check", "study.yaml"]), "study.yaml: fine\n");
        out(&folder, &["run", "study.yaml"]);
        for result in ["maps.csv", "models.csv", "stack.csv", "spin.csv", "report.html"] {
            assert!(folder.join("results").join(result).is_file(), "{layout}: {result}");
        }
        let text = std::fs::read_to_string(folder.join("study.yaml")).unwrap();
        let choices = choices(&text);
        assert!(choices.len() > 8, "{} options", choices.len());
        for taken in &choices {
            std::fs::write(folder.join("option.yaml"), with(&text, taken)).unwrap();
            assert_eq!(out(&folder, &["check", "option.yaml"]), "option.yaml: fine\n");
        }
        out(&folder, &["run", "option.yaml", "-o", "all"]);
        assert!(folder.join("all/contact.csv").is_file() && folder.join("all/bands.csv").is_file());
    }
}

#[test]
fn the_study_takes_the_first_state_that_drives_and_names_the_gearbox_from_where_it_stands() {
    let folder = folder("fits");
    out(&folder, &["new", "gearbox", "two-speed", "-o", "drive.yaml"]);
    let text = std::fs::read_to_string(folder.join("drive.yaml")).unwrap();
    let states = "{ first: [S1], second: [S2], neutral: [] }";
    assert!(text.contains(states));
    let text = text
        .replace(states, "{ idle: [], crawler: [S1] }")
        .replace("rating:", "#rating:");
    std::fs::write(folder.join("drive.yaml"), text).unwrap();
    std::fs::create_dir(folder.join("first look")).unwrap();
    let study = "first look/study.yaml";
    let told = out(&folder, &["new", "study", "--gearbox", "drive.yaml", "-o", study]);
    assert!(
        told.contains("gear `crawler`") && told.contains("has no `rating`"),
        "{told}"
    );
    assert!(told.contains("gearloss run 'first look/study.yaml'"), "{told}");
    let written = std::fs::read_to_string(folder.join(study)).unwrap();
    assert!(
        written.contains("gearboxes: { ours: ../drive.yaml }") && written.contains("gear: crawler"),
        "{written}"
    );
    assert!(out(&folder, &["check", study]).contains("fine"));
}

#[test]
fn a_comparison_of_sets_that_the_gearbox_does_not_fit_is_omitted_with_a_note() {
    let folder = folder("unfit");
    out(&folder, &["new", "gearbox", "single-stage"]);
    let text = std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap();
    let without: Vec<&str> = text.lines().filter(|line| !line.contains("section:")).collect();
    std::fs::write(folder.join("gearbox.yaml"), without.join("\n")).unwrap();
    let told = out(&folder, &["new", "study"]);
    assert!(
        told.contains("gearloss check gearbox.yaml --models iso14179_2"),
        "{told}"
    );
    out(&folder, &["run", "study.yaml"]);
    assert!(folder.join("results/maps.csv").is_file() && !folder.join("results/models.csv").exists());
}

#[test]
fn a_study_needs_a_gearbox_that_can_be_driven() {
    let folder = folder("no-gearbox");
    let told = refused(&folder, &["new", "study"]);
    assert!(
        told.contains("the gearbox gearbox.yaml does not exist") && told.contains("gearloss new gearbox"),
        "{told}"
    );
    out(&folder, &["new", "gearbox", "two-speed"]);
    let text = std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap();
    let idle = text.replace("{ first: [S1], second: [S2], neutral: [] }", "{ idle: [] }");
    std::fs::write(folder.join("gearbox.yaml"), idle).unwrap();
    assert!(refused(&folder, &["new", "study"]).contains("no gear is determined"));
    std::fs::write(folder.join("gearbox.yaml"), "gearloss: gearbox/1\n").unwrap();
    assert!(refused(&folder, &["new", "study"]).contains("gearbox.yaml:1"));
    assert!(!folder.join("study.yaml").exists());
}

#[test]
fn nothing_is_overwritten_and_every_refusal_says_what_to_do() {
    let folder = folder("refuses");
    std::fs::write(folder.join("gearbox.yaml"), "mine").unwrap();
    let told = refused(&folder, &["new", "gearbox", "planetary"]);
    assert!(
        told.contains("exists and is not overwritten") && told.contains("-o other.yaml"),
        "{told}"
    );
    assert_eq!(std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap(), "mine");
    assert!(!folder.join("gearbox.schema.json").exists());
    let told = refused(&folder, &["new", "gearbox", "planetary", "-o", "nowhere/a.yaml"]);
    assert!(told.contains("the folder nowhere does not exist"), "{told}");
    let told = refused(&folder, &["new", "gearbox", "planetary", "-o", "."]);
    assert!(told.contains("it is a folder"), "{told}");
    for wrong in [&["new", "gearbox", "cvt"][..], &["new", "gearbox"]] {
        let told = refused(&folder, wrong);
        for (layout, ..) in LAYOUTS {
            assert!(told.contains(layout), "{told}");
        }
    }
    assert!(refused(&folder, &["new", "gearbox"]).contains("fixed ring"));
}

#[test]
fn the_schema_that_the_first_line_names_is_written_beside_and_kept_where_it_is() {
    let folder = folder("schema");
    out(&folder, &["new", "gearbox", "planetary"]);
    let first = |file: &str| {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        text.lines().next().unwrap().rsplit_once('=').unwrap().1.to_owned()
    };
    let schema = folder.join(first("gearbox.yaml"));
    let published = serde_json::to_string_pretty(&language().published(Kind::Gearbox)).unwrap() + "\n";
    assert!(std::fs::read_to_string(&schema).unwrap() == published);
    assert!(published == out(&folder, &["schema", "gearbox"]));
    let told = out(&folder, &["new", "gearbox", "two-stage", "-o", "other.yaml"]);
    assert!(!told.contains("schema"), "{told}");
    std::fs::write(&schema, "{}").unwrap();
    let told = out(&folder, &["new", "gearbox", "two-stage", "-o", "third.yaml"]);
    assert!(told.contains("kept gearbox.schema.json"), "{told}");
    assert_eq!(std::fs::read_to_string(&schema).unwrap(), "{}");
    out(&folder, &["new", "study"]);
    assert!(folder.join(first("study.yaml")).is_file());
}

/// The lines of a new crate's Cargo.toml that begin with `name =`.
fn dependency(home: &Path, name: &str) -> String {
    let manifest = std::fs::read_to_string(home.join("Cargo.toml")).unwrap();
    let line = manifest.lines().find(|line| line.starts_with(&format!("{name} = ")));
    line.unwrap().to_owned()
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

#[test]
fn a_crate_for_models_is_written_whole() {
    let folder = folder("plugin");
    let told = out(&folder, &["new", "plugin", "acme-losses"]);
    let home = folder.join("acme-losses");
    for file in [
        "Cargo.toml",
        "README.md",
        ".gitignore",
        "gearbox.yaml",
        "src/lib.rs",
        "src/main.rs",
        "src/my_bearing.rs",
        "tests/conformance.rs",
    ] {
        let text = std::fs::read_to_string(home.join(file)).unwrap();
        assert!(!text.contains('@'), "{file}: {text}");
        assert!(told.contains(file), "{told}");
    }
    let text = |file: &str| std::fs::read_to_string(home.join(file)).unwrap();
    assert!(text("Cargo.toml").contains("name = \"acme-losses\""));
    assert!(text("src/main.rs").contains("use acme_losses as _;"));
    assert!(text("tests/conformance.rs").contains("use acme_losses as _;"));
    assert!(
        told.contains("cd acme-losses") && told.contains("cargo test") && told.contains("cargo run -- explain"),
        "{told}"
    );
    // Without --gearloss: the checkout that the program was built from, which is told.
    let root = env!("CARGO_MANIFEST_DIR");
    assert!(
        told.contains(&format!("{root}, which this program was built from")),
        "{told}"
    );
    let line = dependency(&home, "gearloss-framework");
    assert!(
        line.contains(&format!("{root}/framework")) && line.contains(VERSION),
        "{line}"
    );
}

#[test]
fn a_new_crate_takes_gearloss_from_the_checkout_that_is_named() {
    let folder = folder("plugin-checkout");
    let root = env!("CARGO_MANIFEST_DIR");
    out(&folder, &["new", "plugin", "absolute", "--gearloss", root]);
    assert_eq!(
        dependency(&folder.join("absolute"), "gearloss"),
        format!("gearloss = {{ path = \"{root}\", version = \"{VERSION}\" }}")
    );
    let checkout = folder.join("gear loss");
    std::fs::create_dir_all(checkout.join("framework/core")).unwrap();
    std::fs::create_dir_all(folder.join("ours/losses")).unwrap();
    std::fs::write(checkout.join("Cargo.toml"), "").unwrap();
    let named = ["--gearloss", "gear loss"];
    let told = refused(&folder, &[&["new", "plugin", "mine"][..], &named].concat());
    assert!(
        told.contains("it has no framework/core/Cargo.toml") && !folder.join("mine").exists(),
        "{told}"
    );
    std::fs::write(checkout.join("framework/core/Cargo.toml"), "").unwrap();
    // Named from the folder of the command, written from the folder of the crate.
    for (home, way) in [("mine", "../gear loss"), ("ours/losses", "../../gear loss")] {
        let told = out(&folder, &[&["new", "plugin", "mine", "-o", home][..], &named].concat());
        assert!(told.contains(way), "{told}");
        let home = folder.join(home);
        assert_eq!(
            dependency(&home, "gearloss-framework"),
            format!("gearloss-framework = {{ path = \"{way}/framework/core\", version = \"{VERSION}\" }}")
        );
        assert!(home.join(way).join("framework/core/Cargo.toml").is_file());
    }
}

#[test]
fn a_new_crate_names_the_versions_of_the_workspace() {
    let folder = folder("plugin-versions");
    out(&folder, &["new", "plugin", "mine"]);
    let workspace = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).unwrap();
    let written = std::fs::read_to_string(folder.join("mine/Cargo.toml")).unwrap();
    for key in ["schemars = ", "serde = ", "edition = ", "rust-version = "] {
        let line = workspace.lines().find(|line| line.starts_with(key)).unwrap();
        assert!(written.lines().any(|known| known == line), "{line} in {written}");
    }
}

#[test]
fn what_cannot_name_a_crate_is_refused_with_what_to_write() {
    let folder = folder("plugin-names");
    for (name, help) in [
        ("AcmeLosses", "such as `acmelosses`"),
        ("7acme", "such as `acme`"),
        ("acme losses", "such as `acme-losses`"),
        ("../acme", "such as `acme`"),
        ("Lager_Größe", "such as `lager_gr--e`"),
        ("42", "such as `acme-losses`"),
        ("", "such as `acme-losses`"),
        ("Test", "such as `acme-losses`"),
        ("gearloss", "such as `acme-gearloss`"),
        ("gearloss-acme", "such as `acme-gearloss-acme`"),
        ("fn", "such as `acme-fn`"),
        ("test", "such as `acme-test`"),
        ("core", "such as `acme-core`"),
        ("proc-macro", "such as `acme-proc-macro`"),
        ("serde", "such as `acme-serde`"),
    ] {
        let told = refused(&folder, &["new", "plugin", name]);
        assert!(
            told.contains("cannot name a crate") && told.contains(help),
            "{name}: {told}"
        );
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_crate_is_written_into_a_new_or_an_empty_folder_only() {
    let folder = folder("plugin-folders");
    std::fs::create_dir_all(folder.join("cloned/.git")).unwrap();
    let told = out(&folder.join("cloned"), &["new", "plugin", "mine", "-o", "."]);
    assert!(!told.contains("  cd "), "{told}");
    let manifest = folder.join("cloned/Cargo.toml");
    std::fs::write(&manifest, "mine").unwrap();
    let told = refused(&folder, &["new", "plugin", "mine", "-o", "cloned"]);
    assert!(told.contains("not empty") && told.contains("-o DIR"), "{told}");
    assert_eq!(std::fs::read_to_string(&manifest).unwrap(), "mine");
    std::fs::write(folder.join("file"), "").unwrap();
    assert!(refused(&folder, &["new", "plugin", "file"]).contains("it is a file"));
    let told = refused(&folder, &["new", "plugin", "mine", "-o", "nowhere/mine"]);
    assert!(told.contains("the folder nowhere does not exist"), "{told}");
}
