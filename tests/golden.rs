//! Golden cases: what `check` says about each input in `tests/cases`. `UPDATE=1 cargo test` writes the expected texts anew.

use crate::common;
use std::path::Path;
use std::process::Command;

use gearloss_framework::files::Disk;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_studies::checked_study::CheckedStudy;
use gearloss_studies::engine::progress::Silent;

/// Cases of more than one mistake.
const SEVERAL: [&str; 16] = [
    "anchors",
    "boolean_traps",
    "contact_faults",
    "dangling_id",
    "decimal_comma",
    "doubtful_oil_network",
    "drag_counted_twice",
    "network_unknown_gear",
    "network_unknown_nodes",
    "number_as_text",
    "oil_network_cut_off",
    "oil_network_faults",
    "out_of_range",
    "over_determined",
    "plain_bearing_faults",
    "two_locating_bearings",
];

fn verdict(language: &Language, folder: &Path) -> String {
    let text = std::fs::read_to_string(folder.join("input.yaml")).unwrap();
    // The folder is given relative, so that messages about files do not hang on where the repository lies.
    let relative = folder.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
    let built = Gearbox::of_text(language, &text, "input.yaml", relative)
        .and_then(|gearbox| gearbox.transmission(language, &Choice::default()).map(|t| (gearbox, t)));
    match built {
        Ok((gearbox, transmission)) => {
            let mut text = "fine\n".to_owned();
            for warning in &transmission.warnings {
                text.push_str(&gearbox.sources.render(warning));
                text.push('\n');
            }
            text
        }
        Err(findings) => findings.render(),
    }
}

#[test]
fn every_class_of_input_error_states_problem_place_and_fix() {
    let language = common::language();
    let mut wrong = Vec::new();
    for folder in common::cases() {
        let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
        let text = verdict(&language, &folder);
        let expected = folder.join("expected.txt");
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&expected, &text).unwrap();
        } else if std::fs::read_to_string(&expected).unwrap_or_default() != text {
            wrong.push(format!("--- {name} ---\n{text}"));
        }
        if name.starts_with("fine") {
            assert_eq!(text, "fine\n", "{name}");
            continue;
        }
        // What is only doubtful is built all the same.
        let severity = if name.starts_with("doubtful") {
            "warning"
        } else {
            "error"
        };
        assert!(text.contains(severity), "{name} is accepted:\n{text}");
        let one = text.matches(&format!("{severity}[")).count() == 1;
        assert!(
            one || SEVERAL.contains(&name.as_str()),
            "{name} is one mistake and gets several messages:\n{text}"
        );
        assert!(text.contains("help:"), "{name} does not say how to fix it:\n{text}");
    }
    assert!(
        wrong.is_empty(),
        "these differ (UPDATE=1 writes them):\n{}",
        wrong.join("\n")
    );
}

/// The plans of a study with every analysis. `UPDATE=1 cargo test` writes the text anew.
#[test]
fn every_analysis_says_what_it_computes() {
    let language = common::language();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/results");
    let checked = CheckedStudy::read(&language, &Disk::shared(), &folder.join("study.yaml"), &Silent);
    let refused: Vec<String> = checked.refused.iter().map(ToString::to_string).collect();
    assert_eq!(refused, Vec::<String>::new());
    let plans = checked.plans.iter();
    let lines = plans.flat_map(|(name, work)| work.iter().map(move |part| format!("{name}: {part}\n")));
    let text: String = lines.collect();
    let expected = folder.join("plan.txt");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&expected, &text).unwrap();
    }
    assert_eq!(text, std::fs::read_to_string(&expected).unwrap_or_default());
}

#[test]
fn a_plan_is_printed_for_a_study_and_for_a_gearbox() {
    let check = |file: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearloss"));
        command.args(["check", "--plan", file]).output().unwrap()
    };
    let study = check("examples/two-speed-ev/study.yaml");
    let text = String::from_utf8_lossy(&study.stdout).into_owned();
    assert!(study.status.success(), "{text}");
    // As docs/check.md shows it.
    for line in [
        "band: complete, first: 39578 points",
        "band: complete: another `gears.*.surface.rq` builds again: meshes.M1, meshes.M2, meshes.M3",
        "what_matters: complete: another `bearings.*.radial_factor` is set in the built models",
    ] {
        assert!(text.contains(&format!("\n  {line}\n")), "{text}");
    }
    let gearbox = check("examples/two-speed-ev/gearbox.yaml");
    let text = String::from_utf8_lossy(&gearbox.stdout).into_owned();
    // With torque at the input each mesh of the path follows from the one before.
    let (_, order) = text.split_once("  first, torques at input that drive:\n").unwrap();
    let (order, _) = order.split_once("  first, torques at input that brake:\n").unwrap();
    let once: Vec<&str> = order.lines().filter(|line| line.starts_with("    once: ")).collect();
    let looped: Vec<&str> = order.lines().filter(|line| line.starts_with("    loop: ")).collect();
    for mesh in ["meshes.M1", "meshes.M2", "meshes.M3"] {
        assert!(once.iter().any(|line| line.contains(mesh)), "{mesh}: {text}");
        let losses = looped.iter().filter_map(|line| line.split_once(" with the torque of "));
        assert!(
            !losses.clone().any(|(losses, _)| losses.contains(mesh)),
            "{mesh}: {text}"
        );
    }
}
