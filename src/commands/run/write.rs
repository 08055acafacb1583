//! Files of results.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead as _, BufReader, BufWriter, Read, Write as _};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::files::open_regular;
use gearloss_report::Figure;
use gearloss_studies::study::{Study, Write};
use serde::Serialize;
use serde_json::{Value, json};

use super::folder::{cannot, temporary};
use super::table::TableFile;
use super::{Built, Runner};
use crate::output::Failure;

/// What stands at the head of every JSON result.
pub fn head(runner: &Runner<'_>, analysis: &str, built: &[&Built<'_>]) -> Value {
    let mut inputs = inputs(runner.study);
    for (file, hash) in runner.read.borrow().iter() {
        inputs.push(json!({ "gearbox": null, "file": file, "fnv1a_64": hash }));
    }
    let conditions = &runner.study.entry.conditions;
    json!({
        "format": "gearloss-result/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": runner.language.registry().packages(),
        "study": runner.study.entry.title,
        "analysis": analysis,
        "conditions": {
            "torque_at": conditions.torque_at,
            "speed_at": conditions.speed_at,
            "oil_temperature_degc": conditions.oil_temperature,
            "power_flow": conditions.power_flow,
            "set": conditions.set,
        },
        "inputs": inputs,
        "changed_from_source": built.iter().map(|b| json!({
            "model_set": b.name, "coefficients": changed_from_source(&b.transmission, &b.resolved),
        })).collect::<Vec<_>>(),
        "unreached": built.iter().map(|b| json!({ "model_set": b.name, "lines": b.resolved.unreached })).collect::<Vec<_>>(),
    })
}

/// The study, its gearboxes and the files that they have read, with their hashes.
pub fn inputs(study: &Study) -> Vec<Value> {
    let mut list = vec![json!({ "gearbox": null, "file": "study", "fnv1a_64": hash(study.text.as_bytes()) })];
    for (name, gearbox) in &study.gearboxes {
        for source in 0.. {
            let Some((file, text)) = gearbox.sources.get(source) else {
                break;
            };
            let file = Path::new(file).file_name().map_or(file, |f| f.to_str().unwrap_or(file));
            list.push(json!({ "gearbox": name, "file": file, "fnv1a_64": hash(text.as_bytes()) }));
        }
        for (file, text) in gearbox.files.all() {
            let file = file.file_name().and_then(|f| f.to_str()).unwrap_or_default().to_owned();
            list.push(json!({ "gearbox": name, "file": file, "fnv1a_64": hash(text.as_bytes()) }));
        }
    }
    list
}

/// Name of the page.
pub const REPORT: &str = "report.html";

/// Takes away what an earlier run of an analysis left, because it would pass for the results of this one. What this run has
/// written stays: an analysis may fail in part.
pub fn remove(runner: &Runner<'_>, name: &str) {
    for kind in ["csv", "json", "parquet"] {
        let file = format!("{name}.{kind}");
        if !runner.names.borrow().contains(&file) {
            let _ = fs::remove_file(runner.folder.join(file));
        }
    }
}

/// Writes a table as CSV and Parquet and a value as JSON, as asked.
pub fn write(
    runner: &Runner<'_>,
    name: &str,
    formats: &[Write],
    header: &[String],
    rows: &[Vec<String>],
    value: &impl Serialize,
) -> Result<(), Failure> {
    let mut table = TableFile::new(runner, name, formats, header)?;
    table.push_all(rows)?;
    table.finish()?;
    write_json(runner, name, formats, value)
}

/// Writes a value as JSON, where that is asked for.
pub fn write_json(runner: &Runner<'_>, name: &str, formats: &[Write], value: &impl Serialize) -> Result<(), Failure> {
    if !formats.contains(&Write::Json) {
        return Ok(());
    }
    let (place, mut file) = Place::new(runner, &format!("{name}.json"))?;
    let written = serde_json::to_writer_pretty(&mut file, value).map_err(std::io::Error::from);
    let written = written.and_then(|()| file.write_all(b"\n")).and_then(|()| file.flush());
    place.done(written.map_err(|e| e.to_string()))
}

/// A file that is written beside its place and moved there when it is whole; until then its name is held for it.
pub struct Place {
    name: String,
    names: Names,
    part: PathBuf,
    path: PathBuf,
}

/// Names of the files of a run.
pub type Names = Rc<RefCell<BTreeSet<String>>>;

impl Place {
    pub fn new(runner: &Runner<'_>, name: &str) -> Result<(Self, BufWriter<fs::File>), Failure> {
        // Names of analyses, sets and products are joined with hyphens, which they may hold themselves.
        if !runner.names.borrow_mut().insert(name.to_owned()) {
            return Err(Failure::input(
                format!("two results would be called {name}"),
                "rename an analysis or a set of models",
            ));
        }
        let path = runner.folder.join(name);
        let mut place = Self {
            name: name.to_owned(),
            names: Rc::clone(&runner.names),
            part: PathBuf::new(),
            path,
        };
        match temporary(&place.path) {
            Ok((part, file)) => {
                place.part = part;
                Ok((place, BufWriter::new(file)))
            }
            Err(e) => Err(place.cannot(&e)),
        }
    }

    pub fn cannot(&self, e: &dyn std::fmt::Display) -> Failure {
        cannot(&self.path, e)
    }

    /// Moves the file to its place, if it was written whole. A link that stands there is replaced, not followed.
    pub fn done(mut self, written: Result<(), String>) -> Result<(), Failure> {
        let moved = written.and_then(|()| fs::rename(&self.part, &self.path).map_err(|e| e.to_string()));
        moved.map_err(|e| self.cannot(&e))?;
        self.name.clear();
        Ok(())
    }
}

impl Drop for Place {
    /// Takes away what was not written whole, and lets its name go.
    fn drop(&mut self) {
        if !self.name.is_empty() {
            let _ = fs::remove_file(&self.part);
            self.names.borrow_mut().remove(&self.name);
        }
    }
}

/// Puts a picture into the report, and writes it as a file where that is asked for.
pub fn picture(runner: &Runner<'_>, name: &str, figure: Figure, formats: &[Write]) -> Result<(), Failure> {
    if formats.contains(&Write::Svg) {
        // A product stands before its set with a slash.
        let file = format!("{}.svg", name.replace('/', "-"));
        keep(runner, &file, figure.svg().map(String::into_bytes))?;
    }
    runner.report.borrow_mut().figure(figure);
    Ok(())
}

/// Writes a file of results whole, or says why it could not.
pub fn keep(runner: &Runner<'_>, file: &str, bytes: Result<Vec<u8>, String>) -> Result<(), Failure> {
    let (place, mut to) = Place::new(runner, file)?;
    let written = bytes.and_then(|bytes| {
        to.write_all(&bytes)
            .and_then(|()| to.flush())
            .map_err(|e| e.to_string())
    });
    place.done(written)
}

/// Writes a file of results from what another one holds.
pub fn copy(runner: &Runner<'_>, file: &str, mut from: impl Read) -> Result<(), Failure> {
    let (place, mut to) = Place::new(runner, file)?;
    let written = std::io::copy(&mut from, &mut to).and_then(|_| to.flush());
    place.done(written.map_err(|e| e.to_string()))
}

/// A cell: the number with all its digits; nothing where it is none.
pub fn cell(value: Option<f64>) -> String {
    value
        .filter(|x| x.is_finite())
        .map_or_else(String::new, |x| format!("{x}"))
}

/// FNV-1a, 64 bit: tells whether an input changed, no more.
pub fn fnv1a_64(bytes: &[u8]) -> u64 {
    fnv1a_from(FNV_BASIS, bytes)
}

/// The hash of nothing.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv1a_from(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The hash of bytes as it stands in results.
pub fn hash(bytes: &[u8]) -> String {
    words(fnv1a_64(bytes))
}

/// The hash of a regular file, which is read some bytes at a time.
pub fn hash_of(file: &Path) -> std::io::Result<String> {
    let mut file = BufReader::new(open_regular(file)?);
    let mut hash = FNV_BASIS;
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(words(hash));
        }
        hash = fnv1a_from(hash, bytes);
        let count = bytes.len();
        file.consume(count);
    }
}

fn words(hash: u64) -> String {
    format!("{hash:016x}")
}
