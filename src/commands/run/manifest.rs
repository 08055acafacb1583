//! What the folder of a shard belongs to: a study with all its files, a version of the program, a part of the work.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use gearloss_framework::document::read_yaml;
use gearloss_framework::files::{LONGEST_DATA, read_bytes};
use gearloss_framework::language::Language;
use gearloss_studies::analyses::head::inputs;
use gearloss_studies::study::Study;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::folder::{Held, cannot, is_unfinished, temporary};
use super::shard::Shard;
use super::write::hash_of;
use crate::output::Failure;

/// What the folder of a shard belongs to. A part of anything else is not taken for one of this study.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    format: String,
    gearloss: String,
    /// Crates that brought models, with their versions.
    packages: Vec<String>,
    inputs: BTreeMap<String, String>,
    shard: Shard,
    /// How many results the shard holds; absent as long as it is not finished.
    results: Option<usize>,
}

/// Name of the manifest.
pub const MANIFEST: &str = "shard.json";

impl Manifest {
    /// The manifest of a shard of a study as it is now.
    pub fn of(language: &Language, study: &Study, shard: Shard) -> Self {
        let mut all: BTreeMap<String, String> = BTreeMap::new();
        for input in inputs(study) {
            let name = [input.gearbox.unwrap_or_default(), input.file]
                .join(" ")
                .trim()
                .to_owned();
            all.insert(name, input.fnv1a_64);
        }
        // Whatever the study names that is a file: points, cycles, tables of models under trial.
        let mut words = BTreeSet::new();
        texts(&read_yaml(0, &study.text).node.to_json(), &mut words);
        let folders = study.gearboxes.iter().filter_map(|(name, _)| {
            let file = study.folder.join(study.entry.gearboxes.get(name)?);
            Some(file.parent()?.to_owned())
        });
        let folders: Vec<PathBuf> = std::iter::once(study.folder.clone()).chain(folders).collect();
        for word in words {
            let hash = folders.iter().find_map(|folder| hash_of(&folder.join(&word)).ok());
            if let Some(hash) = hash {
                all.insert(word, hash);
            }
        }
        Self {
            // 3: results of tasks of every analysis.
            format: "gearloss-shard/3".to_owned(),
            gearloss: env!("CARGO_PKG_VERSION").to_owned(),
            packages: language.registry().packages().iter().map(ToString::to_string).collect(),
            inputs: all,
            shard,
            results: None,
        }
    }

    /// Takes a folder for the shard: a new one, or one that it began before.
    pub fn claim(&self, folder: &Path) -> Result<Held, Failure> {
        let begun = folder.join(MANIFEST).is_file();
        if begun {
            self.suits(folder)?;
        } else if !is_unfinished(folder) && fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some()) {
            return Err(Failure::input(
                format!("{} holds files, and no part of a study", folder.display()),
                "name another folder with -o",
            ));
        }
        let (held, _) = Held::take(folder)?;
        if !begun {
            store(&folder.join(MANIFEST), self)?;
        }
        Ok(held)
    }

    /// Whether a folder is of another shard of the same splitting.
    pub fn is_of_splitting(&self, folder: &Path) -> bool {
        let other = load::<Self>(&folder.join(MANIFEST));
        other.is_some_and(|other| {
            other.shard.of == self.shard.of
                && other.format == self.format
                && other.gearloss == self.gearloss
                && other.packages == self.packages
                && other.inputs == self.inputs
        })
    }

    /// Says in a folder that its shard is finished with so many results.
    pub fn finish(self, folder: &Path, results: usize) -> Result<(), Failure> {
        let results = Some(results);
        store(&folder.join(MANIFEST), &Self { results, ..self })
    }

    /// The shard whose folder it is, if it is one of the same study under the same program, and how many results it holds if it is
    /// finished.
    pub fn suits(&self, folder: &Path) -> Result<(Shard, Option<usize>), Failure> {
        let file = folder.join(MANIFEST);
        let other: Self = load(&file).ok_or_else(|| {
            Failure::input(
                format!(
                    "{} holds no part of a study: no {MANIFEST} that can be read",
                    folder.display()
                ),
                "name the folders that `run --shard` has written",
            )
        })?;
        let mut changed: Vec<String> = Vec::new();
        if other.format != self.format {
            changed.push(format!("parts of the form {} are now {}", other.format, self.format));
        }
        if other.gearloss != self.gearloss {
            changed.push(format!("gearloss {} is now {}", other.gearloss, self.gearloss));
        }
        if other.packages != self.packages {
            let [then, now] = [&other.packages, &self.packages].map(|list| list.join(", "));
            changed.push(format!("the models of {then} are now those of {now}"));
        }
        let names: BTreeSet<&String> = other.inputs.keys().chain(self.inputs.keys()).collect();
        for name in names {
            if other.inputs.get(name) != self.inputs.get(name) {
                changed.push(format!("`{name}` has changed"));
            }
        }
        // Only a folder to go on with has to be of the same shard; a merge takes all.
        if self.shard.number > 0 && other.shard != self.shard {
            changed.push(format!("it is of shard {}, not of {}", other.shard, self.shard));
        }
        if changed.is_empty() {
            return Ok((other.shard, other.results));
        }
        Err(Failure::input(
            format!(
                "{} was computed from something else: {}",
                folder.display(),
                changed.join("; ")
            ),
            "delete the folder, or name another one, and run its shard again",
        ))
    }
}

fn texts(value: &Value, words: &mut BTreeSet<String>) {
    match value {
        Value::String(text) if !text.is_empty() => drop(words.insert(text.clone())),
        Value::Array(list) => list.iter().for_each(|value| texts(value, words)),
        Value::Object(map) => map.values().for_each(|value| texts(value, words)),
        _ => {}
    }
}

fn store(file: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let stored = temporary(file).and_then(|(part, mut to)| {
        to.write_all(&serde_json::to_vec(value)?)?;
        fs::rename(part, file)
    });
    stored.map_err(|e| cannot(file, &e))
}

fn load<T: DeserializeOwned>(file: &Path) -> Option<T> {
    serde_json::from_slice(&read_bytes(file, LONGEST_DATA).ok()?).ok()
}
