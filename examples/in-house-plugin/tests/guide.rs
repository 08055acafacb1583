//! The guide is correct: its files are those of this crate, and its commands print the output that it shows.
//!
//! `UPDATE=1 cargo test --test guide` updates the guide's files and outputs.
#![allow(clippy::unwrap_used)]

mod common;

use std::path::{Path, PathBuf};

const GUIDE: &str = "../../docs/plugin-guide.md";

/// Maximum number of lines of an output that the guide shows.
const SHOWN: usize = 24;

/// Expected content of a fenced block, by its header; absent if it is not checked.
fn expected(head: &str, body: &str) -> Option<String> {
    if let Some(file) = head.split_whitespace().find_map(|word| word.strip_prefix("file=")) {
        let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        let text = text.trim_end();
        // A file with tests is shown in two blocks.
        let (law, tests) = match text.split_once("\n#[cfg(test)]") {
            Some((law, tests)) => (law.trim_end(), format!("#[cfg(test)]{tests}")),
            None => (text, String::new()),
        };
        return Some(if body.starts_with("#[cfg(test)]") {
            tests
        } else {
            law.to_owned()
        });
    }
    let command = body
        .lines()
        .next()?
        .strip_prefix("$ cargo run -- ")
        .filter(|_| head == "console")?;
    let folder = common::folder("guide");
    let args: Vec<String> = words(command)
        .into_iter()
        .map(|word| word.replace("RESULTS", folder.to_str().unwrap()))
        .collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let printed = common::program(&args)
        .fine()
        .replace(folder.to_str().unwrap(), "RESULTS");
    let mut lines: Vec<String> = printed.lines().map(|l| l.trim_end().to_owned()).collect();
    // The folder of a crate differs between machines.
    lines.retain(|line| !line.starts_with("registered at"));
    if lines.len() > SHOWN {
        lines.truncate(SHOWN);
        lines.push("...".to_owned());
    }
    Some(format!("$ cargo run -- {command}\n{}", lines.join("\n").trim_end()))
}

/// The words of a command line with double quotes, in which `\"` represents a quote.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quoted, mut escaped) = (Vec::new(), String::new(), false, false);
    for c in line.chars() {
        match c {
            _ if escaped => {
                word.push(c);
                escaped = false;
            }
            '\\' => escaped = true,
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(std::mem::take(&mut word)),
            _ => word.push(c),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    words
}

#[test]
fn the_guide_shows_this_crate() {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join(GUIDE);
    let Ok(text) = std::fs::read_to_string(&path) else {
        common::skipped("the guide is not tested: this crate stands outside of the repository");
        return;
    };
    let (mut made, mut blocks) = (String::new(), 0);
    let mut rest = text.as_str();
    while let Some((before, fenced)) = rest.split_once("```") {
        let (head, fenced) = fenced.split_once('\n').unwrap();
        let (body, after) = fenced.split_once("\n```").unwrap();
        let made_block = expected(head, body);
        assert!(
            made_block.is_some() || head == "sh",
            "a block `{head}` stands for itself: {body}"
        );
        blocks += usize::from(made_block.is_some());
        made += &format!("{before}```{head}\n{}\n```", made_block.as_deref().unwrap_or(body));
        rest = after;
    }
    made += rest;
    assert!(blocks == 20, "{blocks} blocks of the guide are checked, not 20");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let stale = made.lines().zip(text.lines()).find(|(now, then)| now != then);
    assert!(
        made == text || std::env::var_os("UPDATE").is_some(),
        "docs/plugin-guide.md is stale: {stale:?}; run `UPDATE=1 cargo test --test guide` in examples/in-house-plugin"
    );
}
