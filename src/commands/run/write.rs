//! Files of results.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead as _, BufReader, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_framework::files::open_regular;
use gearloss_report::Figure;
use gearloss_report::html::{Frame, gearbox_page};
use gearloss_studies::analyses::AnyOutcome;
use gearloss_studies::analyses::head::{FNV_BASIS, fnv1a_from, hexadecimal};
use gearloss_studies::study::Write;

use super::folder::{cannot, temporary};
use super::{Run, Runner};
use crate::output::Failure;

/// Writes an outcome as JSON.
pub fn outcome(runner: &Runner<'_>, outcome: &dyn AnyOutcome) -> Result<(), Failure> {
    let (place, mut file) = Place::new(&runner.run.files, &format!("{}.json", runner.name))?;
    let written = outcome.write_json(&mut file).map_err(std::io::Error::from);
    let written = written.and_then(|()| file.write_all(b"\n")).and_then(|()| file.flush());
    place.done(written.map_err(|e| e.to_string()))
}

/// Name of the report.
pub const REPORT: &str = "report.html";

/// Writes the page beside the results.
pub fn report(run: &Run<'_>, template: Option<&str>) -> Result<(), Failure> {
    let context = run.context("report");
    let mut report = run.report.borrow_mut();
    for (name, gearbox) in &run.study.gearboxes {
        report.gearboxes.push(gearbox_page(&context, name, gearbox)?);
    }
    let frame = Frame::new(run.study, run.language, env!("CARGO_PKG_VERSION"));
    keep(run, REPORT, Ok(report.html(&frame, template)?.into_bytes()))
}

/// Removes files of an earlier run of an analysis, which could be mistaken for current results. Files of this run are kept: an analysis may
/// fail in part.
pub fn remove(runner: &Run<'_>, name: &str) {
    for kind in ["csv", "json", "parquet"] {
        let file = format!("{name}.{kind}");
        if !runner.files.has(&file) {
            let _ = fs::remove_file(runner.files.folder.join(file));
        }
    }
}

/// The result folder and the files written into it.
#[derive(Debug, Default)]
pub struct Files {
    pub folder: PathBuf,
    names: Names,
}

/// Names of files, shared with files that are being written.
type Names = Arc<Mutex<BTreeSet<String>>>;

impl Files {
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            names: Names::default(),
        }
    }

    /// Whether a file was written, or is being written.
    pub fn has(&self, name: &str) -> bool {
        locked(&self.names).contains(name)
    }
}

fn locked(names: &Names) -> std::sync::MutexGuard<'_, BTreeSet<String>> {
    names.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is written beside its final path and moved there when complete; its name is reserved until then.
pub struct Place {
    name: String,
    names: Names,
    part: PathBuf,
    path: PathBuf,
}

impl Place {
    pub fn new(files: &Files, name: &str) -> Result<(Self, BufWriter<fs::File>), Failure> {
        // Names of analyses, sets and products are joined with hyphens, which they may contain.
        if !locked(&files.names).insert(name.to_owned()) {
            return Err(Failure::input(
                format!("two results would have the name {name}"),
                "rename an analysis or a model set",
            ));
        }
        let path = files.folder.join(name);
        let mut place = Self {
            name: name.to_owned(),
            names: Arc::clone(&files.names),
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

    /// Moves the complete file to its final path. An existing link there is replaced, not followed.
    pub fn done(mut self, written: Result<(), String>) -> Result<(), Failure> {
        let moved = written.and_then(|()| fs::rename(&self.part, &self.path).map_err(|e| e.to_string()));
        moved.map_err(|e| self.cannot(&e))?;
        self.name.clear();
        Ok(())
    }
}

impl Drop for Place {
    /// Removes an incomplete file and releases its name.
    fn drop(&mut self) {
        if !self.name.is_empty() {
            let _ = fs::remove_file(&self.part);
            locked(&self.names).remove(&self.name);
        }
    }
}

/// Adds a figure to the report, and writes it as a file if requested.
pub fn picture(runner: &Runner<'_>, name: &str, figure: Figure, formats: &[Write]) -> Result<(), Failure> {
    if formats.contains(&Write::Svg) {
        // A product precedes its set with a slash.
        let file = format!("{}.svg", name.replace('/', "-"));
        keep(runner.run, &file, figure.svg().map(String::into_bytes))?;
    }
    runner.run.in_section(|section| section.figures.push(figure));
    Ok(())
}

/// Writes a result file completely, or reports an error.
pub fn keep(runner: &Run<'_>, file: &str, bytes: Result<Vec<u8>, String>) -> Result<(), Failure> {
    let (place, mut to) = Place::new(&runner.files, file)?;
    let written = bytes.and_then(|bytes| {
        to.write_all(&bytes)
            .and_then(|()| to.flush())
            .map_err(|e| e.to_string())
    });
    place.done(written)
}

/// The hash of a regular file, read in blocks.
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
