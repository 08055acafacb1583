//! Two versions of the framework in one program: each would contain only part of the models, so Cargo rejects them.
#![allow(clippy::unwrap_used)]

mod common;

use std::path::Path;
use std::process::Command;

#[test]
fn two_versions_of_the_framework_are_refused() {
    let framework = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../framework/core");
    if !framework.is_dir() {
        common::skipped(
            "two versions are not tested: this crate stands outside of the repository, so there is no second framework",
        );
        return;
    }
    let folder = common::folder("two-versions");
    let write = |file: &str, text: &str| {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let head = |name: &str, version: &str| {
        format!("[package]\nname = \"{name}\"\nversion = \"{version}\"\nedition = \"2024\"\n")
    };
    let another = head("gearloss-framework", "9.0.0") + "links = \"gearloss-framework\"\n";
    let both = format!(
        "[workspace]\n[dependencies]\none = {{ package = \"gearloss-framework\", path = {:?} }}\n\
         another = {{ package = \"gearloss-framework\", path = \"another\" }}\n",
        framework.canonicalize().unwrap()
    );
    write("another/Cargo.toml", &another);
    write("another/build.rs", "fn main() {}\n");
    write("another/src/lib.rs", "");
    write("src/lib.rs", "");
    write("Cargo.toml", &(head("both", "0.1.0") + &both));
    let cargo = Command::new(env!("CARGO"))
        .args(["generate-lockfile", "--offline"])
        .current_dir(&folder)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&cargo.stderr);
    assert!(!cargo.status.success(), "{told}");
    assert!(
        told.contains("Only one package in the dependency graph may specify the same links value"),
        "{told}"
    );
    assert!(told.contains("gearloss-framework v9.0.0"), "{told}");
}
