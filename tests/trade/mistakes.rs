//! Mistakes of the trade, and what happens to somebody who follows the help to the letter. A folder `mistakes/KIND/NAME` holds arguments, files
//! and, in `expected.txt`, what is printed; its folder `followed` holds the same after the help was followed: it leads to a right result or to
//! another error with help. `UPDATE=1 cargo test` writes the expected texts anew.

use std::path::{Path, PathBuf};

use super::Case;
use crate::common;

/// All cases below a folder, with the folders of followed help.
fn cases(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut folders: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .collect();
    folders.sort();
    for folder in folders {
        if folder.join("arguments.txt").is_file() {
            found.push(folder.clone());
        }
        cases(&folder, found);
    }
}

#[test]
fn followed_help_leads_to_a_right_result_or_a_clear_error() {
    let root = common::file("tests/trade/mistakes");
    let mut folders = Vec::new();
    cases(&root, &mut folders);
    let copies = Case::new("mistakes", "golden");
    let (mut wrong, mut mistakes) = (Vec::new(), 0);
    for folder in folders {
        let name = folder.strip_prefix(&root).unwrap();
        let arguments = std::fs::read_to_string(folder.join("arguments.txt")).unwrap();
        let arguments: Vec<&str> = arguments.lines().collect();
        let said = copies.gearloss_in(name, &arguments);
        let is_followed = name.ends_with("followed");
        mistakes += usize::from(!is_followed);
        let right = is_followed && said.code == Some(0);
        let helped =
            said.text.contains("help: ") || said.text.contains("tip: ") || said.text.contains("possible values");
        assert!(
            right || (said.code == Some(2) && said.text.contains("error") && helped),
            "{}: {:?}\n{}",
            name.display(),
            said.code,
            said.text
        );
        let expected = folder.join("expected.txt");
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&expected, &said.text).unwrap();
        } else if std::fs::read_to_string(&expected).unwrap_or_default() != said.text {
            wrong.push(format!("--- {} ---\n{}", name.display(), said.text));
        }
    }
    assert!(mistakes >= 40, "{mistakes} mistakes");
    assert!(
        wrong.is_empty(),
        "these differ (UPDATE=1 writes them):\n{}",
        wrong.join("\n")
    );
}
