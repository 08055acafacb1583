//! `validate`: every model against the sets of a corpus.

use std::fs;
use std::path::Path;
use std::process;

use gearloss_framework::document::did_you_mean;
use gearloss_framework::files::Disk;
use gearloss_report::validation;
use gearloss_studies::corpus::{Corpus, cells_csv};

use super::check::UntilInterrupted;
use super::run::page;
use crate::args::ValidateArgs;
use crate::interrupt;
use crate::output::{End, Failure, Out};

/// Files that are written.
const DOCUMENT: &str = "validation.md";
const CELLS: &str = "cells.csv";
const PAGE: &str = "validation.html";

pub fn run(args: &ValidateArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let read = Corpus::read(language, &Disk::shared(), &args.corpus);
    let mut corpus = read.map_err(|list| Failure::from(list.as_slice()))?;
    select(&mut corpus, &args.names)?;
    interrupt::listen();
    let validated = corpus.validate(language, &UntilInterrupted)?;
    out.text(&validation::text(language, &validated))?;
    let folder = args.output.clone().unwrap_or_else(|| args.corpus.join("results"));
    let (report, frame) = validation::page(language, &validated, env!("CARGO_PKG_VERSION"));
    let content = serde_json::to_value(report.content(&frame));
    let content =
        content.map_err(|fault| Failure::input(format!("the page cannot be encoded: {fault}"), "report this"))?;
    let files: [(&str, Vec<u8>); 3] = [
        (DOCUMENT, validation::document(language, &validated).into_bytes()),
        (CELLS, cells_csv(&validated.cells(language)).into_bytes()),
        (PAGE, page(content, None)?),
    ];
    for (name, bytes) in files {
        write(&folder, name, &bytes)?;
    }
    out.line(format!("\nreport: {}", folder.join(PAGE).display()))?;
    out.line(format!("document: {}", folder.join(DOCUMENT).display()))?;
    Ok(End::Fine)
}

/// Keeps the named sets.
fn select(corpus: &mut Corpus, names: &[String]) -> Result<(), Failure> {
    for name in names {
        let all: Vec<&str> = corpus.sets.iter().map(|set| set.name.as_str()).collect();
        if !all.contains(&name.as_str()) {
            let help = match did_you_mean(name, all.iter().copied()) {
                Some(close) => format!("write `{close}`; the sets are {}", all.join(", ")),
                None => format!("the sets are {}", all.join(", ")),
            };
            return Err(Failure::input(format!("there is no set `{name}`"), help));
        }
    }
    if !names.is_empty() {
        corpus.sets.retain(|set| names.contains(&set.name));
    }
    Ok(())
}

/// Writes a file completely or not at all.
fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let part = folder.join(format!("{name}.{}.part", process::id()));
    let written = fs::create_dir_all(folder)
        .and_then(|()| fs::write(&part, bytes))
        .and_then(|()| fs::rename(&part, folder.join(name)));
    written.map_err(|e| {
        Failure::input(
            format!("cannot write {}: {e}", folder.join(name).display()),
            "choose another folder with -o",
        )
    })
}
