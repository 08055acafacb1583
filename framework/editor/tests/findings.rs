//! Findings of open texts.

use std::path::Path;
use std::time::Instant;

use gearloss_document::files::Disk;
use gearloss_editor::Workspace;
use gearloss_studies::engine::progress::Silent;

use super::common::{in_memory, language, opened, repository};

#[test]
fn a_finding_has_its_range_in_both_units() {
    let text = "# µ𝄞\ngearloss: gearbox/1\nshafts: { a: { mass: 3 mm } } # µ\n";
    let found = in_memory(&[("a.yaml", text)])
        .findings(Path::new("a.yaml"), &Silent)
        .unwrap();
    let finding = found.iter().find(|finding| finding.path == "shafts.a.mass").unwrap();
    let place = finding.place.as_ref().unwrap();
    assert_eq!(&text[place.range.from..place.range.to], "3 mm");
    assert_eq!(
        (place.range.start.line, place.range.start.utf16, place.range.end.utf8),
        (2, 21, 25)
    );
    assert!(finding.code.starts_with('E') && finding.help.is_some(), "{finding:?}");
}

#[test]
fn unsaved_texts_are_seen_by_the_study_that_names_them() {
    let folder = repository().join("examples/two-speed-ev");
    let study = folder.join("study.yaml");
    let text = std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap();
    let mut workspace = opened(&study, &std::fs::read_to_string(&study).unwrap());
    let before = workspace.findings(&study, &Silent).unwrap();
    workspace.open(
        folder.join("gearbox.yaml"),
        text.replacen("gear_states:", "gear_stats:", 1),
    );
    let after = workspace.findings(&study, &Silent).unwrap();
    assert!(after.len() > before.len(), "{after:?}");
    assert!(after.iter().any(|finding| {
        finding
            .place
            .as_ref()
            .is_some_and(|place| place.file.ends_with("gearbox.yaml"))
    }));
    workspace.close(folder.join("gearbox.yaml"));
    assert_eq!(workspace.findings(&study, &Silent).unwrap(), before);
}

/// Median time of repeated calls. \[ms\]
fn median(mut call: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..9)
        .map(|_| {
            let start = Instant::now();
            call();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Prints the times of docs/editors.md with `--nocapture`; the limit is generous, because machines that run tests are busy.
#[test]
#[allow(clippy::print_stdout)]
fn answers_come_within_a_key_stroke() {
    let folder = repository().join("examples/two-speed-ev");
    for (name, key) in [("gearbox.yaml", "bearings:"), ("study.yaml", "analyses:")] {
        let file = folder.join(name);
        let text = std::fs::read_to_string(&file).unwrap();
        let workspace = opened(&file, &text);
        let at = text.find(key).unwrap();
        let completion = median(|| assert!(!workspace.completion(&file, at).is_empty()));
        let hover = median(|| assert!(workspace.hover(&file, at + 1).is_some()));
        let findings = median(|| assert!(workspace.findings(&file, &Silent).is_some()));
        println!("{name}: completion {completion:.1} ms, hover {hover:.1} ms, findings {findings:.1} ms");
        assert!(
            completion < 300.0 && findings < 3000.0,
            "{completion} ms, {findings} ms"
        );
    }
}

/// Interrupted work has no result, so that no outdated findings are shown.
#[test]
fn an_interrupted_check_has_no_result() {
    use gearloss_studies::engine::progress::{Progress, Steps};
    struct Never;
    impl Progress for Never {
        fn begin(&self, label: &str, count: usize) -> Box<dyn Steps + '_> {
            Silent.begin(label, count)
        }
        fn should_continue(&self) -> bool {
            false
        }
    }
    let study = repository().join("examples/two-speed-ev/study.yaml");
    let workspace = Workspace::new(language(), Disk::shared());
    assert_eq!(workspace.findings(&study, &Never), None);
}
