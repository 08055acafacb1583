//! Cases of the trade: inputs as people who do this work have them, with the right value or the right message. A folder `NAME` beside this
//! file holds the files of a case; a test runs the program in a copy of it.

mod descriptions;
mod documents;
mod files;
mod imports;
mod losses;
mod mistakes;
mod pairs;
mod preloads;
mod units;

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::common;

/// A copy of the folder of a case, in which the program runs.
pub struct Case {
    folder: PathBuf,
}

/// What the program did.
pub struct Said {
    /// Exit code.
    pub code: Option<i32>,
    /// Everything that it printed.
    pub text: String,
}

/// The gearbox of the case, changed at some places.
pub fn changed(case: &Case, changes: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    text
}

impl Case {
    /// The folder of this name, copied. Each test takes a `purpose` of its own, because tests run side by side.
    pub fn new(name: &str, purpose: &str) -> Self {
        let source = common::file("tests/trade").join(name);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join("trade")
            .join(format!("{name}-{purpose}"));
        let _ = std::fs::remove_dir_all(&folder);
        copy(&source, &folder);
        Self { folder }
    }

    /// A file of the copy.
    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// Writes a file beside the others.
    pub fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(file), content).unwrap();
    }

    /// Runs the program in the folder.
    pub fn gearloss(&self, arguments: &[&str]) -> Said {
        self.gearloss_in(Path::new(""), arguments)
    }

    /// Runs the program in a folder inside of it.
    pub fn gearloss_in(&self, folder: &Path, arguments: &[&str]) -> Said {
        let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .current_dir(self.folder.join(folder))
            .args(arguments)
            .output()
            .unwrap();
        let text = [output.stdout, output.stderr].concat();
        Said {
            code: output.status.code(),
            text: String::from_utf8(text).unwrap(),
        }
    }

    /// Runs a study that must succeed; the result of an analysis.
    pub fn result(&self, study: &str, analysis: &str) -> Value {
        let said = self.gearloss(&["run", study, "-o", "results"]);
        assert_eq!(said.code, Some(0), "{}", said.text);
        let file = self.path(&format!("results/{analysis}.json"));
        let bytes = std::fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}\n{}", file.display(), said.text));
        serde_json::from_slice(&bytes).unwrap()
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}
