use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use gearloss_document::files::{Disk, InMemory};
use gearloss_editor::{Completion, Workspace};
use gearloss_framework::language::Language;

/// The language of the built-in models.
pub fn language() -> &'static Language {
    static LANGUAGE: OnceLock<Language> = OnceLock::new();
    LANGUAGE.get_or_init(|| Language::linked().unwrap())
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap()
}

/// Documents of all examples and of the layouts of `gearloss new`, which are valid or nearly so.
pub fn examples() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in [
        "examples",
        "framework/workbench/src/form/layouts",
        "tests/results",
        "tests/foreign_map",
    ] {
        collect(&repository().join(folder), &mut found);
    }
    found.sort();
    assert!(found.len() > 15, "{found:?}");
    found
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "yaml") {
            found.push(path);
        }
    }
}

/// A text without its cursor, and the place of the cursor.
pub fn cursor(text: &str) -> (String, usize) {
    let at = text.find('|').unwrap_or_else(|| panic!("no cursor in {text}"));
    (text.replacen('|', "", 1), at)
}

/// A workspace over the disk with an open text in the folder of an example.
pub fn opened(file: &Path, text: &str) -> Workspace<'static> {
    let mut workspace = Workspace::new(language(), Disk::shared());
    workspace.open(file, text);
    workspace
}

/// A workspace without a disk.
pub fn in_memory(files: &[(&str, &str)]) -> Workspace<'static> {
    let mut workspace = Workspace::new(language(), InMemory::default().shared());
    for (file, text) in files {
        workspace.open(file, *text);
    }
    workspace
}

/// Suggestions in a text with a cursor, as the only document.
pub fn complete(text: &str) -> Vec<Completion> {
    let (text, at) = cursor(text);
    in_memory(&[("a.yaml", &text)]).completion(Path::new("a.yaml"), at)
}

pub fn labels(items: &[Completion]) -> Vec<&str> {
    items.iter().map(|item| item.label.as_str()).collect()
}

/// The text after a suggestion was accepted.
pub fn accepted(text: &str, label: &str) -> String {
    let items = complete(text);
    let item = items.iter().find(|item| item.label == label);
    let item = item.unwrap_or_else(|| panic!("{label} is not among {:?} at {text}", labels(&items)));
    let (mut text, _) = cursor(text);
    text.replace_range(item.range.from..item.range.to, &item.insert);
    text
}
