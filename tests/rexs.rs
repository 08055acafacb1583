//! `import rexs` as a user calls it; what it makes of models is tested in `framework/exchange/tests`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{file, program::gearloss_in};

const MODEL: &str = "framework/exchange/tests/data/SEW_3-stage_cylindrical_gearbox_1.0.rexs";

/// An empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rexs").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Exit code, output and errors of the program.
fn called(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = gearloss_in(folder, args);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_model_is_imported_checked_and_run() {
    let folder = folder("run");
    let model = file(MODEL);
    let (code, out, err) = called(&folder, &["import", "rexs", model.to_str().unwrap()]);
    assert_eq!((code, err.as_str()), (0, ""));
    let model = "SEW_3-stage_cylindrical_gearbox_1.0";
    for name in [
        "gearbox.yaml",
        "study.yaml",
        "load_cases.csv",
        "gearbox.schema.json",
        "study.schema.json",
    ] {
        assert!(out.contains(&format!("wrote {model}/{name}")), "{out}");
        assert!(folder.join(model).join(name).is_file());
    }
    for text in ["Taken: ", "Missing for losses:", "Assumed:", "Not used: ", "next:"] {
        assert!(out.contains(text), "{text} is not in\n{out}");
    }
    for line in out.lines().skip_while(|line| *line != "next:").skip(1) {
        let args: Vec<&str> = line.split_whitespace().skip(1).collect();
        let (code, out, err) = called(&folder, &args);
        assert_eq!(code, 0, "{line}\n{out}{err}");
    }
    let solved = called(
        &folder,
        &[
            "solve",
            &format!("{model}/gearbox.yaml"),
            "--torque",
            "4.7246 Nm",
            "--speed",
            "1400 rpm",
        ],
    );
    assert!(solved.1.contains("output     -13.23"), "{}", solved.1);
}

#[test]
fn existing_files_are_not_overwritten() {
    let folder = folder("again");
    let model = file(MODEL);
    let args = ["import", "rexs", model.to_str().unwrap(), "-o", "here"];
    fs::create_dir_all(folder.join("here")).unwrap();
    fs::write(folder.join("here/study.yaml"), "mine").unwrap();
    let (code, _, err) = called(&folder, &args);
    assert_eq!(code, 2);
    assert!(err.contains("study.yaml exists and is not overwritten"), "{err}");
    assert_eq!(fs::read_to_string(folder.join("here/study.yaml")).unwrap(), "mine");
    assert!(
        !folder.join("here/gearbox.yaml").exists(),
        "nothing is written beside it"
    );
}

#[test]
fn a_file_that_is_no_model_is_an_input_error() {
    let folder = folder("wrong");
    let (code, _, err) = called(&folder, &["import", "rexs", "nowhere.rexs"]);
    assert!(code == 2 && err.contains("cannot read nowhere.rexs"), "{err}");
    fs::write(folder.join("a.rexs"), "<model version=\"1.4\"").unwrap();
    let (code, _, err) = called(&folder, &["import", "rexs", "a.rexs"]);
    assert!(
        code == 2 && err.contains("error[E0801]") && err.contains("a.rexs:1:"),
        "{err}"
    );
    assert!(!folder.join("a").exists());
}
