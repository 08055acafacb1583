//! Reports and the workbench in a browser, and the library that draws their pictures: its tests, its types, its bundles.

use crate::common;
use crate::editor::install::packages;
use serde_json::Value;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, OnceLock, PoisonError};

fn web() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("web")
}

/// The tools of `web/`; installed once.
fn tools() -> Result<(), String> {
    static TOOLS: OnceLock<Result<(), String>> = OnceLock::new();
    TOOLS.get_or_init(|| packages(&web())).clone()
}

/// Says past the capture of the test runner, so that everybody sees it, what was not tested.
fn skipped(what: &str) {
    let words = format!("SKIPPED: {what}\n");
    std::io::stderr().write_all(words.as_bytes()).unwrap();
}

/// Runs a script; one browser at a time, because they disturb each other's storage on a busy machine.
fn node(arguments: &[&str], browser: Option<&str>) -> Output {
    static BROWSER: Mutex<()> = Mutex::new(());
    let _alone = browser.map(|_| BROWSER.lock().unwrap_or_else(PoisonError::into_inner));
    let mut command = Command::new("node");
    command.args(arguments).current_dir(web());
    if let Some(browser) = browser {
        command
            .env("BROWSER", browser)
            .env("PROGRAM", env!("CARGO_BIN_EXE_gearloss"));
    }
    command.output().unwrap()
}

/// Path of a browser; `None` if there is none.
fn browser() -> Option<String> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let path = std::env::var_os("PATH")?;
    let places = std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name)));
    places
        .into_iter()
        .find(|file| file.is_file())
        .map(|file| file.display().to_string())
}

/// Every picture is drawn; tabs, slider, sorting, tooltips and dark colours work; nothing is requested, nothing complained about; axe finds
/// nothing serious; the page fits 500 px. `web/test/page.mjs` says what fails.
#[test]
fn a_report_works_in_a_browser() {
    // Most pages on A4.
    reports_work(&[("examples/planetary-reducer/study.yaml", 6)]);
}

/// Reports with maps of several sets, and of many sections.
#[test]
#[ignore = "takes minutes; a stage of `.ci/full`"]
fn long_reports_work_in_a_browser() {
    reports_work(&[
        ("examples/two-products/study.yaml", 6),
        ("examples/two-speed-ev/study.yaml", 26),
    ]);
}

/// Names have no place on an axis: a sweep over them has bars for loss, temperature and limits.
#[test]
fn a_sweep_over_names_is_bars_in_a_browser() {
    if let Err(reason) = tools() {
        return skipped(&format!("no report was opened: {reason}"));
    }
    let Some(browser) = browser() else {
        return skipped("no report was opened: no browser; on Debian `apt-get install chromium` brings one");
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("names");
    std::fs::create_dir_all(&folder).unwrap();
    let names = "mineral, polyalphaolefin, polyglycol";
    let study = format!(
        "gearloss: study/1
gearboxes: {{ reducer: {}/examples/planetary-reducer/gearbox.yaml }}
limits: {{ life: {{ quantity: rating, rating: iso_281.L10h, of: bearings.O2, least: 20000 h }} }}
analyses:
  kinds: {{ type: sweep, path: lubricants.sump.kind, values: [{names}], torque: 2 Nm, speed: 3000 rpm }}
",
        env!("CARGO_MANIFEST_DIR")
    );
    let (study_file, results) = (folder.join("study.yaml"), folder.join("results"));
    std::fs::write(&study_file, study).unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    let output = run
        .arg("run")
        .arg(&study_file)
        .arg("-o")
        .arg(&results)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = results.join("report.html");
    let output = node(
        &["test/page.mjs", report.to_str().unwrap(), &format!("kinds: {names}")],
        Some(&browser),
    );
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
}

fn reports_work(most_pages: &[(&'static str, u64)]) {
    if let Err(reason) = tools() {
        return skipped(&format!("no report was opened: {reason}"));
    }
    let Some(browser) = browser() else {
        return skipped("no report was opened: no browser; on Debian `apt-get install chromium` brings one");
    };
    for &(study, pages) in most_pages {
        let report = common::study_run(study).folder.join("report.html");
        let output = node(&["test/page.mjs", report.to_str().unwrap()], Some(&browser));
        let (text, errors) = (
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr),
        );
        assert!(output.status.success(), "{study}: {text}{errors}");
        let figures: Value = serde_json::from_str(text.lines().last().unwrap_or_default()).unwrap();
        let number = |key: &str| figures[key].as_u64().unwrap_or(u64::MAX);
        assert!(number("bytes") < 2_000_000, "{study}: {figures}");
        assert!(number("pages") <= pages, "{study}: {figures}");
        assert!(
            figures["screens"].as_f64().is_some_and(|screens| screens <= 20.0),
            "{study}: {figures}"
        );
    }
}

/// From an error while one types to a gearbox from a form: `web/test/workbench.mjs` uses the page of `gearloss open` and says what fails.
#[test]
fn the_workbench_works_in_a_browser() {
    if let Err(reason) = tools() {
        return skipped(&format!("the workbench was not opened: {reason}"));
    }
    let Some(browser) = browser() else {
        return skipped("the workbench was not opened: no browser; on Debian `apt-get install chromium` brings one");
    };
    let output = node(&["test/workbench.mjs"], Some(&browser));
    let (text, errors) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{text}{errors}");
    let figures: Value = serde_json::from_str(text.lines().last().unwrap_or_default()).unwrap();
    assert!(figures["error_ms"].as_u64().is_some_and(|ms| ms > 0), "{figures}");
}

/// The committed bundles are those of the sources, whose types and tests hold.
#[test]
fn the_bundles_are_made_from_their_sources() {
    if let Err(reason) = tools() {
        return skipped(&format!("the library of pictures was not built: {reason}"));
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("web");
    std::fs::create_dir_all(&folder).unwrap();
    let to = format!("{}/", folder.display());
    for arguments in [
        &["build.mjs", &to][..],
        &["node_modules/.bin/tsc", "--noEmit"],
        &["--test", "test/unit/"],
    ] {
        let output = node(arguments, None);
        let (text, errors) = (
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr),
        );
        assert!(output.status.success(), "{arguments:?}: {text}{errors}");
    }
    for (crate_folder, name) in [
        ("report/src/html", "report.js"),
        ("report/src/html", "report.css"),
        ("workbench/src/page", "workbench.js"),
        ("workbench/src/page", "workbench.css"),
        ("workbench/src/page", "workbench.html"),
    ] {
        let made = std::fs::read(folder.join(name)).unwrap();
        let committed = std::fs::read(web().join("../framework").join(crate_folder).join(name)).unwrap();
        assert!(
            made == committed,
            "{name} differs from its sources; run `npm run build` in web/"
        );
    }
}
