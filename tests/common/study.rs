//! Studies that are run by the library, from texts.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;
use std::path::Path;
use std::sync::Arc;

use gearloss::api::{
    Disk, FileSource, Findings, InMemory, Outcome, SharedSource, Silent, Stopped, Study, StudyRun, read_study,
};
use gearloss::report::csv::CsvTable;
use gearloss::report::page::{Block, Page};
use gearloss::studies::checked_study::CheckedStudy;
use gearloss::studies::study::Write;
use serde_json::Value;

use super::language;

/// Texts before files of the disk: gearboxes of the repository are named by their paths.
#[derive(Debug)]
struct TextsAndDisk(InMemory);

impl FileSource for TextsAndDisk {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        self.0.read(path, longest).or_else(|_| Disk.read(path, longest))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<String>> {
        self.0.list(folder).or_else(|_| Disk.list(folder))
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
    /// The pictures that are written, as SVG, by the names of their files without extension.
    pictures: BTreeMap<String, String>,
    /// Files for other programs, by name.
    files: BTreeMap<String, Vec<u8>>,
}

impl Ran {
    /// The run with a copy of its text, which messages of assertions show.
    pub fn with_text(self) -> (Self, String) {
        let text = self.text.clone();
        (self, text)
    }

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
    pub fn file(&self, name: &str) -> &str {
        std::str::from_utf8(self.bytes(name)).unwrap()
    }

    /// A file that an analysis wants to be written.
    pub fn bytes(&self, name: &str) -> &[u8] {
        let file = self.files.get(name);
        file.unwrap_or_else(|| panic!("no file {name}: {}", self.text))
    }

    /// Whether an analysis wants a file of text to be written.
    pub fn has_file(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// A picture that an analysis wants to be written, as SVG.
    pub fn picture(&self, name: &str) -> &str {
        let picture = self.pictures.get(name);
        picture.unwrap_or_else(|| panic!("no picture {name}: {}", self.text))
    }

    /// Whether an analysis wants a picture to be written.
    pub fn draws(&self, name: &str) -> bool {
        self.pictures.contains_key(name)
    }

    fn outcome(&self, name: &str) -> &dyn Outcome {
        let outcome = self.outcomes.get(name);
        outcome
            .unwrap_or_else(|| panic!("no outcome of {name}: {}", self.text))
            .as_ref()
    }

    /// Adds what an analysis prints and wants to be written, and its outcome.
    fn keep(&mut self, study: &Study, name: &str, outcome: Box<dyn Outcome>) {
        let page = Page::from_outcome(outcome.as_ref());
        for block in &page.blocks {
            match block {
                Block::Text(text) => self.text.push_str(text),
                Block::Table(table) => self.text.push_str(&table.render()),
            }
        }
        for line in &page.outside {
            self.text.push_str(&format!("{line}\n"));
        }
        let texts = outcome
            .files()
            .into_iter()
            .map(|file| (file.name, file.text.into_bytes()));
        self.files.extend(texts);
        for file in page.files {
            self.files.insert(file.name, file.bytes);
        }
        let formats = &study.entry.analyses.get(name).unwrap().write;
        if formats.contains(&Write::Svg) {
            for named in page.figures {
                // A product precedes its set with a slash.
                let picture = named.name.replace('/', "-");
                self.pictures.insert(picture, named.figure.svg().unwrap());
            }
        }
        if !page.faults.is_empty() {
            self.fail(&study.findings(page.faults));
        }
        outcome.failures().iter().for_each(|findings| self.fail(findings));
        self.outcomes.insert(name.to_owned(), outcome);
    }

    fn fail(&mut self, findings: &Findings) {
        self.succeeded = false;
        self.text.push_str(&findings.render());
    }
}

/// A study of one gearbox of the repository, which it calls `ours`, with the rest of its text.
pub fn of_gearbox(gearbox: &str, rest: &str) -> String {
    let gearbox = super::file(gearbox);
    format!(
        "gearloss: study/1\ngearboxes: {{ ours: {} }}\n{rest}",
        gearbox.display()
    )
}

/// A number of a result.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Runs a study of the repository.
pub fn run_file(study: &str) -> Ran {
    run(&Disk::shared(), &super::file(study))
}

/// Runs a study with files beside it.
pub fn run_texts(study: &str, files: &[(&str, &str)]) -> Ran {
    run_files(study, files)
}

/// As [`run_texts`], with files of any content.
pub fn run_files(study: &str, files: &[(&str, impl AsRef<[u8]>)]) -> Ran {
    let contents = files.iter().map(|(name, content)| (*name, content.as_ref().to_vec()));
    let texts = InMemory::new(contents.chain([("study.yaml", study.as_bytes().to_vec())]));
    let source: SharedSource = Arc::new(TextsAndDisk(texts));
    run(&source, Path::new("study.yaml"))
}

/// What `check` finds in a study with files beside it: warnings and errors.
pub fn check_texts(study: &str, files: &[(&str, &str)]) -> String {
    let study = [("study.yaml", study)];
    let contents = files.iter().chain(&study);
    let texts = InMemory::new(contents.map(|(name, content)| (*name, content.as_bytes().to_vec())));
    let source: SharedSource = Arc::new(TextsAndDisk(texts));
    let checked = CheckedStudy::read(&language(), &source, Path::new("study.yaml"), &Silent);
    let warnings = checked.warnings.iter().map(Findings::render);
    warnings
        .chain(checked.refused.iter().map(ToString::to_string))
        .collect()
}

fn run(source: &SharedSource, study: &Path) -> Ran {
    let language = language();
    let mut ran = Ran {
        succeeded: true,
        ..Ran::default()
    };
    let study = match read_study(&language, source, study) {
        Ok(study) => study,
        Err(findings) => {
            ran.fail(&findings);
            return ran;
        }
    };
    // Faults of a measurement that no analysis uses are reported here alone.
    if let Some(findings) = study.data_findings() {
        ran.fail(&findings);
    }
    for (name, outcome) in StudyRun::new(&language, &study).outcomes() {
        match outcome {
            Ok(outcome) => ran.keep(&study, name, outcome),
            Err(Stopped::Found(findings)) => ran.fail(&findings),
            Err(stopped) => {
                ran.succeeded = false;
                writeln!(ran.text, "{stopped}").unwrap();
            }
        }
    }
    ran
}
