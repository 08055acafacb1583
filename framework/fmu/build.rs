//! Compiles the library inside of FMUs for the target of this build, so that the program contains it.
//!
//! It is one call of the compiler, because the library has no dependencies. Where it cannot be built, an empty file takes its place and
//! a warning says so; writing an FMU then needs a library of another program.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=src/runtime");
    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("Cargo sets OUT_DIR"));
    let library = folder.join("library");
    if !has_libraries() || !(build(&library, false) || build(&library, true)) {
        println!("cargo::warning=there is no library for FMUs on this target: they need `fmu_libraries`");
        std::fs::write(&library, []).expect("OUT_DIR can be written");
    }
}

fn target(key: &str) -> String {
    env::var(format!("CARGO_CFG_TARGET_{key}")).unwrap_or_default()
}

/// Whether programs of the target load libraries: WebAssembly does not, and a static C library would be in the FMU a second time.
fn has_libraries() -> bool {
    ["linux", "macos", "windows"].contains(&target("OS").as_str()) && target("ENV") != "musl"
}

/// Compiles the library; true if it was. On Linux without the standard library, which needs a newer C library and is six times as large.
fn build(to: &Path, hosted: bool) -> bool {
    if !hosted && target("OS") != "linux" {
        return false;
    }
    let compiler = env::var_os("RUSTC").expect("Cargo sets RUSTC");
    let mut command = Command::new(compiler);
    command.args([
        "--crate-name",
        "gearloss_fmu_library",
        "--crate-type",
        "cdylib",
        "--edition",
        "2024",
    ]);
    command.args([
        "-C",
        "opt-level=s",
        "-C",
        "panic=abort",
        "-C",
        "lto=fat",
        "-C",
        "codegen-units=1",
        "-C",
        "strip=symbols",
    ]);
    command.args(["--target", &env::var("TARGET").expect("Cargo sets TARGET")]);
    if let Some(linker) = env::var_os("RUSTC_LINKER") {
        command.arg("-C").arg(format!("linker={}", linker.display()));
    }
    if hosted {
        command.args(["--cfg", "hosted"]);
    }
    // Paths of this machine are not part of the library, whose bytes are then the same everywhere.
    if let Ok(folder) = env::current_dir() {
        command.arg(format!("--remap-path-prefix={}=gearloss-fmu", folder.display()));
    }
    // Warnings appear where the same sources are checked as a part of this crate.
    command
        .args(["--cap-lints", "allow", "-o"])
        .arg(to)
        .arg("src/runtime/library.rs");
    command.status().is_ok_and(|status| status.success())
}
