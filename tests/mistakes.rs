//! Golden cases of the command line: what the program says about wrong studies, wrong kinds of files and wrong arguments. Each folder in
//! `tests/mistakes` holds the arguments, one on a line, in `arguments.txt`, and what is printed in `expected.txt`.
//! `UPDATE=1 cargo test` writes the expected texts anew.

use crate::common;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

fn folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = std::fs::read_dir(common::file("tests/mistakes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("arguments.txt").is_file())
        .collect();
    folders.sort();
    folders
}

/// Exit code and everything that is printed; the folder of the case is the current one.
fn said(folder: &Path) -> (Option<i32>, String) {
    let arguments = std::fs::read_to_string(folder.join("arguments.txt")).unwrap();
    let output = Command::cargo_bin("gearloss")
        .unwrap()
        .current_dir(folder)
        .args(arguments.lines())
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

#[test]
fn every_mistake_gets_one_message_at_its_place_with_help() {
    let mut wrong = Vec::new();
    for folder in folders() {
        let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
        let (code, text) = said(&folder);
        assert_eq!(code, Some(2), "{name}:\n{text}");
        let errors = text.lines().filter(|line| line.starts_with("error")).count();
        assert_eq!(errors, 1, "{name} has {errors} messages:\n{text}");
        assert!(
            text.contains("help:") || text.contains("tip:"),
            "{name} gives no help:\n{text}"
        );
        let expected = folder.join("expected.txt");
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&expected, &text).unwrap();
        } else if std::fs::read_to_string(&expected).unwrap_or_default() != text {
            wrong.push(format!("--- {name} ---\n{text}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "these differ (UPDATE=1 writes them):\n{}",
        wrong.join("\n")
    );
}

#[test]
fn what_check_finds_is_what_run_refuses_in_the_same_words() {
    let folder = std::env::temp_dir().join(format!("gearloss-mistakes-{}", std::process::id()));
    let mut compared = 0;
    for case in folders() {
        let arguments = std::fs::read_to_string(case.join("arguments.txt")).unwrap();
        if arguments.trim() != "check\nstudy.yaml" {
            continue;
        }
        let (_, found) = said(&case);
        let output = Command::cargo_bin("gearloss")
            .unwrap()
            .current_dir(&case)
            .args(["run", "study.yaml", "-o"])
            .arg(&folder)
            .output()
            .unwrap();
        let refused = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", case.display());
        let text = found.trim_end();
        assert!(
            refused.contains(text),
            "{}:\n{text}\n--- run ---\n{refused}",
            case.display()
        );
        compared += 1;
    }
    let _ = std::fs::remove_dir_all(&folder);
    assert!(compared > 8, "{compared} studies");
}
