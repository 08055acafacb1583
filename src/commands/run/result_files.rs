//! Files of results: each is written next to its final path, under a unique name.

use std::collections::BTreeSet;
use std::fs;
use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use super::folder::{cannot, temporary};
use crate::output::Failure;

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

/// A file that is written next to its final path and moved there when complete; its name is reserved until then.
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
