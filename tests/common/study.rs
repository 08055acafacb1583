//! Studies that are run by the library, from texts.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;
use std::path::Path;
use std::sync::Arc;

use gearloss::api::{Disk, FileSource, Findings, InMemory, Outcome, SharedSource, Stopped, StudyRun, read_study};
use gearloss::pictures::csv::CsvTable;
use gearloss::pictures::page::{Page, Text};
use serde_json::Value;

use super::language;

/// Texts before files of the disk: gearboxes of the repository are named by their paths.
#[derive(Debug)]
struct TextsAndDisk(InMemory);

impl FileSource for TextsAndDisk {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        self.0.read(path, longest).or_else(|_| Disk.read(path, longest))
    }
}

/// What a study gave.
#[derive(Debug, Default)]
pub struct Ran {
    /// What its analyses print, and its errors.
    pub text: String,
    /// Whether all analyses have an outcome without a fault.
    pub succeeded: bool,
    outcomes: BTreeMap<String, Box<dyn Outcome>>,
}

impl Ran {
    /// The result of an analysis.
    pub fn json(&self, name: &str) -> Value {
        let mut bytes = Vec::new();
        self.outcome(name).write_json(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    /// The table of a name.
    pub fn csv(&self, name: &str) -> String {
        let mut tables = self.outcomes.values().flat_map(|outcome| outcome.tables());
        let table = tables.find(|table| table.name == name);
        let table = table.unwrap_or_else(|| panic!("no table {name}: {}", self.text));
        let mut bytes = Vec::new();
        let mut csv = CsvTable::new(&mut bytes, &table).unwrap();
        csv.rows(&table).unwrap();
        csv.finish().unwrap();
        String::from_utf8(bytes).unwrap()
    }

    /// A file of text that an analysis wants to be written.
    pub fn file(&self, name: &str) -> String {
        let mut files = self.outcomes.values().flat_map(|outcome| outcome.files());
        let file = files.find(|file| file.name == name);
        file.unwrap_or_else(|| panic!("no file {name}: {}", self.text)).text
    }

    /// Whether an analysis draws a figure of a name.
    pub fn draws(&self, name: &str) -> bool {
        let mut pages = self
            .outcomes
            .values()
            .map(|outcome| Page::from_outcome(outcome.as_ref()));
        pages.any(|page| page.figures.iter().any(|figure| figure.name == name))
    }

    fn outcome(&self, name: &str) -> &dyn Outcome {
        let outcome = self.outcomes.get(name);
        outcome
            .unwrap_or_else(|| panic!("no outcome of {name}: {}", self.text))
            .as_ref()
    }

    fn fail(&mut self, findings: &Findings) {
        self.succeeded = false;
        self.text.push_str(&findings.render());
    }
}

/// Runs a study with files beside it.
pub fn run_texts(study: &str, files: &[(&str, &str)]) -> Ran {
    let texts = files.iter().copied().chain([("study.yaml", study)]);
    let source: SharedSource = Arc::new(TextsAndDisk(InMemory::new(texts)));
    let language = language();
    let mut ran = Ran {
        succeeded: true,
        ..Ran::default()
    };
    let study = match read_study(&language, &source, "study.yaml") {
        Ok(study) => study,
        Err(findings) => {
            ran.fail(&findings);
            return ran;
        }
    };
    for (name, outcome) in StudyRun::new(&language, &study).outcomes() {
        match outcome {
            Ok(outcome) => {
                let page = Page::from_outcome(outcome.as_ref());
                for text in &page.text {
                    let (Text::Everywhere(text) | Text::InReport(text)) = text;
                    ran.text.push_str(text);
                }
                if !page.faults.is_empty() {
                    ran.fail(&study.findings(page.faults));
                }
                outcome.failures().iter().for_each(|findings| ran.fail(findings));
                ran.outcomes.insert(name.to_owned(), outcome);
            }
            Err(Stopped::Found(findings)) => ran.fail(&findings),
            Err(stopped) => {
                ran.succeeded = false;
                writeln!(ran.text, "{stopped}").unwrap();
            }
        }
    }
    ran
}
