//! What a shard leaves in its folder, and what a merge takes from there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use gearloss_framework::document::read_yaml;
use gearloss_framework::files::{LONGEST_DATA, open_regular, read_bytes};
use gearloss_framework::language::Language;
use gearloss_studies::analysis::Piece;
use gearloss_studies::study::Study;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Run;
use super::folder::{Held, cannot, is_unfinished, temporary};
use super::pieces::{PieceFile, Place};
use super::shard::{Deal, Kind, Shard};
use super::stated_ranges::{StatedRanges, is_printed_at_the_end};
use super::write::{copy, hash_of};
use crate::output::{Failure, Out};
use crate::report::Section;
use gearloss_studies::analyses::head::inputs;

/// What the folder of a shard belongs to. A part of anything else is not taken for one of this study.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    format: String,
    gearloss: String,
    /// Crates that brought models, with their versions.
    packages: Vec<String>,
    inputs: BTreeMap<String, String>,
    shard: Shard,
}

/// Name of the manifest.
const MANIFEST: &str = "shard.json";

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
            // 2: longer pieces.
            format: "gearloss-shard/2".to_owned(),
            gearloss: env!("CARGO_PKG_VERSION").to_owned(),
            packages: language.registry().packages().iter().map(ToString::to_string).collect(),
            inputs: all,
            shard,
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

    /// The shard whose folder it is, if it is one of the same study under the same program.
    fn suits(&self, folder: &Path) -> Result<Shard, Failure> {
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
            return Ok(other.shard);
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

/// An analysis that one shard has run as a whole.
#[derive(Serialize, Deserialize)]
pub struct Outcome {
    /// True for one that failed: it is run again, and at last by the merge, which tells why.
    pub failed: bool,
    /// Stated ranges that were left.
    pub left: usize,
    /// The same, for the end of the run.
    stated_ranges: StatedRanges,
    pub section: Section,
    /// Files of results with their hashes.
    pub files: Vec<(String, String)>,
    /// Where they lie.
    #[serde(skip)]
    folder: PathBuf,
}

impl Outcome {
    /// The folder of the files of an analysis.
    pub fn folder(part: &Path, name: &str) -> PathBuf {
        part.join(name).join("files")
    }

    /// What a runner whose folder is that of the files has done with one analysis.
    pub fn of(runner: &Run<'_>, failed: bool) -> Option<Self> {
        let section = runner.report.borrow_mut().drop_last()?;
        let hashed = |file: &String| Some((file.clone(), hash_of(&runner.folder.join(file)).ok()?));
        let files = runner.names.borrow().iter().filter_map(hashed).collect();
        Some(Self {
            failed,
            left: runner.left.get(),
            stated_ranges: runner.stated_ranges.take(),
            section,
            files,
            folder: runner.folder.clone(),
        })
    }

    /// Writes it beside its files, at last, so that it stands for whole ones.
    pub fn keep(&self, part: &Path, name: &str) -> Result<(), Failure> {
        store(&part.join(name).join("outcome.json"), self)
    }

    /// The outcome that a part holds, if all its files are as they were written.
    pub fn read(part: &Path, name: &str) -> Option<Self> {
        let mut outcome: Self = load(&part.join(name).join("outcome.json"))?;
        outcome.folder = Self::folder(part, name);
        let is_whole =
            |(file, known): &(String, String)| hash_of(&outcome.folder.join(file)).is_ok_and(|hash| hash == *known);
        outcome.files.iter().all(is_whole).then_some(outcome)
    }

    /// Prints what was printed, and puts files and section where they would be.
    pub fn replay(&self, runner: &Run<'_>, out: &mut Out) -> Result<(), Failure> {
        for line in self.section.text().split_inclusive('\n') {
            if !is_printed_at_the_end(line) {
                out.text(line)?;
            }
        }
        runner.stated_ranges.borrow_mut().extend(self.stated_ranges.clone());
        runner.report.borrow_mut().add(self.section.clone());
        for (file, _) in &self.files {
            let path = self.folder.join(file);
            let from = open_regular(&path).map_err(|e| {
                let message = format!("cannot read {}: {e}", path.display());
                Failure::input(message, "run its shard again, and merge then")
            })?;
            copy(runner, file, from)?;
        }
        runner.left.set(runner.left.get() + self.left);
        Ok(())
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

/// The file of the pieces of one map of an analysis.
pub fn piece_file(part: &Path, name: &str, map: usize) -> PathBuf {
    part.join(name).join(format!("{map}.pieces"))
}

/// Pieces of one map by their numbers: files and places in them.
type Places = BTreeMap<usize, (PathBuf, Place)>;

/// What all shards of a study have computed.
pub struct Parts {
    maps: BTreeMap<(String, usize), Places>,
    outcomes: BTreeMap<String, Outcome>,
}

impl Parts {
    /// Everything that the folders of the shards hold, if nothing is missing; absent, the folders `shards/*` beside the study.
    pub fn gather(language: &Language, study: &Study, named: &[PathBuf], file: &Path) -> Result<Self, Failure> {
        let folders = if named.is_empty() {
            beside(study)?
        } else {
            named.to_vec()
        };
        let manifest = Manifest::of(language, study, Shard { number: 0, of: 0 });
        let mut of: Option<(usize, &Path)> = None;
        for folder in &folders {
            let shard = manifest.suits(folder)?;
            let (count, first) = *of.get_or_insert((shard.of, folder));
            if shard.of != count {
                return Err(Failure::input(
                    format!(
                        "{} is of {count} shards, {} of {}",
                        first.display(),
                        folder.display(),
                        shard.of
                    ),
                    "name the folders of one splitting",
                ));
            }
        }
        let of = of.map_or(1, |(of, _)| of);
        let runner = Run::new(language, study, PathBuf::new(), None);
        let runners = runner.all();
        let deal = Deal::of(&runners, of);
        let mut parts = Self {
            maps: BTreeMap::new(),
            outcomes: BTreeMap::new(),
        };
        let mut missing: BTreeSet<usize> = BTreeSet::new();
        for work in &deal.works {
            match &work.kind {
                Kind::Faulty => {}
                Kind::Whole(unit) => match folders.iter().find_map(|part| Outcome::read(part, work.name)) {
                    Some(outcome) => drop(parts.outcomes.insert(work.name.to_owned(), outcome)),
                    None => drop(missing.insert(deal.owner(*unit))),
                },
                Kind::Maps(maps) => {
                    for (number, map) in maps.iter().enumerate() {
                        let mut places = Places::new();
                        for part in &folders {
                            let path = piece_file(part, work.name, number);
                            let found = PieceFile::read_only(path.clone()).map(|(_, found)| found);
                            // A shard that has no piece of a map has no file for it.
                            let found = found.unwrap_or_default().into_iter();
                            for (piece, place) in found.filter(|(piece, _)| *piece < map.pieces()) {
                                places.insert(piece, (path.clone(), place));
                            }
                        }
                        let lacking = (0..map.pieces()).filter(|piece| !places.contains_key(piece));
                        missing.extend(lacking.map(|piece| deal.owner(map.first + piece)));
                        parts.maps.insert((work.name.to_owned(), number), places);
                    }
                }
            }
        }
        if missing.is_empty() {
            return Ok(parts);
        }
        let list: Vec<String> = missing.iter().map(|number| format!("{number}/{of}")).collect();
        Err(Failure::input(
            format!("missing or not finished: shard {}", list.join(", ")),
            format!(
                "run `gearloss run {} --shard {}`{} and merge then",
                file.display(),
                list[0],
                if list.len() > 1 { " and so on" } else { "" }
            ),
        ))
    }

    /// The outcome of an analysis that was run as a whole.
    pub fn outcome(&self, name: &str) -> Option<&Outcome> {
        self.outcomes.get(name).filter(|outcome| !outcome.failed)
    }

    /// The pieces of one map in their order; absent for one that no shard could plan.
    pub fn pieces(&self, (name, map): (&str, usize)) -> Option<impl Iterator<Item = Result<Piece, Failure>> + '_> {
        let places = self.maps.get(&(name.to_owned(), map))?;
        Some(places.values().map(|(path, place)| {
            let piece = PieceFile::at_place(path, *place);
            piece.map_err(|e| {
                Failure::input(
                    format!("cannot read {}: {e}", path.display()),
                    "run its shard again, and merge then",
                )
            })
        }))
    }
}

/// The folders of shards beside a study.
fn beside(study: &Study) -> Result<Vec<PathBuf>, Failure> {
    let folder = study.folder.join("shards");
    let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries
        .map(|e| e.path())
        .filter(|f| f.join(MANIFEST).is_file())
        .collect();
    found.sort();
    if found.is_empty() {
        return Err(Failure::input(
            format!("{} holds no shard", folder.display()),
            "name the folders of the shards, or run them with `gearloss run STUDY --shard K/N` first",
        ));
    }
    Ok(found)
}
