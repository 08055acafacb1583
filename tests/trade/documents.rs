//! Pages: their links resolve, the book of `docs` has all of its pages, and the program accepts every YAML block.
//!
//! A block is a document if it states `gearloss:`. Otherwise it is put into one: a block of `docs/gallery.md` under `analyses`, one of
//! `docs/models/` is an input of `eval` for the mechanism of its page, any other is part of a study if all its keys are those of a study,
//! else of a gearbox. A block that is nothing of gearloss has a comment before it, `<!-- not gearloss: REASON -->`, which readers of the
//! page do not see. Blocks with `file=` are the files of `examples/in-house-plugin`, whose tests run them.

use std::path::{Path, PathBuf};

use gearloss_framework::document::{Diagnostic, read_yaml};
use gearloss_framework::language::{Kind, Language};

use crate::common::file;

const MARK: &str = "<!-- not gearloss: ";

/// A fenced block.
struct Block {
    page: PathBuf,
    line: usize,
    text: String,
}

/// The files of the repository with these endings.
fn files(ends: &[&str]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![file("")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() {
                // Folders that builds, runs and tools write.
                if !name.starts_with('.') && !["node_modules", "out", "results", "target"].contains(&name) {
                    folders.push(path);
                }
            } else if path
                .extension()
                .is_some_and(|end| ends.iter().any(|known| end == *known))
            {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// The lines of a page outside of fenced blocks, with their numbers.
fn lines_outside_blocks(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut inside = false;
    text.lines().zip(1..).filter_map(move |(line, number)| {
        let is_fence = line.trim_start().starts_with("```");
        inside ^= is_fence;
        (!inside && !is_fence).then_some((number, line))
    })
}

/// The targets of the links of a page to files, with their lines.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut links = Vec::new();
    for (number, line) in lines_outside_blocks(text) {
        let prose: String = line.split('`').step_by(2).collect();
        let targets = prose
            .split("](")
            .skip(1)
            .filter_map(|rest| Some(rest.split_once(')')?.0));
        links.extend(
            targets
                .filter(|target| !target.starts_with("http"))
                .map(|target| (number, target.to_owned())),
        );
    }
    links
}

/// The anchors of the headings of a page, as GitHub and mdBook name them.
fn anchors(text: &str) -> Vec<String> {
    let mut anchors: Vec<String> = Vec::new();
    for (_, line) in lines_outside_blocks(text).filter(|(_, line)| line.starts_with('#')) {
        let title = line.trim_start_matches('#').trim();
        // Of a link its text counts.
        let shown = title.split("](").enumerate().map(|(part, rest)| match part {
            0 => rest,
            _ => rest.split_once(')').map_or("", |(_, after)| after),
        });
        let name: String = shown
            .flat_map(str::chars)
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
            .flat_map(char::to_lowercase)
            .map(|c| if c == ' ' { '-' } else { c })
            .collect();
        let repeated = anchors.contains(&name);
        anchors.push(if repeated { format!("{name}-1") } else { name });
    }
    anchors
}

/// The blocks of a page, without those that are marked with a reason.
fn blocks(page: &Path) -> Vec<Block> {
    let text = std::fs::read_to_string(page).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let mut blocks = Vec::new();
    let mut number = 0;
    while number < lines.len() {
        let line = lines[number];
        let fence = line.trim_start();
        let indent = line.len() - fence.len();
        // The pages of a guide are files of its example, whose tests run them.
        if fence.contains("file=") || !(fence.starts_with("```yaml") || fence.starts_with("```yml")) {
            number += 1;
            continue;
        }
        let end = (number + 1..lines.len())
            .find(|at| lines[*at].trim_start().starts_with("```"))
            .unwrap();
        let inside = lines[number + 1..end]
            .iter()
            .map(|line| line.get(indent..).unwrap_or(""));
        let before = lines[..number].iter().rev().find(|line| !line.trim().is_empty());
        let reason = before.and_then(|line| line.trim().strip_prefix(MARK));
        match reason {
            Some(reason) => assert!(
                reason.trim_end_matches("-->").trim().len() > 10,
                "{}: {reason}",
                page.display()
            ),
            None => blocks.push(Block {
                page: page.to_path_buf(),
                line: number + 1,
                text: inside.fold(String::new(), |text, line| text + line + "\n"),
            }),
        }
        number = end + 1;
    }
    blocks
}

fn indented(text: &str) -> String {
    text.lines().fold(String::new(), |all, line| all + "  " + line + "\n")
}

/// The top-level keys of a block.
fn keys(text: &str) -> Vec<&str> {
    text.lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()))
        .filter_map(|line| Some(line.split_once(':')?.0))
        .collect()
}

/// The keys of a study.
fn study_keys(language: &Language) -> Vec<String> {
    let schema = language.published(Kind::Study);
    schema["properties"].as_object().unwrap().keys().cloned().collect()
}

fn findings(language: &Language, study_keys: &[String], block: &Block) -> Vec<Diagnostic> {
    let is_in = |folder: &str| block.page.parent().is_some_and(|parent| parent.ends_with(folder));
    let name = block.page.file_stem().unwrap().to_str().unwrap();
    let of_study = |key: &str| study_keys.iter().any(|known| known == key);
    let study = |text: &str| {
        let mut text = format!("gearloss: study/1\n{text}");
        for (key, line) in [
            ("gearboxes", "gearboxes: { own: gearbox.yaml }\n"),
            ("analyses", "analyses: {}\n"),
        ] {
            if !keys(&text).contains(&key) {
                text.push_str(line);
            }
        }
        text
    };
    let (text, is_study) = if block.text.contains("gearloss: ") {
        (block.text.clone(), block.text.contains("gearloss: study/1"))
    } else if name == "gallery" {
        (study(&format!("analyses:\n{}", indented(&block.text))), true)
    } else if !is_in("docs/models") && keys(&block.text).into_iter().all(of_study) {
        (study(&block.text), true)
    } else {
        (
            format!("gearloss: gearbox/1\nextends: base.yaml\n{}", block.text),
            false,
        )
    };
    if is_in("docs/models") {
        let read = read_yaml(0, &block.text);
        let walked = language.walk_eval(name, &read.node).unwrap();
        return [read.findings, walked.findings].concat();
    }
    let read = read_yaml(0, &text);
    if block.text.contains("gearloss: source/1") {
        return [read.findings, language.walk_document("source", &read.node).findings].concat();
    }
    let walked = if is_study {
        language.walk_study(&read.node)
    } else {
        language.walk_gearbox(&read.node)
    };
    // Sections that the base of a gearbox has.
    let of_base = |finding: &Diagnostic| finding.path.is_empty() && finding.message.ends_with("is missing");
    let extends = keys(&text).contains(&"extends");
    let found = [read.findings, walked.findings].concat();
    found
        .into_iter()
        .filter(|finding| !(extends && of_base(finding)))
        .collect()
}

#[test]
fn every_yaml_block_of_the_docs_is_accepted() {
    let language = Language::linked().unwrap();
    let study_keys = study_keys(&language);
    let blocks: Vec<Block> = files(&["md"]).iter().flat_map(|page| blocks(page)).collect();
    assert!(blocks.len() > 150, "{} blocks", blocks.len());
    let mut wrong = Vec::new();
    for block in &blocks {
        for finding in findings(&language, &study_keys, block) {
            wrong.push(format!("{}:{}: {finding}", block.page.display(), block.line));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_link_of_a_page_resolves() {
    let mut wrong = Vec::new();
    for page in files(&["md"]) {
        let text = std::fs::read_to_string(&page).unwrap();
        for (line, link) in links(&text) {
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if path.is_empty() {
                page.clone()
            } else {
                page.with_file_name(path)
            };
            let has_anchor = || {
                anchors(&std::fs::read_to_string(&target).unwrap())
                    .iter()
                    .any(|known| known == anchor)
            };
            if !target.exists() || !(anchor.is_empty() || has_anchor()) {
                wrong.push(format!("{}:{line}: {link}", page.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_book_has_every_page_once() {
    let (docs, summary) = (file("docs"), file("docs/SUMMARY.md"));
    let contents = links(&std::fs::read_to_string(&summary).unwrap());
    let mut listed: Vec<PathBuf> = contents.iter().map(|(_, page)| docs.join(page)).collect();
    listed.sort();
    let mut pages = files(&["md"]);
    pages.retain(|page| page.starts_with(&docs) && *page != summary);
    assert_eq!(listed, pages, "docs/SUMMARY.md lists every page of docs once");
}

/// Comments, messages and schemas refer to pages by their paths from the top of the repository.
#[test]
fn every_page_that_a_source_mentions_exists() {
    let mut wrong = Vec::new();
    for source in files(&["json", "mjs", "py", "rs", "toml", "yaml"]) {
        let text = std::fs::read_to_string(&source).unwrap_or_default();
        for rest in text.split("docs/").skip(1) {
            let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || "-_./".contains(c)));
            let page = file("docs").join(rest[..length.unwrap_or(rest.len())].trim_end_matches('.'));
            if page.extension().is_some_and(|end| end == "md") && !page.exists() {
                wrong.push(format!("{}: {}", source.display(), page.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
