//! While a document is typed, every beginning of it is a document.

use std::time::{Duration, Instant};

use gearloss_document::files::Disk;
use gearloss_editor::Workspace;
use gearloss_studies::engine::progress::Silent;

use super::common::{examples, language, opened};

/// Every how many bytes answers and findings are asked for; `FULL=1` asks for answers at every byte.
fn steps() -> [usize; 2] {
    if std::env::var_os("FULL").is_some() {
        [1, 97]
    } else {
        [7, 997]
    }
}

#[test]
fn no_beginning_of_a_gearbox_makes_the_engine_panic_or_wait() {
    type_examples("gearloss: gearbox/1");
}

#[test]
fn no_beginning_of_a_study_makes_the_engine_panic_or_wait() {
    type_examples("gearloss: study/1");
}

/// Types the examples of a kind of document.
fn type_examples(kind: &str) {
    let [step, step_of_findings] = steps();
    let mut workspace = Workspace::new(language(), Disk::shared());
    let texts = examples().into_iter().map(|file| {
        let text = std::fs::read_to_string(&file).unwrap();
        (file, text)
    });
    let of_kind: Vec<_> = texts.filter(|(_, text)| text.contains(kind)).collect();
    assert!(of_kind.len() > 10, "{kind}: {} examples", of_kind.len());
    for (file, text) in of_kind {
        for end in (0..=text.len()).step_by(step) {
            let Some(beginning) = text.get(..end) else { continue };
            workspace.open(&file, beginning);
            let start = Instant::now();
            workspace.completion(&file, end);
            workspace.hover(&file, end.saturating_sub(1));
            workspace.definition(&file, end.saturating_sub(1));
            if end % (step * 5) == 0 {
                workspace.symbols(&file);
                workspace.references(&file, end.saturating_sub(1));
                let _ = workspace.rename(&file, end.saturating_sub(1), "other");
            }
            let took = start.elapsed();
            assert!(took < Duration::from_secs(5), "{} at {end}: {took:?}", file.display());
        }
        // The cursor inside of the whole text.
        workspace.open(&file, text.as_str());
        for at in (3..=text.len()).step_by(step) {
            workspace.completion(&file, at);
        }
        for end in (0..=text.len()).step_by(step_of_findings) {
            if let Some(beginning) = text.get(..end) {
                workspace.open(&file, beginning);
                assert!(workspace.findings(&file, &Silent).is_some());
            }
        }
        workspace.close(&file);
    }
}

/// Texts that are no documents.
#[test]
fn no_text_makes_the_engine_panic_or_wait() {
    let many = |text: &str, count: usize| text.repeat(count);
    for text in [
        many("{", 20_000),
        many("[a: ", 10_000),
        many("- ", 20_000),
        many("a:\n ", 5_000),
        (0..2000).fold(String::new(), |text, i| text + &" ".repeat(i % 300) + "a:\n"),
        many("\"", 9999),
        many("'a\n", 5000),
        many("a: |\n", 3000),
        many("x.", 20_000),
        "\u{feff}gearloss: gearbox/1\r\n\t\tshafts:\u{e000}\u{e001}\0".to_owned(),
        "set: { a.b.c.*.0.1: { type: ".to_owned(),
        "extends: a.yaml\n".to_owned(),
        many("😀: µ\n", 2000),
    ] {
        let file = std::path::Path::new("a.yaml");
        let workspace = opened(file, &text);
        let start = Instant::now();
        for at in [0, 1, text.len() / 3, text.len() / 2, text.len()] {
            workspace.completion(file, at);
            workspace.hover(file, at);
            workspace.references(file, at);
            let _ = workspace.rename(file, at, "b");
        }
        workspace.symbols(file);
        let took = start.elapsed();
        assert!(
            took < Duration::from_secs(20),
            "{:?}...: {took:?}",
            text.chars().take(20).collect::<String>()
        );
    }
}
