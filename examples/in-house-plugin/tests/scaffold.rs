//! A crate that `new plugin` writes compiles, and one test is left to its author.
#![allow(clippy::unwrap_used)]

mod common;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of this crate's own build, whose dependencies are those of the new crate too.
fn target() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap()
}

fn cargo(home: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO"))
        .current_dir(home)
        .env("CARGO_TARGET_DIR", target())
        .args(args)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// What a command of the program prints, which must end well.
fn program(home: &Path, args: &[&str]) -> String {
    let output = cargo(home, &[&["run", "--offline", "--quiet", "--"][..], args].concat());
    assert!(output.status.success(), "{args:?}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// A new crate on the gearloss of the repository; none where this crate stands alone.
fn scaffold() -> Option<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = own.join("../..");
    if !root.join("framework/core/Cargo.toml").is_file() {
        common::skipped(
            "new plugin is not tested: there is no ../../framework/core/Cargo.toml to build a new crate on",
        );
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scaffold");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let written = Command::new(env!("CARGO_BIN_EXE_in-house-plugin"))
        .current_dir(&folder)
        .args(["new", "plugin", "acme-losses", "--gearloss"])
        .arg(root.canonicalize().unwrap())
        .output()
        .unwrap();
    assert!(written.status.success(), "{}", said(&written));
    let home = folder.join("acme-losses");
    std::fs::copy(root.join("Cargo.lock"), home.join("Cargo.lock")).unwrap();
    Some(home)
}

#[test]
fn a_new_crate_compiles_and_leaves_one_check_value_to_its_author() {
    let Some(home) = scaffold() else { return };
    let tests = ["test", "--offline", "--no-fail-fast"];

    let first = said(&cargo(&home, &tests));
    assert!(!first.contains("warning"), "{first}");
    let verdicts = |said: &str| said.lines().filter(|line| line.ends_with("... FAILED")).count();
    assert_eq!(verdicts(&first), 1, "{first}");
    assert!(first.contains("test all_models_conform ... ok"), "{first}");
    assert!(
        first.contains("TODO in src/my_bearing.rs") && first.contains("replace 0.0"),
        "{first}"
    );

    // By hand: 1e-7 * 2 * 400 * 60^3 = 17.28 N mm of oil, 3e-4 * 1000 * 60 = 18 N mm of load.
    let told = first
        .split("The code returns ")
        .nth(1)
        .unwrap()
        .split(" Nm")
        .next()
        .unwrap();
    assert_eq!(told, "0.035280", "{first}");
    let file = home.join("src/my_bearing.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text.matches("by_hand = 0.0;").count(), 1);
    let write = |by_hand: &str| std::fs::write(&file, text.replace("by_hand = 0.0;", by_hand)).unwrap();
    write("by_hand = 0.036;");
    let wrong = said(&cargo(&home, &tests));
    assert!(wrong.contains("is not 0.036 within"), "{wrong}");
    write(&format!("by_hand = {told};"));
    let last = cargo(&home, &tests);
    assert!(last.status.success(), "{}", said(&last));

    assert!(program(&home, &["check", "gearbox.yaml"]).starts_with("gearbox.yaml: fine"));
    let list = program(&home, &["models"]);
    let line = list.lines().find(|line| line.contains("my_bearing")).unwrap();
    assert!(line.contains("acme-losses"), "{line}");
    let point = ["--torque", "20 Nm", "--speed", "1500 rpm"];
    let explained = program(&home, &[&["explain", "gearbox.yaml", "P1"][..], &point].concat());
    assert!(
        explained.contains("M_0 = ") && explained.contains("in-house law"),
        "{explained}"
    );
    assert!(program(&home, &["schema", "gearbox"]).contains("\"my_bearing\""));
    assert!(program(&home, &["eval", "bearing/my_bearing"]).contains("M_1"));
}
