//! The extension of VS Code: its types, its bundle, and the server through the protocol library of that editor.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::editor::install::packages;

fn extension() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("editors/vscode")
}

#[test]
fn the_extension_is_built_and_drives_the_server() {
    if let Err(reason) = packages(&extension()) {
        // Past the capture of the test runner.
        let words = format!("SKIPPED: the extension of VS Code was not built: {reason}\n");
        return std::io::stderr().write_all(words.as_bytes()).unwrap();
    }
    for arguments in [
        &["node_modules/typescript/bin/tsc", "--noEmit"][..],
        &["build.mjs"],
        &["--test", "test/"],
    ] {
        let output = Command::new("node")
            .args(arguments)
            .current_dir(extension())
            .env("GEARLOSS", assert_cmd::cargo::cargo_bin("gearloss"))
            .output()
            .unwrap();
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        assert!(output.status.success(), "{arguments:?}: {text}");
        assert!(!text.contains("# SKIP"), "{arguments:?}: {text}");
    }
}
