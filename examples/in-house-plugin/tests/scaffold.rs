//! A crate that `new plugin` writes compiles, and one test is left to its author.
#![allow(clippy::unwrap_used)]

mod common;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of this crate's own build.
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

/// A new crate on the gearloss of the repository; none where this crate stands alone.
fn scaffold(name: &str) -> Option<PathBuf> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = package.join("../..");
    if !root.join("framework/core/Cargo.toml").is_file() {
        common::skipped(
            "new plugin is not tested: there is no ../../framework/core/Cargo.toml to build a new crate on",
        );
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
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

/// How a new crate is compiled and used.
trait Build {
    fn home(&self) -> &Path;
    /// Compiles the crate and runs its tests. Returns what was printed, and whether all passed.
    fn test(&self) -> (String, bool);
    /// Runs its program.
    fn run(&self, args: &[&str]) -> Output;

    /// What a command of its program prints, which must end well.
    fn program(&self, args: &[&str]) -> String {
        let output = self.run(args);
        assert!(output.status.success(), "{args:?}: {}", said(&output));
        String::from_utf8(output.stdout).unwrap()
    }
}

/// As its author does it. Cargo compiles the libraries once more, because the crate is a workspace of its own.
struct WithCargo(PathBuf);

impl Build for WithCargo {
    fn home(&self) -> &Path {
        &self.0
    }

    fn test(&self) -> (String, bool) {
        let tested = cargo(&self.0, &["test", "--offline", "--no-fail-fast"]);
        (said(&tested), tested.status.success())
    }

    fn run(&self, args: &[&str]) -> Output {
        cargo(&self.0, &[&["run", "--offline", "--quiet", "--"][..], args].concat())
    }
}

/// With the compiler and the libraries of this crate. They are compiled already if it was built together with its workspace.
struct WithCompiler {
    home: PathBuf,
    libraries: Vec<String>,
}

impl WithCompiler {
    fn new(home: PathBuf) -> Self {
        let package = Path::new(env!("CARGO_MANIFEST_DIR"));
        let built = cargo(package, &["build", "--offline", "--lib", "--message-format", "json"]);
        assert!(built.status.success(), "{}", said(&built));
        let text = String::from_utf8(built.stdout).unwrap();
        let messages: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let library = |name: &str| {
            let of_name = messages.iter().filter(|message| message["target"]["name"] == name);
            let files = of_name.flat_map(|message| message["filenames"].as_array().unwrap());
            let libraries: Vec<&str> = files
                .filter_map(|file| file.as_str().filter(|file| file.ends_with(".rlib")))
                .collect();
            assert_eq!(libraries.len(), 1, "{name}: {libraries:?}");
            libraries[0].to_owned()
        };
        let names = ["gearloss", "gearloss_framework", "schemars", "serde"];
        let mut libraries = names.map(|name| format!("--extern={name}={}", library(name))).to_vec();
        let serde = library("serde");
        let dependencies = Path::new(&serde).parent().unwrap();
        libraries.push(format!("-Ldependency={}", dependencies.display()));
        libraries.push(format!(
            "--extern=acme_losses={}",
            home.join("libacme_losses.rlib").display()
        ));
        Self { home, libraries }
    }

    /// A command in the folder of the crate, with the environment that Cargo gives it.
    fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(program);
        command
            .current_dir(&self.home)
            .env("CARGO_PKG_NAME", "acme-losses")
            .env("CARGO_PKG_VERSION", "0.1.0")
            .env("CARGO_MANIFEST_DIR", &self.home);
        command
    }

    /// Compiles library, tests and program. Returns the messages, and whether there were no errors.
    fn compile(&self) -> (String, bool) {
        let outputs = [
            &["src/lib.rs", "--crate-name=acme_losses", "--crate-type=lib"][..],
            &["src/lib.rs", "--crate-name=acme_losses", "--test", "-o", "unit"],
            &["tests/conformance.rs", "--test", "-o", "conformance"],
            &["src/main.rs", "--crate-name=program", "-o", "program"],
        ]
        .map(|args| {
            self.command(std::env::var_os("RUSTC").unwrap_or("rustc".into()))
                .arg("--edition=2024")
                .args(&self.libraries)
                .args(args)
                .output()
                .unwrap()
        });
        together(&outputs)
    }
}

/// What commands printed, and whether all succeeded.
fn together(outputs: &[Output]) -> (String, bool) {
    let succeeded = outputs.iter().all(|output| output.status.success());
    (outputs.iter().map(said).collect(), succeeded)
}

impl Build for WithCompiler {
    fn home(&self) -> &Path {
        &self.home
    }

    fn test(&self) -> (String, bool) {
        let (messages, compiled) = self.compile();
        assert!(compiled, "{messages}");
        let run = ["unit", "conformance"].map(|test| self.command(self.home.join(test)).output().unwrap());
        let (results, passed) = together(&run);
        (messages + &results, passed)
    }

    fn run(&self, args: &[&str]) -> Output {
        self.command(self.home.join("program")).args(args).output().unwrap()
    }
}

/// A test is left to the author, says what to do, and passes when it is done; then the model can be used.
fn leaves_one_check_value_to_its_author(build: &impl Build) {
    let (first, _) = build.test();
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
    let file = build.home().join("src/my_bearing.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text.matches("by_hand = 0.0;").count(), 1);
    let write = |by_hand: &str| std::fs::write(&file, text.replace("by_hand = 0.0;", by_hand)).unwrap();
    write("by_hand = 0.036;");
    let (wrong, _) = build.test();
    assert!(wrong.contains("is not 0.036 within"), "{wrong}");
    write(&format!("by_hand = {told};"));
    let (last, passed) = build.test();
    assert!(passed, "{last}");

    assert!(
        build
            .program(&["check", "gearbox.yaml"])
            .starts_with("gearbox.yaml: fine")
    );
    let list = build.program(&["models"]);
    let line = list.lines().find(|line| line.contains("my_bearing")).unwrap();
    assert!(line.contains("acme-losses"), "{line}");
    let point = ["--torque", "20 Nm", "--speed", "1500 rpm"];
    let explained = build.program(&[&["explain", "gearbox.yaml", "P1"][..], &point].concat());
    assert!(
        explained.contains("M_0 = ") && explained.contains("in-house law"),
        "{explained}"
    );
    assert!(build.program(&["schema", "gearbox"]).contains("\"my_bearing\""));
    assert!(build.program(&["eval", "bearing/my_bearing"]).contains("M_1"));
}

#[test]
#[ignore = "compiles for most of a minute; a stage of `.ci/full`"]
fn a_new_crate_compiles_and_leaves_one_check_value_to_its_author() {
    let Some(home) = scaffold("scaffold") else { return };
    // Its manifest is read by Cargo, and names libraries that exist.
    let tree = cargo(
        &home,
        &[
            "tree",
            "--offline",
            "--depth",
            "1",
            "--edges",
            "normal",
            "--prefix",
            "none",
        ],
    );
    let libraries = String::from_utf8_lossy(&tree.stdout).into_owned();
    assert!(
        tree.status.success() && libraries.starts_with("acme-losses v0.1.0"),
        "{}",
        said(&tree)
    );
    for library in ["gearloss v", "gearloss-framework v", "schemars v", "serde v"] {
        assert!(libraries.lines().any(|line| line.starts_with(library)), "{libraries}");
    }
    leaves_one_check_value_to_its_author(&WithCompiler::new(home));
}

/// As its author does it: Cargo compiles all libraries once more, in minutes.
#[test]
fn a_new_crate_builds_with_cargo() {
    if std::env::var_os("FULL").is_none() {
        return common::skipped(
            "the new crate is not built by Cargo: `FULL=1 cargo test -p in-house-plugin --test scaffold` does it",
        );
    }
    let Some(home) = scaffold("scaffold-with-cargo") else {
        return;
    };
    leaves_one_check_value_to_its_author(&WithCargo(home));
}
