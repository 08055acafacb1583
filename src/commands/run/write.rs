//! Files of results.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead as _, BufReader, BufWriter, Read, Write as _};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gearloss_framework::files::open_regular;
use gearloss_report::Figure;
use gearloss_studies::analyses::head::{FNV_BASIS, fnv1a_from, hexadecimal};
use gearloss_studies::analyses::{AnyOutcome, Built};
use gearloss_studies::study::Write;
use gearloss_studies::table::{Table, Values};
use serde::Serialize;
use serde_json::{Value, json};

use super::folder::{cannot, temporary};
use super::table::TableFile;
use super::{Run, Runner};
use crate::output::Failure;

/// What stands at the head of every JSON result.
pub fn head(runner: &Runner<'_>, built: &[&Built<'_>]) -> Value {
    json!(runner.head(built))
}

/// Writes what a study asks for of an outcome.
pub fn outcome(runner: &Runner<'_>, outcome: &dyn AnyOutcome, formats: &[Write]) -> Result<(), Failure> {
    for table in outcome.tables() {
        table_files(runner, &table, formats)?;
    }
    for file in outcome.files() {
        keep(runner.run, &file.name, Ok(file.text.into_bytes()))?;
    }
    if !formats.contains(&Write::Json) {
        return Ok(());
    }
    let (place, mut file) = Place::new(runner.run, &format!("{}.json", runner.name))?;
    let written = outcome.write_json(&mut file).map_err(std::io::Error::from);
    let written = written.and_then(|()| file.write_all(b"\n")).and_then(|()| file.flush());
    place.done(written.map_err(|e| e.to_string()))
}

/// Writes a table as CSV and Parquet, as asked.
fn table_files(runner: &Runner<'_>, table: &Table, formats: &[Write]) -> Result<(), Failure> {
    let header: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    let mut file = TableFile::new(runner.run, &table.name, formats, &header)?;
    let rows: Vec<usize> = (0..table.len()).collect();
    let made = file.shape().rows(&rows, |rows, columns| {
        for column in &table.columns {
            match &column.values {
                Values::Numbers(numbers) => columns.numbers(rows.iter().map(|row| Some(numbers[*row]))),
                Values::Texts(texts) => columns.texts(rows.iter().map(|row| texts.get(*row).unwrap_or_default())),
            }
        }
    });
    file.push_rows(vec![made], vec![(0, 0..table.len())])?;
    file.finish()
}

/// Name of the page.
pub const REPORT: &str = "report.html";

/// Takes away what an earlier run of an analysis left, because it would pass for the results of this one. What this run has
/// written stays: an analysis may fail in part.
pub fn remove(runner: &Run<'_>, name: &str) {
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
    let mut table = TableFile::new(runner.run, name, formats, header)?;
    table.push_all(rows)?;
    table.finish()?;
    write_json(runner, name, formats, value)
}

/// Writes a value as JSON, where that is asked for.
pub fn write_json(runner: &Runner<'_>, name: &str, formats: &[Write], value: &impl Serialize) -> Result<(), Failure> {
    if !formats.contains(&Write::Json) {
        return Ok(());
    }
    let (place, mut file) = Place::new(runner.run, &format!("{name}.json"))?;
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
    pub fn new(runner: &Run<'_>, name: &str) -> Result<(Self, BufWriter<fs::File>), Failure> {
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
        keep(runner.run, &file, figure.svg().map(String::into_bytes))?;
    }
    runner.run.report.borrow_mut().figure(figure);
    Ok(())
}

/// Writes a file of results whole, or says why it could not.
pub fn keep(runner: &Run<'_>, file: &str, bytes: Result<Vec<u8>, String>) -> Result<(), Failure> {
    let (place, mut to) = Place::new(runner, file)?;
    let written = bytes.and_then(|bytes| {
        to.write_all(&bytes)
            .and_then(|()| to.flush())
            .map_err(|e| e.to_string())
    });
    place.done(written)
}

/// Writes a file of results from what another one holds.
pub fn copy(runner: &Run<'_>, file: &str, mut from: impl Read) -> Result<(), Failure> {
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

/// The hash of a regular file, which is read some bytes at a time.
pub fn hash_of(file: &Path) -> std::io::Result<String> {
    let mut file = BufReader::new(open_regular(file)?);
    let mut hash = FNV_BASIS;
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(hexadecimal(hash));
        }
        hash = fnv1a_from(hash, bytes);
        let count = bytes.len();
        file.consume(count);
    }
}
