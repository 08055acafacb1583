//! The report of a study. `browser.rs` opens it in a browser.

use crate::common;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The report of a study.
fn report(study: &'static str) -> PathBuf {
    common::study_run(study).folder.join("report.html")
}

/// Every analysis of both examples with its pictures, its words, the gearbox and the study behind it; nothing from a network.
#[test]
fn the_report_holds_everything_and_needs_no_network() {
    for (study, words) in [
        (
            "examples/two-speed-ev/study.yaml",
            [
                "rig_fit",
                "\"loss torque\"",
                "alpha_wt",
                "only the centre distances are printed",
            ],
        ),
        (
            "examples/planetary-reducer/study.yaml",
            [
                "twelve tests",
                "\"oil temperature\"",
                "planet_ring",
                "placeholder generated with the model",
            ],
        ),
    ] {
        let page = std::fs::read_to_string(report(study)).unwrap();
        for word in words {
            assert!(page.contains(word), "{study}: {word}");
        }
        // Nothing of the page loads anything.
        let linked = page.replace("<link rel=\"icon\" href=\"data:,\">", "");
        assert!(!page.contains("<script src") && !linked.contains("<link"), "{study}");
        assert!(page.contains("gearloss: study") && page.contains("Resolved description"));
        let pictures = page.matches("data-picture=").count();
        assert!(pictures >= 10, "{study}: {pictures} pictures");
    }
}

#[test]
fn two_products_stand_side_by_side() {
    let page = report("examples/two-products/study.yaml");
    let text = std::fs::read_to_string(&page).unwrap();
    for word in [
        "Gearbox ours",
        "Gearbox theirs",
        "loss of theirs&#x2f;joint minus ours&#x2f;joint",
        "Competing product",
    ] {
        assert!(text.contains(word), "{word}");
    }
    let csv = std::fs::read_to_string(page.with_file_name("gain.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 160);
    let column = csv
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|h| h == "difference_w")
        .unwrap();
    let less = |line: &str| line.split(',').nth(column).unwrap().parse::<f64>().unwrap() < 0.0;
    assert!(
        csv.lines().skip(1).all(less),
        "thinner oil and lighter bearings lose less at every point"
    );
}

#[test]
fn a_template_of_the_user_makes_the_page() {
    let template = Path::new(env!("CARGO_TARGET_TMPDIR")).join("own.html");
    std::fs::write(&template, "{% for s in sections %}[{{ s.name }}]{% endfor %}").unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report-own");
    let _ = std::fs::remove_dir_all(&folder);
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(common::file("examples/planetary-reducer/study.yaml"))
        .args(["-o", folder.to_str().unwrap(), "--template", template.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(
        std::fs::read_to_string(folder.join("report.html")).unwrap(),
        "[tests][loaded][unloaded][limit][fastest][convergence]"
    );
}
