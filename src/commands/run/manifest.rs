//! Manifest of a shard folder: study with all its files, program version, part of the work.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use gearloss_framework::document::read_yaml;
use gearloss_framework::files::{LONGEST_DATA, read_bytes};
use gearloss_framework::language::Language;
use gearloss_studies::engine::head::{hash_of, inputs};
use gearloss_studies::study::Study;
use gearloss_studies::tasks::StorageError;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::folder::{Held, cannot_write, is_unfinished, temporary};
use crate::output::Failure;
use crate::shard::Shard;

/// Manifest of a shard folder. Parts with another manifest do not belong to this study.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    format: String,
    gearloss: String,
    /// Crates with models and their versions.
    packages: Vec<String>,
    inputs: BTreeMap<String, String>,
    shard: Shard,
    /// Number of results of the shard; absent until it is finished.
    results: Option<usize>,
}

/// Name of the manifest.
pub const MANIFEST: &str = "shard.json";

impl Manifest {
    /// The current manifest of a shard of a study.
    pub fn for_shard(language: &Language, study: &Study, shard: Shard) -> Self {
        let mut all: BTreeMap<String, String> = BTreeMap::new();
        for input in inputs(study) {
            let name = [input.gearbox.unwrap_or_default(), input.file]
                .join(" ")
                .trim()
                .to_owned();
            all.insert(name, input.fnv1a_64);
        }
        // All files named in the study: points, cycles, tables of trial models.
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
            // 3: results of tasks of every analysis. 4: loss outside ranges by time.
            format: "gearloss-shard/4".to_owned(),
            gearloss: env!("CARGO_PKG_VERSION").to_owned(),
            packages: language.registry().packages().iter().map(ToString::to_string).collect(),
            inputs: all,
            shard,
            results: None,
        }
    }

    /// Claims a folder for the shard: a new one, or one with earlier results of the same shard.
    pub fn claim(&self, folder: &Path) -> Result<Held, Failure> {
        let begun = folder.join(MANIFEST).is_file();
        if begun {
            self.suits(folder)?;
        } else if !is_unfinished(folder) && fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some()) {
            return Err(Failure::input(
                format!("{} contains files that are not part of a study", folder.display()),
                "choose another folder with -o",
            ));
        }
        let (held, _) = Held::take(folder)?;
        if !begun {
            store(&folder.join(MANIFEST), self)?;
        }
        Ok(held)
    }

    /// Whether a folder belongs to another shard of the same splitting.
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

    /// Records in the folder that its shard is finished, with the number of results.
    pub fn finish(self, folder: &Path, results: usize) -> Result<(), StorageError> {
        let results = Some(results);
        store(&folder.join(MANIFEST), &Self { results, ..self })
    }

    /// The shard of a folder, if it belongs to the same study and program, and its number of results if it is finished.
    pub fn suits(&self, folder: &Path) -> Result<(Shard, Option<usize>), Failure> {
        let file = folder.join(MANIFEST);
        let other: Self = load(&file).ok_or_else(|| {
            Failure::input(
                format!("{} is not a part of a study: no readable {MANIFEST}", folder.display()),
                "give the folders that `run --shard` has written",
            )
        })?;
        let mut changed: Vec<String> = Vec::new();
        if other.format != self.format {
            changed.push(format!("format {} of the parts is now {}", other.format, self.format));
        }
        if other.gearloss != self.gearloss {
            changed.push(format!("gearloss {} is now {}", other.gearloss, self.gearloss));
        }
        if other.packages != self.packages {
            let [then, now] = [&other.packages, &self.packages].map(|list| list.join(", "));
            changed.push(format!("models from {then} are now from {now}"));
        }
        let names: BTreeSet<&String> = other.inputs.keys().chain(self.inputs.keys()).collect();
        for name in names {
            if other.inputs.get(name) != self.inputs.get(name) {
                changed.push(format!("`{name}` has changed"));
            }
        }
        // Only a continued folder must belong to the same shard; a merge accepts all.
        if self.shard.number > 0 && other.shard != self.shard {
            changed.push(format!("it belongs to shard {}, not to {}", other.shard, self.shard));
        }
        if changed.is_empty() {
            return Ok((other.shard, other.results));
        }
        Err(Failure::input(
            format!(
                "{} was computed from other inputs: {}",
                folder.display(),
                changed.join("; ")
            ),
            "delete the folder, or choose another one, and run its shard again",
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

fn store(file: &Path, value: &impl Serialize) -> Result<(), StorageError> {
    let stored = temporary(file).and_then(|(part, mut to)| {
        to.write_all(&serde_json::to_vec(value)?)?;
        fs::rename(part, file)
    });
    stored.map_err(|e| cannot_write(file, e))
}

fn load<T: DeserializeOwned>(file: &Path) -> Option<T> {
    serde_json::from_slice(&read_bytes(file, LONGEST_DATA).ok()?).ok()
}
