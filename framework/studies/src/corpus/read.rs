//! Reads the sets of a corpus and checks that they are complete.

use std::io;
use std::path::{Path, PathBuf};

use gearloss_framework::document::{self, Diagnostic, Sources, read_yaml};
use gearloss_framework::files::{LONGEST_DATA, LONGEST_TEXT, SharedSource};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;

use super::source::NAME;
use super::validated::Judgement;
use super::{Corpus, DATA, SOURCE, STUDY, Set, SourceEntry, data};
use crate::analyses::{Planner, Stopped};
use crate::codes;
use crate::study::Study;

/// Whether a folder is a set, or a corpus of sets.
pub fn is_corpus(folder: &Path) -> bool {
    folder.join(SOURCE).is_file() || folders(folder).is_ok_and(|all| all.iter().any(|set| set.join(SOURCE).is_file()))
}

/// The folders in a folder, in the order of their names.
fn folders(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            all.push(path);
        }
    }
    all.sort();
    Ok(all)
}

impl Corpus {
    /// Reads a folder: a set, or all sets in it; folders without `source.md` are not sets.
    ///
    /// # Errors
    /// Everything that is wrong or incomplete in each set.
    pub fn read(language: &Language, files: &SharedSource, folder: &Path) -> Result<Self, Vec<Findings>> {
        let unreadable = |message: String, help: &str| {
            vec![Findings::from(
                Diagnostic::error("", message)
                    .help(help)
                    .code(document::codes::UNREADABLE),
            )]
        };
        let all = if folder.join(SOURCE).is_file() {
            vec![folder.to_owned()]
        } else {
            let all = folders(folder);
            let all = all.map_err(|e| {
                unreadable(
                    format!("cannot read {}: {e}", folder.display()),
                    "check the name of the folder",
                )
            })?;
            all.into_iter().filter(|set| set.join(SOURCE).is_file()).collect()
        };
        if all.is_empty() {
            let message = format!("{} contains no set: no folder with `{SOURCE}`", folder.display());
            return Err(unreadable(
                message,
                "name the folder of a corpus or of one measured set; to check a gearbox or a study, name its file",
            ));
        }
        let (mut sets, mut wrong) = (Vec::new(), Vec::new());
        for folder in all {
            match Set::read(language, files, &folder) {
                Ok(set) => sets.push(set),
                Err(findings) => wrong.push(findings),
            }
        }
        if wrong.is_empty() {
            Ok(Self { sets })
        } else {
            Err(wrong)
        }
    }
}

impl Set {
    /// Reads the folder of a set.
    ///
    /// # Errors
    /// Everything that is wrong or incomplete.
    pub fn read(language: &Language, files: &SharedSource, folder: &Path) -> Result<Self, Findings> {
        let mut sources = Sources::default();
        let path = folder.join(SOURCE);
        let text = files
            .read_text(&path, LONGEST_TEXT)
            .map_err(|e| unreadable(&path, &e))?;
        let number = sources.add(path.display().to_string(), text.as_str());
        let Some((record, words)) = parts(&text) else {
            let help = "begin with a line `---`, then `gearloss: source/1` and the other keys, then a line `---`, then your own words";
            return Err(found(
                vec![incomplete("", "there is no record of the source").help(help)],
                sources,
            ));
        };
        let read = read_yaml(number, record);
        if !read.findings.is_empty() {
            return Err(found(read.findings, sources));
        }
        let walked = language.walk_document(NAME, &read.node);
        if !walked.findings.is_empty() {
            return Err(found(walked.findings, sources));
        }
        let entry: SourceEntry = serde_json::from_value(walked.value)
            .map_err(|e| Findings::from(incomplete("", &format!("the record cannot be read: {e}"))))?;
        let mut list = Vec::new();
        if words.trim().is_empty() {
            let help = "say in your own words who measured what and how, and list what is assumed with its range";
            list.push(incomplete("", "there are no words behind the record").help(help));
        }
        let place = |finding: Diagnostic| walked.places.place(finding);
        let table = folder.join(DATA);
        let rows = match (table.is_file(), entry.columns.is_empty()) {
            (true, true) => {
                let help = "state each column with `what`, `unit`, `from` and `to`";
                list.push(incomplete("columns", "data.csv has columns that the source does not state").help(help));
                None
            }
            (false, false) => {
                let help = "add the table, or delete `columns` if the numbers may not be passed on";
                list.push(place(incomplete("columns", "there is no data.csv").help(help)));
                None
            }
            (false, true) => None,
            (true, false) => {
                let text = files
                    .read_text(&table, LONGEST_DATA)
                    .map_err(|e| unreadable(&table, &e))?;
                let number = sources.add(table.display().to_string(), text.as_str());
                match data::check(&text, number, &entry, &walked.places) {
                    Ok(rows) => Some(rows),
                    Err(wrong) => {
                        list.extend(wrong);
                        None
                    }
                }
            }
        };
        let file = folder.join(STUDY);
        match (&entry.needs, file.is_file()) {
            (Some(_), true) => {
                let help = "delete `needs`, or the study";
                list.push(place(
                    incomplete("needs", "a set with a study needs nothing").help(help),
                ));
            }
            (None, false) => {
                let help = "write `gearbox.yaml` and `study.yaml`, or say what the program lacks: `needs: worm mesh`";
                list.push(incomplete("", "there is no study.yaml that judges models by this set").help(help));
            }
            _ => {}
        }
        for (i, model) in entry.seen.iter().enumerate() {
            if let Err(error) = known(language, model) {
                list.push(place(Diagnostic {
                    path: format!("seen.{i}"),
                    ..error
                }));
            }
        }
        if !list.is_empty() {
            return Err(found(list, sources));
        }
        let study = if entry.needs.is_none() {
            Some(judging(language, files, &file)?)
        } else {
            None
        };
        Ok(Self {
            name: folder
                .file_name()
                .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            folder: folder.to_owned(),
            source: entry,
            rows,
            study,
        })
    }
}

/// The record between two lines `---`, and the words behind it.
fn parts(text: &str) -> Option<(&str, &str)> {
    let first = text
        .split_inclusive('\n')
        .next()
        .filter(|line| line.trim_end() == "---")?;
    let mut end = first.len();
    for line in text[first.len()..].split_inclusive('\n') {
        if line.trim_end() == "---" {
            return Some((&text[..end], &text[end + line.len()..]));
        }
        end += line.len();
    }
    None
}

/// The study of a set, checked; it has an analysis that judges models.
fn judging(language: &Language, files: &SharedSource, file: &Path) -> Result<Study, Findings> {
    let study = Study::read_from(language, files, file)?;
    study.check(language)?;
    let judging = study.entry.analyses.iter();
    let mut judging = judging.filter(|(_, analysis)| Judgement::is_of(analysis)).peekable();
    if judging.peek().is_none() {
        let help = "write an analysis with `type: validation`, or `oil_property` for properties of oils";
        return Err(study.findings(vec![
            incomplete("analyses", "no analysis judges models by the set").help(help),
        ]));
    }
    for (name, analysis) in judging {
        // Nothing is stored or interrupted before anything is computed.
        if let Err(stopped) = analysis.plan(&Planner::new(language, &study, name)) {
            return Err(match stopped {
                Stopped::Found(findings) => findings,
                other => study.findings(vec![incomplete(&format!("analyses.{name}"), &other.to_string())]),
            });
        }
    }
    Ok(study)
}

/// Whether `mechanism/model` is a model.
fn known(language: &Language, model: &str) -> Result<(), Diagnostic> {
    let registry = language.registry();
    let (mechanism, name) = model.split_once('/').unwrap_or((model, ""));
    registry.model_named(registry.mechanism_named(mechanism)?.key, name)?;
    Ok(())
}

fn incomplete(path: &str, message: &str) -> Diagnostic {
    Diagnostic::error(path, message).code(codes::CORPUS)
}

fn unreadable(path: &Path, e: &io::Error) -> Findings {
    let error = Diagnostic::error("", format!("cannot read {}: {e}", path.display()));
    Findings::from(error.help("check the file").code(document::codes::UNREADABLE))
}

fn found(list: Vec<Diagnostic>, sources: Sources) -> Findings {
    Findings { list, sources }
}
