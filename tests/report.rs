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
fn a_report_is_made_again_from_its_content() {
    let page = report("examples/two-products/study.yaml");
    let again = std::env::temp_dir().join(format!("gearloss-report-{}.html", std::process::id()));
    let run = |results: &std::path::Path| {
        let arguments = [Path::new("report"), results, Path::new("-o"), &again];
        Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .args(arguments)
            .output()
            .unwrap()
    };
    let output = run(page.parent().unwrap());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(std::fs::read(&again).unwrap() == std::fs::read(&page).unwrap());
    let refused = run(Path::new("examples/two-products"));
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(
        message.contains("not a folder of results") && message.contains("gearloss run"),
        "{message}"
    );
    std::fs::remove_file(again).unwrap();
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

/// A run with a template; its exit code, and what it printed about errors.
fn run_with_template(name: &str, template: &str) -> (Option<i32>, String) {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.html"));
    std::fs::write(&file, template).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("template-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(common::file("tests/trade/chain-of-shafts/study.yaml"))
        .args([
            "-q",
            "-o",
            folder.to_str().unwrap(),
            "--template",
            file.to_str().unwrap(),
        ])
        .output()
        .unwrap();
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

#[test]
fn a_template_that_needs_much_memory_is_stopped() {
    let doubled = "{% set x = namespace(t='a'*1000) %}{% for i in range(60) %}{% set x.t = x.t ~ x.t %}{% endfor %}";
    let replaced = "{% set a = 'a'*100000 %}{{ a|replace('a', a)|replace('a', a)|length }}";
    for (name, template) in [
        ("doubled", doubled),
        ("replaced", replaced),
        ("padded", "{{ '%2000000000d'|format(1) }}"),
    ] {
        let (code, text) = run_with_template(name, template);
        assert_eq!(code, Some(2), "{name}: {text}");
        assert!(
            text.contains(&format!("{name}.html: it needs more than 1 GB of memory")),
            "{text}"
        );
    }
}

#[test]
fn a_template_that_is_nested_deeply_does_not_break_the_program_off() {
    let nested = |open: &str, count: usize| open.repeat(count);
    for (name, template, codes) in [
        (
            "elif",
            format!("{{% if a %}}{}{{% endif %}}", nested("{% elif a %}", 21_000)),
            vec![0, 2],
        ),
        ("minus", format!("{{{{ {}1 }}}}", nested("-", 260_000)), vec![0, 2]),
        ("not", format!("{{{{ {}a }}}}", nested("not ", 20_000)), vec![0, 2]),
        (
            "long_elif",
            format!("{{% if a %}}{}{{% endif %}}", nested("{% elif a %}", 32_000)),
            vec![2],
        ),
        ("long_not", format!("{{{{ {}a }}}}", nested("not ", 128_000)), vec![2]),
    ] {
        let (code, text) = run_with_template(name, &template);
        assert!(
            codes.iter().any(|expected| code == Some(*expected)),
            "{name}: {code:?} {text}"
        );
        if codes == [2] {
            assert!(text.contains("at most 256 kB are read"), "{name}: {text}");
        }
    }
}

#[test]
fn a_fault_of_a_template_has_its_file_and_line() {
    let (code, text) = run_with_template("faulty", "one\n{% for %}\n");
    assert_eq!(code, Some(2));
    assert!(text.contains("faulty.html:2"), "{text}");
}

/// Results of analyses of one type have their titles before them, printed and in the report; that of a type of its own has none.
#[test]
fn results_of_analyses_of_one_type_are_told_apart_by_their_titles() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report-titles");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("box.yaml"), crate::drive_unit::STAGE).unwrap();
    let study = "gearloss: study/1
gearboxes: { box: box.yaml }
conditions: { oil_temperature: 60 degC }
answered_by: [slow, fast]
analyses:
  slow: { type: spin_loss, title: Idling in town, speed: 1000 rpm }
  fast: { type: spin_loss, title: Idling on the motorway, speed: 5000 rpm }
  bars: { type: breakdown, title: Under load, torque: 10 Nm, speed: 1000 rpm }
";
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(folder.join("study.yaml"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for words in ["> slow     Idling in town: ", "> fast     Idling on the motorway: "] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("Under load: "), "{text}");
    let page = std::fs::read_to_string(folder.join("results/report.html")).unwrap();
    for title in ["Idling in town", "Idling on the motorway"] {
        assert!(page.contains(&format!("<p data-words>{title}: ")), "{title}");
        assert!(page.contains(&format!("{title}</a></li>")), "{title}");
    }
}
